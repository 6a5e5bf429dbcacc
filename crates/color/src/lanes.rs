use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Sub};

use math::Vec4;

/// Four values of a spectral quantity; transport works on these alone. What they mean says the [`LaneBasis`] of
/// the pass.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Lanes(pub Vec4);

/// Meaning of the four lanes of a pass.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LaneBasis {
    /// Red, green, blue of linear Rec. 709 primaries (D65); the fourth lane is 0.
    #[default]
    LinearRgb,
}

impl LaneBasis {
    /// A reflectance or another factor, given as linear RGB.
    pub fn from_rgb(self, rgb: [f32; 3]) -> Lanes {
        match self {
            Self::LinearRgb => Lanes(Vec4::new(rgb[0], rgb[1], rgb[2], 0.0)),
        }
    }

    /// Linear RGB of the lanes.
    pub fn to_rgb(self, lanes: Lanes) -> [f32; 3] {
        match self {
            Self::LinearRgb => [lanes.0.x, lanes.0.y, lanes.0.z],
        }
    }
}

impl Lanes {
    /// All lanes 0.
    pub const ZERO: Self = Self(Vec4::ZERO);
    /// All lanes 1.
    pub const ONE: Self = Self(Vec4::ONE);

    /// All lanes `x`.
    #[inline]
    pub const fn splat(x: f32) -> Self {
        Self(Vec4::splat(x))
    }

    /// Linear RGB in the basis [`LaneBasis::LinearRgb`].
    #[inline]
    pub const fn rgb(r: f32, g: f32, b: f32) -> Self {
        Self(Vec4::new(r, g, b, 0.0))
    }

    /// The first three lanes.
    #[inline]
    pub fn to_rgb(self) -> [f32; 3] {
        [self.0.x, self.0.y, self.0.z]
    }

    /// Greatest lane.
    #[inline]
    pub fn max(self) -> f32 {
        self.0.max_element()
    }

    /// Mean of the lanes that carry light (three in an RGB basis).
    #[inline]
    pub fn mean(self) -> f32 {
        (self.0.x + self.0.y + self.0.z) * (1.0 / 3.0)
    }

    /// Whether every lane is 0.
    #[inline]
    pub fn is_zero(self) -> bool {
        self.0 == Vec4::ZERO
    }

    /// Whether every lane is finite.
    #[inline]
    pub fn is_finite(self) -> bool {
        self.0.is_finite()
    }

    /// Lane by lane.
    #[inline]
    pub fn map(self, f: impl Fn(f32) -> f32) -> Self {
        Self(Vec4::new(f(self.0.x), f(self.0.y), f(self.0.z), f(self.0.w)))
    }

    /// Each lane moved into [low, high].
    #[inline]
    pub fn clamp(self, low: f32, high: f32) -> Self {
        Self(self.0.clamp(Vec4::splat(low), Vec4::splat(high)))
    }
}

impl Add for Lanes {
    type Output = Self;
    #[inline]
    fn add(self, o: Self) -> Self {
        Self(self.0 + o.0)
    }
}
impl Sub for Lanes {
    type Output = Self;
    #[inline]
    fn sub(self, o: Self) -> Self {
        Self(self.0 - o.0)
    }
}
impl AddAssign for Lanes {
    #[inline]
    fn add_assign(&mut self, o: Self) {
        self.0 += o.0;
    }
}
impl Mul for Lanes {
    type Output = Self;
    #[inline]
    fn mul(self, o: Self) -> Self {
        Self(self.0 * o.0)
    }
}
impl Mul<f32> for Lanes {
    type Output = Self;
    #[inline]
    fn mul(self, s: f32) -> Self {
        Self(self.0 * s)
    }
}
impl Mul<Lanes> for f32 {
    type Output = Lanes;
    #[inline]
    fn mul(self, l: Lanes) -> Lanes {
        l * self
    }
}
impl MulAssign for Lanes {
    #[inline]
    fn mul_assign(&mut self, o: Self) {
        self.0 *= o.0;
    }
}
impl MulAssign<f32> for Lanes {
    #[inline]
    fn mul_assign(&mut self, s: f32) {
        self.0 *= s;
    }
}
impl Div<f32> for Lanes {
    type Output = Self;
    #[inline]
    fn div(self, s: f32) -> Self {
        Self(self.0 / s)
    }
}
