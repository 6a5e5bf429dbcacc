//! Colours in every spelling, as an RGB renderer reads them.
//!
//! Mitsuba's RGB mode turns a curve into linear Rec. 709 as soon as it is read: of a reflectance the colour under D65, of
//! a light that of the light itself, where the same at every wavelength is not white. A single number is grey in either
//! place (Mitsuba 0.6, and the usual reading of files that were rendered in RGB).

use color::{emission_to_xyz, reflectance_to_rgb, xyz_to_rgb};
use scenefile::Span;

use super::Importer;
use super::build::numbers;
use super::plugin::{Plugin, Value};
use super::xml::Node;
use crate::file;
use crate::spectrum::Curve;

/// Bytes of an .spd file, at most.
const MOST_SPD: u64 = 4 << 20;

/// A colour or quantity by wavelength.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Spectrum {
    /// Linear Rec. 709.
    Rgb([f64; 3]),
    /// The same at every wavelength.
    Flat(f64),
    /// By wavelength.
    Curve(Curve),
    /// Radiance of a black body in W/(m²·sr·nm), times `scale`.
    BlackBody { kelvin: f64, scale: f64 },
}

impl Spectrum {
    /// As a reflectance; may leave 0..=1.
    pub(super) fn reflectance(&self) -> [f64; 3] {
        match self {
            Self::Rgb(rgb) => *rgb,
            Self::Flat(x) => [*x; 3],
            Self::Curve(curve) => reflectance_to_rgb(|nm| curve.at(nm)),
            Self::BlackBody { .. } => self.light(),
        }
    }

    /// As what a light emits.
    pub(super) fn light(&self) -> [f64; 3] {
        let of = |f: &dyn Fn(f64) -> f64| {
            let all = emission_to_xyz(|_| 1.0)[1];
            xyz_to_rgb(emission_to_xyz(f).map(|x| x / all))
        };
        match self {
            Self::Rgb(rgb) => *rgb,
            Self::Flat(x) => [*x; 3],
            Self::Curve(curve) => of(&|nm| curve.at(nm)),
            Self::BlackBody { kelvin, scale } => of(&|nm| scale * planck(*kelvin, nm)),
        }
    }

    /// As an index or coefficient by channel: a curve as if it were light.
    pub(super) fn channels(&self) -> [f64; 3] {
        self.light()
    }
}

/// Planck's law: W/(m²·sr·nm) at a wavelength in nm.
fn planck(kelvin: f64, nm: f64) -> f64 {
    // 2hc² in W·nm⁴/(m²·sr) and hc/k in nm·K (CODATA 2018).
    const C1: f64 = 1.191_042_972e20;
    const C2: f64 = 1.438_776_877e7;
    C1 / nm.powi(5) / (C2 / (nm * kelvin)).exp_m1()
}

impl Importer {
    /// The value of <rgb>, <srgb>, <blackbody> or a <spectrum> without type.
    pub(super) fn spectrum(&mut self, node: &Node) -> Option<Spectrum> {
        let known =
            ["name", "value", "filename", "intent", "unit", "id", "temperature", "scale", "multiplier"];
        self.known_attributes(node, &known);
        if node.tag == "blackbody" {
            let text = self.required(node, "temperature")?;
            let number = |text: &str| numbers(text.trim_end_matches(['K', 'k']))?.first().copied();
            let factor = node.text("scale").or(node.text("multiplier")).and_then(number).unwrap_or(1.0);
            return match number(&text) {
                Some(kelvin) if kelvin > 0.0 => Some(Spectrum::BlackBody { kelvin, scale: factor }),
                _ => self.malformed(&text, "temperature", node.span),
            };
        }
        if node.tag == "spectrum"
            && let Some(name) = node.attribute("filename")
        {
            return self.spectrum_file(&name.value, name.span);
        }
        let value = self.required(node, "value")?;
        let span = node.attribute("value").map_or(node.span, |a| a.span);
        let decode = |c: f64| f64::from(color::srgb_to_linear(c as f32));
        let encoded = node.tag == "srgb";
        if let Some(hex) = value.trim().strip_prefix('#').filter(|_| node.tag != "spectrum") {
            let digits = (hex.len() == 6).then(|| u32::from_str_radix(hex, 16).ok()).flatten();
            let Some(bits) = digits else { return self.malformed(&value, "colour #rrggbb", span) };
            let rgb = [16, 8, 0].map(|shift| f64::from(bits >> shift & 255) / 255.0);
            return Some(Spectrum::Rgb(if encoded { rgb.map(decode) } else { rgb }));
        }
        if node.tag == "spectrum" && value.contains(':') {
            let pairs = value.replace(':', " ");
            let curve = numbers(&pairs).filter(|n| n.len() % 2 == 0).and_then(|n| Curve::from_pairs(&n));
            return match curve {
                Some(curve) => Some(Spectrum::Curve(curve)),
                None => self.malformed(&value, "list of rising wavelengths and their values", span),
            };
        }
        match numbers(&value).as_deref() {
            Some([x]) if encoded => Some(Spectrum::Rgb([decode(*x); 3])),
            Some([x]) => Some(Spectrum::Flat(*x)),
            Some([r, g, b]) if encoded => Some(Spectrum::Rgb([*r, *g, *b].map(decode))),
            Some([r, g, b]) => Some(Spectrum::Rgb([*r, *g, *b])),
            _ => self.malformed(&value, "colour", span),
        }
    }

