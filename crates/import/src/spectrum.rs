//! Spectra in every spelling, as linear RGB.
//!
//! pbrt-v4 renders with spectra. An RGB reflectance becomes one that looks like it under the colour space's white, an
//! RGB light that white times the colour, and whatever spectrum a light has is scaled so that its luminance is 1
//! before `scale` and `power` act (pbrt-v4 file format, "Lights"). Rendered in RGB both stay as they are.

use std::path::Path;

use color::{
    blackbody_rgb, emission_to_xyz, luminance_f64, metal_spectra, named_ior, reflectance_to_rgb, xyz_to_rgb,
};

/// The primaries that RGB values refer to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Space {
    #[default]
    Srgb,
    Rec2020,
    DciP3,
    Aces2065,
}

impl Space {
    pub(crate) fn from_name(name: &str) -> Option<Self> {
        match name {
            "srgb" => Some(Self::Srgb),
            "rec2020" => Some(Self::Rec2020),
            "dci-p3" => Some(Self::DciP3),
            "aces2065-1" => Some(Self::Aces2065),
            _ => None,
        }
    }

    /// Linear Rec. 709 of a colour, white to white. The matrices follow from the primaries of ITU-R BT.2020, SMPTE EG
    /// 432-1 (with the white D65) and SMPTE ST 2065-1 (its white adapted by Bradford's method).
    pub(crate) fn to_rgb(self, rgb: [f64; 3]) -> [f64; 3] {
        let m = match self {
            Self::Srgb => return rgb,
            Self::Rec2020 => [
                [1.660_491, -0.587_641, -0.072_850],
                [-0.124_550, 1.132_900, -0.008_349],
                [-0.018_151, -0.100_579, 1.118_730],
            ],
            Self::DciP3 => [
                [1.224_940, -0.224_940, 0.0],
                [-0.042_057, 1.042_057, 0.0],
                [-0.019_638, -0.078_636, 1.098_274],
            ],
            Self::Aces2065 => [
                [2.521_686, -1.134_131, -0.387_555],
                [-0.276_480, 1.372_719, -0.096_239],
                [-0.015_378, -0.152_975, 1.168_354],
            ],
        };
        m.map(|row: [f64; 3]| row[0] * rgb[0] + row[1] * rgb[1] + row[2] * rgb[2])
    }
}

/// A quantity by wavelength in nm.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Curve {
    /// Points in order of their wavelengths; linear between, 0 outside (pbrt-v4's PiecewiseLinearSpectrum).
    Points(Vec<[f64; 2]>),
    /// n of a metal.
    MetalN(String),
    /// k of a metal.
    MetalK(String),
    /// The index of a glass, the same at every wavelength.
    Glass(String),
    /// The chromaticity x, y of a light.
    Light([f64; 2]),
}

impl Curve {
    /// From pairs of wavelength and value; `None` where the wavelengths do not rise.
    pub(crate) fn from_pairs(numbers: &[f64]) -> Option<Self> {
        let points: Vec<[f64; 2]> = numbers.chunks_exact(2).map(|c| [c[0], c[1]]).collect();
        let rises = points.windows(2).all(|p| p[0][0] < p[1][0]);
        (rises && !points.is_empty()).then_some(Self::Points(points))
    }

