//! The studio that models are shown in: lamps as large as windows around a grey surround, and a ground that fades into it.
//!
//! Glass and metal show what stands around them: a key light in front on the left above, one strip along either side, a large soft
//! lamp overhead. None of them is behind the model as it is framed. Below the horizon the surround has the radiance of the ground
//! that it lights, so that the ground has no edge.

use std::f64::consts::{PI, TAU};

use scenefile::desc::{
    Channel, ColorDesc, EmbeddedImage, Exposure, FloatDesc, ImageSource, Light, LightKind, Material,
    MaterialRef, Normals, Object, SceneDesc, Shape, SkyMapping, Texture,
};

use crate::matrix::{cross, dot, narrow, unit};

/// Columns and rows of the surround.
const SIZE: [usize; 2] = [256, 128];
/// Radiance of the horizon and of all below it, which the lit ground has, too.
const HORIZON: f64 = 0.5;
/// Radiance straight above, without lamps.
const ZENITH: f64 = 0.12;
/// Degrees over which lamps fade along their edges.
const SOFT: f64 = 3.0;

/// A rectangle of light on the sphere around the model.
struct Lamp {
    /// Degrees to the right of +z and above the horizon.
    toward: [f64; 2],
    /// Half of its width and height in degrees.
    half: [f64; 2],
    radiance: [f64; 3],
}

const LAMPS: [Lamp; 4] = [
    // The key: three fifths of the light on the ground, and what makes shadows and caustics.
    Lamp { toward: [-42.0, 50.0], half: [7.0, 7.0], radiance: [42.0, 41.2, 40.0] },
    Lamp { toward: [88.0, 32.0], half: [6.0, 24.0], radiance: [3.4, 3.5, 3.6] },
    Lamp { toward: [-98.0, 30.0], half: [4.0, 22.0], radiance: [3.8, 3.9, 4.0] },
    Lamp { toward: [0.0, 90.0], half: [24.0, 24.0], radiance: [0.6, 0.6, 0.6] },
];

/// What of the studio a light is. They are lights of their own because each is sampled by itself: a ground draws no samples of what
/// is below it, and whoever mixes lights later has the lamps apart.
#[derive(Clone, Copy)]
enum Part {
    Lamps,
    /// The surround above the horizon, without lamps.
    Above,
    /// Below it.
    Below,
}

/// Exposure in EV under which the ground is light grey and what is white is white.
const EXPOSURE: f32 = 0.6;

/// Adds the surround, with the exposure for it.
pub(crate) fn light(desc: &mut SceneDesc) {
    desc.film.exposure = Exposure::Ev(EXPOSURE);
    for (wanted, part) in
        [("studio-lamps", Part::Lamps), ("studio-above", Part::Above), ("studio-below", Part::Below)]
    {
        let image = EmbeddedImage { name: format!("{wanted}.hdr"), bytes: picture(part).into() };
        let kind = LightKind::Sky {
            source: ImageSource::Embedded(image),
            mapping: SkyMapping::LatLong,
            scale: [1.0; 3],
            transform: Vec::new(),
        };
        let name = Some(free(wanted, |name| is_taken(desc, name)));
        desc.lights.push(Light { name, light_group: None, kind }.into());
    }
}

/// Corners of the rims of the ground.
const CORNERS: u32 = 20;
/// Radius of the ground where it begins to fade and where it ends: of the model's radius, and of its height.
const SOLID: [f64; 2] = [1.5, 2.0];
const END: f64 = 3.0;
/// How far the ground lies below the model's lowest point, of the model's size: where a base is flat, rays must meet it first.
const GAP: f64 = 1e-4;