    fn spectrum_file(&mut self, name: &str, span: Span) -> Option<Spectrum> {
        let path = self.base.join(self.find_file(name));
        let read = file::read(&path, MOST_SPD);
        let curve = match &read {
            Ok(bytes) => Curve::from_file(&String::from_utf8_lossy(bytes)),
            Err(reason) => {
                self.report.error("missing-file", format!("the spectrum {name} {reason}"), span);
                return None;
            }
        };
        if curve.is_none() {
            let text = format!("{name} is no list of rising wavelengths and their values");
            self.report.error("spectrum", text, span);
        }
        curve.map(Spectrum::Curve)
    }

    /// The colour that a plugin of a spectrum's type is; `None` where it is another texture.
    pub(super) fn spectrum_plugin(&mut self, plugin: &Plugin) -> Option<Spectrum> {
        let report = &mut self.report;
        let made = match plugin.kind.as_str() {
            "uniform" | "rawconstant" => match plugin.find("value").map(|p| &p.value) {
                Some(Value::Triple(rgb)) => Spectrum::Rgb(*rgb),
                Some(Value::Color(color)) => color.clone(),
                _ => Spectrum::Flat(plugin.number_or(report, "value", 1.0)),
            },
            "srgb" | "srgb_d65" | "d65" => {
                let scale = plugin.number_or(report, "scale", 1.0);
                let rgb = match plugin.find_any(&["color", "value"]).map(|p| &p.value) {
                    Some(Value::Color(color)) => color.reflectance(),
                    Some(Value::Triple(rgb)) => *rgb,
                    Some(Value::Number(x)) => [*x; 3],
                    _ => [1.0; 3],
                };
                Spectrum::Rgb(rgb.map(|c| c * scale))
            }
            "blackbody" => {
                let kelvin = plugin.positive(report, "temperature", 5000.0);
                let scale = plugin.number_or(report, "scale", 1.0);
                plugin.ignore(&["wavelength_min", "wavelength_max"]);
                Spectrum::BlackBody { kelvin, scale }
            }
            "regular" | "irregular" => {
                let list = |report: &mut _, name: &str| {
                    plugin.text(report, name).and_then(numbers).unwrap_or_default()
                };
                let values = list(report, "values");
                let wavelengths = if plugin.kind == "irregular" {
                    list(report, "wavelengths")
                } else {
                    let from = plugin.find_any(&["wavelength_min", "lambda_min"]).map(|p| p.name.clone());
                    let to = plugin.find_any(&["wavelength_max", "lambda_max"]).map(|p| p.name.clone());
                    let from = from.map_or(360.0, |name| plugin.number_or(report, &name, 360.0));
                    let to = to.map_or(830.0, |name| plugin.number_or(report, &name, 830.0));
                    let steps = values.len().saturating_sub(1).max(1) as f64;
                    (0..values.len()).map(|i| from + (to - from) * i as f64 / steps).collect()
                };
                let pairs: Vec<f64> = wavelengths.iter().zip(&values).flat_map(|(w, v)| [*w, *v]).collect();
                let fits = wavelengths.len() == values.len();
                match Curve::from_pairs(&pairs).filter(|_| fits) {
                    Some(curve) => Spectrum::Curve(curve),
                    None => {
                        let text = format!("{} is no list of rising wavelengths and values", plugin.what());
                        report.error("spectrum", text, plugin.span);
                        Spectrum::Flat(0.5)
                    }
                }
            }
            _ => return None,
        };
        plugin.finish(&mut self.report);
        Some(made)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(a: [f64; 3], b: [f64; 3]) {
        assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 4e-3 * b.abs().max(0.5)), "{a:?} {b:?}");
    }

    /// What Mitsuba 3.9's RGB mode makes of the same curves.
    #[test]
    fn curves_are_read_as_mitsuba_does() {
        let curve = |pairs: &[f64]| Spectrum::Curve(Curve::from_pairs(pairs).unwrap());
        let lamp = curve(&[400.0, 0.0, 500.0, 8.0, 600.0, 15.6, 700.0, 18.4]);
        near(lamp.light(), [20.7108, 10.8546, 2.77115]);
        let paint = curve(&[400.0, 0.1, 500.0, 0.9, 700.0, 0.3]);
        near(paint.reflectance(), [0.4394, 0.813293, 0.504598]);
        near(paint.light(), [0.559423, 0.773073, 0.444754]);
        near(curve(&[400.0, 1.0, 700.0, 1.0]).light(), [1.19969, 0.94952, 0.903443]);
        assert_eq!(Spectrum::Flat(2.0).light(), [2.0; 3]);
    }

    #[test]
    fn black_bodies_have_their_radiance() {
        // 2hc²/λ⁵/(e^(hc/λkT) − 1) at 5000 K and 500 nm is 1.212·10¹³ W/(m³·sr).
        assert!((planck(5000.0, 500.0) / 1.2117e4 - 1.0).abs() < 1e-3);
        let [r, g, b] = Spectrum::BlackBody { kelvin: 3000.0, scale: 1.0 }.light();
        assert!(r > g && g > b && b > 0.0);
    }
}
