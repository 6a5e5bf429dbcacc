//! One path traced again and written down: for values that are no numbers, for fireflies, and for curiosity. A path is a
//! function of its key (seed, pass, domain, index), so it is the same as in the render, to the bit.

use color::Lanes;
use film::PixelSample;
use photons::Photon;
use sampling::{Domain, Streams};
use scene::{LightId, Scene};
use transport::{LightLayer, Observer, PathEnd, Vertex, Walk};

use crate::Settings;
use crate::pixels::{Tracer, start};
use crate::sink::{Origin, Parts, Sink, Source, Technique};

/// Which photons of an integrator a path belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PhotonKind {
    /// From all lights everywhere; the light paths of `vcm` too.
    Global,
    /// Aimed at the specular objects.
    Caustic,
}

impl PhotonKind {
    /// All.
    pub const ALL: [Self; 2] = [Self::Global, Self::Caustic];

    /// The name in messages and on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Global => "global",
            Self::Caustic => "caustic",
        }
    }
}

/// A photon that became non-finite and was dropped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NonFinitePhoton {
    /// Of which photons.
    pub kind: PhotonKind,
    /// Index of its path.
    pub path: u64,
    /// Scattering events before.
    pub depth: u32,
}

/// What happened along a path, in order. Positions and lengths are in scene units, colours linear Rec. 709.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PathRecord {
    /// The events.
    pub events: Vec<PathEvent>,
    /// What an eye path gave its pixel, as in the film's pass (before values that are no numbers are left out); `None` of
    /// photon paths.
    pub sample: Option<PixelSample>,
}

/// One event.
#[derive(Clone, Debug, PartialEq)]
pub enum PathEvent {
    /// A path leaves a light.
    Start {
        /// The light.
        light: String,
        /// Where, moved off the surface.
        position: [f32; 3],
        /// Which way, unit.
        direction: [f32; 3],
        /// Flux in W.
        flux: [f32; 3],
    },
    /// A surface is reached.
    Vertex(VertexRecord),
    /// Light reaches the camera.
    Light {
        /// Layer of the film: "direct", "caustic" or "indirect".
        layer: &'static str,
        /// How it was found.
        technique: Technique,
        /// The lights or groups of lights that it comes from, as far as known.
        from: Vec<String>,
        /// Radiance as it was added to the pixel, before the pixel filter's weight.
        radiance: [f32; 3],
    },
    /// The eye path is joined to the vertices of this light path of the pass.
    Joined {
        /// Its index.
        light_path: u64,
    },
    /// A photon is stored at the last vertex.
    Stored {
        /// Its flux in W.
        power: [f32; 3],
        /// Whether it counts as caustic.
        caustic: bool,
    },
    /// A vertex of a light path is seen by the camera.
    Splat {
        /// Where on the film, in pixels.
        film_position: [f32; 2],
        /// Layer of the film.
        layer: &'static str,
        /// Weighted radiance of a pixel there, before the filter.
        radiance: [f32; 3],
    },
    /// A walk is over.
    End(PathEnd),
}

/// A surface that a path reached.
#[derive(Clone, Debug, PartialEq)]
pub struct VertexRecord {
    /// Scattering events before.
    pub depth: u32,
    /// The point.
    pub position: [f32; 3],
    /// Length of the ray that reached it.
    pub distance: f32,
    /// Name of the object or instance.
    pub object: Option<String>,
    /// Name of the material.
    pub material: Option<String>,
    /// Kind of scattering function.
    pub scattering: String,
    /// Whether photons are stored there: D, else S.
    pub is_diffuse: bool,
    /// The light that the surface is.
    pub light: Option<String>,
    /// Geometric normal, unit.
    pub ng: [f32; 3],
    /// Shading normal, unit.
    pub ns: [f32; 3],
    /// Width of the ray there; of eye paths alone.
    pub footprint: f32,
    /// Throughput of an eye path, flux in W of a photon, after roulette.
    pub throughput: [f32; 3],
}

impl VertexRecord {
    fn new(walk: &Walk<'_>, vertex: &Vertex) -> Self {
        let (scene, hit) = (walk.scene(), &vertex.hit);
        let kind = format!("{:?}", vertex.bsdf.kind());
        let name: String = kind.chars().take_while(|c| c.is_alphanumeric()).collect();
        Self {
            depth: walk.depth,
            position: hit.p.to_array(),
            distance: hit.t,
            object: scene.object_name(&walk.ray).map(str::to_owned),
            material: scene.material_name(hit.material).map(str::to_owned),
            scattering: name.to_lowercase(),
            is_diffuse: vertex.bsdf.has_diffuse(),
            light: hit.light.map(|light| scene.light_name(light).to_owned()),
            ng: hit.ng.to_array(),
            ns: vertex.bsdf.ns().to_array(),
            footprint: vertex.footprint,
            throughput: walk.throughput.to_rgb(),
        }
    }
}

