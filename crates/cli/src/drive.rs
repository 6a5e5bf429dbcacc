//! Runs a session to its end: progress, signals, pictures, and what is said of them.

use std::fmt::Write as _;
use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use nephroid::{
    Control, Event, Film, MapReport, Output, OutputKind, Phase, PictureInfo, Planes, Session, Timings,
};

use serde_json::json;

use crate::args::RunArgs;
use crate::denoise::Denoising;
use crate::failure::{FAILED, OK, Outcome};
use crate::grain;
use crate::info::bytes;
use crate::progress::{Position, Progress, duration};
use crate::replay::key_arguments;
use crate::say;
use crate::signals::{INTERRUPTED, Interrupt};
use crate::values::Previews;

/// How a session is to be driven.
#[derive(Debug)]
pub struct Drive<'a> {
    /// Pictures to write.
    pub outputs: &'a [Output],
    /// What they are written with.
    pub info: &'a PictureInfo,
    /// How to run.
    pub run: RunArgs,
    /// What came before.
    pub timings: Timings,
    /// What `nephroid replay` is to be given to trace paths of this render.
    pub again: &'a str,
    /// The grain that ends it.
    pub goal: Option<f32>,
    /// What takes noise out of the pictures.
    pub denoising: Option<&'a Denoising>,
}

/// Renders what is missing and writes the pictures.
pub fn drive(mut session: Session, how: Drive<'_>, interrupt: &Interrupt) -> Outcome {
    let Drive { outputs, info, run: args, mut timings, again, goal, denoising } = how;
    let mut progress = Progress::new(&args);
    interrupt.answer_through(&progress);
    let previews = args.preview_every.map_or_else(default_previews, |Previews(every)| every);
    if let Some(every) = previews {
        session = session.with_previews(outputs, info, every);
    }
    let mut teller = Teller { again, goal, maps: false, saved: None };
    let start = Instant::now();
    let result = session.run(&mut |event| {
        teller.tell(&mut progress, event);
        if interrupt.is_asked() { Control::Stop } else { Control::Continue }
    });
    progress.finish();

    timings.merge(session.timings());
    let mut code = OK;
    if let Err(error) = &result {
        progress.error(&format!("the render stopped: {error}"));
        code = FAILED;
    }
    if let Some((passes, size)) = teller.saved.filter(|_| session.is_saved() == Some(true)) {
        say_saved(&progress, &session, passes, size);
    }
    if session.is_saved() == Some(false) && session.done() > 0 {
        code = FAILED;
    }
    let pictures = Pictures { outputs, info, denoising };
    if session.done() > 0 && !write(&pictures, session.film(), &progress, &mut timings) {
        code = FAILED;
        if let (Some(true), Some(file)) = (session.is_saved(), session.checkpoint_file()) {
            let file = file.path().display();
            progress
                .line(&format!("  = help: nothing is lost: `nephroid merge {file} -o OUT` writes a picture"));
        }
    }
    if let Some(blank) = session.blank(info).filter(|_| session.done() > 0) {
        progress.warn(&format!("{}\n  = help: {}", blank.message, blank.help.unwrap_or_default()));
    }
    say_end(&progress, &session, goal, result.as_ref().ok().copied(), start.elapsed());
    if result == Ok(nephroid::Outcome::Stopped) && code == OK {
        code = INTERRUPTED;
    }
    if args.timings {
        say::print(&timing_table(&timings))?;
    }
    Ok(code)
}

/// What was told already.
struct Teller<'a> {
    /// As for [`drive`].
    again: &'a str,
    goal: Option<f32>,
    maps: bool,
    /// Passes and size of the last checkpoint.
    saved: Option<(u64, u64)>,
}

