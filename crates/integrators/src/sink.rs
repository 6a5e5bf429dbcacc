use color::Lanes;
use film::PixelSample;
use scene::LightId;
use transport::{LightLayer, Vertex, Walk};

/// How a path was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Technique {
    /// The eye path met the light by itself.
    Emission,
    /// Light sampling at the last vertex of the eye path.
    Direct,
    /// Density estimation from photons.
    Merge,
    /// A vertex of an eye path joined to one of a light path.
    Connect,
    /// A vertex of a light path joined to the camera.
    Project,
}

impl Technique {
    /// All, in the order of files.
    pub const ALL: [Self; 5] = [Self::Emission, Self::Direct, Self::Merge, Self::Connect, Self::Project];

    /// The name in files and messages.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Emission => "emission",
            Self::Direct => "direct",
            Self::Merge => "merge",
            Self::Connect => "connect",
            Self::Project => "project",
        }
    }
}

/// What is known of some light that reached the film.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Origin {
    pub layer: LightLayer,
    pub technique: Technique,
    /// Which light, where one alone is meant.
    pub light: Option<LightId>,
}

/// Takes what an integrator finds along one eye path.
pub(crate) trait Sink {
    /// Radiance at the camera, times its weight against other techniques.
    fn add(&mut self, origin: Origin, radiance: Lanes);

    /// The first surface.
    fn features(&mut self, vertex: &Vertex);

    /// Photons per unit area that an estimate found.
    fn density(&mut self, photons_per_area: f32);

    /// The walk has reached a vertex. For replays; films have no use for it.
    #[inline]
    fn reached(&mut self, _walk: &Walk<'_>, _vertex: &Vertex) {}
}

/// Greatest photon density that a film is given: in small scenes the square of a length is smaller yet.
const DENSEST: f32 = 8e9;

impl Sink for PixelSample {
    #[inline]
    fn add(&mut self, origin: Origin, radiance: Lanes) {
        let target = match origin.layer {
            LightLayer::Direct => &mut self.direct,
            LightLayer::Caustic => &mut self.caustic,
            LightLayer::Indirect => &mut self.indirect,
        };
        for (t, r) in target.iter_mut().zip(radiance.to_rgb()) {
            *t += r;
        }
    }

    #[inline]
    fn features(&mut self, vertex: &Vertex) {
        let ns = vertex.bsdf.ns();
        let facing = if ns.dot(vertex.wo) < 0.0 { -ns } else { ns };
        self.albedo = vertex.bsdf.albedo(vertex.wo).to_rgb();
        self.normal = facing.to_array();
        self.depth = vertex.hit.t;
    }

    #[inline]
    fn density(&mut self, photons_per_area: f32) {
        self.photon_density = (self.photon_density + photons_per_area).min(DENSEST);
    }
}
