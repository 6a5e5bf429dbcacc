use math::{DVec2, DVec3};

use super::field::Field;
use crate::{MeshError, TriangleMesh};

/// Triangles of a field, at most.
const MOST_TRIANGLES: usize = 1 << 26;

/// Heights over a rectangle of the plane y = 0 about the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeightField<'a> {
    /// Sides along x and z, > 0.
    pub size: [f32; 2],
    /// Heights in a row, 2 or more.
    pub columns: usize,
    /// Rows from −z to +z, each from −x to +x; the outermost heights lie on the border.
    pub heights: &'a [f32],
    /// From y = 0 to the flat bottom of a closed body; `None` for an open sheet.
    pub depth: Option<f32>,
}

/// A sheet through all heights that faces +y, or a closed body below it. Normals are those of the paraboloid through
/// neighbouring heights (central differences). u goes along +x, v along −z.
///
/// # Errors
/// Where there are less than two rows of two heights or more than fit, one is not finite, or the surface reaches the bottom.
pub fn height_field(of: &HeightField<'_>) -> Result<TriangleMesh, MeshError> {
    let rows = of.heights.len().checked_div(of.columns).unwrap_or(0);
    if rows < 2 || of.columns < 2 || rows * of.columns != of.heights.len() {
        return Err(MeshError::whole("there are less than two rows of two heights", "give a larger field"));
    }
    if of.heights.len() > MOST_TRIANGLES / 2 {
        return Err(MeshError::whole(
            format!("{} × {rows} heights make more than {MOST_TRIANGLES} triangles", of.columns),
            "make the picture smaller",
        ));
    }
    if of.heights.iter().any(|h| !h.is_finite()) {
        return Err(MeshError::whole("a height is not finite", "mend it, or choose a smaller `height`"));
    }
    let size = DVec2::new(of.size[0].into(), of.size[1].into());
    let field = Field { size, cells: [of.columns as u32 - 1, rows as u32 - 1] };
    // Row j counts from +z.
    let height = |i: usize, j: usize| f64::from(of.heights[(rows - 1 - j) * of.columns + i]);
    let step = size / DVec2::new((of.columns - 1) as f64, (rows - 1) as f64);
    // One-sided on the border.
    let slope = |at: usize, count: usize, step: f64, height: &dyn Fn(usize) -> f64| {
        let (low, high) = (at.saturating_sub(1), (at + 1).min(count - 1));
        (height(high) - height(low)) / (step * (high - low) as f64)
    };
    let mut points = Vec::with_capacity(of.heights.len());
    for j in 0..rows {
        for i in 0..of.columns {
            let dx = slope(i, of.columns, step.x, &|i| height(i, j));
            let toward_back = slope(j, rows, step.y, &|j| height(i, j));
            points.push((height(i, j), DVec3::new(-dx, 1.0, toward_back)));
        }
    }
    let mesh = field.sheet(&points);
    match of.depth {
        Some(depth) => field.body(mesh, -depth),
        None => Ok(mesh),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use math::Vec3;

    fn of(heights: &[f32], columns: usize, depth: Option<f32>) -> Result<TriangleMesh, MeshError> {
        height_field(&HeightField { size: [2.0, 4.0], columns, heights, depth })
    }

    #[test]
    fn a_slope_is_where_it_is_put() {
        // Height grows by 1 toward +x and by 2 toward −z.
        let heights = [2.0, 2.5, 3.0, 1.0, 1.5, 2.0, 0.0, 0.5, 1.0];
        let mesh = of(&heights, 3, None).unwrap();
        mesh.validate().unwrap();
        assert_eq!((mesh.positions.len(), mesh.indices.len()), (9, 8));
        let wanted = Vec3::new(-0.5, 1.0, 0.5).normalize();
        for (p, n) in mesh.positions.iter().zip(&mesh.normals) {
            assert!((p.y - (0.5 * (p.x + 1.0) - 0.5 * (p.z - 2.0))).abs() < 1e-6, "{p}");
            assert!(n.distance(wanted) < 1e-6, "{n}");
        }
        for i in 0..8 {
            let [a, b, c] = mesh.corners(i);
            assert!((b - a).cross(c - a).normalize().distance(wanted) < 1e-6);
        }
    }

    #[test]
    fn bodies_are_closed_and_have_their_volume() {
        let body = of(&[0.0, 1.0, 0.0, 0.0, 1.0, 0.0], 3, Some(0.5)).unwrap();
        assert!(body.is_closed());
        assert!((body.signed_volume() - 8.0 * 0.5 - 8.0 * 0.5).abs() < 1e-5, "{}", body.signed_volume());
        assert!(of(&[0.0, -0.5, 0.0, 0.0], 2, Some(0.5)).is_err());
    }

    #[test]
    fn what_is_no_field_is_refused() {
        for (heights, columns) in [(&[][..], 0), (&[1.0, 2.0], 2), (&[1.0; 5], 2), (&[1.0; 4], 1)] {
            assert!(of(heights, columns, None).is_err(), "{heights:?}");
        }
        for x in [f32::NAN, f32::INFINITY] {
            assert!(of(&[0.0, x, 0.0, 0.0], 2, None).is_err());
        }
    }
}
