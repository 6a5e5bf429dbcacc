//! Shapes, views and placements without extent.

use crate::desc::{HeightField, HeightSource, Shape, TransformStep, Triple, WaterSurface};

/// Triangles that one object may make of a formula.
const MOST_TRIANGLES: u64 = 1 << 26;
/// Waves times cells that one water may have: some ten seconds of adding up.
const MOST_WAVE_CELLS: u64 = 1 << 33;
/// Two directions this close to parallel, as the sine of their angle, span no plane.
const PARALLEL: f64 = 1e-6;

fn sub(a: Triple, b: Triple) -> [f64; 3] {
    [0, 1, 2].map(|i| a[i] as f64 - b[i] as f64)
}

fn wide(a: Triple) -> [f64; 3] {
    a.map(f64::from)
}

fn length(a: [f64; 3]) -> f64 {
    a.iter().map(|x| x * x).sum::<f64>().sqrt()
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Whether two vectors span no plane, or are not finite.
fn parallel(a: [f64; 3], b: [f64; 3]) -> bool {
    let area = length(cross(a, b));
    !(area.is_finite() && area > PARALLEL * length(a) * length(b))
}

pub(crate) fn has_length(a: Triple) -> bool {
    let length = length(wide(a));
    length.is_finite() && length > 0.0
}

/// What is wrong with a camera's place and direction.
pub(crate) fn view_fault(position: Triple, target: Triple, up: Triple) -> Option<&'static str> {
    let view = sub(target, position);
    if !(length(view).is_finite() && length(view) > 0.0) {
        Some("the view has no direction: the target is the position")
    } else if !has_length(up) {
        Some("`up` has no length")
    } else if parallel(view, wide(up)) {
        Some("`up` is parallel to the view")
    } else {
        None
    }
}

/// What is wrong with one step of a placement.
pub(crate) fn step_fault(step: &TransformStep) -> Option<&'static str> {
    match step {
        TransformStep::Translate(by) => {
            (!by.iter().all(|x| x.is_finite())).then_some("the way is not finite")
        }
        TransformStep::Rotate { axis, degrees } => {
            (!has_length(*axis) || !degrees.is_finite()).then_some("the axis has no length")
        }
        TransformStep::Scale(by) => {
            (!by.iter().all(|x| x.is_finite() && *x != 0.0)).then_some("a factor is 0: it would flatten")
        }
        TransformStep::LookAt { position, target, up } => view_fault(*position, *target, *up),
        TransformStep::Matrix(m) => {
            let row = |i: usize| [m[4 * i] as f64, m[4 * i + 1] as f64, m[4 * i + 2] as f64];
            if m[12..] != [0.0, 0.0, 0.0, 1.0] {
                return Some("the last row of the matrix is not 0 0 0 1");
            }
            let normal = cross(row(0), row(1));
            let determinant: f64 = (0..3).map(|i| normal[i] * row(2)[i]).sum();
            let volume = length(row(0)) * length(row(1)) * length(row(2));
            let singular = !(determinant.is_finite() && determinant.abs() > 1e-12 * volume);
            singular.then_some("the matrix is singular: it would flatten")
        }
    }
}

