use color::Lanes;
use math::Vec3;

use crate::bsdf::DeltaLobe;
use crate::lobes::Lobes;

pub(crate) const LOBES: Lobes = Lobes::SPECULAR.union(Lobes::REFLECTION);

/// Local `wo` (z > 0) mirrored about the normal.
#[inline]
pub(crate) fn direction(wo: Vec3) -> Vec3 {
    Vec3::new(-wo.x, -wo.y, wo.z)
}

/// The mirrored direction, with reflectance `weight`.
#[inline]
pub(crate) fn lobe(wo: Vec3, weight: Lanes) -> DeltaLobe {
    DeltaLobe { wi: direction(wo), weight, lobes: LOBES, eta: 1.0 }
}
