//! Weights of one path that several techniques find: x a D surface on the eye path, S⁺ a chain of S events, L a light.
//!
//! * The eye path itself meets L, having left x by BSDF sampling ("emission").
//! * At the last vertex of the chain, where that is no delta lobe, L is sampled ("direct").
//! * A photon that comes from L through the chain lands near x ("merge"): its density counts n·π·r² times, with n
//!   photon paths and the radius r of x (Georgiev et al. 2012, eq. 7).
//!
//! With p⃗ the densities of eye walks and p⃖ those of light walks per steradian, cosines to the geometric normals, z the
//! chain and y on the light,
//!
//!   p_light/p_eye = p_L(y, ω)/cos θ_y · cos θ_x/p⃗_x · Π_z (cos θ_out/cos θ_in)·(p⃖_z/p⃗_z),
//!
//! the squared distances being the same from both sides. For a delta lobe p⃖ = p⃗. Roulette and the choice among delta
//! lobes are left out on both sides alike: weights need only be the same function of the path wherever it is found.
//! Balance heuristic (Veach 1997, eq. 9.8). [`EyeChain`] and [`LightChain`] are the same ratio, grown from either end.
//!
//! The n photons of a pass share the eye path up to x. Grittmann, Georgiev & Slusallek 2021 lower the weight of merging for
//! it where other techniques do not share that part. Here all do: x is the one vertex where such a path is merged, and
//! emission and direct go on from the same eye path. Their correction is 1.

use bsdf::TransportMode;
use math::Vec3;
use scene::light::{LeSample, LiSample, LightHit};
use scene::{LightId, Scene};

use crate::{Scattered, Vertex, Walk};

/// The chain on an eye path since its last D event.
#[derive(Clone, Copy, Debug, Default)]
pub struct EyeChain {
    /// n·π·r² at x; 0 where nothing is merged, as before the first D event.
    acceptance: f64,
    /// p_light/p_eye without the light's own factors.
    ratio: f64,
    /// S events.
    length: u32,
}

impl EyeChain {
    /// The chain behind a D event at `x`, which `walk` has just been scattered at, where merging accepts photons
    /// n·π·r² times their density.
    #[inline]
    pub fn start(walk: &Walk<'_>, x: &Vertex, scattered: &Scattered, acceptance: f64) -> Self {
        let cos = f64::from(x.hit.ng.dot(walk.ray.direction).abs());
        Self { acceptance, ratio: cos / f64::from(scattered.pdf_w), length: 0 }
    }

    /// One more S event at `z`, which `walk` has just been scattered at.
    #[inline]
    pub fn extend(&mut self, walk: &Walk<'_>, z: &Vertex, scattered: &Scattered) {
        self.length += 1;
        if self.acceptance == 0.0 {
            return;
        }
        let wi = walk.ray.direction;
        self.ratio *= cosines(z, wi);
        if scattered.lit {
            let back = f64::from(z.bsdf.pdf_w(wi, z.wo, TransportMode::Importance));
            self.ratio *= back / f64::from(scattered.pdf_w);
        }
    }

    /// Whether merging at x competes for a light that the walk meets now.
    #[inline]
    pub fn competes(&self) -> bool {
        self.length > 0 && self.acceptance > 0.0
    }

    /// Whether merging at x would compete for a light that is sampled at an S surface, met now.
    #[inline]
    pub fn would_compete(&self) -> bool {
        self.acceptance > 0.0
    }

    /// Density of merging over that of the eye path, for the light that the walk meets: at `hit`, or where it leaves
    /// the scene.
    pub fn merge_over_emission(&self, walk: &Walk<'_>, light: LightId, hit: Option<LightHit>) -> f64 {
        let w = -walk.ray.direction;
        let (start, cos) = match hit {
            Some(hit) => (hit, f64::from(hit.ng.dot(w).abs())),
            None => (LightHit { p: walk.ray.origin, ng: w, prim: 0 }, 1.0),
        };
        let emitted = emission_density(walk.scene(), light, &start, w);
        if cos > 0.0 { self.acceptance * self.ratio * emitted / cos } else { 0.0 }
    }

    /// Density of merging over that of the eye path with `li` sampled at `z`, the last vertex of the chain; `pmf`: the
    /// probability of the light.
    pub fn merge_over_direct(
        &self,
        scene: &Scene,
        z: &Vertex,
        light: LightId,
        pmf: f32,
        li: &LiSample,
    ) -> f64 {
        let w = -li.wi;
        let cos = f64::from(li.n.dot(w).abs());
        // What a steradian at z is at the light: an area of it, or for a point, whose sampling has no density, its
        // solid angle there.
        let at_light = match (li.distance.is_finite(), li.is_delta) {
            (false, _) => 1.0,
            (true, true) => 1.0 / squared(li.distance),
            (true, false) if cos > 0.0 => 1.0 / cos,
            (true, false) => 0.0,
        };
        let back = f64::from(z.bsdf.pdf_w(li.wi, z.wo, TransportMode::Importance));
        let start = scene.light(light).hit_of_li(li);
        let emitted = emission_density(scene, light, &start, w);
        self.acceptance * self.ratio * cosines(z, li.wi) * back * emitted * at_light
            / (f64::from(pmf) * f64::from(li.pdf_w))
    }
}

