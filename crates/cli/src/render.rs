//! `nephroid render`.

use std::path::{Path, PathBuf};

use nephroid::{
    CheckpointFile, CheckpointInfo, Format, Job, Output, PictureError, PictureInfo, Session, SessionError,
    check_outputs, desc, overwritten_inputs, scene_hash,
};

use crate::args::{Layers, RenderArgs};
use crate::checkpoint;
use crate::drive::{absolute, drive};
use crate::failure::{Failure, Outcome};
use crate::replay::scene_arguments;
use crate::say;
use crate::scene::{compiled, describe};

/// Renders a scene and writes its pictures.
pub fn run(args: &RenderArgs) -> Outcome {
    let mut messages = Vec::new();
    let outputs = checked(&wanted_outputs(args), &mut messages);
    let file = args.checkpoint.as_deref().map(CheckpointFile::create).transpose();
    let file = file.unwrap_or_else(|error| {
        messages.push(checkpoint::refusal(&error));
        None
    });
    let mut described = describe(&args.scene, messages)?;
    if !args.layers.is_empty() {
        let has = |layers| args.layers.contains(&layers);
        described.desc.film.layers =
            desc::Layers { techniques: has(Layers::Techniques), lights: has(Layers::Lights) };
    }
    let replaced = overwritten_inputs(&outputs, &described.desc);
    if !replaced.is_empty() {
        return Err(Failure::Usage(replaced.iter().map(refusal).collect()));
    }
    let (scene, warnings) = compiled(&mut described, args.run.threads)?;
    if !warnings.is_empty() {
        say::say(say::painted(&warnings).trim_end());
    }
    let desc = &described.desc;
    let job = wanted_passes(args, Job::new(desc, scene.scene).map_err(Failure::usage)?);
    let mut session = Session::new(job, args.run.threads).map_err(|e| match e {
        SessionError::NoPasses | SessionError::Film(_) => Failure::usage(e),
        SessionError::Threads(_) | SessionError::Memory(_) => Failure::runtime(e),
    })?;
    if let Some(time) = args.time {
        session = session.with_time(time);
    }
    let hash = match file {
        None => scene_hash(desc).map_err(Failure::runtime)?,
        Some(file) => {
            let info = match Format::of(&args.scene.scene) {
                Format::Native => CheckpointInfo::new(desc),
                _ => CheckpointInfo::of_import(desc, &args.scene.scene, &args.scene.set),
            };
            let mut info = info.map_err(Failure::runtime)?;
            info.timings = described.timings.clone();
            info.outputs = absolute(&outputs);
            let hash = info.hash;
            session = session.with_checkpoint(file, info, args.checkpoint_every);
            hash
        }
    };
    let info = PictureInfo::new(desc, hash);
    drive(session, &outputs, &info, args.run, described.timings, &scene_arguments(&args.scene))
}

/// The passes that were asked for: a range, a number, those of the scene, or with nothing but a time, without end.
fn wanted_passes(args: &RenderArgs, job: Job) -> Job {
    match (&args.pass_range, args.scene.passes, args.time) {
        (Some(range), ..) => Job { passes: range.clone(), ..job },
        (None, None, Some(_)) => job.endless(),
        _ => job,
    }
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

/// Outputs that can be written; those that cannot become messages.
pub fn checked(paths: &[PathBuf], messages: &mut Vec<String>) -> Vec<Output> {
    match check_outputs(paths) {
        Ok(outputs) => outputs,
        Err(errors) => {
            messages.extend(errors.iter().map(refusal));
            Vec::new()
        }
    }
}

/// Why a picture cannot be written, and what to do.
pub fn refusal(error: &PictureError) -> String {
    format!("{error}\n  = help: {}", error.help())
}
