use bsdf::TransportMode;
use color::Lanes;
use math::{Ray, offset_ray_origin};
use sampling::Sampler;
use scene::light::LeSample;
use scene::{LightId, Scene};

use crate::{LightStart, Walk};

/// A photon that has just left a light.
#[derive(Clone, Copy, Debug)]
pub struct EmittedPhoton<'s> {
    /// The light.
    pub light: LightId,
    /// The walk; its throughput is the flux in W that one photon would carry if it were the only one: divide by
    /// the number of emitted photons.
    pub walk: Walk<'s>,
}

/// A photon in proportion to the lights' power, cosine-weighted over area lights. `None`: it carries nothing, and
/// counts as emitted all the same.
///
/// Φ = Le·cosθ / (p_light · p_area · p_direction) (Jensen 2001, §5.1).
pub fn emit<'s>(scene: &'s Scene, sampler: &mut Sampler) -> Option<EmittedPhoton<'s>> {
    emit_with_start(scene, sampler).map(|(emitted, _)| emitted)
}

/// [`emit`], and the start that weights are made of.
pub(crate) fn emit_with_start<'s>(
    scene: &'s Scene,
    sampler: &mut Sampler,
) -> Option<(EmittedPhoton<'s>, LightStart)> {
    let (u_light, u_pos, u_dir) = (sampler.next_1d(), sampler.next_2d(), sampler.next_2d());
    let (index, pmf, u_pick) = scene.global_picker().sample(u_light);
    if pmf == 0.0 {
        return None;
    }
    let id = LightId(index as u32);
    let le = scene.sample_le(id, u_pick, u_pos, u_dir)?;
    let emitted = start(scene, id, &le, pmf * le.pdf_a * le.pdf_w)?;
    Some((emitted, LightStart { light: id, pmf, le }))
}

/// A photon aimed at the scene's specular objects. Its flux is exact: the density is that of the aimed direction.
/// `None`: it carries nothing or misses every object, and counts as emitted.
pub fn emit_toward_targets<'s>(scene: &'s Scene, sampler: &mut Sampler) -> Option<EmittedPhoton<'s>> {
    let (u_light, u_pos, u_dir) = (sampler.next_1d(), sampler.next_2d(), sampler.next_2d());
    emit_toward_targets_with(scene, u_light, u_pos, u_dir).map(|(emitted, _)| emitted)
}

/// [`emit_toward_targets`] from given numbers, and the start that weights are made of.
pub fn emit_toward_targets_with<'s>(
    scene: &'s Scene,
    u_light: f32,
    u_pos: [f32; 2],
    u_dir: [f32; 2],
) -> Option<(EmittedPhoton<'s>, LightStart)> {
    let (index, pmf, u_pick) = scene.caustic_picker().sample(u_light);
    if pmf == 0.0 {
        return None;
    }
    let light = LightId(index as u32);
    let le = scene.sample_le_toward(light, u_pick, u_pos, u_dir)?;
    let emitted = start(scene, light, &le, pmf * le.pdf_a * le.pdf_w)?;
    Some((emitted, LightStart { light, pmf, le }))
}

/// A photon of a mixture: with probability `aimed` as by [`emit_toward_targets`], else as by [`emit`]. The flux is over
/// the density of both together (one-sample balance heuristic: Veach 1997, §9.2.4), so it is exact for any share, and
/// no photon carries more than 1/(1 − `aimed`) of what [`emit`] would give it. `None` as there.
pub fn emit_mixed<'s>(scene: &'s Scene, aimed: f32, sampler: &mut Sampler) -> Option<EmittedPhoton<'s>> {
    let u_strategy = sampler.next_1d();
    let (u_light, u_pos, u_dir) = (sampler.next_1d(), sampler.next_2d(), sampler.next_2d());
    let toward = u_strategy < aimed;
    let picker = if toward { scene.caustic_picker() } else { scene.global_picker() };
    let (index, pmf, u_pick) = picker.sample(u_light);
    if pmf == 0.0 {
        return None;
    }
    let id = LightId(index as u32);
    let light = scene.light(id);
    let le = if toward {
        scene.sample_le_toward(id, u_pick, u_pos, u_dir)
    } else {
        scene.sample_le(id, u_pick, u_pos, u_dir)
    }?;
    let start_at = light.hit_of_le(&le);
    let own = pmf * le.pdf_a * le.pdf_w;
    let (other_pmf, (other_a, other_w)) = if toward {
        (scene.global_picker().pmf(index), light.pdf_le(&start_at, le.w))
    } else {
        (scene.caustic_picker().pmf(index), light.pdf_le_toward(scene.targets(), &start_at, le.w))
    };
    let other = other_pmf * other_a * other_w;
    let density =
        if toward { aimed * own + (1.0 - aimed) * other } else { (1.0 - aimed) * own + aimed * other };
    start(scene, id, &le, density)
}

fn start<'s>(scene: &'s Scene, id: LightId, le: &LeSample, density: f32) -> Option<EmittedPhoton<'s>> {
    let flux: Lanes = le.radiance * (le.cos / density);
    if flux.is_zero() {
        return None;
    }
    let ray = Ray::new(offset_ray_origin(le.p, le.p_error, le.n, le.w), le.w);
    let walk = Walk::new(scene, TransportMode::Importance, ray, flux, scene.light_medium(id));
    Some(EmittedPhoton { light: id, walk })
}
