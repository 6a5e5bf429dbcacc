//! Lights at a point and from a direction, and how much any light gives.
//!
//! In pbrt-v4 whatever spectrum a light has is first scaled to luminance 1 (RGB: such that white has it), then
//! multiplied by `scale`; `power` and `illuminance` set the total instead.

use std::f64::consts::PI;

use scenefile::desc::{ImageSource, Light, LightKind, PointAmount, SkyMapping};
use scenefile::{Sourced, Span};

use super::Importer;
use super::params::Params;
use crate::matrix::{Matrix, narrow, sub};

impl Importer {
    /// Colour times scale, white balance and the film's gain. `unit`: what a total of 1 makes of it, for the parameter `total`.
    pub(super) fn amount(&mut self, params: &Params, color: &str, total: &str, unit: f64) -> [f64; 3] {
        let rgb = self.light_color(params, color).unwrap_or([1.0; 3]);
        // Version 3 gives `scale` as a colour.
        let scale = match params.find("scale", &["rgb", "spectrum", "blackbody"]) {
            Some(_) => self.channels(params, "scale").unwrap_or([1.0; 3]),
            None => [params.number_or("scale", 1.0); 3],
        };
        let total = params.number(total).filter(|x| *x > 0.0).map_or(1.0, |x| x * unit);
        let rgb = [0, 1, 2].map(|i| rgb[i] * scale[i] * total * self.gain);
        if rgb.iter().any(|c| *c < 0.0 || !(*c as f32).is_finite()) {
            self.report.error(
                "out-of-range",
                format!("{} is not of a finite positive power", params.what),
                params.span,
            );
            return [0.0; 3];
        }
        self.white.balanced(rgb)
    }

    pub(super) fn light(&mut self, kind: &str, at: Span, params: &Params) {
        let ctm = self.mirror.after(&self.graphics.ctm);
        let from = params.point("from").unwrap_or([0.0; 3]);
        let to = params.point("to").unwrap_or([0.0, 0.0, 1.0]);
        let toward = narrow(ctm.vector(sub(to, from)));
        let position = narrow(ctm.point(from));
        let light = match kind {
            "point" => {
                let intensity = self.amount(params, "I", "power", 1.0 / (4.0 * PI));
                Some(LightKind::Point { position, amount: PointAmount::Intensity(narrow(intensity)) })
            }
            "goniometric" => Some(self.goniometric(params, &ctm)),
            "spot" => {
                let cone = params.number_or("coneangle", 30.0).clamp(0.01, 180.0);
                let delta = params.number_or("conedeltaangle", 5.0).clamp(0.0, cone);
                let [end, start] = [cone, cone - delta].map(|a| a.to_radians().cos());
                let unit = 1.0 / (2.0 * PI * ((1.0 - start) + (start - end) / 2.0));
                let intensity = self.amount(params, "I", "power", unit);
                Some(LightKind::Spot {
                    position,
                    direction: toward,
                    cone_angle: cone as f32,
                    falloff_angle: delta as f32,
                    amount: PointAmount::Intensity(narrow(intensity)),
                })
            }
            "projection" => self.projection(params, &ctm),
            "distant" => {
                let irradiance = narrow(self.amount(params, "L", "illuminance", 1.0));
                Some(LightKind::Directional { direction: toward, irradiance })
            }
            "infinite" | "exinfinite" => Some(self.infinite(params, &ctm)),
            _ => {
                self.report.error("unknown-kind", format!("there is no light `{kind}`"), at);
                None
            }
        };
        let Some(light) = light else { return };
        params.ignore(&["samples", "nsamples"]);
        if self.object.is_some() {
            self.report.instead(
                "a light within an object",
                "it shines once, where it stands in the file",
                params.span,
            );
        }
        self.desc.lights.push(Sourced::at(Light::from(light), params.span));
    }

    /// The picture of a light, by its name in either version, and whether it is version 3's.
    pub(super) fn light_image(&mut self, params: &Params) -> Option<(ImageSource, bool)> {
        let old = params.find("mapname", &["string"]);
        let param = params.find("filename", &["string"]).or(old)?;
        let file = self.find_file(param.text().filter(|name| !name.is_empty())?);
        Some((ImageSource::File(Sourced::at(file, param.span)), old.is_some() || self.is_version_3))
    }

    fn goniometric(&mut self, params: &Params, ctm: &Matrix) -> LightKind {
        let image = self.light_image(params);
        if image.is_some() && params.number("power").is_some_and(|p| p > 0.0) {
            let text = "the power of a goniometric light does not count what its image holds back";
            self.report.instead(text, "it is that of an image of ones", params.span);
        }
        let intensity = narrow(self.amount(params, "I", "power", 1.0 / (4.0 * PI)));
        let Some((source, old)) = image else {
            let position = narrow(ctm.point([0.0; 3]));
            return LightKind::Point { position, amount: PointAmount::Intensity(intensity) };
        };
        // The picture's axes in the light's frame. Version 4: y and z change places. Version 3: longitudes from +x toward +z, +y up.
        let (mapping, axes) = if old {
            (SkyMapping::LatLong, [[0.0, 0.0, -1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]])
        } else {
            (SkyMapping::EqualArea, [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]])
        };
        let transform = ctm.after(&Matrix::rows(axes)).steps();
        LightKind::Goniometric { source, mapping, intensity, transform }
    }

    fn projection(&mut self, params: &Params, ctm: &Matrix) -> Option<LightKind> {
        let Some((source, old)) = self.light_image(params) else {
            let text = format!("{} has no `filename`", params.what);
            self.report.error("missing-parameter", text, params.span);
            return None;
        };
        let fov = params.number_or("fov", 90.0).clamp(0.1, 179.0);
        if params.number("power").is_some_and(|p| p > 0.0) {
            let text = "the power of a projection light does not count what its image holds back";
            self.report.instead(text, "it is that of a square of ones", params.span);
        }
        // The solid angle of a square whose half side is the tangent (that of a rectangle: Ureña et al. 2013, §2).
        let tangent = (fov / 2.0).to_radians().tan();
        let solid = 4.0 * (tangent * tangent / (1.0 + tangent * tangent)).asin();
        let intensity = narrow(self.amount(params, "I", "power", 1.0 / solid));
        // The picture's left is at −x; its first row at +y, in version 3 at −y.
        let up = if old { -1.0 } else { 1.0 };
        let transform = ctm.after(&Matrix::scale([-1.0, up, 1.0])).steps();
        Some(LightKind::Projector { source, fov: fov as f32, intensity, transform })
    }
}
