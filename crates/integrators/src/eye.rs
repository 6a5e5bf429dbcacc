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
use photons::{PhotonMap, Scratch};
use sampling::Sampler;
use scene::Scene;
use transport::{
    LightLayer, LightNumbers, Lookup, PathClass, PathEnd, Vertex, Walk, direct, direct_against, emission_at,
    emission_escaped, merge, merge_each, nearest_irradiance,
};

use crate::maps::StoredMap;
use crate::path::add_emission;
use crate::photon_map::global_lookup;
use crate::pixels::{CameraPath, Tracer};
use crate::sink::{Origin, Sink, Source, Sum, Technique};
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

/// The i-th of n sets of numbers for light sampling at one vertex.
struct Spread {
    i: u32,
    n: u32,
    u_choice: f32,
    shift: [f32; 2],
}

impl LightNumbers for Spread {
    fn choice(&mut self) -> f32 {
        // Each light gets its share of the rays.
        ((self.i as f32 + self.u_choice) / self.n as f32).min(ONE_MINUS_EPSILON)
    }

    fn point(&mut self, _nth: u32) -> [f32; 2] {
        shifted_hammersley(self.i, self.n, self.shift)
    }
}

/// Light gathered at a D surface, times the throughput there, and who watches.
struct Gathered<'s, S: Sink> {
    sink: &'s mut S,
    direct: S::Sum,
    indirect: S::Sum,
}

impl<'s, S: Sink> Gathered<'s, S> {
    fn new(sink: &'s mut S) -> Self {
        Self { sink, direct: S::Sum::default(), indirect: S::Sum::default() }
    }
}

