//! Materials of pbrt-v4 and, by their names, of v3.

use scenefile::desc::{
    CoatedConductor, CoatedDiffuse, ColorDesc, ColorSpace, Conductor, Dielectric, Facets, FloatDesc, Image,
    ImageSource, Material, MaterialKind, MaterialRef, Metal, Roughness, Texture, ThinDielectric,
};
use scenefile::{Sourced, Span};

use super::Importer;
use super::lower::MaterialUse;
use super::params::Params;
use crate::matrix::narrow;
use crate::spectrum::Curve;

/// How a version makes the α of facets from its `roughness`.
#[derive(Clone, Copy, PartialEq)]
enum Remap {
    /// pbrt-v4: α = √roughness.
    Root,
    /// pbrt-v3: a polynomial in the logarithm.
    Logarithm,
}

/// What a mix comes to.
enum Mixed {
    One(MaterialUse),
    Both(Box<MaterialKind>),
}

impl Remap {
    fn alpha(self, roughness: f64) -> f64 {
        match self {
            Self::Root => roughness.max(0.0).sqrt(),
            Self::Logarithm => {
                let x = roughness.max(1e-3).ln();
                1.62142 + x * (0.819955 + x * (0.1734 + x * (0.0171201 + x * 0.000640711)))
            }
        }
    }
}

impl Importer {
    /// Lowers a material of a kind; `name`: its own, if it has one.
    pub(super) fn material(
        &mut self,
        kind: &str,
        at: Span,
        params: &Params,
        name: Option<&str>,
    ) -> MaterialUse {
        let material = match kind {
            "interface" | "none" | "" => return MaterialUse::Interface,
            "mix" => match self.mixed(params) {
                Some(Mixed::One(used)) => return used,
                Some(Mixed::Both(kind)) => (*kind).into(),
                None => Material::diffuse(0.5),
            },
            _ => match self.scattering(kind, params) {
                Some(material) => material,
                None => {
                    self.report.error("unknown-kind", format!("there is no material `{kind}`"), at);
                    Material::diffuse(0.5)
                }
            },
        };
        let material = self.bumped(material, params);
        self.add_material(name.unwrap_or(kind), material, params.span)
    }

    /// Two materials by chance; one where the other has no share.
    fn mixed(&mut self, params: &Params) -> Option<Mixed> {
        let names: Vec<String> = match params.find("materials", &["string"]).map(|p| &p.values) {
            Some(super::params::Values::Texts(names)) => names.clone(),
            // Version 3.
            _ => ["namedmaterial1", "namedmaterial2"]
                .iter()
                .filter_map(|n| params.text(n))
                .map(str::to_owned)
                .collect(),
        };
        let amount = match params.find("amount", &["rgb"]).and_then(|p| p.triple()) {
            // Version 3: the share of the first, by channel.
            Some(rgb) => {
                if rgb[0] != rgb[1] || rgb[1] != rgb[2] {
                    let text = "a mix by channel is not rendered";
                    self.report.instead(text, "the mean of its shares is taken", params.span);
                }
                FloatDesc::Value((1.0 - (rgb[0] + rgb[1] + rgb[2]) / 3.0).clamp(0.0, 1.0) as f32)
            }
            None => match self.float(params, "amount").unwrap_or(0.5.into()) {
                FloatDesc::Value(share) => FloatDesc::Value(share.clamp(0.0, 1.0)),
                texture => texture,
            },
        };
        let [first, second] = &names[..] else {
            let text = format!("{} does not name two materials", params.what);
            self.report.error("missing-parameter", text, params.span);
            return None;
        };
        let [a, b] = [first, second].map(|name| self.named_material(name, params.span));
        Some(match (a, b, &amount) {
            (a, _, FloatDesc::Value(0.0)) => Mixed::One(a),
            (_, b, FloatDesc::Value(1.0)) => Mixed::One(b),
            (MaterialUse::Key(a), MaterialUse::Key(b), _) => {
                let named = |key| MaterialRef::Named(Sourced::at(key, params.span));
                Mixed::Both(Box::new(MaterialKind::Mix { a: named(a), b: named(b), amount }))
            }
            (one @ MaterialUse::Key(_), _, _) | (_, one, _) => {
                let text = "a mix with an interface is not rendered";
                self.report.instead(text, "the other material takes its place", params.span);
                Mixed::One(one)
            }
        })
    }

