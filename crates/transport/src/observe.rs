use photons::Photon;
use scene::LightId;

use crate::{Vertex, Walk};

/// How a path ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PathEnd {
    /// It left the scene.
    Escaped,
    /// The surface scattered nothing of it.
    Absorbed,
    /// By Russian roulette.
    Roulette,
    /// Absorbed, or by roulette where that is part of scattering.
    Lost,
    /// By the limit on scattering events.
    Depth,
    /// At a surface where photons stand for the rest of the path, or whose further light is of no use here.
    Complete,
    /// Its throughput was no number.
    NonFinite,
}

impl PathEnd {
    /// In words.
    pub const fn text(self) -> &'static str {
        match self {
            Self::Escaped => "left the scene",
            Self::Absorbed => "absorbed",
            Self::Roulette => "ended by roulette",
            Self::Lost => "absorbed or ended by roulette",
            Self::Depth => "ended by max_depth",
            Self::Complete => "complete",
            Self::NonFinite => "no longer finite",
        }
    }
}

/// Watches one path from a light as it is traced. `()` watches nothing and costs nothing.
pub trait Observer {
    /// The path leaves a light; the walk's ray and throughput are those of the start.
    #[inline]
    fn started(&mut self, _walk: &Walk<'_>, _light: LightId) {}

    /// The path has reached a vertex.
    #[inline]
    fn reached(&mut self, _walk: &Walk<'_>, _vertex: &Vertex) {}

    /// A photon is stored at the vertex reached last.
    #[inline]
    fn stored(&mut self, _photon: &Photon) {}

    /// The path is over.
    #[inline]
    fn ended(&mut self, _end: PathEnd) {}
}

impl Observer for () {}
