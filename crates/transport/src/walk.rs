use bsdf::{Bsdf, DeltaLobe, Lobes, TransportMode};
use color::Lanes;
use math::{Ray, Vec3};
use sampling::Sampler;
use scene::light::Receiver;
use scene::{Boundary, MaterialId, Medium, MediumStack, Scene, SurfaceInteraction};

/// Scattering events after which every walk may end.
pub const ENDLESS_DEPTH: u32 = 64;
/// Chance to survive each event from then on.
const ENDLESS_SURVIVAL: f32 = 0.9;

/// A random walk through the scene, from the camera or from a light. The loop stays with the integrator:
///
/// ```text
/// while let Some(vertex) = walk.next_vertex() { …; if walk.scatter(&vertex, &mut sampler).is_none() { break } }
/// ```
///
/// Throughput is β: from the camera, radiance arriving along the ray times β is what the film receives; from a
/// light, β is the flux that the path carries, in W per lane.
#[derive(Clone, Copy, Debug)]
pub struct Walk<'s> {
    scene: &'s Scene,
    mode: TransportMode,
    /// The ray to be followed next; unit direction.
    pub ray: Ray,
    /// β.
    pub throughput: Lanes,
    /// Scattering events so far.
    pub depth: u32,
    media: MediumStack,
    /// Width of the ray's footprint at the last vertex, and its growth per length.
    footprint: f32,
    spread: f32,
    /// What of it textures are averaged over.
    texture_share: f32,
    /// Square of the relative index that β was scaled by at refractions: radiance is not lost there.
    eta_scale: f32,
    /// Where the last scattering happened and how, for weights of what the ray meets.
    pub(crate) last: Option<Scattered>,
    /// Whether no invisible boundary was passed since the last vertex.
    clear: bool,
    /// Whether all surfaces so far scatter by delta lobes alone.
    delta_only: bool,
    /// Length of the walk up to the last vertex.
    length: f32,
}

/// A point that a walk reached.
#[derive(Clone, Copy, Debug)]
pub struct Vertex {
    /// The surface.
    pub hit: SurfaceInteraction,
    /// Its scattering function.
    pub bsdf: Bsdf,
    /// Toward where the walk came from.
    pub wo: Vec3,
    /// Width of the ray there, in units of length.
    pub footprint: f32,
    /// What fills the space on either side.
    pub sides: Sides,
}

/// The dielectrics on both sides of a vertex; known only where the scene has some that absorb.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sides {
    /// Where the walk came from.
    pub seen: Option<MaterialId>,
    /// Beyond the surface.
    pub beyond: Option<MaterialId>,
}

impl Vertex {
    /// The geometric normal on the side that the walk came from.
    #[inline]
    pub fn facing_ng(&self) -> Vec3 {
        if self.wo.dot(self.hit.ng) < 0.0 { -self.hit.ng } else { self.hit.ng }
    }

    /// How light sampling sees it.
    #[inline]
    pub fn receiver(&self) -> Receiver {
        let both = self.bsdf.lobes().contains(Lobes::TRANSMISSION);
        Receiver { p: self.hit.p, n: if both { Vec3::ZERO } else { self.facing_ng() } }
    }

    /// What is left, after `distance`, of light that leaves or arrives along `w` without meeting a surface.
    #[inline]
    pub fn transmittance(&self, scene: &Scene, w: Vec3, distance: f32) -> Lanes {
        if !scene.absorbs() {
            return Lanes::ONE;
        }
        let same = (w.dot(self.hit.ng) > 0.0) == (self.wo.dot(self.hit.ng) > 0.0);
        scene.transmittance(if same { self.sides.seen } else { self.sides.beyond }, distance)
    }
}

/// A scattering event.
#[derive(Clone, Copy, Debug)]
pub struct Scattered {
    /// The point from which the ray went on.
    pub from: Receiver,
    /// Density of the direction per steradian; of no meaning after a delta lobe.
    pub pdf_w: f32,
    /// Kind of the lobe that was drawn.
    pub lobes: Lobes,
    /// Whether light sampling could have found what the ray meets: the event had a non-delta part.
    pub lit: bool,
    /// Where transmitted, the index on the side that the ray goes to over that on the other; else 1.
    pub eta: f32,
}

