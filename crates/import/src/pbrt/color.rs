//! Colours, numbers and indices of parameters: constants, spectra of every spelling, textures.

use color::emission_to_xyz;
use scenefile::desc::{ColorDesc, FloatDesc};
use scenefile::{Diagnostic, Span};

use super::Importer;
use super::params::{Param, Params, Values};
use crate::file;
use crate::matrix::narrow;
use crate::spectrum::{Curve, blackbody, is_spectrum_file};

/// Bytes of an .spd file, at most.
const MOST_SPD: u64 = 4 << 20;

/// Types of parameters that hold a spectrum.
pub(super) const SPECTRA: [&str; 4] = ["rgb", "spectrum", "blackbody", "xyz"];

impl Importer {
    /// The curve of a `spectrum` parameter; what is wrong with it is reported.
    pub(super) fn curve(&mut self, param: &Param) -> Option<Curve> {
        let fail = |this: &mut Self, text: String| {
            this.report.error("spectrum", text, param.span);
            None
        };
        let name = match &param.values {
            Values::Numbers(numbers) => {
                return match Curve::from_pairs(numbers) {
                    Some(curve) => Some(curve),
                    None => fail(self, format!("the wavelengths of `{}` do not rise", param.name)),
                };
            }
            Values::Texts(texts) => texts.first().cloned().unwrap_or_default(),
            Values::Truths(_) => return None,
        };
        if let Some(curve) = Curve::named(&name) {
            if !curve.is_known() {
                let text = format!("there are no data of the spectrum `{name}`");
                self.report.instead(text, "it is 1.5 for an index, else that of chromium", param.span);
                return Curve::named(&match name.rsplit_once('-') {
                    Some((_, part)) => format!("metal-Cr-{part}"),
                    None => name,
                })
                .or_else(|| Curve::from_pairs(&[300.0, 1.5, 900.0, 1.5]));
            }
            return Some(curve);
        }
        let path = self.base.join(self.find_file(&name));
        if !is_spectrum_file(&name) && !path.exists() {
            return fail(self, format!("no spectrum is named `{name}`"));
        }
        let text = match file::read(&path, MOST_SPD) {
            Ok(bytes) => String::from_utf8_lossy(&bytes).into_owned(),
            Err(reason) => return fail(self, format!("the spectrum file `{name}` {reason}")),
        };
        match Curve::from_file(&text) {
            Some(curve) => Some(curve),
            None => fail(self, format!("`{name}` is no list of rising wavelengths and values")),
        }
    }

    /// RGB of a spectrum with a meaning: `of_curve` says which for curves.
    fn triple(
        &mut self,
        params: &Params,
        param: &Param,
        of_curve: fn(&Curve) -> [f64; 3],
    ) -> Option<[f64; 3]> {
        match param.kind {
            "rgb" => param.triple().map(|rgb| params.space.to_rgb(rgb)),
            "xyz" => param.triple().map(color::xyz_to_rgb),
            "blackbody" => {
                let n = param.numbers();
                n.first().map(|kelvin| blackbody(*kelvin).map(|c| c * n.get(1).unwrap_or(&1.0)))
            }
            _ => self.curve(param).map(|curve| of_curve(&curve)),
        }
    }

    /// The colour of a light before its scale: `None` where the parameter is absent. Version 3 takes spectra at the size that they have.
    pub(super) fn light_color(&mut self, params: &Params, name: &str) -> Option<[f64; 3]> {
        let param = params.find(name, &SPECTRA)?;
        let mut rgb = self.triple(params, param, Curve::light)?;
        if self.is_version_3 {
            let brightness = match param.kind {
                // Its greatest value is 1.
                "blackbody" => param.numbers().first().map_or(1.0, |kelvin| blackbody_luminance(*kelvin)),
                "spectrum" => self.curve(param).map_or(1.0, |curve| luminance(|nm| curve.at(nm))),
                _ => 1.0,
            };
            rgb = rgb.map(|c| c * brightness);
        }
        if rgb.iter().any(|c| *c < 0.0) {
            let text = format!("a colour of {} lies outside Rec. 709", params.what);
            self.report.instead(text, "its negative channels are 0", param.span);
        }
        Some(rgb.map(|c| c.max(0.0)))
    }