impl Teller<'_> {
    fn tell(&mut self, progress: &mut Progress, event: Event<'_>) {
        match event {
            Event::PhaseStarted(phase) => progress.doing(phase.name()),
            Event::PassStarted { .. } | Event::PhaseDone { .. } => progress.doing(Phase::EyePasses.name()),
            // Once, though some integrators make maps for every pass.
            Event::MapsReady { reports, .. } if !std::mem::replace(&mut self.maps, true) => {
                say_maps(progress, reports);
            }
            Event::PassDone { done, passes, elapsed, remaining, film, .. } => {
                progress.pass(&Position { done, passes, elapsed, remaining, goal: self.goal }, film);
            }
            Event::Warning(warning) => {
                let key = key_arguments(warning.replay_key());
                let command = format!("nephroid replay {} {key}", self.again);
                progress.warn(&format!("{warning}\n  = help: trace its path again: {command}"));
            }
            Event::CheckpointWritten { passes, bytes, .. } => self.saved = Some((passes, bytes)),
            Event::CheckpointFailed { error, .. } => {
                let older = self.saved.map_or(String::new(), |(passes, _)| {
                    format!("; the checkpoint of {} is still there", self::passes(passes))
                });
                progress.warn(&format!("{error}{older}\n  = help: {}", error.help()));
            }
            Event::PreviewWritten { passes, .. } => progress.preview(passes),
            Event::PreviewFailed { error } => {
                let tries = "the render goes on, and tries again";
                progress.warn(&format!("{error}: {tries}\n  = help: {}", error.help()));
            }
            _ => {}
        }
    }
}

fn say_maps(progress: &Progress, reports: &[MapReport]) {
    for report in reports {
        progress.line(&format!(
            "{} map: {} stored photons, {}, typical radius {:.3e}",
            report.name,
            report.photons,
            bytes(report.bytes as u64),
            report.typical_radius
        ));
    }
}

/// At a terminal people want to see something.
fn default_previews() -> Option<Duration> {
    std::io::stderr().is_terminal().then_some(Duration::from_secs(5))
}

fn say_saved(progress: &Progress, session: &Session, count: u64, size: u64) {
    if let Some(file) = session.checkpoint_file() {
        let path = file.path().display();
        let text = format!("saved {path} ({}, {})", passes(count), bytes(size));
        progress.object("saved", &text, json!({ "path": path.to_string(), "passes": count, "bytes": size }));
    }
}

/// How it ended, where that is not plain, and how good the picture is.
fn say_end(
    progress: &Progress,
    session: &Session,
    goal: Option<f32>,
    outcome: Option<nephroid::Outcome>,
    elapsed: Duration,
) {
    let done = session.done();
    let done = session.total().map_or_else(|| passes(done), |total| format!("{done} of {}", passes(total)));
    let resume = || {
        let file = session.checkpoint_file().filter(|_| session.is_saved() == Some(true))?;
        Some(format!("; `nephroid resume {}` goes on", file.path().display()))
    };
    match outcome {
        Some(nephroid::Outcome::Stopped) => {
            progress.line(&format!("interrupted after {done}{}", resume().unwrap_or_default()));
        }
        Some(nephroid::Outcome::TimeUp) => progress.line(&format!("the time is up after {done}")),
        Some(nephroid::Outcome::FineEnough) => {
            progress.line(&format!("the grain is as fine as was asked for after {done}"));
        }
        Some(nephroid::Outcome::Finished) => {
            let missed = |goal: &f32| session.film().grain().is_some_and(|grain| grain > f64::from(*goal));
            if let Some(goal) = goal.filter(missed) {
                let wanted = grain::percent(goal.into());
                progress.line(&format!(
                    "all passes are done before the grain is as fine as was asked for ({wanted})"
                ));
            }
        }
        None => {}
    }
    let how = match outcome {
        Some(nephroid::Outcome::Finished) => "finished",
        Some(nephroid::Outcome::FineEnough) => "fine-enough",
        Some(nephroid::Outcome::TimeUp) => "time-up",
        Some(nephroid::Outcome::Stopped) => "interrupted",
        None => "failed",
    };
    let values = json!({
        "outcome": how,
        "done": session.done(),
        "passes": session.total(),
        "elapsed_s": (elapsed.as_secs_f64() * 1e3).round() / 1e3,
        "grain": session.film().grain(),
    });
    progress.end(&grain::line(session.film()).unwrap_or_default(), values);
}

