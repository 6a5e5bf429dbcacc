use std::f64::consts::TAU;
use std::ops::{Add, Div, Mul, Sub};
use std::sync::LazyLock;

use color::{Lanes, reflectance_to_rgb};
use math::{Vec2, Vec4};

/// A transparent film on a surface, thin enough for interference.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Film {
    /// Sixteenths of a nanometre.
    thickness: u16,
    /// Index times 2¹⁴.
    eta: u16,
}

impl Film {
    /// No film.
    pub const NONE: Self = Self { thickness: 0, eta: 0 };

    /// Of a thickness in nanometres ([0, 4095.9], steps of 1/16; 0 is no film) and an index relative to the outside
    /// ([1, 3.99], steps of 2⁻¹⁴). Values outside are moved in; NaN is no film.
    pub fn new(thickness_nm: f32, eta: f32) -> Self {
        // The casts saturate, and take NaN to 0.
        let thickness = (thickness_nm * 16.0 + 0.5) as u16;
        if thickness == 0 || eta.is_nan() {
            return Self::NONE;
        }
        Self { thickness, eta: (eta.clamp(1.0, 3.99) * 16384.0 + 0.5) as u16 }
    }

    /// Whether there is none.
    #[inline]
    pub fn is_none(self) -> bool {
        self.thickness == 0
    }

    /// Thickness in nanometres.
    pub fn thickness_nm(self) -> f32 {
        f32::from(self.thickness) / 16.0
    }

    /// Index relative to the outside.
    pub fn eta(self) -> f32 {
        f32::from(self.eta) / 16384.0
    }

    /// Reflectance of the film on a base of index n + ik (relative to the outside), seen from the outside at the angle of
    /// cosine `cos`, for unpolarised light: the Airy sum of all reflections between the two faces
    /// (Born & Wolf 1999, §7.6), each lane averaged over the channel's response.
    ///
    /// With a the (real) amplitude of the outer face, b that of the inner one and x = 2·η·d·cos the optical path
    /// difference, the sum is R = 1 − (1 − a²)(1 − |b|²)/(1 − |ab|²) · (1 + 2 Re Σ (−ab)ᵐ e^{2πi·mx/λ}), so that only the
    /// averages of the exponential over the spectrum are needed (Belcour & Barla 2017, §4.2, who fit them;
    /// here they are tabulated). Six terms are summed, which errs by less than 0.01; the result is kept in [0, 1]. For
    /// linear RGB lanes.
    pub fn reflectance(self, cos: f32, n: Lanes, k: Lanes) -> Lanes {
        let cos = cos.clamp(0.0, 1.0);
        let eta = self.eta();
        let sin2 = 1.0 - cos * cos;
        let cos_film = (1.0 - sin2 / (eta * eta)).max(0.0).sqrt();
        let a = [
            (cos - eta * cos_film) / (cos + eta * cos_film).max(1e-20),
            (eta * cos - cos_film) / (eta * cos + cos_film).max(1e-20),
        ];
        let path_nm = 2.0 * eta * self.thickness_nm() * cos_film;
        let waves: [[Vec2; 3]; TERMS] = std::array::from_fn(|m| mean_wave(path_nm * (m + 1) as f32));
        let lane = |c: usize, n: f32, k: f32| {
            let index = Complex::new(n, k);
            let cos_base = (Complex::new(1.0, 0.0) - Complex::new(sin2, 0.0) / (index * index)).sqrt();
            let (film, cos_film) = (Complex::new(eta, 0.0), Complex::new(cos_film, 0.0));
            let b = [
                (film * cos_film - index * cos_base) / (film * cos_film + index * cos_base),
                (index * cos_film - film * cos_base) / (index * cos_film + film * cos_base),
            ];
            0.5 * (airy(a[0], b[0], &waves, c) + airy(a[1], b[1], &waves, c))
        };
        let r = lane(0, n.0.x, k.0.x);
        // The fourth lane carries no light; it repeats the first, so that the greatest lane is one that does.
        Lanes(Vec4::new(r, lane(1, n.0.y, k.0.y), lane(2, n.0.z, k.0.z), r))
    }
}

/// Terms of the sum.
const TERMS: usize = 6;

fn airy(a: f32, b: Complex, waves: &[[Vec2; 3]; TERMS], channel: usize) -> f32 {
    let b2 = (b.re * b.re + b.im * b.im).min(1.0);
    let a2 = (a * a).min(1.0);
    let step = b * Complex::new(-a, 0.0);
    let mut power = step;
    let mut sum = 1.0;
    for wave in waves {
        let w = wave[channel];
        sum += 2.0 * (power.re * w.x - power.im * w.y);
        power = power * step;
    }
    let through = (1.0 - a2) * (1.0 - b2) / (1.0 - a2 * b2).max(1e-12);
    (1.0 - through * sum).clamp(0.0, 1.0)
}

/// Step of the table of waves, in nanometres: a fortieth of the shortest period.
const STEP_NM: f32 = 10.0;
/// Length of the table: beyond 20 µm of path difference nothing is left to see.
const STEPS: usize = 2001;

