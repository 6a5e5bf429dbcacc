//! What caustic photons are aimed at.

use math::{Bounds3, Frame, PI, Vec3};
use sampling::warp;

use crate::light::aim::pick;

/// Most targets that a mixture holds; more are merged.
pub const MAX_TARGETS: usize = 64;

/// A specular object as lights see it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Target {
    /// Box around it.
    pub bounds: Bounds3,
    /// Centre of a sphere around it.
    pub center: Vec3,
    /// Radius of that sphere; the tighter, the fewer photons are lost.
    pub radius: f32,
    /// Specular albedo, 0..1: shifts photons among targets.
    pub weight: f32,
}

impl Target {
    /// With the box's own sphere.
    pub fn from_bounds(bounds: Bounds3, weight: f32) -> Self {
        let (center, radius) = bounds.bounding_sphere();
        Self { bounds, center, radius, weight }
    }

    fn is_valid(&self) -> bool {
        self.center.is_finite() && self.radius > 0.0 && self.radius.is_finite() && self.weight >= 0.0
    }

    /// Around all of a group: the box of the boxes; its sphere, or a smaller one about the same centre.
    fn around(group: &[Self]) -> Self {
        let bounds = group.iter().fold(Bounds3::EMPTY, |b, t| b.union(t.bounds));
        let (center, corner_radius) = bounds.bounding_sphere();
        let reach = group.iter().map(|t| t.center.distance(center) + t.radius).fold(0.0, f32::max);
        let area: f32 = group.iter().map(|t| t.radius * t.radius).sum();
        let weight = group.iter().map(|t| t.weight * t.radius * t.radius).sum::<f32>() / area;
        Self { bounds, center, radius: corner_radius.min(reach), weight }
    }
}

/// The targets of a scene, at most [`MAX_TARGETS`].
#[derive(Clone, Debug, Default)]
pub struct Targets {
    targets: Vec<Target>,
    /// Probability of each target's shadow in parallel light: ½·r²w/Σr²w + ½/J.
    shadows: Vec<f32>,
}

impl Targets {
    /// Keeps targets of positive finite radius and weight ≥ 0; where there are more than [`MAX_TARGETS`], the group of
    /// the largest sphere is split in two at the median of its longest axis until that many groups stand, and each
    /// group becomes one target. Boxes and spheres grow by 10⁻⁴ of the radius, so that rounding loses no edge.
    pub fn new(targets: Vec<Target>) -> Self {
        let targets: Vec<Target> = targets.into_iter().filter(Target::is_valid).collect();
        let mut targets = if targets.len() > MAX_TARGETS { merged(targets) } else { targets };
        for t in &mut targets {
            let pad = 1e-4 * t.radius;
            t.radius += pad;
            t.bounds = Bounds3 { min: t.bounds.min - Vec3::splat(pad), max: t.bounds.max + Vec3::splat(pad) };
        }
        let area = |t: &Target| t.radius * t.radius * t.weight;
        let total: f32 = targets.iter().map(area).sum();
        let uniform = 1.0 / targets.len() as f32;
        let share = |t: &Target| if total > 0.0 { 0.5 * (area(t) / total + uniform) } else { uniform };
        let shadows = targets.iter().map(share).collect();
        Self { targets, shadows }
    }

    /// The targets, after merging and growing.
    pub fn as_slice(&self) -> &[Target] {
        &self.targets
    }

    /// Number of targets.
    pub fn len(&self) -> usize {
        self.targets.len()
    }

    /// Whether there is none: no photon can be aimed.
    pub fn is_empty(&self) -> bool {
        self.targets.is_empty()
    }

    /// Whether the ray from `x` along `w` meets the box of some target.
    pub fn hit_by(&self, x: Vec3, w: Vec3) -> bool {
        let inverse = w.recip();
        self.targets.iter().any(|t| hits_box(&t.bounds, x, inverse))
    }

