//! Shapes.

use super::fields;
use super::value::{Fields, number, quote, triple};
use crate::desc::{HeightSource, Normals, Shape, TEAPOT_PARTS, TeapotPart};
use crate::spec;

/// The fields of a shape.
pub(super) fn shape_fields(shape: &Shape) -> Fields {
    let new = |kind| fields(&spec::OBJECTS, Some(kind));
    let round = |kind, segments: u32| {
        let mut f = new(kind);
        f.integer("segments", segments);
        f
    };
    match shape {
        Shape::Sphere { center, radius } => {
            let mut f = new("sphere");
            f.triple("center", *center);
            f.number("radius", *radius);
            f
        }
        Shape::Disk { center, normal, radius } => {
            let mut f = new("disk");
            f.triple("center", *center);
            f.triple("normal", *normal);
            f.number("radius", *radius);
            f
        }
        Shape::Quad { origin, edge_u, edge_v } => {
            let mut f = new("quad");
            f.triple("origin", *origin);
            f.triple("edge_u", *edge_u);
            f.triple("edge_v", *edge_v);
            f
        }
        Shape::Corners { corners } => {
            let mut f = new("quad");
            f.list("corners", corners, |p| triple(*p));
            f
        }
        Shape::Mesh { file, normals } => {
            let mut f = new("mesh");
            f.text("file", &file.to_string_lossy());
            normals_fields(&mut f, *normals);
            f
        }
        Shape::Triangles { positions, indices, vertex_normals, uvs, uvs2, colors, normals } => {
            let mut f = new("triangles");
            f.list("positions", positions, |p| triple(*p));
            f.list("indices", indices, |t| format!("[{}, {}, {}]", t[0], t[1], t[2]));
            if !vertex_normals.is_empty() {
                f.list("vertex_normals", vertex_normals, |n| triple(*n));
            }
            for (key, uvs) in [("uvs", uvs), ("uvs2", uvs2)] {
                if !uvs.is_empty() {
                    f.list(key, uvs, |uv| format!("[{}, {}]", number(uv[0]), number(uv[1])));
                }
            }
            if !colors.is_empty() {
                f.list("colors", colors, |c| format!("[{}]", c.map(number).join(", ")));
            }
            normals_fields(&mut f, *normals);
            f
        }
        Shape::Box { min, max } => {
            let mut f = new("box");
            f.triple("min", *min);
            f.triple("max", *max);
            f
        }
        Shape::Teapot { level, parts, solid } => {
            let mut f = new("teapot");
            f.integer("level", *level);
            if parts[..] != TEAPOT_PARTS && !solid {
                f.list("parts", parts, |part| quote(part_name(*part)));
            }
            f.bool("solid", *solid);
            f
        }
        Shape::Lathe { profile, segments, smooth, closed, steps, crease_degrees } => {
            let mut f = new("lathe");
            f.list("profile", profile, |p| format!("[{}, {}]", number(p[0]), number(p[1])));
            f.integer("segments", *segments);
            f.bool("smooth", *smooth);
            f.bool("closed", *closed);
            f.integer("steps", *steps);
            f.number("crease_angle", *crease_degrees);
            f
        }
        Shape::Cylinder { base, axis, radius, height, inward, closed, segments } => {
            let mut f = new("cylinder");
            f.triple("base", *base);
            f.triple("axis", *axis);
            f.number("radius", *radius);
            f.number("height", *height);
            f.bool("inward", *inward);
            f.bool("closed", *closed);
            f.integer("segments", *segments);
            f
        }
        Shape::Cone { base, axis, radius, top_radius, height, closed, segments } => {
            let mut f = new("cone");
            f.triple("base", *base);
            f.triple("axis", *axis);
            f.number("radius", *radius);
            f.number("top_radius", *top_radius);
            f.number("height", *height);
            f.bool("closed", *closed);
            f.integer("segments", *segments);
            f
        }
        Shape::Capsule { base, axis, radius, height, segments } => {
            let mut f = new("capsule");
            f.triple("base", *base);
            f.triple("axis", *axis);
            f.number("radius", *radius);
            f.number("height", *height);
            f.integer("segments", *segments);
            f
        }
        Shape::RoundedBox { min, max, radius, steps } => {
            let mut f = new("rounded-box");
            f.triple("min", *min);
            f.triple("max", *max);
            f.number("radius", *radius);
            f.integer("steps", *steps);
            f
        }
        Shape::RoundBrilliant(gem) => {
            let mut f = new("round-brilliant");
            f.triple("center", gem.center);
            f.triple("axis", gem.axis);
            f.number("diameter", gem.diameter);
            f.number("table", gem.table);
            f.number("crown_angle", gem.crown_degrees);
            f.number("pavilion_angle", gem.pavilion_degrees);
            f.number("girdle", gem.girdle);
            f.number("star_length", gem.star_length);
            f.number("lower_half_length", gem.lower_half_length);
            f.number("culet", gem.culet);
            f
        }
        Shape::HeightField(field) => {
            let mut f = new("height-field");
            f.triple("center", field.center);
            f.pair("size", field.size.map(number));
            match &field.source {
                HeightSource::Picture(file) => f.text("file", &file.to_string_lossy()),
                HeightSource::Rows(rows) => f.list("heights", rows, |row| {
                    format!("[{}]", row.iter().map(|x| number(*x)).collect::<Vec<_>>().join(", "))
                }),
            }
            f.number("height", field.height);
            f.optional_number("depth", field.depth);
            f
        }
        Shape::WaterSurface(water) => {
            let mut f = new("water-surface");
            f.triple("center", water.center);
            f.pair("size", water.size.map(number));
            f.optional_number("depth", water.depth);
            f.integer("resolution", water.resolution);
            f.number("wind_speed", water.wind_speed);
            f.number("wind_direction", water.wind_degrees);
            f.number("fetch", water.fetch);
            f.optional_number("wave_height", water.wave_height);
            f.integer("waves", water.waves);
            f.integer("seed", water.seed);
            f.number("time", water.time);
            f
        }
        Shape::Torus { center, axis, major_radius, minor_radius, segments, tube_segments } => {
            let mut f = new("torus");
            f.triple("center", *center);
            f.triple("axis", *axis);
            f.number("major_radius", *major_radius);
            f.number("minor_radius", *minor_radius);
            f.integer("segments", *segments);
            f.integer("tube_segments", *tube_segments);
            f
        }
        Shape::Icosphere { center, radius, level, smooth } => {
            let mut f = new("icosphere");
            f.triple("center", *center);
            f.number("radius", *radius);
            f.integer("level", *level);
            f.bool("smooth", *smooth);
            f
        }
        Shape::Band { inner_radius, outer_radius, height, fillet, segments } => {
            let mut f = new("band");
            f.number("inner_radius", *inner_radius);
            f.number("outer_radius", *outer_radius);
            f.number("height", *height);
            f.number("fillet", *fillet);
            f.integer("segments", *segments);
            f
        }
        Shape::Ring { segments } => round("ring", *segments),
        Shape::CoffeeCup { segments } => round("coffee-cup", *segments),
        Shape::WineGlass { segments } => round("wine-glass", *segments),
        Shape::Wine { segments } => round("wine", *segments),
    }
}

fn normals_fields(f: &mut Fields, normals: Normals) {
    match normals {
        Normals::Given => {}
        Normals::Flat => f.word("normals", "flat"),
        Normals::Completed => f.word("normals", "completed"),
        Normals::Smooth { crease_degrees } => {
            f.word("normals", "smooth");
            if crease_degrees != 180.0 {
                f.number("crease_angle", crease_degrees);
            }
        }
    }
}

fn part_name(part: TeapotPart) -> &'static str {
    match part {
        TeapotPart::Body => "body",
        TeapotPart::Handle => "handle",
        TeapotPart::Spout => "spout",
        TeapotPart::Lid => "lid",
        TeapotPart::Bottom => "bottom",
    }
}
