//! Intensities over the sphere.

use math::Vec3;

/// The axis from which polar angles are counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PolarAxis {
    /// −y (types C and A): azimuth 0 is +x, 90 is +z.
    Down,
    /// −z (type B): azimuth 0 is +x, 90 is +y.
    Side,
}

/// Luminous intensities on a grid of angles about a luminaire at the origin, bilinear in the angles between; 0 outside the
/// angles of the grid.
#[derive(Clone, Debug, PartialEq)]
pub struct Web {
    /// Degrees from the axis, ascending, at least two.
    polar: Vec<f32>,
    /// Degrees about the axis, ascending, at least two, over no more than 360; a whole turn begins at 0 and ends at 360.
    azimuth: Vec<f32>,
    /// cd, all polar angles of an azimuth one after the other.
    candela: Vec<f32>,
    axis: PolarAxis,
}

/// A cell of the grid, and where in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// Index of its first azimuth.
    pub azimuth: usize,
    /// Index of its first polar angle.
    pub polar: usize,
    /// Share of the cell's azimuths that lie before, 0..=1.
    pub s: f32,
    /// Share of the cell's polar angles that lie before, 0..=1.
    pub t: f32,
}

/// Which planes a file leaves out, as they repeat others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Symmetry {
    None,
    /// One plane for all.
    Rotation,
    /// About the plane of 0° and 180°.
    Across0,
    /// About the plane of 90° and 270°.
    Across90,
    /// About both.
    Quadrants,
}

impl Web {
    /// A whole turn from planes at `azimuth` and what symmetry makes of them; `candela` as in [`Web`].
    pub(crate) fn turned(polar: Vec<f32>, azimuth: &[f32], candela: &[f32], symmetry: Symmetry) -> Self {
        let n = polar.len();
        let images = |phi: f32| -> Vec<f32> {
            match symmetry {
                Symmetry::None | Symmetry::Rotation => vec![phi],
                Symmetry::Across0 => vec![phi, -phi],
                Symmetry::Across90 => vec![phi, 180.0 - phi],
                Symmetry::Quadrants => vec![phi, -phi, 180.0 - phi, 180.0 + phi],
            }
        };
        let azimuth = if symmetry == Symmetry::Rotation { &[0.0] } else { azimuth };
        let mut planes: Vec<(f32, usize)> = Vec::new();
        for (i, &phi) in azimuth.iter().enumerate() {
            planes.extend(images(phi).into_iter().map(|phi| (phi.rem_euclid(360.0).abs(), i)));
        }
        planes.sort_by(|a, b| a.0.total_cmp(&b.0));
        planes.dedup_by(|a, b| a.0 - b.0 < 1e-3);
        // 359.9999 is 0.
        if planes.len() > 1 && planes[planes.len() - 1].0 > 360.0 - 1e-3 {
            planes.pop();
        }
        // Where no plane stands at 0, the first one closes the turn on both sides.
        let (first, last) = (planes[0], planes[planes.len() - 1]);
        let mut all = Vec::with_capacity(planes.len() + 2);
        if first.0 > 0.0 {
            all.push(first.1);
        }
        all.extend(planes.iter().map(|plane| plane.1));
        all.push(first.1);
        let mut angles = Vec::with_capacity(all.len());
        if first.0 > 0.0 {
            angles.push(last.0 - 360.0);
            all[0] = last.1;
        }
        angles.extend(planes.iter().map(|plane| plane.0));
        angles.push(first.0 + 360.0);
        let candela = all.iter().flat_map(|&i| &candela[i * n..(i + 1) * n]).copied().collect();
        Self { polar, azimuth: angles, candela, axis: PolarAxis::Down }
    }

    /// A part of the sphere.
    pub(crate) fn part(polar: Vec<f32>, azimuth: Vec<f32>, candela: Vec<f32>, axis: PolarAxis) -> Self {
        Self { polar, azimuth, candela, axis }
    }

    /// Number of cells of the grid: over azimuths and polar angles.
    pub fn cells(&self) -> [usize; 2] {
        [self.azimuth.len() - 1, self.polar.len() - 1]
    }

    /// Polar angles in degrees.
    pub fn polar(&self) -> &[f32] {
        &self.polar
    }

    /// Azimuths in degrees.
    pub fn azimuth(&self) -> &[f32] {
        &self.azimuth
    }

    /// The greatest intensity, cd.
    pub fn greatest(&self) -> f32 {
        self.candela.iter().fold(0.0, |m, &x| m.max(x))
    }

    fn corner(&self, azimuth: usize, polar: usize) -> f32 {
        self.candela[azimuth * self.polar.len() + polar]
    }

