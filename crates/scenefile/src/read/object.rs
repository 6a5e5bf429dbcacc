//! Objects, instances and placements.

use super::amount::{self, Amount};
use super::material;
use crate::desc::{
    Brilliant, Displacement, EdgeLength, Emission, EmissionAmount, HeightField, HeightSource, Instance,
    Normals, Object, Shape, TEAPOT_PARTS, TeapotPart, TransformStep, TransformSteps, WaterSurface,
};
use crate::diagnostic::{Diagnostic, Report};
use crate::document::{Entry, Node, Value};
use crate::reader::{Reader, as_table};
use crate::source::{Sourced, Span};
use crate::spec;

/// What stands for a shape after a mistake.
const STAND_IN: Shape = Shape::Sphere { center: [0.0; 3], radius: 1.0 };

/// An object; after a mistake its shape is a stand-in that passes further checks.
pub(super) fn object(report: &mut Report, what: String, node: &Node) -> Object {
    let Some(table) = as_table(report, &what, node) else {
        return Object::new(STAND_IN, crate::desc::Material::diffuse(0.5));
    };
    let r = Reader::new(report, &spec::OBJECTS, what, table, node.span);
    let name = r.optional_text(report, "name");
    let shape = shape(report, &r).unwrap_or(STAND_IN);
    let material = material::reference(report, &r);
    let transform = transform(report, &r);
    let displacement = displacement(report, &r);
    let flip_normals = r.bool(report, "flip_normals");
    let emission = emission(report, &r);
    let light_group = r.optional_text(report, "light_group").flatten().map(|group| group.value);
    let wrong_emission = given_amount(&r).is_some() && emission.is_none();
    Object {
        name: name.flatten().map(|name| name.value),
        shape: Sourced::at(shape, r.given("shape").map_or(node.span, |entry| entry.node.span)),
        // A lamp whose emission is wrong shall not be told to have a material as well.
        material: material.or(wrong_emission.then(|| crate::desc::Material::diffuse(0.0).into())),
        transform,
        displacement,
        flip_normals: flip_normals.unwrap_or(false),
        emission,
        light_group,
    }
}

/// What moves an object's surface; `None` after a mistake, too.
fn displacement(report: &mut Report, r: &Reader<'_>) -> Option<Sourced<Displacement>> {
    let r = r.inner(report, "displacement")??;
    let (texture, scale) = (r.text(report, "texture"), r.number(report, "scale"));
    let midlevel = r.number(report, "midlevel");
    let (length, pixels) =
        (r.optional_number(report, "edge_length"), r.optional_number(report, "edge_pixels"));
    if let (Some(a), Some(b)) = (r.given("edge_length"), r.given("edge_pixels")) {
        r.conflict(report, a, b);
        return None;
    }
    let edge = match (length?, pixels?) {
        (Some(length), _) => EdgeLength::Units(length),
        (None, Some(pixels)) => EdgeLength::Pixels(pixels),
        (None, None) => EdgeLength::DEFAULT,
    };
    let value = Displacement { texture: texture?, scale: scale?, midlevel: midlevel?, edge };
    Some(Sourced { value, span: Some(r.span) })
}

/// Where an object is told to shine.
fn given_amount<'a>(r: &Reader<'a>) -> Option<&'a Entry> {
    ["radiance", "power", "lumens", "nits"].iter().find_map(|key| r.given(key))
}

