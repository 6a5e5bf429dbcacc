//! What a checkpoint holds, and why one cannot be used.

use std::fmt::Write as _;
use std::path::Path;

use nephroid::{Checkpoint, CheckpointError, Film, said};

use crate::drive::passes;
use crate::failure::{Failure, OK, Outcome};
use crate::grain;
use crate::info::{bytes, row, settings};
use crate::progress::duration;
use crate::say;

/// The reason with what to do about it.
pub fn refusal(error: &CheckpointError) -> String {
    match error.help() {
        Some(help) => format!("{error}\n  = help: {help}"),
        None => error.to_string(),
    }
}

/// `nephroid info` of a checkpoint: all of it is read, so that damage shows.
pub fn info(path: &Path) -> Outcome {
    let Checkpoint { info, film } = Checkpoint::read(path).map_err(|e| Failure::Usage(vec![refusal(&e)]))?;
    let size = std::fs::metadata(path).map_or(0, |m| m.len());
    let mut text = String::new();
    row(&mut text, "checkpoint", &format!("{}, {}, undamaged", path.display(), bytes(size)));
    row(
        &mut text,
        "scene",
        &format!("{} ({})", info.name.as_ref().unwrap_or(&info.desc.base).display(), info.hash),
    );
    settings(&mut text, &info.desc);
    let asked = match info.passes.end - info.passes.start {
        Film::MAX_PASSES => "without end".to_owned(),
        _ => said(std::slice::from_ref(&info.passes)),
    };
    row(&mut text, "holds", &format!("{}: {}", passes(film.passes()), said(film.pass_ranges())));
    let time = info.time.map_or(String::new(), |time| format!(", {}", duration(time)));
    row(&mut text, "asked for", &format!("{asked}{time}"));
    row(&mut text, "took", &duration(info.elapsed));
    if let Some(grain) = grain::line(&film) {
        row(&mut text, "grain", grain.trim_start_matches("grain "));
    }
    if film.nonfinite_count() > 0 {
        row(&mut text, "left out", &format!("{} values that were not finite", film.nonfinite_count()));
    }
    if !film.layer_names().is_empty() {
        row(&mut text, "layers", &film.layer_names().join(", "));
    }
    for (file, _) in &info.files {
        let _ = writeln!(text, "{:<11} {}", "reads", info.desc.resolve(file).display());
    }
    for output in &info.outputs {
        let _ = writeln!(text, "{:<11} {}", "to write", output.display());
    }
    say::print(&text)?;
    Ok(OK)
}
