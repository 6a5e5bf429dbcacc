//! What can be wrong with a description whose every value is right: names, files, geometry without extent.

mod material;
mod shape;

pub(crate) use shape::{step_fault, view_fault};

use std::collections::{BTreeMap, HashMap};
use std::path::Path;

use crate::desc::{
    ColorDesc, EdgeLength, EmissionAmount, FloatDesc, HeightSource, ImageSource, LightKind, MaterialRef,
    Object, PointAmount, SceneDesc, Shape, Texture, TransformStep, Triple,
};
use crate::diagnostic::{Diagnostic, Report, quoted};
use crate::nearest::nearest;
use crate::source::{FileId, Sourced, Span};
use crate::spec::{Kind, LIGHTS, OBJECTS, TEXTURES, Variant};

/// Checks names, files and geometry of a description from anywhere: a scene file, an importer, code. Ranges of single
/// values are the reader's business and not checked again.
///
/// Files are looked for, not opened.
pub fn check(desc: &SceneDesc) -> Vec<Diagnostic> {
    let mut report = Report::default();
    check_into(&mut report, desc, None);
    report.finish()
}

/// As [`check`]; what concerns the whole scene points at `file`.
pub(crate) fn check_into(report: &mut Report, desc: &SceneDesc, file: Option<FileId>) {
    let checker = Checker { desc };
    let whole = file.map(|file| Span { file, start: 0, end: 0 });
    checker.camera(report, whole);
    for (name, texture) in &desc.textures {
        checker.texture(report, name, texture, texture.span);
    }
    checker.texture_cycles(report);
    for (name, material) in &desc.materials {
        checker.material(report, &format!("material {}", quoted(name)), material, material.span);
    }
    unique(report, "object", desc.objects.iter().map(|o| (o.name.as_deref(), o.span)));
    for (index, object) in desc.objects.iter().enumerate() {
        checker.object(report, &called("object", object.name.as_deref(), index), object);
    }
    unique(report, "light", desc.lights.iter().map(|l| (l.name.as_deref(), l.span)));
    for (index, light) in desc.lights.iter().enumerate() {
        checker.light(report, &called("light", light.name.as_deref(), index), &light.kind, light.span);
    }
    for (name, group) in &desc.groups {
        for (index, object) in group.objects.iter().enumerate() {
            let what =
                format!("{} of group {}", called("object", object.name.as_deref(), index), quoted(name));
            checker.object(report, &what, object);
        }
    }
    unique(report, "instance", desc.instances.iter().map(|i| (i.name.as_deref(), i.span)));
    for (index, instance) in desc.instances.iter().enumerate() {
        let what = called("instance", instance.name.as_deref(), index);
        checker.named(report, "group", &what, &instance.group, &desc.groups);
        checker.material_ref(report, &what, instance.material.as_ref());
        steps(report, &what, &instance.transform, instance.span);
    }
    checker.emptiness(report, whole);
}

fn called(noun: &str, name: Option<&str>, index: usize) -> String {
    match name {
        Some(name) => format!("{noun} {}", quoted(name)),
        None => format!("{noun} {}", index + 1),
    }
}

fn unique<'a>(report: &mut Report, noun: &str, names: impl Iterator<Item = (Option<&'a str>, Option<Span>)>) {
    let mut seen: HashMap<&str, Option<Span>> = HashMap::new();
    for (name, span) in names {
        let Some(name) = name else { continue };
        if let Some(first) = seen.get(name) {
            let message = format!("two {noun}s are named {}", quoted(name));
            report.push(Diagnostic::error("duplicate-name", message).at(span).label(*first, "the first"));
        } else {
            seen.insert(name, span);
        }
    }
}

fn steps(report: &mut Report, what: &str, transform: &[TransformStep], span: Option<Span>) {
    for (i, step) in transform.iter().enumerate() {
        if let Some(fault) = step_fault(step) {
            let message = format!("{fault} in step {} of `transform` of {what}", i + 1);
            report.push(Diagnostic::error("degenerate", message).at(span));
        }
    }
}

