//! `nephroid resume`.

use nephroid::{
    CheckpointError, CheckpointErrorKind, CompileError, Extent, Resumed, SessionError, Sources, Wanted, load,
    overwritten_inputs, render_all, resume,
};

use crate::args::ResumeArgs;
use crate::checkpoint;
use crate::denoise::Denoising;
use crate::display::picture_info;
use crate::drive::{Drive, drive, say_replaced};
use crate::failure::{Failure, Outcome};
use crate::progress::Progress;
use crate::render::{checked, refusal};
use crate::replay::quoted;
use crate::signals::Interrupt;

/// Goes on with a checkpoint.
pub fn run(args: &ResumeArgs) -> Outcome {
    let mut messages = Vec::new();
    checked(&args.output, &mut messages);
    if !messages.is_empty() {
        return Err(Failure::Usage(messages));
    }
    let extent = args.passes.unwrap_or(Extent::AsAsked);
    let wanted = Wanted { extent, time: args.time, grain: args.noise };
    let resumed = resume(&args.checkpoint, wanted, args.checkpoint_every, args.run.threads, &load);
    let Resumed { mut session, info, warnings, timings } = resumed.map_err(|e| failure(&e))?;
    let outputs = if args.output.is_empty() { &info.outputs } else { &args.output };
    let outputs = checked(outputs, &mut messages);
    messages.extend(overwritten_inputs(&outputs, &info.desc).iter().map(refusal));
    if !messages.is_empty() {
        return Err(Failure::Usage(messages));
    }
    if !args.output.is_empty() {
        session = session.with_outputs(crate::drive::absolute(&outputs));
    }
    let progress = Progress::before(&args.run);
    let how = args.denoise.map_or(info.desc.film.denoise, Into::into);
    let denoising = Denoising::find(how, &progress)?;
    progress.diagnostics(&render_all(&warnings, &Sources::default()));
    let (name, done) = (args.checkpoint.display(), session.done());
    progress.line(&match (session.total(), session.missing()) {
        (Some(total), 0) => format!("{name} has all of its {total} passes: nothing is left to render"),
        (Some(total), _) => format!("going on with {name}: {done} of {total} passes are done"),
        (None, _) => format!("going on with {name}: {done} passes are done"),
    });
    let picture = picture_info(&info.desc, info.hash, &args.display)?;
    if !args.output.is_empty() {
        say_replaced(&progress, &outputs);
    }
    let again = quoted(&args.checkpoint.to_string_lossy());
    let goal = args.noise.or(info.desc.render.noise);
    let (denoising, run) = (denoising.as_ref(), args.run);
    let how = Drive { outputs: &outputs, info: &picture, run, timings, again: &again, goal, denoising };
    drive(session, how, &Interrupt::catch()?)
}

fn failure(error: &CheckpointError) -> Failure {
    match error.kind() {
        CheckpointErrorKind::Session(SessionError::Threads(_) | SessionError::Memory(_))
        | CheckpointErrorKind::Scene(CompileError::Threads(_)) => Failure::runtime(error),
        _ => Failure::Usage(vec![checkpoint::refusal(error)]),
    }
}
