use crate::{Vec2, Vec3};

/// The unit vector with polar cosine `cos_theta` about z and azimuth `phi` (radians).
pub fn spherical_direction(cos_theta: f32, phi: f32) -> Vec3 {
    let sin_theta = (1.0 - cos_theta * cos_theta).max(0.0).sqrt();
    let (s, c) = phi.sin_cos();
    Vec3::new(sin_theta * c, sin_theta * s, cos_theta)
}

/// `wo` mirrored about `n`; both point away from the surface.
#[inline]
pub fn reflect(wo: Vec3, n: Vec3) -> Vec3 {
    n * (2.0 * wo.dot(n)) - wo
}

/// Snell's law: the transmitted direction for `wo` above `n` (`wo·n > 0`) and `eta` = index of the far side over
/// that of the side of `wo`. `None`: total internal reflection.
#[inline]
pub fn refract(wo: Vec3, n: Vec3, eta: f32) -> Option<Vec3> {
    let cos_i = wo.dot(n);
    let sin2_t = (1.0 - cos_i * cos_i).max(0.0) / (eta * eta);
    if sin2_t >= 1.0 {
        return None;
    }
    let cos_t = (1.0 - sin2_t).sqrt();
    Some((-wo / eta + n * (cos_i / eta - cos_t)).normalize())
}

/// A unit vector in 32 bits: two 16-bit coordinates of the octahedral map (Cigolle et al. 2014).
/// Greatest error: 0.004°.
pub fn octahedral_encode(v: Vec3) -> u32 {
    let v = v / (v.x.abs() + v.y.abs() + v.z.abs());
    let p = if v.z >= 0.0 {
        Vec2::new(v.x, v.y)
    } else {
        Vec2::new((1.0 - v.y.abs()).copysign(v.x), (1.0 - v.x.abs()).copysign(v.y))
    };
    let q = |x: f32| ((x.clamp(-1.0, 1.0) * 0.5 + 0.5) * 65534.0 + 0.5) as u32;
    q(p.x) | (q(p.y) << 16)
}

/// The unit vector of [`octahedral_encode`].
#[inline]
pub fn octahedral_decode(code: u32) -> Vec3 {
    let d = |x: u32| x as f32 * (2.0 / 65534.0) - 1.0;
    let (x, y) = (d(code & 0xffff), d(code >> 16));
    let z = 1.0 - x.abs() - y.abs();
    let t = (-z).max(0.0);
    Vec3::new(x - t.copysign(x), y - t.copysign(y), z).normalize()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn octahedral_round_trip() {
        for i in 0..10_000 {
            let v = spherical_direction(1.0 - 2.0 * (i as f32 + 0.5) / 10_000.0, i as f32 * 2.399_963);
            let e = (octahedral_decode(octahedral_encode(v)) - v).length();
            assert!(e < 7e-5, "{v} {e}");
        }
        for v in [Vec3::X, Vec3::Y, Vec3::Z, -Vec3::X, -Vec3::Y, -Vec3::Z] {
            assert!((octahedral_decode(octahedral_encode(v)) - v).length() < 7e-5, "{v}");
        }
    }

    #[test]
    fn snell() {
        let wo = spherical_direction(0.5, 0.3);
        let wi = refract(wo, Vec3::Z, 1.5).unwrap();
        let sin = |w: Vec3| (1.0 - w.z * w.z).sqrt();
        assert!((sin(wo) - 1.5 * sin(wi)).abs() < 1e-6);
        assert!(wi.z < 0.0 && (wi.x * wo.y - wi.y * wo.x).abs() < 1e-6, "coplanar, other side");
        assert_eq!(refract(wo, Vec3::Z, 1.0 / 1.5), None, "total internal reflection at 60°");
        assert!((reflect(wo, Vec3::Z) - Vec3::new(-wo.x, -wo.y, wo.z)).length() < 1e-6);
    }
}