    /// A spectrum that pbrt knows by name; `None` for a file name.
    pub(crate) fn named(name: &str) -> Option<Self> {
        let light = |xy: [f64; 2]| Some(Self::Light(xy));
        if let Some(metal) = name.strip_prefix("metal-") {
            let (symbol, part) = metal.rsplit_once('-')?;
            let metal = metal_name(symbol).to_owned();
            return match part {
                "eta" => Some(Self::MetalN(metal)),
                "k" => Some(Self::MetalK(metal)),
                _ => None,
            };
        }
        if let Some(glass) = name.strip_prefix("glass-") {
            return Some(Self::Glass(glass.to_owned()));
        }
        // CIE 15:2004, tables T.3 and T.7; ACES: SMPTE ST 2065-1.
        match name {
            "stdillum-A" => light([0.447_58, 0.407_45]),
            "stdillum-D50" => light([0.345_67, 0.358_51]),
            "stdillum-D65" => light([0.312_72, 0.329_03]),
            "illum-acesD60" => light([0.321_68, 0.337_67]),
            "stdillum-F1" => light([0.313_1, 0.337_1]),
            "stdillum-F2" => light([0.372_1, 0.375_1]),
            "stdillum-F3" => light([0.409_1, 0.394_1]),
            "stdillum-F4" => light([0.440_2, 0.403_1]),
            "stdillum-F5" => light([0.313_8, 0.345_2]),
            "stdillum-F6" => light([0.377_9, 0.388_2]),
            "stdillum-F7" => light([0.312_9, 0.329_2]),
            "stdillum-F8" => light([0.345_8, 0.358_6]),
            "stdillum-F9" => light([0.374_1, 0.372_7]),
            "stdillum-F10" => light([0.345_8, 0.358_8]),
            "stdillum-F11" => light([0.380_5, 0.376_9]),
            "stdillum-F12" => light([0.437_0, 0.404_2]),
            _ => None,
        }
    }

    /// From the text of an .spd file: a wavelength and a value a line, `#` begins a comment.
    pub(crate) fn from_file(text: &str) -> Option<Self> {
        let words =
            text.lines().map(|l| l.split('#').next().unwrap_or_default()).flat_map(str::split_whitespace);
        let numbers: Vec<f64> = words.map(|w| w.trim_end_matches(',').parse().ok()).collect::<Option<_>>()?;
        let finite = numbers.iter().all(|x| x.is_finite());
        (finite && numbers.len().is_multiple_of(2)).then(|| Self::from_pairs(&numbers))?
    }

    /// Whether the data behind the name are here.
    pub(crate) fn is_known(&self) -> bool {
        match self {
            Self::MetalN(metal) | Self::MetalK(metal) => metal_spectra(metal).is_some(),
            Self::Glass(_) => self.index().is_some(),
            Self::Points(_) | Self::Light(_) => true,
        }
    }

    /// The value at a wavelength; 1 for lights, which have none here.
    pub(crate) fn at(&self, nm: f64) -> f64 {
        match self {
            Self::Points(points) => {
                let after = points.partition_point(|p| p[0] <= nm);
                match (after.checked_sub(1).map(|i| points[i]), points.get(after)) {
                    (Some(a), Some(b)) => a[1] + (b[1] - a[1]) * (nm - a[0]) / (b[0] - a[0]),
                    (Some(a), None) if a[0] == nm => a[1],
                    _ => 0.0,
                }
            }
            Self::MetalN(metal) => metal_spectra(metal).map_or(1.0, |(n, _)| n.at(nm)),
            Self::MetalK(metal) => metal_spectra(metal).map_or(0.0, |(_, k)| k.at(nm)),
            Self::Glass(_) => self.index().unwrap_or(1.5),
            Self::Light(_) => 1.0,
        }
    }

    fn index(&self) -> Option<f64> {
        let Self::Glass(name) = self else { return None };
        let name = if name == "F5" { "SF5" } else { name };
        named_ior(&format!("N-{name}")).or_else(|| named_ior(name)).map(f64::from)
    }

    /// As the colour of a reflectance, 0..=1.
    pub(crate) fn albedo(&self) -> [f64; 3] {
        reflectance_to_rgb(|nm| self.at(nm)).map(|c| c.clamp(0.0, 1.0))
    }

    /// As the colour of a light, of luminance 1.
    pub(crate) fn light(&self) -> [f64; 3] {
        let xyz = match self {
            Self::Light([x, y]) => [x / y, 1.0, (1.0 - x - y) / y],
            _ => emission_to_xyz(|nm| self.at(nm)),
        };
        let rgb = xyz_to_rgb(xyz).map(|c| c.max(0.0));
        let luminance = luminance_f64(rgb);
        if luminance > 0.0 { rgb.map(|c| c / luminance) } else { [0.0; 3] }
    }

