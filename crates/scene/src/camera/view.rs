//! What cameras with a flat picture share: where they stand, and a rectangle of film before them.

use math::{Frame, Vec2, Vec3};

use super::CameraError;

/// The side of the picture that a field of view or extent spans.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Its height.
    Height,
    /// Its width.
    Width,
    /// The smaller of the two.
    Smaller,
}

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
    /// Half of what the side spans at distance 1.
    pub(super) fn half(self) -> Result<(Side, f32), CameraError> {
        let (side, degrees) = match self {
            Self::Vertical(degrees) => (Side::Height, degrees),
            Self::Horizontal(degrees) => (Side::Width, degrees),
            Self::Smaller(degrees) => (Side::Smaller, degrees),
        };
        if !(degrees > 0.0 && degrees < 180.0) {
            return Err(CameraError::BadFov);
        }
        Ok((side, (0.5 * f64::from(degrees)).to_radians().tan() as f32))
    }
}

/// Where a camera stands and what it sees in how many pixels. Its picture is a rectangle across the line of sight: at
/// distance 1 for cameras in perspective, in scene units for parallel rays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    pub(super) position: Vec3,
    /// x: right, y: up, z: backward.
    pub(super) frame: Frame,
    pub(super) resolution: [u32; 2],
    /// A side of the rectangle, and half its length.
    side: (Side, f32),
    /// Shares of width and height by which the rectangle's middle lies to the right of and above the line of sight.
    shift: Vec2,
    /// The rectangle's left and upper border, and a pixel's width and height.
    corner: Vec2,
    pixel: Vec2,
    pub(super) pixel_side: f32,
}

/// The frame of a camera: x to the right, y up, z backward.
pub(super) fn frame(position: Vec3, look_at: Vec3, up: Vec3) -> Result<Frame, CameraError> {
    if !(position.is_finite() && look_at.is_finite() && up.is_finite()) {
        return Err(CameraError::NotFinite);
    }
    let back = (position - look_at).try_normalize().ok_or(CameraError::NoDirection)?;
    let up = up.try_normalize().ok_or(CameraError::BadUp)?;
    let right = up.cross(back);
    if right.length() < 1e-5 {
        return Err(CameraError::BadUp);
    }
    let right = right.normalize();
    Ok(Frame { x: right, y: back.cross(right), z: back })
}

impl View {
    pub(super) fn new(
        position: Vec3,
        frame: Frame,
        side: (Side, f32),
        resolution: [u32; 2],
    ) -> Result<Self, CameraError> {
        let zero = Vec2::ZERO;
        let mut view = Self {
            position,
            frame,
            resolution,
            side,
            shift: zero,
            corner: zero,
            pixel: zero,
            pixel_side: 0.0,
        };
        view.fit(resolution)?;
        Ok(view)
    }

    fn size(&self) -> Vec2 {
        Vec2::new(self.resolution[0] as f32, self.resolution[1] as f32)
    }

    /// A pixel's area on the rectangle.
    pub(super) fn pixel_area(&self) -> f32 {
        self.pixel.x * self.pixel.y
    }

    /// Fills the rectangle with so many pixels.
    pub(super) fn fit(&mut self, resolution: [u32; 2]) -> Result<(), CameraError> {
        if resolution.contains(&0) {
            return Err(CameraError::NoPixels);
        }
        self.resolution = resolution;
        let [width, height] = resolution.map(|n| n as f32);
        let (side, half) = self.side;
        let by_height = match side {
            Side::Height => true,
            Side::Width => false,
            Side::Smaller => height <= width,
        };
        let half = if by_height {
            Vec2::new(half * width / height, half)
        } else {
            Vec2::new(half, half * height / width)
        };
        self.pixel = 2.0 * half / self.size();
        self.pixel_side = self.pixel_area().sqrt();
        self.corner = Vec2::new(2.0 * self.shift.x - 1.0, 2.0 * self.shift.y + 1.0) * half;
        Ok(())
    }

    /// Moves the rectangle by shares of its width to the right and of its height up.
    pub(super) fn shift(&mut self, shift: Vec2) -> Result<(), CameraError> {
        if !shift.is_finite() {
            return Err(CameraError::NotFinite);
        }
        self.shift = shift;
        self.fit(self.resolution)
    }

    /// The point of the rectangle, x to the right and y up from the line of sight.
    #[inline]
    pub(super) fn on_rectangle(&self, film_position: Vec2) -> Vec2 {
        let s = film_position * self.pixel;
        Vec2::new(self.corner.x + s.x, self.corner.y - s.y)
    }

    /// The inverse of [`Self::on_rectangle`], inside the picture.
    pub(super) fn film_position(&self, at: Vec2) -> Option<Vec2> {
        let f = Vec2::new(at.x - self.corner.x, self.corner.y - at.y) / self.pixel;
        self.holds(f).then_some(f)
    }

    pub(super) fn holds(&self, film_position: Vec2) -> bool {
        film_position.cmpge(Vec2::ZERO).all() && film_position.cmplt(self.size()).all()
    }
}