pub(crate) fn layer_name(layer: LightLayer) -> &'static str {
    match layer {
        LightLayer::Direct => "direct",
        LightLayer::Caustic => "caustic",
        LightLayer::Indirect => "indirect",
    }
}

/// Writes an eye path down.
pub(crate) struct Recording<'s> {
    scene: &'s Scene,
    sample: PixelSample,
    events: Vec<PathEvent>,
}

impl Recording<'_> {
    fn name(&self, source: Source) -> Option<String> {
        match source {
            Source::Light(light) => Some(self.scene.light_name(light).to_owned()),
            Source::Group(group) => self.scene.light_groups().get(usize::from(group)).cloned(),
            Source::Unknown => None,
        }
    }

    fn light(&mut self, layer: LightLayer, technique: Technique, from: Vec<String>, radiance: Lanes) {
        let radiance = radiance.to_rgb();
        if radiance != [0.0; 3] {
            self.events.push(PathEvent::Light { layer: layer_name(layer), technique, from, radiance });
        }
    }

    pub fn weight(&self) -> f32 {
        self.sample.weight
    }

    pub fn finish(self) -> PathRecord {
        PathRecord { events: self.events, sample: Some(self.sample) }
    }
}

impl Sink for Recording<'_> {
    type Sum = Parts;

    fn add(&mut self, origin: Origin, radiance: Lanes) {
        self.sample.add(origin, radiance);
        let from = self.name(origin.source).into_iter().collect();
        self.light(origin.layer, origin.technique, from, radiance);
    }

    fn add_sum(&mut self, layer: LightLayer, technique: Technique, sum: Parts) {
        self.sample.add_sum(layer, technique, sum.total);
        let lit = sum.parts.iter().filter(|(_, part)| !part.is_zero());
        let from = lit.filter_map(|(source, _)| self.name(*source)).collect();
        self.light(layer, technique, from, sum.total);
    }

    fn features(&mut self, walk: &Walk<'_>, vertex: &Vertex) {
        self.sample.features(walk, vertex);
    }

    fn density(&mut self, photons_per_area: f32) {
        self.sample.density(photons_per_area);
    }

    fn reached(&mut self, walk: &Walk<'_>, vertex: &Vertex) {
        self.events.push(PathEvent::Vertex(VertexRecord::new(walk, vertex)));
    }

    fn joined(&mut self, light_path: u64) {
        self.events.push(PathEvent::Joined { light_path });
    }

    fn ended(&mut self, end: PathEnd) {
        self.events.push(PathEvent::End(end));
    }
}

/// The eye path of a pass through a pixel, by a tracer of that pass.
pub(crate) fn record_pixel<'s>(
    scene: &'s Scene,
    settings: &Settings,
    pass: u64,
    pixel: [usize; 2],
    tracer: &impl Tracer,
) -> Recording<'s> {
    let path = start(scene, settings, &Streams::new(settings.seed, pass, Domain::Camera), pass, pixel);
    let sample = PixelSample { weight: path.weight, ..PixelSample::default() };
    let mut recording = Recording { scene, sample, events: Vec::new() };
    tracer.trace(path, &mut recording);
    recording
}

/// Writes a photon's path down.
#[derive(Default)]
pub(crate) struct PhotonRecording {
    pub events: Vec<PathEvent>,
}

impl PhotonRecording {
    pub fn finish(self) -> PathRecord {
        PathRecord { events: self.events, sample: None }
    }
}

impl Observer for PhotonRecording {
    fn started(&mut self, walk: &Walk<'_>, light: LightId) {
        self.events.push(PathEvent::Start {
            light: walk.scene().light_name(light).to_owned(),
            position: walk.ray.origin.to_array(),
            direction: walk.ray.direction.to_array(),
            flux: walk.throughput.to_rgb(),
        });
    }

    fn reached(&mut self, walk: &Walk<'_>, vertex: &Vertex) {
        self.events.push(PathEvent::Vertex(VertexRecord::new(walk, vertex)));
    }

    fn stored(&mut self, photon: &Photon) {
        let caustic = photon.flags.contains(photons::PhotonFlags::CAUSTIC);
        self.events.push(PathEvent::Stored { power: photon.power.to_rgb(), caustic });
    }

    fn ended(&mut self, end: PathEnd) {
        self.events.push(PathEvent::End(end));
    }
}
