//! Lights: sampled toward a receiver (`li`), along emission (`le`) and along emission aimed at chosen targets.
//!
//! World space throughout; a light owns a copy of its geometry. One file per variant; [`Light`] is the only place
//! that tells them apart. Units: radiance W/(m²·sr), intensity W/sr, irradiance W/m², flux W (lane by lane).
//!
//! Photon flux: one of `n` photons carries `radiance·cos / (n·p_light·pdf_a·pdf_w)`. A sampler that returns `None` has
//! emitted a dark photon: it counts among the `n`, which keeps powers exact.

pub(crate) mod aim;
mod area;
mod cone;
mod direct_picker;
mod directional;
mod disk;
mod emission;
mod environment;
mod goniometric;
mod group;
mod pattern;
mod picker;
mod point;
mod profile;
mod projector;
mod shaped;
mod sky;
mod sphere;
mod spot;
mod sun;
mod sun_data;
mod tree;
mod triangles;

use color::Lanes;
use math::{Bounds3, Vec3};

use crate::target::Targets;
pub use area::{AreaEmission, Sides};
pub use direct_picker::{DirectPicker, Drawn};
pub use directional::DirectionalLight;
pub use disk::DiskLight;
use emission::{Emission, Origin};
pub use environment::EnvironmentLight;
pub use goniometric::GoniometricShape;
use pattern::Pattern;
pub use picker::LightPicker;
pub use point::PointLight;
pub use profile::ProfileShape;
pub use projector::SlideShape;
pub use shaped::{IntensityShape, ShapedLight};
pub use sky::SkyLight;
pub use sphere::SphereLight;
pub use spot::SpotLight;
pub use sun::{SunLight, sun_irradiance};
pub use triangles::TriangleLight;

/// A light.
#[derive(Clone, Debug)]
pub enum Light {
    /// A point that shines equally in all directions.
    Point(PointLight),
    /// A point that shines within a cone.
    Spot(SpotLight),
    /// A point that shines by direction: a measured luminaire, a picture.
    Shaped(Box<ShapedLight>),
    /// Parallel light from infinity.
    Directional(DirectionalLight),
    /// Equal radiance from everywhere at infinity.
    Environment(EnvironmentLight),
    /// A picture of the sky at infinity.
    Sky(Box<SkyLight>),
    /// A disc at infinity.
    Sun(SunLight),
    /// A sphere.
    Sphere(SphereLight),
    /// A flat disc.
    Disk(DiskLight),
    /// Triangles: quads and meshes.
    Triangles(TriangleLight),
}

/// Where light is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Receiver {
    /// Position.
    pub p: Vec3,
    /// Unit geometric normal on the side that light is received on; zero: on both, or in empty space.
    pub n: Vec3,
}

/// Light that would arrive at a receiver, were nothing in between.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LiSample {
    /// Unit direction from the receiver to the light.
    pub wi: Vec3,
    /// Distance to the light; infinite for lights at infinity.
    pub distance: f32,
    /// Radiance; for delta lights intensity/d² or irradiance. Used as `radiance·f·|cos|/pdf_w`.
    pub radiance: Lanes,
    /// Density per steradian at the receiver; 1 for delta lights.
    pub pdf_w: f32,
    /// Whether no other technique can find this light.
    pub is_delta: bool,
    /// Point on the light; for lights at infinity a point along `wi` outside the scene.
    pub p: Vec3,
    /// Half-size of the cube about `p` that holds the true point.
    pub p_error: f32,
    /// Unit normal of the light at `p` on the side of the receiver; zero where there is none.
    pub n: Vec3,
    /// Triangle index for [`Light::Triangles`], else 0.
    pub prim: u32,
}

/// The start of a light path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeSample {
    /// Start; for lights at infinity on a disc outside the scene.
    pub p: Vec3,
    /// Half-size of the cube about `p` that holds the true point.
    pub p_error: f32,
    /// Unit normal on the side of `w`; zero for point-like lights; `w` for lights at infinity.
    pub n: Vec3,
    /// Unit direction of flight.
    pub w: Vec3,
    /// Emitted radiance, or intensity (point, spot), or irradiance (directional).
    pub radiance: Lanes,
    /// Cosine between `n` and `w` at an area light; 1 for all others.
    pub cos: f32,
    /// Density of `p` per area; 1 where the position is delta. For lights at infinity per area of the disc.
    pub pdf_a: f32,
    /// Density of `w` per steradian; 1 where the direction is delta.
    pub pdf_w: f32,
    /// Triangle index for [`Light::Triangles`], else 0.
    pub prim: u32,
}

