//! What models are given that their files leave out: a view of the whole, the light of a studio, and a ground.

use scenefile::desc::{Camera, FovAxis, SceneDesc, Shape, TransformStep, TransformSteps, Triple};
use scenefile::{Diagnostic, FileId, Span};

use crate::matrix::{Matrix, add, cross, dot, narrow, times, unit, wide};
use crate::report::Report;
use crate::studio;

/// Width over height of the picture.
pub(crate) const ASPECT: f64 = 4.0 / 3.0;
const SIZE: [u32; 2] = [800, 600];
/// Degrees over the picture's height.
const FOV: f64 = 40.0;
/// Share of the picture that what is framed fills: alone, and on a ground, where its shadow wants room.
const FILLED: f64 = 0.92;
const FILLED_ON_GROUND: f64 = 0.78;
/// Degrees to the right of the front and above the horizon from where it is seen.
const FROM: [f64; 2] = [25.0, 17.0];
/// What is lower than the second, of its width or depth, is seen from further above: by so many degrees from the first on.
const LOW: [f64; 2] = [0.1, 0.35];
const FURTHER_ABOVE: f64 = 16.0;
/// What is flatter than the first, of its height or width, is seen from the front; what is deeper than the second from there.
const FLAT: [f64; 2] = [0.2, 0.8];
/// Vertices of instances that are looked at one by one.
const MANY: usize = 4 << 20;

/// Whether a ground is laid under a model.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Ground {
    /// Where the file has neither a camera nor a light.
    #[default]
    UnderBare,
    /// In any case.
    Laid,
    /// Never.
    Missing,
}

/// The name of the override that says so.
const GROUND_KEY: &str = "stage.ground";

impl Ground {
    /// Takes what is said about it out of the overrides of a scene; the last word counts.
    ///
    /// # Errors
    /// A diagnostic where it is neither `true` nor `false`.
    pub(crate) fn take(overrides: &[String]) -> Result<(Option<Self>, Vec<String>), Diagnostic> {
        let mut ground = None;
        let mut rest = Vec::new();
        for text in overrides {
            match text.split_once('=').filter(|(key, _)| key.trim() == GROUND_KEY) {
                Some((_, value)) => {
                    ground = Some(match value.trim() {
                        "true" => Self::Laid,
                        "false" => Self::Missing,
                        _ => {
                            let message = format!("`{text}`: a ground is there or not");
                            return Err(Diagnostic::error("override", message)
                                .help("write `stage.ground=true` or `stage.ground=false`"));
                        }
                    });
                }
                None => rest.push(text.clone()),
            }
        }
        Ok((ground, rest))
    }
}

/// What a file has of its own.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Given {
    /// Whether it has a lamp, or a surface that is one.
    pub light: bool,
    /// What was asked for.
    pub ground: Ground,
}

/// Gives a model what it lacks: a view of the whole if the file has no camera, the light of a studio if it has no light, and a
/// ground if it has neither, unless asked for otherwise. All is said.
pub(crate) fn complete(desc: &mut SceneDesc, given: Given, report: &mut Report) {
    let whole = Span { file: FileId(0), start: 0, end: 0 };
    let is_viewed = desc.camera.is_some();
    let on_ground = match given.ground {
        Ground::UnderBare => !is_viewed && !given.light,
        Ground::Laid => true,
        Ground::Missing => false,
    };
    let extent = extent(desc);
    if !is_viewed {
        let filled = if on_ground { FILLED_ON_GROUND } else { FILLED };
        if frame(desc, extent, filled) {
            report.note("no-camera", "the file has no camera: the whole scene is framed", whole);
        }
    }
    if !given.light {
        studio::light(desc);
        report.note("no-light", "the file has no light: a studio lights it, exposed for it", whole);
    }
    if let Some(extent) = extent.filter(|_| on_ground) {
        studio::ground(desc, extent);
        let message = "a ground is laid under the model: --no-ground leaves it out";
        report.note("ground", message, whole);
    }
}

