use math::{Transform, Vec3};

use super::perlin::noise;
use super::{SMALL_STEP, TexturePoint};

/// Factor of frequency from octave to octave; not 2, so that their lattices do not coincide (Pharr, Jakob & Humphreys
/// 2016, §10.6.3).
const LACUNARITY: f32 = 1.99;
/// Mean of the absolute value of noise, which stands for octaves too fine to be seen.
const MEAN_OF_ABSOLUTE: f32 = 0.2;
/// What noise does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NoiseKind {
    /// A sum of octaves.
    Fbm,
    /// A sum of their absolute values.
    Wrinkled,
    /// The height of waves: that of six octaves, where the absolute value of three wide ones is the wind's strength.
    Windy,
    /// A ramp of colours along y.
    Marble {
        /// Factor on the place.
        scale: f32,
        /// Strength of the shaking.
        variation: f32,
    },
}

/// Noise in space: sums of octaves of gradient noise, without those that the footprint would hide (Pharr, Jakob &
/// Humphreys 2016, §10.6).
#[derive(Clone, Debug)]
pub struct Noise {
    /// What it does.
    pub kind: NoiseKind,
    /// Most octaves.
    pub octaves: u32,
    /// Factor on the amplitude from octave to octave.
    pub roughness: f32,
    /// From the world to the texture's own space.
    texture_from_world: Transform,
    /// Greatest growth of lengths by that.
    growth: f32,
}

impl Noise {
    /// Noise placed in the world by `world_from_texture`.
    pub fn new(kind: NoiseKind, octaves: u32, roughness: f32, world_from_texture: &Transform) -> Self {
        let texture_from_world = world_from_texture.inverse();
        let m = texture_from_world.matrix().matrix3;
        let growth = [m.x_axis, m.y_axis, m.z_axis].iter().map(|axis| axis.length()).fold(0.0, f32::max);
        Self { kind, octaves, roughness, texture_from_world, growth }
    }

    pub(super) fn evaluate(&self, at: &TexturePoint<'_>) -> [f32; 3] {
        let p = self.texture_from_world.point(at.p);
        self.local(p, at.width * self.growth)
    }

    /// At a point of its own space.
    fn local(&self, p: Vec3, width: f32) -> [f32; 3] {
        let (octaves, omega) = (self.octaves, self.roughness);
        match self.kind {
            NoiseKind::Fbm => [fbm(p, width, omega, octaves); 3],
            NoiseKind::Wrinkled => [turbulence(p, width, omega, octaves); 3],
            NoiseKind::Windy => {
                let strength = fbm(0.1 * p, 0.1 * width, 0.5, 3).abs();
                [strength * fbm(p, width, 0.5, 6); 3]
            }
            NoiseKind::Marble { scale, variation } => {
                let p = p * scale;
                let shaken = p.y + variation * fbm(p, width * scale.abs(), omega, octaves);
                marble(0.5 + 0.5 * shaken.sin())
            }
        }
    }

    /// Mean over space, estimated.
    pub(super) fn mean(&self) -> [f32; 3] {
        let mut sum = [0f64; 3];
        let n = 512;
        for i in 0..n {
            // A lattice of rank one (Roberts 2018: powers of the root of x⁴ = x + 1).
            let share = |a: f32| (0.5 + a * i as f32).fract() * 64.0;
            let p = Vec3::new(share(0.819_172_5), share(0.671_043_6), share(0.549_700_5));
            sum.iter_mut().zip(self.local(p, 0.0)).for_each(|(s, x)| *s += f64::from(x));
        }
        sum.map(|s| (s / f64::from(n)) as f32)
    }

    pub(super) fn grain(&self) -> Option<f32> {
        let scale = if let NoiseKind::Marble { scale, .. } = self.kind { scale.abs() } else { 1.0 };
        let grain = SMALL_STEP / (self.growth * scale);
        (grain.is_finite() && grain > 0.0).then_some(grain)
    }
}

/// How many octaves a footprint of `width` lets through, up to `most`: the finest has a wavelength of twice the width.
fn visible(width: f32, most: u32) -> f32 {
    (-1.0 - width.log2()).clamp(0.0, most as f32)
}

