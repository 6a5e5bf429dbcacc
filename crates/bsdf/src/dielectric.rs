use color::Lanes;
use math::Vec3;

use crate::bsdf::DeltaLobe;
use crate::fresnel::{fresnel_dielectric, refracted_cosine};
use crate::lobes::{Lobes, TransportMode};
use crate::mirror;

pub(crate) const REFLECTION: Lobes = mirror::LOBES;
pub(crate) const TRANSMISSION: Lobes = Lobes::SPECULAR.union(Lobes::TRANSMISSION);

/// Reflected and refracted directions for local `wo` (z > 0), `eta` = far side over near side.
/// The second is `None` under total internal reflection.
#[inline]
pub(crate) fn delta_lobes(wo: Vec3, eta: f32, tint: Lanes, mode: TransportMode) -> [Option<DeltaLobe>; 2] {
    let kr = fresnel_dielectric(wo.z, eta);
    let reflected = mirror::lobe(wo, Lanes::splat(kr));
    let transmitted = refracted_cosine(wo.z, eta).filter(|_| kr < 1.0).map(|cos_t| {
        // Radiance is compressed into the solid angle of the denser side: L_o = T·L_i·(η_o/η_i)² (Veach 1997,
        // eq. 5.2); flux is not.
        let scale = match mode {
            TransportMode::Radiance => 1.0 / (eta * eta),
            TransportMode::Importance => 1.0,
        };
        DeltaLobe {
            wi: Vec3::new(-wo.x / eta, -wo.y / eta, -cos_t).normalize(),
            weight: tint * ((1.0 - kr) * scale),
            lobes: TRANSMISSION,
            eta,
        }
    });
    [Some(reflected), transmitted]
}

/// Chooses between the admitted directions in proportion to kr and kt = 1 − kr; the weight is divided by the
/// probability.
#[inline]
pub(crate) fn sample(
    wo: Vec3,
    eta: f32,
    tint: Lanes,
    allowed: Lobes,
    u_lobe: f32,
    mode: TransportMode,
) -> Option<(DeltaLobe, f32)> {
    let [reflected, transmitted] = delta_lobes(wo, eta, tint, mode);
    let reflected = reflected.filter(|l| allowed.contains(l.lobes));
    let transmitted = transmitted.filter(|l| allowed.contains(l.lobes));
    match (reflected, transmitted) {
        (Some(r), Some(t)) => {
            let kr = fresnel_dielectric(wo.z, eta);
            if u_lobe < kr {
                Some((DeltaLobe { weight: Lanes::ONE, ..r }, kr))
            } else {
                Some((DeltaLobe { weight: t.weight / (1.0 - kr), ..t }, 1.0 - kr))
            }
        }
        (Some(l), None) | (None, Some(l)) => Some((l, 1.0)),
        (None, None) => None,
    }
}

/// Reflectance plus transmittance of flux.
#[inline]
pub(crate) fn albedo(cos_o: f32, eta: f32, tint: Lanes) -> Lanes {
    let kr = fresnel_dielectric(cos_o, eta);
    Lanes::splat(kr) + tint * (1.0 - kr)
}