/// The least and the greatest corner of the box around everything; `None` where there is nothing that has one.
fn extent(desc: &SceneDesc) -> Option<[[f64; 3]; 2]> {
    let (mut least, mut most) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    points(desc, &mut |p| {
        for i in 0..3 {
            (least[i], most[i]) = (least[i].min(p[i]), most[i].max(p[i]));
        }
    });
    let size = [0, 1, 2].map(|i| most[i] - least[i]);
    let is_usable = size.iter().all(|x| x.is_finite()) && size.iter().any(|x| *x > 0.0);
    is_usable.then_some([least, most])
}

/// Looks at the whole scene, whose meshes are all in place and which has this extent, from the front, right and above (+z is the
/// front, +y up). Whether there is anything to look at; the camera is set in any case.
fn frame(desc: &mut SceneDesc, extent: Option<[[f64; 3]; 2]>, filled: f64) -> bool {
    desc.film.size = SIZE;
    desc.camera = Some(Camera { position: [0.0, 0.0, 3.0], ..Camera::default() }.into());
    let Some([least, most]) = extent else { return false };
    let size = [0, 1, 2].map(|i| most[i] - least[i]);
    let ramp = |x: f64, [from, to]: [f64; 2]| ((x - from) / (to - from)).clamp(0.0, 1.0);
    let share = ramp(size[2] / size[0].max(size[1]), FLAT);
    let above = FURTHER_ABOVE * (1.0 - ramp(size[1] / size[0].max(size[2]), LOW));
    let [azimuth, height] = [FROM[0], FROM[1] + above].map(|degrees| (share * degrees).to_radians());
    let back = [azimuth.sin() * height.cos(), height.sin(), azimuth.cos() * height.cos()];
    let right = unit(cross([0.0, 1.0, 0.0], back)).unwrap_or([1.0, 0.0, 0.0]);
    let up = cross(back, right);
    // A point p is within the side planes of a pyramid of slope s whose tip is c where ±(p − c)·x ≤ s·(c − p)·z: each side
    // wants c·z·s ± c·x to reach the greatest p·z·s ± p·x.
    let tan = (FOV / 2.0).to_radians().tan() * filled;
    let slopes = [tan * ASPECT, tan];
    let mut reach = [[f64::NEG_INFINITY; 2]; 2];
    let (mut near, mut far) = (f64::NEG_INFINITY, f64::INFINITY);
    points(desc, &mut |p| {
        let z = dot(p, back);
        (near, far) = (near.max(z), far.min(z));
        for (reach, (axis, slope)) in reach.iter_mut().zip([right, up].into_iter().zip(slopes)) {
            let x = dot(p, axis);
            *reach = [reach[0].max(slope * z + x), reach[1].max(slope * z - x)];
        }
    });
    let [x, y] = reach.map(|[a, b]| (a - b) / 2.0);
    let z = reach.iter().zip(slopes).map(|([a, b], slope)| (a + b) / (2.0 * slope)).fold(near, f64::max);
    let z = z.max(near + 1e-3 * (near - far));
    let place = |z: f64| narrow(add(add(times(right, x), times(up, y)), times(back, z)));
    let camera = Camera {
        position: place(z),
        look_at: place((near + far) / 2.0),
        fov: FOV as f32,
        fov_axis: FovAxis::Y,
        ..Camera::default()
    };
    if camera.position != camera.look_at && camera.position.iter().all(|x| x.is_finite()) {
        desc.camera = Some(camera.into());
    }
    true
}

/// Calls back with the points of all meshes in place, in the world; of a group with many instances the corners of its box.
fn points(desc: &SceneDesc, found: &mut impl FnMut([f64; 3])) {
    for object in &desc.objects {
        let matrix = matrix(&object.transform);
        vertices(&object.shape.value).iter().for_each(|p| found(matrix.point(wide(*p))));
    }
    let mut seen = 0;
    for instance in &desc.instances {
        let Some(group) = desc.groups.get(instance.group.as_str()) else { continue };
        let placed = matrix(&instance.transform);
        for object in &group.objects {
            let matrix = placed.after(&matrix(&object.transform));
            let vertices = vertices(&object.shape.value);
            seen += vertices.len();
            if seen < MANY {
                vertices.iter().for_each(|p| found(matrix.point(wide(*p))));
            } else {
                corners(vertices).iter().for_each(|p| found(matrix.point(*p)));
            }
        }
    }
}

