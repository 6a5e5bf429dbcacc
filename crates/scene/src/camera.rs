//! Cameras: pinhole and thin lens, in perspective.
//!
//! Film positions are in pixels: x to the right, y down, pixel (i, j) covers [i, i+1) × [j, j+1), row 0 on top. The
//! measure on the film makes one pixel's area 1. Right-handed: the picture's right is forward × up, so that a
//! camera that looks along +z with +y up has +x on its left.

use std::fmt;

use math::{Frame, PI, Ray, Vec2, Vec3};
use sampling::warp;

/// Field of view in degrees, 0 < fov < 180.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fov {
    /// Over the picture's height.
    Vertical(f32),
    /// Over the picture's width.
    Horizontal(f32),
    /// Over the smaller of the two.
    Smaller(f32),
}

impl Fov {
    /// Half the width and height of the picture at distance 1.
    fn half_size(self, resolution: [u32; 2]) -> Vec2 {
        let (Self::Vertical(degrees) | Self::Horizontal(degrees) | Self::Smaller(degrees)) = self;
        let tangent = (0.5 * f64::from(degrees)).to_radians().tan() as f32;
        let [width, height] = resolution.map(|n| n as f32);
        let vertical = match self {
            Self::Vertical(_) => true,
            Self::Horizontal(_) => false,
            Self::Smaller(_) => height <= width,
        };
        if vertical {
            Vec2::new(tangent * width / height, tangent)
        } else {
            Vec2::new(tangent, tangent * height / width)
        }
    }
}

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
            Self::NoPixels => "the picture has no pixel",
            Self::BadLens => "lens radius and focus distance must be positive",
        })
    }
}

impl std::error::Error for CameraError {}

/// Where a camera stands, what it sees and in how many pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    position: Vec3,
    /// x: right, y: up, z: backward.
    frame: Frame,
    resolution: [u32; 2],
    fov: Fov,
    /// Half the picture's width and height at distance 1.
    half: Vec2,
    /// A pixel's width and height at distance 1, and the square root of their product.
    pixel: Vec2,
    pixel_side: f32,
}

/// A camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Camera {
    /// Everything in focus.
    Pinhole(View),
    /// A circular aperture about the position; points at the focus distance are sharp.
    ThinLens(View, Lens),
}

/// The start of a camera path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraSample {
    /// From the pinhole or a point of the lens; unit direction.
    pub ray: Ray,
    /// Weight of the radiance along the ray in its pixel: 1, since a pixel measures mean radiance.
    pub weight: f32,
    /// Growth of the pixel's footprint with distance, radians: square root of the pixel's solid angle.
    pub spread: f32,
    /// Width of the pixel's footprint where the ray starts: 0, as all rays of a pixel through one lens point start
    /// together.
    pub width: f32,
}

