//! `nephroid render`.

use std::path::{Path, PathBuf};

use nephroid::{
    CheckpointFile, CheckpointInfo, Format, Job, Output, PictureError, Session, SessionError, check_outputs,
    desc, overwritten_inputs, scene_hash,
};

use serde_json::json;

use crate::args::{Layers, RenderArgs};
use crate::checkpoint;
use crate::denoise::Denoising;
use crate::display::picture_info;
use crate::drive::{Drive, absolute, drive, say_replaced};
use crate::failure::{Failure, OK, Outcome};
use crate::places;
use crate::progress::Progress;
use crate::replay::scene_arguments;
use crate::scene::{Described, compiled, describe};
use crate::signals::{INTERRUPTED, Interrupt};

/// Renders scenes and writes their pictures. Of several each is looked at before the first is rendered.
pub fn run(args: &RenderArgs) -> Outcome {
    let mut messages = Vec::new();
    let outputs = checked(&all_outputs(args, &mut messages), &mut messages);
    // As many for each scene.
    let shares: Vec<&[Output]> = match outputs.len() / args.scenes.len() {
        0 => vec![&[]; args.scenes.len()],
        each => outputs.chunks(each).collect(),
    };
    let file = args.checkpoint.as_deref().map(CheckpointFile::create).transpose();
    let file = file.unwrap_or_else(|error| {
        messages.push(checkpoint::refusal(&error));
        None
    });
    match (args.scenes.as_slice(), shares.as_slice()) {
        ([scene], [outputs]) => {
            let described = read(args, scene, outputs, messages)?;
            render(args, Prepared { scene, outputs, described, file }, &Interrupt::catch()?)
        }
        (scenes, shares) => several(args, scenes, shares, messages),
    }
}

/// Looks at all scenes, then renders one after another, whatever becomes of those before; the greatest exit status.
fn several(args: &RenderArgs, scenes: &[PathBuf], shares: &[&[Output]], messages: Vec<String>) -> Outcome {
    let mut wrong = OK;
    if !messages.is_empty() {
        wrong = Failure::Usage(messages).report();
    }
    for (scene, outputs) in scenes.iter().zip(shares) {
        // Read again when it is its turn: all of them together may be large.
        if let Err(failure) = read(args, scene, outputs, Vec::new()) {
            wrong = wrong.max(failure.report());
        }
    }
    if wrong != OK {
        return Ok(wrong);
    }
    let interrupt = Interrupt::catch()?;
    let mut code = OK;
    for (i, (scene, outputs)) in scenes.iter().zip(shares).enumerate() {
        let values = json!({ "scene": scene.display().to_string(), "number": i + 1, "of": scenes.len() });
        let text = format!("{} ({} of {})", scene.display(), i + 1, scenes.len());
        Progress::before(&args.run).object("scene", &text, values);
        let one = read(args, scene, outputs, Vec::new()).and_then(|described| {
            render(args, Prepared { scene, outputs, described, file: None }, &interrupt)
        });
        code = code.max(one.unwrap_or_else(|failure| failure.report()));
        if interrupt.is_asked() {
            return Ok(INTERRUPTED);
        }
    }
    Ok(code)
}

/// A scene that was read, and where its render goes.
struct Prepared<'a> {
    scene: &'a Path,
    outputs: &'a [Output],
    described: Described,
    file: Option<CheckpointFile>,
}

/// Reads a scene with all that the command line changes; `messages`: what else is wrong.
fn read(
    args: &RenderArgs,
    scene: &Path,
    outputs: &[Output],
    messages: Vec<String>,
) -> Result<Described, Failure> {
    let mut described = describe(scene, &args.changes, messages)?;
    if !args.layers.is_empty() {
        let has = |layers| args.layers.contains(&layers);
        described.desc.film.layers =
            desc::Layers { techniques: has(Layers::Techniques), lights: has(Layers::Lights) };
    }
    if let Some(lut) = &args.changes.display.lut {
        // As the scene's own, that a checkpoint knows it; whoever resumes may be in another folder.
        let lut = std::path::absolute(lut).unwrap_or_else(|_| lut.clone());
        described.desc.film.lut = Some(lut.into());
    }
    let replaced = overwritten_inputs(outputs, &described.desc);
    if !replaced.is_empty() {
        return Err(Failure::Usage(replaced.iter().map(refusal).collect()));
    }
    Ok(described)
}

