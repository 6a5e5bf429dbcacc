//! Unidirectional path tracing with light sampling and multiple importance sampling (Kajiya 1986; Veach & Guibas
//! 1995). The oracle that other integrators are tested against.

use bsdf::Lobes;
use film::{FilmError, PassFilm};
use scene::Scene;
use transport::{Emission, PathClass, Walk, direct, emission_at, emission_escaped};

use crate::pixels::{CameraPath, Tracer, render_pixels};
use crate::sink::{Origin, Sink, Technique};
use crate::{Integrator, Maps, Settings, TracedPhotons};

/// Scattering events before Russian roulette begins.
const ROULETTE_DEPTH: u32 = 3;
/// Greatest chance to survive it: a path in a white furnace ends, too.
const MAX_SURVIVAL: f32 = 0.98;

/// The path tracer.
#[derive(Clone, Debug)]
pub struct Path {
    settings: Settings,
}

impl Path {
    /// A path tracer of these settings.
    pub fn new(settings: Settings) -> Self {
        Self { settings }
    }
}

/// Light that the walk met.
#[inline]
pub(crate) fn add_emission(sink: &mut impl Sink, walk: &Walk<'_>, class: PathClass, e: &Emission) {
    let origin = Origin { layer: class.layer(), technique: Technique::Emission, light: Some(e.light) };
    sink.add(origin, walk.throughput * e.radiance * e.weight);
}

impl Tracer for Path {
    #[inline]
    fn trace<S: Sink>(&self, CameraPath { mut walk, mut sampler, .. }: CameraPath<'_>, sink: &mut S) {
        let scene = walk.scene();
        let mut class = PathClass::default();
        loop {
            let Some(vertex) = walk.next_vertex() else {
                for e in emission_escaped(&walk) {
                    add_emission(sink, &walk, class, &e);
                }
                return;
            };
            sink.reached(&walk, &vertex);
            if walk.depth == 0 {
                sink.features(&vertex);
            }
            if let Some(e) = emission_at(&walk, &vertex) {
                add_emission(sink, &walk, class, &e);
            }
            if walk.depth >= self.settings.max_depth {
                return;
            }
            let is_s = !vertex.bsdf.has_diffuse();
            if let Some(direct) = direct(scene, &vertex, &mut sampler) {
                let layer = class.scattered(is_s).layer();
                let origin = Origin { layer, technique: Technique::Direct, light: Some(direct.light) };
                sink.add(origin, walk.throughput * direct.radiance);
            }
            let Some(scattered) = walk.scatter(&vertex, &mut sampler) else { return };
            class = class.scattered(is_s || scattered.lobes.contains(Lobes::SPECULAR));
            if walk.depth >= ROULETTE_DEPTH && !walk.roulette(walk.survival().min(MAX_SURVIVAL), &mut sampler)
            {
                return;
            }
        }
    }
}

impl Integrator for Path {
    fn name(&self) -> &'static str {
        "path"
    }

    fn map_index(&self, _pass: u64) -> Option<u64> {
        None
    }

    fn trace_photons(&self, _scene: &Scene, _map_index: u64) -> TracedPhotons {
        TracedPhotons::default()
    }

    fn build_maps(&self, _scene: &Scene, _photons: TracedPhotons) -> Maps {
        Maps::default()
    }

    fn render(&self, scene: &Scene, _maps: Option<&Maps>, pass: u64) -> Result<PassFilm, FilmError> {
        render_pixels(scene, &self.settings, pass, self)
    }
}
