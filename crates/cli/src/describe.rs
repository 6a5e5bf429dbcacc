//! `nephroid describe`.

use crate::args::DescribeArgs;
use crate::failure::{Failure, OK, Outcome};
use crate::say::print;

/// Prints the reference of scene files, or a topic of it.
pub fn run(args: &DescribeArgs) -> Outcome {
    let text = nephroid::describe(&args.topic.join(" ")).map_err(Failure::usage)?;
    print(&text)?;
    Ok(OK)
}
