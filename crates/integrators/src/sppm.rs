//! Stochastic progressive photon mapping without memory (Hachisuka & Jensen 2009; Knaus & Zwicker 2011). Every pass
//! traces photons of its own and estimates their density at the first D surface of every eye path, within a radius
//! that follows from the pass alone. Every path from the camera to a light is counted once. With x that D surface,
//! reached through S*,
//!
//! * emission seen before x and at x: the eye path itself; where it was scattered by a rough S surface, weighted
//!   against light sampling there;
//! * light that reaches x straight from a light: light sampling and BSDF sampling, or photons (a setting);
//! * all other light at x: photons.

use bsdf::{Lobes, TransportMode};
use color::Lanes;
use film::{FilmError, PassFilm};
use math::Vec2;
use photons::{Kernel, PhotonFlags, PhotonMap};
use scene::Scene;
use transport::{
    LightLayer, PathClass, PathEnd, PhotonJob, PhotonPaths, Vertex, Walk, direct, direct_against,
    emission_at, emission_escaped, is_hidden, merge_within,
};

use crate::maps::StoredMap;
use crate::numbers::VertexNumbers;
use crate::path::{add_direct, add_emission};
use crate::photon_pass::{replay_job, trace_job};
use crate::pixels::{CameraPath, Tracer, render_pixels};
use crate::radius::{PassRadius, median};
use crate::replay::record_pixel;
use crate::sink::{Sink, Source, Sum, Technique};
use crate::{DirectLight, Integrator, Maps, PathRecord, PhotonKind, Settings, TracedPhotons};

/// For equal bias this kernel needs a radius of √1.5 of the constant one's, and has 8/9 of its variance then: of all
/// kernels the least (Epanechnikov 1969).
const KERNEL: Kernel = Kernel::Epanechnikov;
/// Eye paths that carry less are ended by roulette.
const FAINT: f32 = 0.1;

/// Pixels along either side of the picture at which the typical radius is measured.
const PROBES: usize = 8;

/// Stochastic progressive photon mapping.
#[derive(Clone, Debug)]
pub struct Sppm {
    settings: Settings,
}

impl Sppm {
    /// An integrator of these settings.
    pub fn new(settings: Settings) -> Self {
        Self { settings }
    }

    fn radius(&self, scene: &Scene, pass: u64) -> PassRadius {
        self.settings.sppm.radius.of_pass(pass, scene.bounds().size().length())
    }

    /// The photons of a pass; `None` where paths may be no longer than what is found without them.
    fn job(&self, scene: &Scene, map_index: u64) -> Option<PhotonJob> {
        let [width, height] = scene.resolution().map(u64::from);
        let (paths, least_depth) = match self.settings.sppm.direct {
            DirectLight::Sampling => (PhotonPaths::MixedScattered, 2),
            DirectLight::Photons => (PhotonPaths::Mixed, 1),
        };
        (self.settings.max_depth >= least_depth).then(|| PhotonJob {
            paths,
            count: self.settings.sppm.photons.unwrap_or(width * height),
            seed: self.settings.seed,
            map_index,
            max_depth: self.settings.max_depth,
        })
    }

    fn eye<'a>(&self, scene: &Scene, maps: Option<&'a Maps>, pass: u64) -> Eye<'a> {
        Eye {
            map: maps.and_then(|maps| maps.merging.as_ref()).map(|stored| &stored.map),
            radius: self.radius(scene, pass),
            max_depth: self.settings.max_depth,
            direct: self.settings.sppm.direct,
            rays: if scene.lights().iter().all(|light| light.is_delta()) {
                Lobes::NONE
            } else {
                Lobes::NON_DELTA
            },
        }
    }
}

impl Integrator for Sppm {
    fn name(&self) -> &'static str {
        "sppm"
    }

    fn map_index(&self, pass: u64) -> Option<u64> {
        Some(pass)
    }

    fn trace_photons(&self, scene: &Scene, map_index: u64) -> TracedPhotons {
        let Some(job) = self.job(scene, map_index) else { return TracedPhotons::default() };
        let traced = trace_job(scene, &job);
        TracedPhotons {
            global: traced.photons,
            typical_radius: typical_radius(scene, &self.radius(scene, map_index)),
            global_balance: traced.balance,
            nonfinite: traced.nonfinite,
            ..TracedPhotons::default()
        }
    }

    fn build_maps(&self, _scene: &Scene, photons: TracedPhotons) -> Maps {
        let map = PhotonMap::build(photons.global);
        let merging = StoredMap { map, typical_radius: photons.typical_radius, max_radius: None };
        Maps { merging: Some(merging), ..Maps::default() }
    }

    fn render(&self, scene: &Scene, maps: Option<&Maps>, pass: u64) -> Result<PassFilm, FilmError> {
        render_pixels(scene, &self.settings, pass, &self.eye(scene, maps, pass))
    }

    fn replay_pixel(&self, scene: &Scene, maps: Option<&Maps>, pass: u64, pixel: [usize; 2]) -> PathRecord {
        record_pixel(scene, &self.settings, pass, pixel, &self.eye(scene, maps, pass)).finish()
    }

    fn photon_paths(&self, scene: &Scene) -> Vec<(PhotonKind, u64)> {
        self.job(scene, 0).map(|job| (PhotonKind::Global, job.count)).into_iter().collect()
    }

    fn replay_photon(&self, scene: &Scene, map_index: u64, kind: PhotonKind, path: u64) -> PathRecord {
        match (kind, self.job(scene, map_index)) {
            (PhotonKind::Global, Some(job)) => replay_job(scene, &job, path),
            _ => PathRecord::default(),
        }
    }
}

