//! Lights at infinity.

use std::f64::consts::PI;

use scenefile::desc::{ImageSource, LightKind, SkyMapping};

use super::Importer;
use super::params::Params;
use crate::matrix::{Matrix, narrow};
use crate::picture;

impl Importer {
    pub(super) fn infinite(&mut self, params: &Params, ctm: &Matrix) -> LightKind {
        if let Some(portal) = params.any("portal") {
            let text = "portals guide no light here";
            self.report.instead(text, "the whole surroundings shine", portal.span);
        }
        let image = self.light_image(params);
        if image.is_some() && params.number("illuminance").is_some_and(|e| e > 0.0) {
            let text = "the illuminance of an image is not measured";
            self.report.instead(text, "it is taken for that of an image of ones", params.span);
        }
        let scale = narrow(self.amount(params, "L", "illuminance", 1.0 / PI));
        let Some((source, old)) = image else { return LightKind::Environment { radiance: scale } };
        let (mapping, axes) = if old || self.is_oblong(&source, params) {
            // Version 3: longitudes from +x toward +y, rows from +z down.
            (SkyMapping::LatLong, [[0.0, 0.0, -1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
        } else {
            (SkyMapping::EqualArea, [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
        };
        let transform = ctm.after(&Matrix::rows(axes)).steps();
        LightKind::Sky { source, mapping, scale, transform }
    }

    /// pbrt-v4 takes square pictures alone; one of another shape was made for version 3.
    fn is_oblong(&mut self, source: &ImageSource, params: &Params) -> bool {
        let Some(file) = source.file() else { return false };
        let Some([width, height]) = picture::size(&self.base.join(&file.value)) else { return false };
        if width == height {
            return false;
        }
        let text = "an image of the surroundings that is not square is none of equal areas";
        self.report.instead(text, "it is taken for longitudes and latitudes", params.span);
        true
    }
}
