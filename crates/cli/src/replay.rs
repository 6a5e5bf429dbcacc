//! `nephroid replay`.

use std::fmt::Write as _;
use std::path::Path;

use nephroid::{
    Checkpoint, CheckpointErrorKind, Job, PathEvent, PathRecord, ReplayError, ReplayKey, Replayed, SceneDesc,
    VertexRecord, replay,
};

use crate::args::{Changes, Integrator, ReplayArgs, SceneArgs};
use crate::checkpoint;
use crate::failure::{Failure, OK, Outcome};
use crate::replay_json::json;
use crate::say;
use crate::scene::{Described, compiled, describe};
use crate::values::Size;
use clap::ValueEnum;

/// Traces a path again and prints it.
pub fn run(args: &ReplayArgs) -> Outcome {
    let mut described = if Checkpoint::is_one(&args.scene.scene) {
        of_checkpoint(&args.scene)?
    } else {
        describe(&args.scene.scene, &args.scene.changes, Vec::new())?
    };
    let (scene, warnings) = compiled(&mut described, 0)?;
    if !warnings.is_empty() {
        say::say(say::painted(&warnings).trim_end());
    }
    let job = Job::new(&described.desc, scene.scene).map_err(Failure::usage)?;
    let key = match (args.pixel, args.photon) {
        (Some([x, y]), _) => ReplayKey::Pixel { pass: args.pass, x, y },
        (None, photon) => {
            ReplayKey::Photon { pass: args.pass, kind: args.map.map(Into::into), path: photon.unwrap_or(0) }
        }
    };
    let replayed = replay(&job, key, 0).map_err(|error| match error {
        ReplayError::Threads(_) => Failure::runtime(error),
        _ => Failure::usage(error),
    })?;
    for path in &replayed {
        let text = if args.json { json(key, path) } else { table(key, path, &described.desc) };
        say::print(&text)?;
    }
    Ok(OK)
}

/// What a checkpoint was made of.
fn of_checkpoint(args: &SceneArgs) -> Result<Described, Failure> {
    let name = args.scene.to_string_lossy();
    if scene_arguments(&args.scene, &args.changes) != quoted(&name) {
        return Err(Failure::usage(format!(
            "{name} is a checkpoint, whose scene and settings cannot be changed\n  = help: give the pass and the pixel or \
             photon alone"
        )));
    }
    let refused = |error| Failure::Usage(vec![checkpoint::refusal(&error)]);
    let (info, _) = Checkpoint::read_head(&args.scene).map_err(refused)?;
    let changed = info.changed_files();
    if !changed.is_empty() {
        return Err(refused(nephroid::CheckpointError::new(
            &args.scene,
            CheckpointErrorKind::Files(changed),
        )));
    }
    Ok(Described {
        desc: info
            .scene(&nephroid::load)
            .map_err(|kind| refused(nephroid::CheckpointError::new(&args.scene, kind)))?,
        sources: Default::default(),
        warnings: Vec::new(),
        timings: Default::default(),
    })
}

/// The part of a command line that names a path.
pub fn key_arguments(key: ReplayKey) -> String {
    match key {
        ReplayKey::Pixel { pass, x, y } => format!("--pass {pass} --pixel {x},{y}"),
        ReplayKey::Photon { pass, kind, path } => {
            let map = kind.map_or(String::new(), |kind| format!(" --map {}", kind.name()));
            format!("--pass {pass} --photon {path}{map}")
        }
    }
}

/// The part of a command line that names a scene and what decides its paths.
pub fn scene_arguments(scene: &Path, args: &Changes) -> String {
    let mut words = vec![scene.to_string_lossy().into_owned()];
    let mut flag = |name: &str, value: Option<String>| {
        if let Some(value) = value {
            words.extend([name.to_owned(), value]);
        }
    };
    let name = |integrator: Integrator| Some(integrator.to_possible_value()?.get_name().to_owned());
    flag("--integrator", args.integrator.and_then(name));
    flag(
        "--size",
        args.size.map(|size| match size {
            Size::Both([w, h]) => format!("{w}x{h}"),
            Size::Width(width) => width.to_string(),
        }),
    );
    flag("--width", args.width.map(|n| n.to_string()));
    flag("--seed", args.seed.map(|n| n.to_string()));
    flag("--max-depth", args.max_depth.map(|n| n.to_string()));
    for set in args.sets() {
        flag("--set", Some(set));
    }
    words.iter().map(|word| quoted(word)).collect::<Vec<_>>().join(" ")
}

/// A word as a shell takes it.
pub fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || "-_./,=:+@%".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        return word.to_owned();
    }
    format!("'{}'", word.replace('\'', "'\\''"))
}

