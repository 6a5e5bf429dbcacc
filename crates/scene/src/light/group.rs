//! What a group of lights at finite places, or one of them, may send to a receiver at most (Conty Estévez & Kulla 2018,
//! "Importance sampling of many lights with adaptive tree splitting", §5.2).

use math::{Bounds3, PI, Vec3, Vec4};

use super::cone::Cone;
use super::{Light, Receiver};

/// Least share of a group's intensity that it keeps however it is turned: so that no rounding loses light along a horizon.
const LEAST_COSINE: f32 = 0.01;
/// By how much cosines may be off before a group counts as turned away.
const SLACK: f32 = 2e-3;

/// Whether a light lies at a finite place and shines.
pub(super) fn is_local(light: &Light) -> bool {
    let power = light.power().mean();
    !light.is_infinite() && power > 0.0 && power.is_finite()
}

/// Where lights are, which way they shine, and how strongly.
#[derive(Clone, Copy)]
pub(super) struct Group {
    pub bounds: Bounds3,
    pub cone: Cone,
    /// W/sr.
    pub intensity: f64,
}

impl Group {
    pub fn of(light: &Light) -> Self {
        let cone = Cone::of(light);
        // Flux over the solid angle that a light of this kind fills at its greatest intensity.
        let solid_angle = match light {
            Light::Spot(l) => l.solid_angle() as f32,
            Light::Disk(_) | Light::Triangles(_) if cone.spread < 0.5 * PI => PI,
            Light::Disk(_) => 2.0 * PI,
            _ => 4.0 * PI,
        };
        Self { bounds: light.bounds(), cone, intensity: f64::from(light.power().mean() / solid_angle) }
    }

    pub fn union(self, other: Self) -> Self {
        Self {
            bounds: self.bounds.union(other.bounds),
            cone: self.cone.union(other.cone),
            intensity: self.intensity + other.intensity,
        }
    }
}

/// Up to four groups as receivers see them, a lane each; lanes without one are dark.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Bounds4 {
    /// Middle of their bounds.
    center: [Vec4; 3],
    /// Half the diagonal of the bounds, squared.
    radius2: Vec4,
    axis: [Vec4; 3],
    cos_spread: Vec4,
    sin_spread: Vec4,
    /// Of the angle beyond which nothing leaves.
    cos_reach: Vec4,
    /// W/sr.
    intensity: Vec4,
}

impl Bounds4 {
    pub fn new(groups: impl IntoIterator<Item = Group>) -> Self {
        let mut all = Self::default();
        for (lane, group) in groups.into_iter().enumerate().take(4) {
            let (sin_spread, cos_spread) = group.cone.spread.sin_cos();
            let center = group.bounds.center();
            for axis in 0..3 {
                all.center[axis][lane] = center[axis];
                all.axis[axis][lane] = group.cone.axis[axis];
            }
            all.radius2[lane] = 0.25 * group.bounds.size().length_squared();
            all.cos_spread[lane] = cos_spread;
            all.sin_spread[lane] = sin_spread.max(0.0);
            all.cos_reach[lane] = group.cone.reach.cos() - SLACK;
            all.intensity[lane] = group.intensity as f32;
        }
        all
    }

    /// Bounds of the irradiance from each at the receiver, up to a factor: intensity · cos θ′ · cos θᵢ′/d².
    #[inline]
    pub fn importance(&self, at: &Receiver) -> Vec4 {
        let to_center: [Vec4; 3] = std::array::from_fn(|i| self.center[i] - Vec4::splat(at.p[i]));
        let d2 = dot(&to_center, &to_center);
        let over_d = Vec4::ONE / d2.max(Vec4::splat(f32::MIN_POSITIVE)).sqrt();
        // Angle that the bounds fill at the receiver; within them they are all around.
        let outside = d2.cmpgt(self.radius2);
        let s2 = Vec4::select(outside, self.radius2 / d2, Vec4::ZERO);
        let fills = (Vec4::select(outside, (Vec4::ONE - s2).sqrt(), Vec4::NEG_ONE), s2.sqrt());
        let out = with_sine(-dot(&self.axis, &to_center) * over_d);
        let (cos_out, _) = less(less(out, (self.cos_spread, self.sin_spread)), fills);
        let least = Vec4::splat(LEAST_COSINE);
        let sent = Vec4::select(cos_out.cmplt(self.cos_reach), Vec4::ZERO, cos_out.max(least));
        let arriving = sent * self.intensity / d2.max(self.radius2).max(Vec4::splat(1e-20));
        if at.n == Vec3::ZERO {
            return arriving;
        }
        let middle = with_sine(dot(&at.n.to_array().map(Vec4::splat), &to_center) * over_d);
        let (cos_in, _) = less(middle, fills);
        // Half the bound, half what the middle has: the bound alone makes much of groups along the horizon.
        let received = (0.5 * (cos_in + middle.0.max(Vec4::ZERO))).max(least);
        arriving * Vec4::select(cos_in.cmplt(Vec4::splat(-SLACK)), Vec4::ZERO, received)
    }
}

#[inline]
fn dot(a: &[Vec4; 3], b: &[Vec4; 3]) -> Vec4 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Cosine and sine of an angle in [0, π].
#[inline]
fn with_sine(cos: Vec4) -> (Vec4, Vec4) {
    let cos = cos.clamp(Vec4::NEG_ONE, Vec4::ONE);
    (cos, (Vec4::ONE - cos * cos).max(Vec4::ZERO).sqrt())
}

/// Cosine and sine of max(0, a − b), both angles given by (cosine, sine).
#[inline]
fn less((cos_a, sin_a): (Vec4, Vec4), (cos_b, sin_b): (Vec4, Vec4)) -> (Vec4, Vec4) {
    let inside = cos_a.cmpgt(cos_b);
    let cos = Vec4::select(inside, Vec4::ONE, cos_a * cos_b + sin_a * sin_b);
    (cos, Vec4::select(inside, Vec4::ZERO, sin_a * cos_b - cos_a * sin_b))
}