    fn scattering(&mut self, kind: &str, params: &Params) -> Option<Material> {
        let roughness =
            |this: &mut Self, prefix: &str, remap, default| this.roughness(params, prefix, remap, default);
        Some(match kind {
            "diffuse" => Material::diffuse(self.color(params, "reflectance", 0.5)),
            "matte" => {
                let color = self.color(params, "Kd", 0.5);
                // Degrees of standard deviation (Oren & Nayar 1994); our roughness is 1 at π/2.
                match self.float(params, "sigma") {
                    Some(FloatDesc::Value(degrees)) if degrees > 0.0 => {
                        let roughness = (degrees / 90.0).min(1.0).into();
                        MaterialKind::RoughDiffuse { color, roughness }.into()
                    }
                    _ => Material::diffuse(color),
                }
            }
            "coateddiffuse" => CoatedDiffuse {
                color: self.color(params, "reflectance", 0.5),
                ior: self.index(params, &["eta"], 1.5).into(),
                roughness: roughness(self, "", Remap::Root, 0.0),
                depth: self.coat(params, &["thickness", "albedo", "g"]),
                ..CoatedDiffuse::default()
            }
            .into(),
            "plastic" | "substrate" => {
                let color = self.color(params, "Kd", if kind == "plastic" { 0.25 } else { 0.5 });
                let specular = self.color(params, "Ks", if kind == "plastic" { 0.25 } else { 0.5 });
                let text = format!("the material `{kind}` is not imitated exactly");
                self.report.instead(text, "a diffuse base under a coat takes its place", params.span);
                // `Ks` is the coat's own reflectance at normal incidence in one, a factor on that of glass in the other.
                let (specular, ior) = match (kind, specular) {
                    ("substrate", ColorDesc::Rgb(rgb)) => (ColorDesc::from(1.0), index_of(rgb)),
                    (_, specular) => (specular, 1.5),
                };
                let roughness = roughness(self, "", Remap::Logarithm, 0.1);
                CoatedDiffuse { color, specular, ior: ior.into(), roughness, ..CoatedDiffuse::default() }
                    .into()
            }
            "conductor" | "metal" => {
                let remap = if kind == "metal" { Remap::Logarithm } else { Remap::Root };
                Conductor {
                    metal: self.metal(params, "", "Cu"),
                    roughness: roughness(self, "", remap, if kind == "metal" { 0.01 } else { 0.0 }),
                    facets: Facets::SingleBounce,
                    ..Conductor::default()
                }
                .into()
            }
            "mirror" => Material::mirror(self.color(params, "Kr", 0.9)),
            "coatedconductor" => {
                let coat = match roughness(self, "interface.", Remap::Root, 0.0) {
                    // That of a coat is one number, of which α is the square.
                    Roughness::Alpha { along: FloatDesc::Value(a), across: FloatDesc::Value(b) } => {
                        FloatDesc::Value((a * b).sqrt().sqrt())
                    }
                    Roughness::Perceived { roughness, .. } => roughness,
                    Roughness::Alpha { along, .. } => along,
                };
                CoatedConductor {
                    metal: self.metal(params, "conductor.", "Cu"),
                    roughness: roughness(self, "conductor.", Remap::Root, 0.0),
                    ior: self.index(params, &["interface.eta"], 1.5).into(),
                    coat_roughness: coat,
                    depth: self.coat(params, &["thickness", "interface.thickness", "albedo", "g"]),
                    ..CoatedConductor::default()
                }
                .into()
            }
            "dielectric" | "glass" => {
                let remap = if kind == "glass" { Remap::Logarithm } else { Remap::Root };
                Dielectric {
                    ior: self.index(params, &["eta", "index"], 1.5).into(),
                    color: self.color(params, "Kt", 1.0),
                    specular: self.color(params, "Kr", 1.0),
                    roughness: roughness(self, "", remap, 0.0),
                    facets: Facets::SingleBounce,
                    ..Dielectric::default()
                }
                .into()
            }
            "thindielectric" => {
                ThinDielectric { ior: self.index(params, &["eta"], 1.5).into(), ..ThinDielectric::default() }
                    .into()
            }
            "diffusetransmission" => {
                let scale = params.number_or("scale", 1.0);
                let (r, t) =
                    (self.color(params, "reflectance", 0.25), self.color(params, "transmittance", 0.25));
                self.two_faced(r, t, scale, params)
            }
            "translucent" => {
                let (kd, ks) = (self.color(params, "Kd", 0.25), self.color(params, "Ks", 0.25));
                let (r, t) = (self.color(params, "reflect", 0.5), self.color(params, "transmit", 0.5));
                roughness(self, "", Remap::Logarithm, 0.1);
                if ks != ColorDesc::from(0.0) {
                    let text = "the gloss of a translucent material is not rendered";
                    self.report.instead(text, "it is diffuse", params.span);
                }
                let share = |side: ColorDesc| match (&kd, &side) {
                    (ColorDesc::Rgb(d), ColorDesc::Rgb(s)) => ColorDesc::Rgb([0, 1, 2].map(|i| d[i] * s[i])),
                    (ColorDesc::Texture(_), _) => kd.clone(),
                    _ => side,
                };
                self.two_faced(share(r), share(t), 1.0, params)
            }
            "uber" => self.uber(params),
            "subsurface" | "kdsubsurface" => {
                let names = ["mfp", "name", "sigma_a", "sigma_s", "g", "Kr", "Kt", "scale"];
                params.ignore(&names);
                let text = "light is not scattered below a surface";
                self.report.instead(text, "a diffuse base under a coat takes its place", params.span);
                let color =
                    self.albedo(params, "reflectance").or(self.albedo(params, "Kd")).unwrap_or(0.5.into());
                CoatedDiffuse {
                    color,
                    ior: self.index(params, &["eta"], 1.33).into(),
                    roughness: roughness(self, "", Remap::Root, 0.0),
                    ..CoatedDiffuse::default()
                }
                .into()
            }
            "hair" => {
                let text = "the material `hair` is not rendered";
                self.report.instead(text, "its fibres are diffuse", params.span);
                let names = ["sigma_a", "eumelanin", "pheomelanin", "eta", "beta_m", "beta_n", "alpha"];
                params.ignore(&names);
                Material::diffuse(
                    self.albedo(params, "color").or(self.albedo(params, "reflectance")).unwrap_or(0.3.into()),
                )
            }
            "measured" | "fourier" | "disney" => {
                let text = format!("the material `{kind}` is not rendered");
                self.report.instead(text, "a diffuse one takes its place", params.span);
                let names = [
                    "filename",
                    "bsdffile",
                    "anisotropic",
                    "clearcoat",
                    "clearcoatgloss",
                    "eta",
                    "metallic",
                    "roughness",
                    "scatterdistance",
                    "sheen",
                    "sheentint",
                    "spectrans",
                    "speculartint",
                    "thin",
                    "difftrans",
                    "flatness",
                ];
                params.ignore(&names);
                Material::diffuse(self.color(params, "color", 0.5))
            }
            _ => return None,
        })
    }

