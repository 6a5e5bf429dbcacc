use bsdf::{Bsdf, BsdfKind, Lobes, TransportMode};
use math::Vec3;
use sampling::Sampler;
use scene::camera::WePdf;
use scene::light::{LeSample, Receiver};
use scene::{LightId, Scene};

use crate::mis::Scattering;
use crate::{Connections, LightDensities, Scattered, SubpathMis, Vertex, Walk};

/// A walk whose vertices know the densities that weights need. Its roulette is local, so that the other side's
/// densities include it: survival is the greatest lane of the albedo where no delta lobe was drawn, else 1.
#[derive(Clone, Copy, Debug)]
pub struct Subpath<'s> {
    /// The walk.
    pub walk: Walk<'s>,
    connections: Connections,
    /// As the path left its last vertex, or where it starts.
    leaving: SubpathMis,
    from: Receiver,
    /// Until its first vertex is known.
    start: Start,
}

/// What the first edge of a subpath needs.
#[derive(Clone, Copy, Debug)]
enum Start {
    /// It starts there.
    Light(LightId, LeSample),
    /// The camera's rays are parallel.
    Parallel,
    /// Nothing more.
    Point,
}

/// A vertex of a subpath.
#[derive(Clone, Copy, Debug)]
pub struct PathVertex {
    /// The surface; `wo` points to where the path came from.
    pub vertex: Vertex,
    /// As the path arrived.
    pub mis: SubpathMis,
}

impl PathVertex {
    /// Whether photons are merged there: on surfaces that scatter by more than delta lobes, and to one side only.
    #[inline]
    pub fn is_merged(&self) -> bool {
        is_merged(self.vertex.bsdf.kind())
    }

    /// Chance that a path which comes here meets a surface on which photons are merged: their flux is over it, as the
    /// eye path that they are merged with takes the chance again.
    #[inline]
    pub fn presence(&self, scene: &Scene) -> f32 {
        scene.presence(&self.vertex.hit, is_merged)
    }
}

/// What an eye path knows where it meets a light.
#[derive(Clone, Copy, Debug)]
pub struct EyeEnd {
    /// Its last vertex.
    pub from: Receiver,
    /// Direction of its last ray.
    pub direction: Vec3,
    /// As it left that vertex.
    pub leaving: SubpathMis,
}

impl<'s> Subpath<'s> {
    /// From the camera; `density`: camera paths for each light path (0: light paths cannot be joined to it).
    #[inline]
    pub fn from_camera(walk: Walk<'s>, density: WePdf, connections: Connections) -> Self {
        let (mis, start) = match density {
            WePdf::PerSteradian(density) => (SubpathMis::of_camera(density), Start::Point),
            WePdf::PerArea(density) => (SubpathMis::of_camera(density), Start::Parallel),
        };
        let leaving = if connections == Connections::Made { mis } else { mis.without_edge() };
        Self { from: Receiver { p: walk.ray.origin, n: Vec3::ZERO }, walk, connections, leaving, start }
    }

    /// From a light.
    #[inline]
    pub fn from_light(walk: Walk<'s>, id: LightId, le: LeSample, connections: Connections) -> Self {
        let leaving = SubpathMis::default();
        Self {
            from: Receiver { p: le.p, n: Vec3::ZERO },
            walk,
            connections,
            leaving,
            start: Start::Light(id, le),
        }
    }

    /// The next surface.
    #[inline]
    pub fn next_vertex(&mut self) -> Option<PathVertex> {
        let vertex = self.walk.next_vertex();
        if !self.walk.is_clear() {
            self.leaving = self.leaving.without_edge();
        }
        let vertex = vertex?;
        let p = vertex.hit.p;
        let distance2 = match std::mem::replace(&mut self.start, Start::Point) {
            Start::Light(id, le) => {
                let start = LightDensities::of_start(self.walk.scene(), id, &le, &vertex.receiver())
                    .start(self.connections);
                self.leaving = if self.walk.is_clear() { start } else { start.without_edge() };
                1.0
            }
            Start::Parallel => 1.0,
            Start::Point => f64::from(p.distance_squared(self.from.p)),
        };
        let mis = self.leaving.arrived(distance2, geometric_cos(&vertex, vertex.wo));
        Some(PathVertex { vertex, mis })
    }

