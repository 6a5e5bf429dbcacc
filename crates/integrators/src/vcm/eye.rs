//! The eye paths of a pass.

use bsdf::Lobes;
use color::Lanes;
use math::PI;
use photons::Kernel;
use sampling::{Domain, Sampler, Streams};
use scene::LightId;
use transport::{
    Connections, Emission, LightClass, LightLayer, LightVertex, MergingWeights, PathClass, PathEnd,
    PathVertex, Subpath, connect, connect_light, emission_against_all, escape_against_all, is_hidden,
    merge_within, trace_light_path,
};

use super::{Merging, Plan};
use crate::Maps;
use crate::VcmTechniques;
use crate::numbers::VertexNumbers;
use crate::pixels::{CameraPath, Tracer};
use crate::sink::{Origin, Sink, Source, Technique};

pub(super) struct Eye<'a> {
    plan: Plan,
    maps: &'a Maps,
    light_paths: Streams,
}

/// What an eye path knows of itself at a vertex.
struct Reached<'v> {
    at: &'v PathVertex,
    /// Events before, the one at the vertex included.
    class: PathClass,
    radius: f32,
    eta: f64,
}

impl<'a> Eye<'a> {
    pub fn new(plan: Plan, maps: &'a Maps, seed: u64, pass: u64) -> Self {
        Self { plan, maps, light_paths: Streams::new(seed, pass, Domain::LightPath) }
    }
}

impl Tracer for Eye<'_> {
    #[inline]
    fn trace<S: Sink>(&self, path: CameraPath<'_>, sink: &mut S) {
        let CameraPath { walk, mut sampler, strata, film_position, .. } = path;
        let plan = &self.plan;
        let (ray, camera) = (walk.ray, walk.scene().camera());
        // Light paths are joined to what is in the picture. A picture of all directions has what lies beyond its border
        // elsewhere.
        let rays = if camera.holds(film_position) { plan.film_density } else { 0.0 };
        let density = camera.pdf_we(ray.origin, ray.direction).times(rays);
        let mut path = Subpath::from_camera(walk, density, plan.connections);
        let mut class = PathClass::default();
        // Radius and η are those of the first vertex that is not specular.
        let mut merging: Option<(f32, f64)> = None;
        let mut lights = JoinedPath::default();
        loop {
            let vertex = path.next_vertex();
            let eta = merging.map_or(0.0, |(_, eta)| eta);
            let Some(at) = vertex else {
                for e in escape_against_all(path.scene(), path.end(), eta) {
                    self.add_emission(&path, class, &e, sink);
                }
                return sink.ended(PathEnd::Escaped);
            };
            sink.reached(&path.walk, &at.vertex);
            if path.walk.shows(&at.vertex) {
                sink.features(&path.walk, &at.vertex);
            }
            if let Some(e) = emission_against_all(path.scene(), &path.end(), &at.vertex, eta) {
                self.add_emission(&path, class, &e, sink);
            }
            if path.walk.depth >= plan.max_depth || plan.techniques == VcmTechniques::LightTracing {
                return sink.ended(PathEnd::Depth);
            }
            let specular = !at.vertex.bsdf.has_diffuse();
            let mut lobes = Lobes::ALL;
            if !at.vertex.bsdf.is_delta_only() {
                let first = merging.is_none();
                let (radius, eta) = *merging.get_or_insert_with(|| {
                    let radius = plan.radius.at(at.vertex.footprint);
                    (radius, plan.eta(radius))
                });
                let reached = Reached { at: &at, class: class.scattered(specular), radius, eta };
                if plan.connections == Connections::Made {
                    let mut numbers = VertexNumbers::new(&strata, &mut sampler, path.walk.depth);
                    self.light(&path, &reached, &mut numbers, sink);
                    self.join(&path, &reached, &mut lights, &mut sampler, sink);
                }
                if plan.merging != Merging::Never && at.is_merged() {
                    let sight = if first { Sight::Asked } else { Sight::Granted };
                    self.merge(&path, &reached, sight, sink);
                    if plan.merging == Merging::First {
                        lobes = Lobes::DELTA;
                    }
                }
            }
            let Some(scattered) = path.scatter(&at, lobes, &mut sampler) else {
                return sink.ended(PathEnd::Lost);
            };
            class = class.scattered(specular || scattered.lobes.contains(Lobes::SPECULAR));
        }
    }
}

/// Whether a wall between a vertex and its photons is looked for: at the first alone, for where the camera does not
/// see a leak of light as such, that is not worth a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Sight {
    Asked,
    Granted,
}

/// The light path that an eye path is joined to, traced when it is needed.
#[derive(Default)]
struct JoinedPath {
    vertices: Option<Vec<LightVertex>>,
}