impl<'s> Walk<'s> {
    /// A walk that starts at the camera (`Radiance`) or at a light (`Importance`).
    #[inline]
    pub fn new(
        scene: &'s Scene,
        mode: TransportMode,
        ray: Ray,
        throughput: Lanes,
        media: MediumStack,
    ) -> Self {
        Self {
            scene,
            mode,
            ray,
            throughput,
            depth: 0,
            media,
            footprint: 0.0,
            spread: 0.0,
            texture_share: 1.0,
            eta_scale: 1.0,
            last: None,
            clear: true,
            delta_only: true,
            length: 0.0,
        }
    }

    /// Starts the footprint: its width at the start and growth per unit of length.
    #[inline]
    pub fn with_footprint(mut self, width: f32, spread: f32) -> Self {
        self.footprint = width;
        self.spread = spread;
        self
    }

    /// Averages textures over a part of the footprint's width, from 0 to 1.
    #[inline]
    pub fn with_texture_share(mut self, share: f32) -> Self {
        self.texture_share = share;
        self
    }

    /// The next surface that is one: boundaries between equal dielectrics are passed. `None`: the walk left the
    /// scene along `ray`.
    #[inline]
    pub fn next_vertex(&mut self) -> Option<Vertex> {
        // A bound only against geometry that is degenerate: each round passes one invisible boundary.
        for _ in 0..4096 {
            let Some(hit) = self.scene.intersect(&self.ray) else {
                if self.scene.absorbs() {
                    self.throughput *= left(self.scene, &{ self.media }, f32::INFINITY);
                }
                return None;
            };
            if self.scene.absorbs() {
                self.throughput *= left(self.scene, &{ self.media }, hit.t);
            }
            self.footprint += self.spread * hit.t;
            self.length += hit.t;
            let eta = match self.scene.boundary(&hit, &self.media, self.ray.direction) {
                None => 1.0,
                Some(Boundary::Interface { eta }) => eta,
                Some(Boundary::Invisible) => {
                    // A shadow ray would have stopped here.
                    self.clear = false;
                    if let Some(last) = &mut self.last {
                        last.lit = false;
                    }
                    self.cross(&hit);
                    self.ray = hit.spawn_ray(self.ray.direction);
                    continue;
                }
            };
            let wo = -self.ray.direction;
            let bsdf = self.scene.bsdf(&hit, wo, eta, self.footprint * self.texture_share);
            let sides = if self.scene.absorbs() {
                let medium = self.scene.medium(&hit);
                sides(&{ self.media }, medium, self.ray.direction.dot(hit.ng) < 0.0)
            } else {
                Sides::default()
            };
            return Some(Vertex { hit, bsdf, wo, footprint: self.footprint, sides });
        }
        None
    }

    /// Moves the medium stack through the boundary at `hit`.
    #[inline]
    fn cross(&mut self, hit: &SurfaceInteraction) {
        if let Some(medium) = self.scene.medium(hit) {
            let media = self.media;
            self.media = media.crossed(medium, self.ray.direction.dot(hit.ng) < 0.0);
        }
    }

    /// Continues in a direction drawn from the whole BSDF. `None`: nothing is scattered.
    #[inline]
    pub fn scatter(&mut self, vertex: &Vertex, sampler: &mut Sampler) -> Option<Scattered> {
        self.scatter_lobes(vertex, Lobes::ALL, sampler)
    }

    /// The same from some lobes only.
    #[inline]
    pub fn scatter_lobes(
        &mut self,
        vertex: &Vertex,
        lobes: Lobes,
        sampler: &mut Sampler,
    ) -> Option<Scattered> {
        let u_lobe = sampler.next_1d();
        let u = sampler.next_2d();
        self.scatter_with(vertex, lobes, u_lobe, u)
    }

    /// The same from given numbers.
    #[inline]
    pub fn scatter_with(
        &mut self,
        vertex: &Vertex,
        lobes: Lobes,
        u_lobe: f32,
        u: [f32; 2],
    ) -> Option<Scattered> {
        let sample = vertex.bsdf.sample_lobes(vertex.wo, lobes, u_lobe, u, self.mode)?;
        self.follow(vertex, sample.wi, sample.weight, sample.lobes, sample.eta);
        // A density is only of use where light sampling competes.
        let scattered = Scattered {
            from: vertex.receiver(),
            pdf_w: sample.pdf_w,
            lobes: sample.lobes,
            lit: !sample.lobes.contains(Lobes::SPECULAR),
            eta: sample.eta,
        };
        self.last = Some(scattered);
        (!self.throughput.is_zero()).then_some(scattered)
    }

