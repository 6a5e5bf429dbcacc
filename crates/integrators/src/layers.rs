//! Layers on request: what each technique found, and what each group of lights gave. The layers of either kind add up to
//! the picture, but for the rounding of f32 sums within one pass (some 10⁻⁷ of it).

use color::Lanes;
use film::PixelSample;
use photons::PhotonFlags;
use sampling::{Domain, Streams};
use scene::Scene;
use transport::{LightLayer, Vertex, Walk};

use crate::pixels::{Traced, Tracer, start};
use crate::sink::{Origin, Parts, Sink, Source, Technique};
use crate::{IntegratorKind, Settings};

/// Names of the layers that passes of these settings bring beside those of every film, in order: `technique-emission`,
/// `technique-direct` and so on for each technique that the integrator has, then `light-NAME` for each group of lights
/// ([`Scene::light_groups`]), at most 127 of them. `light-other` takes what belongs to none of these: further groups, and
/// the irradiance that `photon_map` works out in advance for its gather rays. Characters of group names that are neither
/// ASCII letters, digits, `_` nor `-` become `_`.
pub fn layer_names(settings: &Settings, scene: &Scene) -> Vec<String> {
    let Some(slots) = Slots::new(settings, scene) else { return Vec::new() };
    let mut names: Vec<String> =
        slots.techniques.iter().map(|technique| format!("technique-{}", technique.name())).collect();
    for group in &scene.light_groups()[..slots.groups] {
        push_unique(&mut names, &format!("light-{}", ordinary(group)));
    }
    if slots.other.is_some() {
        push_unique(&mut names, "light-other");
    }
    names
}

/// Longest part of a group's name in that of its layer, in bytes.
const MOST_BYTES: usize = 100;

fn ordinary(name: &str) -> String {
    let keep = |c: char| if c.is_ascii_alphanumeric() || c == '_' || c == '-' { c } else { '_' };
    name.chars().map(keep).take(MOST_BYTES).collect()
}

fn push_unique(names: &mut Vec<String>, name: &str) {
    let numbered = (2..).map(|n| format!("{name}-{n}"));
    let free = std::iter::once(name.to_owned()).chain(numbered).find(|name| !names.contains(name));
    names.extend(free);
}

/// Which layer is whose.
#[derive(Clone, Debug)]
pub(crate) struct Slots {
    /// The first layers, one each.
    techniques: &'static [Technique],
    /// Groups of lights that have a layer each, after those.
    groups: usize,
    /// Whether lights have layers at all.
    lights: bool,
    /// The layer of light that belongs to none of these groups.
    other: Option<usize>,
    count: usize,
}

impl Slots {
    /// `None`: there are none.
    pub fn new(settings: &Settings, scene: &Scene) -> Option<Self> {
        let wanted = settings.layers;
        let techniques = if wanted.techniques { techniques(settings.kind) } else { &[] };
        let all = scene.light_groups().len();
        let groups = if wanted.lights { all.min(PhotonFlags::MOST_GROUPS as usize) } else { 0 };
        let is_mixed = settings.kind == IntegratorKind::PhotonMap && settings.photon_map.final_gather > 0;
        let has_other = wanted.lights && (groups < all || is_mixed);
        let other = has_other.then_some(techniques.len() + groups);
        let count = techniques.len() + groups + usize::from(has_other);
        (count > 0).then_some(Self { techniques, groups, lights: wanted.lights, other, count })
    }

    fn of_technique(&self, technique: Technique) -> Option<usize> {
        self.techniques.iter().position(|t| *t == technique)
    }

    fn of_source(&self, source: Source, scene: &Scene) -> Option<usize> {
        if !self.lights {
            return None;
        }
        let group = match source {
            Source::Light(light) => Some(scene.light_group(light) as usize),
            Source::Group(group) => Some(usize::from(group)),
            Source::Unknown => None,
        };
        group.filter(|group| *group < self.groups).map(|group| self.techniques.len() + group).or(self.other)
    }

    /// The layers of some light: by its technique and by its source.
    pub fn of(&self, origin: &Origin, scene: &Scene) -> impl Iterator<Item = usize> + use<> {
        let technique = self.of_technique(origin.technique);
        technique.into_iter().chain(self.of_source(origin.source, scene))
    }
}