fn emission(report: &mut Report, r: &Reader<'_>) -> Option<Sourced<Emission>> {
    let amount = amount::amount(report, r, "radiance", &["power", "lumens", "nits"]);
    let texture = r.optional_text(report, "emission_texture");
    let two_sided = r.bool(report, "two_sided_emission");
    let given = given_amount(r);
    for key in ["emission_texture", "two_sided_emission", "light_group"] {
        if let (Some(entry), None) = (r.given(key), given) {
            let message = format!("`{key}` without `radiance` or `power` in {}", r.what);
            report.push(Diagnostic::error("conflict", message).at(entry.key_span));
        }
    }
    let amount = match amount?? {
        Amount::Channels(radiance) => EmissionAmount::Radiance(radiance),
        Amount::Scaled { key: "nits", value, color } => {
            EmissionAmount::Radiance(Amount::channels(value, color))
        }
        Amount::Scaled { key, value, color } => {
            EmissionAmount::Power { watts: Amount::watts(key, value, color), color }
        }
    };
    Some(Sourced {
        value: Emission { amount, texture: texture?, two_sided: two_sided? },
        span: given.map(|entry| entry.node.span),
    })
}

fn shape(report: &mut Report, r: &Reader<'_>) -> Option<Shape> {
    match r.variant()? {
        "sphere" => {
            let (center, radius) = (r.point(report, "center"), r.number(report, "radius"));
            Some(Shape::Sphere { center: center?, radius: radius? })
        }
        "disk" => {
            let (center, normal) = (r.point(report, "center"), r.point(report, "normal"));
            let radius = r.number(report, "radius");
            Some(Shape::Disk { center: center?, normal: normal?, radius: radius? })
        }
        "quad" => quad(report, r),
        "mesh" => {
            let (file, normals) = (r.file(report, "file"), normals(report, r));
            Some(Shape::Mesh { file: file?, normals: normals? })
        }
        "triangles" => {
            let (positions, indices) = (r.points(report, "positions"), r.indices(report, "indices"));
            let (vertex_normals, uvs) = (r.points(report, "vertex_normals"), r.pairs(report, "uvs"));
            let (uvs2, colors) = (r.pairs(report, "uvs2"), r.vertex_colors(report, "colors"));
            let normals = normals(report, r);
            Some(Shape::Triangles {
                positions: positions?,
                indices: indices?,
                vertex_normals: vertex_normals?,
                uvs: uvs?,
                uvs2: uvs2?,
                colors: colors?,
                normals: normals?,
            })
        }
        "box" => {
            let (min, max) = (r.point(report, "min"), r.point(report, "max"));
            Some(Shape::Box { min: min?, max: max? })
        }
        "teapot" => {
            let (level, parts) = (r.integer(report, "level"), r.words(report, "parts"));
            let solid = r.bool(report, "solid");
            if let (Some(a), Some(b), Some(true)) = (r.given("parts"), r.given("solid"), solid) {
                r.conflict(report, a, b);
                return None;
            }
            let parts = match parts? {
                Some(words) => words.into_iter().filter_map(teapot_part).collect(),
                None => TEAPOT_PARTS.to_vec(),
            };
            Some(Shape::Teapot { level: level?, parts, solid: solid? })
        }
        "lathe" => {
            let (profile, segments) = (r.pairs(report, "profile"), r.integer(report, "segments"));
            let (smooth, closed) = (r.bool(report, "smooth"), r.bool(report, "closed"));
            let (steps, crease) = (r.integer(report, "steps"), r.optional_number(report, "crease_angle"));
            let steps: u32 = steps?;
            Some(Shape::Lathe {
                profile: profile?,
                segments: segments?,
                smooth: smooth?,
                closed: closed?,
                steps,
                crease_degrees: crease?.unwrap_or(if steps == 1 { 30.0 } else { 75.0 }),
            })
        }
        "cylinder" => {
            let (base, axis) = (r.point(report, "base"), r.point(report, "axis"));
            let (radius, height) = (r.number(report, "radius"), r.number(report, "height"));
            let (inward, segments) = (r.bool(report, "inward"), r.integer(report, "segments"));
            let closed = r.bool(report, "closed");
            Some(Shape::Cylinder {
                base: base?,
                axis: axis?,
                radius: radius?,
                height: height?,
                inward: inward?,
                closed: closed?,
                segments: segments?,
            })
        }
        "cone" => {
            let (base, axis) = (r.point(report, "base"), r.point(report, "axis"));
            let (radius, top_radius) = (r.number(report, "radius"), r.number(report, "top_radius"));
            let (height, closed) = (r.number(report, "height"), r.bool(report, "closed"));
            let segments = r.integer(report, "segments");
            Some(Shape::Cone {
                base: base?,
                axis: axis?,
                radius: radius?,
                top_radius: top_radius?,
                height: height?,
                closed: closed?,
                segments: segments?,
            })
        }
        "capsule" => {
            let (base, axis) = (r.point(report, "base"), r.point(report, "axis"));
            let (radius, height) = (r.number(report, "radius"), r.number(report, "height"));
            let segments = r.integer(report, "segments");
            Some(Shape::Capsule {
                base: base?,
                axis: axis?,
                radius: radius?,
                height: height?,
                segments: segments?,
            })
        }
        "rounded-box" => {
            let (min, max) = (r.point(report, "min"), r.point(report, "max"));
            let (radius, steps) = (r.number(report, "radius"), r.integer(report, "steps"));
            Some(Shape::RoundedBox { min: min?, max: max?, radius: radius?, steps: steps? })
        }
        "round-brilliant" => brilliant(report, r).map(Shape::RoundBrilliant),
        "height-field" => height_field(report, r).map(Shape::HeightField),
        "water-surface" => water(report, r).map(Shape::WaterSurface),
        "torus" => {
            let (center, axis) = (r.point(report, "center"), r.point(report, "axis"));
            let (major_radius, minor_radius) =
                (r.number(report, "major_radius"), r.number(report, "minor_radius"));
            let (segments, tube_segments) =
                (r.integer(report, "segments"), r.integer(report, "tube_segments"));
            Some(Shape::Torus {
                center: center?,
                axis: axis?,
                major_radius: major_radius?,
                minor_radius: minor_radius?,
                segments: segments?,
                tube_segments: tube_segments?,
            })
        }
        "band" => {
            let inner_radius = r.number(report, "inner_radius");
            let outer_radius = r.number(report, "outer_radius");
            let (height, fillet) = (r.number(report, "height"), r.number(report, "fillet"));
            let segments = r.integer(report, "segments");
            Some(Shape::Band {
                inner_radius: inner_radius?,
                outer_radius: outer_radius?,
                height: height?,
                fillet: fillet?,
                segments: segments?,
            })
        }
        "ring" => Some(Shape::Ring { segments: r.integer(report, "segments")? }),
        "coffee-cup" => Some(Shape::CoffeeCup { segments: r.integer(report, "segments")? }),
        "wine-glass" => Some(Shape::WineGlass { segments: r.integer(report, "segments")? }),
        "wine" => Some(Shape::Wine { segments: r.integer(report, "segments")? }),
        _ => {
            let (center, radius) = (r.point(report, "center"), r.number(report, "radius"));
            let (level, smooth) = (r.integer(report, "level"), r.bool(report, "smooth"));
            Some(Shape::Icosphere { center: center?, radius: radius?, level: level?, smooth: smooth? })
        }
    }
}