/// Means of (cos, sin)(2πx/λ) over the response of each channel under D65, at multiples of [`STEP_NM`].
static WAVES: LazyLock<Vec<[Vec2; 3]>> = LazyLock::new(|| {
    let wave = |i: usize| {
        let x = TAU * f64::from(STEP_NM) * i as f64;
        let c = reflectance_to_rgb(|nm| (x / nm).cos());
        let s = reflectance_to_rgb(|nm| (x / nm).sin());
        std::array::from_fn(|j| Vec2::new(c[j] as f32, s[j] as f32))
    };
    (0..STEPS).map(wave).collect()
});

fn mean_wave(path_nm: f32) -> [Vec2; 3] {
    let place = path_nm / STEP_NM;
    let i = place as usize;
    if i + 1 >= STEPS {
        return [Vec2::ZERO; 3];
    }
    let (w, t) = (&*WAVES, place - i as f32);
    std::array::from_fn(|c| w[i][c].lerp(w[i + 1][c], t))
}

#[derive(Clone, Copy)]
struct Complex {
    re: f32,
    im: f32,
}

impl Complex {
    fn new(re: f32, im: f32) -> Self {
        Self { re, im }
    }

    /// The root in the right half plane.
    fn sqrt(self) -> Self {
        let length = self.re.hypot(self.im);
        let re = (0.5 * (length + self.re)).max(0.0).sqrt();
        let im = (0.5 * (length - self.re)).max(0.0).sqrt();
        Self { re, im: if self.im < 0.0 { -im } else { im } }
    }
}

impl Add for Complex {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Self::new(self.re + o.re, self.im + o.im)
    }
}
impl Sub for Complex {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        Self::new(self.re - o.re, self.im - o.im)
    }
}
impl Mul for Complex {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        Self::new(self.re * o.re - self.im * o.im, self.re * o.im + self.im * o.re)
    }
}
impl Div for Complex {
    type Output = Self;
    /// Of a denominator near 0 the result is large, never NaN.
    fn div(self, o: Self) -> Self {
        let d = (o.re * o.re + o.im * o.im).max(1e-24);
        Self::new((self.re * o.re + self.im * o.im) / d, (self.im * o.re - self.re * o.im) / d)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fresnel::{fresnel_conductor, fresnel_dielectric};

    /// Airy's formula at one wavelength in f64, for a dielectric base, real amplitudes.
    fn exact(cos: f64, eta: f64, base: f64, d: f64, nm: f64) -> f64 {
        let sin2 = 1.0 - cos * cos;
        let (c2, c3) = ((1.0 - sin2 / (eta * eta)).sqrt(), (1.0 - sin2 / (base * base)).sqrt());
        let of = |a: f64, b: f64| {
            let two = 2.0 * a * b * (TAU * 2.0 * eta * d * c2 / nm).cos();
            (a * a + b * b + two) / (1.0 + a * a * b * b + two)
        };
        let s = of((cos - eta * c2) / (cos + eta * c2), (eta * c2 - base * c3) / (eta * c2 + base * c3));
        let p = of((eta * cos - c2) / (eta * cos + c2), (base * c2 - eta * c3) / (base * c2 + eta * c3));
        0.5 * (s + p)
    }

    #[test]
    fn equals_the_spectral_integral() {
        for (eta, base) in [(1.3, 1.5), (1.8, 1.5), (2.4, 1.3)] {
            for d in [40.0, 120.0, 400.0, 1500.0] {
                for cos in [1.0, 0.7, 0.4, 0.15] {
                    let film = Film::new(d, eta as f32);
                    let found = film.reflectance(cos as f32, Lanes::splat(base as f32), Lanes::ZERO);
                    let expected = reflectance_to_rgb(|nm| exact(cos, eta, base, d.into(), nm));
                    for (f, e) in found.to_rgb().iter().zip(expected) {
                        let e = e.clamp(0.0, 1.0);
                        assert!((f64::from(*f) - e).abs() < 0.01, "{eta} {base} {d} {cos}: {f} {e}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_vanishing_film_is_none() {
        let film = Film::new(0.07, 1.4);
        for cos in [1.0, 0.6, 0.3] {
            let glass = film.reflectance(cos, Lanes::splat(1.5), Lanes::ZERO).0.x;
            assert!((glass - fresnel_dielectric(cos, 1.5)).abs() < 2e-3, "{cos}");
            let (n, k) = (Lanes::rgb(0.16, 0.42, 1.51), Lanes::rgb(3.8, 2.4, 1.88));
            let metal = (film.reflectance(cos, n, k) - fresnel_conductor(cos, n, k)).0.abs();
            assert!(metal.truncate().max_element() < 5e-3, "{cos} {metal}");
        }
    }

    #[test]
    fn an_antireflective_coat_and_colours() {
        // A quarter of 550 nm of index √1.5 on glass of 1.5 takes the reflection of green away.
        let film = Film::new(550.0 / 4.0 / 1.2247, 1.2247);
        assert!(film.reflectance(1.0, Lanes::splat(1.5), Lanes::ZERO).0.y < 0.003);
        // A film of 500 nm has a colour, one of 4 µm none (white light has too many fringes).
        let spread = |d| {
            let [r, g, b] = Film::new(d, 2.0).reflectance(1.0, Lanes::splat(1.5), Lanes::ZERO).to_rgb();
            (r - g).abs().max((b - g).abs())
        };
        assert!(spread(500.0) > 0.03 && spread(4000.0) < 0.003, "{} {}", spread(500.0), spread(4000.0));
        assert!(Film::new(0.0, 1.5).is_none() && Film::new(f32::NAN, 1.5).is_none());
    }
}