    /// As any quantity by channel: the means over the red, green and blue of the spectrum.
    pub(crate) fn channels(&self) -> [f64; 3] {
        [[600.0, 700.0], [500.0, 600.0], [400.0, 500.0]].map(|[from, to]| {
            let steps = 50;
            (0..steps)
                .map(|i| self.at(from + (to - from) * (f64::from(i) + 0.5) / f64::from(steps)))
                .sum::<f64>()
                / f64::from(steps)
        })
    }

    /// The value at the sodium line, 587.6 nm.
    pub(crate) fn at_sodium(&self) -> f64 {
        self.at(587.6)
    }

    /// Whether the value changes with wavelength in the visible.
    pub(crate) fn varies(&self) -> bool {
        (self.at(400.0) - self.at(700.0)).abs() > 1e-6
    }
}

/// pbrt's symbols that differ from the names here.
fn metal_name(symbol: &str) -> &str {
    if symbol == "CuZn" { "brass" } else { symbol }
}

/// Light of a black body, of luminance 1.
pub(crate) fn blackbody(kelvin: f64) -> [f64; 3] {
    blackbody_rgb(kelvin as f32).map(f64::from)
}

/// Whether a file name looks like one of a spectrum.
pub(crate) fn is_spectrum_file(name: &str) -> bool {
    Path::new(name)
        .extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("spd") || e.eq_ignore_ascii_case("txt"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves() {
        let curve = Curve::from_pairs(&[400.0, 1.0, 500.0, 3.0]).unwrap();
        assert_eq!([399.0, 400.0, 450.0, 500.0, 501.0].map(|nm| curve.at(nm)), [0.0, 1.0, 2.0, 3.0, 0.0]);
        assert!(Curve::from_pairs(&[500.0, 1.0, 400.0, 1.0]).is_none());
        assert_eq!(Curve::from_file("# a\n400 1\n500 3 # b\n"), Some(curve));
        assert_eq!(Curve::from_file("400 one"), None);
        let flat = Curve::from_pairs(&[300.0, 0.25, 900.0, 0.25]).unwrap();
        assert!(flat.albedo().iter().all(|c| (c - 0.25).abs() < 1e-9));
        assert!((luminance_f64(flat.light()) - 1.0).abs() < 1e-12 && !flat.varies());
    }

    #[test]
    fn names() {
        let white = Curve::named("stdillum-D65").unwrap().light();
        assert!(white.iter().all(|c| (c - 1.0).abs() < 2e-3), "{white:?}");
        let warm = Curve::named("stdillum-A").unwrap().light();
        assert!(warm[0] > 1.5 && warm[2] < 0.4, "{warm:?}");
        assert!((Curve::named("glass-BK7").unwrap().at_sodium() - 1.5168).abs() < 1e-4);
        for glass in ["BK7", "BAF10", "FK51A", "LASF9", "F5", "SF10", "SF11"] {
            assert!(Curve::named(&format!("glass-{glass}")).unwrap().is_known(), "{glass}");
        }
        for metal in ["Ag", "Al", "Au", "Cu", "CuZn"] {
            assert!(Curve::named(&format!("metal-{metal}-k")).unwrap().is_known(), "{metal}");
        }
        assert!(!Curve::named("metal-MgO-eta").unwrap().is_known());
        assert_eq!(Curve::named("lamp.spd"), None);
    }

    #[test]
    fn whites_stay_white() {
        for space in [Space::Srgb, Space::Rec2020, Space::DciP3, Space::Aces2065] {
            assert!(space.to_rgb([1.0; 3]).iter().all(|c| (c - 1.0).abs() < 1e-5), "{space:?}");
        }
    }
}
