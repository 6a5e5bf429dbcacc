//! Materials that only pbrt-v3 has.

use scenefile::desc::{
    CoatedDiffuse, ColorDesc, Facets, FloatDesc, Material, MaterialKind, Principled, Roughness,
};

use super::Importer;
use super::params::Params;
use super::roughness::Remap;
use super::textures::{grey, number};

/// 1 minus the mean reflectance of glass of index 1.5 for diffuse light from outside (Duntley 1942: 0.0918).
const THROUGH_GLASS: f32 = 0.9082;

impl Importer {
    /// `None`: no such kind.
    pub(super) fn version_3(&mut self, kind: &str, params: &Params) -> Option<Material> {
        Some(match kind {
            "matte" => self.matte(params),
            "plastic" => {
                let (kd, ks) = (self.color(params, "Kd", 0.25), self.color(params, "Ks", 0.25));
                self.glossy(params, kd, ks, 1.5)
            }
            "substrate" => {
                let (kd, ks) = (self.color(params, "Kd", 0.5), self.color(params, "Ks", 0.5));
                // `Ks` is the coat's reflectance at normal incidence.
                match ks {
                    ColorDesc::Rgb(rgb) => self.glossy(params, kd, 1.0.into(), index_of(rgb)),
                    texture => self.glossy(params, kd, texture, 1.5),
                }
            }
            "metal" => self.conductor(params, Remap::Logarithm, 0.01),
            "mirror" => Material::mirror(self.color(params, "Kr", 0.9)),
            "glass" => self.glass(params, Remap::Logarithm),
            "translucent" => self.translucent(params),
            "uber" => self.uber(params),
            "disney" => self.disney(params),
            _ => return None,
        })
    }

    fn matte(&mut self, params: &Params) -> Material {
        let color = self.color(params, "Kd", 0.5);
        // Degrees of standard deviation (Oren & Nayar 1994); our roughness is 1 at π/2.
        match self.float(params, "sigma") {
            Some(FloatDesc::Value(degrees)) if degrees > 0.0 => {
                let roughness = (degrees / 90.0).min(1.0).into();
                MaterialKind::RoughDiffuse { color, roughness }.into()
            }
            Some(FloatDesc::Texture(name)) => {
                let degrees = FloatDesc::Texture(name);
                let roughness =
                    self.number_product("sigma", degrees, FloatDesc::Value(1.0 / 90.0), params.span);
                MaterialKind::RoughDiffuse { color, roughness }.into()
            }
            _ => Material::diffuse(color),
        }
    }

    /// A diffuse base that keeps its albedo beside a gloss: version 3 adds the two.
    fn glossy(&mut self, params: &Params, kd: ColorDesc, ks: ColorDesc, ior: f32) -> Material {
        let text = format!("{} is not imitated exactly", params.what);
        self.report.instead(text, "a diffuse base under a coat takes its place", params.span);
        let roughness = self.roughness(params, "", Remap::Logarithm, 0.1);
        let color = match kd {
            ColorDesc::Rgb(rgb) => ColorDesc::Rgb(rgb.map(|c| (c / THROUGH_GLASS).min(1.0))),
            texture => self.product("Kd", texture, grey((1.0 / THROUGH_GLASS).into()), params.span),
        };
        CoatedDiffuse {
            color,
            specular: ks,
            ior: ior.into(),
            roughness,
            facets: Facets::SingleBounce,
            nonlinear: false,
            ..CoatedDiffuse::default()
        }
        .into()
    }

    fn translucent(&mut self, params: &Params) -> Material {
        let (kd, ks) = (self.color(params, "Kd", 0.25), self.color(params, "Ks", 0.25));
        let (r, t) = (self.color(params, "reflect", 0.5), self.color(params, "transmit", 0.5));
        self.roughness(params, "", Remap::Logarithm, 0.1);
        if ks != ColorDesc::from(0.0) {
            let text = "the gloss of a translucent material is not rendered";
            self.report.instead(text, "it is diffuse", params.span);
        }
        let r = self.product("reflect", kd.clone(), r, params.span);
        let t = self.product("transmit", kd, t, params.span);
        self.two_faced(r, t, 1.0, params)
    }

