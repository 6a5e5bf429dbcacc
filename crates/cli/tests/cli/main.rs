//! The command line as people and scripts meet it.
#![allow(clippy::unwrap_used, reason = "helpers of tests, too")]

mod develop;
mod harness;
mod imports;
mod interrupt;
mod layers;
#[cfg(all(unix, feature = "long"))]
mod long;
mod manners;
mod manual;
mod outputs;
mod parts;
mod progress;
mod replay;
mod reports;
mod sessions;
mod threads;
mod wrong;
