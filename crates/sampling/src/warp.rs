//! Maps from the unit square to densities. Each has its density beside it; directions are about +z.

use math::{FRAC_1_PI, ONE_MINUS_EPSILON, PI, Vec2, Vec3, spherical_direction};

/// Uniform on the unit disc (Shirley & Chiu 1997: concentric, keeps neighbours together).
#[inline]
pub fn disk(u: [f32; 2]) -> Vec2 {
    let x = 2.0 * u[0] - 1.0;
    let y = 2.0 * u[1] - 1.0;
    if x == 0.0 && y == 0.0 {
        return Vec2::ZERO;
    }
    let (r, theta) =
        if x.abs() > y.abs() { (x, PI / 4.0 * (y / x)) } else { (y, PI / 2.0 - PI / 4.0 * (x / y)) };
    let (s, c) = theta.sin_cos();
    r * Vec2::new(c, s)
}

/// The numbers for which [`disk`] gives `p`.
pub fn disk_inverse(p: Vec2) -> [f32; 2] {
    let r = p.length();
    let (x, y) = if p.x.abs() > p.y.abs() {
        let x = r.copysign(p.x);
        (x, x * (p.y / p.x).atan() * (4.0 / PI))
    } else if r > 0.0 {
        let y = r.copysign(p.y);
        (y * (p.x / p.y).atan() * (4.0 / PI), y)
    } else {
        (0.0, 0.0)
    };
    [x, y].map(|x| (0.5 * x + 0.5).clamp(0.0, ONE_MINUS_EPSILON))
}

/// Cosine-weighted on the upper hemisphere.
#[inline]
pub fn cosine_hemisphere(u: [f32; 2]) -> Vec3 {
    let d = disk(u);
    d.extend((1.0 - d.length_squared()).max(0.0).sqrt())
}

/// Density of [`cosine_hemisphere`] per steradian.
#[inline]
pub fn cosine_hemisphere_pdf_w(cos_theta: f32) -> f32 {
    cos_theta.max(0.0) * FRAC_1_PI
}

/// Uniform on the unit sphere.
pub fn sphere(u: [f32; 2]) -> Vec3 {
    spherical_direction(1.0 - 2.0 * u[0], 2.0 * PI * u[1])
}

/// The numbers for which [`sphere`] gives the unit vector `w`.
pub fn sphere_inverse(w: Vec3) -> [f32; 2] {
    let phi = w.y.atan2(w.x) / (2.0 * PI);
    [0.5 - 0.5 * w.z, if phi < 0.0 { phi + 1.0 } else { phi }].map(|x| x.clamp(0.0, ONE_MINUS_EPSILON))
}

/// Density of [`sphere`] per steradian.
pub const SPHERE_PDF_W: f32 = 0.25 * FRAC_1_PI;

/// Uniform in the cone of half-angle acos(1 − `one_minus_cos`); the argument keeps narrow cones exact.
pub fn cone(u: [f32; 2], one_minus_cos: f32) -> Vec3 {
    let z = u[0] * one_minus_cos;
    let sin_theta = (z * (2.0 - z)).max(0.0).sqrt();
    let (s, c) = (2.0 * PI * u[1]).sin_cos();
    Vec3::new(sin_theta * c, sin_theta * s, 1.0 - z)
}

/// Density of [`cone`] per steradian inside the cone.
pub fn cone_pdf_w(one_minus_cos: f32) -> f32 {
    1.0 / (2.0 * PI * one_minus_cos)
}

/// Barycentric coordinates (b0, b1), uniform on a triangle (Heitz 2019, "A low-distortion map between triangle
/// and square").
pub fn triangle(u: [f32; 2]) -> [f32; 2] {
    if u[0] < u[1] {
        let b0 = u[0] * 0.5;
        [b0, u[1] - b0]
    } else {
        let b1 = u[1] * 0.5;
        [u[0] - b1, b1]
    }
}

/// The numbers for which [`triangle`] gives `b`.
pub fn triangle_inverse([b0, b1]: [f32; 2]) -> [f32; 2] {
    let u = if b0 < b1 { [2.0 * b0, b0 + b1] } else { [b0 + b1, 2.0 * b1] };
    u.map(|x| x.clamp(0.0, ONE_MINUS_EPSILON))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inverses_give_the_numbers_back() {
        for i in 0..10_000 {
            let u = [(i % 100) as f32, (i / 100) as f32].map(|x| (x + 0.37) / 100.0);
            for back in [disk_inverse(disk(u)), sphere_inverse(sphere(u)), triangle_inverse(triangle(u))] {
                assert!((back[0] - u[0]).abs().max((back[1] - u[1]).abs()) < 1e-4, "{u:?} {back:?}");
            }
        }
    }
}
