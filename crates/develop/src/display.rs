use std::sync::Arc;

use color::{Adaptation, Exposure, ViewTransform, WhiteBalance, correlated_temperature};

use crate::{AUTO_DEGREE, Lut, Planes, automatic_exposure, legend, light_of};

/// How a picture is shown.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Display {
    /// How bright.
    pub exposure: Exposure,
    /// What is white.
    pub white_balance: WhiteBalance,
    /// How radiance becomes display colour.
    pub view: ViewTransform,
    /// A look-up table for display colours, applied last.
    pub lut: Option<Arc<Lut>>,
}

/// A [`Display`] whose automatic parts are settled for one picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Settled {
    /// Radiance is multiplied by 2 to this power.
    pub ev: f32,
    /// Whether the picture asked for it; else somebody did.
    pub is_automatic: bool,
    /// Whether an automatic exposure found the picture black; `ev` is then 0.
    pub is_black: bool,
    /// Colour temperature in kelvin of the light that an automatic white balance found.
    pub found_kelvin: Option<f64>,
    adaptation: Adaptation,
    display: Display,
}

impl Display {
    /// Looks at a picture where this leaves something to it.
    pub fn settle(&self, planes: &Planes) -> Settled {
        let (ev, is_automatic, is_black) = match self.exposure {
            Exposure::Ev(ev) => (ev, false, false),
            Exposure::Auto => match automatic_exposure(planes) {
                Some(ev) => (ev, true, false),
                None => (0.0, true, true),
            },
        };
        let light = match self.white_balance {
            WhiteBalance::Auto => light_of(planes),
            WhiteBalance::None | WhiteBalance::Kelvin(_) | WhiteBalance::Illuminant(_) => None,
        };
        Settled {
            ev,
            is_automatic,
            is_black,
            found_kelvin: light.map(correlated_temperature),
            adaptation: light.map_or_else(
                || Adaptation::of(self.white_balance),
                |light| Adaptation::from_rgb(light, AUTO_DEGREE),
            ),
            display: self.clone(),
        }
    }
}

impl Settled {
    /// "exposure −7.8 EV, automatic", and what else is not plain.
    pub fn text(&self) -> String {
        let mut text = match (self.is_black, self.is_automatic) {
            (true, _) => "exposure 0 EV: the picture is black".to_owned(),
            (false, true) => format!("exposure {} EV, automatic", signed(self.ev)),
            (false, false) => format!("exposure {} EV", signed(self.ev)),
        };
        match (self.display.white_balance, self.found_kelvin) {
            (WhiteBalance::None, _) => {}
            (WhiteBalance::Auto, Some(kelvin)) => {
                text += &format!("; white balance automatic (light of some {:.0} K)", round(kelvin));
            }
            (WhiteBalance::Auto, None) => text += "; white balance automatic (nothing to go by)",
            (WhiteBalance::Kelvin(kelvin), _) => text += &format!("; white balance {kelvin} K"),
            (WhiteBalance::Illuminant(light), _) => text += &format!("; white balance {}", light.name()),
        }
        text
    }

    /// What files say of it: names and values.
    pub fn metadata(&self) -> Vec<(String, String)> {
        let automatic = if self.is_automatic { " (automatic)" } else { "" };
        let mut all = vec![("exposure".to_owned(), format!("{} EV{automatic}", self.ev))];
        if self.display.white_balance != WhiteBalance::None {
            all.push(("whiteBalance".to_owned(), self.display.white_balance.text()));
        }
        all.push(("view".to_owned(), self.display.view.name().to_owned()));
        all
    }

    /// sRGB-encoded display colours of all pixels.
    pub fn show(&self, planes: &Planes) -> Vec<[u8; 3]> {
        let shown = |rgb: &[f32; 3]| {
            let colour = self.display.view.apply(self.adaptation.apply(*rgb), self.ev);
            let colour = self.display.lut.as_ref().map_or(colour, |lut| lut.apply(colour));
            // The cast saturates.
            colour.map(|v| (v * 255.0 + 0.5) as u8)
        };
        let mut pixels: Vec<[u8; 3]> = planes.shown().iter().map(shown).collect();
        if self.display.view == ViewTransform::FalseColour {
            legend::draw(&mut pixels, planes.width, planes.height, self.ev);
        }
        pixels
    }
}

/// With a minus sign where it is negative, and no zeros at the end.
fn signed(ev: f32) -> String {
    let ev = if ev == 0.0 { 0.0 } else { ev };
    ev.to_string().replace('-', "−")
}

/// To 50 K.
fn round(kelvin: f64) -> f64 {
    (kelvin / 50.0).round() * 50.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grey(value: f32) -> Planes {
        Planes { width: 8, height: 6, beauty: vec![[value; 3]; 48], ..Planes::default() }
    }

    #[test]
    fn what_is_said() {
        let auto = Display::default();
        assert_eq!(auto.settle(&grey(40.0)).text(), "exposure −7.8 EV, automatic");
        assert_eq!(auto.settle(&grey(0.0)).text(), "exposure 0 EV: the picture is black");
        let fixed = Display {
            exposure: Exposure::Ev(-0.0),
            white_balance: WhiteBalance::Kelvin(3000.0),
            ..Display::default()
        };
        assert_eq!(fixed.settle(&grey(40.0)).text(), "exposure 0 EV; white balance 3000 K");
        let white = Display { white_balance: WhiteBalance::Auto, ..auto };
        assert_eq!(
            white.settle(&grey(40.0)).text(),
            "exposure −7.8 EV, automatic; white balance automatic (light of some 6500 K)"
        );
        assert_eq!(white.settle(&grey(40.0)).metadata().len(), 3);
    }

    #[test]
    fn grey_is_shown_as_the_view_shows_middle_grey() {
        let shown = Display::default().settle(&grey(40.0)).show(&grey(40.0));
        let middle = ViewTransform::default().apply([0.18; 3], 0.0)[1] * 255.0;
        assert!((f32::from(shown[0][1]) - middle).abs() < 3.0, "{shown:?} {middle}");
    }

    #[test]
    fn a_warm_scene_is_balanced_in_part() {
        let lamp = color::blackbody_rgb(2700.0);
        let planes = Planes { beauty: vec![lamp; 48], ..grey(0.0) };
        let spread = |white_balance| {
            let display = Display { white_balance, view: ViewTransform::Srgb, ..Display::default() };
            let [r, _, b] = display.settle(&planes).show(&planes)[0];
            i32::from(r) - i32::from(b)
        };
        let [none, auto, full] =
            [WhiteBalance::None, WhiteBalance::Auto, WhiteBalance::Kelvin(2700.0)].map(spread);
        assert!(full.abs() <= 1 && auto > 15 && auto < none / 2, "{none} {auto} {full}");
    }
}
