//! Lights.
//!
//! In pbrt-v4 whatever spectrum a light has is first scaled to luminance 1 (RGB: such that white has it), then
//! multiplied by `scale`; `power` and `illuminance` set the total instead.

use std::f64::consts::PI;
use std::rc::Rc;

use scenefile::desc::{Emission, EmissionAmount, Light, LightKind, PointAmount};
use scenefile::{Diagnostic, Sourced, Span};

use super::Importer;
use super::params::Params;
use crate::matrix::{narrow, sub, times};

impl Importer {
    /// Colour times scale and the film's gain. `unit`: what a total of 1 makes of it, for the parameter `total`.
    fn amount(&mut self, params: &Params, color: &str, total: &str, unit: f64) -> [f64; 3] {
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
        rgb
    }

    pub(super) fn light(&mut self, kind: &str, at: Span, params: &Params) {
        let ctm = self.mirror.after(&self.graphics.ctm);
        let from = params.point("from").unwrap_or([0.0; 3]);
        let to = params.point("to").unwrap_or([0.0, 0.0, 1.0]);
        let toward = narrow(ctm.vector(sub(to, from)));
        let position = narrow(ctm.point(from));
        let light = match kind {
            "point" | "goniometric" => {
                if kind == "goniometric" {
                    let text = "the distribution of a goniometric light is not rendered";
                    self.report.instead(text, "it shines the same in every direction", params.span);
                    params.ignore(&["filename", "mapname"]);
                }
                let intensity = self.amount(params, "I", "power", 1.0 / (4.0 * PI));
                LightKind::Point { position, amount: PointAmount::Intensity(narrow(intensity)) }
            }
            "spot" => {
                let cone = params.number_or("coneangle", 30.0).clamp(0.01, 180.0);
                let delta = params.number_or("conedeltaangle", 5.0).clamp(0.0, cone);
                let [end, start] = [cone, cone - delta].map(|a| a.to_radians().cos());
                let unit = 1.0 / (2.0 * PI * ((1.0 - start) + (start - end) / 2.0));
                let intensity = self.amount(params, "I", "power", unit);
                LightKind::Spot {
                    position,
                    direction: toward,
                    cone_angle: cone as f32,
                    falloff_angle: delta as f32,
                    amount: PointAmount::Intensity(narrow(intensity)),
                }
            }
            "projection" => {
                let text = "the image of a projection light is not rendered";
                self.report.instead(text, "a spot of its angle shines in white", params.span);
                params.ignore(&["filename", "mapname"]);
                let fov = params.number_or("fov", 90.0).clamp(0.1, 179.0);
                let unit = 1.0 / (2.0 * PI * (1.0 - (fov / 2.0).to_radians().cos()));
                let intensity = self.amount(params, "I", "power", unit);
                LightKind::Spot {
                    position: narrow(ctm.point([0.0; 3])),
                    direction: narrow(ctm.vector([0.0, 0.0, 1.0])),
                    cone_angle: (fov / 2.0) as f32,
                    falloff_angle: 0.0,
                    amount: PointAmount::Intensity(narrow(intensity)),
                }
            }
            "distant" => {
                let irradiance = narrow(self.amount(params, "L", "illuminance", 1.0));
                LightKind::Directional { direction: toward, irradiance }
            }
            "infinite" | "exinfinite" => {
                if let Some(file) = params.any("filename").or(params.any("mapname")) {
                    let text = "the image of an infinite light is not rendered";
                    self.report.instead(text, "it shines in its mean colour, taken as white", file.span);
                }
                if let Some(portal) = params.any("portal") {
                    let text = "portals guide no light here";
                    self.report.instead(text, "the whole surroundings shine", portal.span);
                }
                params.ignore(&["nsamples"]);
                LightKind::Environment { radiance: narrow(self.amount(params, "L", "illuminance", 1.0 / PI)) }
            }
            _ => {
                self.report.error("unknown-kind", format!("there is no light `{kind}`"), at);
                return;
            }
        };
        params.ignore(&["samples"]);
        if self.object.is_some() {
            self.report.instead(
                "a light within an object",
                "it shines once, where it stands in the file",
                params.span,
            );
        }
        self.desc.lights.push(Sourced::at(Light::from(light), params.span));
    }

    pub(super) fn area_light(&mut self, kind: &str, at: Span, params: Params) {
        if !matches!(kind, "diffuse" | "area") {
            self.report
                .push(Diagnostic::error("unknown-kind", format!("there is no area light `{kind}`")).at(at));
        }
        if let Some(file) = params.any("filename") {
            let text = "the image of an area light is not rendered";
            self.report.instead(text, "it shines in one colour", file.span);
        }
        params.ignore(&["samples", "nsamples", "L", "scale", "twosided", "power"]);
        params.finish(&mut self.report);
        self.graphics.area_light = Some(Rc::new(params));
    }

    /// The emission of a shape, if an area light is in force and the shape is one that may shine.
    pub(super) fn emission(&mut self, shape: Span) -> Option<Sourced<Emission>> {
        let params = self.graphics.area_light.clone()?;
        if self.object.is_some() {
            let text = "shapes of objects do not shine in pbrt";
            self.report.instead(text, "they are dark", shape);
            return None;
        }
        let two_sided = params.truth("twosided").unwrap_or(false);
        let rgb = self.amount(&params, "L", "power", 1.0);
        let amount = if params.number("power").is_some_and(|p| p > 0.0) {
            // The flux of each channel; its mean and its proportions.
            let watts = rgb.iter().sum::<f64>() / 3.0;
            if watts <= 0.0 {
                return None;
            }
            EmissionAmount::Power { watts: watts as f32, color: narrow(times(rgb, 1.0 / watts)) }
        } else {
            EmissionAmount::Radiance(narrow(rgb))
        };
        Some(Sourced::at(Emission { amount, texture: None, two_sided }, params.span))
    }
}