/// What an integrator finds light by.
fn techniques(kind: IntegratorKind) -> &'static [Technique] {
    use Technique::{Direct, Emission, Merge};
    match kind {
        IntegratorKind::Path => &[Emission, Direct],
        IntegratorKind::PhotonMap | IntegratorKind::Sppm | IntegratorKind::Auto => &[Emission, Direct, Merge],
        IntegratorKind::Vcm => &Technique::ALL,
    }
}

/// The layers of a pass.
pub(crate) struct Layers {
    pub slots: Slots,
    /// Layer by layer, each row by row.
    pub values: Vec<[f32; 3]>,
}

/// A sample and the layers of its pixel.
struct Layered<'a> {
    sample: PixelSample,
    values: &'a mut [[f32; 3]],
    slots: &'a Slots,
    scene: &'a Scene,
}

impl Layered<'_> {
    fn add_to(&mut self, slot: Option<usize>, radiance: Lanes) {
        let Some(value) = slot.and_then(|slot| self.values.get_mut(slot)) else { return };
        value.iter_mut().zip(radiance.to_rgb()).for_each(|(v, r)| *v += r);
    }
}

impl Sink for Layered<'_> {
    type Sum = Parts;

    fn add(&mut self, origin: Origin, radiance: Lanes) {
        self.sample.add(origin, radiance);
        self.add_to(self.slots.of_technique(origin.technique), radiance);
        self.add_to(self.slots.of_source(origin.source, self.scene), radiance);
    }

    fn add_sum(&mut self, layer: LightLayer, technique: Technique, sum: Parts) {
        self.sample.add_sum(layer, technique, sum.total);
        self.add_to(self.slots.of_technique(technique), sum.total);
        for (source, part) in sum.parts {
            self.add_to(self.slots.of_source(source, self.scene), part);
        }
    }

    fn features(&mut self, walk: &Walk<'_>, vertex: &Vertex) {
        self.sample.features(walk, vertex);
    }

    fn density(&mut self, photons_per_area: f32) {
        self.sample.density(photons_per_area);
    }
}

/// Rows of one task. Part of no result: pixels share nothing.
const BAND: usize = 4;

/// The samples of one pass with their layers.
pub(crate) fn trace_layers(
    scene: &Scene,
    settings: &Settings,
    pass: u64,
    tracer: &impl Tracer,
    slots: Slots,
) -> Traced {
    let [width, height] = scene.resolution().map(|n| n as usize);
    let streams = Streams::new(settings.seed, pass, Domain::Camera);
    let bands = par::map_chunks(width * height, width * BAND, |pixels| {
        let mut values = vec![[0.0; 3]; slots.count * pixels.len()];
        let mut samples = Vec::with_capacity(pixels.len());
        for (pixel, values) in pixels.zip(values.chunks_mut(slots.count)) {
            let [x, y] = [pixel % width, pixel / width];
            if !settings.shows(x, y) {
                samples.push(PixelSample::default());
                continue;
            }
            let path = start(scene, settings, &streams, pass, [x, y]);
            let sample = PixelSample { weight: path.weight, ..PixelSample::default() };
            let mut layered = Layered { sample, values, slots: &slots, scene };
            tracer.trace(path, &mut layered);
            samples.push(layered.sample);
        }
        (samples, values)
    });
    let (samples, values): (Vec<_>, Vec<_>) = bands.into_iter().unzip();
    let values = values.concat();
    let by_layer = par::map(slots.count, |layer| {
        values.iter().skip(layer).step_by(slots.count).copied().collect::<Vec<_>>()
    });
    Traced { samples: samples.concat(), layers: Some(Layers { slots, values: by_layer.concat() }) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_layers_are_ordinary_and_differ() {
        let mut names = Vec::new();
        for group in ["key light", "key.light", "key-light", "Lämp", "key_light"] {
            push_unique(&mut names, &ordinary(group));
        }
        assert_eq!(names, ["key_light", "key_light-2", "key-light", "L_mp", "key_light-3"]);
    }
}