/// The eye paths of one pass.
struct Eye<'a> {
    map: Option<&'a PhotonMap>,
    radius: PassRadius,
    max_depth: u32,
    direct: DirectLight,
    /// Lobes of D surfaces from which rays to lights are drawn: none where no ray finds a light.
    rays: Lobes,
}

impl Tracer for Eye<'_> {
    #[inline]
    fn trace<S: Sink>(&self, CameraPath { mut walk, mut sampler, strata, .. }: CameraPath<'_>, sink: &mut S) {
        loop {
            let Some(vertex) = walk.next_vertex() else {
                escape(&walk, sink);
                return sink.ended(PathEnd::Escaped);
            };
            sink.reached(&walk, &vertex);
            if walk.shows(&vertex) {
                sink.features(&walk, &vertex);
            }
            if let Some(e) = emission_at(&walk, &vertex) {
                add_emission(sink, &walk, PathClass::default(), &e);
            }
            if walk.depth >= self.max_depth {
                return sink.ended(PathEnd::Depth);
            }
            let mut lobes = Lobes::ALL;
            if vertex.bsdf.has_diffuse() {
                if self.direct == DirectLight::Sampling {
                    let mut numbers = VertexNumbers::new(&strata, &mut sampler, walk.depth);
                    self.straight(&walk, &vertex, &mut numbers, sink);
                }
                self.merge(&walk, &vertex, sink);
                if !vertex.bsdf.lobes().contains(Lobes::SPECULAR) {
                    return sink.ended(PathEnd::Complete);
                }
                lobes = Lobes::DELTA;
            } else {
                let mut numbers = VertexNumbers::new(&strata, &mut sampler, walk.depth);
                direct(walk.scene(), &vertex, &mut numbers, |direct| {
                    add_direct(sink, &walk, PathClass::default(), direct);
                });
            }
            if walk.scatter_lobes(&vertex, lobes, &mut sampler).is_none() {
                return sink.ended(PathEnd::Absorbed);
            }
            if !walk.roulette(walk.survival() / FAINT, &mut sampler) {
                return sink.ended(PathEnd::Roulette);
            }
        }
    }
}

/// The lights that a walk sees when it leaves the scene, all S* before.
fn escape(walk: &Walk<'_>, sink: &mut impl Sink) {
    for e in emission_escaped(walk) {
        add_emission(sink, walk, PathClass::default(), &e);
    }
}

impl Eye<'_> {
    /// Light that comes straight from a light to a D surface: samples of the lights and one of the BSDF.
    #[inline]
    fn straight(
        &self,
        walk: &Walk<'_>,
        vertex: &Vertex,
        numbers: &mut VertexNumbers<'_>,
        sink: &mut impl Sink,
    ) {
        direct_against(walk.scene(), vertex, self.rays, numbers, |direct| {
            add_direct(sink, walk, PathClass::default(), direct);
        });
        let mut ray = *walk;
        let (u_lobe, u) = numbers.scatter();
        if ray.scatter_with(vertex, self.rays, u_lobe, u).is_none() {
            return;
        }
        match ray.next_vertex() {
            None => escape(&ray, sink),
            Some(end) => {
                sink.reached(&ray, &end);
                if let Some(e) = emission_at(&ray, &end) {
                    add_emission(sink, &ray, PathClass::default(), &e);
                }
            }
        }
    }

    /// Light that photons bring to a D surface.
    #[inline]
    fn merge<S: Sink>(&self, walk: &Walk<'_>, vertex: &Vertex, sink: &mut S) {
        let Some(map) = self.map else { return };
        let radius = self.radius.at(vertex.footprint);
        // The events before, and the one here, count on the whole path.
        let most = self.max_depth - walk.depth - 1;
        let mut sums: [S::Sum; 3] = Default::default();
        let within = merge_within(map, vertex, radius, KERNEL, |photon, radiance| {
            let depth = u32::from(photon.depth());
            if depth <= most {
                let flags = photon.flags();
                sums[layer_of(depth, flags)].add(Source::of_flags(flags), radiance);
            }
        });
        if within.count > 0 && !is_hidden(walk.scene(), map, vertex, &within) {
            let layers = [LightLayer::Direct, LightLayer::Caustic, LightLayer::Indirect];
            for (layer, sum) in layers.into_iter().zip(sums) {
                sink.add_sum(layer, Technique::Merge, sum.map(|sum| walk.throughput * sum));
            }
            sink.density(within.density(radius));
        }
    }
}

/// Which of the layers E S* D L, E S* D S⁺ L and all others.
#[inline]
fn layer_of(depth: u32, flags: PhotonFlags) -> usize {
    match depth {
        0 => 0,
        _ if flags.contains(PhotonFlags::CAUSTIC) => 1,
        _ => 2,
    }
}

/// Median radius where the middles of pixels, spread evenly over the picture, see a D surface; 0 where none does.
fn typical_radius(scene: &Scene, radius: &PassRadius) -> f32 {
    let [width, height] = scene.resolution().map(|n| n as f32);
    let radius_at = |i: usize| {
        let at = [i % PROBES, i / PROBES].map(|k| (k as f32 + 0.5) / PROBES as f32);
        let camera = scene.camera().sample_we(Vec2::new(at[0] * width, at[1] * height), [0.5; 2]);
        let mut walk = Walk::new(
            scene,
            TransportMode::Radiance,
            camera.ray,
            Lanes::ONE,
            scene.camera_medium(camera.ray.origin),
        )
        .with_footprint(camera.width, camera.spread);
        let vertex = walk.next_vertex()?;
        vertex.bsdf.has_diffuse().then(|| radius.at(vertex.footprint))
    };
    median((0..PROBES * PROBES).filter_map(radius_at).collect()).unwrap_or(0.0)
}
