use color::Lanes;
use math::{Frame, Vec2, Vec3};
use sampling::Discrete;

/// Most squares over which a picture's flux is summed, in quarters of pixels, if it has fewer of these.
const MOST_PARTS: usize = 1 << 16;

/// Intensity as a picture has it that a point throws on what lies before it, bilinear between the middles of its pixels.
///
/// Directions are drawn by a density that is constant in the picture over each pixel, in proportion to its luminance times its
/// solid angle, rows first.
#[derive(Clone, Debug, PartialEq)]
pub struct SlideShape {
    width: usize,
    height: usize,
    /// W/sr at the middles of pixels, linear RGB, rows from the top.
    pixels: Vec<[f32; 3]>,
    rows: Discrete,
    /// For each row its pixels.
    columns: Vec<Discrete>,
    /// x to the picture's left, y up, z forward; not always right-handed.
    frame: Frame,
    /// Half the picture's width and height at distance 1.
    half: Vec2,
    flux: Lanes,
    peak: f32,
}

impl SlideShape {
    /// From linear RGB, row by row from the top, W/sr; `fov`: full angle over the smaller side, radians. `frame`: what the
    /// light's x, y and z are in the world, each of unit length and at right angles to the others. `None` where counts
    /// disagree, the angle is not between 0 and π, something is negative or not finite, or all is black.
    pub fn new([width, height]: [usize; 2], pixels: Vec<[f32; 3]>, fov: f32, frame: Frame) -> Option<Self> {
        let counts = width > 0 && height > 0 && width.checked_mul(height) == Some(pixels.len());
        let angle = fov > 0.0 && fov < math::PI;
        if !(counts && angle && pixels.iter().flatten().all(|x| *x >= 0.0 && x.is_finite())) {
            return None;
        }
        let size = Vec2::new(width as f32, height as f32);
        let half = size / size.min_element() * (0.5 * fov).tan();
        let peak = pixels.iter().map(|rgb| (rgb[0] + rgb[1] + rgb[2]) / 3.0).fold(0.0, f32::max);
        let mut slide = Self {
            width,
            height,
            pixels,
            rows: Discrete::default(),
            columns: Vec::with_capacity(height),
            frame,
            half,
            flux: Lanes::ZERO,
            peak,
        };
        // The coarser the picture, the more it and the solid angle vary over a pixel.
        let parts = 2 * (MOST_PARTS / (width * height)).isqrt().clamp(1, 8);
        let mut flux = [0f64; 3];
        for j in 0..height {
            let row = (0..width).map(|i| {
                let of_pixel = slide.flux_of(i, j, parts);
                flux.iter_mut().zip(of_pixel).for_each(|(s, x)| *s += x);
                color::luminance_f64(of_pixel)
            });
            let row = Discrete::new(row);
            slide.columns.push(row);
        }
        slide.rows = Discrete::new(slide.columns.iter().map(Discrete::total));
        let total = slide.rows.total();
        let [r, g, b] = flux.map(|x| x as f32);
        slide.flux = Lanes::rgb(r, g, b);
        (total > 0.0 && total.is_finite() && half.is_finite()).then_some(slide)
    }

    /// Of a pixel: the intensities in the middles of `parts`² squares of it times their solid angles.
    fn flux_of(&self, i: usize, j: usize, parts: usize) -> [f64; 3] {
        let mut sum = [0f64; 3];
        for part in 0..parts * parts {
            let at = |k: usize, part: usize| k as f32 + (part as f32 + 0.5) / parts as f32;
            let place = Vec2::new(at(i, part % parts), at(j, part / parts));
            let solid_angle = self.solid_angle_about(place, 0.5 / parts as f32);
            let pixel = self.lookup(place);
            sum.iter_mut().zip(pixel).for_each(|(s, x)| *s += f64::from(x) * solid_angle);
        }
        sum
    }

    fn size(&self) -> Vec2 {
        Vec2::new(self.width as f32, self.height as f32)
    }

