//! `nephroid convert`.

use std::fs::File;
use std::io::Write;

use nephroid::{outsource, render_all, to_toml};

use crate::args::ConvertArgs;
use crate::failure::{Failure, OK, Outcome};
use crate::say;
use crate::scene::describe;

/// Writes a scene as TOML.
pub fn run(args: &ConvertArgs) -> Outcome {
    let name = args.out.display();
    if args.out.extension().is_none_or(|e| !e.eq_ignore_ascii_case("toml")) {
        return Err(Failure::usage(format!("{name} is written as TOML\n  = help: name it with .toml")));
    }
    let mut described = describe(&args.scene.scene, &args.scene.changes, Vec::new())?;
    let warnings = render_all(&described.warnings, &described.sources);
    if !warnings.is_empty() {
        say::say(say::painted(&warnings).trim_end());
    }
    let unwritable = |e: std::io::Error| {
        let help = match e.kind() {
            std::io::ErrorKind::AlreadyExists => "\n  = help: remove it, or choose another name",
            _ => "",
        };
        Failure::usage(format!("{name} cannot be written: {e}{help}"))
    };
    let mut file = File::create_new(&args.out).map_err(unwritable)?;
    // What was begun must not pass for a scene.
    let written = outsource(&mut described.desc, &args.out)
        .map_err(Failure::runtime)
        .and_then(|_| file.write_all(to_toml(&described.desc).as_bytes()).map_err(unwritable));
    if written.is_err() {
        let _ = std::fs::remove_file(&args.out);
    }
    written.map(|()| OK)
}
