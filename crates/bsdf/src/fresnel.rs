use color::Lanes;
use math::Vec4;

use crate::reflectance::hemispherical_mean;

/// Reflectance of a smooth dielectric interface for unpolarised light, exact (Born & Wolf 1999, §1.5.2).
/// `cos_i` ≥ 0: cosine of the angle of incidence; `eta`: index of the far side over that of the near side.
/// 1 under total internal reflection and at grazing incidence.
#[inline]
pub fn fresnel_dielectric(cos_i: f32, eta: f32) -> f32 {
    match refracted_cosine(cos_i, eta) {
        Some(cos_t) if cos_i > 0.0 => {
            let s = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
            let p = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
            0.5 * (s * s + p * p)
        }
        _ => 1.0,
    }
}

/// Cosine of the angle of refraction (Snell); `None` under total internal reflection.
/// Written so that nothing cancels near grazing incidence for `eta` = 1.
#[inline]
pub(crate) fn refracted_cosine(cos_i: f32, eta: f32) -> Option<f32> {
    let t = (eta - 1.0) * (eta + 1.0) + cos_i * cos_i;
    (t >= 0.0).then(|| (t.sqrt() / eta).min(1.0))
}

/// Reflectance of a smooth conductor of complex index n + ik relative to the outside, for unpolarised light, exact
/// (Born & Wolf 1999, §14.2). `cos_i` in [0, 1]; n, k in [0, 10⁶]. The result lies in [0, 1], also where n = k = 0.
#[inline]
pub fn fresnel_conductor(cos_i: f32, n: Lanes, k: Lanes) -> Lanes {
    let one = Vec4::ONE;
    let tiny = Vec4::splat(1e-30);
    let cos = cos_i.clamp(0.0, 1.0);
    let cos2 = Vec4::splat(cos * cos);
    let sin2 = one - cos2;
    let (n, k) = (n.0, k.0);
    let t0 = (n - k) * (n + k) - sin2;
    let nk2 = 2.0 * n * k;
    let a2b2 = sqrt(t0 * t0 + nk2 * nk2);
    let a = sqrt((0.5 * (a2b2 + t0)).max(Vec4::ZERO));
    let t1 = a2b2 + cos2;
    let t2 = 2.0 * cos * a;
    let rs = (t1 - t2).max(Vec4::ZERO) / (t1 + t2).max(tiny);
    let t3 = cos2 * a2b2 + sin2 * sin2;
    let t4 = t2 * sin2;
    let rp = rs * ((t3 - t4).max(Vec4::ZERO) / (t3 + t4).max(tiny));
    Lanes((0.5 * (rs + rp)).min(one))
}

#[inline]
fn sqrt(v: Vec4) -> Vec4 {
    Vec4::new(v.x.sqrt(), v.y.sqrt(), v.z.sqrt(), v.w.sqrt())
}

/// 2∫F(μ) μ dμ over the hemisphere: mean reflectance of a smooth dielectric interface under diffuse light, in
/// closed form (Walsh 1926; see Duntley 1942). `eta` > 0 as in [`fresnel_dielectric`]; below 1 by
/// 1 − F(1/η) = η⁻²·(1 − F(η)) turned about. Absolute error below 1e-4 (within 10⁻³ of η = 1), 1e-7 elsewhere.
pub fn fresnel_dielectric_mean(eta: f32) -> f32 {
    let eta = f64::from(eta);
    if eta < 1.0 {
        let n = 1.0 / eta;
        return (1.0 - (1.0 - walsh(n)) / (n * n)) as f32;
    }
    walsh(eta) as f32
}

fn walsh(n: f64) -> f64 {
    if n < 1.0 + 1e-4 {
        return 0.0;
    }
    let (n2, n4) = (n * n, n * n * n * n);
    0.5 + (n - 1.0) * (3.0 * n + 1.0) / (6.0 * (n + 1.0).powi(2))
        + n2 * (n2 - 1.0).powi(2) / (n2 + 1.0).powi(3) * ((n - 1.0) / (n + 1.0)).ln()
        - 2.0 * n * n2 * (n2 + 2.0 * n - 1.0) / ((n2 + 1.0) * (n4 - 1.0))
        + 8.0 * n4 * (n4 + 1.0) / ((n2 + 1.0) * (n4 - 1.0).powi(2)) * n.ln()
}

