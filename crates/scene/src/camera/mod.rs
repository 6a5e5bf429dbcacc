//! Cameras: pinhole and thin lens in perspective, parallel rays, all directions from one point.
//!
//! Film positions are in pixels: x to the right, y down, pixel (i, j) covers [i, i+1) × [j, j+1), row 0 on top. The
//! measure on the film makes one pixel's area 1. Right-handed: the picture's right is forward × up, so that a
//! camera that looks along +z with +y up has +x on its left.

mod globe;
mod view;

use std::fmt;

use math::{PI, Ray, Vec2, Vec3};
use sampling::warp;
use scenefile::desc::SkyMapping;

pub use globe::Globe;
pub use view::{Fov, Side, View};

/// A thin lens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lens {
    /// Radius of the aperture, scene units; > 0.
    pub radius: f32,
    /// Distance, along the optical axis, of the plane in focus; > 0.
    pub focus_distance: f32,
}

/// What is wrong with a camera.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CameraError {
    /// A coordinate is not finite.
    NotFinite,
    /// `position` and `look_at` coincide.
    NoDirection,
    /// `up` is zero or parallel to the line of sight.
    BadUp,
    /// The field of view is not between 0° and 180°.
    BadFov,
    /// The extent is not positive and finite.
    BadExtent,
    /// The picture has no pixel.
    NoPixels,
    /// The radius or focus distance of the lens is not positive and finite.
    BadLens,
}

impl fmt::Display for CameraError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NotFinite => "a coordinate of the camera is not finite",
            Self::NoDirection => "the camera looks at its own position",
            Self::BadUp => "the camera's up vector is zero or parallel to its line of sight",
            Self::BadFov => "the field of view must lie between 0 and 180 degrees",
            Self::BadExtent => "the extent of the picture must be positive",
            Self::NoPixels => "the picture has no pixel",
            Self::BadLens => "lens radius and focus distance must be positive",
        })
    }
}

impl std::error::Error for CameraError {}

/// A camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Camera {
    /// Everything in focus.
    Pinhole(View),
    /// A circular aperture about the position; points at the focus distance are sharp.
    ThinLens(View, Lens),
    /// Parallel rays that start on a rectangle across the line of sight; what lies behind it is not seen.
    Orthographic(View),
    /// All directions from one point.
    Spherical(Globe),
}

/// The start of a camera path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraSample {
    /// From the pinhole, a point of the lens or of the rectangle of parallel rays; unit direction.
    pub ray: Ray,
    /// Weight of the radiance along the ray in its pixel: 1, since a pixel measures mean radiance.
    pub weight: f32,
    /// Growth of the pixel's footprint with distance, radians: square root of the pixel's solid angle; 0 for parallel rays.
    pub spread: f32,
    /// Width of the pixel's footprint where the ray starts: square root of the pixel's area for parallel rays, else 0, as
    /// all rays of a pixel through one lens point start together.
    pub width: f32,
}

/// Density of camera rays, in its own measure, where film positions are uniform with density 1 per pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WePdf {
    /// Of the directions from one point.
    PerSteradian(f64),
    /// Of parallel rays, per area across them.
    PerArea(f64),
}

impl WePdf {
    /// The same with that many rays a pixel.
    #[must_use]
    pub fn times(self, rays: f64) -> Self {
        match self {
            Self::PerSteradian(pdf) => Self::PerSteradian(pdf * rays),
            Self::PerArea(pdf) => Self::PerArea(pdf * rays),
        }
    }

    /// Density per area across the ray at a distance whose square this is.
    pub fn across(self, distance2: f64) -> f64 {
        match self {
            Self::PerSteradian(pdf) => pdf / distance2,
            Self::PerArea(pdf) => pdf,
        }
    }
}

/// A connection from a point of the scene to the camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WiSample {
    /// Unit direction from the point to the lens.
    pub wi: Vec3,
    /// Distance to the lens.
    pub distance: f32,
    /// Point of the lens; for parallel rays, where the ray starts.
    pub p: Vec3,
    /// Film position in pixels.
    pub film_position: Vec2,
    /// We·|cos|/(d²·pdf of the lens point per area), per pixel: the pixel at `film_position` receives
    /// `importance · f · |cos at the point| · flux`; nothing else is divided by.
    pub importance: f32,
    /// Density of `wi` per steradian at the point; 1 where the lens is a point or the rays are parallel.
    pub pdf_w: f32,
}

