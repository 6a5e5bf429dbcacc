//! `cargo xtask bench`: builds and runs the program of `benches`, where all that it measures is said.

use std::process::Command;

use crate::{Outcome, root};

/// Hands the arguments on; file names stay relative to the caller's folder.
pub fn run(arguments: &[String]) -> Outcome {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let status = Command::new(cargo)
        .args(["run", "--quiet", "--release", "--package", "nephroid-benches", "--manifest-path"])
        .arg(root().join("Cargo.toml"))
        .arg("--")
        .args(arguments)
        .status()
        .map_err(|e| format!("cargo does not start: {e}"))?;
    if status.success() { Ok(()) } else { Err("the measurement failed".into()) }
}