fn brilliant(report: &mut Report, r: &Reader<'_>) -> Option<Brilliant> {
    let (center, axis) = (r.point(report, "center"), r.point(report, "axis"));
    let (diameter, table) = (r.number(report, "diameter"), r.number(report, "table"));
    let (crown, pavilion) = (r.number(report, "crown_angle"), r.number(report, "pavilion_angle"));
    let (girdle, star_length) = (r.number(report, "girdle"), r.number(report, "star_length"));
    let (lower, culet) = (r.number(report, "lower_half_length"), r.number(report, "culet"));
    Some(Brilliant {
        center: center?,
        axis: axis?,
        diameter: diameter?,
        table: table?,
        crown_degrees: crown?,
        pavilion_degrees: pavilion?,
        girdle: girdle?,
        star_length: star_length?,
        lower_half_length: lower?,
        culet: culet?,
    })
}

fn height_field(report: &mut Report, r: &Reader<'_>) -> Option<HeightField> {
    let (center, size) = (r.point(report, "center"), r.pair(report, "size"));
    let (height, depth) = (r.number(report, "height"), r.optional_number(report, "depth"));
    let source = match (r.given("file"), r.given("heights")) {
        (Some(a), Some(b)) => {
            r.conflict(report, a, b);
            None
        }
        (Some(_), None) => r.file(report, "file").map(HeightSource::Picture),
        (None, Some(_)) => r.optional_rows(report, "heights").flatten().map(HeightSource::Rows),
        (None, None) => {
            let message = format!("missing `file` or `heights` in {}", r.what);
            report.push(
                Diagnostic::error("missing-key", message)
                    .at(r.span)
                    .help("name a picture, or give rows of numbers"),
            );
            None
        }
    };
    Some(HeightField { center: center?, size: size?, source: source?, height: height?, depth: depth? })
}