fn vertices(shape: &Shape) -> &[Triple] {
    match shape {
        Shape::Triangles { positions, .. } => positions,
        _ => &[],
    }
}

/// Of the box around some points; none of none.
fn corners(points: &[Triple]) -> Vec<[f64; 3]> {
    let Some(first) = points.first() else { return Vec::new() };
    let (mut least, mut most) = (wide(*first), wide(*first));
    for p in points {
        let p = wide(*p);
        for i in 0..3 {
            (least[i], most[i]) = (least[i].min(p[i]), most[i].max(p[i]));
        }
    }
    (0..8).map(|k| [0, 1, 2].map(|i| if k >> i & 1 == 0 { least[i] } else { most[i] })).collect()
}

/// A placement as importers write it.
fn matrix(steps: &TransformSteps) -> Matrix {
    steps.iter().fold(Matrix::IDENTITY, |before, step| match step {
        TransformStep::Matrix(m) => {
            Matrix(std::array::from_fn(|r| std::array::from_fn(|c| f64::from(m[4 * r + c])))).after(&before)
        }
        _ => before,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use scenefile::desc::{Material, Normals, Object};

    fn cloud(points: Vec<Triple>) -> SceneDesc {
        let shape = Shape::Triangles {
            positions: points,
            indices: vec![[0, 1, 2]],
            vertex_normals: Vec::new(),
            uvs: Vec::new(),
            uvs2: Vec::new(),
            colors: Vec::new(),
            normals: Normals::Given,
        };
        let mut desc = SceneDesc::default();
        desc.objects.push(Object::new(shape, Material::diffuse(0.5)).into());
        desc
    }

    /// The greatest distance of a point from the middle of the picture, in halves of width and height.
    fn extent(desc: &SceneDesc) -> [f64; 2] {
        let camera = desc.camera.as_ref().unwrap();
        let eye = wide(camera.position);
        let forward = unit(crate::matrix::sub(wide(camera.look_at), eye)).unwrap();
        let right = unit(cross(forward, wide(camera.up))).unwrap();
        let up = cross(right, forward);
        let tan = f64::from(camera.fov / 2.0).to_radians().tan();
        let mut most = [0.0f64; 2];
        points(desc, &mut |p| {
            let d = crate::matrix::sub(p, eye);
            let depth = dot(d, forward);
            assert!(depth > 0.0);
            most[0] = most[0].max((dot(d, right) / depth / tan / ASPECT).abs());
            most[1] = most[1].max((dot(d, up) / depth / tan).abs());
        });
        most
    }

    #[test]
    fn everything_is_in_view_and_fills_it() {
        for scale in [1e-3, 1.0, 1e4] {
            for shape in [[1.0, 1.0, 1.0], [5.0, 0.1, 3.0], [0.1, 4.0, 0.1], [1.0, 2.0, 0.0]] {
                let at = |k: usize, i: usize| (if k >> i & 1 == 0 { 0.0 } else { shape[i] } + 7.0) * scale;
                let mut desc = cloud((0..8).map(|k| [0, 1, 2].map(|i| at(k, i) as f32)).collect());
                let around = super::extent(&desc);
                assert!(frame(&mut desc, around, FILLED));
                let [x, y] = extent(&desc);
                assert!(x.max(y) <= FILLED + 1e-3 && x.max(y) > FILLED - 1e-2, "{shape:?}: {x} {y}");
            }
        }
        assert!(super::extent(&SceneDesc::default()).is_none());
        assert!(super::extent(&cloud(vec![[1.0; 3]; 3])).is_none());
        assert!(!frame(&mut SceneDesc::default(), None, FILLED));
    }
}
