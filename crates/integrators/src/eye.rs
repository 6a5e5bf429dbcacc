//! The eye pass of photon mapping (Jensen 2001, ch. 9). Every path from the camera to a light is counted once. With x
//! the first D surface that the eye meets (a surface that stores photons), light reaches x
//!
//! * straight from a light: light sampling and BSDF sampling together;
//! * from a light through S⁺: the caustic map;
//! * from another D surface, straight or through S⁺: gather rays into the global map, or with `final_gather = 0`
//!   the map of all that was scattered before, at x itself.

use bsdf::{BsdfKind, Lobes, TransportMode};
use color::Lanes;
use math::{FRAC_1_PI, ONE_MINUS_EPSILON};
use photons::Scratch;
use sampling::Sampler;
use scene::Scene;
use transport::{
    LightLayer, Lookup, PathClass, Vertex, Walk, direct, direct_against, emission_at, emission_escaped,
    merge, nearest_irradiance,
};

use crate::maps::StoredMap;
use crate::path::add_emission;
use crate::photon_map::global_lookup;
use crate::pixels::{CameraPath, Tracer};
use crate::sink::{Origin, Sink, Technique};
use crate::{Maps, PhotonMapSettings};

/// Delta vertices of an eye path at which reflection and refraction are both followed; afterwards one is drawn.
const SPLITS: u32 = 3;
/// Eye paths that carry less are ended by roulette.
const FAINT: f32 = 0.05;
/// Greatest radius of a caustic lookup, in widths of a pixel.
const CAUSTIC_PIXELS: f32 = 8.0;
/// Gather rays shorter than this many typical radii end in a second gather instead of a lookup: so near, the
/// estimate's blur would show (Christensen 1999).
const NEAR: f32 = 1.5;
/// Stored irradiance is that on the true surface; where the shading normal bends away from its normal by more than
/// acos of this, photons are looked up one by one.
const LEVEL_COSINE: f32 = 0.995;

pub(crate) struct Eye<'a> {
    pub scene: &'a Scene,
    pub settings: &'a PhotonMapSettings,
    pub max_depth: u32,
    pub maps: &'a Maps,
}

/// Gather rays for each shadow ray at the first D surface.
const GATHER_PER_SHADOW: u32 = 4;

/// The i-th of n points of Hammersley, shifted at random (Cranley & Patterson 1976).
fn shifted_hammersley(i: u32, n: u32, shift: [f32; 2]) -> [f32; 2] {
    let radical_inverse = i.reverse_bits() as f32 * (1.0 / 4_294_967_296.0);
    [(i as f32 / n as f32 + shift[0]).fract(), (radical_inverse + shift[1]).fract()]
}

fn add(sink: &mut impl Sink, layer: LightLayer, technique: Technique, radiance: Lanes) {
    sink.add(Origin { layer, technique, light: None }, radiance);
}

/// Light gathered at a D surface, times the throughput there.
#[derive(Default)]
struct Gathered {
    direct: Lanes,
    indirect: Lanes,
}

impl Tracer for Eye<'_> {
    fn trace<S: Sink>(&self, CameraPath { walk, mut sampler, .. }: CameraPath<'_>, sink: &mut S) {
        let mut scratch = Scratch::new();
        let mut branches = vec![(walk, SPLITS)];
        while let Some((walk, splits)) = branches.pop() {
            self.follow(walk, splits, &mut branches, &mut sampler, &mut scratch, sink);
        }
    }
}

