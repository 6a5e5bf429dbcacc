//! Directions from a point of a light toward targets.

use math::{Frame, PI, Vec3};
use sampling::warp;

use super::emission::Emission;
use crate::target::{MAX_TARGETS, Targets};

/// The mixture at one point x: target j is chosen with probability ½·Ωⱼwⱼ/ΣΩw + ½/J over the targets that the light
/// can reach; the direction is then uniform in the cone that its sphere subtends, or the light's own where that is
/// narrower and where x lies in the sphere.
struct Mixture {
    len: usize,
    lobes: [Lobe; MAX_TARGETS],
}

#[derive(Clone, Copy)]
struct Lobe {
    /// Probability.
    q: f32,
    /// Unit direction of the cone.
    axis: Vec3,
    /// 1 − cos of its half-angle; 0 marks the light's own distribution.
    one_minus_cos: f32,
}

impl Lobe {
    fn pdf_w(&self, emission: &Emission<'_>, w: Vec3, drawn: bool) -> f32 {
        if self.one_minus_cos == 0.0 {
            emission.pdf_w(w)
        } else if drawn || 0.5 * (w - self.axis).length_squared() <= self.one_minus_cos {
            warp::cone_pdf_w(self.one_minus_cos)
        } else {
            0.0
        }
    }
}

impl Mixture {
    fn new(targets: &Targets, x: Vec3, emission: &Emission<'_>) -> Self {
        let empty = Lobe { q: 0.0, axis: Vec3::Z, one_minus_cos: 0.0 };
        let mut mixture = Self { len: 0, lobes: [empty; MAX_TARGETS] };
        let own = emission.solid_angle();
        let mut total = 0.0;
        for t in targets.as_slice() {
            let to_center = t.center - x;
            if !emission.may_reach(to_center, t.radius) {
                continue;
            }
            let d2 = to_center.as_dvec3().length_squared();
            let sin2 = f64::from(t.radius).powi(2) / d2;
            let lobe = &mut mixture.lobes[mixture.len];
            mixture.len += 1;
            let one_minus_cos = if sin2 < 1.0 { sin2 / (1.0 + (1.0 - sin2).sqrt()) } else { 2.0 };
            let mut omega = 2.0 * PI * one_minus_cos as f32;
            if omega < own {
                lobe.axis = (to_center.as_dvec3() / d2.sqrt()).as_vec3();
                lobe.one_minus_cos = (one_minus_cos as f32).max(f32::MIN_POSITIVE);
            } else {
                omega = own;
            }
            lobe.q = omega * t.weight;
            total += lobe.q;
        }
        let uniform = 1.0 / mixture.len as f32;
        for lobe in &mut mixture.lobes[..mixture.len] {
            lobe.q = if total > 0.0 { 0.5 * (lobe.q / total + uniform) } else { uniform };
        }
        mixture
    }

    fn pdf_w(&self, emission: &Emission<'_>, w: Vec3, drawn: Option<usize>) -> f32 {
        let lobes = self.lobes[..self.len].iter().enumerate();
        lobes.map(|(j, lobe)| lobe.q * lobe.pdf_w(emission, w, drawn == Some(j))).sum()
    }
}

/// A direction from `x` and its density per steradian; `None` where nothing leaves along it and where
/// the ray misses the boxes of all targets.
pub(super) fn sample(
    targets: &Targets,
    x: Vec3,
    emission: &Emission<'_>,
    u: [f32; 2],
) -> Option<(Vec3, f32)> {
    let mixture = Mixture::new(targets, x, emission);
    let (j, u0) = pick(mixture.lobes[..mixture.len].iter().map(|l| l.q), u[0])?;
    let lobe = mixture.lobes[j];
    let w = if lobe.one_minus_cos == 0.0 {
        emission.sample([u0, u[1]])?.0
    } else {
        Frame::from_z(lobe.axis).to_world(warp::cone([u0, u[1]], lobe.one_minus_cos)).normalize()
    };
    useful(targets, x, emission, w).then(|| (w, mixture.pdf_w(emission, w, Some(j))))
}

/// Whether light leaves along `w` and the ray meets the box of some target.
fn useful(targets: &Targets, x: Vec3, emission: &Emission<'_>, w: Vec3) -> bool {
    emission.along(w).is_some() && targets.hit_by(x, w)
}

/// Density of [`sample`] per steradian.
pub(super) fn pdf_w(targets: &Targets, x: Vec3, emission: &Emission<'_>, w: Vec3) -> f32 {
    if useful(targets, x, emission, w) {
        Mixture::new(targets, x, emission).pdf_w(emission, w, None)
    } else {
        0.0
    }
}

/// Index drawn with the given probabilities (sum 1), and `u` mapped back to [0, 1).
pub(crate) fn pick(probabilities: impl Iterator<Item = f32>, u: f32) -> Option<(usize, f32)> {
    let mut low = 0.0;
    let mut last = None;
    for (j, q) in probabilities.enumerate() {
        if q <= 0.0 {
            continue;
        }
        last = Some((j, math::ONE_MINUS_EPSILON));
        if u < low + q {
            return Some((j, ((u - low) / q).clamp(0.0, math::ONE_MINUS_EPSILON)));
        }
        low += q;
    }
    last
}
