//! Metals, bare and coated.

use scenefile::desc::{CoatedConductor, ColorDesc, Conductor, Facets, FloatDesc, Material, Metal, Roughness};

use super::Importer;
use super::params::Params;
use super::roughness::Remap;
use crate::matrix::narrow;
use crate::spectrum::Curve;

/// What `reflectance` comes to.
struct Reflecting {
    metal: Metal,
    /// Factor on what it reflects.
    specular: ColorDesc,
}

impl Importer {
    pub(super) fn conductor(&mut self, params: &Params, remap: Remap, roughness: f64) -> Material {
        let Reflecting { metal, specular } = self.metal(params, "", "reflectance");
        Conductor {
            metal,
            specular,
            roughness: self.roughness(params, "", remap, roughness),
            facets: Facets::SingleBounce,
            ..Conductor::default()
        }
        .into()
    }

    pub(super) fn coated_conductor(&mut self, params: &Params) -> Material {
        let coat = match self.roughness(params, "interface.", Remap::Root, 0.0) {
            // That of a coat is one number, of which α is the square.
            Roughness::Alpha { along: FloatDesc::Value(a), across: FloatDesc::Value(b) } => {
                FloatDesc::Value((a * b).sqrt().sqrt())
            }
            Roughness::Perceived { roughness, .. } => roughness,
            Roughness::Alpha { along, .. } => along,
        };
        let reflectance = if params.any("conductor.reflectance").is_some() {
            "conductor.reflectance"
        } else {
            "reflectance"
        };
        let Reflecting { metal, specular } = self.metal(params, "conductor.", reflectance);
        let metal = match specular {
            ColorDesc::Rgb(_) => metal,
            ColorDesc::Texture(_) => {
                let text = "a coated metal's reflectance of a texture is not rendered";
                self.report.instead(text, "it is 0.5", params.span);
                reflecting([0.5; 3])
            }
        };
        CoatedConductor {
            metal,
            roughness: self.roughness(params, "conductor.", Remap::Root, 0.0),
            ior: self.index(params, &["interface.eta"], 1.5).into(),
            coat_roughness: coat,
            depth: self.coat_depth(params),
            facets: Facets::SingleBounce,
        }
        .into()
    }

    /// By `reflectance`, else by `eta` and `k` behind a prefix.
    fn metal(&mut self, params: &Params, prefix: &str, reflectance: &str) -> Reflecting {
        let plain = |metal| Reflecting { metal, specular: 1.0.into() };
        match self.albedo(params, reflectance) {
            Some(ColorDesc::Rgb(rgb)) => return plain(reflecting(rgb)),
            // A metal that reflects everything, times the texture.
            Some(texture) => return Reflecting { metal: reflecting([1.0; 3]), specular: texture },
            None => {}
        }
        let [eta, k] = ["eta", "k"].map(|name| format!("{prefix}{name}"));
        for name in [&eta, &k] {
            if let Some(texture) = params.find(name, &["texture"]) {
                let text = "the index of a metal does not vary over a surface";
                self.report.instead(text, "it is that of copper", texture.span);
            }
        }
        let name = |this: &mut Self, name: &str| {
            let param = params.find(name, &["spectrum"])?;
            param.text()?;
            this.curve(param)
        };
        let curves = (name(self, &eta), name(self, &k));
        let named = match &curves {
            (Some(Curve::MetalN(n)), Some(Curve::MetalK(k))) if n == k => Some(n.clone()),
            (Some(Curve::MetalN(n)), None) if params.any(&k).is_none() => Some(n.clone()),
            (None, None) if params.any(&eta).is_none() && params.any(&k).is_none() => Some("Cu".to_owned()),
            _ => None,
        };
        if let Some(name) = named {
            return plain(Metal::Named(name.into()));
        }
        let copper =
            |part: &str| Curve::named(&format!("metal-Cu-{part}")).map_or([1.0; 3], |c| c.channels());
        let n = self.channels(params, &eta).unwrap_or(copper("eta"));
        let k = self.channels(params, &k).unwrap_or(copper("k"));
        plain(Metal::Index { n: narrow(n.map(|x| x.max(1e-3))), k: narrow(k.map(|x| x.max(0.0))) })
    }
}

/// What reflects so much at normal incidence: n = 1, k = 2√r/√(1 − r) (pbrt-v4, ConductorMaterial).
pub(super) fn reflecting(rgb: [f32; 3]) -> Metal {
    let k = rgb.map(|r| 2.0 * r.min(0.9999).sqrt() / (1.0 - r.min(0.9999)).sqrt());
    Metal::Index { n: [1.0; 3], k }
}
