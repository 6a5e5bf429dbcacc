//! What scatters light inside: skin, wax and hair, approximately.

use scenefile::desc::{CoatedDiffuse, ColorDesc, Facets, Material, MaterialKind};

use super::Importer;
use super::params::Params;
use super::roughness::Remap;
use super::textures::grey;
use crate::matrix::narrow;

/// pbrt's default medium, skimmed milk: absorption and scattering by channel in 1/mm (Jensen et al. 2001, table 1).
pub(super) const MILK: [[f64; 3]; 2] = [[0.0011, 0.0024, 0.014], [2.55, 3.21, 3.77]];

impl Importer {
    /// A diffuse base of the medium's own albedo under a coat.
    pub(super) fn subsurface(&mut self, params: &Params) -> Material {
        params.ignore(&["mfp", "g", "Kr", "Kt", "scale"]);
        let text = "light is not scattered below a surface";
        self.report.instead(text, "a diffuse base under a coat takes its place", params.span);
        let color = match self.albedo(params, "reflectance").or(self.albedo(params, "Kd")) {
            Some(color) => color,
            None => {
                params.ignore(&["name", "preset"]);
                let [absorbed, scattered] = [("sigma_a", MILK[0]), ("sigma_s", MILK[1])]
                    .map(|(name, default)| self.channels(params, name).unwrap_or(default));
                let albedo = [0, 1, 2].map(|i| diffuse_albedo(absorbed[i], scattered[i]));
                ColorDesc::Rgb(narrow(albedo))
            }
        };
        CoatedDiffuse {
            color,
            ior: self.index(params, &["eta"], 1.33).into(),
            roughness: self.roughness(params, "", Remap::Root, 0.0),
            facets: Facets::SingleBounce,
            ..CoatedDiffuse::default()
        }
        .into()
    }

    /// Fibres that reflect and let pass diffusely what hair of that colour scatters.
    pub(super) fn hair(&mut self, params: &Params) -> Material {
        let text = "the material `hair` is not rendered";
        self.report.instead(text, "its fibres are diffuse", params.span);
        params.ignore(&["eta", "beta_m", "alpha"]);
        let across = params.number_or("beta_n", 0.3);
        let color = match self.albedo(params, "color").or(self.albedo(params, "reflectance")) {
            Some(color) => color,
            None => {
                let [dark, red] = ["eumelanin", "pheomelanin"].map(|name| params.number(name));
                let absorbed = self.channels(params, "sigma_a").unwrap_or_else(|| match (dark, red) {
                    (None, None) => melanin(1.3, 0.0),
                    _ => melanin(dark.unwrap_or(0.0), red.unwrap_or(0.0)),
                });
                ColorDesc::Rgb(narrow(absorbed.map(|sigma| hair_color(sigma, across))))
            }
        };
        // Half of it each way.
        let half = self.product("hair", color, grey(0.5.into()), params.span);
        MaterialKind::DiffuseTransmission { reflectance: half.clone(), transmittance: half }.into()
    }
}

/// Absorption by hair's pigments in 1/(mean radius) (d'Eon et al. 2011).
fn melanin(dark: f64, red: f64) -> [f64; 3] {
    [(0.419, 0.187), (0.697, 0.4), (1.37, 1.05)].map(|(e, p)| dark * e + red * p)
}

/// Colour of a mass of hair of an absorption and azimuthal roughness (Chiang et al. 2016, equation 9).
fn hair_color(sigma: f64, roughness: f64) -> f64 {
    let b = roughness;
    let fit =
        5.969 - 0.215 * b + 2.532 * b.powi(2) - 10.73 * b.powi(3) + 5.574 * b.powi(4) + 0.245 * b.powi(5);
    (-sigma.max(0.0).sqrt() * fit).exp()
}

/// Albedo of a half space of a medium under diffuse light, no border to it (Jensen et al. 2001, the total of the dipole for A = 1).
fn diffuse_albedo(absorbed: f64, scattered: f64) -> f64 {
    let alpha = if absorbed + scattered > 0.0 { scattered / (absorbed + scattered) } else { 0.0 };
    let root = (3.0 * (1.0 - alpha).max(0.0)).sqrt();
    (alpha / 2.0 * (1.0 + (-4.0 / 3.0 * root).exp()) * (-root).exp()).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn albedos() {
        assert_eq!(
            [diffuse_albedo(0.0, 3.0), diffuse_albedo(1.0, 0.0), diffuse_albedo(0.0, 0.0)],
            [1.0, 0.0, 0.0]
        );
        assert!(diffuse_albedo(0.01, 1.0) > 0.7 && diffuse_albedo(1.0, 1.0) < 0.1);
        // The fit is the inverse of σ = (ln c / fit)².
        assert_eq!(hair_color(0.0, 0.3), 1.0);
        assert!((hair_color((0.5f64.ln() / 5.969).powi(2), 0.0) - 0.5).abs() < 1e-12);
        let brown = melanin(1.3, 0.0).map(|sigma| hair_color(sigma, 0.3));
        assert!(brown[0] > brown[1] && brown[1] > brown[2] && brown[0] < 0.1, "{brown:?}");
    }
}
