//! Light transport algorithms, one paper a file. An integrator turns (scene, settings, pass index) into one film
//! contribution, a pure function; no clocks, locks, atomics or printing.

mod auto;
mod caustics;
mod eye;
mod irradiance;
mod layers;
mod maps;
mod numbers;
mod path;
mod photon_map;
mod photon_pass;
mod pixels;
mod plan;
mod radius;
mod replay;
mod settings;
mod sink;
mod sppm;
mod vcm;

use film::{FilmError, PassFilm};
use scene::Scene;

pub use auto::Auto;
pub use layers::layer_names;
pub use maps::{MapReport, Maps, TracedPhotons};
pub use path::Path;
pub use photon_map::PhotonMapper;
pub use photons::Kernel;
pub use radius::{RadiusSettings, StartRadius};
pub use replay::{NonFinitePhoton, PathEvent, PathRecord, PhotonKind, VertexRecord};
pub use settings::{
    DirectLight, IntegratorKind, LayerSettings, PhotonMapSettings, Settings, SppmSettings, VcmSettings,
    VcmTechniques,
};
pub use sink::Technique;
pub use sppm::Sppm;
pub use transport::PathEnd;
pub use vcm::Vcm;

/// What sessions run. Object-safe: sessions meet it once a pass.
pub trait Integrator: Send + Sync {
    /// As in scene files.
    fn name(&self) -> &'static str;

    /// Index of the photon maps that a pass looks up; `None`: it needs none. Equal indices mean equal maps, so a
    /// session may keep them from pass to pass.
    fn map_index(&self, pass: u64) -> Option<u64>;

    /// First step towards the maps of an index: traces the photons.
    fn trace_photons(&self, scene: &Scene, map_index: u64) -> TracedPhotons;

    /// Second step: builds the maps.
    fn build_maps(&self, scene: &Scene, photons: TracedPhotons) -> Maps;

    /// One pass: one camera sample a pixel, with the layers that [`layer_names`] says. `maps`: those of
    /// `map_index(pass)`.
    ///
    /// # Errors
    /// As [`PassFilm::new`]: where the film is too large to be addressed.
    fn render(&self, scene: &Scene, maps: Option<&Maps>, pass: u64) -> Result<PassFilm, FilmError>;

    /// Traces the eye path of a pass through a pixel again. `maps`: as for [`render`](Self::render); `pixel`: column and
    /// row, within the scene's resolution.
    fn replay_pixel(&self, scene: &Scene, maps: Option<&Maps>, pass: u64, pixel: [usize; 2]) -> PathRecord;

    /// The photons that are traced for each map index, and how many paths; those of none are left out.
    fn photon_paths(&self, scene: &Scene) -> Vec<(PhotonKind, u64)>;

    /// Traces a photon path again, one of [`photon_paths`](Self::photon_paths); others give an empty record.
    fn replay_photon(&self, scene: &Scene, map_index: u64, kind: PhotonKind, path: u64) -> PathRecord;
}

/// The integrator that the settings name, for renders of `scene`. Cost: `auto` traces a pilot, some 10⁵ paths; the
/// others cost nothing.
pub fn integrator(settings: &Settings, scene: &Scene) -> Box<dyn Integrator> {
    match settings.kind {
        IntegratorKind::Auto => Box::new(Auto::new(settings.clone(), scene)),
        IntegratorKind::Path => Box::new(Path::new(settings.clone())),
        IntegratorKind::Sppm => Box::new(Sppm::new(settings.clone())),
        IntegratorKind::Vcm => Box::new(Vcm::new(settings.clone())),
        IntegratorKind::PhotonMap => Box::new(PhotonMapper::new(settings.clone())),
    }
}