impl Eye<'_> {
    /// Light that the eye path met. What the camera sees straight away nothing else has found.
    #[inline]
    fn add_emission(&self, path: &Subpath<'_>, class: PathClass, e: &Emission, sink: &mut impl Sink) {
        let weight = if path.walk.depth == 0 { 1.0 } else { e.weight };
        let origin =
            Origin { layer: class.layer(), technique: Technique::Emission, source: Source::Light(e.light) };
        sink.add(origin, path.walk.throughput * e.radiance * weight);
    }

    /// Light sampling.
    #[inline]
    fn light(
        &self,
        path: &Subpath<'_>,
        here: &Reached<'_>,
        numbers: &mut VertexNumbers<'_>,
        sink: &mut impl Sink,
    ) {
        connect_light(path.scene(), here.at, here.eta, numbers, |direct| {
            let origin = Origin {
                layer: here.class.layer(),
                technique: Technique::Direct,
                source: Source::Light(direct.light),
            };
            sink.add(origin, path.walk.throughput * direct.radiance);
        });
    }

    /// Connections with the vertices of one light path.
    #[inline]
    fn join(
        &self,
        path: &Subpath<'_>,
        here: &Reached<'_>,
        lights: &mut JoinedPath,
        sampler: &mut Sampler,
        sink: &mut impl Sink,
    ) {
        let (scene, walk) = (path.scene(), &path.walk);
        let vertices = lights.vertices.get_or_insert_with(|| {
            // Any of them, whatever the pixel.
            let index = (u64::from(sampler.next_u32()) * self.plan.count) >> 32;
            sink.joined(index);
            let mut vertices = Vec::with_capacity(8);
            let mut stream = self.light_paths.path(index);
            let depth = self.plan.max_depth - walk.depth - 1;
            trace_light_path(scene, depth, self.plan.connections, &mut stream, |v| vertices.push(*v));
            vertices
        });
        for light in vertices.iter() {
            // Both ends scatter.
            if walk.depth + light.depth + 2 > self.plan.max_depth || !light.flux.is_finite() {
                break;
            }
            if let Some(radiance) = connect(scene, here.at, light, here.eta) {
                let specular = !light.at.vertex.bsdf.has_diffuse();
                let layer = light.class.scattered(specular).after(here.class).layer();
                let origin =
                    Origin { layer, technique: Technique::Connect, source: Source::Light(light.light) };
                sink.add(origin, walk.throughput * radiance);
            }
        }
    }

    /// Light that photons bring.
    #[inline]
    fn merge(&self, path: &Subpath<'_>, here: &Reached<'_>, sight: Sight, sink: &mut impl Sink) {
        let Some(stored) = &self.maps.merging else { return };
        let Reached { at, class, radius, eta } = *here;
        let paths = &self.maps.light_side.paths;
        let most = self.plan.max_depth - path.walk.depth - 1;
        let weights = MergingWeights::new(at, eta);
        let mut sums = Sums::new(class);
        let within = merge_within(&stored.map, &at.vertex, radius, Kernel::Constant, |photon, radiance| {
            let light = &paths[photon.slot as usize];
            if u32::from(light.depth) > most {
                return;
            }
            let weight = match self.plan.merging {
                Merging::First => 1.0,
                _ => weights.weight(&light.mis, photon.direction()),
            };
            sums.add(light.light, light.class, radiance * weight);
        });
        if sight == Sight::Granted || !is_hidden(path.scene(), &stored.map, &at.vertex, &within) {
            sums.give(path.walk.throughput, sink);
        }
        if path.walk.depth == 0 && within.count > 0 {
            sink.density(within.count as f32 / (PI * radius * radius));
        }
    }
}

/// Photons by their lights and their paths' classes.
struct Sums {
    layers: [LightLayer; 6],
    light: LightId,
    sums: [Lanes; 6],
    /// Those of other lights before.
    before: Vec<(LightId, [Lanes; 6])>,
}

impl Sums {
    fn new(eye: PathClass) -> Self {
        Self {
            layers: LightClass::layers_after(eye),
            light: LightId(0),
            sums: [Lanes::ZERO; 6],
            before: Vec::new(),
        }
    }

    #[inline]
    fn add(&mut self, light: LightId, class: LightClass, radiance: Lanes) {
        if light != self.light {
            let sums = std::mem::replace(&mut self.sums, [Lanes::ZERO; 6]);
            if sums.iter().any(|sum| !sum.is_zero()) {
                self.before.push((self.light, sums));
            }
            self.light = light;
        }
        self.sums[class.index()] += radiance;
    }

    /// Hands over what there is.
    #[inline]
    fn give(&self, throughput: Lanes, sink: &mut impl Sink) {
        for (light, sums) in self.before.iter().chain([&(self.light, self.sums)]) {
            for (sum, layer) in sums.iter().zip(self.layers) {
                if !sum.is_zero() {
                    let origin = Origin { layer, technique: Technique::Merge, source: Source::Light(*light) };
                    sink.add(origin, throughput * *sum);
                }
            }
        }
    }
}