    /// A mixture of everything: glass, or a coated base; what `opacity` leaves is not there.
    fn uber(&mut self, params: &Params) -> Material {
        let (kd, ks) = (self.color(params, "Kd", 0.25), self.color(params, "Ks", 0.25));
        let (kr, kt) = (self.color(params, "Kr", 0.0), self.color(params, "Kt", 0.0));
        let ior = self.index(params, &["eta", "index"], 1.5);
        let opacity = self.albedo(params, "opacity").map_or(FloatDesc::Value(1.0), number);
        let mean = |color: &ColorDesc| match number(color.clone()) {
            FloatDesc::Value(x) => x,
            FloatDesc::Texture(_) => 0.5,
        };
        let material = if mean(&kt) > mean(&kd).max(mean(&kr)) {
            let text = format!("{} is not imitated exactly", params.what);
            self.report.instead(text, "glass takes its place", params.span);
            params.ignore(&["roughness", "uroughness", "vroughness", "remaproughness"]);
            let glass = scenefile::desc::Dielectric {
                ior: ior.into(),
                outside_ior: Some(1.0),
                color: kt,
                specular: kr,
                ..Default::default()
            };
            glass.into()
        } else {
            let mirrors = mean(&kr) > mean(&ks);
            let mut material = self.glossy(params, kd, if mirrors { kr } else { ks }, ior);
            if let (true, MaterialKind::CoatedDiffuse(coated)) = (mirrors, &mut material.kind) {
                coated.roughness = Roughness::default();
            }
            material
        };
        Material { opacity, ..material }
    }

    /// Burley's model (2012, 2015), which ours is close to.
    fn disney(&mut self, params: &Params) -> Material {
        params.ignore(&["flatness", "speculartint", "scatterdistance"]);
        let text = format!("{} is not imitated exactly", params.what);
        self.report.instead(text, "the principled model takes its place", params.span);
        let mut float = |name: &str, default: f32| self.float(params, name).unwrap_or(default.into());
        let (metallic, roughness) = (float("metallic", 0.0), float("roughness", 0.5));
        let (anisotropy, transmission) = (float("anisotropic", 0.0), float("spectrans", 0.0));
        let (sheen, tint) = (float("sheen", 0.0), float("sheentint", 0.5));
        let (clearcoat, gloss) = (float("clearcoat", 0.0), float("clearcoatgloss", 1.0));
        let transmitted = float("difftrans", 1.0);
        let thin = params.truth("thin") == Some(true);
        let color = self.color(params, "color", 0.5);
        let sheen_color = match (&sheen, &tint, &color) {
            (FloatDesc::Value(s), FloatDesc::Value(t), ColorDesc::Rgb(rgb)) => {
                let most = rgb.iter().copied().fold(1e-6, f32::max);
                ColorDesc::Rgb(rgb.map(|c| (s * (1.0 - t + t * c / most)).clamp(0.0, 1.0)))
            }
            _ => grey(sheen),
        };
        Principled {
            base_color: color,
            metallic,
            roughness: Roughness::Perceived { roughness, anisotropy },
            ior: self.index(params, &["eta"], 1.5).into(),
            transmission,
            thin,
            // Its share is half of 0..=2.
            diffuse_transmission: match (thin, transmitted) {
                (false, _) => 0.0.into(),
                (true, FloatDesc::Value(x)) => (x / 2.0).clamp(0.0, 1.0).into(),
                (true, texture) => self.number_product("difftrans", texture, 0.5.into(), params.span),
            },
            sheen_color,
            clearcoat,
            // α goes from 0.1 (no gloss) to 0.001.
            clearcoat_roughness: match gloss {
                FloatDesc::Value(g) => (0.1 + (0.001 - 0.1) * g.clamp(0.0, 1.0)).sqrt().into(),
                FloatDesc::Texture(_) => 0.2.into(),
            },
            ..Principled::default()
        }
        .into()
    }
}

/// The index of a coat of a reflectance at normal incidence.
fn index_of(reflectance: [f32; 3]) -> f32 {
    let root = (reflectance.iter().sum::<f32>() / 3.0).clamp(1e-4, 0.6).sqrt();
    (1.0 + root) / (1.0 - root)
}