struct Checker<'a> {
    desc: &'a SceneDesc,
}

impl Checker<'_> {
    fn camera(&self, report: &mut Report, whole: Option<Span>) {
        let Some(camera) = &self.desc.camera else {
            report.push(
                Diagnostic::error("no-camera", "the scene has no camera")
                    .at(whole)
                    .help("add [camera] with `position` and `look_at`"),
            );
            return;
        };
        if let Some(fault) = view_fault(camera.position, camera.look_at, camera.up) {
            report.push(Diagnostic::error("degenerate", format!("{fault} in [camera]")).at(camera.span));
        }
    }

    /// A name that must be a key of `known`.
    fn named<T>(
        &self,
        report: &mut Report,
        noun: &'static str,
        what: &str,
        name: &Sourced<String>,
        known: &BTreeMap<String, T>,
    ) {
        if known.contains_key(&name.value) || report.count_if_full() {
            return;
        }
        let code = match noun {
            "material" => "unknown-material",
            "texture" => "unknown-texture",
            _ => "unknown-group",
        };
        let help = match nearest(name, known.keys().map(String::as_str)) {
            Some(near) => format!("did you mean {}?", quoted(near)),
            None if noun == "material" && crate::preset::find(name).is_some() => {
                format!("there is a preset of this name: {{ preset = \"{}\" }}", name.value)
            }
            None if known.is_empty() => format!("the scene has no {noun}s; add [{noun}s.NAME]"),
            None => {
                let all: Vec<_> = known.keys().take(12).map(|name| quoted(name)).collect();
                let more = if known.len() > all.len() { ", …" } else { "" };
                format!("the scene has the {noun}s {}{more}", all.join(", "))
            }
        };
        let message = format!("unknown {noun} {} in {what}", quoted(name));
        report.push(Diagnostic::error(code, message).at(name.span).help(help));
    }

    fn texture_name(&self, report: &mut Report, what: &str, name: &Sourced<String>) {
        self.named(report, "texture", what, name, &self.desc.textures);
    }

    fn color(&self, report: &mut Report, what: &str, color: &ColorDesc) {
        if let ColorDesc::Texture(name) = color {
            self.texture_name(report, what, name);
        }
    }

    fn float(&self, report: &mut Report, what: &str, float: &FloatDesc) {
        if let FloatDesc::Texture(name) = float {
            self.texture_name(report, what, name);
        }
    }

    fn file<P: AsRef<Path>>(&self, report: &mut Report, what: &str, file: &Sourced<P>, formats: &[&str]) {
        let written = file.value.as_ref();
        let path = self.desc.resolve(written);
        let name = path.file_name().map(|name| name.to_string_lossy().to_lowercase()).unwrap_or_default();
        // Some extensions have two parts.
        if !formats.iter().any(|format| name.strip_suffix(format).is_some_and(|stem| stem.ends_with('.'))) {
            let message = format!("{} of {what} is of no known format", quoted(&written.to_string_lossy()));
            let help = format!("known are .{}", formats.join(", ."));
            report.push(Diagnostic::error("unknown-format", message).at(file.span).help(help));
        }
        let reason = match std::fs::metadata(&path) {
            Ok(meta) if meta.is_file() => return,
            Ok(meta) if meta.is_dir() => "is a folder".to_owned(),
            Ok(_) => "is no ordinary file".to_owned(),
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => "is not there".to_owned(),
            Err(error) => format!("cannot be read: {error}"),
        };
        let message = format!("the file {} of {what} {reason}", quoted(&written.to_string_lossy()));
        let help = written.is_relative().then(|| match self.desc.base.as_os_str().is_empty() {
            true => "file names start from the folder of the scene file".to_owned(),
            false => format!("it was looked for at {}", quoted(&path.to_string_lossy())),
        });
        report.push(Diagnostic::error("missing-file", message).at(file.span).maybe_help(help));
    }

    fn image(
        &self,
        report: &mut Report,
        what: &str,
        source: &ImageSource,
        variant: Option<&'static Variant>,
    ) {
        if let Some(file) = source.file() {
            self.file(report, what, file, extensions(variant));
        }
    }

    fn texture(&self, report: &mut Report, name: &str, texture: &Texture, span: Option<Span>) {
        let what = format!("texture {}", quoted(name));
        match texture {
            Texture::Image(image) => self.image(report, &what, &image.source, TEXTURES.variant("image")),
            Texture::Noise(noise) => steps(report, &what, &noise.transform, span),
            other => other.parts().iter().for_each(|name| self.texture_name(report, &what, name)),
        }
    }

    /// A texture that is, by way of others, made of itself has no colour.
    fn texture_cycles(&self, report: &mut Report) {
        #[derive(Clone, Copy, PartialEq)]
        enum Mark {
            Open,
            Done,
        }
        let parts =
            |name: &str| self.desc.textures.get(name).map(|texture| texture.parts()).unwrap_or_default();
        let mut marks: HashMap<&str, Mark> = HashMap::new();
        for root in self.desc.textures.keys() {
            if marks.contains_key(root.as_str()) {
                continue;
            }
            // Depth first without recursion: a chain may be long.
            let mut stack = vec![(root.as_str(), parts(root))];
            marks.insert(root, Mark::Open);
            while let Some((name, left)) = stack.last_mut() {
                let Some(next) = left.pop() else {
                    marks.insert(name, Mark::Done);
                    stack.pop();
                    continue;
                };
                match marks.get(next.as_str()) {
                    Some(Mark::Done) => {}
                    Some(Mark::Open) => {
                        let message = format!("texture {} is made of itself", quoted(next));
                        report.push(Diagnostic::error("texture-cycle", message).at(next.span));
                    }
                    None => {
                        marks.insert(next.as_str(), Mark::Open);
                        stack.push((next.as_str(), parts(next)));
                    }
                }
            }
        }
    }

    fn material_ref(&self, report: &mut Report, what: &str, material: Option<&MaterialRef>) {
        match material {
            Some(MaterialRef::Named(name)) => {
                self.named(report, "material", what, name, &self.desc.materials)
            }
            Some(MaterialRef::Inline(material)) => {
                self.material(report, &format!("the material of {what}"), material, None);
            }
            None => {}
        }
    }

    fn object(&self, report: &mut Report, what: &str, object: &Sourced<Object>) {
        self.material_ref(report, what, object.material.as_ref());
        if object.material.is_none() && object.emission.is_none() {
            report.push(
                Diagnostic::error("missing-material", format!("{what} has no material"))
                    .at(object.span)
                    .help("give `material`, or `radiance` or `power` to make it a lamp"),
            );
        }
        if let Shape::Mesh { file, .. } = &object.shape.value {
            self.file(report, what, file, extensions(OBJECTS.variant("mesh")));
        }
        if let Shape::HeightField(field) = &object.shape.value
            && let HeightSource::Picture(file) = &field.source
        {
            self.file(report, what, file, extensions(OBJECTS.variant("height-field")));
        }
        if let Some((code, fault)) = shape::shape_fault(&object.shape) {
            let light = if object.emission.is_some() && code == "degenerate" {
                ": a light needs an area"
            } else {
                ""
            };
            report.push(Diagnostic::error(code, format!("{fault} in {what}{light}")).at(object.shape.span));
        }
        if let Some(name) = object.emission.as_ref().and_then(|emission| emission.texture.as_ref()) {
            self.texture_name(report, what, name);
        }
        if let Some(emission) = &object.emission
            && let EmissionAmount::Power { watts, color } = emission.amount
        {
            power(report, what, watts, color, emission.span);
        }
        if let Some(displacement) = &object.displacement {
            self.texture_name(report, &format!("the displacement of {what}"), &displacement.texture);
            let (EdgeLength::Units(edge) | EdgeLength::Pixels(edge)) = displacement.edge;
            let finite = displacement.scale.is_finite() && displacement.midlevel.is_finite();
            if !(finite && edge > 0.0 && edge.is_finite()) {
                let message = format!(
                    "the numbers of the displacement of {what} are not finite, or its edges have no length"
                );
                report.push(Diagnostic::error("out-of-range", message).at(displacement.span));
            }
        }
        steps(report, what, &object.transform, object.span);
    }

    fn light(&self, report: &mut Report, what: &str, kind: &LightKind, span: Option<Span>) {
        let direction = match kind {
            LightKind::Spot { direction, .. } | LightKind::Directional { direction, .. } => Some(direction),
            LightKind::SunSky(sky) => Some(&sky.sun_direction),
            _ => None,
        };
        if direction.is_some_and(|d| !shape::has_length(*d)) {
            report.push(
                Diagnostic::error("degenerate", format!("the direction of {what} has no length")).at(span),
            );
        }
        match kind {
            LightKind::Sky { source, transform, .. }
            | LightKind::Goniometric { source, transform, .. }
            | LightKind::Projector { source, transform, .. } => {
                self.image(report, what, source, LIGHTS.variant("environment"));
                steps(report, what, transform, span);
            }
            LightKind::Profile { file, transform, .. } => {
                self.file(report, what, file, &["ies", "ldt"]);
                steps(report, what, transform, span);
            }
            LightKind::SunSky(sky) => steps(report, what, &sky.transform, span),
            LightKind::Point { .. }
            | LightKind::Spot { .. }
            | LightKind::Directional { .. }
            | LightKind::Environment { .. } => {}
        }
        if let LightKind::Point { amount, .. } | LightKind::Spot { amount, .. } = kind
            && let PointAmount::Power { watts, color } = amount
        {
            power(report, what, *watts, *color, span);
        }
    }

    /// Not after an error: what is missing may have been misspelt.
    fn emptiness(&self, report: &mut Report, whole: Option<Span>) {
        if report.has_error() {
            return;
        }
        let desc = self.desc;
        if desc.objects.is_empty() && desc.instances.is_empty() {
            report.push(
                Diagnostic::warning("empty-scene", "the scene has no object")
                    .at(whole)
                    .help("add [[objects]]"),
            );
        }
        let placed = |name: &str| desc.instances.iter().any(|instance| instance.group.value == name);
        let in_groups = desc
            .groups
            .iter()
            .filter(|(_, group)| group.objects.iter().any(|object| object.emission.is_some()))
            .any(|(name, _)| placed(name));
        let surfaces = desc.objects.iter().any(|object| object.emission.is_some());
        if desc.lights.is_empty() && !surfaces && !in_groups {
            report.push(
                Diagnostic::warning("no-light", "nothing emits light: the picture will be black")
                    .at(whole)
                    .help("add [[lights]], or give an object `radiance` or `power`"),
            );
        }
    }
}

fn power(report: &mut Report, what: &str, watts: f32, color: Triple, span: Option<Span>) {
    let finite = crate::desc::channel_power(watts, color).iter().all(|x| x.is_finite() && *x >= 0.0);
    let some = color.iter().any(|x| *x > 0.0);
    if !(watts > 0.0 && some && finite) {
        report.push(
            Diagnostic::error("out-of-range", format!("the power of {what} is not > 0 and finite")).at(span),
        );
    }
}

/// The file formats of a kind, from its specification.
fn extensions(variant: Option<&'static Variant>) -> &'static [&'static str] {
    variant
        .and_then(|variant| {
            variant.keys().find_map(|key| match key.kind {
                Kind::File(extensions) => Some(extensions),
                _ => None,
            })
        })
        .unwrap_or(&[])
}
