use math::{PI, Vec3};

/// Cosine-weighted about +z by the concentric map (Shirley & Chiu 1997), without trigonometric calls: the angle
/// stays within ±π/4, where Taylor polynomials of degree 9 and 8 err by less than 3e-8.
#[inline]
pub(crate) fn cosine_hemisphere(u: [f32; 2]) -> Vec3 {
    let x = 2.0 * u[0] - 1.0;
    let y = 2.0 * u[1] - 1.0;
    let swap = x.abs() <= y.abs();
    let (r, q) = if swap { (y, x) } else { (x, y) };
    let t = PI / 4.0 * if r == 0.0 { 0.0 } else { q / r };
    let t2 = t * t;
    let s =
        t * (1.0 + t2 * (-1.0 / 6.0 + t2 * (1.0 / 120.0 + t2 * (-1.0 / 5040.0 + t2 * (1.0 / 362_880.0)))));
    let c = 1.0 + t2 * (-0.5 + t2 * (1.0 / 24.0 + t2 * (-1.0 / 720.0 + t2 * (1.0 / 40_320.0))));
    let (dx, dy) = if swap { (r * s, r * c) } else { (r * c, r * s) };
    Vec3::new(dx, dy, (1.0 - r * r).max(0.0).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_the_warp_of_sampling() {
        for i in 0..=64 {
            for j in 0..=64 {
                let u = [i as f32 / 64.0, j as f32 / 64.0];
                let (a, b) = (cosine_hemisphere(u), sampling::warp::cosine_hemisphere(u));
                assert!((a - b).truncate().length() < 3e-7, "{u:?} {a} {b}");
                assert!(
                    (a.z * a.z - b.z * b.z).abs() < 1e-6 && (a.length() - 1.0).abs() < 3e-7,
                    "{u:?} {a} {b}"
                );
            }
        }
    }
}