    fn color(&mut self, params: &Params, name: &str, default: f32) -> ColorDesc {
        self.albedo(params, name).unwrap_or(default.into())
    }

    /// Diffuse reflection and transmission, each times a scale, together at most 1.
    fn two_faced(
        &mut self,
        reflectance: ColorDesc,
        transmittance: ColorDesc,
        scale: f64,
        params: &Params,
    ) -> Material {
        let (mut reflectance, mut transmittance) = (reflectance, transmittance);
        let mut scaled = |color: &mut ColorDesc| match color {
            ColorDesc::Rgb(rgb) => *rgb = rgb.map(|c| c * scale as f32),
            ColorDesc::Texture(_) if scale != 1.0 => {
                let text = "a scaled texture is not rendered";
                self.report.instead(text, "it is taken as it is", params.span);
            }
            ColorDesc::Texture(_) => {}
        };
        scaled(&mut reflectance);
        scaled(&mut transmittance);
        if let (ColorDesc::Rgb(r), ColorDesc::Rgb(t)) = (&mut reflectance, &mut transmittance) {
            let sum = [0, 1, 2].map(|i| r[i] + t[i]);
            if sum.iter().any(|s| *s > 1.0) {
                let text = format!("{} sends away more light than it gets", params.what);
                self.report.instead(text, "its colours are made darker", params.span);
                for i in 0..3 {
                    let over = sum[i].max(1.0) * (1.0 + 1e-6);
                    (r[i], t[i]) = (r[i] / over, t[i] / over);
                }
            }
        }
        MaterialKind::DiffuseTransmission { reflectance, transmittance }.into()
    }

    /// Optical depth of a coat: pbrt's `thickness` counts only with a medium in it.
    fn coat(&mut self, params: &Params, names: &[&str]) -> f32 {
        params.ignore(&["maxdepth", "nsamples"]);
        params.ignore(names);
        if let Some(albedo) = params.any("albedo")
            && albedo.numbers().iter().any(|x| *x > 0.0)
        {
            let text = "a coat with a medium in it is not rendered";
            self.report.instead(text, "it is clear", albedo.span);
        }
        0.0
    }

