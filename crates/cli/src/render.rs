//! `nephroid render`.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::time::Instant;

use nephroid::{
    Control, Event, Job, MapReport, Output, Phase, PictureError, PictureInfo, Session, SessionError, Timings,
    Warning, check_outputs, overwritten_inputs, scene_hash,
};

use crate::args::RenderArgs;
use crate::failure::{FAILED, Failure, OK, Outcome};
use crate::progress::{Progress, duration};
use crate::say;
use crate::scene::{compiled, describe};
use crate::signals::{INTERRUPTED, Interrupt};

/// Renders a scene and writes its pictures.
pub fn run(args: &RenderArgs) -> Outcome {
    let (outputs, messages) = match check_outputs(&wanted_outputs(args)) {
        Ok(outputs) => (outputs, Vec::new()),
        Err(errors) => (Vec::new(), errors.iter().map(refusal).collect()),
    };
    let mut described = describe(&args.scene, messages)?;
    let replaced = overwritten_inputs(&outputs, &described.desc);
    if !replaced.is_empty() {
        return Err(Failure::Usage(replaced.iter().map(refusal).collect()));
    }
    let (scene, warnings) = compiled(&mut described, args.threads)?;
    if !warnings.is_empty() {
        say::say(say::painted(&warnings).trim_end());
    }
    let desc = &described.desc;
    let hash = scene_hash(desc).map_err(Failure::runtime)?;
    let info = PictureInfo::new(desc, hash);
    let job = Job::new(desc, scene.scene).map_err(Failure::usage)?;
    let passes = job.passes.end - job.passes.start;
    let mut session = Session::new(job, args.threads).map_err(|e| match e {
        SessionError::NoPasses | SessionError::Film(_) => Failure::usage(e),
        SessionError::Threads(_) | SessionError::Memory(_) => Failure::runtime(e),
    })?;

    let mut progress = Progress::new(args.quiet, passes);
    let handle = progress.clone();
    let interrupt = Interrupt::catch(move || {
        handle.line("interrupted: the picture is written after this pass; once more ends at once");
    })
    .map_err(|e| Failure::runtime(format!("Ctrl-C cannot be caught: {e}")))?;
    let mut maps_said = false;
    let result = session.run(&mut |event| {
        // Once, though some integrators make maps for every pass.
        if let Event::MapsReady { reports, .. } = &event
            && !std::mem::replace(&mut maps_said, true)
        {
            say_maps(&progress, reports);
        }
        tell(&mut progress, event);
        if interrupt.is_asked() { Control::Stop } else { Control::Continue }
    });
    progress.finish();

    let mut timings = described.timings.clone();
    timings.merge(session.timings());
    let failed = match &result {
        Err(error) => Some(format!("the render stopped: {error}")),
        Ok(_) => None,
    };
    let mut code = if failed.is_some() { FAILED } else { OK };
    if let Some(message) = failed {
        say::error(&message);
    }
    if session.done() > 0 && !write(&outputs, &session, &info, args.quiet, &mut timings) {
        code = FAILED;
    }
    if result == Ok(nephroid::Outcome::Stopped) {
        if !args.quiet {
            say::say(&format!("interrupted after {} of {passes} passes", session.done()));
        }
        if code == OK {
            code = INTERRUPTED;
        }
    }
    if args.timings {
        say::print(&timing_table(&timings))?;
    }
    Ok(code)
}

/// The outputs that were named, or the scene's name with .png in the working directory.
fn wanted_outputs(args: &RenderArgs) -> Vec<PathBuf> {
    if !args.output.is_empty() {
        return args.output.clone();
    }
    let stem = args.scene.scene.file_stem().unwrap_or("picture".as_ref());
    let mut name = stem.to_os_string();
    name.push(".png");
    vec![Path::new(&name).to_path_buf()]
}

fn refusal(error: &PictureError) -> String {
    format!("{error}\n  = help: {}", error.help())
}

fn tell(progress: &mut Progress, event: Event<'_>) {
    match event {
        Event::PhaseStarted(phase) => progress.doing(phase.name()),
        Event::PassStarted { .. } => progress.doing(Phase::EyePasses.name()),
        Event::PassDone { done, passes, elapsed, remaining, .. } => {
            progress.passes(done, passes, elapsed, remaining);
        }
        Event::PhaseDone { .. } => progress.doing(Phase::EyePasses.name()),
        Event::Warning(warning) => warn(progress, &warning),
        _ => {}
    }
}

fn say_maps(progress: &Progress, reports: &[MapReport]) {
    for report in reports {
        progress.line(&format!(
            "{} map: {} stored photons, {}, typical radius {:.3e}",
            report.name,
            report.photons,
            crate::info::bytes(report.bytes as u64),
            report.typical_radius
        ));
    }
}

/// Warnings are said whatever the verbosity.
fn warn(progress: &Progress, warning: &Warning) {
    let text = say::warning(&warning.to_string());
    match progress {
        Progress::Quiet => say::say(&text),
        _ => progress.line(&text),
    }
}

/// Writes every output that can be written; whether all could.
fn write(
    outputs: &[Output],
    session: &Session,
    info: &PictureInfo,
    quiet: bool,
    timings: &mut Timings,
) -> bool {
    let start = Instant::now();
    let film = session.film();
    let mut all = true;
    for output in outputs {
        match output.write(film, info) {
            Ok(()) if quiet => {}
            Ok(()) => say::say(&format!(
                "wrote {} ({}x{}, {} passes)",
                output.path().display(),
                film.width(),
                film.height(),
                film.passes()
            )),
            Err(error) => {
                say::error(&error.to_string());
                all = false;
            }
        }
    }
    timings.add(Phase::Write, start.elapsed());
    all
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
