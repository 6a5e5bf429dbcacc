use std::path::Path;

use color::Lanes;
use math::{Bounds3, PI, Transform, Vec3};

use super::directional::SceneSphere;
use super::{LeSample, LiSample};
use crate::target::Targets;
use crate::texture::{Encoding, ImageTexture, TextureError};

/// A picture of the sky at infinity in longitude and latitude, bilinear between the middles of its pixels.
///
/// Directions are drawn by a piecewise constant density: of a pixel's part of the sphere in proportion to the luminance over it
/// (Pharr, Jakob & Humphreys 2023, §12.5.2), rows first. Evenly in longitude and in the cosine of the polar angle within.
///
/// Memory: 20 bytes a pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct SkyLight {
    width: usize,
    height: usize,
    /// Radiance at the middles of pixels, linear RGB, rows from the top.
    pixels: Vec<[f32; 3]>,
    /// Cosines of the polar angles between rows, from 1 to −1.
    cosines: Vec<f64>,
    /// Cumulative shares of the rows: `height + 1` numbers from 0 to 1.
    rows: Vec<f64>,
    /// For each row the cumulative shares of its pixels.
    columns: Vec<f64>,
    /// ∫L dω.
    integral: Lanes,
    world_from_sky: Transform,
    scene: SceneSphere,
}

impl SkyLight {
    /// From linear RGB, row by row from the top. `None` where counts disagree, something is negative or not finite, or all is black.
    pub fn new(
        width: usize,
        height: usize,
        pixels: Vec<[f32; 3]>,
        world_from_sky: Transform,
    ) -> Option<Self> {
        let counts = width > 0 && height > 0 && width.checked_mul(height) == Some(pixels.len());
        if !counts || !pixels.iter().flatten().all(|x| *x >= 0.0 && x.is_finite()) {
            return None;
        }
        let cosines: Vec<f64> =
            (0..=height).map(|j| (std::f64::consts::PI * j as f64 / height as f64).cos()).collect();
        let mut sky = Self {
            width,
            height,
            pixels,
            cosines,
            rows: vec![0.0],
            columns: Vec::with_capacity((width + 1) * height),
            integral: Lanes::ZERO,
            world_from_sky,
            scene: SceneSphere::default(),
        };
        let mut integral = [0f64; 3];
        for j in 0..height {
            let solid_angle =
                2.0 * std::f64::consts::PI / width as f64 * (sky.cosines[j] - sky.cosines[j + 1]);
            let (first, shares) = (sky.columns.len(), sky.shares(j));
            let mut sum = 0.0;
            sky.columns.push(0.0);
            for i in 0..width {
                let mean = sky.mean_over(i, j, shares);
                integral.iter_mut().zip(mean).for_each(|(s, x)| *s += x * solid_angle);
                sum += luminance(mean) * solid_angle;
                sky.columns.push(sum);
            }
            normalize(&mut sky.columns[first..], sum);
            let below = sky.rows[j];
            sky.rows.push(below + sum);
        }
        let total = sky.rows[height];
        normalize(&mut sky.rows, total);
        let [r, g, b] = integral.map(|x| x as f32);
        sky.integral = Lanes::rgb(r, g, b);
        (total > 0.0 && total.is_finite() && sky.integral.is_finite()).then_some(sky)
    }

    /// From a picture file, its values times `scale`. `Ok(None)` as in [`Self::new`].
    pub fn from_path(
        path: &Path,
        scale: [f32; 3],
        world_from_sky: Transform,
    ) -> Result<Option<Self>, TextureError> {
        let image = ImageTexture::from_path(path, Encoding::Srgb)?;
        let [width, height] = image.size();
        let pixels = (0..width * height).map(|i| {
            let [r, g, b] = image.pixel(i);
            [r * scale[0], g * scale[1], b * scale[2]]
        });
        Ok(Self::new(width, height, pixels.collect(), world_from_sky))
    }

    /// Mean over the solid angle of a pixel of what is bilinear between the middles of pixels: along a row (1, 6, 1)/8.
    fn mean_over(&self, i: usize, j: usize, rows: [f64; 3]) -> [f64; 3] {
        let mut sum = [0f64; 3];
        for (dj, wj) in (-1..).zip(rows) {
            for (di, wi) in [(-1, 0.125), (0, 0.75), (1, 0.125)] {
                let pixel = self.pixel(i as i64 + di, j as i64 + dj);
                sum.iter_mut().zip(pixel).for_each(|(s, x)| *s += wi * wj * f64::from(x));
            }
        }
        sum
    }

    /// Shares in row `j` of the row above, of itself and of the row below.
    fn shares(&self, j: usize) -> [f64; 3] {
        let step = std::f64::consts::PI / self.height as f64;
        let [top, middle, bottom] = [0.0, 0.5, 1.0].map(|t| (j as f64 + t) * step);
        // ∫ (θ − middle) sin θ dθ; the other row's share grows from the middle of this one to 1/2 at its edge.
        let moment = |theta: f64| theta.sin() - (theta - middle) * theta.cos();
        let whole = self.cosines[j] - self.cosines[j + 1];
        let above = (moment(top) - moment(middle)) / (step * whole);
        let below = (moment(bottom) - moment(middle)) / (step * whole);
        [above, 1.0 - above - below, below].map(|share| share.max(0.0))
    }

