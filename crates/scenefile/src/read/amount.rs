//! How much a light gives: radiometric or photometric amounts, with a colour.

use color::{blackbody_rgb, luminance_f64};

use crate::desc::{Triple, WHITE_EFFICACY};
use crate::diagnostic::{Diagnostic, Report};
use crate::reader::Reader;

/// One of the ways to say how much.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Amount {
    /// In each channel, in the unit of the first key.
    Channels(Triple),
    /// By one of the other keys, with the proportions of the channels.
    Scaled { key: &'static str, value: f32, color: Triple },
}

impl Amount {
    /// A total flux in W, the mean over the channels, of a value in W (`power`) or lm.
    pub fn watts(key: &str, value: f32, color: Triple) -> f32 {
        if key == "power" {
            return value;
        }
        let rgb = color.map(f64::from);
        let mean = (rgb[0] + rgb[1] + rgb[2]) / 3.0;
        (f64::from(value) / f64::from(WHITE_EFFICACY) * mean / luminance_f64(rgb)) as f32
    }

    /// The channels of a photometric value: cd, cd/m² or lx to W/sr, W/(sr·m²) or W/m².
    pub fn channels(value: f32, color: Triple) -> Triple {
        let unit = f64::from(value) / (f64::from(WHITE_EFFICACY) * luminance_f64(color.map(f64::from)));
        color.map(|c| (f64::from(c) * unit) as f32)
    }
}

/// An amount by the key `channels` or one of `scaled`, which exclude each other; `None` inside where none of them is given.
pub(super) fn amount(
    report: &mut Report,
    r: &Reader<'_>,
    channels: &str,
    scaled: &[&'static str],
) -> Option<Option<Amount>> {
    let radiometric = r.optional_color(report, channels);
    let values: Vec<(&'static str, Option<Option<f32>>)> =
        scaled.iter().map(|&key| (key, r.optional_number(report, key))).collect();
    let color = color(report, r);
    let mut given = [channels].into_iter().chain(scaled.iter().copied()).filter_map(|key| r.given(key));
    let (first, second) = (given.next(), given.next());
    if let (Some(a), Some(b)) = (first, second) {
        r.conflict(report, a, b);
        return None;
    }
    let by_value = scaled.iter().any(|key| r.given(key).is_some());
    if let (Some(entry), false) = (r.given("color").or(r.given("temperature")), by_value) {
        let message = format!("`{}` without {} in {}", entry.key, either(scaled), r.what);
        let help = match r.given(channels) {
            Some(_) => format!("write the colour into `{channels}`"),
            None if channels == "radiance" && entry.key == "color" => {
                "the colour of a surface belongs to its material".to_owned()
            }
            None => format!("give the amount as {}", either(scaled)),
        };
        report.push(Diagnostic::error("conflict", message).at(entry.key_span).help(help));
        return None;
    }
    let color = color?;
    if let Some(rgb) = radiometric? {
        return Some(Some(Amount::Channels(rgb)));
    }
    for (key, value) in values {
        if let Some(value) = value? {
            return Some(Some(Amount::Scaled { key, value, color }));
        }
    }
    Some(None)
}

/// `color` or `temperature`; white where neither is given.
pub(super) fn color(report: &mut Report, r: &Reader<'_>) -> Option<Triple> {
    let color = r.optional_color(report, "color");
    let kelvin = r.optional_number(report, "temperature");
    if let (Some(a), Some(b)) = (r.given("color"), r.given("temperature")) {
        r.conflict(report, a, b);
        return None;
    }
    if let (Some(entry), Some(Some([0.0, 0.0, 0.0]))) = (r.given("color"), color) {
        let message = format!("{} is black: it cannot be scaled to an amount", r.label("color"));
        report.push(Diagnostic::error("out-of-range", message).at(entry.node.span));
        return None;
    }
    Some(match (color?, kelvin?) {
        (Some(rgb), _) => rgb,
        (None, Some(kelvin)) => blackbody_rgb(kelvin),
        (None, None) => [1.0; 3],
    })
}

/// `a`, `b` or `c`.
pub(super) fn either(keys: &[&str]) -> String {
    let quoted: Vec<String> = keys.iter().map(|key| format!("`{key}`")).collect();
    match quoted.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} or {last}", rest.join(", ")),
        _ => quoted.concat(),
    }
}
