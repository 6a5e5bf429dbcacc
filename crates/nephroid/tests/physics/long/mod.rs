//! What takes minutes: `cargo xtask long`. Tests tell what they measured, with `--nocapture`.
#![allow(clippy::print_stdout, reason = "measured numbers")]

mod blocks;
mod contact;
mod convergence;
mod globe;
mod references;
