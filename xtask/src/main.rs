//! The project's chores: `cargo xtask NAME`.
#![allow(clippy::print_stdout, clippy::print_stderr)] // it reports

mod bench;
mod book;
mod cookbook;
mod diagrams;
mod dist;
mod gallery;
mod long;
mod passes;
mod perfume;
mod pictures;
mod reference;
mod spheres;
mod verify;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// What a chore returns: a message for people where it failed.
type Outcome = Result<(), String>;

/// Name, arguments, what it does, and the function that does it with the rest of the command line.
type Chore = (&'static str, &'static str, &'static str, fn(&[String]) -> Outcome);

const CHORES: &[Chore] = &[
    ("bench", "[--quick] [--only PREFIX] [--json FILE]", "measures against peers", bench::run),
    ("book", "[--check]", "checks the links of all pages and makes the site: target/book/", book::run),
    ("cookbook", "[NAME... | --pages | --jpeg FROM TO]", "renders docs/cookbook/", cookbook::run),
    ("diagrams", "[--check]", "draws docs/book/diagrams/", diagrams::run),
    ("dist", "[--target TRIPLE]", "packs the program for release: target/dist/", dist::run),
    ("gallery", "[NAME...]", "renders docs/gallery/", gallery::run),
    ("long", "[NAME...]", "runs the tests that take minutes", long::run),
    ("passes", "", "renders docs/cookbook/passes.gif", passes::run),
    ("perfume", "[--check]", "writes scenes/cookbook/perfume.glb", perfume::run),
    ("reference", "[--check]", "writes docs/reference.md", reference::run),
    ("spheres", "[NAME...]", "renders docs/book/spheres/: a ball of every material", spheres::run),
    (
        "verify",
        "[--scenes DIR] [--out DIR] [--passes N] [NAME...]",
        "renders scenes of other programs beside their references",
        verify::run,
    ),
];

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let outcome = match arguments.split_first() {
        Some((name, rest)) => match CHORES.iter().find(|chore| chore.0 == name) {
            Some((_, _, _, run)) => run(rest),
            None => Err(format!("`{name}` is no chore\n{}", usage())),
        },
        None => Err(usage()),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{}", message.trim_end());
            ExitCode::FAILURE
        }
    }
}

fn usage() -> String {
    let line =
        |(name, arguments, what, _): &Chore| format!("  cargo xtask {name} {arguments}\n      {what}\n");
    format!("usage:\n{}", CHORES.iter().map(line).collect::<String>())
}

/// The root of the repository.
fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}