/// So many passes, in words.
pub fn passes(n: u64) -> String {
    if n == 1 { "1 pass".to_owned() } else { format!("{n} passes") }
}

/// Pictures to write.
#[derive(Clone, Copy, Debug)]
pub struct Pictures<'a> {
    /// Where.
    pub outputs: &'a [Output],
    /// With what.
    pub info: &'a PictureInfo,
    /// What takes the noise out.
    pub denoising: Option<&'a Denoising>,
}

/// Writes every output that can be written; whether all could.
pub fn write(
    &Pictures { outputs, info, denoising }: &Pictures<'_>,
    film: &Film,
    progress: &Progress,
    timings: &mut Timings,
) -> bool {
    let start = Instant::now();
    let mut all = true;
    let denoised =
        match denoising.filter(|_| !outputs.is_empty()).map(|how| how.apply(&Planes::of(film), progress)) {
            Some(Ok(denoised)) => denoised,
            Some(Err(())) => {
                all = false;
                None
            }
            None => None,
        };
    for output in outputs {
        let written = match &denoised {
            Some(denoised) => output.write_denoised(film, info, denoised),
            None => output.write(film, info),
        };
        match written {
            Ok(()) => {
                let (path, width, height) = (output.path().display(), film.width(), film.height());
                let count = film.passes();
                let values =
                    json!({ "path": path.to_string(), "width": width, "height": height, "passes": count });
                let text = format!("wrote {path} ({width}x{height}, {})", passes(count));
                progress.object("wrote", &text, values);
            }
            Err(error) => {
                progress.error(&format!("{error}\n  = help: {}", error.help()));
                all = false;
            }
        }
    }
    if all && outputs.iter().any(|output| output.kind() == OutputKind::Png) {
        let settled = info.settle(film);
        if settled.is_automatic || settled.found_kelvin.is_some() {
            let values = json!({ "exposure_ev": settled.ev, "light_k": settled.found_kelvin });
            progress.object("display", &settled.text(), values);
        }
    }
    timings.add(Phase::Write, start.elapsed());
    all
}

/// Says which files the pictures will replace.
pub fn say_replaced(progress: &Progress, outputs: &[Output]) {
    for output in outputs.iter().filter(|output| output.path().exists()) {
        progress.line(&format!("{} is there already: it will be replaced", output.path().display()));
    }
}

/// Absolute paths, for whoever goes on with the render in another folder.
pub fn absolute(outputs: &[Output]) -> Vec<PathBuf> {
    let absolute = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    outputs.iter().map(|output| absolute(output.path())).collect()
}

/// A row a phase: name, seconds, share.
fn timing_table(timings: &Timings) -> String {
    let total = timings.total().as_secs_f64();
    let mut out = String::new();
    for (phase, spent) in timings.iter() {
        let s = spent.as_secs_f64();
        let share = if total > 0.0 { 100.0 * s / total } else { 0.0 };
        let _ = writeln!(out, "{:<18} {s:>10.3} s {share:>5.1} %", phase.name());
    }
    let _ = writeln!(out, "{:<18} {total:>10.3} s   ({})", "total", duration(timings.total()));
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use expect_test::expect;
    use std::time::Duration;

    #[test]
    fn the_table_of_timings() {
        let mut timings = Timings::default();
        timings.add(Phase::Load, Duration::from_millis(4));
        timings.add(Phase::EyePasses, Duration::from_millis(12_000));
        timings.add(Phase::Write, Duration::from_millis(30));
        expect![[r#"
            load scene              0.004 s   0.0 %
            compile scene           0.000 s   0.0 %
            trace photons           0.000 s   0.0 %
            build photon maps       0.000 s   0.0 %
            eye passes             12.000 s  99.7 %
            write pictures          0.030 s   0.2 %
            total                  12.034 s   (12 s)
        "#]]
        .assert_eq(&timing_table(&timings));
    }
}
