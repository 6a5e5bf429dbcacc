//! 4×4 matrices in double precision, as scene formats give placements.

use scenefile::desc::{TransformStep, TransformSteps, Triple};

/// Rows of an affine map of column vectors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Matrix(pub [[f64; 4]; 4]);

impl Matrix {
    pub(crate) const IDENTITY: Self = Self::scale([1.0; 3]);

    /// From sixteen numbers, column by column.
    pub(crate) fn columns(m: &[f64]) -> Self {
        Self(std::array::from_fn(|r| std::array::from_fn(|c| m.get(4 * c + r).copied().unwrap_or(0.0))))
    }

    /// A linear map by its rows.
    pub(crate) const fn rows([x, y, z]: [[f64; 3]; 3]) -> Self {
        let mut m = Self::IDENTITY;
        (m.0[0][0], m.0[0][1], m.0[0][2]) = (x[0], x[1], x[2]);
        (m.0[1][0], m.0[1][1], m.0[1][2]) = (y[0], y[1], y[2]);
        (m.0[2][0], m.0[2][1], m.0[2][2]) = (z[0], z[1], z[2]);
        m
    }

    pub(crate) const fn scale([x, y, z]: [f64; 3]) -> Self {
        Self([[x, 0.0, 0.0, 0.0], [0.0, y, 0.0, 0.0], [0.0, 0.0, z, 0.0], [0.0, 0.0, 0.0, 1.0]])
    }

    pub(crate) fn translate([x, y, z]: [f64; 3]) -> Self {
        let mut m = Self::IDENTITY;
        (m.0[0][3], m.0[1][3], m.0[2][3]) = (x, y, z);
        m
    }

    /// The turn of a quaternion x, y, z, w of any length but zero.
    pub(crate) fn quaternion([x, y, z, w]: [f64; 4]) -> Option<Self> {
        let axis = [x, y, z];
        let sine = length(axis);
        if sine == 0.0 {
            return (w != 0.0).then_some(Self::IDENTITY);
        }
        Self::rotate((2.0 * sine.atan2(w)).to_degrees(), axis)
    }

    /// Counter-clockwise about an axis, seen from its tip (Rodrigues 1840). `None`: the axis has no length.
    pub(crate) fn rotate(degrees: f64, axis: [f64; 3]) -> Option<Self> {
        let [x, y, z] = unit(axis)?;
        let (s, c) = degrees.to_radians().sin_cos();
        let t = 1.0 - c;
        let mut m = Self::IDENTITY;
        let rows = [
            [c + t * x * x, t * x * y - s * z, t * x * z + s * y],
            [t * x * y + s * z, c + t * y * y, t * y * z - s * x],
            [t * x * z - s * y, t * y * z + s * x, c + t * z * z],
        ];
        for (to, from) in m.0.iter_mut().zip(rows) {
            to[..3].copy_from_slice(&from);
        }
        Some(m)
    }

    /// Camera space from world space: the eye goes to the origin, `look` onto +z, `up` toward +y, +x to the side that
    /// `up` × forward gives. `None`: the three make no frame.
    pub(crate) fn look_at(eye: [f64; 3], look: [f64; 3], up: [f64; 3]) -> Option<Self> {
        let z = unit(sub(look, eye))?;
        let x = unit(cross(unit(up)?, z))?;
        let y = cross(z, x);
        let mut m = Self::IDENTITY;
        for (row, axis) in m.0.iter_mut().zip([x, y, z]) {
            row[..3].copy_from_slice(&axis);
            row[3] = -dot(axis, eye);
        }
        Some(m)
    }

    /// First `first`, then this.
    pub(crate) fn after(&self, first: &Self) -> Self {
        let cell = |r: usize, c: usize| (0..4).map(|k| self.0[r][k] * first.0[k][c]).sum();
        Self(std::array::from_fn(|r| std::array::from_fn(|c| cell(r, c))))
    }

    pub(crate) fn point(&self, p: [f64; 3]) -> [f64; 3] {
        let row = |r: &[f64; 4]| r[0] * p[0] + r[1] * p[1] + r[2] * p[2] + r[3];
        [row(&self.0[0]), row(&self.0[1]), row(&self.0[2])]
    }

    pub(crate) fn vector(&self, v: [f64; 3]) -> [f64; 3] {
        let row = |r: &[f64; 4]| r[0] * v[0] + r[1] * v[1] + r[2] * v[2];
        [row(&self.0[0]), row(&self.0[1]), row(&self.0[2])]
    }

    /// What a normal becomes, of any length: the cofactors, which are the inverse transposed times the determinant.
    pub(crate) fn normal(&self, n: [f64; 3]) -> [f64; 3] {
        let [a, b, c] = self.linear();
        let side = self.determinant().signum();
        [cross(b, c), cross(c, a), cross(a, b)].map(|row| side * dot(row, n))
    }

    /// Determinant of the linear part.
    pub(crate) fn determinant(&self) -> f64 {
        let [a, b, c] = self.linear();
        dot(a, cross(b, c))
    }