/// 0 below 0.3, 1 above 0.7, smooth between.
fn fade(t: f32) -> f32 {
    let t = ((t - 0.3) / 0.4).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Fractional Brownian motion: Σ ωⁱ·noise(λⁱ·p).
fn fbm(p: Vec3, width: f32, omega: f32, most: u32) -> f32 {
    let octaves = visible(width, most);
    let whole = octaves.floor();
    let (mut sum, mut lambda, mut weight) = (0.0, 1.0, 1.0);
    for _ in 0..whole as u32 {
        sum += weight * noise((p * lambda).to_array());
        lambda *= LACUNARITY;
        weight *= omega;
    }
    let part = fade(octaves - whole);
    if part > 0.0 { sum + weight * part * noise((p * lambda).to_array()) } else { sum }
}

/// Σ ωⁱ·|noise(λⁱ·p)|; octaves that are not seen add their mean.
fn turbulence(p: Vec3, width: f32, omega: f32, most: u32) -> f32 {
    let octaves = visible(width, most);
    let whole = octaves.floor();
    let (mut sum, mut lambda, mut weight) = (0.0, 1.0, 1.0);
    for i in 0..most {
        let share = if (i as f32) < whole {
            1.0
        } else if i as f32 == whole {
            fade(octaves - whole)
        } else {
            0.0
        };
        let seen = if share > 0.0 { noise((p * lambda).to_array()).abs() } else { 0.0 };
        sum += weight * (share * seen + (1.0 - share) * MEAN_OF_ABSOLUTE);
        lambda *= LACUNARITY;
        weight *= omega;
    }
    sum
}

/// Control points of marble's colours, before their factor (Pharr, Jakob & Humphreys 2016, §10.6.5).
const VEINS: [[f32; 3]; 9] = [
    [0.58, 0.58, 0.6],
    [0.58, 0.58, 0.6],
    [0.58, 0.58, 0.6],
    [0.5, 0.5, 0.5],
    [0.6, 0.59, 0.58],
    [0.58, 0.58, 0.6],
    [0.58, 0.58, 0.6],
    [0.2, 0.2, 0.33],
    [0.58, 0.58, 0.6],
];
/// Factor on marble's colours.
const BRIGHTNESS: f32 = 1.5;

/// The colour at `t` in [0, 1]: cubic Bézier curves over four control points each, six in all.
fn marble(t: f32) -> [f32; 3] {
    let segments = (VEINS.len() - 3) as f32;
    let x = t.clamp(0.0, 1.0) * segments;
    let first = x.floor().min(segments - 1.0);
    let t = x - first;
    let s = 1.0 - t;
    // Bernstein's polynomials.
    let weights = [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t];
    let points = &VEINS[first as usize..first as usize + 4];
    std::array::from_fn(|c| BRIGHTNESS * points.iter().zip(weights).map(|(p, w)| p[c] * w).sum::<f32>())
}

#[cfg(test)]
mod tests {
    use math::Affine3A;

    use super::*;

    fn points() -> impl Iterator<Item = Vec3> {
        (0..4000u32).map(|i| {
            let share = |a: f64| (f64::from(i) * a).fract() as f32 * 90.0 - 45.0;
            Vec3::new(share(0.819_172_5), share(0.671_043_6), share(0.549_700_5))
        })
    }

    fn of(kind: NoiseKind) -> Noise {
        Noise::new(kind, 8, 0.5, &Transform::IDENTITY)
    }

    #[test]
    fn fbm_is_about_zero_and_fades_under_a_wide_footprint() {
        let noise = of(NoiseKind::Fbm);
        let values: Vec<f32> = points().map(|p| noise.local(p, 0.0)[0]).collect();
        let mean = values.iter().sum::<f32>() / values.len() as f32;
        assert!(mean.abs() < 0.03, "{mean}");
        assert!(values.iter().all(|x| x.abs() < 2.1) && values.iter().any(|x| x.abs() > 0.5));
        assert!(noise.mean()[0].abs() < 0.05);
        for p in points().take(100) {
            assert_eq!(noise.local(p, 0.6), [0.0; 3]);
            // One octave of eight, then two: what is lost is fine.
            let (coarse, fine) = (noise.local(p, 0.25)[0], noise.local(p, 0.0)[0]);
            assert!((coarse - fine).abs() < 1.1);
        }
    }

    #[test]
    fn turbulence_keeps_its_mean_under_any_footprint() {
        let noise = of(NoiseKind::Wrinkled);
        let mean = |width: f32| points().map(|p| noise.local(p, width)[0]).sum::<f32>() / 4000.0;
        let sharp = mean(0.0);
        assert!(points().all(|p| noise.local(p, 0.0)[0] >= 0.0));
        for width in [0.02, 0.1, 0.3, 10.0] {
            assert!((mean(width) / sharp - 1.0).abs() < 0.12, "{width}: {} {sharp}", mean(width));
        }
    }

    #[test]
    fn marble_stays_between_its_colours_and_varies_along_y() {
        let noise = of(NoiseKind::Marble { scale: 1.0, variation: 0.0 });
        for p in points() {
            for x in noise.local(p, 0.0) {
                assert!((0.3 - 1e-4..=0.9 + 1e-4).contains(&x), "{x}");
            }
            let beside = Vec3::new(p.x + 3.0, p.y, p.z - 1.0);
            assert_eq!(noise.local(p, 0.0), noise.local(beside, 0.0));
        }
        // t = 0 at y = −π/2: the first control points alone.
        assert!((marble(0.0)[2] - 0.9).abs() < 1e-6);
        assert!((marble(1.0)[2] - 1.5 * 0.6).abs() < 1e-6, "the last control point ends the curve");
    }

    #[test]
    fn windy_is_calm_where_the_wind_is() {
        let noise = of(NoiseKind::Windy);
        let heights: Vec<f32> = points().map(|p| noise.local(p, 0.0)[0].abs()).collect();
        assert!(heights.iter().all(|x| *x < 1.5) && heights.iter().any(|x| *x > 0.1));
        assert!(noise.local(Vec3::ZERO, 0.0)[0] == 0.0);
    }

    #[test]
    fn the_transform_places_the_texture() {
        let kind = NoiseKind::Fbm;
        let placed = Transform::new(Affine3A::from_scale(Vec3::splat(4.0))).unwrap();
        let (small, large) = (of(kind), Noise::new(kind, 8, 0.5, &placed));
        for p in points().take(50) {
            let near = TexturePoint { p, ..TexturePoint::of_uv(math::Vec2::ZERO, 0.05) };
            let far = TexturePoint { p: p * 4.0, width: 0.2, ..near };
            let (a, b) = (small.evaluate(&near)[0], large.evaluate(&far)[0]);
            assert!((a - b).abs() < 1e-4, "{a} {b}");
        }
    }
}
