//! From arguments to a description and a compiled scene, with every mistake said at once.

use std::path::Path;
use std::time::Instant;

use nephroid::{
    Checkpoint, CompileError, Compiled, Diagnostic, Overrides, Phase, SceneDesc, Sources, Survey, Timings,
    compile, load, render_all, strict, survey,
};

use crate::args::Changes;
use crate::failure::Failure;
use crate::values::Size;

/// A description that was read without mistakes.
#[derive(Debug)]
pub struct Described {
    /// The description, with all that was replaced.
    pub desc: SceneDesc,
    /// The texts that its spans point into.
    pub sources: Sources,
    /// What may be wrong with it.
    pub warnings: Vec<Diagnostic>,
    /// What reading took.
    pub timings: Timings,
}

/// Reads a scene. `messages`: what else is wrong with the command line, to be said with it.
pub fn describe(scene: &Path, changes: &Changes, messages: Vec<String>) -> Result<Described, Failure> {
    if Checkpoint::is_one(scene) {
        let name = scene.display();
        return Err(Failure::usage(format!(
            "{name} is no scene but a checkpoint\n  = help: `nephroid resume {name}` goes on with it"
        )));
    }
    let start = Instant::now();
    let loaded = load(scene, &changes.sets());
    let loaded = if changes.strict { strict(loaded) } else { loaded };
    let mut timings = Timings::default();
    timings.add(Phase::Load, start.elapsed());
    let Some(mut desc) = loaded.desc else {
        return Err(Failure::Scene(loaded.render(), messages));
    };
    if !messages.is_empty() {
        return Err(Failure::Usage(messages));
    }
    overrides(changes).apply(&mut desc);
    let [width, height] = desc.film.size;
    if let Some([x0, y0, x1, y1]) = desc.film.crop
        && (x1 > width || y1 > height || x0 >= x1 || y0 >= y1)
    {
        return Err(Failure::usage(format!(
            "the crop {x0},{y0},{x1},{y1} is no part of the picture\n  = help: it has {width}x{height} pixels; parts are left,top,\
             right,bottom"
        )));
    }
    Ok(Described { desc, sources: loaded.sources, warnings: loaded.diagnostics, timings })
}

/// Compiles on `threads` threads; the warnings of reading and compiling, as text, come with it.
pub fn compiled(described: &mut Described, threads: usize) -> Result<(Compiled, String), Failure> {
    let start = Instant::now();
    let result = compile(&described.desc, threads);
    described.timings.add(Phase::Compile, start.elapsed());
    let mut diagnostics = std::mem::take(&mut described.warnings);
    match result {
        Ok(compiled) => {
            diagnostics.extend(compiled.warnings.iter().cloned());
            Ok((compiled, render_all(&diagnostics, &described.sources)))
        }
        Err(CompileError::Threads(reason)) => Err(Failure::runtime(CompileError::Threads(reason))),
        Err(CompileError::Scene(errors)) => {
            diagnostics.extend(errors);
            Err(Failure::Scene(render_all(&diagnostics, &described.sources), Vec::new()))
        }
    }
}

/// Looks at a scene on all cores, without building what rays need; warnings as of [`compiled`].
pub fn surveyed(described: &mut Described) -> Result<(Survey, String), Failure> {
    let result = survey(&described.desc, 0);
    let mut diagnostics = std::mem::take(&mut described.warnings);
    match result {
        Ok((survey, told)) => {
            diagnostics.extend(told);
            Ok((survey, render_all(&diagnostics, &described.sources)))
        }
        Err(CompileError::Threads(reason)) => Err(Failure::runtime(CompileError::Threads(reason))),
        Err(CompileError::Scene(errors)) => {
            diagnostics.extend(errors);
            Err(Failure::Scene(render_all(&diagnostics, &described.sources), Vec::new()))
        }
    }
}

fn overrides(changes: &Changes) -> Overrides {
    let (size, width) = match changes.size {
        Some(Size::Both(size)) => (Some(size), None),
        Some(Size::Width(width)) => (None, Some(width)),
        None => (None, changes.width),
    };
    Overrides {
        integrator: changes.integrator.map(Into::into),
        size,
        crop: changes.crop,
        width,
        passes: changes.passes,
        seed: changes.seed,
        exposure: changes.display.exposure,
        white_balance: changes.display.white_balance,
        view: changes.display.view,
        denoise: changes.denoise.map(Into::into),
        max_depth: changes.max_depth,
        noise: changes.noise,
    }
}