fn water(report: &mut Report, r: &Reader<'_>) -> Option<WaterSurface> {
    let (center, size) = (r.point(report, "center"), r.pair(report, "size"));
    let (depth, resolution) = (r.optional_number(report, "depth"), r.integer(report, "resolution"));
    let (wind_speed, wind) = (r.number(report, "wind_speed"), r.number(report, "wind_direction"));
    let (fetch, wave_height) = (r.number(report, "fetch"), r.optional_number(report, "wave_height"));
    let (waves, seed) = (r.integer(report, "waves"), r.integer(report, "seed"));
    let time = r.number(report, "time");
    Some(WaterSurface {
        center: center?,
        size: size?,
        depth: depth?,
        resolution: resolution?,
        wind_speed: wind_speed?,
        wind_degrees: wind?,
        fetch: fetch?,
        wave_height: wave_height?,
        waves: waves?,
        seed: seed?,
        time: time?,
    })
}

fn quad(report: &mut Report, r: &Reader<'_>) -> Option<Shape> {
    let origin = r.optional_point(report, "origin");
    let edge_u = r.optional_point(report, "edge_u");
    let edge_v = r.optional_point(report, "edge_v");
    let corners = r.optional_points(report, "corners");
    let edges = ["origin", "edge_u", "edge_v"];
    if let (Some(a), Some(b)) = (r.given("corners"), edges.iter().find_map(|name| r.given(name))) {
        r.conflict(report, a, b);
        return None;
    }
    if r.given("corners").is_some() {
        let corners = corners??;
        return Some(Shape::Corners {
            corners: [*corners.first()?, *corners.get(1)?, *corners.get(2)?, *corners.get(3)?],
        });
    }
    let absent: Vec<&str> = edges.into_iter().filter(|name| r.given(name).is_none()).collect();
    if absent.len() == edges.len() {
        let message = format!("missing `origin`, `edge_u` and `edge_v` in {}", r.what);
        report.push(Diagnostic::error("missing-key", message).at(r.span).help("or give four `corners`"));
        return None;
    }
    for name in &absent {
        r.missing(report, name);
    }
    Some(Shape::Quad { origin: origin??, edge_u: edge_u??, edge_v: edge_v?? })
}

fn normals(report: &mut Report, r: &Reader<'_>) -> Option<Normals> {
    let word = r.word(report, "normals");
    let crease = r.optional_number(report, "crease_angle");
    let (word, crease) = (word?, crease?);
    if let (Some(entry), true) = (r.given("crease_angle"), word != "smooth") {
        let message = format!("`crease_angle` without normals = \"smooth\" in {}", r.what);
        report.push(Diagnostic::error("conflict", message).at(entry.key_span));
        return None;
    }
    Some(match word {
        "flat" => Normals::Flat,
        "completed" => Normals::Completed,
        "smooth" => Normals::Smooth { crease_degrees: crease.unwrap_or(180.0) },
        _ => Normals::Given,
    })
}

