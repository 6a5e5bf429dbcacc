//! Unidirectional path tracing with light sampling and multiple importance sampling (Kajiya 1986; Veach & Guibas
//! 1995). The oracle that other integrators are tested against.

use bsdf::Lobes;
use film::{FilmError, PassFilm};
use scene::Scene;
use transport::{Direct, Emission, PathClass, PathEnd, Walk, direct, emission_at, emission_escaped};

use crate::numbers::VertexNumbers;
use crate::pixels::{CameraPath, Tracer, render_pixels};
use crate::replay::record_pixel;
use crate::sink::{Origin, Sink, Source, Technique};
use crate::{Integrator, Maps, PathRecord, PhotonKind, Settings, TracedPhotons};

/// Throughput below which Russian roulette begins: killing earlier adds more noise than it saves time.
const FAINT: f32 = 1.0 / 3.0;

/// Chance to survive an event.
#[inline]
pub(crate) fn survival(walk: &Walk<'_>) -> f32 {
    walk.survival() / FAINT
}

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
    let origin =
        Origin { layer: class.layer(), technique: Technique::Emission, source: Source::Light(e.light) };
    sink.add(origin, walk.throughput * e.radiance * e.weight);
}

/// Light that light sampling found at a vertex of the walk, on a path of that class.
#[inline]
pub(crate) fn add_direct(sink: &mut impl Sink, walk: &Walk<'_>, class: PathClass, direct: &Direct) {
    let origin =
        Origin { layer: class.layer(), technique: Technique::Direct, source: Source::Light(direct.light) };
    sink.add(origin, walk.throughput * direct.radiance);
}

impl Tracer for Path {
    #[inline]
    fn trace<S: Sink>(&self, CameraPath { mut walk, mut sampler, strata, .. }: CameraPath<'_>, sink: &mut S) {
        let scene = walk.scene();
        let mut class = PathClass::default();
        loop {
            let Some(vertex) = walk.next_vertex() else {
                for e in emission_escaped(&walk) {
                    add_emission(sink, &walk, class, &e);
                }
                return sink.ended(PathEnd::Escaped);
            };
            sink.reached(&walk, &vertex);
            if walk.shows(&vertex) {
                sink.features(&walk, &vertex);
            }
            if let Some(e) = emission_at(&walk, &vertex) {
                add_emission(sink, &walk, class, &e);
            }
            if walk.depth >= self.settings.max_depth {
                return sink.ended(PathEnd::Depth);
            }
            let is_s = !vertex.bsdf.has_diffuse();
            let mut numbers = VertexNumbers::new(&strata, &mut sampler, walk.depth);
            direct(scene, &vertex, &mut numbers, |direct| {
                add_direct(sink, &walk, class.scattered(is_s), direct);
            });
            let (u_lobe, u) = numbers.scatter();
            let Some(scattered) = walk.scatter_with(&vertex, Lobes::ALL, u_lobe, u) else {
                return sink.ended(PathEnd::Absorbed);
            };
            class = class.scattered(is_s || scattered.lobes.contains(Lobes::SPECULAR));
            if !walk.roulette(survival(&walk), &mut sampler) {
                return sink.ended(PathEnd::Roulette);
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

    fn replay_pixel(&self, scene: &Scene, _maps: Option<&Maps>, pass: u64, pixel: [usize; 2]) -> PathRecord {
        record_pixel(scene, &self.settings, pass, pixel, self).finish()
    }

    fn photon_paths(&self, _scene: &Scene) -> Vec<(PhotonKind, u64)> {
        Vec::new()
    }

    fn replay_photon(&self, _scene: &Scene, _map_index: u64, _kind: PhotonKind, _path: u64) -> PathRecord {
        PathRecord::default()
    }
}
