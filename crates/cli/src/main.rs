//! The command line: says what sessions tell, and nothing that they don't know.

mod args;
mod checkpoint;
mod compare;
mod convert;
mod denoise;
mod describe;
mod develop;
mod display;
#[cfg(test)]
mod docs;
mod drive;
mod failure;
mod grain;
mod info;
mod manual;
mod merge;
mod places;
mod progress;
mod render;
mod replay;
mod replay_json;
mod resume;
mod say;
mod scene;
mod signals;
mod span;
mod typed;
mod values;

use std::process::ExitCode;

use args::Command;

fn main() -> ExitCode {
    let cli = match typed::parse(std::env::args_os().collect()) {
        Ok(cli) => cli,
        Err(error) => match typed::refused(&error) {
            Some(failure) => return ExitCode::from(failure.report()),
            None => error.exit(),
        },
    };
    let result = match cli.command {
        Command::Render(args) => render::run(&args),
        Command::Resume(args) => resume::run(&args),
        Command::Merge(args) => merge::run(&args),
        Command::Develop(args) => develop::run(&args),
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
