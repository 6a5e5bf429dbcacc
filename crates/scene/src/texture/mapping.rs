use math::{Vec2, Vec3};

use super::TexturePoint;

/// From a point of a surface to the coordinates of a texture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mapping {
    /// Linear in texture coordinates: rows · uv + offset.
    Uv {
        /// Which set of the mesh's coordinates.
        set: u8,
        /// Gradients of the mapped coordinates.
        rows: [Vec2; 2],
        /// Added.
        offset: Vec2,
    },
    /// Linear in the place in the world.
    Planar {
        /// Gradients of the mapped coordinates, per unit of length.
        rows: [Vec3; 2],
        /// Added.
        offset: Vec2,
    },
}

impl Default for Mapping {
    fn default() -> Self {
        Self::Uv { set: 0, rows: [Vec2::X, Vec2::Y], offset: Vec2::ZERO }
    }
}

impl Mapping {
    /// Texture coordinates scaled, then turned by `degrees` from u toward v, then moved.
    pub fn uv(set: u8, scale: Vec2, degrees: f32, offset: Vec2) -> Self {
        let (sin, cos) = match degrees {
            // Exact, so that what is not turned stays what it was.
            0.0 => (0.0, 1.0),
            _ => degrees.to_radians().sin_cos(),
        };
        let rows = [Vec2::new(cos, -sin) * scale, Vec2::new(sin, cos) * scale];
        Self::Uv { set, rows, offset }
    }

    /// The mapped point and the widths of the footprint in its coordinates.
    #[inline]
    pub fn apply(&self, at: &TexturePoint<'_>) -> (Vec2, Vec2) {
        match self {
            Self::Uv { set, rows, offset } => {
                let (uv, growth) = at.uv_set(*set);
                let mapped = Vec2::new(rows[0].dot(uv), rows[1].dot(uv)) + *offset;
                (mapped, Vec2::new(rows[0].length(), rows[1].length()) * (at.width * growth))
            }
            Self::Planar { rows, offset } => {
                let mapped = Vec2::new(rows[0].dot(at.p), rows[1].dot(at.p)) + *offset;
                (mapped, Vec2::new(rows[0].length(), rows[1].length()) * at.width)
            }
        }
    }

    /// The least distance on the surface that is `step` in one of the mapped coordinates; `None` where they do not grow.
    pub(super) fn length(&self, at: &TexturePoint<'_>, step: Vec2) -> Option<f32> {
        let growth = match self {
            Self::Uv { set, rows, .. } => Vec2::new(rows[0].length(), rows[1].length()) * at.uv_set(*set).1,
            Self::Planar { rows, .. } => Vec2::new(rows[0].length(), rows[1].length()),
        };
        let length = (step / growth).min_element();
        (length.is_finite() && length > 0.0).then_some(length)
    }

    /// The mapping that counts `factor` for each unit of this one.
    pub fn times(self, factor: f32) -> Self {
        match self {
            Self::Uv { set, rows, offset } => {
                Self::Uv { set, rows: rows.map(|r| r * factor), offset: offset * factor }
            }
            Self::Planar { rows, offset } => {
                Self::Planar { rows: rows.map(|r| r * factor), offset: offset * factor }
            }
        }
    }

    /// The directions on a surface of normal `n` in which the mapped coordinates grow; `tangents` gives those of the
    /// coordinates of a set. Zero where unknown, not of unit length.
    pub(crate) fn directions(&self, n: Vec3, tangents: impl Fn(u8) -> [Vec3; 2]) -> [Vec3; 2] {
        match self {
            Self::Uv { set, rows: [a, b], .. } => {
                let [du, dv] = tangents(*set);
                let det = a.x * b.y - a.y * b.x;
                if det == 0.0 {
                    return [du, dv];
                }
                // The columns of the inverse of the rows; only directions count.
                let sign = det.signum();
                [(du * b.y - dv * b.x) * sign, (dv * a.x - du * a.y) * sign]
            }
            Self::Planar { rows, .. } => rows.map(|row| row - n * n.dot(row)),
        }
    }
}