    /// A reflectance or the like, 0..=1 in each channel; `None` where the parameter is absent.
    pub(super) fn albedo(&mut self, params: &Params, name: &str) -> Option<ColorDesc> {
        if let Some(param) = params.find(name, &["texture"]) {
            return Some(match self.color_texture(param) {
                // A constant one, as large as its author liked.
                ColorDesc::Rgb(rgb) => {
                    ColorDesc::Rgb(self.within_one(rgb.map(f64::from), params, param.span))
                }
                texture => texture,
            });
        }
        let rgb = self.unbounded(params, name)?;
        let span = params.any(name).map_or(params.span, |param| param.span);
        Some(ColorDesc::Rgb(self.within_one(rgb, params, span)))
    }

    /// The same without textures and of any size.
    pub(super) fn unbounded(&mut self, params: &Params, name: &str) -> Option<[f64; 3]> {
        let param = params.find(name, &[&SPECTRA[..], &["float"]].concat())?;
        match param.kind {
            "float" => param.numbers().first().map(|x| [*x; 3]),
            _ => self.triple(params, param, Curve::albedo),
        }
    }

    /// Moved into 0..=1; that changes what is rendered if it is off by more than rounding.
    pub(super) fn within_one(&mut self, rgb: [f64; 3], params: &Params, span: Span) -> [f32; 3] {
        if rgb.iter().any(|c| !(-1e-3..=1.001).contains(c)) {
            let text = format!("a colour of {} is not within 0 and 1", params.what);
            self.report.instead(text, "it is moved there", span);
        }
        narrow(rgb.map(|c| c.clamp(0.0, 1.0)))
    }

    /// A quantity by channel, like the index of a metal.
    pub(super) fn channels(&mut self, params: &Params, name: &str) -> Option<[f64; 3]> {
        let param = params.find(name, &[&SPECTRA[..], &["float"]].concat())?;
        match param.kind {
            "float" => param.numbers().first().map(|x| [*x; 3]),
            _ => self.triple(params, param, Curve::channels),
        }
    }

    /// A number or a texture of numbers; `None` where the parameter is absent.
    pub(super) fn float(&mut self, params: &Params, name: &str) -> Option<FloatDesc> {
        if let Some(param) = params.find(name, &["texture"]) {
            return Some(self.float_texture(param));
        }
        params.number(name).map(|x| FloatDesc::Value(x as f32))
    }

    /// The refractive index by any of the names; a spectrum gives that at the sodium line.
    pub(super) fn index(&mut self, params: &Params, names: &[&str], default: f64) -> f32 {
        let Some(param) = names.iter().find_map(|name| params.any(name)) else { return default as f32 };
        let value = match param.kind {
            "float" | "integer" => param.numbers().first().copied(),
            "spectrum" => self.curve(param).map(|curve| {
                if curve.varies() {
                    let text = "dispersion is not rendered";
                    self.report.instead(text, "the index is that of 587.6 nm", param.span);
                }
                curve.at_sodium()
            }),
            _ => None,
        };
        match value {
            Some(n) if (1.0..=10.0).contains(&n) => n as f32,
            // From inside of something denser.
            Some(n) if (0.1..1.0).contains(&n) => {
                let text = format!("an index below 1 in {} is not rendered", params.what);
                self.report.instead(text, "its reciprocal takes its place", param.span);
                (1.0 / n) as f32
            }
            _ => {
                let text = format!("`{}` of {} is no refractive index", param.name, params.what);
                self.report.push(Diagnostic::error("out-of-range", text).at(param.span));
                default as f32
            }
        }
    }
}

/// Luminance of a light, 1 for a spectrum of ones.
fn luminance(spectrum: impl Fn(f64) -> f64) -> f64 {
    emission_to_xyz(spectrum)[1] / emission_to_xyz(|_| 1.0)[1]
}

/// Luminance of a black body whose greatest value by wavelength is 1 (pbrt-v3's).
fn blackbody_luminance(kelvin: f64) -> f64 {
    let kelvin = kelvin.clamp(500.0, 1e6);
    // Planck 1901, and Wien's displacement law; constants of CODATA 2018.
    let planck = |nm: f64| (nm / 560.0).powi(-5) / (1.438_776_877e7 / (nm * kelvin)).exp_m1();
    let greatest = planck(2.897_771_955e6 / kelvin);
    luminance(|nm| planck(nm) / greatest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn version_3_takes_spectra_as_they_are() {
        assert!((luminance(|_| 7.0) - 7.0).abs() < 1e-9);
        // At 5200 K the greatest value lies where the eye is most sensitive; hotter or colder bodies are darker to it.
        let at = [2000.0, 5200.0, 20_000.0].map(blackbody_luminance);
        assert!(at[1] > 0.97 && at[1] < 1.0 && at[0] < 0.4 && at[2] < 0.4, "{at:?}");
    }
}
