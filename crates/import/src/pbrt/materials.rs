//! Materials of pbrt-v4; those of v3 are in a file of their own.

use scenefile::desc::{
    CoatedDiffuse, ColorDesc, ColorSpace, Dielectric, Facets, FloatDesc, Image, ImageSource, Material,
    MaterialKind, MaterialRef, Texture, ThinDielectric,
};
use scenefile::{Sourced, Span};

use super::Importer;
use super::lower::MaterialUse;
use super::params::{Params, Values};
use super::roughness::Remap;
use super::textures::grey;

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
                Ok(used) => return used,
                Err(material) => *material,
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
    fn mixed(&mut self, params: &Params) -> Result<MaterialUse, Box<Material>> {
        let names: Vec<String> = match params.find("materials", &["string"]).map(|p| &p.values) {
            Some(Values::Texts(names)) => names.clone(),
            // Version 3.
            _ => ["namedmaterial1", "namedmaterial2"]
                .iter()
                .filter_map(|n| params.text(n))
                .map(str::to_owned)
                .collect(),
        };
        let amount = self.share(params);
        let [first, second] = &names[..] else {
            let text = format!("{} does not name two materials", params.what);
            self.report.error("missing-parameter", text, params.span);
            return Ok(MaterialUse::Interface);
        };
        let [a, b] = [first, second].map(|name| self.named_material(name, params.span));
        match (a, b, &amount) {
            (a, _, FloatDesc::Value(0.0)) => Ok(a),
            (_, b, FloatDesc::Value(1.0)) => Ok(b),
            (MaterialUse::Key(a), MaterialUse::Key(b), _) => {
                let named = |key| MaterialRef::Named(Sourced::at(key, params.span));
                Err(Box::new(MaterialKind::Mix { a: named(a), b: named(b), amount }.into()))
            }
            // What is not there lets light pass.
            (MaterialUse::Key(key), _, _) => {
                let present = self.complement("presence", amount, params.span);
                Ok(MaterialUse::Key(self.with_opacity(&key, present, params.span)))
            }
            (_, MaterialUse::Key(key), _) => {
                Ok(MaterialUse::Key(self.with_opacity(&key, amount, params.span)))
            }
            _ => Ok(MaterialUse::Interface),
        }
    }

    /// The share of the second material of a mix.
    fn share(&mut self, params: &Params) -> FloatDesc {
        if let Some(rgb) = params.find("amount", &["rgb"]).and_then(|p| p.triple()) {
            // Version 3: the share of the first, by channel.
            if rgb[0] != rgb[1] || rgb[1] != rgb[2] {
                let text = "a mix by channel is not rendered";
                self.report.instead(text, "the mean of its shares is taken", params.span);
            }
            return FloatDesc::Value((1.0 - (rgb[0] + rgb[1] + rgb[2]) / 3.0).clamp(0.0, 1.0) as f32);
        }
        match self.float(params, "amount").unwrap_or(0.5.into()) {
            FloatDesc::Value(share) => FloatDesc::Value(share.clamp(0.0, 1.0)),
            texture => texture,
        }
    }

    fn scattering(&mut self, kind: &str, params: &Params) -> Option<Material> {
        Some(match kind {
            "diffuse" => {
                // Early files of version 4 have Oren's and Nayar's roughness, which nothing reads.
                params.ignore(&["sigma"]);
                Material::diffuse(self.color(params, "reflectance", 0.5))
            }
            "coateddiffuse" => {
                params.ignore(&["twosided"]);
                CoatedDiffuse {
                    color: self.color(params, "reflectance", 0.5),
                    ior: self.index(params, &["eta"], 1.5).into(),
                    roughness: self.roughness(params, "", Remap::Root, 0.0),
                    facets: Facets::SingleBounce,
                    depth: self.coat_depth(params),
                    ..CoatedDiffuse::default()
                }
                .into()
            }
            "conductor" => self.conductor(params, Remap::Root, 0.0),
            "coatedconductor" => self.coated_conductor(params),
            "dielectric" => self.glass(params, Remap::Root),
            "thindielectric" => {
                ThinDielectric { ior: self.index(params, &["eta"], 1.5).into(), ..ThinDielectric::default() }
                    .into()
            }
            "diffusetransmission" => {
                params.ignore(&["sigma", "remaproughness"]);
                let scale = params.number_or("scale", 1.0);
                let (r, t) =
                    (self.color(params, "reflectance", 0.25), self.color(params, "transmittance", 0.25));
                self.two_faced(r, t, scale, params)
            }
            "subsurface" | "kdsubsurface" => self.subsurface(params),
            "hair" => self.hair(params),
            "measured" | "fourier" => {
                let text = format!("the material `{kind}` is not rendered");
                self.report.instead(text, "a diffuse one takes its place", params.span);
                params.ignore(&["filename", "bsdffile"]);
                Material::diffuse(0.5)
            }
            _ => return self.version_3(kind, params),
        })
    }

    pub(super) fn color(&mut self, params: &Params, name: &str, default: f32) -> ColorDesc {
        self.albedo(params, name).unwrap_or(default.into())
    }

    pub(super) fn glass(&mut self, params: &Params, remap: Remap) -> Material {
        Dielectric {
            ior: self.index(params, &["eta", "index"], 1.5).into(),
            // Of pbrt's surfaces each decides by itself.
            outside_ior: Some(1.0),
            color: self.color(params, "Kt", 1.0),
            specular: self.color(params, "Kr", 1.0),
            roughness: self.roughness(params, "", remap, 0.0),
            facets: Facets::SingleBounce,
            ..Dielectric::default()
        }
        .into()
    }

    /// Diffuse reflection and transmission, each times a scale, together at most 1.
    pub(super) fn two_faced(
        &mut self,
        reflectance: ColorDesc,
        transmittance: ColorDesc,
        scale: f64,
        params: &Params,
    ) -> Material {
        let mut scaled = |color: ColorDesc, name: &str| {
            self.product(name, color, ColorDesc::Rgb([scale as f32; 3]), params.span)
        };
        let mut reflectance = scaled(reflectance, "reflectance");
        let mut transmittance = scaled(transmittance, "transmittance");
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

    /// Optical depth of a coat. pbrt's medium in it has the extinction 1 and counts where it has an albedo; what it scatters is taken
    /// to leave as it would without it.
    pub(super) fn coat_depth(&mut self, params: &Params) -> f32 {
        params.ignore(&["maxdepth", "nsamples", "g"]);
        let thickness = params.number("thickness").or(params.number("interface.thickness")).unwrap_or(0.01);
        let Some(param) = params.any("albedo") else { return 0.0 };
        let albedo = match self.albedo(params, "albedo") {
            Some(ColorDesc::Rgb(rgb)) => f64::from(rgb.iter().sum::<f32>()) / 3.0,
            _ => 0.5,
        };
        if albedo <= 0.0 {
            return 0.0;
        }
        let text = "a coat with a medium in it scatters no light";
        self.report.instead(text, "it absorbs what its medium does", param.span);
        (thickness * (1.0 - albedo)).max(0.0) as f32
    }

    /// Normal maps, and displacement as bumps: pbrt's heights are in units of the scene.
    fn bumped(&mut self, material: Material, params: &Params) -> Material {
        let mut material = material;
        if let Some(bump) = params.any("displacement").or(params.any("bumpmap")) {
            let span = bump.span;
            let heights = self.float(params, if bump.name == "bumpmap" { "bumpmap" } else { "displacement" });
            // The same height everywhere bends no normal.
            material.bump_map = heights.map(grey).as_ref().and_then(ColorDesc::named).cloned();
            if let Some(map) = &mut material.bump_map {
                map.span = Some(span);
            }
        }
        let Some(map) = params.find("normalmap", &["string"]) else { return material };
        let file = self.find_file(map.text().unwrap_or_default());
        let image = Image {
            color_space: ColorSpace::Linear,
            ..Image::new(ImageSource::File(Sourced::at(file, map.span)))
        };
        let texture = self.add_texture("normalmap", Texture::Image(image), map.span);
        Material { normal_map: texture.named().cloned(), ..material }
    }
}
