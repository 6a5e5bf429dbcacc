use color::Lanes;
use math::{Frame, PI, Vec3};
use photometry::{Cell, Web};
use sampling::Discrete;

/// The intensity of a measured luminaire.
///
/// Directions are drawn by a piecewise constant density: a cell of the file's grid in proportion to its flux, planes first,
/// evenly over the solid angle within.
#[derive(Clone, Debug, PartialEq)]
pub struct ProfileShape {
    web: Web,
    /// The luminaire's axes in the world; not always right-handed.
    frame: Frame,
    /// W/sr for each candela.
    per_candela: Lanes,
    planes: Discrete,
    /// For each pair of planes the cells between.
    cells: Vec<Discrete>,
    lumens: f32,
    /// Greatest polar angle with light, radians; π where the grid's axis is another.
    widest: f32,
}

impl ProfileShape {
    /// `frame`: what the luminaire's x, y and z are in the world, each of unit length and at right angles to the others.
    pub fn new(web: Web, frame: Frame, per_candela: Lanes) -> Self {
        let [azimuths, polars] = web.cells();
        let row = |i| Discrete::new((0..polars).map(|j| web.flux(i, j)));
        let cells: Vec<Discrete> = (0..azimuths).map(row).collect();
        let planes = Discrete::new(cells.iter().map(Discrete::total));
        let lumens = web.lumens() as f32;
        let widest = web.widest().map_or(PI, f32::to_radians);
        Self { web, frame, per_candela, planes, cells, lumens, widest }
    }

    pub(super) fn flux_and_peak(&self) -> (Lanes, f32) {
        (self.per_candela * self.lumens, self.per_candela.mean() * self.web.greatest())
    }

    pub(super) fn intensity(&self, w: Vec3) -> Lanes {
        match self.web.locate(self.frame.to_local(w)) {
            Some(cell) => self.per_candela * self.web.candela(cell),
            None => Lanes::ZERO,
        }
    }

    pub(super) fn pdf_w(&self, w: Vec3) -> f32 {
        let Some(Cell { azimuth, polar, .. }) = self.web.locate(self.frame.to_local(w)) else { return 0.0 };
        let share = f64::from(self.planes.pmf(azimuth)) * f64::from(self.cells[azimuth].pmf(polar));
        (share / self.web.solid_angle(azimuth, polar)) as f32
    }

    pub(super) fn sample(&self, u: [f32; 2]) -> Vec3 {
        let (azimuth, _, s) = self.planes.sample(u[0]);
        let (polar, _, v) = self.cells[azimuth].sample(u[1]);
        let w = self.web.direction(Cell { azimuth, polar, s, t: self.web.share_of_angle(polar, v) });
        self.frame.to_world(w).normalize()
    }

    /// A cone that holds all light: unit axis and half-angle.
    pub(super) fn cone(&self) -> (Vec3, f32) {
        (-self.frame.y, self.widest)
    }
}