/// A code of [`CODES`](crate::diagnostic::CODES) and what is wrong with a shape.
pub(crate) fn shape_fault(shape: &Shape) -> Option<(&'static str, String)> {
    let degenerate = |wrong: bool, text: &str| wrong.then(|| ("degenerate", text.to_owned()));
    let positive = |x: f32| x > 0.0 && x.is_finite();
    let too_many = |triangles: u64| {
        (triangles > MOST_TRIANGLES).then(|| {
            ("too-large", format!("{triangles} triangles are more than the {MOST_TRIANGLES} allowed"))
        })
    };
    match shape {
        Shape::Sphere { radius, .. } => degenerate(!positive(*radius), "the radius is not > 0"),
        Shape::Disk { normal, radius, .. } => degenerate(!has_length(*normal), "the normal has no length")
            .or_else(|| degenerate(!positive(*radius), "the radius is not > 0")),
        Shape::Quad { edge_u, edge_v, .. } => {
            degenerate(parallel(wide(*edge_u), wide(*edge_v)), "`edge_u` and `edge_v` are parallel")
        }
        Shape::Corners { corners: c } => {
            let flat = |i: usize, j: usize| parallel(sub(c[i], c[0]), sub(c[j], c[0]));
            degenerate(flat(1, 2) && flat(2, 3), "the corners lie on a line")
        }
        Shape::Mesh { .. } => None,
        Shape::Triangles { positions, indices, vertex_normals, uvs, uvs2, colors, .. } => {
            let counts = [
                (vertex_normals.len(), "vertex_normals"),
                (uvs.len(), "uvs"),
                (uvs2.len(), "uvs2"),
                (colors.len(), "colors"),
            ];
            triangles_fault(positions, indices, &counts)
        }
        Shape::Box { min, max } => {
            let extent = |i: usize| max[i] > min[i] && (max[i] - min[i]).is_finite();
            degenerate(
                !(extent(0) && extent(1) && extent(2)),
                "`max` does not exceed `min` in every coordinate",
            )
        }
        Shape::Teapot { level, parts, solid } => degenerate(*level == 0, "the level is 0")
            .or_else(|| degenerate(parts.is_empty() && !solid, "no part is left"))
            .or_else(|| too_many(64 * *level as u64 * *level as u64)),
        Shape::Lathe { profile, segments, closed, steps, .. } => lathe_fault(profile, *segments, *closed)
            .map(|text| ("degenerate", text.to_owned()))
            .or_else(|| too_many(2 * profile.len() as u64 * u64::from(*steps) * *segments as u64)),
        Shape::Cylinder { axis, radius, height, segments, .. } => {
            degenerate(!has_length(*axis), "the axis has no length")
                .or_else(|| {
                    degenerate(!positive(*radius) || !positive(*height), "radius or height is not > 0")
                })
                .or_else(|| degenerate(*segments < 3, "there are less than 3 segments"))
        }
        Shape::Cone { axis, radius, top_radius, height, segments, .. } => {
            degenerate(!has_length(*axis), "the axis has no length")
                .or_else(|| {
                    degenerate(!positive(*radius) || !positive(*height), "radius or height is not > 0")
                })
                .or_else(|| {
                    degenerate(!(*top_radius >= 0.0 && top_radius.is_finite()), "the top radius is not ≥ 0")
                })
                .or_else(|| degenerate(*segments < 3, "there are less than 3 segments"))
        }
        Shape::Capsule { axis, radius, height, segments, .. } => {
            degenerate(!has_length(*axis), "the axis has no length")
                .or_else(|| {
                    degenerate(!positive(*radius) || !positive(*height), "radius or height is not > 0")
                })
                .or_else(|| degenerate(*segments < 3, "there are less than 3 segments"))
        }
        Shape::RoundedBox { min, max, radius, steps } => {
            let side = (0..3).map(|i| max[i] - min[i]).fold(f32::INFINITY, f32::min);
            degenerate(!(side > 0.0 && side.is_finite()), "`max` does not exceed `min` in every coordinate")
                .or_else(|| degenerate(!positive(*radius), "the radius is not > 0"))
                .or_else(|| {
                    degenerate(2.0 * radius >= side, "the radius is not less than half the least side")
                })
                .or_else(|| degenerate(*steps < 1, "there are no steps"))
                .or_else(|| too_many(16 * (*steps as u64 + 1).pow(2)))
        }
        Shape::RoundBrilliant(gem) => degenerate(!has_length(gem.axis), "the axis has no length")
            .or_else(|| degenerate(!positive(gem.diameter), "the diameter is not > 0")),
        Shape::WaterSurface(water) => water_fault(water),
        Shape::HeightField(field) => field_fault(field).or_else(|| match &field.source {
            HeightSource::Rows(rows) => too_many(2 * rows.iter().map(|row| row.len() as u64).sum::<u64>()),
            HeightSource::Picture(_) => None,
        }),
        Shape::Torus { axis, major_radius, minor_radius, segments, tube_segments, .. } => {
            degenerate(!has_length(*axis), "the axis has no length")
                .or_else(|| {
                    degenerate(!positive(*major_radius) || !positive(*minor_radius), "a radius is not > 0")
                })
                .or_else(|| degenerate(*segments < 3 || *tube_segments < 3, "there are less than 3 segments"))
                .or_else(|| too_many(2 * *segments as u64 * *tube_segments as u64))
        }
        Shape::Icosphere { radius, level, .. } => degenerate(!positive(*radius), "the radius is not > 0")
            .or_else(|| too_many(20u64.saturating_mul(4u64.saturating_pow(*level)))),
        Shape::Band { inner_radius, outer_radius, height, fillet, segments } => degenerate(
            !(positive(*inner_radius) && positive(*outer_radius) && positive(*height)),
            "a radius or the height is not > 0",
        )
        .or_else(|| degenerate(outer_radius <= inner_radius, "`outer_radius` does not exceed `inner_radius`"))
        .or_else(|| degenerate(!(*fillet >= 0.0 && fillet.is_finite()), "the fillet is not ≥ 0"))
        .or_else(|| degenerate(*segments < 3, "there are less than 3 segments")),
        Shape::Ring { segments }
        | Shape::CoffeeCup { segments }
        | Shape::WineGlass { segments }
        | Shape::Wine { segments } => degenerate(*segments < 3, "there are less than 3 segments"),
    }
}