impl Camera {
    /// A camera at `position` that looks at `look_at`; without a lens a pinhole.
    pub fn perspective(
        position: Vec3,
        look_at: Vec3,
        up: Vec3,
        fov: Fov,
        resolution: [u32; 2],
        lens: Option<Lens>,
    ) -> Result<Self, CameraError> {
        let frame = view::frame(position, look_at, up)?;
        let view = View::new(position, frame, fov.half()?, resolution)?;
        match lens {
            None => Ok(Self::Pinhole(view)),
            Some(lens) => {
                let ok = |x: f32| x > 0.0 && x.is_finite();
                let valid = ok(lens.radius) && ok(lens.focus_distance);
                if valid { Ok(Self::ThinLens(view, lens)) } else { Err(CameraError::BadLens) }
            }
        }
    }

    /// Parallel rays toward where `look_at` lies from `position`, the middle of the rectangle where they start; `extent`: scene
    /// units over that side of the picture.
    pub fn orthographic(
        position: Vec3,
        look_at: Vec3,
        up: Vec3,
        side: Side,
        extent: f32,
        resolution: [u32; 2],
    ) -> Result<Self, CameraError> {
        let frame = view::frame(position, look_at, up)?;
        if !(extent > 0.0 && extent.is_finite()) {
            return Err(CameraError::BadExtent);
        }
        View::new(position, frame, (side, 0.5 * extent), resolution).map(Self::Orthographic)
    }

    /// All directions from `position`: what the mapping has at +z lies toward `look_at`, the picture's top toward `up`.
    pub fn spherical(
        position: Vec3,
        look_at: Vec3,
        up: Vec3,
        mapping: SkyMapping,
        resolution: [u32; 2],
    ) -> Result<Self, CameraError> {
        let frame = view::frame(position, look_at, up)?;
        Globe::new(position, frame, mapping, resolution).map(Self::Spherical)
    }

    /// The same with its picture moved by shares of its width to the right and of its height up; what is seen moves the other
    /// way. A camera that sees all directions stays as it is.
    pub fn shifted(mut self, shift: Vec2) -> Result<Self, CameraError> {
        match &mut self {
            Self::Pinhole(view) | Self::ThinLens(view, _) | Self::Orthographic(view) => view.shift(shift)?,
            Self::Spherical(_) => {}
        }
        Ok(self)
    }

    /// Pixels across and down.
    pub fn resolution(&self) -> [u32; 2] {
        match self {
            Self::Pinhole(view) | Self::ThinLens(view, _) | Self::Orthographic(view) => view.resolution,
            Self::Spherical(globe) => globe.resolution,
        }
    }

    /// The pinhole, the centre of the lens, or the point of the line of sight where parallel rays start.
    pub fn position(&self) -> Vec3 {
        match self {
            Self::Pinhole(view) | Self::ThinLens(view, _) | Self::Orthographic(view) => view.position,
            Self::Spherical(globe) => globe.position,
        }
    }

    /// Unit vector along the line of sight into the scene.
    pub fn forward(&self) -> Vec3 {
        match self {
            Self::Pinhole(view) | Self::ThinLens(view, _) | Self::Orthographic(view) => -view.frame.z,
            Self::Spherical(globe) => globe.forward,
        }
    }

    /// Whether its rays start at different places far from one another.
    pub fn is_parallel(&self) -> bool {
        matches!(self, Self::Orthographic(_))
    }

    /// Whether a film position lies in the picture.
    pub fn holds(&self, film_position: Vec2) -> bool {
        match self {
            Self::Pinhole(view) | Self::ThinLens(view, _) | Self::Orthographic(view) => {
                view.holds(film_position)
            }
            Self::Spherical(globe) => globe.holds(film_position),
        }
    }

    /// The same camera with another number of pixels; its [`Fov`] or extent then holds for the new aspect.
    pub fn with_resolution(mut self, resolution: [u32; 2]) -> Result<Self, CameraError> {
        match &mut self {
            Self::Pinhole(view) | Self::ThinLens(view, _) | Self::Orthographic(view) => {
                view.fit(resolution)?
            }
            Self::Spherical(globe) => *globe = globe.with_resolution(resolution)?,
        }
        Ok(self)
    }

    /// The ray of a film position through a point of the lens (`u_lens` uniform in [0, 1)²; unused by all but a lens). Film
    /// positions beyond the picture's border are taken as well; of a picture of all directions they are such as others stand
    /// for, too.
    #[inline]
    pub fn sample_we(&self, film_position: Vec2, u_lens: [f32; 2]) -> CameraSample {
        let (view, origin, direction) = match self {
            Self::Pinhole(view) => (view, Vec3::ZERO, view.on_rectangle(film_position).extend(-1.0)),
            Self::ThinLens(view, lens) => {
                let d = warp::disk(u_lens) * lens.radius;
                let origin = d.extend(0.0);
                let at_one = view.on_rectangle(film_position).extend(-1.0);
                (view, origin, at_one * lens.focus_distance - origin)
            }
            Self::Orthographic(view) => return parallel(view, film_position),
            Self::Spherical(globe) => return globe.sample_we(film_position),
        };
        let local = direction.normalize();
        let cos = local.z.abs();
        let spread = view.pixel_side * cos * cos.sqrt();
        let ray = Ray::new(view.position + view.frame.to_world(origin), view.frame.to_world(local));
        CameraSample { ray, weight: 1.0, spread, width: 0.0 }
    }

