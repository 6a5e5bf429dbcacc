//! The command line as people and scripts meet it.

mod harness;
mod interrupt;
mod manual;
mod outputs;
mod reports;
mod threads;
mod wrong;