/// Lays a disc under what has this extent. Where the surround shines alone it has no edge: it fades, and looks like what is behind.
pub(crate) fn ground(desc: &mut SceneDesc, [least, most]: [[f64; 3]; 2]) {
    let size = [0, 1, 2].map(|i| most[i] - least[i]);
    let radius = size[0].hypot(size[2]) / 2.0;
    let solid = SOLID[0] * radius + SOLID[1] * size[1];
    let middle =
        [(least[0] + most[0]) / 2.0, least[1] - GAP * radius.max(size[1]), (least[2] + most[2]) / 2.0];
    let mut positions = vec![narrow(middle)];
    let mut colors = vec![[1.0; 4]];
    for (radius, alpha) in [(solid, 1.0), (solid * END, 0.0)] {
        for k in 0..CORNERS {
            let (sin, cos) = (TAU * f64::from(k) / f64::from(CORNERS)).sin_cos();
            positions.push(narrow([middle[0] + radius * sin, middle[1], middle[2] + radius * cos]));
            colors.push([1.0, 1.0, 1.0, alpha]);
        }
    }
    // Counter-clockwise seen from above: from +z toward +x.
    let indices = (0..CORNERS)
        .flat_map(|k| {
            let (a, b) = (1 + k, 1 + (k + 1) % CORNERS);
            [[0, a, b], [a, a + CORNERS, b + CORNERS], [a, b + CORNERS, b]]
        })
        .collect();
    let shape = Shape::Triangles {
        positions,
        indices,
        vertex_normals: Vec::new(),
        uvs: Vec::new(),
        uvs2: Vec::new(),
        colors,
        normals: Normals::Flat,
    };
    let opacity = free("ground-opacity", |name| desc.textures.contains_key(name));
    desc.textures.insert(opacity.clone(), Texture::VertexColor { channel: Channel::Alpha }.into());
    let light = irradiance();
    let color = ColorDesc::Rgb([0, 1, 2].map(|i| (HORIZON * PI / light[i]) as f32));
    let material = Material { opacity: FloatDesc::Texture(opacity.into()), ..Material::diffuse(color) };
    let key = free("ground", |name| desc.materials.contains_key(name));
    desc.materials.insert(key.clone(), material.into());
    let name = free("ground", |name| is_taken(desc, name));
    desc.objects
        .push(Object { name: Some(name), ..Object::new(shape, MaterialRef::from(key.as_str())) }.into());
}

/// A name that nothing has yet.
fn free(wanted: &str, is_taken: impl Fn(&str) -> bool) -> String {
    let numbered = (2..).map(|n| format!("{wanted}-{n}"));
    std::iter::once(wanted.to_owned()).chain(numbered).find(|name| !is_taken(name)).unwrap_or_default()
}

/// Whether an object, an instance or a light has this name.
fn is_taken(desc: &SceneDesc, name: &str) -> bool {
    let is = |own: &Option<String>| own.as_deref() == Some(name);
    desc.objects.iter().any(|o| is(&o.name))
        || desc.instances.iter().any(|i| is(&i.name))
        || desc.lights.iter().any(|l| is(&l.name))
}