/// Adds to a sum what a map's photons reflect at a vertex, times `throughput`; their number per unit of area.
fn add_merged(
    sum: &mut impl Sum,
    map: &PhotonMap,
    vertex: &Vertex,
    lookup: &Lookup,
    throughput: Lanes,
    scratch: &mut Scratch,
) -> f32 {
    let found = merge(map, vertex, lookup, scratch);
    sum.add_split(throughput * found.radiance, |part| {
        merge_each(map, vertex, lookup, scratch, |photon, radiance| {
            part(Source::of(photon), throughput * radiance);
        });
    });
    found.density()
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
                return sink.ended(PathEnd::Escaped);
            };
            sink.reached(&walk, &vertex);
            if walk.shows(&vertex) {
                sink.features(&walk, &vertex);
            }
            if let Some(e) = emission_at(&walk, &vertex) {
                add_emission(sink, &walk, PathClass::default(), &e);
            }
            if walk.depth >= self.max_depth {
                return sink.ended(PathEnd::Depth);
            }
            let mut lobes = Lobes::ALL;
            if vertex.bsdf.has_diffuse() {
                self.shade(&walk, &vertex, sampler, scratch, sink);
                if !vertex.bsdf.lobes().contains(Lobes::SPECULAR) {
                    return sink.ended(PathEnd::Complete);
                }
                lobes = Lobes::DELTA;
            } else {
                direct(self.scene, &vertex, sampler, |direct| {
                    let (layer, technique) = (LightLayer::Direct, Technique::Direct);
                    let origin = Origin { layer, technique, source: Source::Light(direct.light) };
                    sink.add(origin, walk.throughput * direct.radiance);
                });
            }
            // Where a lobe of finite width is left as well, one of them all is drawn.
            let delta = if lobes == Lobes::DELTA || vertex.bsdf.is_delta_only() {
                vertex.bsdf.delta_lobes(vertex.wo, TransportMode::Radiance)
            } else {
                [None; 2]
            };
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
                        return sink.ended(PathEnd::Absorbed);
                    }
                }
            }
            if !walk.roulette(walk.survival() / FAINT, sampler) {
                return sink.ended(PathEnd::Roulette);
            }
        }
    }

    /// All light reflected at the first D surface, its delta lobes apart.
    fn shade<S: Sink>(
        &self,
        walk: &Walk<'_>,
        vertex: &Vertex,
        sampler: &mut Sampler,
        scratch: &mut Scratch,
        sink: &mut S,
    ) {
        let beta = walk.throughput;
        let direct: S::Sum = self.direct(vertex, sampler);
        sink.add_sum(LightLayer::Direct, Technique::Direct, direct.map(|light| beta * light));
        let caustic = self.caustic(vertex, scratch, sink);
        let gain = self.settings.caustic_gain;
        sink.add_sum(LightLayer::Caustic, Technique::Merge, caustic.map(|light| beta * light * gain));
        let mut gathered = Gathered::new(&mut *sink);
        self.gather(walk, vertex, self.settings.final_gather.max(1), 0, sampler, scratch, &mut gathered);
        if let (0, Some(global)) = (self.settings.final_gather, &self.maps.global) {
            let lookup = global_lookup(self.settings, global);
            let density = add_merged(&mut gathered.indirect, &global.map, vertex, &lookup, beta, scratch);
            gathered.sink.density(density);
        }
        let Gathered { direct, indirect, .. } = gathered;
        sink.add_sum(LightLayer::Direct, Technique::Emission, direct);
        sink.add_sum(LightLayer::Indirect, Technique::Merge, indirect);
    }

    /// Light straight from the lights by light sampling: a shadow ray for every few gather rays.
    fn direct<T: Sum>(&self, vertex: &Vertex, sampler: &mut Sampler) -> T {
        let draws = self.scene.direct_picker().draws().max(1);
        let n = (self.settings.final_gather / (GATHER_PER_SHADOW * draws)).max(1);
        let shift = sampler.next_2d();
        let mut sum = T::default();
        for i in 0..n {
            let mut numbers = Spread { i, n, u_choice: sampler.next_1d(), shift };
            direct_against(self.scene, vertex, Lobes::NON_DELTA, &mut numbers, |direct| {
                sum.add(Source::Light(direct.light), direct.radiance);
            });
        }
        sum.map(|light| light / n as f32)
    }

    fn caustic<S: Sink>(&self, vertex: &Vertex, scratch: &mut Scratch, sink: &mut S) -> S::Sum {
        let mut sum = S::Sum::default();
        if let Some(stored) = &self.maps.caustic {
            let lookup = self.caustic_lookup(stored, vertex);
            sink.density(add_merged(&mut sum, &stored.map, vertex, &lookup, Lanes::ONE, scratch));
        }
        sum
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
    fn gather<S: Sink>(
        &self,
        walk: &Walk<'_>,
        vertex: &Vertex,
        n: u32,
        level: u32,
        sampler: &mut Sampler,
        scratch: &mut Scratch,
        out: &mut Gathered<'_, S>,
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

    fn follow_gather_ray<S: Sink>(
        &self,
        mut ray: Walk<'_>,
        from: &Vertex,
        level: u32,
        sampler: &mut Sampler,
        scratch: &mut Scratch,
        out: &mut Gathered<'_, S>,
    ) {
        let start = ray.throughput.max();
        let mut straight = true;
        loop {
            let Some(y) = ray.next_vertex() else {
                if straight {
                    for e in emission_escaped(&ray) {
                        out.direct.add(Source::Light(e.light), ray.throughput * e.radiance * e.weight);
                    }
                }
                return;
            };
            out.sink.reached(&ray, &y);
            if straight && let Some(e) = emission_at(&ray, &y) {
                out.direct.add(Source::Light(e.light), ray.throughput * e.radiance * e.weight);
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
    fn light_at_end<S: Sink>(
        &self,
        ray: &Walk<'_>,
        y: &Vertex,
        from: Option<&Vertex>,
        level: u32,
        sampler: &mut Sampler,
        scratch: &mut Scratch,
        out: &mut Gathered<'_, S>,
    ) {
        let Some(global) = &self.maps.global else { return };
        let near = from.is_some_and(|x| (x.hit.p - y.hit.p).length() < NEAR * global.typical_radius);
        if near && level == 0 {
            let mut second = Gathered::new(&mut *out.sink);
            direct_against(self.scene, y, Lobes::NON_DELTA, sampler, |direct| {
                second.direct.add(Source::Light(direct.light), ray.throughput * direct.radiance);
            });
            if let Some(caustic) = &self.maps.caustic {
                let lookup = self.caustic_lookup(caustic, y);
                add_merged(&mut second.indirect, &caustic.map, y, &lookup, ray.throughput, scratch);
            }
            self.gather(ray, y, 1, level + 1, sampler, scratch, &mut second);
            let Gathered { direct, indirect, .. } = second;
            out.indirect = std::mem::take(&mut out.indirect).plus(direct.plus(indirect));
            return;
        }
        let lookup = global_lookup(self.settings, global);
        if let BsdfKind::Diffuse { albedo } = *y.bsdf.kind()
            && y.bsdf.ns().dot(y.hit.ng).abs() > LEVEL_COSINE
            && let Some(samples) = &self.maps.irradiance
            && let Some(e) = nearest_irradiance(samples, y, global.typical_radius, scratch)
        {
            out.indirect.add(Source::Unknown, ray.throughput * albedo * e * FRAC_1_PI);
            return;
        }
        add_merged(&mut out.indirect, &global.map, y, &lookup, ray.throughput, scratch);
    }
}
