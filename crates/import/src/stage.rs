//! What files without a camera or a light are given: a view of the whole, and a soft sky.

use std::f64::consts::PI;

use scenefile::desc::{
    Camera, EmbeddedImage, FovAxis, ImageSource, Light, LightKind, SceneDesc, Shape, SkyMapping,
    TransformStep, TransformSteps, Triple,
};

use crate::matrix::{Matrix, add, cross, dot, narrow, times, unit, wide};

/// Width over height of the picture.
pub(crate) const ASPECT: f64 = 4.0 / 3.0;
const SIZE: [u32; 2] = [800, 600];
/// Degrees over the picture's height.
const FOV: f64 = 40.0;
/// Share of the picture that what is framed fills.
const FILLED: f64 = 0.92;
/// Degrees to the right of the front and above the horizon from where it is seen.
const FROM: [f64; 2] = [25.0, 17.0];
/// What is flatter than the first, of its height or width, is seen from the front; what is deeper than the second from there.
const FLAT: [f64; 2] = [0.2, 0.8];
/// Vertices of instances that are looked at one by one.
const MANY: usize = 4 << 20;

/// Looks at the whole scene, whose meshes are all in place, from the front, right and above (+z is the front, +y up).
/// Whether there is anything to look at; the camera is set in any case.
pub(crate) fn frame(desc: &mut SceneDesc) -> bool {
    let (mut least, mut most) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    points(desc, &mut |p| {
        for i in 0..3 {
            (least[i], most[i]) = (least[i].min(p[i]), most[i].max(p[i]));
        }
    });
    let size = [0, 1, 2].map(|i| most[i] - least[i]);
    desc.film.size = SIZE;
    desc.camera = Some(Camera { position: [0.0, 0.0, 3.0], ..Camera::default() }.into());
    if !size.iter().all(|x| x.is_finite()) || size.iter().all(|x| *x <= 0.0) {
        return false;
    }
    let depth = size[2] / size[0].max(size[1]);
    let share = ((depth - FLAT[0]) / (FLAT[1] - FLAT[0])).clamp(0.0, 1.0);
    let [azimuth, height] = FROM.map(|degrees| (share * degrees).to_radians());
    let back = [azimuth.sin() * height.cos(), height.sin(), azimuth.cos() * height.cos()];
    let right = unit(cross([0.0, 1.0, 0.0], back)).unwrap_or([1.0, 0.0, 0.0]);
    let up = cross(back, right);
    // A point p is within the side planes of a pyramid of slope s whose tip is c where ±(p − c)·x ≤ s·(c − p)·z: each side
    // wants c·z·s ± c·x to reach the greatest p·z·s ± p·x.
    let tan = (FOV / 2.0).to_radians().tan() * FILLED;
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

/// Columns and rows of the sky.
const SKY: [usize; 2] = [256, 128];

/// Adds a sky: grey, brighter above, with a large lamp in front on the left above and a weaker one behind on the right. What is
/// white and diffuse looks about as bright as white.
pub(crate) fn light(desc: &mut SceneDesc) {
    let image = EmbeddedImage { name: "studio.hdr".into(), bytes: studio().into() };
    let kind = LightKind::Sky {
        source: ImageSource::Embedded(image),
        mapping: SkyMapping::LatLong,
        scale: [1.0; 3],
        transform: Vec::new(),
    };
    desc.lights.push(Light { name: Some("sky".into()), light_group: None, kind }.into());
}

/// A direction by degrees to the right of +z and above the horizon.
fn toward(azimuth: f64, height: f64) -> [f64; 3] {
    let [a, h] = [azimuth, height].map(f64::to_radians);
    [a.sin() * h.cos(), h.sin(), a.cos() * h.cos()]
}

/// Radiance of the sky from a direction.
fn radiance(w: [f64; 3]) -> [f64; 3] {
    let ramp = |x: f64, from: f64, to: f64| {
        let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
        t * t * (3.0 - 2.0 * t)
    };
    let (ground, horizon, zenith) = ([0.16, 0.15, 0.14], [0.30, 0.30, 0.30], [0.40, 0.43, 0.47]);
    let (a, b, t) = if w[1] < 0.0 {
        (horizon, ground, ramp(-w[1], 0.0, 0.5))
    } else {
        (horizon, zenith, ramp(w[1], 0.0, 1.0))
    };
    let lamp = |axis: [f64; 3], inner: f64, outer: f64| {
        ramp(dot(w, axis), outer.to_radians().cos(), inner.to_radians().cos())
    };
    let key = 8.0 * lamp(toward(-40.0, 48.0), 16.0, 22.0);
    let rim = 3.0 * lamp(toward(150.0, 30.0), 16.0, 26.0);
    [0, 1, 2].map(|i| a[i] + (b[i] - a[i]) * t + key * [1.0, 0.98, 0.95][i] + rim * [0.95, 0.98, 1.0][i])
}

/// The sky as a Radiance picture (Ward 1991), flat: four bytes a pixel.
fn studio() -> Vec<u8> {
    let [width, height] = SKY;
    let mut out = format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n").into_bytes();
    for row in 0..height {
        let theta = PI * (row as f64 + 0.5) / height as f64;
        for column in 0..width {
            // The middle is +z, the left quarter +x.
            let phi = 2.0 * PI * (0.5 - (column as f64 + 0.5) / width as f64);
            let rgb = radiance([theta.sin() * phi.sin(), theta.cos(), theta.sin() * phi.cos()]);
            out.extend(rgbe(rgb));
        }
    }
    out
}

/// Three mantissas and the exponent that they share.
fn rgbe(rgb: [f64; 3]) -> [u8; 4] {
    let exponent = rgb.iter().copied().fold(f64::MIN_POSITIVE, f64::max).log2().floor() as i32 + 1;
    let [r, g, b] = rgb.map(|x| (x * 256.0 / f64::from(exponent).exp2()) as u8);
    [r, g, b, (exponent + 128) as u8]
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
                assert!(frame(&mut desc));
                let [x, y] = extent(&desc);
                assert!(x.max(y) <= FILLED + 1e-3 && x.max(y) > FILLED - 1e-2, "{shape:?}: {x} {y}");
            }
        }
        assert!(!frame(&mut SceneDesc::default()));
        assert!(!frame(&mut cloud(vec![[1.0; 3]; 3])));
    }

    #[test]
    fn white_looks_white_under_the_sky() {
        // Irradiance over π on planes that face up and to the front.
        let n = 200;
        for (normal, range) in
            [([0.0, 1.0, 0.0], 0.8..1.3), ([0.0, 0.0, 1.0], 0.6..1.3), ([0.0, -1.0, 0.0], 0.1..0.4)]
        {
            let mut sum = 0.0;
            for i in 0..n {
                let y = (i as f64 + 0.5) / n as f64 * 2.0 - 1.0;
                for j in 0..2 * n {
                    let phi = PI * (j as f64 + 0.5) / n as f64;
                    let r = (1.0 - y * y).sqrt();
                    let w = [r * phi.cos(), y, r * phi.sin()];
                    sum += radiance(w)[1] * dot(w, normal).max(0.0);
                }
            }
            let white = sum * 4.0 * PI / (2 * n * n) as f64 / PI;
            assert!(range.contains(&white), "{normal:?} {white}");
        }
        assert_eq!(rgbe([0.5, 0.25, 1.0]), [64, 32, 128, 129]);
    }
}
