//! Vertex connection and merging (Georgiev, Křivánek, Davidovič & Slusallek 2012; Hachisuka, Pantaleoni & Jensen 2012):
//! every path from the camera to a light that light sampling, connections, light tracing, photon density estimation or
//! the eye path alone may find counts with the balance heuristic over all of them. Bidirectional path tracing, light
//! tracing, bidirectional photon mapping and progressive photon mapping leave some of these out.
//!
//! Each pass traces light paths, whose vertices become photons and splats, and an eye path a pixel, which is joined to the
//! vertices of one light path. That path is traced once more then: nothing of it is kept but photons and splats.

mod eye;
mod light;
mod splat;

use film::{FilmError, PassFilm};
use scene::Scene;
use transport::Connections;

use crate::pixels::trace_pixels;
use crate::radius::PassRadius;
use crate::replay::record_pixel;
use crate::{Integrator, Maps, PathRecord, PhotonKind, Settings, TracedPhotons, VcmTechniques};

pub(crate) use light::{LightSide, LightTrace};

/// Vertex connection and merging.
#[derive(Clone, Debug)]
pub struct Vcm {
    settings: Settings,
}

/// Where photons are merged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Merging {
    /// At every vertex.
    Every,
    /// At the first that is not specular, where the eye path ends.
    First,
    /// Nowhere.
    Never,
}

/// What one pass combines.
#[derive(Clone, Copy, Debug)]
struct Plan {
    connections: Connections,
    merging: Merging,
    techniques: VcmTechniques,
    /// Light paths.
    count: u64,
    radius: PassRadius,
    max_depth: u32,
    /// Mean density of an eye path's place on the film, for each light path.
    film_density: f64,
}

impl Plan {
    /// η = π·r²·n (Georgiev 2012, eq. 20).
    fn eta(&self, radius: f32) -> f64 {
        if self.merging == Merging::Never {
            return 0.0;
        }
        std::f64::consts::PI * f64::from(radius).powi(2) * self.count as f64
    }
}

impl Vcm {
    /// An integrator of these settings.
    pub fn new(settings: Settings) -> Self {
        Self { settings }
    }

    fn plan(&self, scene: &Scene, pass: u64) -> Plan {
        let vcm = &self.settings.vcm;
        let (connections, merging) = match vcm.techniques {
            VcmTechniques::Vcm => (Connections::Made, Merging::Every),
            VcmTechniques::Bdpt | VcmTechniques::LightTracing => (Connections::Made, Merging::Never),
            VcmTechniques::Bpm => (Connections::None, Merging::Every),
            VcmTechniques::Ppm => (Connections::None, Merging::First),
        };
        let [width, height] = scene.resolution().map(u64::from);
        let count = vcm.light_paths.unwrap_or(width * height);
        Plan {
            connections,
            merging,
            techniques: vcm.techniques,
            count,
            radius: vcm.radius.of_pass(pass, scene.bounds().size().length()),
            max_depth: self.settings.max_depth,
            film_density: f64::from(self.settings.filter.density()) / count as f64,
        }
    }
}

impl Integrator for Vcm {
    fn name(&self) -> &'static str {
        "vcm"
    }

    fn map_index(&self, pass: u64) -> Option<u64> {
        Some(pass)
    }

    fn trace_photons(&self, scene: &Scene, map_index: u64) -> TracedPhotons {
        light::trace(scene, &self.plan(scene, map_index), self.settings.seed, map_index)
    }

    fn build_maps(&self, _scene: &Scene, photons: TracedPhotons) -> Maps {
        light::build(photons)
    }

    fn render(&self, scene: &Scene, maps: Option<&Maps>, pass: u64) -> Result<PassFilm, FilmError> {
        let none = Maps::default();
        let maps = maps.unwrap_or(&none);
        let [width, height] = scene.resolution().map(|n| n as usize);
        let eye = eye::Eye::new(self.plan(scene, pass), maps, self.settings.seed, pass);
        let mut traced = trace_pixels(scene, &self.settings, pass, &eye);
        let splats = &maps.light_side.splats;
        splat::add(splats, &self.settings, [width, height], &mut traced.samples);
        if let Some(layers) = &mut traced.layers {
            splat::add_to_layers(splats, &self.settings, &traced.samples, layers, scene);
        }
        traced.finish(scene)
    }

    fn replay_pixel(&self, scene: &Scene, maps: Option<&Maps>, pass: u64, pixel: [usize; 2]) -> PathRecord {
        let none = Maps::default();
        let maps = maps.unwrap_or(&none);
        let size = scene.resolution().map(|n| n as usize);
        let eye = eye::Eye::new(self.plan(scene, pass), maps, self.settings.seed, pass);
        let mut recording = record_pixel(scene, &self.settings, pass, pixel, &eye);
        let (splats, weight) = (&maps.light_side.splats, recording.weight());
        splat::add_to_pixel(splats, &self.settings.filter, size, pixel, weight, &mut recording);
        recording.finish()
    }

    fn photon_paths(&self, scene: &Scene) -> Vec<(PhotonKind, u64)> {
        vec![(PhotonKind::Global, self.plan(scene, 0).count)]
    }

    fn replay_photon(&self, scene: &Scene, map_index: u64, kind: PhotonKind, path: u64) -> PathRecord {
        match kind {
            PhotonKind::Global => {
                light::replay(scene, &self.plan(scene, map_index), self.settings.seed, map_index, path)
            }
            PhotonKind::Caustic => PathRecord::default(),
        }
    }
}