fn field_fault(field: &HeightField) -> Option<(&'static str, String)> {
    let degenerate = |wrong: bool, text: &str| wrong.then(|| ("degenerate", text.to_owned()));
    let positive = |x: f32| x > 0.0 && x.is_finite();
    let ragged = match &field.source {
        HeightSource::Picture(_) => None,
        HeightSource::Rows(rows) => {
            let columns = rows.first().map_or(0, Vec::len);
            let other = rows.iter().position(|row| row.len() != columns);
            let other = other
                .map(|i| format!("row {} has {} heights, the first has {columns}", i + 1, rows[i].len()));
            other.or_else(|| {
                (rows.len() < 2 || columns < 2)
                    .then(|| "there are less than two rows of two heights".to_owned())
            })
        }
    };
    degenerate(!field.size.into_iter().all(positive), "a side is not > 0")
        .or_else(|| degenerate(field.depth.is_some_and(|d| !positive(d)), "the depth is not > 0"))
        .or_else(|| degenerate(!field.height.is_finite(), "the height is not finite"))
        .or_else(|| ragged.map(|text| ("degenerate", text)))
}

fn water_fault(water: &WaterSurface) -> Option<(&'static str, String)> {
    let degenerate = |wrong: bool, text: &str| wrong.then(|| ("degenerate", text.to_owned()));
    let positive = |x: f32| x > 0.0 && x.is_finite();
    let [x, z] = water.size;
    degenerate(!positive(x) || !positive(z), "a side is not > 0")
        .or_else(|| degenerate(water.depth.is_some_and(|d| !positive(d)), "the depth is not > 0"))
        .or_else(|| degenerate(!positive(water.fetch), "the fetch is not > 0"))
        .or_else(|| {
            degenerate(!(8..=4096).contains(&water.resolution), "the resolution is not from 8 to 4096")
        })
        .or_else(|| degenerate(!(1..=4096).contains(&water.waves), "the waves are not 1 to 4096"))
        .or_else(|| {
            let work = u64::from(water.resolution).pow(2) * u64::from(water.waves);
            (work > MOST_WAVE_CELLS).then(|| {
                let (waves, cells) = (water.waves, water.resolution);
                ("too-large", format!("{waves} waves on {cells}² cells take too long: lower one of them"))
            })
        })
        .or_else(|| {
            let still = water.wind_speed == 0.0 && water.wave_height.is_some_and(|h| h > 0.0);
            still.then(|| ("conflict", "`wave_height` without wind: `wind_speed` is 0".to_owned()))
        })
}

fn triangles_fault(
    positions: &[Triple],
    indices: &[[u32; 3]],
    counts: &[(usize, &str)],
) -> Option<(&'static str, String)> {
    let vertices = positions.len();
    if indices.is_empty() {
        return Some(("degenerate", "there is no triangle".into()));
    }
    if let Some((i, index)) =
        indices.iter().enumerate().find_map(|(i, t)| Some((i, *t.iter().find(|&&v| v as usize >= vertices)?)))
    {
        return Some((
            "out-of-range",
            format!("triangle {} has vertex {index}, but there are {vertices}", i + 1),
        ));
    }
    for &(count, name) in counts {
        if count != 0 && count != vertices {
            return Some(("conflict", format!("{count} `{name}` for {vertices} `positions`")));
        }
    }
    let flat = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|v| positions[v as usize]);
        let area = length(cross(sub(b, a), sub(c, a)));
        !(area.is_finite() && area > 0.0)
    };
    indices.iter().all(flat).then(|| ("degenerate", "no triangle has an area".into()))
}

fn lathe_fault(profile: &[[f32; 2]], segments: u32, closed: bool) -> Option<&'static str> {
    if profile.len() < 2 || (closed && profile.len() < 3) {
        return Some("the profile has too few points");
    }
    if profile.iter().any(|p| !(p[0] >= 0.0 && p[0].is_finite() && p[1].is_finite())) {
        return Some("the profile has a radius below 0");
    }
    let bare = |pair: &[[f32; 2]]| pair[0] == pair[1] || (pair[0][0] == 0.0 && pair[1][0] == 0.0);
    if profile.windows(2).all(bare) {
        return Some("the profile has no extent");
    }
    (segments < 3).then_some("there are less than 3 segments")
}