/// A point of an area light that a ray has found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightHit {
    /// Position.
    pub p: Vec3,
    /// Unit geometric normal of the front side (for a sphere: outward).
    pub ng: Vec3,
    /// Triangle index for [`Light::Triangles`], else 0.
    pub prim: u32,
}

impl Light {
    /// A direction from the receiver `p` to the light. `None`: no light comes from the drawn point.
    ///
    /// `_n` is the receiver's normal or zero; no variant shapes its density by it, so that [`Self::pdf_li_w`] needs
    /// none. `u_pick` chooses among triangles and cells of a texture; `u` the point or direction. Radiance is without what a
    /// texture makes of it: [`Scene::sample_li`](crate::Scene::sample_li) has that.
    #[inline]
    pub fn sample_li(&self, p: Vec3, _n: Vec3, u_pick: f32, u: [f32; 2]) -> Option<LiSample> {
        match self {
            Self::Triangles(l) => l.sample_li(p, u_pick, u),
            _ => self.sample_li_elsewhere(p, u_pick, u),
        }
    }

    /// [`Self::sample_li`] for all but triangles: out of the way of loops over paths.
    #[inline(never)]
    fn sample_li_elsewhere(&self, p: Vec3, u_pick: f32, u: [f32; 2]) -> Option<LiSample> {
        match self {
            Self::Point(l) => l.sample_li(p),
            Self::Spot(l) => l.sample_li(p),
            Self::Shaped(l) => l.sample_li(p),
            Self::Directional(l) => l.sample_li(p),
            Self::Environment(l) => l.sample_li(p, u),
            Self::Sky(l) => l.sample_li(p, u),
            Self::Sun(l) => l.sample_li(p, u),
            Self::Sphere(l) => l.sample_li(p, u_pick, u),
            Self::Disk(l) => l.sample_li(p, u_pick, u),
            Self::Triangles(l) => l.sample_li(p, u_pick, u),
        }
    }

    /// Density per steradian with which [`Self::sample_li`] gives `wi` at the receiver `p`; `hit` is where the ray
    /// meets this light (`None`: it escapes the scene). 0 for delta lights and where the light does not shine
    /// toward `p`.
    pub fn pdf_li_w(&self, p: Vec3, wi: Vec3, hit: Option<LightHit>) -> f32 {
        match (self, hit) {
            (Self::Environment(l), None) => l.pdf_li_w(),
            (Self::Sky(l), None) => l.pdf_w(wi),
            (Self::Sun(l), None) => l.pdf_w(wi),
            (Self::Sphere(l), Some(hit)) => l.pdf_li_w(p, wi, hit),
            (Self::Disk(l), Some(hit)) => l.pdf_li_w(p, wi, hit),
            (Self::Triangles(l), Some(hit)) => l.pdf_li_w(p, wi, hit),
            _ => 0.0,
        }
    }

    /// Radiance of an area light that leaves along `w` (unit) where the geometric normal of the front side is
    /// `ng`, without what a texture makes of it ([`Scene::emitted`](crate::Scene::emitted) has that). Zero for lights without
    /// a surface.
    pub fn emitted(&self, ng: Vec3, w: Vec3) -> Lanes {
        match self {
            Self::Sphere(l) => l.surface().emitted(ng, w),
            Self::Disk(l) => l.surface().emitted(ng, w),
            Self::Triangles(l) => l.surface().emitted(ng, w),
            Self::Point(_)
            | Self::Spot(_)
            | Self::Shaped(_)
            | Self::Directional(_)
            | Self::Environment(_)
            | Self::Sky(_)
            | Self::Sun(_) => Lanes::ZERO,
        }
    }

    /// Radiance seen by a ray that leaves the scene along `w`. Zero for all but environments.
    pub fn escaped(&self, w: Vec3) -> Lanes {
        match self {
            Self::Environment(l) => l.radiance(),
            Self::Sky(l) => l.radiance(w),
            Self::Sun(l) => l.radiance(w),
            _ => Lanes::ZERO,
        }
    }

