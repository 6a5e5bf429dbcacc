//! The light paths of a pass: photons with what weights need of them, and splats.

use std::cell::RefCell;

use photons::{Photon, PhotonFlags, PhotonMap};
use sampling::{Domain, Streams};
use scene::{LightId, Scene};
use transport::{
    Connections, LightClass, LightVertex, Observer, PathClass, PathEnd, SubpathMis, Vertex, Walk, is_seen,
    observe_light_path, project, trace_light_path,
};

use super::splat::Splat;
use super::{Merging, Plan};
use crate::maps::StoredMap;
use crate::radius::median;
use crate::replay::{PhotonRecording, layer_name};
use crate::{Maps, NonFinitePhoton, PathEvent, PathRecord, PhotonKind, TracedPhotons, VcmTechniques};

/// Light paths of one task; fixed, so that results do not depend on the number of threads.
const CHUNK: usize = 1024;

/// What a photon's path was, beside the photon: 20 bytes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PhotonPath {
    pub mis: SubpathMis,
    pub light: LightId,
    pub depth: u16,
    pub class: LightClass,
}

/// What light paths leave beside photons, in index order.
#[derive(Clone, Debug, Default)]
pub(crate) struct LightTrace {
    paths: Vec<PhotonPath>,
    splats: Vec<Splat>,
    /// Radii at the splats.
    radii: Vec<f32>,
}

/// The same as it is looked up.
#[derive(Clone, Debug, Default)]
pub(crate) struct LightSide {
    /// By slot of the photon map.
    pub paths: Vec<PhotonPath>,
    pub splats: Vec<Splat>,
}

/// What a range of light paths gave.
#[derive(Default)]
struct Batch {
    photons: Vec<Photon>,
    trace: LightTrace,
    nonfinite: Vec<NonFinitePhoton>,
}

pub(super) fn trace(scene: &Scene, plan: &Plan, seed: u64, map_index: u64) -> TracedPhotons {
    let streams = Streams::new(seed, map_index, Domain::LightPath);
    let batches = par::map_chunks(plan.count as usize, CHUNK, |range| {
        let mut batch = Batch::default();
        for path in range {
            let mut sampler = streams.path(path as u64);
            trace_light_path(scene, plan.max_depth, plan.connections, &mut sampler, |vertex| {
                batch.add(scene, plan, path as u64, vertex);
            });
        }
        batch
    });
    let mut out = TracedPhotons::default();
    for batch in batches {
        out.global.extend_from_slice(&batch.photons);
        out.light_trace.paths.extend_from_slice(&batch.trace.paths);
        out.light_trace.splats.extend_from_slice(&batch.trace.splats);
        out.light_trace.radii.extend_from_slice(&batch.trace.radii);
        out.nonfinite.extend(batch.nonfinite);
    }
    out.typical_radius = median(std::mem::take(&mut out.light_trace.radii)).unwrap_or(0.0);
    out
}

/// A light path again, with what it leaves.
pub(super) fn replay(scene: &Scene, plan: &Plan, seed: u64, map_index: u64, path: u64) -> PathRecord {
    let mut sampler = Streams::new(seed, map_index, Domain::LightPath).path(path);
    // The path is watched and what it leaves is kept at once.
    let recording = RefCell::new(PhotonRecording::default());
    observe_light_path(
        scene,
        plan.max_depth,
        plan.connections,
        &mut sampler,
        &mut Watched(&recording),
        |vertex| {
            let mut batch = Batch::default();
            batch.add(scene, plan, path, vertex);
            let mut recording = recording.borrow_mut();
            batch.photons.iter().for_each(|photon| recording.stored(photon));
            recording.events.extend(batch.trace.splats.iter().map(|splat| PathEvent::Splat {
                film_position: splat.film_position.to_array(),
                layer: layer_name(splat.layer),
                radiance: splat.radiance.to_rgb(),
            }));
        },
    );
    recording.into_inner().finish()
}

/// A recording that others write to as well.
struct Watched<'r>(&'r RefCell<PhotonRecording>);

impl Observer for Watched<'_> {
    fn started(&mut self, walk: &Walk<'_>, light: LightId) {
        self.0.borrow_mut().started(walk, light);
    }

    fn reached(&mut self, walk: &Walk<'_>, vertex: &Vertex) {
        self.0.borrow_mut().reached(walk, vertex);
    }

    fn ended(&mut self, end: PathEnd) {
        self.0.borrow_mut().ended(end);
    }
}

impl Batch {
    fn add(&mut self, scene: &Scene, plan: &Plan, path: u64, vertex: &LightVertex) {
        if vertex.depth >= plan.max_depth {
            return;
        }
        if !vertex.flux.is_finite() {
            let (kind, depth) = (PhotonKind::Global, vertex.depth);
            self.nonfinite.push(NonFinitePhoton { kind, path, depth });
            return;
        }
        if plan.connections == Connections::Made {
            self.project(scene, plan, vertex);
        }
        if plan.merging != Merging::Never && vertex.at.is_merged() {
            let LightVertex { at, flux, depth, class, light, .. } = *vertex;
            self.photons.push(Photon {
                position: at.vertex.hit.p,
                direction: at.vertex.wo,
                normal: at.vertex.facing_ng(),
                power: flux * (1.0 / (plan.count as f32 * at.presence(scene))),
                depth: depth.min(255) as u8,
                flags: PhotonFlags::NONE,
            });
            self.trace.paths.push(PhotonPath { mis: at.mis, light, depth: depth.min(65535) as u16, class });
        }
    }

    fn project(&mut self, scene: &Scene, plan: &Plan, vertex: &LightVertex) {
        let Some((projection, lens)) = project(scene, vertex) else { return };
        let radius = plan.radius.at(projection.footprint);
        let weight = match plan.techniques {
            VcmTechniques::LightTracing => 1.0,
            _ => projection.weight(plan.eta(radius), plan.film_density),
        };
        let radiance = projection.radiance * (weight / plan.count as f32);
        if radiance.is_zero() || !is_seen(scene, &vertex.at.vertex, lens) {
            return;
        }
        let specular = !vertex.at.vertex.bsdf.has_diffuse();
        let layer = vertex.class.after(PathClass::default().scattered(specular)).layer();
        let film_position = projection.film_position;
        self.trace.splats.push(Splat { film_position, radiance, layer, light: vertex.light });
        self.trace.radii.push(radius);
    }
}

pub(super) fn build(traced: TracedPhotons) -> Maps {
    let LightTrace { paths, splats, .. } = traced.light_trace;
    let (map, order) = PhotonMap::build_ordered(traced.global);
    let by_slot = par::map_chunks(order.len(), CHUNK * 16, |slots| {
        order[slots].iter().map(|&index| paths[index as usize]).collect::<Vec<_>>()
    });
    let light_side = LightSide { paths: by_slot.concat(), splats };
    let merging = StoredMap { map, typical_radius: traced.typical_radius, max_radius: None };
    Maps { merging: Some(merging), light_side, ..Maps::default() }
}
