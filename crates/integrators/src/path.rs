//! Unidirectional path tracing with light sampling and multiple importance sampling (Kajiya 1986; Veach & Guibas
//! 1995). The oracle that other integrators are tested against.

use bsdf::Lobes;
use film::{FilmError, PassFilm, PixelSample};
use scene::Scene;
use transport::{PathClass, direct, emission_at, emission_escaped};

use crate::pixels::{CameraPath, add, add_features, render_pixels};
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

    #[inline]
    fn trace(&self, CameraPath { mut walk, mut sampler }: CameraPath<'_>, sample: &mut PixelSample) {
        let scene = walk.scene();
        let mut class = PathClass::default();
        loop {
            let Some(vertex) = walk.next_vertex() else {
                for e in emission_escaped(&walk) {
                    add(sample, class.layer(), walk.throughput * e.radiance * e.weight);
                }
                return;
            };
            if walk.depth == 0 {
                add_features(sample, &vertex);
            }
            if let Some(e) = emission_at(&walk, &vertex) {
                add(sample, class.layer(), walk.throughput * e.radiance * e.weight);
            }
            if walk.depth >= self.settings.max_depth {
                return;
            }
            let is_s = !vertex.bsdf.has_diffuse();
            let reflected = direct(scene, &vertex, &mut sampler);
            if !reflected.is_zero() {
                add(sample, class.scattered(is_s).layer(), walk.throughput * reflected);
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
        render_pixels(scene, &self.settings, pass, |path, sample| self.trace(path, sample))
    }
}