/// A connection from a point of the scene to the camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WiSample {
    /// Unit direction from the point to the lens.
    pub wi: Vec3,
    /// Distance to the lens.
    pub distance: f32,
    /// Point of the lens.
    pub p: Vec3,
    /// Film position in pixels.
    pub film_position: Vec2,
    /// We·|cos|/(d²·pdf of the lens point per area), per pixel: the pixel at `film_position` receives
    /// `importance · f · |cos at the point| · flux`; nothing else is divided by.
    pub importance: f32,
    /// Density of `wi` per steradian at the point; 1 for a pinhole.
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
        let view = View::new(position, look_at, up, fov, resolution)?;
        match lens {
            None => Ok(Self::Pinhole(view)),
            Some(lens) => {
                let ok = |x: f32| x > 0.0 && x.is_finite();
                let valid = ok(lens.radius) && ok(lens.focus_distance);
                if valid { Ok(Self::ThinLens(view, lens)) } else { Err(CameraError::BadLens) }
            }
        }
    }

    #[inline]
    fn view(&self) -> &View {
        match self {
            Self::Pinhole(view) | Self::ThinLens(view, _) => view,
        }
    }

    /// Pixels across and down.
    pub fn resolution(&self) -> [u32; 2] {
        self.view().resolution
    }

    /// The pinhole or the centre of the lens.
    pub fn position(&self) -> Vec3 {
        self.view().position
    }

    /// Unit vector along the optical axis into the scene.
    pub fn forward(&self) -> Vec3 {
        -self.view().frame.z
    }

    /// The same camera with another number of pixels; its [`Fov`] then holds for the new aspect.
    pub fn with_resolution(self, resolution: [u32; 2]) -> Result<Self, CameraError> {
        if resolution.contains(&0) {
            return Err(CameraError::NoPixels);
        }
        let mut view = *self.view();
        view.fit(resolution);
        Ok(match self {
            Self::Pinhole(_) => Self::Pinhole(view),
            Self::ThinLens(_, lens) => Self::ThinLens(view, lens),
        })
    }

    /// The ray of a film position through a point of the lens (`u_lens` uniform in [0, 1)²; unused by a pinhole).
    #[inline]
    pub fn sample_we(&self, film_position: Vec2, u_lens: [f32; 2]) -> CameraSample {
        let view = self.view();
        let at_one = view.at_one(film_position);
        let (origin, direction) = match self {
            Self::Pinhole(_) => (Vec3::ZERO, at_one),
            Self::ThinLens(_, lens) => {
                let d = warp::disk(u_lens) * lens.radius;
                let origin = d.extend(0.0);
                (origin, at_one * lens.focus_distance - origin)
            }
        };
        let local = direction.normalize();
        let cos = local.z.abs();
        let spread = view.pixel_side * cos * cos.sqrt();
        let ray = Ray::new(view.position + view.frame.to_world(origin), view.frame.to_world(local));
        CameraSample { ray, weight: 1.0, spread, width: 0.0 }
    }

    /// Film position of the ray that leaves the lens (pinhole: the position) at `origin` along `direction` (any
    /// length); `None` behind the camera and outside the picture.
    pub fn film_position(&self, origin: Vec3, direction: Vec3) -> Option<Vec2> {
        let view = self.view();
        let d = view.frame.to_local(direction);
        if d.z >= 0.0 {
            return None;
        }
        let at_one = match self {
            Self::Pinhole(_) => d / -d.z,
            Self::ThinLens(_, lens) => {
                let o = view.frame.to_local(origin - view.position);
                (o + d * (lens.focus_distance / -d.z)) / lens.focus_distance
            }
        };
        view.film_position(at_one)
    }

    /// Density per steradian of the directions that film positions, uniform with density 1 per pixel, give at a
    /// lens point: 1/(A·cos³θ), A = a pixel's area at distance 1. It integrates to the number of pixels. 0 for rays
    /// outside the picture. `direction` is of unit length and points into the scene.
    pub fn pdf_we_w(&self, origin: Vec3, direction: Vec3) -> f32 {
        let cos = self.forward().dot(direction);
        match self.film_position(origin, direction) {
            Some(_) => 1.0 / (self.view().pixel_area() * cos.powi(3)),
            None => 0.0,
        }
    }

    /// A connection from `p` to a point of the lens; `None` behind the camera and outside the picture.
    pub fn sample_wi(&self, p: Vec3, u_lens: [f32; 2]) -> Option<WiSample> {
        let view = self.view();
        let lens_point = match self {
            Self::Pinhole(_) => view.position,
            Self::ThinLens(_, lens) => {
                let d = warp::disk(u_lens) * lens.radius;
                view.position + view.frame.x * d.x + view.frame.y * d.y
            }
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
            Self::Pinhole(_) => 1.0,
            Self::ThinLens(_, lens) => d2 / (cos * PI * lens.radius * lens.radius),
        };
        let ok = importance.is_finite() && pdf_w.is_finite();
        ok.then_some(WiSample { wi, distance, p: lens_point, film_position, importance, pdf_w })
    }
}

impl View {
    fn new(
        position: Vec3,
        look_at: Vec3,
        up: Vec3,
        fov: Fov,
        resolution: [u32; 2],
    ) -> Result<Self, CameraError> {
        if !(position.is_finite() && look_at.is_finite() && up.is_finite()) {
            return Err(CameraError::NotFinite);
        }
        if resolution.contains(&0) {
            return Err(CameraError::NoPixels);
        }
        let back = (position - look_at).try_normalize().ok_or(CameraError::NoDirection)?;
        let up = up.try_normalize().ok_or(CameraError::BadUp)?;
        let right = up.cross(back);
        if right.length() < 1e-5 {
            return Err(CameraError::BadUp);
        }
        let right = right.normalize();
        let (Fov::Vertical(degrees) | Fov::Horizontal(degrees) | Fov::Smaller(degrees)) = fov;
        if !(degrees > 0.0 && degrees < 180.0) {
            return Err(CameraError::BadFov);
        }
        let frame = Frame { x: right, y: back.cross(right), z: back };
        let (half, pixel, pixel_side) = (Vec2::ZERO, Vec2::ZERO, 0.0);
        let mut view = Self { position, frame, resolution, fov, half, pixel, pixel_side };
        view.fit(resolution);
        Ok(view)
    }

    fn size(&self) -> Vec2 {
        Vec2::new(self.resolution[0] as f32, self.resolution[1] as f32)
    }