impl Eye<'_> {
    /// One branch, up to where it ends or splits.
    fn follow<'s>(
        &self,
        mut walk: Walk<'s>,
        mut splits: u32,
        branches: &mut Vec<(Walk<'s>, u32)>,
        sampler: &mut Sampler,
        scratch: &mut Scratch,
        sink: &mut impl Sink,
    ) {
        loop {
            let Some(vertex) = walk.next_vertex() else {
                for e in emission_escaped(&walk) {
                    add_emission(sink, &walk, PathClass::default(), &e);
                }
                return;
            };
            sink.reached(&walk, &vertex);
            if walk.depth == 0 {
                sink.features(&vertex);
            }
            if let Some(e) = emission_at(&walk, &vertex) {
                add_emission(sink, &walk, PathClass::default(), &e);
            }
            if walk.depth >= self.max_depth {
                return;
            }
            let mut lobes = Lobes::ALL;
            if vertex.bsdf.has_diffuse() {
                self.shade(&walk, &vertex, sampler, scratch, sink);
                if !vertex.bsdf.lobes().contains(Lobes::SPECULAR) {
                    return;
                }
                lobes = Lobes::DELTA;
            } else if !vertex.bsdf.is_delta_only()
                && let Some(direct) = direct(self.scene, &vertex, sampler)
            {
                add(sink, LightLayer::Direct, Technique::Direct, walk.throughput * direct.radiance);
            }
            let delta = vertex.bsdf.delta_lobes(vertex.wo, TransportMode::Radiance);
            match delta {
                [Some(first), Some(second)] if splits > 0 => {
                    splits -= 1;
                    let mut other = walk;
                    other.follow_delta(&vertex, &second);
                    if other.roulette(other.survival() / FAINT, sampler) {
                        branches.push((other, splits));
                    }
                    walk.follow_delta(&vertex, &first);
                }
                [Some(only), None] => walk.follow_delta(&vertex, &only),
                _ => {
                    if walk.scatter_lobes(&vertex, lobes, sampler).is_none() {
                        return;
                    }
                }
            }
            if !walk.roulette(walk.survival() / FAINT, sampler) {
                return;
            }
        }
    }

    /// All light reflected at the first D surface, its delta lobes apart.
    fn shade(
        &self,
        walk: &Walk<'_>,
        vertex: &Vertex,
        sampler: &mut Sampler,
        scratch: &mut Scratch,
        sink: &mut impl Sink,
    ) {
        let beta = walk.throughput;
        add(sink, LightLayer::Direct, Technique::Direct, beta * self.direct(vertex, sampler));
        let caustic = self.caustic(vertex, scratch, sink);
        add(sink, LightLayer::Caustic, Technique::Merge, beta * caustic * self.settings.caustic_gain);
        let mut gathered = Gathered::default();
        self.gather(walk, vertex, self.settings.final_gather.max(1), 0, sampler, scratch, &mut gathered);
        if let (0, Some(global)) = (self.settings.final_gather, &self.maps.global) {
            let found = merge(&global.map, vertex, &global_lookup(self.settings, global), scratch);
            gathered.indirect += beta * found.radiance;
            sink.density(found.density());
        }
        add(sink, LightLayer::Direct, Technique::Emission, gathered.direct);
        add(sink, LightLayer::Indirect, Technique::Merge, gathered.indirect);
    }

    /// Light straight from the lights by light sampling: a shadow ray for every few gather rays.
    fn direct(&self, vertex: &Vertex, sampler: &mut Sampler) -> Lanes {
        let n = (self.settings.final_gather / GATHER_PER_SHADOW).max(1);
        let shift = sampler.next_2d();
        let mut sum = Lanes::ZERO;
        for i in 0..n {
            // Each light gets its share of the rays.
            let u_light = (i as f32 + sampler.next_1d()) / n as f32;
            let u_light = u_light.min(ONE_MINUS_EPSILON);
            if let Some(direct) =
                direct_against(self.scene, vertex, Lobes::NON_DELTA, u_light, shifted_hammersley(i, n, shift))
            {
                sum += direct.radiance;
            }
        }
        sum / n as f32
    }

    fn caustic(&self, vertex: &Vertex, scratch: &mut Scratch, sink: &mut impl Sink) -> Lanes {
        let Some(stored) = &self.maps.caustic else { return Lanes::ZERO };
        let found = merge(&stored.map, vertex, &self.caustic_lookup(stored, vertex), scratch);
        sink.density(found.density());
        found.radiance
    }

    fn caustic_lookup(&self, stored: &StoredMap, vertex: &Vertex) -> Lookup {
        let by_footprint = (CAUSTIC_PIXELS * vertex.footprint).max(2.0 * stored.typical_radius);
        Lookup {
            knn: self.settings.caustic_knn as usize,
            max_radius: stored.max_radius.unwrap_or(by_footprint),
            kernel: self.settings.caustic_kernel,
        }
    }

    /// `n` rays from a D surface: lights that they meet at once, with their weight against light sampling, and light
    /// from D surfaces at their ends. `level` counts gathers before this one.
    fn gather(
        &self,
        walk: &Walk<'_>,
        vertex: &Vertex,
        n: u32,
        level: u32,
        sampler: &mut Sampler,
        scratch: &mut Scratch,
        out: &mut Gathered,
    ) {
        let shift = sampler.next_2d();
        for i in 0..n {
            let u = shifted_hammersley(i, n, shift);
            let u_lobe = sampler.next_1d();
            let mut ray = *walk;
            ray.throughput = ray.throughput / n as f32;
            if ray.scatter_with(vertex, Lobes::NON_DELTA, u_lobe, u).is_some() {
                self.follow_gather_ray(ray, vertex, level, sampler, scratch, out);
            }
        }
    }

    fn follow_gather_ray(
        &self,
        mut ray: Walk<'_>,
        from: &Vertex,
        level: u32,
        sampler: &mut Sampler,
        scratch: &mut Scratch,
        out: &mut Gathered,
    ) {
        let start = ray.throughput.max();
        let mut straight = true;
        loop {
            let Some(y) = ray.next_vertex() else {
                if straight {
                    for e in emission_escaped(&ray) {
                        out.direct += ray.throughput * e.radiance * e.weight;
                    }
                }
                return;
            };
            if straight && let Some(e) = emission_at(&ray, &y) {
                out.direct += ray.throughput * e.radiance * e.weight;
            }
            if self.settings.final_gather == 0 || ray.depth >= self.max_depth {
                return;
            }
            let mut lobes = Lobes::ALL;
            if y.bsdf.has_diffuse() {
                self.light_at_end(&ray, &y, straight.then_some(from), level, sampler, scratch, out);
                if !y.bsdf.lobes().contains(Lobes::SPECULAR) {
                    return;
                }
                lobes = Lobes::DELTA;
            }
            straight = false;
            if ray.scatter_lobes(&y, lobes, sampler).is_none()
                || !ray.roulette(ray.survival() / start.max(f32::MIN_POSITIVE), sampler)
            {
                return;
            }
        }
    }

    /// Light that the D surface at the end of a gather ray reflects along it.
    fn light_at_end(
        &self,
        ray: &Walk<'_>,
        y: &Vertex,
        from: Option<&Vertex>,
        level: u32,
        sampler: &mut Sampler,
        scratch: &mut Scratch,
        out: &mut Gathered,
    ) {
        let Some(global) = &self.maps.global else { return };
        let near = from.is_some_and(|x| (x.hit.p - y.hit.p).length() < NEAR * global.typical_radius);
        if near && level == 0 {
            let mut second = Gathered::default();
            let (u_light, u) = (sampler.next_1d(), sampler.next_2d());
            if let Some(direct) = direct_against(self.scene, y, Lobes::NON_DELTA, u_light, u) {
                second.direct += ray.throughput * direct.radiance;
            }
            if let Some(caustic) = &self.maps.caustic {
                let found = merge(&caustic.map, y, &self.caustic_lookup(caustic, y), scratch);
                second.indirect += ray.throughput * found.radiance;
            }
            self.gather(ray, y, 1, level + 1, sampler, scratch, &mut second);
            out.indirect += second.direct + second.indirect;
            return;
        }
        let lookup = global_lookup(self.settings, global);
        if let BsdfKind::Diffuse { albedo } = *y.bsdf.kind()
            && y.bsdf.ns().dot(y.hit.ng).abs() > LEVEL_COSINE
            && let Some(samples) = &self.maps.irradiance
            && let Some(e) = nearest_irradiance(samples, y, global.typical_radius, scratch)
        {
            out.indirect += ray.throughput * albedo * e * FRAC_1_PI;
            return;
        }
        out.indirect += ray.throughput * merge(&global.map, y, &lookup, scratch).radiance;
    }
}