    /// Columns go round; beyond a pole lies the row at the pole.
    fn pixel(&self, i: i64, j: i64) -> [f32; 3] {
        let i = i.rem_euclid(self.width as i64) as usize;
        let j = j.clamp(0, self.height as i64 - 1) as usize;
        self.pixels[j * self.width + i]
    }

    /// Coordinates in pixels of the unit vector `w`: the middle of the picture is +z, its left quarter +x.
    fn place(&self, w: Vec3) -> [f32; 2] {
        let d = self.world_from_sky.inverse().vector(w);
        let u = d.x.atan2(-d.z) / (2.0 * PI);
        let v = d.y.clamp(-1.0, 1.0).acos() / PI;
        [(if u < 0.0 { u + 1.0 } else { u }) * self.width as f32, v * self.height as f32]
    }

    /// Radiance that comes from the direction `w`.
    pub fn radiance(&self, w: Vec3) -> Lanes {
        let [x, y] = self.place(w).map(|x| x - 0.5);
        let (i, j) = (x.floor() as i64, y.floor() as i64);
        let (s, t) = (x - x.floor(), y - y.floor());
        let row = |j: i64| {
            let (a, b) = (self.pixel(i, j), self.pixel(i + 1, j));
            [0, 1, 2].map(|c| a[c] + (b[c] - a[c]) * s)
        };
        let (a, b) = (row(j), row(j + 1));
        let [r, g, b] = [0, 1, 2].map(|c| a[c] + (b[c] - a[c]) * t);
        Lanes::rgb(r, g, b)
    }

    /// Density per steradian with which light sampling draws `w`.
    pub fn pdf_w(&self, w: Vec3) -> f32 {
        let [x, y] = self.place(w);
        let i = (x as usize).min(self.width - 1);
        let j = (y as usize).min(self.height - 1);
        let row = self.rows[j + 1] - self.rows[j];
        let cells = &self.columns[j * (self.width + 1)..];
        let cell = cells[i + 1] - cells[i];
        let solid_angle =
            2.0 * std::f64::consts::PI / self.width as f64 * (self.cosines[j] - self.cosines[j + 1]);
        (row * cell / solid_angle) as f32
    }

    /// A direction toward the sky and its density.
    fn sample(&self, u: [f32; 2]) -> Option<(Vec3, f32)> {
        let (j, t) = invert(&self.rows, f64::from(u[1]));
        let columns = &self.columns[j * (self.width + 1)..(j + 1) * (self.width + 1)];
        let (i, s) = invert(columns, f64::from(u[0]));
        let cos = self.cosines[j] + (self.cosines[j + 1] - self.cosines[j]) * t;
        let sin = (1.0 - cos * cos).max(0.0).sqrt();
        let phi = 2.0 * std::f64::consts::PI * (i as f64 + s) / self.width as f64;
        let d = Vec3::new((sin * phi.sin()) as f32, cos as f32, (-sin * phi.cos()) as f32);
        let w = self.world_from_sky.vector(d).normalize();
        // As the direction, rounded, will be asked about.
        let pdf_w = self.pdf_w(w);
        (pdf_w > 0.0).then_some((w, pdf_w))
    }

    /// ∫L dω times the area of a great disc of the scene's sphere.
    pub fn power(&self) -> Lanes {
        self.integral * self.scene.disc_area()
    }

    pub(super) fn preprocess(&mut self, bounds: Bounds3) {
        self.scene = SceneSphere::of(bounds);
    }

    pub(super) fn sample_li(&self, p: Vec3, u: [f32; 2]) -> Option<LiSample> {
        let (wi, pdf_w) = self.sample(u)?;
        Some(LiSample {
            wi,
            distance: f32::INFINITY,
            radiance: self.radiance(wi),
            pdf_w,
            is_delta: false,
            p: p + wi * (2.0 * self.scene.radius),
            p_error: 0.0,
            n: Vec3::ZERO,
        })
    }

    pub(super) fn sample_le(&self, u_pos: [f32; 2], u_dir: [f32; 2]) -> Option<LeSample> {
        let (from, pdf_w) = self.sample(u_dir)?;
        self.scene.sample_le(-from, pdf_w, self.radiance(from), u_pos)
    }

    pub(super) fn pdf_le_a(&self, p: Vec3, w: Vec3) -> f32 {
        self.scene.pdf_a(p, w)
    }

    pub(super) fn sample_le_toward(
        &self,
        targets: &Targets,
        u_pick: f32,
        u_pos: [f32; 2],
        u_dir: [f32; 2],
    ) -> Option<LeSample> {
        let (from, pdf_w) = self.sample(u_dir)?;
        self.scene.sample_le_toward(targets, -from, pdf_w, self.radiance(from), u_pick, u_pos)
    }
}

/// Rec. 709.
fn luminance([r, g, b]: [f64; 3]) -> f64 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

/// Makes sums end at exactly 1.
fn normalize(sums: &mut [f64], total: f64) {
    if total > 0.0 {
        sums.iter_mut().for_each(|x| *x /= total);
    }
}

/// The interval of cumulative shares that holds `u`, never an empty one if any is not, and the place within it in [0, 1).
fn invert(sums: &[f64], u: f64) -> (usize, f64) {
    let above = sums.partition_point(|&x| x <= u);
    let i = above.clamp(1, sums.len() - 1) - 1;
    let share = sums[i + 1] - sums[i];
    let t = if share > 0.0 { ((u - sums[i]) / share).clamp(0.0, 1.0 - 1e-9) } else { 0.5 };
    (i, t)
}