/// 2∫F(μ) μ dμ of a conductor, per lane, by four-point Gauss–Legendre quadrature in μ: F is nearly linear in μ for
/// metals, and the error stays below 2e-3 for the indices of metals.
pub(crate) fn fresnel_conductor_mean(n: Lanes, k: Lanes) -> Lanes {
    hemispherical_mean(|mu| fresnel_conductor(mu, n, k))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Midpoint rule for 2∫F μ dμ.
    fn mean(f: impl Fn(f32) -> f32) -> f64 {
        let n = 20_000;
        (0..n).map(|i| (i as f32 + 0.5) / n as f32).map(|mu| 2.0 * f64::from(mu * f(mu))).sum::<f64>()
            / f64::from(n)
    }

    #[test]
    fn dielectric_known_values() {
        // Normal incidence: ((n − 1)/(n + 1))², from either side.
        for eta in [1.5, 1.0 / 1.5] {
            assert!((fresnel_dielectric(1.0, eta) - 0.04).abs() < 1e-6);
        }
        assert!((fresnel_dielectric(1.0, 1.33) - 0.020_06).abs() < 1e-5);
        // Brewster: tan θ = n; only s light is reflected, Rs = ((n² − 1)/(n² + 1))².
        let cos_b = 1.0 / (1.0f32 + 2.25).sqrt();
        assert!((fresnel_dielectric(cos_b, 1.5) - 0.5 * (1.25f32 / 3.25).powi(2)).abs() < 1e-6);
        // 60° in air on n = 1.5: Rs 0.177, Rp 0.0018 (Hecht, Optics).
        assert!((fresnel_dielectric(0.5, 1.5) - 0.089_2).abs() < 1e-4);
        // Beyond the critical angle of 41.8°.
        assert_eq!(fresnel_dielectric(45f32.to_radians().cos(), 1.0 / 1.5), 1.0);
        assert!(fresnel_dielectric(41f32.to_radians().cos(), 1.0 / 1.5) < 0.5);
        for eta in [0.5, 1.0, 1.5] {
            assert_eq!(fresnel_dielectric(0.0, eta), 1.0);
        }
        assert_eq!(fresnel_dielectric(1e-4, 1.0), 0.0);
    }

    #[test]
    fn dielectric_is_the_same_from_both_sides() {
        for i in 1..100 {
            let cos_i = i as f32 / 100.0;
            let cos_t = refracted_cosine(cos_i, 1.7).unwrap();
            let difference = fresnel_dielectric(cos_i, 1.7) - fresnel_dielectric(cos_t, 1.0 / 1.7);
            assert!(difference.abs() < 2e-6 / cos_i, "ill-conditioned towards grazing");
        }
    }

    #[test]
    fn conductor_known_values() {
        // Normal incidence: ((n − 1)² + k²)/((n + 1)² + k²). Gold at 650, 550, 450 nm: n 0.16, 0.42, 1.51;
        // k 3.8, 2.4, 1.88 (Johnson & Christy 1972, rounded).
        let (n, k) = (Lanes::rgb(0.16, 0.42, 1.51), Lanes::rgb(3.8, 2.4, 1.88));
        let f = fresnel_conductor(1.0, n, k).to_rgb();
        for (f, expected) in f.iter().zip([15.1456 / 15.7856, 6.0964 / 7.7764, 3.7945 / 9.8345]) {
            assert!((f - expected).abs() < 1e-6, "{f} {expected}");
        }
        assert_eq!(fresnel_conductor(0.0, n, k).to_rgb(), [1.0; 3]);
    }

    #[test]
    fn conductor_without_absorption_is_a_dielectric() {
        for i in 0..=100 {
            let cos_i = i as f32 / 100.0;
            let c = fresnel_conductor(cos_i, Lanes::splat(1.5), Lanes::ZERO).max();
            assert!((c - fresnel_dielectric(cos_i, 1.5)).abs() < 2e-5, "{cos_i}");
        }
    }

    #[test]
    fn conductor_is_never_nan() {
        for n in [0.0, 1e-3, 1.0, 5.0, 1e6] {
            for k in [0.0, 1e-3, 1.0, 5.0, 1e6] {
                for cos_i in [0.0, 1e-20, 1e-4, 0.5, 1.0] {
                    let f = fresnel_conductor(cos_i, Lanes::splat(n), Lanes::splat(k)).max();
                    assert!((0.0..=1.0).contains(&f), "{n} {k} {cos_i}: {f}");
                }
            }
        }
    }

    #[test]
    fn means() {
        for eta in [1.01, 1.33, 1.5, 2.4, 4.0, 1.0 / 1.33, 1.0 / 1.5] {
            let expected = mean(|mu| fresnel_dielectric(mu, eta));
            assert!((f64::from(fresnel_dielectric_mean(eta)) - expected).abs() < 2e-6, "{eta} {expected}");
        }
        for (n, k) in [(0.16, 3.8), (1.51, 1.88), (2.9, 3.1), (0.05, 4.0), (1.3, 7.5)] {
            let (n, k) = (Lanes::splat(n), Lanes::splat(k));
            let expected = mean(|mu| fresnel_conductor(mu, n, k).max());
            assert!((f64::from(fresnel_conductor_mean(n, k).max()) - expected).abs() < 2e-3);
        }
    }
}