    /// Continues along one delta lobe, without choosing: its weight is all of f·|cos|.
    pub fn follow_delta(&mut self, vertex: &Vertex, lobe: &DeltaLobe) {
        self.follow(vertex, lobe.wi, lobe.weight, lobe.lobes, lobe.eta);
        let (lobes, eta) = (lobe.lobes, lobe.eta);
        self.last = Some(Scattered { from: vertex.receiver(), pdf_w: 0.0, lobes, lit: false, eta });
    }

    #[inline]
    fn follow(&mut self, vertex: &Vertex, wi: Vec3, weight: Lanes, lobes: Lobes, eta: f32) {
        self.throughput *= weight;
        self.delta_only &= vertex.bsdf.is_delta_only();
        match self.mode {
            TransportMode::Importance => self.throughput *= vertex.bsdf.shading_correction(vertex.wo, wi),
            TransportMode::Radiance => self.eta_scale *= eta * eta,
        }
        if lobes.contains(Lobes::TRANSMISSION) {
            self.cross(&vertex.hit);
        }
        if !lobes.contains(Lobes::SPECULAR) {
            // A wide lobe: the cone that it opens is that of a texture seen once more, not of a pixel.
            self.spread = self.spread.max(0.05);
        }
        self.depth += 1;
        self.clear = true;
        self.ray = vertex.hit.spawn_ray(wi);
    }

    /// Russian roulette: survives with probability min(1, `survival`), which throughput is divided by. After
    /// [`ENDLESS_DEPTH`] events no walk is certain to survive: light can run round inside glass for ever.
    #[inline]
    pub fn roulette(&mut self, survival: f32, sampler: &mut Sampler) -> bool {
        let survival = if self.depth > ENDLESS_DEPTH { survival.min(ENDLESS_SURVIVAL) } else { survival };
        if survival >= 1.0 {
            return true;
        }
        if sampler.next_1d() >= survival {
            return false;
        }
        self.throughput = self.throughput / survival;
        true
    }

    /// Chance of survival that keeps throughput even: its greatest lane, without the scaling at refractions.
    #[inline]
    pub fn survival(&self) -> f32 {
        self.throughput.max() * self.eta_scale
    }

    /// Whether `vertex` is the first surface of the walk that has more than delta lobes: what mirrors and clear glass
    /// before it show.
    #[inline]
    pub fn shows(&self, vertex: &Vertex) -> bool {
        self.delta_only && !vertex.bsdf.is_delta_only()
    }

    /// What the walk so far leaves of light, without the scaling at refractions; what went on without loss is about 1.
    #[inline]
    pub fn tint(&self) -> Lanes {
        self.throughput * self.eta_scale
    }

    /// Length of the walk up to its last vertex.
    #[inline]
    pub fn length(&self) -> f32 {
        self.length
    }

    /// The scene walked through.
    #[inline]
    pub fn scene(&self) -> &'s Scene {
        self.scene
    }

    /// Which way it goes.
    #[inline]
    pub(crate) fn mode(&self) -> TransportMode {
        self.mode
    }

    /// Whether a shadow ray would see along the last edge of the walk what the walk has met at its end.
    #[inline]
    pub fn is_clear(&self) -> bool {
        self.clear
    }

    /// The last scattering event; `None` before the first.
    #[inline]
    pub fn last(&self) -> Option<&Scattered> {
        self.last.as_ref()
    }
}

/// What the dielectric that rules in `media` leaves of light after `distance`. Out of the way, and given a copy, so that a
/// walk need not lie in memory.
#[inline(never)]
fn left(scene: &Scene, media: &MediumStack, distance: f32) -> Lanes {
    scene.transmittance(media.current().map(|m| m.material), distance)
}

/// What fills both sides of a surface that bounds `medium`, for a ray in `media` that would enter it or leave.
#[inline(never)]
fn sides(media: &MediumStack, medium: Option<Medium>, entering: bool) -> Sides {
    let filling = |media: &MediumStack| media.current().map(|m| m.material);
    let beyond = medium.map_or(*media, |medium| media.crossed(medium, entering));
    Sides { seen: filling(media), beyond: filling(&beyond) }
}
