//! Scenes of other programs as [`SceneDesc`](scenefile::SceneDesc)s.
//!
//! [`load`] reads what Nephroid knows, by the file's extension: its own TOML, pbrt-v4 (v3 where its names differ),
//! Mitsuba 3 (0.6 where it differs), glTF 2.0, and the mesh files OBJ, PLY and STL.
//! What a format has and Nephroid does not is said once, with its place and what is done instead, as a warning.
//! [`outsource`] moves large meshes of a description into PLY files, so that it can be written as TOML.

mod absent;
mod curve;
mod file;
mod foreign;
mod gltf;
mod matrix;
mod mitsuba;
mod names;
mod obj;
mod outsource;
mod pbrt;
mod picture;
mod ply;
mod report;
mod spectrum;
mod stage;
mod studio;
mod surfaces;

use std::path::Path;

use scenefile::{Diagnostic, Loaded, Severity, Sources, Span};

use stage::Ground;

pub use outsource::{OutsourceError, outsource};

/// Reads a scene in any known format: `.pbrt` and `.pbrt.gz` as pbrt, `.xml` as Mitsuba's, `.gltf` and `.glb` as glTF,
/// `.obj`, `.ply` and `.stl` as meshes, everything else as TOML.
///
/// Files of other programs are refused with what to export; a file that is not there with the name of one that may be meant.
///
/// Models (glTF, OBJ, PLY, STL) that lack a camera, a light or both are given a view of the whole, a studio and a ground, which is said
/// as notes; `stage.ground=false` among `overrides` leaves the ground out, `=true` lays one in any case. Other scenes have none:
/// for them the first is a note, the second an error.
///
/// `overrides` replace values, as [`scenefile::load`] takes them; of scenes of other programs those of the description
/// ([`scenefile::replace`]). With Mitsuba's a name without a table is that of a `<default>`.
/// Never panics; memory is bounded by the size of the files.
pub fn load(path: &Path, overrides: &[String]) -> Loaded {
    let format = Format::of(path);
    let foreign = || (format == Format::Native).then(|| foreign::refusal(path)).flatten();
    if let Some(refusal) = absent::refusal(path).or_else(foreign) {
        return refused(path, refusal);
    }
    let (ground, overrides) = match Ground::take(overrides) {
        Ok((Some(Ground::Laid), _)) if !format.is_model() => return refused(path, no_model(path)),
        Ok(taken) => taken,
        Err(diagnostic) => return refused(path, diagnostic),
    };
    let mut loaded = load_as(format, path, ground.unwrap_or_default(), overrides);
    if ground.is_some() && !format.is_model() {
        loaded.diagnostics.push(Diagnostic::note("ground", "no ground is laid under this scene in any case"));
    }
    loaded
}

/// A scene that is not read.
fn refused(path: &Path, why: Diagnostic) -> Loaded {
    let mut sources = Sources::default();
    let file = sources.add(path, "");
    Loaded { desc: None, diagnostics: vec![why.at(Span { file, start: 0, end: 0 })], sources }
}

fn no_model(path: &Path) -> Diagnostic {
    let message = format!("no ground can be laid under {}: it is a whole scene, not a model", path.display());
    Diagnostic::error("override", message)
        .help("models are glTF, OBJ, PLY and STL files; in a scene of your own, add a [[objects]] table with a `quad` or a `disk`")
}

fn load_as(format: Format, path: &Path, ground: Ground, overrides: Vec<String>) -> Loaded {
    // Defaults of Mitsuba's scenes have names without a table.
    let is_default = |text: &&String| format == Format::Mitsuba && !names_a_table(text);
    let (defaults, overrides): (Vec<String>, Vec<String>) =
        overrides.into_iter().partition(|t| is_default(&t));
    let loaded = match format {
        Format::Native => return scenefile::load(path, &overrides),
        Format::Mitsuba => mitsuba::load(path, &defaults),
        Format::Pbrt => pbrt::load(path),
        Format::Gltf => gltf::load(path, ground),
        Format::Obj => obj::load(path, ground),
        Format::Ply => ply::load(path, ply::Kind::Ply, ground),
        Format::Stl => ply::load(path, ply::Kind::Stl, ground),
    };
    if overrides.is_empty() { loaded } else { scenefile::replace(loaded, path, &overrides) }
}

/// Whether an override's name begins with a table of our own scenes.
fn names_a_table(text: &str) -> bool {
    let name = text.split('=').next().unwrap_or_default();
    name.split_once('.').is_some_and(|(table, _)| scenefile::spec::section(table.trim()).is_some())
}

/// Turns every warning into an error, after which there is no description if there was any.
pub fn strict(loaded: Loaded) -> Loaded {
    let doubtful = loaded.diagnostics.iter().any(|d| d.severity != Severity::Note);
    let harder = |d: Diagnostic| match d.severity {
        Severity::Note => d,
        Severity::Warning | Severity::Error => Diagnostic { severity: Severity::Error, ..d },
    };
    let diagnostics = loaded.diagnostics.into_iter().map(harder).collect();
    Loaded { desc: loaded.desc.filter(|_| !doubtful), diagnostics, ..loaded }
}

/// Who made a scene file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Nephroid: TOML.
    Native,
    /// pbrt-v4 or v3.
    Pbrt,
    /// Mitsuba 3 or 0.6.
    Mitsuba,
    /// glTF 2.0, text or binary.
    Gltf,
    /// A Wavefront model.
    Obj,
    /// A mesh in PLY.
    Ply,
    /// A mesh in STL, text or binary.
    Stl,
}

impl Format {
    /// Whether files of it are often things alone, without camera and light.
    fn is_model(self) -> bool {
        match self {
            Self::Gltf | Self::Obj | Self::Ply | Self::Stl => true,
            Self::Native | Self::Pbrt | Self::Mitsuba => false,
        }
    }

    /// By the file's extension.
    pub fn of(path: &Path) -> Self {
        let name = path.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
        let is = |extension: &str| name.ends_with(extension);
        match () {
            () if is(".pbrt") || is(".pbrt.gz") => Self::Pbrt,
            () if is(".xml") => Self::Mitsuba,
            () if is(".gltf") || is(".glb") => Self::Gltf,
            () if is(".obj") => Self::Obj,
            () if is(".ply") => Self::Ply,
            () if is(".stl") => Self::Stl,
            () => Self::Native,
        }
    }
}
