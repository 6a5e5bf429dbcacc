use color::Lanes;
use math::Vec3;

use crate::bsdf::DeltaLobe;
use crate::lobes::Lobes;

pub(crate) const LOBES: Lobes = Lobes::SPECULAR.union(Lobes::TRANSMISSION);

/// Straight on.
#[inline]
pub(crate) fn lobe(wo: Vec3) -> DeltaLobe {
    DeltaLobe { wi: -wo, weight: Lanes::ONE, lobes: LOBES, eta: 1.0 }
}
