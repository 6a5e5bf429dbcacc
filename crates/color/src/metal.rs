use crate::metal_data::{METALS, Metal, SAMPLES};
use crate::spectrum::channel_means;
use crate::{plain_name, reflectance_to_rgb};

/// First wavelength of the tables of metals, in nanometres.
const START_NM: f64 = 380.0;
/// Distance of their wavelengths.
const STEP_NM: f64 = 10.0;

/// A quantity by wavelength: values at 380, 390 … 730 nm, linear between, constant outside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spectrum([f32; SAMPLES]);

impl Spectrum {
    /// The value at a wavelength in nanometres.
    pub fn at(&self, nm: f64) -> f64 {
        let place = ((nm - START_NM) / STEP_NM).clamp(0.0, (SAMPLES - 1) as f64);
        let i = (place as usize).min(SAMPLES - 2);
        let (a, b) = (f64::from(self.0[i]), f64::from(self.0[i + 1]));
        a + (b - a) * (place - i as f64)
    }
}

/// Names of the measured metals, in alphabetical order; their chemical symbols are known as well.
pub fn metal_names() -> impl Iterator<Item = &'static str> {
    METALS.iter().map(|m| m.name)
}

/// Measured n(λ) and k(λ) of a metal, by English name or chemical symbol (brass: 70 % copper, 30 % zinc).
pub fn metal_spectra(name: &str) -> Option<(Spectrum, Spectrum)> {
    find(name).map(|m| (Spectrum(m.n), Spectrum(m.k)))
}

/// A metal's n and k for linear red, green and blue, such that the reflectance at normal incidence is that of the
/// spectral metal under D65 (see [`metal_spectra`] for names).
///
/// n of a channel is the mean of n(λ) with the positive part of the channel's response under D65 as weight; k then
/// follows from the reflectance R = ((n − 1)² + k²)/((n + 1)² + k²), which is matched exactly where R lies below the
/// metal's greatest spectral reflectance and is limited to that elsewhere: gold, outside Rec. 709, is 6 % too dark in
/// red, tungsten 1 %.
pub fn named_metal(name: &str) -> Option<([f32; 3], [f32; 3])> {
    let (n, k) = metal_spectra(name)?;
    let spectral = |nm: f64| normal_reflectance(n.at(nm), k.at(nm));
    let greatest = (0..SAMPLES).map(|i| spectral(START_NM + STEP_NM * i as f64)).fold(0.0, f64::max);
    let target = reflectance_to_rgb(spectral).map(|r| r.clamp(0.0, greatest));
    let means = channel_means(|nm| n.at(nm));
    let (mut n_rgb, mut k_rgb) = ([0.0; 3], [0.0; 3]);
    for c in 0..3 {
        let r = target[c];
        // With k = 0, R is matched by (1 ± √R)/(1 ∓ √R): n outside of these needs an imaginary k.
        let root = r.sqrt();
        let n = means[c].clamp((1.0 - root) / (1.0 + root), (1.0 + root) / (1.0 - root));
        let k2 = (r * (n + 1.0) * (n + 1.0) - (n - 1.0) * (n - 1.0)) / (1.0 - r);
        n_rgb[c] = n as f32;
        k_rgb[c] = k2.max(0.0).sqrt() as f32;
    }
    Some((n_rgb, k_rgb))
}

/// Reflectance of a conductor in vacuum at normal incidence (Born & Wolf, *Principles of Optics*, 14.2).
pub fn normal_reflectance(n: f64, k: f64) -> f64 {
    ((n - 1.0) * (n - 1.0) + k * k) / ((n + 1.0) * (n + 1.0) + k * k)
}

fn find(name: &str) -> Option<&'static Metal> {
    let wanted = plain_name(name);
    METALS.iter().find(|m| m.name == wanted || m.symbol.eq_ignore_ascii_case(&wanted))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Reflectance in linear Rec. 709 under D65, integrated at 1 nm from the measured points by another program.
    const REFLECTANCES: [(&str, [f64; 3]); 14] = [
        ("aluminium", [0.9073, 0.9159, 0.9223]),
        ("brass", [0.9097, 0.7782, 0.4228]),
        ("chromium", [0.5496, 0.5560, 0.5542]),
        ("cobalt", [0.6830, 0.6552, 0.6160]),
        ("copper", [0.9317, 0.6226, 0.5223]),
        ("gold", [1.0376, 0.7283, 0.3646]),
        ("iron", [0.5297, 0.5132, 0.4942]),
        ("mercury", [0.7814, 0.7795, 0.7784]),
        ("nickel", [0.6971, 0.6405, 0.5633]),
        ("platinum", [0.6779, 0.6377, 0.5836]),
        ("silver", [0.9900, 0.9875, 0.9791]),
        ("titanium", [0.6186, 0.5794, 0.5425]),
        ("tungsten", [0.5185, 0.4939, 0.4689]),
        ("zinc", [0.8752, 0.8689, 0.8551]),
    ];

    #[test]
    fn reflectance_matches_the_spectral_metal() {
        assert_eq!(metal_names().collect::<Vec<_>>(), REFLECTANCES.map(|r| r.0));
        for (name, expected) in REFLECTANCES {
            let (n, k) = named_metal(name).unwrap();
            for c in 0..3 {
                let found = normal_reflectance(f64::from(n[c]), f64::from(k[c]));
                let limit = if (name, c) == ("gold", 0) { 0.065 } else { 0.01 };
                let error = (found / expected[c] - 1.0).abs();
                assert!(error < limit, "{name} {c}: {found} {}", expected[c]);
            }
        }
    }

    #[test]
    fn names_and_symbols() {
        assert_eq!(named_metal("Au"), named_metal("gold"));
        assert_eq!(named_metal("Silver"), named_metal("ag"));
        assert!(named_metal("wood").is_none());
        let (n, k) = metal_spectra("Au").unwrap();
        // Johnson & Christy 1972 at 2.13 eV (582.1 nm): n = 0.29, k = 2.863.
        assert!((n.at(582.1) - 0.29).abs() < 0.02 && (k.at(582.1) - 2.863).abs() < 0.03);
        assert_eq!((n.at(100.0), n.at(5000.0)), (n.at(380.0), n.at(730.0)));
    }
}
