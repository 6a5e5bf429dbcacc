//! Values replaced in a description that did not come from TOML.
//!
//! What the overrides name is written as TOML, read with and without them, and where the two differ the new value is taken.
//! Lists of vertices and pictures inside of the description are not written: they stay as they are.

use std::path::Path;

use crate::check::check_into;
use crate::desc::{Group, ImageSource, Light, LightKind, Object, SceneDesc, Shape, Texture};
use crate::diagnostic::{Diagnostic, Report};
use crate::include::alone;
use crate::load::{Loaded, read_tree};
use crate::overrides;
use crate::source::{Sourced, Span};
use crate::write::to_toml;

/// Replaces values of a scene that was read from `path`, a file of another program, as [`load`](crate::load()) does in a
/// scene file: names and numbers are those of the TOML that `nephroid convert` would write. What comes of it is checked.
pub fn replace(loaded: Loaded, path: &Path, texts: &[String]) -> Loaded {
    let Loaded { desc: Some(desc), mut diagnostics, mut sources } = loaded else { return loaded };
    let roots: Vec<String> = texts.iter().filter_map(|text| overrides::root(text)).collect();
    let text = to_toml(&sketch(&desc, &roots));
    let file = sources.add(path.with_extension("toml"), text.as_str());
    let mut plain = Report::default();
    let (before, _) = read_tree(&mut plain, alone(&text, file), file, &[], &mut sources);
    if let Some(first) = plain.finish().into_iter().find(Diagnostic::is_error) {
        let message = format!("values of this scene cannot be replaced here: {}", first.message);
        let refused = Diagnostic::error("override", message)
            .at(Span { file, start: 0, end: 0 })
            .help("`nephroid convert` makes a TOML scene of this one");
        diagnostics.push(refused);
        return Loaded { desc: None, diagnostics, sources };
    }
    let mut report = Report::default();
    let (after, _) = read_tree(&mut report, alone(&text, file), file, texts, &mut sources);
    let desc = merged(desc, before, after, &roots);
    if !report.has_error() {
        check_into(&mut report, &desc, Some(file));
    }
    let new = report.finish();
    let failed = new.iter().any(Diagnostic::is_error);
    let known = |d: &Diagnostic| diagnostics.iter().any(|other| other.message == d.message);
    let new: Vec<Diagnostic> = new.into_iter().filter(|d| !known(d)).collect();
    diagnostics.extend(new);
    Loaded { desc: (!failed).then_some(desc), diagnostics, sources }
}

/// Those parts of a description that overrides name, with one triangle for the many of a mesh.
fn sketch(desc: &SceneDesc, roots: &[String]) -> SceneDesc {
    let named = |root: &str| roots.iter().any(|r| r == root);
    let mut out = SceneDesc {
        render: desc.render.clone(),
        film: desc.film.clone(),
        camera: desc.camera.clone(),
        photon_map: desc.photon_map.clone(),
        sppm: desc.sppm.clone(),
        vcm: desc.vcm.clone(),
        ..SceneDesc::default()
    };
    // Any name of a picture file will do for one that is inside.
    let outside = |source: &mut ImageSource| {
        if matches!(source, ImageSource::Embedded(_)) {
            *source = "inside.png".into();
        }
    };
    if named("textures") {
        out.textures = desc.textures.clone();
        for texture in out.textures.values_mut() {
            if let Texture::Image(image) = &mut texture.value {
                outside(&mut image.source);
            }
        }
    }
    if named("materials") {
        out.materials = desc.materials.clone();
    }
    if named("objects") {
        out.objects = desc.objects.iter().map(small).collect();
    }
    if named("lights") {
        out.lights = desc.lights.clone();
        for light in &mut out.lights {
            slide(&mut light.value.kind).into_iter().for_each(outside);
        }
    }
    if named("groups") {
        let group = |group: &Group| Group { objects: group.objects.iter().map(small).collect() };
        out.groups = desc.groups.iter().map(|(name, g)| (name.clone(), group(g).into())).collect();
    }
    if named("instances") {
        out.instances = desc.instances.clone();
    }
    out
}