    /// Where an eye path is when it meets a light.
    #[inline]
    pub fn end(&self) -> EyeEnd {
        EyeEnd { from: self.from, direction: self.walk.ray.direction, leaving: self.leaving }
    }

    /// Goes on from a vertex along one of the admitted lobes. `None`: it ends there.
    #[inline]
    pub fn scatter(&mut self, at: &PathVertex, lobes: Lobes, sampler: &mut Sampler) -> Option<Scattered> {
        let PathVertex { vertex, mis } = at;
        let scattered = self.walk.scatter_lobes(vertex, lobes, sampler)?;
        let specular = scattered.lobes.contains(Lobes::SPECULAR);
        let q = if specular { 1.0 } else { survival(&vertex.bsdf, vertex.wo) };
        if !self.walk.roulette(q, sampler) {
            return None;
        }
        let wi = self.walk.ray.direction;
        self.leaving = if specular {
            mis.passed(delta_ratio(vertex, wi, &scattered))
        } else {
            let event = Scattering {
                cos: geometric_cos(vertex, wi),
                forward: f64::from(scattered.pdf_w) * f64::from(q),
                reverse: density(vertex, wi, vertex.wo, other(self.walk.mode())),
                merging: merging(&vertex.bsdf),
            };
            mis.scattered(&event, self.connections)
        };
        self.from = vertex.receiver();
        Some(scattered)
    }

    /// The scene.
    #[inline]
    pub fn scene(&self) -> &'s Scene {
        self.walk.scene()
    }
}

/// |cos| to the geometric normal: what densities per area go with.
#[inline]
pub(crate) fn geometric_cos(vertex: &Vertex, w: Vec3) -> f64 {
    f64::from(vertex.hit.ng.dot(w).abs())
}

/// Density per steradian, survival included, with which a path that comes from `wo` goes on along `wi`.
#[inline]
pub(crate) fn density(vertex: &Vertex, wo: Vec3, wi: Vec3, mode: TransportMode) -> f64 {
    f64::from(vertex.bsdf.pdf_w(wo, wi, mode)) * f64::from(survival(&vertex.bsdf, wo))
}

/// Chance that a path which comes from `w` goes on: from 0.02 to 1.
#[inline]
pub(crate) fn survival(bsdf: &Bsdf, w: Vec3) -> f32 {
    bsdf.albedo(w).max().clamp(0.02, 1.0)
}

/// 1 where photons are merged, else 0.
#[inline]
pub(crate) fn merging(bsdf: &Bsdf) -> f64 {
    if is_merged(bsdf.kind()) { 1.0 } else { 0.0 }
}

/// Whether photons are merged: on surfaces that scatter by more than delta lobes, and to one side only.
#[inline]
fn is_merged(bsdf: &BsdfKind) -> bool {
    !bsdf.is_delta_only() && !bsdf.lobes().contains(Lobes::TRANSMISSION)
}

/// |cos θi| times the density of the delta lobe that leads back over that of the one which leads on. Both are chosen with
/// one probability, which is spread over solid angles of the ratio dω_i/dω_o = (cos θo/cos θi)/η² at refraction, η being
/// the index on the side of `wi` over that on the side of `wo` (Veach 1997, §5.2.2); else 1.
fn delta_ratio(vertex: &Vertex, wi: Vec3, scattered: &Scattered) -> f64 {
    if scattered.lobes.contains(Lobes::TRANSMISSION) {
        geometric_cos(vertex, vertex.wo) / f64::from(scattered.eta).powi(2)
    } else {
        geometric_cos(vertex, wi)
    }
}

#[inline]
pub(crate) fn other(mode: TransportMode) -> TransportMode {
    match mode {
        TransportMode::Radiance => TransportMode::Importance,
        TransportMode::Importance => TransportMode::Radiance,
    }
}