    /// The cell that a unit vector lies in; `None` outside the grid.
    pub fn locate(&self, w: Vec3) -> Option<Cell> {
        let w = match self.axis {
            PolarAxis::Down => w,
            PolarAxis::Side => Vec3::new(w.x, w.z, w.y),
        };
        let theta = w.x.hypot(w.z).atan2(-w.y).to_degrees();
        let [first, last] = [self.azimuth[0], self.azimuth[self.azimuth.len() - 1]];
        // In (−180, 180].
        let mut phi = w.z.atan2(w.x).to_degrees();
        if phi < first {
            phi += 360.0;
        } else if phi > last {
            phi -= 360.0;
        }
        let (azimuth, s) = between(&self.azimuth, phi, last - first >= 360.0)?;
        let (polar, t) = between(&self.polar, theta, false)?;
        Some(Cell { azimuth, polar, s, t })
    }

    /// The unit vector at a place of a cell.
    pub fn direction(&self, cell: Cell) -> Vec3 {
        let along = |angles: &[f32], i: usize, t: f32| {
            (f64::from(angles[i]) + f64::from(angles[i + 1] - angles[i]) * f64::from(t)).to_radians()
        };
        let (sin, cos) = along(&self.polar, cell.polar, cell.t).sin_cos();
        let (s, c) = along(&self.azimuth, cell.azimuth, cell.s).sin_cos();
        let w = [sin * c, -cos, sin * s].map(|x| x as f32);
        match self.axis {
            PolarAxis::Down => Vec3::new(w[0], w[1], w[2]),
            PolarAxis::Side => Vec3::new(w[0], w[2], w[1]),
        }
    }

    /// Intensity at a place of a cell, cd.
    pub fn candela(&self, cell: Cell) -> f32 {
        let Cell { azimuth: i, polar: j, s, t } = cell;
        let at = |i: usize| {
            let (a, b) = (self.corner(i, j), self.corner(i, j + 1));
            a + (b - a) * t
        };
        let (a, b) = (at(i), at(i + 1));
        a + (b - a) * s
    }

    /// Cosines of the polar angles that bound a cell, the greater one first.
    pub fn cosines(&self, polar: usize) -> [f64; 2] {
        [polar, polar + 1].map(|j| f64::from(self.polar[j]).to_radians().cos())
    }

    /// The share of a cell's polar angles that lies before the share `v` of its solid angle.
    pub fn share_of_angle(&self, polar: usize, v: f32) -> f32 {
        let [a, b] = self.cosines(polar);
        let [low, high] = [self.polar[polar], self.polar[polar + 1]].map(f64::from);
        let theta = (a + (b - a) * f64::from(v)).clamp(-1.0, 1.0).acos().to_degrees();
        (((theta - low) / (high - low)) as f32).clamp(0.0, 1.0)
    }

    /// The least angle from straight down, degrees, beyond which there is no light; `None` where the grid has another axis.
    pub fn widest(&self) -> Option<f32> {
        let n = self.polar.len();
        let lit = |j: usize| self.candela.iter().skip(j).step_by(n).any(|&x| x > 0.0);
        let last = (0..n).rev().find(|&j| lit(j)).unwrap_or(0);
        (self.axis == PolarAxis::Down).then(|| self.polar[(last + 1).min(n - 1)])
    }

    /// Solid angle of a cell, sr.
    pub fn solid_angle(&self, azimuth: usize, polar: usize) -> f64 {
        let [a, b] = self.cosines(polar);
        self.width(azimuth) * (a - b)
    }

    /// Of a cell in azimuth, radians.
    fn width(&self, azimuth: usize) -> f64 {
        f64::from(self.azimuth[azimuth + 1] - self.azimuth[azimuth]).to_radians()
    }

    /// Luminous flux through a cell, lm.
    pub fn flux(&self, azimuth: usize, polar: usize) -> f64 {
        let mean =
            |j: usize| 0.5 * (f64::from(self.corner(azimuth, j)) + f64::from(self.corner(azimuth + 1, j)));
        let (low, high) = (mean(polar), mean(polar + 1));
        let [a, b] = [polar, polar + 1].map(|j| f64::from(self.polar[j]).to_radians());
        // ∫ sin θ dθ, and ∫ (θ − a)/(b − a)·sin θ dθ.
        let whole = a.cos() - b.cos();
        let part = ((b.sin() - a.sin()) - (b - a) * b.cos()) / (b - a);
        self.width(azimuth) * (low * whole + (high - low) * part)
    }

    /// Luminous flux of all, lm.
    pub fn lumens(&self) -> f64 {
        let [azimuths, polars] = self.cells();
        (0..azimuths).map(|i| (0..polars).map(|j| self.flux(i, j)).sum::<f64>()).sum()
    }
}

/// The interval that holds `x`, and the share of it before `x`. What lies outside by rounding alone counts to the nearest
/// one, and so does all of it `around` a turn.
fn between(angles: &[f32], x: f32, around: bool) -> Option<(usize, f32)> {
    let last = angles.len() - 1;
    let slack = 1e-4;
    if !around && !(angles[0] - slack..=angles[last] + slack).contains(&x) {
        return None;
    }
    let i = angles.partition_point(|&a| a <= x).clamp(1, last) - 1;
    let share = (x - angles[i]) / (angles[i + 1] - angles[i]);
    Some((i, share.clamp(0.0, 1.0)))
}