/// Rises smoothly from 0 to 1.
fn ramp(x: f64, from: f64, to: f64) -> f64 {
    let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

impl Lamp {
    /// How much of it is seen in a direction, from 0 to 1.
    fn share(&self, w: [f64; 3]) -> f64 {
        let [a, h] = self.toward.map(f64::to_radians);
        let axis = [a.sin() * h.cos(), h.sin(), a.cos() * h.cos()];
        // Of the lamp overhead no side is up: +z is.
        let right = unit(cross([0.0, 1.0, 0.0], axis)).unwrap_or([1.0, 0.0, 0.0]);
        let up = cross(axis, right);
        let z = dot(w, axis);
        if z <= 0.0 {
            return 0.0;
        }
        let inside = |side: [f64; 3], half: f64| {
            let angle = dot(w, side).atan2(z).to_degrees().abs();
            ramp(half + SOFT / 2.0 - angle, 0.0, SOFT)
        };
        inside(right, self.half[0]) * inside(up, self.half[1])
    }
}

impl Part {
    /// Radiance from a direction.
    fn radiance(self, w: [f64; 3]) -> [f64; 3] {
        match self {
            Self::Lamps => {
                let shares = LAMPS.map(|lamp| lamp.share(w));
                [0, 1, 2]
                    .map(|i| LAMPS.iter().zip(shares).map(|(lamp, share)| share * lamp.radiance[i]).sum())
            }
            Self::Above if w[1] > 0.0 => [HORIZON + (ZENITH - HORIZON) * ramp(w[1], 0.0, 0.7); 3],
            Self::Below if w[1] <= 0.0 => [HORIZON; 3],
            Self::Above | Self::Below => [0.0; 3],
        }
    }
}

/// Radiance of the whole from a direction.
fn radiance(w: [f64; 3]) -> [f64; 3] {
    let parts = [Part::Lamps, Part::Above, Part::Below].map(|part| part.radiance(w));
    [0, 1, 2].map(|i| parts.iter().map(|rgb| rgb[i]).sum())
}

/// Calls back with every texel's direction, solid angle, row by row; the middle column is +z, the left quarter +x.
fn texels(mut found: impl FnMut([f64; 3], f64)) {
    let [width, height] = SIZE;
    let step = PI / height as f64;
    for row in 0..height {
        let theta = step * (row as f64 + 0.5);
        for column in 0..width {
            let phi = TAU * (0.5 - (column as f64 + 0.5) / width as f64);
            let w = [theta.sin() * phi.sin(), theta.cos(), theta.sin() * phi.cos()];
            found(w, step * step * theta.sin());
        }
    }
}

/// Irradiance of a ground that faces up.
fn irradiance() -> [f64; 3] {
    let mut sum = [0.0; 3];
    texels(|w, solid_angle| {
        let rgb = radiance(w);
        (0..3).for_each(|i| sum[i] += rgb[i] * w[1].max(0.0) * solid_angle);
    });
    sum
}

/// A part as a Radiance picture (Ward 1991), flat: four bytes a pixel.
fn picture(part: Part) -> Vec<u8> {
    let [width, height] = SIZE;
    let mut out = format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n").into_bytes();
    texels(|w, _| out.extend(rgbe(part.radiance(w))));
    out
}

/// Three mantissas and the exponent that they share.
fn rgbe(rgb: [f64; 3]) -> [u8; 4] {
    if rgb == [0.0; 3] {
        return [0; 4];
    }
    let exponent = rgb.iter().copied().fold(f64::MIN_POSITIVE, f64::max).log2().floor() as i32 + 1;
    let [r, g, b] = rgb.map(|x| (x * 256.0 / f64::from(exponent).exp2()).round().min(255.0) as u8);
    [r, g, b, (exponent + 128) as u8]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_looks_white() {
        // Irradiance over π on planes that face up and to the front.
        for (normal, range) in
            [([0.0, 1.0, 0.0], 0.9..1.3), ([0.0, 0.0, 1.0], 0.5..1.3), ([0.0, -1.0, 0.0], 0.45..0.55)]
        {
            let mut sum = 0.0;
            texels(|w, solid_angle| sum += radiance(w)[1] * dot(w, normal).max(0.0) * solid_angle / PI);
            assert!(range.contains(&sum), "{normal:?} {sum}");
        }
        assert_eq!(rgbe([0.5, 0.25, 1.0]), [64, 32, 128, 129]);
        assert_eq!(rgbe([0.5; 3]), [128, 128, 128, 128]);
    }

    #[test]
    fn no_lamp_is_behind_the_model() {
        // As models are framed: 27 degrees to each side, up to 20 degrees above the horizon where they are flat.
        for azimuth in (153..=232).map(f64::from) {
            for height in (0..=20).map(f64::from) {
                let [a, h] = [azimuth, height].map(f64::to_radians);
                let w = [a.sin() * h.cos(), h.sin(), a.cos() * h.cos()];
                assert!(LAMPS.iter().all(|lamp| lamp.share(w) == 0.0), "{azimuth} {height}");
            }
        }
    }
}