fn small(object: &Sourced<Object>) -> Sourced<Object> {
    let shape = match &object.shape.value {
        Shape::Triangles { normals, .. } => Shape::Triangles {
            positions: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
            indices: vec![[0, 1, 2]],
            vertex_normals: Vec::new(),
            uvs: Vec::new(),
            uvs2: Vec::new(),
            colors: Vec::new(),
            normals: *normals,
        },
        shape => shape.clone(),
    };
    Object {
        name: object.name.clone(),
        shape: shape.into(),
        material: object.material.clone(),
        transform: object.transform.clone(),
        displacement: object.displacement.clone(),
        flip_normals: object.flip_normals,
        emission: object.emission.clone(),
        light_group: object.light_group.clone(),
    }
    .into()
}

/// The description, with what differs before and after.
fn merged(desc: SceneDesc, before: SceneDesc, after: SceneDesc, roots: &[String]) -> SceneDesc {
    let named = |root: &str| roots.iter().any(|r| r == root);
    let mut out = SceneDesc {
        render: after.render,
        film: after.film,
        camera: if before.camera == after.camera { desc.camera } else { after.camera },
        photon_map: after.photon_map,
        sppm: after.sppm,
        vcm: after.vcm,
        ..desc
    };
    if named("textures") {
        let entries = after.textures.into_iter().map(|(name, mut new)| {
            let (old, read) = (out.textures.remove(&name), before.textures.get(&name));
            match (old, read) {
                (Some(old), Some(read)) if *read == new => (name, old),
                (Some(old), Some(read)) => {
                    keep_picture(&mut new, read, &old);
                    (name, new)
                }
                _ => (name, new),
            }
        });
        out.textures = entries.collect();
    }
    if named("materials") {
        let entries = after.materials.into_iter().map(|(name, new)| {
            match (out.materials.remove(&name), before.materials.get(&name)) {
                (Some(old), Some(read)) if *read == new => (name, old),
                _ => (name, new),
            }
        });
        out.materials = entries.collect();
    }
    if named("objects") {
        out.objects = objects(out.objects, &before.objects, after.objects);
    }
    if named("lights") {
        let old = std::mem::take(&mut out.lights);
        let lights = after.lights.into_iter().zip(old).zip(&before.lights).map(|((mut new, old), read)| {
            if *read == new {
                return old;
            }
            keep_slide(&mut new, read, &old);
            new
        });
        out.lights = lights.collect();
    }
    if named("groups") {
        let entries = after.groups.into_iter().map(|(name, mut new)| {
            if let (Some(old), Some(read)) = (out.groups.remove(&name), before.groups.get(&name)) {
                let new_objects = std::mem::take(&mut new.value.objects);
                new.value.objects = objects(old.value.objects, &read.objects, new_objects);
            }
            (name, new)
        });
        out.groups = entries.collect();
    }
    if named("instances") {
        out.instances = after.instances;
    }
    out
}

fn objects(
    old: Vec<Sourced<Object>>,
    before: &[Sourced<Object>],
    after: Vec<Sourced<Object>>,
) -> Vec<Sourced<Object>> {
    let one = |((mut new, old), read): ((Sourced<Object>, Sourced<Object>), &Sourced<Object>)| {
        if *read == new {
            return old;
        }
        if read.shape == new.shape {
            new.value.shape = old.value.shape;
        }
        new
    };
    after.into_iter().zip(old).zip(before).map(one).collect()
}

/// A picture that was not replaced stays the one inside of the description.
fn keep_picture(new: &mut Texture, read: &Texture, old: &Texture) {
    if let (Texture::Image(new), Texture::Image(read), Texture::Image(old)) = (new, read, old)
        && new.source == read.source
    {
        new.source = old.source.clone();
    }
}

fn keep_slide(new: &mut Light, read: &Light, old: &Light) {
    if slide(&mut new.kind).as_deref() == slide(&mut read.kind.clone()).as_deref()
        && let (Some(new), Some(old)) = (slide(&mut new.kind), slide(&mut old.kind.clone()))
    {
        *new = old.clone();
    }
}

/// The picture of a light.
fn slide(kind: &mut LightKind) -> Option<&mut ImageSource> {
    match kind {
        LightKind::Sky { source, .. }
        | LightKind::Goniometric { source, .. }
        | LightKind::Projector { source, .. } => Some(source),
        LightKind::Point { .. }
        | LightKind::Spot { .. }
        | LightKind::Profile { .. }
        | LightKind::Directional { .. }
        | LightKind::Environment { .. }
        | LightKind::SunSky(_) => None,
    }
}