/// The start of a light path, as weights need it.
#[derive(Clone, Copy, Debug)]
pub struct LightStart {
    /// The light.
    pub light: LightId,
    /// Its probability.
    pub pmf: f32,
    /// Point, direction and their densities.
    pub le: LeSample,
}

/// The chain behind a photon, from its light.
#[derive(Clone, Copy, Debug)]
pub struct LightChain {
    start: LightStart,
    is_delta: bool,
    is_infinite: bool,
    /// p_eye/p_light of emission without p⃗_x; 0 where no eye path can meet the light.
    emission: f64,
    /// The same of light sampling; before the first S event without its density.
    direct: f64,
    /// Whether a shadow ray would see the light from the first vertex.
    clear: bool,
    /// S events.
    length: u32,
}

impl LightChain {
    /// Of a photon that has just been emitted.
    #[inline]
    pub fn new(scene: &Scene, start: LightStart) -> Self {
        let source = scene.light(start.light);
        let (is_delta, is_infinite) = (source.is_delta(), source.is_infinite());
        let le = &start.le;
        let density = f64::from(start.pmf) * f64::from(le.pdf_a) * f64::from(le.pdf_w);
        let emission = if is_delta { 0.0 } else { f64::from(le.cos) / density };
        let direct = if is_delta { 1.0 / density } else { emission };
        Self { start, is_delta, is_infinite, emission, direct, clear: true, length: 0 }
    }

    /// Where it came from.
    #[inline]
    pub(crate) fn light(&self) -> LightId {
        self.start.light
    }

    /// `walk` has just reached a vertex.
    #[inline]
    pub fn reach(&mut self, walk: &Walk<'_>) {
        if self.length == 0 {
            self.clear = walk.is_clear();
        }
    }

    /// One more S event at `z`, which `walk` has reached and has just been scattered at.
    #[inline]
    pub fn extend(&mut self, walk: &Walk<'_>, z: &Vertex, scattered: &Scattered) {
        let wi = walk.ray.direction;
        let turn = cosines(z, wi);
        let is_first = self.length == 0;
        self.length += 1;
        if !scattered.lit {
            self.emission *= turn;
            self.direct *= if is_first { 0.0 } else { turn };
            return;
        }
        let forward = f64::from(z.bsdf.pdf_w(wi, z.wo, TransportMode::Radiance));
        let pdf_w = f64::from(scattered.pdf_w);
        self.emission *= turn * forward / pdf_w;
        self.direct *= turn * if is_first { self.sampled(walk.scene(), z) } else { forward } / pdf_w;
    }

    /// Density of sampling the light at `z`, the first vertex: per steradian, or what stands for it.
    fn sampled(&self, scene: &Scene, z: &Vertex) -> f64 {
        if !self.clear {
            return 0.0;
        }
        let light = self.start.light;
        let pmf = f64::from(scene.direct_picker().expected(light.0 as usize, &z.receiver()));
        if self.is_delta {
            return if self.is_infinite { pmf } else { pmf * squared(z.hit.t) };
        }
        let le = &self.start.le;
        let hit = (!self.is_infinite).then(|| scene.light(light).hit_of_le(le));
        pmf * f64::from(scene.light(light).pdf_li_w(z.hit.p, z.wo, hit))
    }

    /// (p_emission + p_direct)/p_light for a photon that has landed at `x`, without p⃗_x. With that, the density with
    /// which eye paths leave x toward the photon, the weight of merging is 1/(1 + rivals·p⃗_x/(n·π·r²)).
    #[inline]
    pub fn rivals(&self, x: &Vertex) -> f32 {
        let cos = f64::from(x.hit.ng.dot(x.wo).abs()).max(f64::from(f32::MIN_POSITIVE));
        ((self.emission + self.direct) / cos).min(f64::from(f32::MAX)) as f32
    }
}

/// cos θ_out/cos θ_in at a vertex of a chain, out being where the walk goes on.
#[inline]
fn cosines(z: &Vertex, out: Vec3) -> f64 {
    let cos_in = f64::from(z.hit.ng.dot(z.wo).abs());
    f64::from(z.hit.ng.dot(out).abs()) / cos_in.max(f64::from(f32::MIN_POSITIVE))
}

/// Density of aimed emission from `start` along `w`, the probability of the light included.
fn emission_density(scene: &Scene, light: LightId, start: &LightHit, w: Vec3) -> f64 {
    let (pdf_a, pdf_w) = scene.light(light).pdf_le_toward(scene.targets(), start, w);
    f64::from(scene.caustic_picker().pmf(light.0 as usize)) * f64::from(pdf_a) * f64::from(pdf_w)
}

#[inline]
fn squared(distance: f32) -> f64 {
    f64::from(distance) * f64::from(distance)
}