fn teapot_part(name: &str) -> Option<TeapotPart> {
    Some(match name {
        "body" => TeapotPart::Body,
        "handle" => TeapotPart::Handle,
        "spout" => TeapotPart::Spout,
        "lid" => TeapotPart::Lid,
        "bottom" => TeapotPart::Bottom,
        _ => return None,
    })
}

/// The steps of `transform`: a list, or one step alone. Wrong steps are left out.
pub(super) fn transform(report: &mut Report, r: &Reader<'_>) -> TransformSteps {
    let Some(Entry { node, .. }) = r.given("transform") else { return Vec::new() };
    let what = r.label("transform");
    match &node.value {
        Value::Array(items) => items
            .iter()
            .enumerate()
            .filter_map(|(i, item)| step(report, format!("step {} of {what}", i + 1), item))
            .collect(),
        Value::Table(_) => step(report, what, node).into_iter().collect(),
        _ => {
            crate::convert::wrong_type(report, &what, &spec::Kind::Transform.text(), node);
            Vec::new()
        }
    }
}

fn step(report: &mut Report, what: String, node: &Node) -> Option<TransformStep> {
    let table = as_table(report, &what, node)?;
    let r = Reader::new(report, &spec::TRANSFORM, what, table, node.span);
    let (first, second) = (table.entries.first(), table.entries.get(1));
    let Some(first) = first else {
        let names: Vec<_> = spec::TRANSFORM.keys.iter().map(|key| key.name).collect();
        let message = format!("{} is empty", r.what);
        report.push(
            Diagnostic::error("missing-key", message)
                .at(node.span)
                .help(format!("a step is one of {}", names.join(", "))),
        );
        return None;
    };
    if let Some(second) = second {
        let message = format!("{} has several keys: their order would not count", r.what);
        report.push(
            Diagnostic::error("conflict", message)
                .at(second.key_span)
                .help(format!("write [{{ {} = … }}, {{ {} = … }}]", first.key, second.key)),
        );
        return None;
    }
    match first.key.as_str() {
        "translate" => r.point(report, "translate").map(TransformStep::Translate),
        "scale" => r.factors(report, "scale").map(TransformStep::Scale),
        "matrix" => {
            r.matrix(report, "matrix").and_then(|matrix| affine(report, matrix, &r.what, first.node.span))
        }
        "rotate" => {
            let r = r.inner(report, "rotate")??;
            let (axis, degrees) = (r.point(report, "axis"), r.number(report, "degrees"));
            Some(TransformStep::Rotate { axis: axis?, degrees: degrees? })
        }
        "look_at" => {
            let r = r.inner(report, "look_at")??;
            let (position, target, up) =
                (r.point(report, "position"), r.point(report, "target"), r.point(report, "up"));
            let (position, target, up) = (position?, target?, up?);
            if let Some(reason) = crate::check::view_fault(position, target, up) {
                let message = format!("{reason} in {}", r.what);
                report.push(Diagnostic::error("degenerate", message).at(first.node.span));
                return None;
            }
            Some(TransformStep::LookAt { position, target, up })
        }
        _ => None,
    }
}

fn affine(report: &mut Report, matrix: [f32; 16], what: &str, span: Span) -> Option<TransformStep> {
    let step = TransformStep::Matrix(matrix);
    if let Some(reason) = crate::check::step_fault(&step) {
        report.push(Diagnostic::error("degenerate", format!("{reason} in {what}")).at(span));
        return None;
    }
    Some(step)
}

pub(super) fn instance(report: &mut Report, what: String, node: &Node) -> Option<Instance> {
    let table = as_table(report, &what, node)?;
    let r = Reader::new(report, &spec::INSTANCES, what, table, node.span);
    let name = r.optional_text(report, "name");
    let group = r.text(report, "group");
    let transform = transform(report, &r);
    let material = material::reference(report, &r);
    Some(Instance { name: name.flatten().map(|name| name.value), group: group?, transform, material })
}