    /// Film position of the ray that leaves the lens (pinhole: the position) at `origin` along `direction` (any
    /// length; parallel rays: toward the scene); `None` behind the camera and outside the picture.
    pub fn film_position(&self, origin: Vec3, direction: Vec3) -> Option<Vec2> {
        let view = match self {
            Self::Pinhole(view) | Self::ThinLens(view, _) | Self::Orthographic(view) => view,
            Self::Spherical(globe) => return globe.film_position(direction),
        };
        let d = view.frame.to_local(direction);
        if d.z >= 0.0 {
            return None;
        }
        let o = || view.frame.to_local(origin - view.position);
        let at = match self {
            Self::ThinLens(_, lens) => (o() + d * (lens.focus_distance / -d.z)) / lens.focus_distance,
            Self::Orthographic(_) => o(),
            Self::Pinhole(_) | Self::Spherical(_) => d / -d.z,
        };
        view.film_position(at.truncate())
    }

    /// Density of the rays that film positions, uniform with density 1 per pixel, give: from a point, of directions,
    /// 1/(A·cos³θ), A = a pixel's area at distance 1; of parallel rays, per area across them. It integrates to the number
    /// of pixels. 0 for rays outside the picture. `direction` is of unit length and points into the scene.
    pub fn pdf_we(&self, origin: Vec3, direction: Vec3) -> WePdf {
        let seen = || self.film_position(origin, direction).is_some();
        match self {
            Self::Pinhole(view) | Self::ThinLens(view, _) => {
                let cos = self.forward().dot(direction);
                let pdf = 1.0 / (view.pixel_area() * cos.powi(3));
                WePdf::PerSteradian(if seen() { f64::from(pdf) } else { 0.0 })
            }
            Self::Orthographic(view) => {
                WePdf::PerArea(if seen() { 1.0 / f64::from(view.pixel_area()) } else { 0.0 })
            }
            Self::Spherical(globe) => globe.pdf_we(direction),
        }
    }

    /// A connection from `p` to a point of the lens; `None` behind the camera and outside the picture.
    pub fn sample_wi(&self, p: Vec3, u_lens: [f32; 2]) -> Option<WiSample> {
        let (view, lens_point) = match self {
            Self::Pinhole(view) => (view, view.position),
            Self::ThinLens(view, lens) => {
                let d = warp::disk(u_lens) * lens.radius;
                (view, view.position + view.frame.x * d.x + view.frame.y * d.y)
            }
            Self::Orthographic(view) => return parallel_wi(view, p),
            Self::Spherical(globe) => return globe.sample_wi(p),
        };
        let film_position = self.film_position(lens_point, p - lens_point)?;
        let d2 = p.distance_squared(lens_point);
        let distance = d2.sqrt();
        let wi = (lens_point - p) / distance;
        let cos = -wi.dot(self.forward());
        // We = 1/(A·cos⁴·A_lens) (Pharr, Jakob & Humphreys 2016, §16.1.1, per pixel); |cos|/d² and the density
        // 1/A_lens of the lens point leave:
        let importance = 1.0 / (view.pixel_area() * cos.powi(3) * d2);
        let pdf_w = match self {
            Self::ThinLens(_, lens) => d2 / (cos * PI * lens.radius * lens.radius),
            Self::Pinhole(_) | Self::Orthographic(_) | Self::Spherical(_) => 1.0,
        };
        let ok = importance.is_finite() && pdf_w.is_finite();
        ok.then_some(WiSample { wi, distance, p: lens_point, film_position, importance, pdf_w })
    }
}

#[inline(never)]
fn parallel(view: &View, film_position: Vec2) -> CameraSample {
    let origin = view.frame.to_world(view.on_rectangle(film_position).extend(0.0));
    let ray = Ray::new(view.position + origin, -view.frame.z);
    CameraSample { ray, weight: 1.0, spread: 0.0, width: view.pixel_side }
}

/// A pixel's mean radiance over its area A is ∫ f·dΦ·|cos|/A over the flux that falls on what it sees.
#[inline(never)]
fn parallel_wi(view: &View, p: Vec3) -> Option<WiSample> {
    let local = view.frame.to_local(p - view.position);
    let distance = -local.z;
    let film_position = view.film_position(local.truncate()).filter(|_| distance > 0.0)?;
    let wi = view.frame.z;
    let importance = 1.0 / view.pixel_area();
    Some(WiSample { wi, distance, p: p + wi * distance, film_position, importance, pdf_w: 1.0 })
}

#[cfg(test)]
mod tests;
