//! The command line: says what sessions tell, and nothing that they don't know.

mod args;
mod checkpoint;
mod compare;
mod convert;
mod describe;
mod drive;
mod failure;
mod info;
mod manual;
mod merge;
mod progress;
mod render;
mod replay;
mod replay_json;
mod resume;
mod say;
mod scene;
mod signals;
mod span;

use std::process::ExitCode;

use clap::Parser;

use args::{Cli, Command};

fn main() -> ExitCode {
    let result = match Cli::parse().command {
        Command::Render(args) => render::run(&args),
        Command::Resume(args) => resume::run(&args),
        Command::Merge(args) => merge::run(&args),
        Command::Info(args) => info::run(&args),
        Command::Replay(args) => replay::run(&args),
        Command::Convert(args) => convert::run(&args),
        Command::Compare(args) => compare::run(&args),
        Command::Describe(args) => describe::run(&args),
        Command::Completions { shell } => manual::completions(shell),
        Command::Man => manual::man(),
    };
    match result {
        Ok(code) => ExitCode::from(code),
        Err(failure) => ExitCode::from(failure.report()),
    }
}