    /// The start of a light path: cosine-weighted over area lights (uniform in area), uniform over the sphere for
    /// points, proportional to intensity for spots and (about) for shaped points, over the scene's bounding disc for lights at infinity.
    /// `None`: a dark photon.
    pub fn sample_le(&self, u_pick: f32, u_pos: [f32; 2], u_dir: [f32; 2]) -> Option<LeSample> {
        match self {
            Self::Directional(l) => l.sample_le(u_pos),
            Self::Environment(l) => l.sample_le(u_pos, u_dir),
            Self::Sky(l) => l.sample_le(u_pos, u_dir),
            Self::Sun(l) => l.sample_le(u_pos, u_dir),
            _ => {
                let origin = self.origin(u_pick, u_pos)?;
                let emission = self.emission(origin.ng)?;
                let (w, pdf_w) = emission.sample(u_dir)?;
                self.leave(&origin, &emission, w, pdf_w)
            }
        }
    }

    /// Densities (per area, per steradian) with which [`Self::sample_le`] starts at `p` along `w`; 1 where delta.
    /// Normal and triangle are those of an area light, else unused.
    pub fn pdf_le(&self, start: &LightHit, w: Vec3) -> (f32, f32) {
        let LightHit { p, ng, .. } = *start;
        match self {
            Self::Directional(l) => (l.pdf_le_a(p), 1.0),
            Self::Environment(l) => (l.pdf_le_a(p, w), l.pdf_li_w()),
            Self::Sky(l) => (l.pdf_le_a(p, w), l.pdf_w(-w)),
            Self::Sun(l) => (l.pdf_le_a(p, w), l.pdf_w(-w)),
            _ => (self.origin_pdf_a(start), self.emission(ng).map_or(0.0, |e| e.pdf_w(w))),
        }
    }

    /// The start of a light path aimed at `targets`: position as in [`Self::sample_le`], direction from a mixture
    /// of the cones that the targets' spheres subtend; for lights at infinity the position comes from a mixture of
    /// the spheres' shadows. The densities returned are those of the whole mixtures. `None`: a dark photon; it was
    /// drawn below the horizon or misses the boxes of all targets.
    pub fn sample_le_toward(
        &self,
        targets: &Targets,
        u_pick: f32,
        u_pos: [f32; 2],
        u_dir: [f32; 2],
    ) -> Option<LeSample> {
        match self {
            Self::Directional(l) => l.sample_le_toward(targets, u_pick, u_pos),
            Self::Environment(l) => l.sample_le_toward(targets, u_pick, u_pos, u_dir),
            Self::Sky(l) => l.sample_le_toward(targets, u_pick, u_pos, u_dir),
            Self::Sun(l) => l.sample_le_toward(targets, u_pick, u_pos, u_dir),
            _ => {
                let origin = self.origin(u_pick, u_pos)?;
                let emission = self.emission(origin.ng)?;
                let (w, pdf_w) = aim::sample(targets, origin.p, &emission, u_dir)?;
                self.leave(&origin, &emission, w, pdf_w)
            }
        }
    }

    /// Densities with which [`Self::sample_le_toward`] starts at `p` along `w`, as in [`Self::pdf_le`].
    pub fn pdf_le_toward(&self, targets: &Targets, start: &LightHit, w: Vec3) -> (f32, f32) {
        let LightHit { p, ng, .. } = *start;
        match self {
            Self::Directional(l) => (targets.shadow_pdf_a(p, l.direction(), None), 1.0),
            Self::Environment(l) => (targets.shadow_pdf_a(p, w, None), l.pdf_li_w()),
            Self::Sky(l) => (targets.shadow_pdf_a(p, w, None), l.pdf_w(-w)),
            Self::Sun(l) => (targets.shadow_pdf_a(p, w, None), l.pdf_w(-w)),
            _ => {
                let pdf_w = self.emission(ng).map_or(0.0, |e| aim::pdf_w(targets, p, &e, w));
                (self.origin_pdf_a(start), pdf_w)
            }
        }
    }

    /// The greatest radiant intensity of a light at a point, W/sr; none of others.
    pub fn greatest_intensity(&self) -> Option<Lanes> {
        match self {
            Self::Point(l) => Some(l.intensity()),
            Self::Spot(l) => Some(l.power() * (1.0 / l.solid_angle() as f32)),
            Self::Shaped(l) => Some(l.power() * (1.0 / l.solid_angle())),
            Self::Directional(_)
            | Self::Environment(_)
            | Self::Sky(_)
            | Self::Sun(_)
            | Self::Sphere(_)
            | Self::Disk(_)
            | Self::Triangles(_) => None,
        }
    }