    /// At a place in pixels, of the plane at distance 1.
    fn at_one(&self, place: Vec2) -> Vec2 {
        self.half - 2.0 * self.half * place / self.size()
    }

    /// Of the square about a place that reaches `q` pixels to either side.
    fn solid_angle_about(&self, place: Vec2, q: f32) -> f64 {
        let corner = |dx: f32, dy: f32| {
            let [x, y] = self.at_one(place + Vec2::new(dx, dy)).to_array().map(f64::from);
            // Of the rectangle from the axis to (x, y) at distance 1.
            (x * y / (1.0 + x * x + y * y).sqrt()).atan()
        };
        (corner(q, q) - corner(-q, q) - corner(q, -q) + corner(-q, -q)).abs()
    }

    /// Solid angle over area, in pixels, at a place: a pixel's area at distance 1 times cos³.
    fn solid_angle(&self, place: Vec2) -> f64 {
        let pixel = 2.0 * self.half / self.size();
        let cos2 = 1.0 / (1.0 + f64::from(self.at_one(place).length_squared()));
        f64::from(pixel.x * pixel.y) * cos2 * cos2.sqrt()
    }

    /// The place in pixels that a unit vector meets; `None` outside the picture.
    fn place(&self, w: Vec3) -> Option<Vec2> {
        let d = self.frame.to_local(w);
        if d.z <= 0.0 {
            return None;
        }
        let s = Vec2::new(d.x, d.y) / (d.z * self.half);
        let inside = s.x.abs() <= 1.0 && s.y.abs() <= 1.0;
        inside.then(|| (Vec2::ONE - s) * 0.5 * self.size())
    }

    /// Beyond the border lies the pixel at the border.
    fn lookup(&self, place: Vec2) -> [f32; 3] {
        let [x, y] = (place - 0.5).to_array();
        let (i, j) = (x.floor(), y.floor());
        let (s, t) = (x - i, y - j);
        let pixel = |di: f32, dj: f32| {
            let i = (i + di).clamp(0.0, (self.width - 1) as f32) as usize;
            let j = (j + dj).clamp(0.0, (self.height - 1) as f32) as usize;
            self.pixels[j * self.width + i]
        };
        let row = |dj: f32| {
            let (a, b) = (pixel(0.0, dj), pixel(1.0, dj));
            [0, 1, 2].map(|c| a[c] + (b[c] - a[c]) * s)
        };
        let (a, b) = (row(0.0), row(1.0));
        [0, 1, 2].map(|c| a[c] + (b[c] - a[c]) * t)
    }

    pub(super) fn flux_and_peak(&self) -> (Lanes, f32) {
        (self.flux, self.peak)
    }

    pub(super) fn intensity(&self, w: Vec3) -> Lanes {
        self.place(w).map_or(Lanes::ZERO, |place| {
            let [r, g, b] = self.lookup(place);
            Lanes::rgb(r, g, b)
        })
    }

    pub(super) fn pdf_w(&self, w: Vec3) -> f32 {
        let Some(place) = self.place(w) else { return 0.0 };
        let i = (place.x as usize).min(self.width - 1);
        let j = (place.y as usize).min(self.height - 1);
        let share = f64::from(self.rows.pmf(j)) * f64::from(self.columns[j].pmf(i));
        (share / self.solid_angle(place)) as f32
    }

    pub(super) fn sample(&self, u: [f32; 2]) -> Vec3 {
        let (j, _, t) = self.rows.sample(u[1]);
        let (i, _, s) = self.columns[j].sample(u[0]);
        let at = self.at_one(Vec2::new(i as f32 + s, j as f32 + t));
        self.frame.to_world(at.extend(1.0)).normalize()
    }

    /// A cone that holds the picture: unit axis and half-angle.
    pub(super) fn cone(&self) -> (Vec3, f32) {
        (self.frame.z, self.half.length().atan())
    }
}