    fn linear(&self) -> [[f64; 3]; 3] {
        [0, 1, 2].map(|r| [self.0[r][0], self.0[r][1], self.0[r][2]])
    }

    /// Whether it can place something: affine, finite, and not flat, in 32 bits.
    pub(crate) fn is_usable(&self) -> bool {
        let finite = self.0.iter().flatten().all(|x| (*x as f32).is_finite());
        let determinant = self.determinant() as f32;
        finite && self.0[3] == [0.0, 0.0, 0.0, 1.0] && determinant != 0.0 && determinant.is_finite()
    }

    /// The inverse of an affine map; `None` where it is flat or not affine.
    pub(crate) fn inverse(&self) -> Option<Self> {
        if !self.is_usable() {
            return None;
        }
        let [a, b, c] = self.linear();
        let d = self.determinant();
        let columns = [cross(b, c), cross(c, a), cross(a, b)];
        let mut m = Self::IDENTITY;
        for (r, row) in m.0.iter_mut().take(3).enumerate() {
            for (cell, column) in row.iter_mut().zip(&columns) {
                *cell = column[r] / d;
            }
        }
        let t = m.vector([self.0[0][3], self.0[1][3], self.0[2][3]]);
        for (row, t) in m.0.iter_mut().zip(t) {
            row[3] = -t;
        }
        Some(m)
    }

    /// As the placement of an object; no step for the identity.
    pub(crate) fn steps(&self) -> TransformSteps {
        if *self == Self::IDENTITY {
            return Vec::new();
        }
        // Zeros without a sign, which would only clutter what is written.
        vec![TransformStep::Matrix(std::array::from_fn(|i| self.0[i / 4][i % 4] as f32 + 0.0))]
    }
}

pub(crate) fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(crate) fn add(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub(crate) fn times(a: [f64; 3], s: f64) -> [f64; 3] {
    a.map(|x| x * s)
}

pub(crate) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(crate) fn length(a: [f64; 3]) -> f64 {
    dot(a, a).sqrt()
}

/// `None` where there is no direction.
pub(crate) fn unit(a: [f64; 3]) -> Option<[f64; 3]> {
    let length = length(a);
    (length > 0.0 && length.is_finite()).then(|| a.map(|x| x / length))
}

pub(crate) fn narrow(a: [f64; 3]) -> Triple {
    a.map(|x| x as f32)
}

pub(crate) fn wide(a: Triple) -> [f64; 3] {
    a.map(f64::from)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(a: [f64; 3], b: [f64; 3]) {
        assert!(length(sub(a, b)) < 1e-12, "{a:?} {b:?}");
    }

    #[test]
    fn known_maps() {
        close(Matrix::rotate(90.0, [0.0, 0.0, 2.0]).unwrap().point([1.0, 0.0, 5.0]), [0.0, 1.0, 5.0]);
        let camera = Matrix::look_at([1.0, 2.0, 3.0], [1.0, 2.0, 8.0], [0.0, 1.0, 0.0]).unwrap();
        close(camera.point([1.0, 2.0, 3.0]), [0.0; 3]);
        close(camera.point([2.0, 4.0, 8.0]), [1.0, 2.0, 5.0]);
        assert!(Matrix::look_at([0.0; 3], [0.0, 1.0, 0.0], [0.0, 3.0, 0.0]).is_none());
        // Column by column: the last four are the translation.
        let m = Matrix::columns(&[1., 0., 0., 0., 0., 1., 0., 0., 0., 0., -1., 0., 7., 8., 9., 1.]);
        close(m.point([1.0, 1.0, 1.0]), [8.0, 9.0, 8.0]);
        assert_eq!(m.determinant(), -1.0);
    }

    #[test]
    fn normals_stay_upright() {
        let m = Matrix::rotate(20.0, [1.0, 1.0, 0.0]).unwrap().after(&Matrix::scale([2.0, -0.5, 3.0]));
        let (a, b) = ([1.0, 0.5, -0.2], [-0.3, 0.2, 1.0]);
        let n = m.normal(cross(a, b));
        assert!(dot(n, m.vector(a)).abs() < 1e-12 && dot(n, m.vector(b)).abs() < 1e-12);
        assert!(dot(n, m.vector(cross(a, b))) > 0.0);
    }

    #[test]
    fn inverses() {
        let m = Matrix::translate([1.0, -2.0, 3.0])
            .after(&Matrix::rotate(33.0, [1.0, 2.0, -0.5]).unwrap())
            .after(&Matrix::scale([2.0, -0.5, 3.0]));
        let inverse = m.inverse().unwrap();
        for p in [[1.0, 2.0, 3.0], [-4.0, 0.1, 9.0]] {
            close(inverse.point(m.point(p)), p);
        }
        assert!(Matrix::scale([1.0, 0.0, 1.0]).inverse().is_none());
        assert!(Matrix::IDENTITY.steps().is_empty());
    }
}
