//! Surfaces that are there by chance: opacity, and mixes of two materials.
//!
//! Which of them a ray meets is decided as it meets the surface, by a number that is a hash of the place: no random number is
//! asked for, and the same ray meets the same. As the place is hashed to the last bit, rays of different paths decide
//! independently, with the probabilities that opacity and amount say. Every path of a picture then has the expectation that it
//! would have through grains too fine to be seen, by whatever technique it is found, for each vertex on such a surface
//! and each passage through one carries its probability once.
//!
//! Where photons are merged a path has such a vertex twice: the photon's and the eye's. [`Scene::presence`] is the
//! probability of the first, which the photon's power is divided by.

use bsdf::BsdfKind;
use math::Ray;
use sampling::philox4x32_10;

use crate::material::{MaterialKind, Place};
use crate::{MaterialId, Scene, SurfaceInteraction};

/// Surfaces that one ray may pass; a bound only against geometry that is degenerate.
const MOST: u32 = 10_000;

/// Number in [0, 1) for the `round`-th decision at a place.
fn chance(hit: &SurfaceInteraction, round: u32) -> f32 {
    let [x, y, z] = hit.p.to_array().map(f32::to_bits);
    let [bits, ..] = philox4x32_10([x, y, z, round], [0x6f70_6163, 0x6974_7921]);
    (bits >> 8) as f32 / (1u32 << 24) as f32
}

impl Scene {
    /// [`Self::intersect`] where chance decides what is met.
    #[inline(never)]
    pub(crate) fn intersect_by_chance(&self, ray: &Ray) -> Option<SurfaceInteraction> {
        self.meet(ray, chance)
    }

    /// The first place on a ray where a surface may be, however small the chance.
    pub fn intersect_possible(&self, ray: &Ray) -> Option<SurfaceInteraction> {
        if self.by_chance { self.meet(ray, |_, _| 0.0) } else { self.first(ray) }
    }

    /// The first surface that is there, where `number` draws the number of each decision.
    fn meet(
        &self,
        ray: &Ray,
        number: impl Fn(&SurfaceInteraction, u32) -> f32,
    ) -> Option<SurfaceInteraction> {
        let mut rest = *ray;
        for passed in 0..MOST {
            let mut hit = self.first(&rest)?;
            if let Some(material) = self.chosen(&hit, &number) {
                hit.material = material;
                if passed > 0 {
                    hit.t = hit.p.distance(ray.origin) / ray.direction.length();
                }
                return Some(hit);
            }
            rest = if ray.t_max.is_finite() {
                let end = ray.at(ray.t_max);
                let rest = hit.spawn_ray_to(end, 0.0, math::Vec3::ZERO);
                // The surface may lie so near the end that nothing is left.
                if rest.direction.dot(ray.direction) <= 0.0 {
                    return None;
                }
                rest
            } else {
                hit.spawn_ray(ray.direction)
            };
        }
        None
    }

    /// The material of which the surface at `hit` is for this ray; `None`: there is no surface.
    fn chosen(
        &self,
        hit: &SurfaceInteraction,
        number: impl Fn(&SurfaceInteraction, u32) -> f32,
    ) -> Option<MaterialId> {
        let lookup = self.lookup(0.0);
        let at = Place { hit: Some(hit), lookup: &lookup };
        let mut id = hit.material;
        let mut round = 0;
        loop {
            let material = &self.materials[id.0 as usize];
            if let Some(opacity) = material.opacity
                && hit.light.is_none()
            {
                let share = at.share(opacity.share);
                let bar = opacity.cutoff.unwrap_or_else(|| number(hit, round));
                // A chance below the share; a share of the cutoff at least.
                if share < bar || (opacity.cutoff.is_none() && share == bar) {
                    return None;
                }
            }
            let MaterialKind::Mix { a, b, amount } = material.kind else { return Some(id) };
            id = if number(hit, round + 1) < at.share(amount) { b } else { a };
            round += 2;
        }
    }

    /// The probability that a ray which comes to the place of `hit` meets a surface of a kind that is `wanted`. 1 where all is
    /// certain.
    #[inline]
    pub fn presence(&self, hit: &SurfaceInteraction, wanted: impl Fn(&BsdfKind) -> bool) -> f32 {
        if self.by_chance { self.share_of(hit, &wanted) } else { 1.0 }
    }

    #[inline(never)]
    fn share_of(&self, hit: &SurfaceInteraction, wanted: &dyn Fn(&BsdfKind) -> bool) -> f32 {
        let mut root = hit.material;
        while let Some(mix) = self.materials[root.0 as usize].part_of {
            root = mix;
        }
        let lookup = self.lookup(0.0);
        let share = self.share_below(root, &Place { hit: Some(hit), lookup: &lookup }, wanted);
        // What has been met is possible, whatever rounding says.
        if share > 0.0 { share } else { 1.0 }
    }

    fn share_below(&self, id: MaterialId, at: &Place<'_>, wanted: &dyn Fn(&BsdfKind) -> bool) -> f32 {
        let material = &self.materials[id.0 as usize];
        let share = match material.kind {
            MaterialKind::Mix { a, b, amount } => {
                let t = at.share(amount);
                let part =
                    |id: MaterialId, t: f32| if t > 0.0 { t * self.share_below(id, at, wanted) } else { 0.0 };
                part(a, 1.0 - t) + part(b, t)
            }
            ref kind => {
                let kind = kind.bsdf(at.hit, 1.5, at.lookup);
                if wanted(&kind) { 1.0 } else { 0.0 }
            }
        };
        match material.opacity {
            Some(opacity) if opacity.cutoff.is_none() && at.hit.is_some_and(|hit| hit.light.is_none()) => {
                share * at.share(opacity.share)
            }
            _ => share,
        }
    }
}