    /// A pixel's area on the plane at distance 1.
    fn pixel_area(&self) -> f32 {
        self.pixel.x * self.pixel.y
    }

    /// Fills the field of view with so many pixels.
    fn fit(&mut self, resolution: [u32; 2]) {
        self.resolution = resolution;
        self.half = self.fov.half_size(resolution);
        self.pixel = 2.0 * self.half / self.size();
        self.pixel_side = self.pixel_area().sqrt();
    }

    /// The point on the plane at distance 1, local.
    #[inline]
    fn at_one(&self, film_position: Vec2) -> Vec3 {
        let s = film_position * self.pixel - self.half;
        Vec3::new(s.x, -s.y, -1.0)
    }

    /// The inverse of [`Self::at_one`], inside the picture.
    fn film_position(&self, at_one: Vec3) -> Option<Vec2> {
        let s = Vec2::new(at_one.x / self.half.x, -at_one.y / self.half.y);
        let f = (s + Vec2::ONE) * 0.5 * self.size();
        (f.cmpge(Vec2::ZERO).all() && f.cmplt(self.size()).all()).then_some(f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sampling::{Domain, Sampler};

    fn arena() -> Camera {
        let position = Vec3::new(2.78, 2.73, -8.0);
        Camera::perspective(position, position + Vec3::Z, Vec3::Y, Fov::Smaller(39.307_648), [256, 256], None)
            .unwrap()
    }

    fn thin() -> Camera {
        let lens = Lens { radius: 0.2, focus_distance: 3.0 };
        Camera::perspective(Vec3::ONE, Vec3::ZERO, Vec3::Y, Fov::Vertical(50.0), [40, 20], Some(lens))
            .unwrap()
    }

    #[test]
    fn plus_x_is_left_for_a_camera_that_looks_along_plus_z() {
        let camera = arena();
        for (x, y, z) in [(2.78, 2.73, 3.0), (0.5, 4.0, 5.6), (4.9, 0.1, 0.2), (3.2, 5.0, 1.0)] {
            let k = (z + 8.0) * 12.5 / 35.0;
            let expected = Vec2::new(128.0 * (1.0 - (x - 2.78) / k), 128.0 * (1.0 - (y - 2.73) / k));
            let p = Vec3::new(x, y, z);
            let found = camera.film_position(camera.position(), p - camera.position()).unwrap();
            assert!(found.distance(expected) < 1e-3, "{found} {expected}");
            let connected = camera.sample_wi(p, [0.3, 0.6]).unwrap();
            assert!(connected.film_position.distance(expected) < 1e-3);
            let ray = camera.sample_we(expected, [0.3, 0.6]).ray;
            let t = p.distance(ray.origin);
            assert!(ray.at(t).distance(p) < 1e-4);
        }
        assert_eq!(camera.film_position(camera.position(), -Vec3::Z), None, "behind");
        assert_eq!(camera.film_position(camera.position(), Vec3::X + Vec3::Z), None, "outside");
    }

    #[test]
    fn rays_and_film_positions_are_inverse_and_focus_is_sharp() {
        let camera = thin();
        for i in 0..200 {
            let mut s = Sampler::new(1, 0, Domain::Other, i);
            let film = Vec2::new(s.next_1d() * 40.0, s.next_1d() * 20.0);
            let [a, b] = [camera.sample_we(film, s.next_2d()).ray, camera.sample_we(film, s.next_2d()).ray];
            let found = camera.film_position(a.origin, a.direction).unwrap();
            assert!(found.distance(film) < 1e-3, "{found} {film}");
            let in_focus = |r: Ray| r.at(3.0 / r.direction.dot(camera.forward()));
            assert!(in_focus(a).distance(in_focus(b)) < 1e-5);
            assert!((a.origin.distance(Vec3::ONE)) <= 0.2 + 1e-6);
        }
    }

    #[test]
    fn fields_of_view() {
        let edge = |fov, resolution: [u32; 2], film: Vec2| {
            let c = Camera::perspective(Vec3::ZERO, Vec3::Z, Vec3::Y, fov, resolution, None).unwrap();
            c.sample_we(film, [0.5; 2]).ray.direction.angle_between(Vec3::Z).to_degrees()
        };
        let close = |a: f32, b: f32| assert!((a - b).abs() < 1e-3, "{a} {b}");
        close(edge(Fov::Vertical(40.0), [80, 20], Vec2::new(40.0, 0.0)), 20.0);
        close(edge(Fov::Horizontal(40.0), [80, 20], Vec2::new(0.0, 10.0)), 20.0);
        close(edge(Fov::Smaller(40.0), [80, 20], Vec2::new(40.0, 0.0)), 20.0);
        close(edge(Fov::Smaller(40.0), [20, 80], Vec2::new(0.0, 40.0)), 20.0);
        let c = arena().with_resolution([512, 256]).unwrap();
        close(
            c.sample_we(Vec2::new(256.0, 0.0), [0.5; 2]).ray.direction.angle_between(Vec3::Z).to_degrees(),
            19.653_824,
        );
    }

    #[test]
    fn pdf_is_the_jacobian_of_film_to_directions() {
        // A pixel's solid angle, measured as the sum of the solid angles of a fine grid within it.
        for camera in [arena(), thin()] {
            let film = Vec2::new(3.0, 2.0);
            let u = [0.9, 0.2];
            let ray = |x: f32, y: f32| camera.sample_we(film + Vec2::new(x, y), u).ray;
            let c = ray(0.5, 0.5);
            let h = 0.05;
            let dx = (ray(0.5 + h, 0.5).direction - ray(0.5 - h, 0.5).direction) / (2.0 * h);
            let dy = (ray(0.5, 0.5 + h).direction - ray(0.5, 0.5 - h).direction) / (2.0 * h);
            let solid_angle = dx.cross(dy).length();
            let pdf = camera.pdf_we_w(c.origin, c.direction);
            assert!((solid_angle * pdf - 1.0).abs() < 2e-3, "{}", solid_angle * pdf);
            let spread = camera.sample_we(film + Vec2::splat(0.5), u).spread;
            assert!((spread * spread / solid_angle - 1.0).abs() < 2e-3);
        }
    }

    #[test]
    fn light_traced_to_the_film_is_the_radiance_that_rays_see() {
        // A uniformly radiant plane z = 0 (radiance 1): every pixel measures 1. Light points uniform over a region
        // larger than the view, connected to the camera: f·flux = L/p_area.
        let position = Vec3::new(0.3, -0.2, 2.0);
        let look = Vec3::new(0.0, 0.1, 0.0);
        let lens = Lens { radius: 0.1, focus_distance: 1.5 };
        for lens in [None, Some(lens)] {
            let camera =
                Camera::perspective(position, look, Vec3::Y, Fov::Vertical(30.0), [4, 3], lens).unwrap();
            let (n, half) = (200_000, 1.5f32);
            let (mut sum, mut sum2) = ([0f64; 12], [0f64; 12]);
            for i in 0..n {
                let mut s = Sampler::new(3, 0, Domain::Other, i);
                let p = Vec3::new((2.0 * s.next_1d() - 1.0) * half, (2.0 * s.next_1d() - 1.0) * half, 0.0);
                if let Some(c) = camera.sample_wi(p, s.next_2d()) {
                    let pixel = c.film_position.y as usize * 4 + c.film_position.x as usize;
                    let x = f64::from(c.importance * c.wi.z.abs() * 4.0 * half * half);
                    sum[pixel] += x;
                    sum2[pixel] += x * x;
                }
            }
            for (s, s2) in sum.iter().zip(sum2) {
                let (mean, n) = (s / n as f64, n as f64);
                let error = ((s2 / n - mean * mean) / n).sqrt();
                assert!((mean - 1.0).abs() < 4.0 * error && error < 0.02, "{mean} ± {error}");
            }
        }
    }

    #[test]
    fn mistakes_are_named() {
        let make = |at: Vec3, up: Vec3, fov: f32, resolution: [u32; 2], lens: Option<Lens>| {
            Camera::perspective(Vec3::ZERO, at, up, Fov::Vertical(fov), resolution, lens).err()
        };
        let size = [2, 2];
        assert_eq!(make(Vec3::NAN, Vec3::Y, 40.0, size, None), Some(CameraError::NotFinite));
        assert_eq!(make(Vec3::ZERO, Vec3::Y, 40.0, size, None), Some(CameraError::NoDirection));
        assert_eq!(make(Vec3::Y, Vec3::Y, 40.0, size, None), Some(CameraError::BadUp));
        assert_eq!(make(Vec3::Z, Vec3::Y, 180.0, size, None), Some(CameraError::BadFov));
        assert_eq!(make(Vec3::Z, Vec3::Y, f32::NAN, size, None), Some(CameraError::BadFov));
        assert_eq!(make(Vec3::Z, Vec3::Y, 40.0, [0, 2], None), Some(CameraError::NoPixels));
        let lens = Lens { radius: 0.0, focus_distance: 1.0 };
        assert_eq!(make(Vec3::Z, Vec3::Y, 40.0, size, Some(lens)), Some(CameraError::BadLens));
    }
}
