//! `cargo xtask long`: the tests that take minutes.

use std::process::Command;

use crate::{Outcome, root};

/// Packages with such tests, each behind its feature `long`, in modules of that name.
const PACKAGES: [&str; 2] = ["nephroid", "nephroid-cli"];

/// Runs them; arguments choose among them by a part of their names.
pub fn run(arguments: &[String]) -> Outcome {
    let features = PACKAGES.map(|package| format!("{package}/long")).join(",");
    let mut command = Command::new(env!("CARGO"));
    command.current_dir(root()).args(["test", "--release", "--no-fail-fast", "--features", &features]);
    for package in PACKAGES {
        command.args(["--package", package]);
    }
    // Several filters mean any of them, so the module's name stands only where nothing else was chosen.
    command.arg("--");
    if arguments.is_empty() {
        command.arg("long::");
    }
    command.args(arguments);
    let status = command.status().map_err(|e| format!("cargo does not start: {e}"))?;
    if status.success() { Ok(()) } else { Err("long tests failed".into()) }
}