fn render(args: &RenderArgs, prepared: Prepared<'_>, interrupt: &Interrupt) -> Outcome {
    let Prepared { scene: path, outputs, mut described, file } = prepared;
    let progress = Progress::before(&args.run);
    let denoising = Denoising::find(described.desc.film.denoise, &progress)?;
    let (scene, warnings) = compiled(&mut described, args.run.threads)?;
    progress.diagnostics(&warnings);
    let desc = &described.desc;
    let job = wanted_passes(args, Job::new(desc, scene.scene).map_err(Failure::usage)?);
    let mut session = Session::new(job, args.run.threads).map_err(|e| match e {
        SessionError::NoPasses | SessionError::Film(_) => Failure::usage(e),
        SessionError::Threads(_) | SessionError::Memory(_) => Failure::runtime(e),
    })?;
    if let Some(time) = args.time {
        session = session.with_time(time);
    }
    if let Some(noise) = desc.render.noise {
        session = session.with_grain(noise.into());
    }
    let hash = match file {
        None => scene_hash(desc).map_err(Failure::runtime)?,
        Some(file) => {
            let info = match Format::of(path) {
                Format::Native => CheckpointInfo::new(desc),
                _ => CheckpointInfo::of_import(desc, path, &args.changes.sets()),
            };
            let mut info = info.map_err(Failure::runtime)?;
            info.name = std::path::absolute(path).ok();
            info.timings = described.timings.clone();
            info.outputs = absolute(outputs);
            let hash = info.hash;
            session = session.with_checkpoint(file, info, args.checkpoint_every);
            hash
        }
    };
    let info = picture_info(desc, hash, &args.changes.display)?;
    say_replaced(&progress, outputs);
    let again = scene_arguments(path, &args.changes);
    let timings = described.timings;
    let goal = desc.render.noise;
    let (denoising, run) = (denoising.as_ref(), args.run);
    drive(session, Drive { outputs, info: &info, run, timings, again: &again, goal, denoising }, interrupt)
}

/// The passes that were asked for: a range, a number, those of the scene, or with nothing but a time or a grain, without
/// end.
fn wanted_passes(args: &RenderArgs, job: Job) -> Job {
    let ends = args.time.is_some() || args.changes.noise.is_some();
    match (&args.pass_range, args.changes.passes) {
        (Some(range), _) => Job { passes: range.clone(), ..job },
        (None, None) if ends => job.endless(),
        (None, _) => job,
    }
}

/// The outputs that were named, or each scene's name with .png in the working directory: scene by scene, as many for
/// each. Names that cannot be of several scenes become messages.
fn all_outputs(args: &RenderArgs, messages: &mut Vec<String>) -> Vec<PathBuf> {
    let several = args.scenes.len() > 1;
    if several {
        for named in args.output.iter().filter(|named| !places::is_for_many(named)) {
            messages.push(format!(
                "{} cannot be the picture of {} scenes\n  = help: name a folder that is there, as -o pictures/, or put {{}} \
                 for the scene's name, as -o {{}}.exr",
                named.display(),
                args.scenes.len()
            ));
        }
        if args.checkpoint.is_some() {
            messages.push(
                "a checkpoint is of one scene\n  = help: render the scenes one by one, each with a checkpoint of its own"
                    .into(),
            );
        }
    }
    if !messages.is_empty() {
        return Vec::new();
    }
    let of_scene = |scene: &PathBuf| -> Vec<PathBuf> {
        if args.output.is_empty() {
            return vec![places::default(scene, "png")];
        }
        args.output.iter().map(|named| places::of_scene(named, scene, "png")).collect()
    };
    args.scenes.iter().flat_map(of_scene).collect()
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
