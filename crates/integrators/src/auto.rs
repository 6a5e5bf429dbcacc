//! Path tracing, light sampling and merging with caustic photons under one set of weights: the cheap part of vertex
//! connection and merging (Georgiev et al. 2012), with photons alone where nothing else finds the light well. Paths
//! E … D S⁺ L are found by BSDF sampling, by light sampling at a rough end of the chain, and by merging at D; all other
//! paths by BSDF and light sampling. Nothing need be set: what photons are worth is found by a pilot ([`Plan`]).

use bsdf::{Lobes, TransportMode};
use film::{FilmError, PassFilm};
use photons::{Kernel, PhotonMap};
use sampling::Domain;
use scene::Scene;
use transport::{
    CausticJob, Direct, EyeChain, LightLayer, PathClass, PathEnd, Vertex, Walk, direct, direct_in_chain,
    emission_in_chain, escaped_in_chain, is_hidden, merge_within,
};

use crate::caustics::{Caustics, replay_caustic_job, trace_caustic_job};
use crate::maps::StoredMap;
use crate::numbers::VertexNumbers;
use crate::path::{add_direct, add_emission, survival};
use crate::pixels::{CameraPath, Tracer, render_pixels};
use crate::plan::Plan;
use crate::radius::PassRadius;
use crate::replay::record_pixel;
use crate::sink::{Sink, Source, Sum, Technique};
use crate::{Integrator, Maps, PathRecord, PhotonKind, RadiusSettings, Settings, StartRadius, TracedPhotons};

/// Radii. No setting: weights hand to other techniques what a radius does not suit.
pub(crate) const RADIUS: RadiusSettings =
    RadiusSettings { start: StartRadius::Pixels(3.0), alpha: 2.0 / 3.0 };
/// For equal bias, of all kernels that of the least variance (Epanechnikov 1969).
const KERNEL: Kernel = Kernel::Epanechnikov;

/// The default integrator.
#[derive(Clone, Debug)]
pub struct Auto {
    settings: Settings,
    plan: Plan,
}

impl Auto {
    /// For renders of a scene, where a pilot finds how many photons are worth tracing.
    pub fn new(settings: Settings, scene: &Scene) -> Self {
        let plan = Plan::new(&settings, scene);
        Self { settings, plan }
    }

    /// Photon paths that each pass traces; 0 where there is nothing for them to find.
    pub fn paths_per_pass(&self) -> u64 {
        self.plan.paths
    }

    fn job(&self, map_index: u64) -> CausticJob {
        CausticJob {
            count: self.plan.paths,
            seed: self.settings.seed,
            map_index,
            domain: Domain::CausticPhoton,
            max_depth: self.settings.max_depth,
        }
    }

    fn eye<'a>(&self, scene: &Scene, maps: Option<&'a Maps>, pass: u64) -> Eye<'a> {
        let radius = RADIUS.of_pass(pass, scene.bounds().size().length());
        let photons = maps.and_then(|maps| Merging::new(maps, radius, self.plan.paths));
        Eye { photons, max_depth: self.settings.max_depth }
    }
}

impl Integrator for Auto {
    fn name(&self) -> &'static str {
        "auto"
    }

    fn map_index(&self, pass: u64) -> Option<u64> {
        (self.plan.paths > 0).then_some(pass)
    }

    fn trace_photons(&self, scene: &Scene, map_index: u64) -> TracedPhotons {
        let Caustics { photons, rivals, nonfinite } = trace_caustic_job(scene, &self.job(map_index));
        TracedPhotons { caustic: photons, rivals, nonfinite, ..TracedPhotons::default() }
    }

    fn build_maps(&self, _scene: &Scene, photons: TracedPhotons) -> Maps {
        let (map, order) = PhotonMap::build_ordered(photons.caustic);
        let rivals = order.iter().map(|&i| photons.rivals[i as usize]).collect();
        let typical_radius = self.plan.typical_radius;
        let caustic = Some(StoredMap { map, typical_radius, max_radius: None });
        Maps { caustic, rivals, ..Maps::default() }
    }

    fn render(&self, scene: &Scene, maps: Option<&Maps>, pass: u64) -> Result<PassFilm, FilmError> {
        render_pixels(scene, &self.settings, pass, &self.eye(scene, maps, pass))
    }

    fn replay_pixel(&self, scene: &Scene, maps: Option<&Maps>, pass: u64, pixel: [usize; 2]) -> PathRecord {
        record_pixel(scene, &self.settings, pass, pixel, &self.eye(scene, maps, pass)).finish()
    }

    fn photon_paths(&self, _scene: &Scene) -> Vec<(PhotonKind, u64)> {
        let paths = (PhotonKind::Caustic, self.plan.paths);
        if paths.1 > 0 { vec![paths] } else { Vec::new() }
    }

    fn replay_photon(&self, scene: &Scene, map_index: u64, kind: PhotonKind, path: u64) -> PathRecord {
        match kind {
            PhotonKind::Caustic => replay_caustic_job(scene, &self.job(map_index), path),
            PhotonKind::Global => PathRecord::default(),
        }
    }
}