    /// Emitted flux; of lights at infinity the flux that enters the scene's bounding sphere (0 before
    /// [`Self::preprocess`]).
    pub fn power(&self) -> Lanes {
        match self {
            Self::Point(l) => l.power(),
            Self::Spot(l) => l.power(),
            Self::Shaped(l) => l.power(),
            Self::Directional(l) => l.power(),
            Self::Environment(l) => l.power(),
            Self::Sky(l) => l.power(),
            Self::Sun(l) => l.power(),
            Self::Sphere(l) => l.surface().power(l.area()) * self.mean_factor(),
            Self::Disk(l) => l.surface().power(l.area()) * self.mean_factor(),
            Self::Triangles(l) => l.surface().power(l.area()) * self.mean_factor(),
        }
    }

    /// The light with a factor on its radiance over the surface: of (point, triangle), averaged over about a width in units of
    /// length. Points are then drawn in proportion to the luminance of the factor; who asks for samples multiplies by it.
    /// `None`: it is black. Lights without a surface stay as they are.
    pub fn textured(self, factor: impl Fn(Vec3, u32, f32) -> Lanes) -> Option<Self> {
        match self {
            Self::Sphere(l) => l.textured(factor).map(Self::Sphere),
            Self::Disk(l) => l.textured(factor).map(Self::Disk),
            Self::Triangles(l) => l.textured(factor).map(Self::Triangles),
            _ => Some(self),
        }
    }

    /// Multiplies the radiance of an area light; others stay as they are.
    pub fn scale_radiance(&mut self, factor: f32) {
        match self {
            Self::Sphere(l) => l.surface_mut().radiance *= factor,
            Self::Disk(l) => l.surface_mut().radiance *= factor,
            Self::Triangles(l) => l.surface_mut().radiance *= factor,
            _ => {}
        }
    }

    /// Whether the radiance varies over its surface.
    #[inline]
    pub fn is_textured(&self) -> bool {
        self.pattern().is_some()
    }

    #[inline]
    fn pattern(&self) -> Option<&Pattern> {
        match self {
            Self::Sphere(l) => l.pattern(),
            Self::Disk(l) => l.pattern(),
            Self::Triangles(l) => l.pattern(),
            _ => None,
        }
    }

    /// Mean over the surface of what a texture makes of the radiance.
    fn mean_factor(&self) -> Lanes {
        self.pattern().map_or(Lanes::ONE, Pattern::mean)
    }

    /// About the radiance of a sample, a texture included: as bright as the density of points at it.
    fn radiance_about(&self, le: &LeSample) -> Lanes {
        let area = match self {
            Self::Sphere(l) => l.area(),
            Self::Disk(l) => l.area(),
            Self::Triangles(l) => l.area(),
            _ => return le.radiance,
        };
        if self.is_textured() { le.radiance * self.mean_factor() * (le.pdf_a * area) } else { le.radiance }
    }

