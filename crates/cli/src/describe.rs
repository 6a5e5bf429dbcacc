//! `nephroid describe`.

use crate::args::DescribeArgs;
use crate::failure::{Failure, OK, Outcome};
use crate::say::print;

/// Prints the reference of scene files, or a topic of it.
pub fn run(args: &DescribeArgs) -> Outcome {
    let text = nephroid::describe(args.topic.as_deref().unwrap_or_default()).map_err(Failure::usage)?;
    print(&text)?;
    Ok(OK)
}
