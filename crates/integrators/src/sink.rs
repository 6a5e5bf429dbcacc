use color::Lanes;
use film::PixelSample;
use photons::{PhotonFlags, PhotonView};
use scene::LightId;
use transport::{LightLayer, PathEnd, Vertex, Walk};

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

/// Where light came from, as far as it is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Source {
    Light(LightId),
    /// A group of lights.
    Group(u8),
    /// Several lights, or one that was not kept.
    Unknown,
}

impl Source {
    #[inline]
    pub fn of_flags(flags: PhotonFlags) -> Self {
        flags.group().map_or(Self::Unknown, Self::Group)
    }

    #[inline]
    pub fn of(photon: &PhotonView<'_>) -> Self {
        Self::of_flags(photon.flags())
    }
}

/// What is known of some light that reached the film.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Origin {
    pub layer: LightLayer,
    pub technique: Technique,
    pub source: Source,
}

/// Adds up radiance before it goes to a sink. The total is the same number whatever else is kept.
pub(crate) trait Sum: Default {
    fn add(&mut self, source: Source, radiance: Lanes);

    /// Adds `total`, whose parts `each` tells where they matter. They agree with the total but for rounding.
    fn add_split(&mut self, total: Lanes, each: impl FnOnce(&mut dyn FnMut(Source, Lanes)));

    fn plus(self, other: Self) -> Self;

    /// `f` is linear.
    fn map(self, f: impl Fn(Lanes) -> Lanes) -> Self;
}

impl Sum for Lanes {
    #[inline]
    fn add(&mut self, _source: Source, radiance: Lanes) {
        *self += radiance;
    }

    #[inline]
    fn add_split(&mut self, total: Lanes, _each: impl FnOnce(&mut dyn FnMut(Source, Lanes))) {
        *self += total;
    }

    #[inline]
    fn plus(self, other: Self) -> Self {
        self + other
    }

    #[inline]
    fn map(self, f: impl Fn(Lanes) -> Lanes) -> Self {
        f(self)
    }
}

/// A sum that remembers where its parts came from.
#[derive(Clone, Debug, Default)]
pub(crate) struct Parts {
    pub total: Lanes,
    pub parts: Vec<(Source, Lanes)>,
}

impl Parts {
    fn add_part(&mut self, source: Source, radiance: Lanes) {
        match self.parts.iter_mut().find(|(s, _)| *s == source) {
            Some((_, sum)) => *sum += radiance,
            None => self.parts.push((source, radiance)),
        }
    }
}

impl Sum for Parts {
    fn add(&mut self, source: Source, radiance: Lanes) {
        self.total += radiance;
        self.add_part(source, radiance);
    }

    fn add_split(&mut self, total: Lanes, each: impl FnOnce(&mut dyn FnMut(Source, Lanes))) {
        self.total += total;
        each(&mut |source, radiance| self.add_part(source, radiance));
    }

    fn plus(mut self, other: Self) -> Self {
        self.total += other.total;
        for (source, radiance) in other.parts {
            self.add_part(source, radiance);
        }
        self
    }

    fn map(mut self, f: impl Fn(Lanes) -> Lanes) -> Self {
        self.total = f(self.total);
        self.parts.iter_mut().for_each(|(_, part)| *part = f(*part));
        self
    }
}

/// Takes what an integrator finds along one eye path. The hooks are for replays; films have no use for them.
pub(crate) trait Sink {
    /// For light of several sources.
    type Sum: Sum;

    /// Radiance at the camera, times its weight against other techniques.
    fn add(&mut self, origin: Origin, radiance: Lanes);

    /// The same of several sources.
    fn add_sum(&mut self, layer: LightLayer, technique: Technique, sum: Self::Sum);

    /// A surface that the walk [shows](Walk::shows): the first one, or what is seen in mirrors and through glass. Of walks
    /// that were split there is one for each.
    fn features(&mut self, walk: &Walk<'_>, vertex: &Vertex);

    /// Photons per unit area that an estimate found.
    fn density(&mut self, photons_per_area: f32);

    /// A walk has reached a vertex.
    #[inline]
    fn reached(&mut self, _walk: &Walk<'_>, _vertex: &Vertex) {}

    /// The eye path is joined to a light path from here on.
    #[inline]
    fn joined(&mut self, _light_path: u64) {}

    /// The walk is over.
    #[inline]
    fn ended(&mut self, _end: PathEnd) {}
}

/// Greatest photon density that a film is given: in small scenes the square of a length is smaller yet.
const DENSEST: f32 = 8e9;

impl Sink for PixelSample {
    type Sum = Lanes;

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
    fn add_sum(&mut self, layer: LightLayer, technique: Technique, sum: Lanes) {
        self.add(Origin { layer, technique, source: Source::Unknown }, sum);
    }

    #[inline]
    fn features(&mut self, walk: &Walk<'_>, vertex: &Vertex) {
        let ns = vertex.bsdf.ns();
        let facing = if ns.dot(vertex.wo) < 0.0 { -ns } else { ns };
        let tint = walk.tint().to_rgb().map(|t| t.clamp(0.0, 1.0));
        let share = tint.into_iter().fold(0.0, f32::max);
        let albedo = vertex.bsdf.albedo(vertex.wo).to_rgb();
        for ((sum, albedo), tint) in self.albedo.iter_mut().zip(albedo).zip(tint) {
            *sum += tint * albedo;
        }
        for (sum, n) in self.normal.iter_mut().zip((facing * share).to_array()) {
            *sum += n;
        }
        self.depth = if self.depth > 0.0 { self.depth.min(walk.length()) } else { walk.length() };
    }

    #[inline]
    fn density(&mut self, photons_per_area: f32) {
        self.photon_density = (self.photon_density + photons_per_area).min(DENSEST);
    }
}