    /// A point of the plane through `plane` perpendicular to the unit vector `w`, from the mixture of the shadows
    /// that the targets' spheres cast along `w`, and its density per area of the plane. `None` where the ray from
    /// it along `w` misses the boxes of all targets.
    pub(crate) fn sample_shadow(
        &self,
        plane: Vec3,
        w: Vec3,
        u_pick: f32,
        u: [f32; 2],
    ) -> Option<(Vec3, f32)> {
        let (j, _) = pick(self.shadows.iter().copied(), u_pick)?;
        let t = &self.targets[j];
        let d = warp::disk(u) * t.radius;
        let frame = Frame::from_z(w);
        // The ray starts a target's radius before it even where the target sticks out of the plane.
        let back = w.dot(t.center - plane).max(t.radius);
        let p = t.center - w * back + frame.x * d.x + frame.y * d.y;
        self.hit_by(p, w).then(|| (p, self.mixture_pdf_a(p, w, Some(j))))
    }

    /// Density of [`Self::sample_shadow`] per area for a path through `p` along `w`.
    pub(crate) fn shadow_pdf_a(&self, p: Vec3, w: Vec3, drawn: Option<usize>) -> f32 {
        if self.hit_by(p, w) { self.mixture_pdf_a(p, w, drawn) } else { 0.0 }
    }

    fn mixture_pdf_a(&self, p: Vec3, w: Vec3, drawn: Option<usize>) -> f32 {
        let shadows = self.targets.iter().zip(&self.shadows).enumerate();
        let density = shadows.map(|(j, (t, q))| {
            let v = p - t.center;
            let off = v - w * v.dot(w);
            let r2 = t.radius * t.radius;
            if drawn == Some(j) || off.length_squared() <= r2 { q / (PI * r2) } else { 0.0 }
        });
        density.sum()
    }
}

/// Slab test with t ≥ 0 (Kay & Kajiya 1986). A ray within a face gives 0·∞ = NaN and counts as inside that slab.
fn hits_box(b: &Bounds3, x: Vec3, inverse: Vec3) -> bool {
    let (mut near, mut far) = (0.0f32, f32::INFINITY);
    for axis in 0..3 {
        let t0 = (b.min[axis] - x[axis]) * inverse[axis];
        let t1 = (b.max[axis] - x[axis]) * inverse[axis];
        if t0.is_nan() || t1.is_nan() {
            continue;
        }
        near = near.max(t0.min(t1));
        far = far.min(t0.max(t1));
    }
    near <= far * (1.0 + 4.0 * f32::EPSILON)
}

/// At most [`MAX_TARGETS`] targets that together hold all.
fn merged(targets: Vec<Target>) -> Vec<Target> {
    let mut groups = vec![targets];
    while groups.len() < MAX_TARGETS {
        let splittable = groups.iter().enumerate().filter(|(_, g)| g.len() > 1);
        let widest =
            splittable.map(|(i, g)| (i, Target::around(g).radius)).fold(None, |best, (i, r)| match best {
                Some((_, b)) if b >= r => best,
                _ => Some((i, r)),
            });
        let Some((i, _)) = widest else { break };
        let group = &mut groups[i];
        let size = Bounds3::of_points(group.iter().map(|t| t.center)).size();
        let axis = if size.x >= size.y && size.x >= size.z {
            0
        } else if size.y >= size.z {
            1
        } else {
            2
        };
        // Stable: equal centres keep the order in which they were given.
        group.sort_by(|a, b| a.center[axis].total_cmp(&b.center[axis]));
        let upper = group.split_off(group.len() / 2);
        groups.push(upper);
    }
    groups.iter().map(|g| Target::around(g)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boxes_are_hit_from_faces_edges_and_inside() {
        let b = Bounds3 { min: Vec3::ZERO, max: Vec3::ONE };
        let hits = |x: Vec3, w: Vec3| hits_box(&b, x, w.recip());
        let mid = Vec3::splat(0.5);
        assert!(hits(mid, Vec3::X) && hits(mid, -Vec3::ONE.normalize()));
        assert!(hits(Vec3::new(0.5, 3.0, 0.5), -Vec3::Y) && !hits(Vec3::new(0.5, 3.0, 0.5), Vec3::Y));
        assert!(hits(Vec3::new(0.0, 3.0, 0.5), -Vec3::Y) && hits(Vec3::new(1.0, 3.0, 1.0), -Vec3::Y));
        assert!(!hits(Vec3::new(1.1, 3.0, 0.5), -Vec3::Y) && !hits(Vec3::new(-0.1, 3.0, 0.5), -Vec3::Y));
        assert!(hits(Vec3::new(-1.0, -1.0, 0.5), Vec3::new(1.0, 1.0, -0.0).normalize()));
    }
}