    /// A metal's index, or what reflects as much at normal incidence: n = 1, k = 2√r/√(1 − r).
    fn metal(&mut self, params: &Params, prefix: &str, default: &str) -> Metal {
        let [eta, k, reflectance] = ["eta", "k", "reflectance"].map(|name| format!("{prefix}{name}"));
        if let Some(color) = self.albedo(params, &reflectance) {
            let rgb = match color {
                ColorDesc::Rgb(rgb) => rgb,
                ColorDesc::Texture(_) => {
                    let text = "a metal's reflectance of a texture is not rendered";
                    self.report.instead(text, "it is 0.5", params.span);
                    [0.5; 3]
                }
            };
            let k = rgb.map(|r| 2.0 * r.min(0.9999).sqrt() / (1.0 - r.min(0.9999)).sqrt());
            return Metal::Index { n: [1.0; 3], k };
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
            (None, None) if params.any(&eta).is_none() && params.any(&k).is_none() => {
                Some(default.to_owned())
            }
            _ => None,
        };
        if let Some(name) = named {
            return Metal::Named(name.into());
        }
        let copper =
            |part: &str| Curve::named(&format!("metal-Cu-{part}")).map_or([1.0; 3], |c| c.channels());
        let n = self.channels(params, &eta).unwrap_or(copper("eta"));
        let k = self.channels(params, &k).unwrap_or(copper("k"));
        Metal::Index { n: narrow(n.map(|x| x.max(1e-3))), k: narrow(k.map(|x| x.max(0.0))) }
    }

    /// α of facets along and across.
    fn roughness(&mut self, params: &Params, prefix: &str, remap: Remap, default: f64) -> Roughness {
        let remapped = params.truth("remaproughness").unwrap_or(true);
        let both = self.float(params, &format!("{prefix}roughness")).unwrap_or((default as f32).into());
        let u = self.float(params, &format!("{prefix}uroughness")).unwrap_or(both.clone());
        let v = self.float(params, &format!("{prefix}vroughness")).unwrap_or(both);
        let mut alpha = |value: FloatDesc| match value {
            // 0 is smooth in either version.
            FloatDesc::Value(0.0) => FloatDesc::Value(0.0),
            FloatDesc::Value(x) if remapped => {
                FloatDesc::Value(remap.alpha(f64::from(x)).clamp(0.0, 1.0) as f32)
            }
            FloatDesc::Value(x) => FloatDesc::Value(x.clamp(0.0, 1.0)),
            texture => {
                if remapped {
                    let text = "a texture of roughness is not remapped";
                    self.report.instead(text, "it is taken as the facets' α", params.span);
                }
                texture
            }
        };
        Roughness::Alpha { along: alpha(u), across: alpha(v) }
    }

    /// pbrt-v3's mixture of everything: the nearest of glass, mirror and coated base.
    fn uber(&mut self, params: &Params) -> Material {
        let (kd, ks) = (self.color(params, "Kd", 0.25), self.color(params, "Ks", 0.25));
        let (kr, kt) = (self.color(params, "Kr", 0.0), self.color(params, "Kt", 0.0));
        let ior = self.index(params, &["eta", "index"], 1.5);
        let roughness = self.roughness(params, "", Remap::Logarithm, 0.1);
        let text = "the material `uber` is not imitated exactly";
        self.report.instead(text, "a diffuse base under a coat, or glass, takes its place", params.span);
        if self.albedo(params, "opacity").is_some_and(|o| o != ColorDesc::from(1.0)) {
            self.report.instead("opacity is not rendered", "the surface is opaque", params.span);
        }
        let mean = |color: &ColorDesc| match color {
            ColorDesc::Rgb(rgb) => rgb.iter().sum::<f32>() / 3.0,
            ColorDesc::Texture(_) => 0.5,
        };
        if mean(&kt) > mean(&kd).max(mean(&kr)) {
            return Dielectric { ior: ior.into(), color: kt, specular: kr, ..Dielectric::default() }.into();
        }
        if mean(&kr) > mean(&kd) {
            return Material::mirror(kr);
        }
        CoatedDiffuse { color: kd, specular: ks, ior: ior.into(), roughness, ..CoatedDiffuse::default() }
            .into()
    }

    /// Normal maps and displacement.
    fn bumped(&mut self, material: Material, params: &Params) -> Material {
        if let Some(bump) = params.any("displacement").or(params.any("bumpmap")) {
            self.report.instead("displacement is not rendered", "the surface is smooth", bump.span);
        }
        let Some(map) = params.find("normalmap", &["string"]) else { return material };
        let path = self.find_file(map.text().unwrap_or_default());
        let key = crate::names::free_name(&self.desc.textures, "normalmap");
        let image = Image {
            color_space: ColorSpace::Linear,
            ..Image::new(ImageSource::File(Sourced::at(path, map.span)))
        };
        self.desc.textures.insert(key.clone(), Sourced::at(Texture::Image(image), map.span));
        Material { normal_map: Some(Sourced::at(key, map.span)), ..material }
    }
}

/// The index of a coat of a reflectance at normal incidence.
fn index_of(reflectance: [f32; 3]) -> f32 {
    let root = (reflectance.iter().sum::<f32>() / 3.0).clamp(1e-4, 0.6).sqrt();
    (1.0 + root) / (1.0 - root)
}
