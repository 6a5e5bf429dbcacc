//! A glass sphere on the axis of a light, traced in f64 by Snell and Fresnel alone: the flux of its caustic.

use std::f64::consts::PI;

/// A light on the vertical axis through the sphere.
#[derive(Clone, Copy)]
pub enum Source {
    /// Straight down, 1 W/m².
    Parallel,
    /// A point at this height, 1 W/sr.
    Point(f64),
}

/// A sphere over a round floor at height 0 about its axis.
#[derive(Clone, Copy)]
pub struct GlassSphere {
    pub center: f64,
    pub radius: f64,
    pub index: f64,
    pub floor_radius: f64,
}

/// Unpolarised reflectance of a dielectric of relative index `n`, met at the cosine `c` from outside.
fn fresnel(c: f64, n: f64) -> f64 {
    let t = (1.0 - (1.0 - c * c) / (n * n)).sqrt();
    let (s, p) = ((c - n * t) / (c + n * t), (n * c - t) / (n * c + t));
    0.5 * (s * s + p * p)
}

impl GlassSphere {
    /// Flux in W that reaches the floor after the sphere (reflected by it or through it), and all that meets the sphere.
    pub fn flux(&self, source: Source) -> [f64; 2] {
        const STEPS: u32 = 20_000;
        let (mut landed, mut met) = (0.0, 0.0);
        for i in 0..STEPS {
            let x = (f64::from(i) + 0.5) / f64::from(STEPS);
            // Rays of the meridional plane (distance from the axis, height), and the flux that each stands for.
            let (origin, direction, weight) = match source {
                Source::Parallel => {
                    let b = x * self.radius;
                    ([b, self.center + 2.0 * self.radius], [0.0, -1.0], 2.0 * PI * b * self.radius)
                }
                Source::Point(height) => {
                    let widest = (self.radius / (height - self.center)).asin();
                    let angle = x * widest;
                    ([0.0, height], [angle.sin(), -angle.cos()], 2.0 * PI * angle.sin() * widest)
                }
            };
            let weight = weight / f64::from(STEPS);
            met += weight;
            landed += weight * self.share(origin, direction);
        }
        [landed, met]
    }

    /// Share of a ray that reaches the floor.
    fn share(&self, o: [f64; 2], d: [f64; 2]) -> f64 {
        let dot = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] + a[1] * b[1];
        let along = |a: [f64; 2], t: f64, b: [f64; 2]| [a[0] + t * b[0], a[1] + t * b[1]];
        let normal = |p: [f64; 2]| [p[0] / self.radius, (p[1] - self.center) / self.radius];
        let lands = |p: [f64; 2], w: [f64; 2]| {
            let on_floor = w[1] < 0.0 && (p[0] - w[0] * p[1] / w[1]).abs() <= self.floor_radius;
            if on_floor { 1.0 } else { 0.0 }
        };
        let to_center = [-o[0], self.center - o[1]];
        let middle = dot(to_center, d);
        let miss2 = dot(to_center, to_center) - middle * middle;
        let p = along(o, middle - (self.radius * self.radius - miss2).sqrt(), d);
        let n = normal(p);
        let c = -dot(d, n);
        let f = fresnel(c, self.index);
        let mut sum = f * lands(p, along(d, 2.0 * c, n));
        // Refracted: the angle to the normal is the same at each meeting with the skin.
        let t = (1.0 - (1.0 - c * c) / self.index.powi(2)).sqrt();
        let mut w = along([d[0] / self.index, d[1] / self.index], c / self.index - t, n);
        let (mut q, mut left) = (p, 1.0 - f);
        for _ in 0..16 {
            q = along(q, 2.0 * self.radius * t, w);
            let n = normal(q);
            let out = along([w[0] * self.index, w[1] * self.index], c - self.index * t, n);
            sum += left * (1.0 - f) * lands(q, out);
            left *= f;
            w = along(w, -2.0 * t, n);
        }
        sum
    }
}

#[test]
fn the_oracle_loses_nothing_and_follows_snell() {
    let sphere = GlassSphere { center: 2.0, radius: 0.5, index: 1.5, floor_radius: 1e9 };
    let [landed, met] = sphere.flux(Source::Parallel);
    assert!((met - PI * 0.25).abs() < 1e-6 && landed > 0.8 * met && landed < met);
    // All but what goes upward lands on an endless floor; a floor that begins at the sphere's own height gets all of it,
    // and vertical rays at normal incidence give 0.96² + 0.04·….
    let axis = |floor_radius| GlassSphere { floor_radius, ..sphere }.share([0.0, 9.0], [0.0, -1.0]);
    assert!((axis(1e-9) - 0.96 / 1.04).abs() < 1e-12, "even orders go down: {}", axis(1e-9));
    // Paraxial focus: n·R/(2(n − 1)) = 0.75 below the centre.
    let focus = GlassSphere { center: 0.75, floor_radius: 2e-4, ..sphere };
    assert!(focus.share([0.02, 9.0], [0.0, -1.0]) > 0.9);
    assert!(focus.share([0.2, 9.0], [0.0, -1.0]) < 0.1, "aberration");
    let solid_angle = 2.0 * PI * (1.0 - (1.0f64 - 0.0625).sqrt());
    assert!((sphere.flux(Source::Point(4.0))[1] / solid_angle - 1.0).abs() < 1e-6);
}