/// Which path, in words.
fn title(key: ReplayKey, path: &Replayed, desc: &SceneDesc) -> String {
    let (integrator, seed) = (desc.render.integrator.name(), desc.render.seed);
    let what = match key {
        ReplayKey::Pixel { pass, x, y } => format!("camera path through pixel {x},{y} of pass {pass}"),
        ReplayKey::Photon { pass, path: index, .. } => {
            let kind = path.kind.map_or("", |kind| kind.name());
            format!("{kind} photon path {index} of pass {pass}")
        }
    };
    format!("{what} ({integrator}, seed {seed})")
}

fn table(key: ReplayKey, path: &Replayed, desc: &SceneDesc) -> String {
    let mut text = title(key, path, desc);
    text.push('\n');
    let record = &path.record;
    if record.events.is_empty() {
        text += "  nothing: the light sends nothing along this path, or it misses what it is aimed at\n";
    }
    for event in &record.events {
        say_event(&mut text, event);
    }
    say_sample(&mut text, record);
    text
}

fn say_event(text: &mut String, event: &PathEvent) {
    let _ = match event {
        PathEvent::Start { light, position, direction, flux } => writeln!(
            text,
            "  start       from {light} at {}, toward {}\n              flux {} W",
            point(*position),
            point(*direction),
            numbers(*flux)
        ),
        PathEvent::Vertex(vertex) => return say_vertex(text, vertex),
        PathEvent::Light { layer, technique, from, radiance } => {
            let from = if from.is_empty() { String::new() } else { format!(", from {}", from.join(", ")) };
            let bad = if radiance.iter().all(|v| v.is_finite()) { "" } else { "  <-- not finite" };
            writeln!(text, "    + {:<9} {} ({layer}{from}){bad}", technique.name(), numbers(*radiance))
        }
        PathEvent::Joined { light_path } => writeln!(text, "    joined to light path {light_path}"),
        PathEvent::Stored { power, caustic } => {
            let kind = if *caustic { "a caustic photon" } else { "a photon" };
            writeln!(text, "    stored    {kind} of {} W", numbers(*power))
        }
        PathEvent::Splat { film_position: [x, y], layer, radiance } => {
            writeln!(text, "    + project   {} ({layer}) at {x:.2},{y:.2} of the film", numbers(*radiance))
        }
        PathEvent::End(end) => writeln!(text, "  end         {}", end.text()),
    };
}

fn say_vertex(text: &mut String, v: &VertexRecord) {
    let object = v.object.as_deref().unwrap_or("an object without name");
    let material = v.material.as_ref().map_or(String::new(), |name| format!("{name}, "));
    let class = if v.is_diffuse { "D" } else { "S" };
    let light = v.light.as_ref().map_or(String::new(), |name| format!(", shines as {name}"));
    let _ = writeln!(text, "  vertex {:<4} {object} ({material}{}, {class}{light})", v.depth, v.scattering);
    let _ = writeln!(
        text,
        "              at {}, {} away, footprint {}",
        point(v.position),
        short(v.distance),
        short(v.footprint)
    );
    let shading = if v.ns == v.ng { String::new() } else { format!(", shading normal {}", point(v.ns)) };
    let _ = writeln!(text, "              normal {}{shading}", point(v.ng));
    let _ = writeln!(text, "              throughput {}", numbers(v.throughput));
}

/// What the pixel received.
fn say_sample(text: &mut String, record: &PathRecord) {
    let Some(sample) = &record.sample else { return };
    let layers = [("direct", sample.direct), ("caustic", sample.caustic), ("indirect", sample.indirect)];
    for (name, value) in layers {
        let _ = writeln!(text, "  {name:<11} {}", numbers(value));
    }
    let _ = writeln!(
        text,
        "  beauty      {}, times the filter's weight {}",
        numbers(sample.beauty()),
        short(sample.weight)
    );
}

/// Six figures.
fn short(value: f32) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    if !value.is_finite() || !(1e-4..1e6).contains(&value.abs()) {
        return format!("{value:.5e}");
    }
    let digits = (5 - value.abs().log10().floor() as i32).max(0) as usize;
    let text = format!("{value:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

fn numbers(values: [f32; 3]) -> String {
    values.map(short).join(" ")
}

fn point(values: [f32; 3]) -> String {
    format!("({})", values.map(short).join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_quoted_where_a_shell_needs_it() {
        let said = ["a.toml", "a b.toml", "it's", "objects.lamp.power=5", "x=[1, 2]", ""].map(quoted);
        assert_eq!(said, ["a.toml", "'a b.toml'", r"'it'\''s'", "objects.lamp.power=5", "'x=[1, 2]'", "''"]);
    }

    #[test]
    fn figures_are_short() {
        let said = [0.0, 1.0, -0.0123456789, 1234.5678, 1e-7, 2.5e9, f32::NAN, f32::INFINITY].map(short);
        assert_eq!(said, ["0", "1", "-0.0123457", "1234.57", "1.00000e-7", "2.50000e9", "NaN", "inf"]);
    }
}