    /// Whether light may fly straight to some target's sphere; `false` only where none can.
    pub fn may_reach(&self, targets: &Targets) -> bool {
        let any = |emission: Emission<'_>, x: Vec3| {
            targets.as_slice().iter().any(|t| emission.may_reach(t.center - x, t.radius))
        };
        match self {
            Self::Spot(l) => any(Emission::Spot(l), l.position()),
            Self::Shaped(l) => any(Emission::Shaped(l), l.position()),
            // A flat light sees the same height of a target from all its points.
            Self::Disk(l) => any(Emission::Lambert(l.surface(), l.normal()), l.center()),
            Self::Triangles(l) => l.faces().any(|(x, ng)| any(Emission::Lambert(l.surface(), ng), x)),
            Self::Point(_)
            | Self::Directional(_)
            | Self::Environment(_)
            | Self::Sky(_)
            | Self::Sun(_)
            | Self::Sphere(_) => !targets.is_empty(),
        }
    }

    /// Where a light path starts on a light that is not at infinity. The sample's normal lies on the side of its direction: of a
    /// light whose front does not shine there, that is the back.
    #[inline]
    pub fn hit_of_le(&self, le: &LeSample) -> LightHit {
        LightHit { p: le.p, ng: self.front(le.n, le.w), prim: le.prim }
    }

    /// The point of a light that is not at infinity from which light sampling found light.
    #[inline]
    pub fn hit_of_li(&self, li: &LiSample) -> LightHit {
        LightHit { p: li.p, ng: self.front(li.n, -li.wi), prim: li.prim }
    }

    /// The front's normal, from that on the side of `w`, along which the light shines.
    fn front(&self, n: Vec3, w: Vec3) -> Vec3 {
        if self.emitted(n, w).is_zero() { -n } else { n }
    }

    /// Whether only [`Self::sample_li`] can find it: no ray hits it.
    pub fn is_delta(&self) -> bool {
        matches!(self, Self::Point(_) | Self::Spot(_) | Self::Shaped(_) | Self::Directional(_))
    }

    /// Whether it lies at infinity.
    pub fn is_infinite(&self) -> bool {
        matches!(self, Self::Directional(_) | Self::Environment(_) | Self::Sky(_) | Self::Sun(_))
    }

    /// Bounds of its points; empty for lights at infinity.
    pub fn bounds(&self) -> Bounds3 {
        match self {
            Self::Point(l) => Bounds3::of_points([l.position()]),
            Self::Spot(l) => Bounds3::of_points([l.position()]),
            Self::Shaped(l) => Bounds3::of_points([l.position()]),
            Self::Directional(_) | Self::Environment(_) | Self::Sky(_) | Self::Sun(_) => Bounds3::EMPTY,
            Self::Sphere(l) => l.bounds(),
            Self::Disk(l) => l.bounds(),
            Self::Triangles(l) => l.bounds(),
        }
    }

    /// Tells lights at infinity how far the scene reaches; must be called before they are asked for samples or
    /// power.
    pub fn preprocess(&mut self, scene_bounds: Bounds3) {
        match self {
            Self::Directional(l) => l.preprocess(scene_bounds),
            Self::Environment(l) => l.preprocess(scene_bounds),
            Self::Sky(l) => l.preprocess(scene_bounds),
            Self::Sun(l) => l.preprocess(scene_bounds),
            _ => {}
        }
    }

    /// A point of a light that is not at infinity, uniform in area or by the pattern of its texture.
    fn origin(&self, u_pick: f32, u_pos: [f32; 2]) -> Option<Origin> {
        match self {
            Self::Point(l) => Some(Origin::at_point(l.position())),
            Self::Spot(l) => Some(Origin::at_point(l.position())),
            Self::Shaped(l) => Some(Origin::at_point(l.position())),
            Self::Directional(_) | Self::Environment(_) | Self::Sky(_) | Self::Sun(_) => None,
            Self::Sphere(l) => Some(l.origin(u_pick, u_pos)),
            Self::Disk(l) => Some(l.origin(u_pick, u_pos)),
            Self::Triangles(l) => Some(l.origin(u_pick, u_pos)),
        }
    }

    /// Density of [`Self::origin`] per area; 1 for points.
    fn origin_pdf_a(&self, at: &LightHit) -> f32 {
        match self {
            Self::Sphere(l) => l.pdf_a(at.p),
            Self::Disk(l) => l.pdf_a(at.p),
            Self::Triangles(l) => l.pdf_a(at.p, at.prim),
            _ => 1.0,
        }
    }

    /// How light leaves a point with front normal `ng`; `None` for lights at infinity.
    fn emission(&self, ng: Vec3) -> Option<Emission<'_>> {
        match self {
            Self::Point(l) => Some(Emission::Uniform(l.intensity())),
            Self::Spot(l) => Some(Emission::Spot(l)),
            Self::Shaped(l) => Some(Emission::Shaped(l)),
            Self::Directional(_) | Self::Environment(_) | Self::Sky(_) | Self::Sun(_) => None,
            Self::Sphere(l) => Some(Emission::Lambert(l.surface(), ng)),
            Self::Disk(l) => Some(Emission::Lambert(l.surface(), ng)),
            Self::Triangles(l) => Some(Emission::Lambert(l.surface(), ng)),
        }
    }

    fn leave(&self, origin: &Origin, emission: &Emission<'_>, w: Vec3, pdf_w: f32) -> Option<LeSample> {
        let (radiance, cos, n) = emission.along(w)?;
        (pdf_w > 0.0).then_some(LeSample {
            p: origin.p,
            p_error: origin.p_error,
            n,
            w,
            radiance,
            cos,
            pdf_a: origin.pdf_a,
            pdf_w,
            prim: origin.prim,
        })
    }
}

/// Whether all lanes are finite and none is negative.
fn is_emission(lanes: Lanes) -> bool {
    lanes.is_finite() && lanes.0.min_element() >= 0.0
}
