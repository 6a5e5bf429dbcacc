//! `nephroid merge`.

use std::path::Path;

use nephroid::{Checkpoint, CheckpointFile, MergeError, Timings, gaps, merge, overwritten_inputs, said};

use crate::args::MergeArgs;
use crate::checkpoint;
use crate::denoise::Denoising;
use crate::display::picture_info;
use crate::drive::{Pictures, passes, say_replaced, write};
use crate::failure::{FAILED, Failure, OK, Outcome};
use crate::grain;
use crate::info::bytes;
use crate::progress::Progress;
use crate::render::{checked, refusal};
use crate::say;

/// Adds up checkpoints.
pub fn run(args: &MergeArgs) -> Outcome {
    let (saves, pictures): (Vec<_>, Vec<_>) =
        args.output.iter().cloned().partition(|path| is_checkpoint(path));
    let mut messages = Vec::new();
    let outputs = checked(&pictures, &mut messages);
    let files: Vec<CheckpointFile> = saves
        .iter()
        .filter_map(|path| {
            CheckpointFile::open(path).map_err(|e| messages.push(checkpoint::refusal(&e))).ok()
        })
        .collect();
    for file in &files {
        // A checkpoint is work: it is not replaced by the way, not even by one that holds more.
        if file.path().exists() {
            messages.push(format!(
                "cannot write {}: there is such a file already\n  = help: give another name, or remove it first",
                file.path().display()
            ));
        }
    }
    if !messages.is_empty() {
        return Err(Failure::Usage(messages));
    }
    let Checkpoint { info, film } =
        merge(&args.checkpoints).map_err(|errors| Failure::Usage(errors.iter().map(reason).collect()))?;
    let replaced = overwritten_inputs(&outputs, &info.desc);
    if !replaced.is_empty() {
        return Err(Failure::Usage(replaced.iter().map(refusal).collect()));
    }
    let progress = Progress::plain(args.quiet);
    let how = args.denoise.map_or(info.desc.film.denoise, Into::into);
    let denoising = Denoising::find(how, &progress)?;
    say_replaced(&progress, &outputs);
    if !args.quiet {
        let missing = gaps(film.pass_ranges());
        let note = if missing.is_empty() {
            String::new()
        } else {
            format!("; {} are not among them", said(&missing))
        };
        let what = if args.checkpoints.len() == 1 { "read" } else { "merged" };
        let files = match args.checkpoints.len() {
            1 => "1 file".to_owned(),
            n => format!("{n} files"),
        };
        say::say(&format!("{what} {} of {files}{note}", passes(film.passes())));
    }
    let picture = picture_info(&info.desc, info.hash, &args.display)?;
    let mut code = OK;
    for file in &files {
        match file.write(&info, &film) {
            Ok(_) if args.quiet => {}
            Ok(size) => say::say(&format!(
                "wrote {} ({}, {})",
                file.path().display(),
                said(film.pass_ranges()),
                bytes(size)
            )),
            Err(error) => {
                say::error(&format!("{error}\n  = help: {}", error.help()));
                code = FAILED;
            }
        }
    }
    let pictures = Pictures { outputs: &outputs, info: &picture, denoising: denoising.as_ref() };
    if !write(&pictures, &film, &progress, &mut Timings::default()) {
        code = FAILED;
    }
    if let Some(noise) = grain::line(&film).filter(|_| !args.quiet) {
        say::say(&noise);
    }
    Ok(code)
}

fn is_checkpoint(path: &Path) -> bool {
    path.extension().is_some_and(|e| e.eq_ignore_ascii_case("neph"))
}

fn reason(error: &MergeError) -> String {
    match error {
        MergeError::Checkpoint(error) => checkpoint::refusal(error),
        other => other.to_string(),
    }
}