/// The photons of a pass.
pub(crate) struct Merging<'a> {
    map: &'a PhotonMap,
    rivals: &'a [f32],
    radius: PassRadius,
    paths: u64,
}

impl<'a> Merging<'a> {
    pub fn new(maps: &'a Maps, radius: PassRadius, paths: u64) -> Option<Self> {
        let stored = maps.caustic.as_ref()?;
        Some(Self { map: &stored.map, rivals: &maps.rivals, radius, paths })
    }
}

/// The eye paths of a pass.
pub(crate) struct Eye<'a> {
    pub photons: Option<Merging<'a>>,
    pub max_depth: u32,
}

impl Tracer for Eye<'_> {
    #[inline]
    fn trace<S: Sink>(&self, path: CameraPath<'_>, sink: &mut S) {
        let CameraPath { mut walk, mut sampler, strata, .. } = path;
        let scene = walk.scene();
        let mut class = PathClass::default();
        let mut chain = EyeChain::default();
        // Of merging, at all D surfaces of the path; 0 before the first.
        let mut radius = 0.0;
        loop {
            let Some(vertex) = walk.next_vertex() else {
                for e in escaped_in_chain(walk, chain) {
                    add_emission(sink, &walk, class, &e);
                }
                return sink.ended(PathEnd::Escaped);
            };
            sink.reached(&walk, &vertex);
            if walk.shows(&vertex) {
                sink.features(&walk, &vertex);
            }
            if let Some(e) = emission_in_chain(&walk, &vertex, &chain) {
                add_emission(sink, &walk, class, &e);
            }
            if walk.depth >= self.max_depth {
                return sink.ended(PathEnd::Depth);
            }
            let is_d = vertex.bsdf.has_diffuse();
            let mut numbers = VertexNumbers::new(&strata, &mut sampler, walk.depth);
            let mut found = |light: &Direct| add_direct(sink, &walk, class.scattered(!is_d), light);
            if !is_d && chain.would_compete() {
                direct_in_chain(scene, &vertex, &chain, &mut numbers, &mut found);
            } else {
                direct(scene, &vertex, &mut numbers, &mut found);
            }
            if let (true, Some(photons)) = (is_d, &self.photons) {
                if radius == 0.0 {
                    radius = photons.radius.at(vertex.footprint);
                }
                photons.merge(&walk, &vertex, class, radius, self.max_depth, sink);
            }
            let (u_lobe, u) = numbers.scatter();
            let Some(scattered) = walk.scatter_with(&vertex, Lobes::ALL, u_lobe, u) else {
                return sink.ended(PathEnd::Absorbed);
            };
            let specular = !is_d || scattered.lobes.contains(Lobes::SPECULAR);
            class = class.scattered(specular);
            match &self.photons {
                Some(_) if specular => chain.extend(&walk, &vertex, &scattered),
                Some(photons) => {
                    chain = EyeChain::start(&walk, &vertex, &scattered, photons.acceptance(radius));
                }
                None => {}
            }
            if !walk.roulette(survival(&walk), &mut sampler) {
                return sink.ended(PathEnd::Roulette);
            }
        }
    }
}

impl Merging<'_> {
    /// n·π·r².
    #[inline]
    fn acceptance(&self, radius: f32) -> f64 {
        std::f64::consts::PI * f64::from(radius) * f64::from(radius) * self.paths as f64
    }

    /// Caustic light at a D surface.
    #[inline]
    fn merge<S: Sink>(
        &self,
        walk: &Walk<'_>,
        vertex: &Vertex,
        class: PathClass,
        radius: f32,
        max_depth: u32,
        sink: &mut S,
    ) {
        let per_acceptance = (1.0 / self.acceptance(radius)) as f32;
        // The events before, and the one here, count on the whole path.
        let most = max_depth - walk.depth - 1;
        let mut sum = S::Sum::default();
        let within = merge_within(self.map, vertex, radius, KERNEL, |photon, radiance| {
            if u32::from(photon.depth()) > most {
                return;
            }
            let pdf_w = vertex.bsdf.pdf_w(vertex.wo, photon.direction(), TransportMode::Radiance);
            let rivals = self.rivals[photon.slot as usize] * pdf_w * per_acceptance;
            sum.add(Source::of(photon), radiance * (1.0 / (1.0 + rivals)));
        });
        if within.count == 0 || is_hidden(walk.scene(), self.map, vertex, &within) {
            return;
        }
        let layer = class.scattered(false).scattered(true).layer();
        sink.add_sum(layer, Technique::Merge, sum.map(|sum| walk.throughput * sum));
        if layer == LightLayer::Caustic {
            sink.density(within.density(radius));
        }
    }
}
