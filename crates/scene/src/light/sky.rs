use std::f64::consts::PI;

use color::Lanes;
use math::{Bounds3, Transform, Vec3};
use sampling::Discrete;
use scenefile::desc::SkyMapping;

use super::directional::SceneSphere;
use super::{LeSample, LiSample};
use crate::sphere_map;
use crate::target::Targets;

/// A picture of the sky at infinity, bilinear between the middles of its pixels.
///
/// Directions are drawn by a piecewise constant density: of a pixel's part of the sphere in proportion to the luminance over it
/// (Pharr, Jakob & Humphreys 2023, §12.5.2), rows first. Within the pixel evenly over the sphere.
///
/// Memory: 20 bytes a pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct SkyLight {
    mapping: SkyMapping,
    width: usize,
    height: usize,
    /// Radiance at the middles of pixels, linear RGB, rows from the top.
    pixels: Vec<[f32; 3]>,
    rows: Discrete,
    /// For each row its pixels.
    columns: Vec<Discrete>,
    /// ∫L dω.
    integral: Lanes,
    world_from_sky: Transform,
    scene: SceneSphere,
}

impl SkyLight {
    /// From linear RGB, row by row from the top. `None` where counts disagree, a picture of equal areas is not square, something
    /// is negative or not finite, or all is black.
    pub fn new(
        mapping: SkyMapping,
        [width, height]: [usize; 2],
        pixels: Vec<[f32; 3]>,
        world_from_sky: Transform,
    ) -> Option<Self> {
        let counts = width > 0 && height > 0 && width.checked_mul(height) == Some(pixels.len());
        let shape = mapping == SkyMapping::LatLong || width == height;
        if !(counts && shape && pixels.iter().flatten().all(|x| *x >= 0.0 && x.is_finite())) {
            return None;
        }
        let mut sky = Self {
            mapping,
            width,
            height,
            pixels,
            rows: Discrete::default(),
            columns: Vec::with_capacity(height),
            integral: Lanes::ZERO,
            world_from_sky,
            scene: SceneSphere::default(),
        };
        let mut integral = [0f64; 3];
        for j in 0..height {
            let (solid_angle, shares) = (sky.solid_angle(j), sky.shares(j));
            let row = (0..width).map(|i| {
                let mean = sky.mean_over(i, j, shares);
                integral.iter_mut().zip(mean).for_each(|(s, x)| *s += x * solid_angle);
                color::luminance_f64(mean) * solid_angle
            });
            let row = Discrete::new(row);
            sky.columns.push(row);
        }
        sky.rows = Discrete::new(sky.columns.iter().map(Discrete::total));
        let [r, g, b] = integral.map(|x| x as f32);
        sky.integral = Lanes::rgb(r, g, b);
        let total = sky.rows.total();
        (total > 0.0 && total.is_finite() && sky.integral.is_finite()).then_some(sky)
    }

    /// Mean over a pixel's part of the sphere of what is bilinear between the middles of pixels: along a row (1, 6, 1)/8.
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
        if self.mapping == SkyMapping::EqualArea {
            return [0.125, 0.75, 0.125];
        }
        let step = PI / self.height as f64;
        let [top, middle, bottom] = [0.0, 0.5, 1.0].map(|t| (j as f64 + t) * step);
        // ∫ (θ − middle) sin θ dθ; the other row's share grows from the middle of this one to 1/2 at its edge.
        let moment = |theta: f64| theta.sin() - (theta - middle) * theta.cos();
        let whole = self.cos(j) - self.cos(j + 1);
        let above = (moment(top) - moment(middle)) / (step * whole);
        let below = (moment(bottom) - moment(middle)) / (step * whole);
        [above, 1.0 - above - below, below].map(|share| share.max(0.0))
    }

    /// Cosine of the polar angle between rows `j` − 1 and `j` of longitudes and latitudes.
    fn cos(&self, j: usize) -> f64 {
        (PI * j as f64 / self.height as f64).cos()
    }

    /// Of each pixel in row `j`.
    fn solid_angle(&self, j: usize) -> f64 {
        match self.mapping {
            SkyMapping::LatLong => 2.0 * PI / self.width as f64 * (self.cos(j) - self.cos(j + 1)),
            SkyMapping::EqualArea => 4.0 * PI / (self.width as f64 * self.height as f64),
        }
    }

    fn pixel(&self, i: i64, j: i64) -> [f32; 3] {
        let [i, j] = sphere_map::wrapped(self.mapping, [self.width, self.height], i, j);
        self.pixels[j * self.width + i]
    }

    /// Coordinates in pixels of the unit vector `w`.
    fn place(&self, w: Vec3) -> [f32; 2] {
        let [u, v] = sphere_map::square(self.mapping, self.world_from_sky.inverse().vector(w));
        [u * self.width as f32, v * self.height as f32]
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
        let share = f64::from(self.rows.pmf(j)) * f64::from(self.columns[j].pmf(i));
        (share / self.solid_angle(j)) as f32
    }

    /// A direction toward the sky and its density.
    fn sample(&self, u: [f32; 2]) -> Option<(Vec3, f32)> {
        let w = self.draw(u);
        // As the direction, rounded, will be asked about.
        let pdf_w = self.pdf_w(w);
        (pdf_w > 0.0).then_some((w, pdf_w))
    }

    /// The direction alone.
    pub(super) fn draw(&self, u: [f32; 2]) -> Vec3 {
        let (j, _, t) = self.rows.sample(u[1]);
        let (i, _, s) = self.columns[j].sample(u[0]);
        let (s, t) = (f64::from(s), f64::from(t));
        let v = match self.mapping {
            SkyMapping::LatLong => (self.cos(j) + (self.cos(j + 1) - self.cos(j)) * t).acos() / PI,
            SkyMapping::EqualArea => (j as f64 + t) / self.height as f64,
        };
        let d = sphere_map::direction(self.mapping, [(i as f64 + s) / self.width as f64, v]);
        self.world_from_sky.vector(d).normalize()
    }

    /// ∫L dω.
    pub(super) fn integral(&self) -> Lanes {
        self.integral
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
        Some(self.scene.sample_li(p, wi, pdf_w, self.radiance(wi)))
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
