//! BSDFs that scatter by themselves.

use std::rc::Rc;

use scenefile::Diagnostic;
use scenefile::desc::{
    CoatedDiffuse, ColorDesc, Conductor, Dielectric, Facets, FloatDesc, Material, MaterialKind, Metal,
    Roughness, ThinDielectric,
};

use super::bsdf::{Use, Uv};
use super::matter;
use super::plugin::{Plugin, Value};
use super::{Importer, principled};
use crate::matrix::narrow;
use crate::report::nearest;

/// Kinds that are known, for those that are not.
pub(super) const KINDS: [&str; 34] = [
    "diffuse",
    "roughdiffuse",
    "dielectric",
    "thindielectric",
    "roughdielectric",
    "conductor",
    "roughconductor",
    "plastic",
    "roughplastic",
    "pplastic",
    "phong",
    "ward",
    "principled",
    "principledthin",
    "difftrans",
    "twosided",
    "mask",
    "blendbsdf",
    "mixturebsdf",
    "bumpmap",
    "normalmap",
    "null",
    "coating",
    "roughcoating",
    "measured",
    "measured_polarized",
    "hair",
    "hk",
    "irawan",
    "rtrans",
    "polarizer",
    "retarder",
    "circular",
    "merl",
];

impl Importer {
    pub(super) fn scattering(&mut self, plugin: &Rc<Plugin>, used: Use) -> Material {
        let uv = used.uv;
        let mut material: Material = match plugin.kind.as_str() {
            "diffuse" => Material::diffuse(self.diffuse_color(plugin, uv)),
            "roughdiffuse" => {
                plugin.ignore(&["use_fast_approx"]);
                let color = self.diffuse_color(plugin, uv);
                // The deviation of slopes is α/√2; our roughness is 1 at a deviation of π/2.
                let roughness = match self.float(plugin, "alpha", 0.2, uv) {
                    FloatDesc::Value(a) => {
                        (a / (std::f32::consts::SQRT_2 * std::f32::consts::FRAC_PI_2)).clamp(0.0, 1.0).into()
                    }
                    texture => texture,
                };
                MaterialKind::RoughDiffuse { color, roughness }.into()
            }
            "difftrans" => MaterialKind::DiffuseTransmission {
                reflectance: 0.0.into(),
                transmittance: self.color(plugin, &["transmittance"], 0.5, uv),
            }
            .into(),
            "dielectric" | "roughdielectric" => {
                let rough = plugin.kind == "roughdielectric";
                let (ior, outside) = self.index(plugin, 1.5046);
                Dielectric {
                    ior: ior.into(),
                    outside_ior: Some(outside),
                    color: self.color(plugin, &["specular_transmittance"], 1.0, uv),
                    specular: self.color(plugin, &["specular_reflectance"], 1.0, uv),
                    roughness: self.roughness(plugin, rough, uv),
                    facets: self.facets(plugin, rough),
                    absorption: used.absorption,
                    ..Dielectric::default()
                }
                .into()
            }
            "thindielectric" => {
                let (ior, outside) = self.index(plugin, 1.5046);
                ThinDielectric {
                    ior: (ior / outside).max(1.0).into(),
                    color: self.color(plugin, &["specular_transmittance"], 1.0, uv),
                    specular: self.color(plugin, &["specular_reflectance"], 1.0, uv),
                    ..ThinDielectric::default()
                }
                .into()
            }
            "conductor" | "roughconductor" => self.conductor(plugin, uv),
            "plastic" | "roughplastic" | "pplastic" => {
                let rough = plugin.kind != "plastic";
                plugin.ignore(&["specular_sampling_weight"]);
                let (ior, outside) = self.index(plugin, 1.49);
                CoatedDiffuse {
                    color: self.color(plugin, &["diffuse_reflectance", "reflectance"], 0.5, uv),
                    specular: self.color(plugin, &["specular_reflectance"], 1.0, uv),
                    ior: (ior / outside).max(1.0).into(),
                    roughness: self.roughness(plugin, rough, uv),
                    facets: self.facets(plugin, rough),
                    nonlinear: plugin.is(&mut self.report, "nonlinear"),
                    depth: 0.0,
                }
                .into()
            }
            "phong" => {
                plugin.ignore(&["specular_sampling_weight"]);
                let exponent = self.float(plugin, "exponent", 30.0, uv);
                self.phong(plugin, exponent, uv)
            }
            "ward" => {
                plugin.ignore(&["specular_sampling_weight", "variant", "alpha"]);
                let text = "the BSDF `ward` is not imitated exactly";
                self.report.instead(text, "a lobe of Phong of about its width takes its place", plugin.span);
                let [u, v] = ["alpha_u", "alpha_v"].map(|n| match self.float(plugin, n, 0.1, uv) {
                    FloatDesc::Value(a) => a,
                    FloatDesc::Texture(_) => 0.1,
                });
                // e^(−tan²θ_h/α²) falls as cos^(2/α²) θ_h, and θ_h is half the angle that Phong's exponent is for.
                self.phong(plugin, (0.5 / (u * v).max(1e-6)).into(), uv)
            }
            "principled" => principled::solid(self, plugin, uv),
            "principledthin" => principled::thin(self, plugin, uv),
            kind if KINDS.contains(&kind) => {
                let text = format!("the BSDF `{kind}` is not rendered");
                self.report.instead(text, "a grey diffuse one takes its place", plugin.span);
                plugin.params.iter().for_each(|p| p.mark());
                Material::diffuse(0.5)
            }
            kind => {
                let wrong = Diagnostic::error("unknown-kind", format!("there is no BSDF `{kind}`"));
                let help = nearest(kind, KINDS.into_iter()).map(|n| format!("did you mean `{n}`?"));
                self.report.push(wrong.at(plugin.kind_span).maybe_help(help));
                plugin.params.iter().for_each(|p| p.mark());
                Material::diffuse(0.5)
            }
        };
        material.two_sided = false;
        material
    }

    fn diffuse_color(&mut self, plugin: &Rc<Plugin>, uv: Uv) -> ColorDesc {
        self.color(plugin, &["reflectance", "diffuse_reflectance"], 0.5, uv)
    }

    fn phong(&mut self, plugin: &Rc<Plugin>, exponent: FloatDesc, uv: Uv) -> Material {
        let mut diffuse = self.color(plugin, &["diffuse_reflectance"], 0.5, uv);
        let mut specular = self.color(plugin, &["specular_reflectance"], 0.2, uv);
        if let (ColorDesc::Rgb(d), ColorDesc::Rgb(s)) = (&mut diffuse, &mut specular) {
            let sum = [0, 1, 2].map(|i| d[i] + s[i]).into_iter().fold(1.0, f32::max);
            if sum > 1.0 {
                let text = format!("{} sends away more light than it gets", plugin.what());
                self.report.instead(text, "its colours are made darker", plugin.span);
                let sum = sum * (1.0 + 1e-6);
                (*d, *s) = (d.map(|x| x / sum), s.map(|x| x / sum));
            }
        }
        MaterialKind::Phong { diffuse, specular, exponent }.into()
    }

    fn conductor(&mut self, plugin: &Rc<Plugin>, uv: Uv) -> Material {
        let rough = plugin.kind == "roughconductor";
        let specular = self.color(plugin, &["specular_reflectance"], 1.0, uv);
        let named = plugin.find("material").is_some();
        let given = plugin.find("eta").is_some() || plugin.find("k").is_some();
        // Version 0.6 takes copper where nothing is said.
        let default = if plugin.old { "Cu" } else { "none" };
        let name = plugin.text(&mut self.report, "material").unwrap_or(default).to_owned();
        if !rough && !given && name == "none" {
            return Material::mirror(specular);
        }
        let (n, k) = match matter::metal(&name) {
            Some(known) => known,
            None => {
                let wrong = Diagnostic::error("unknown-substance", format!("no material is named `{name}`"));
                let help = nearest(&name, matter::metal_names()).map(|n| format!("did you mean `{n}`?"));
                let span = plugin.find("material").map_or(plugin.span, |p| p.span);
                self.report.push(wrong.at(span).maybe_help(help));
                ([1.0; 3], [1.0; 3])
            }
        };
        if named && given {
            let text = format!("{} has both `material` and `eta` or `k`", plugin.what());
            self.report.error("conflict", text, plugin.span);
        }
        // With one of the two alone the other has its default.
        let (n, k) = if given { ([1e-6; 3], [1.0; 3]) } else { (n, k) };
        let n = self.channels(plugin, "eta").unwrap_or(n);
        let k = self.channels(plugin, "k").unwrap_or(k);
        let outside = match plugin.find("ext_eta") {
            Some(_) => self.named_index(plugin, "ext_eta", 1.0),
            None => 1.0,
        };
        let n = narrow(n.map(|x| (x / outside).max(1e-6)));
        let k = narrow(k.map(|x| (x / outside).max(0.0)));
        Conductor {
            metal: Metal::Index { n, k },
            specular,
            roughness: self.roughness(plugin, rough, uv),
            facets: self.facets(plugin, rough),
            ..Conductor::default()
        }
        .into()
    }

    /// `int_ior` and `ext_ior`.
    pub(super) fn index(&mut self, plugin: &Plugin, default: f64) -> (f32, f32) {
        let inside = self.named_index(plugin, "int_ior", default);
        let outside = self.named_index(plugin, "ext_ior", 1.000277);
        (inside as f32, outside as f32)
    }

    /// An index by number or name.
    pub(super) fn named_index(&mut self, plugin: &Plugin, name: &str, default: f64) -> f64 {
        let Some(param) = plugin.find(name) else { return default };
        let value = match &param.value {
            Value::Number(x) => Some(*x),
            Value::Text(name) => {
                let known = matter::ior(name);
                if known.is_none() {
                    let text = format!("no substance is named `{name}`");
                    let help = nearest(name, matter::ior_names()).map(|n| format!("did you mean `{n}`?"));
                    let wrong = Diagnostic::error("unknown-substance", text).at(param.span);
                    self.report.push(wrong.maybe_help(help));
                    return default;
                }
                known
            }
            Value::Color(color) => Some(color.channels().iter().sum::<f64>() / 3.0),
            _ => None,
        };
        match value {
            Some(n) if (0.1..=10.0).contains(&n) => n,
            _ => {
                let text = format!("`{name}` of {} is no refractive index", plugin.what());
                self.report.error("out-of-range", text, param.span);
                default
            }
        }
    }

    /// α of the facets of a rough BSDF.
    fn roughness(&mut self, plugin: &Rc<Plugin>, rough: bool, uv: Uv) -> Roughness {
        if !rough {
            return Roughness::default();
        }
        let along =
            self.float(plugin, if plugin.find("alpha_u").is_some() { "alpha_u" } else { "alpha" }, 0.1, uv);
        let across =
            self.float(plugin, if plugin.find("alpha_v").is_some() { "alpha_v" } else { "alpha" }, 0.1, uv);
        let limited = |alpha| match alpha {
            FloatDesc::Value(x) => FloatDesc::Value(f32::clamp(x, 0.0, 1.0)),
            texture => texture,
        };
        Roughness::Alpha { along: limited(along), across: limited(across) }
    }

    fn facets(&mut self, plugin: &Plugin, rough: bool) -> Facets {
        if !rough {
            return Facets::default();
        }
        plugin.ignore(&["sample_visible", "sampleVisible"]);
        match plugin.text(&mut self.report, "distribution") {
            Some("ggx") => Facets::Separable,
            None | Some("beckmann") => Facets::Beckmann,
            Some(other) => {
                let text = format!("the distribution of facets `{other}` is not rendered");
                self.report.instead(text, "Beckmann's takes its place", plugin.span);
                Facets::Beckmann
            }
        }
    }

    /// Mitsuba 0.6: a coat over another BSDF.
    pub(super) fn coating(&mut self, plugin: &Rc<Plugin>, used: Use, depth: usize) -> Option<Material> {
        let rough = plugin.kind == "roughcoating";
        plugin.ignore(&["thickness", "sigma_a", "specular_sampling_weight"]);
        let (ior, outside) = self.index(plugin, 1.5046);
        let ior = (ior / outside).max(1.0);
        let specular = self.color(plugin, &["specular_reflectance"], 1.0, used.uv);
        let (roughness, facets) = (self.roughness(plugin, rough, used.uv), self.facets(plugin, rough));
        let mut material = self.nested(plugin, used, depth)?;
        let text = format!("the BSDF `{}` is not imitated exactly", plugin.kind);
        material.kind = match material.kind {
            MaterialKind::Diffuse { color } => {
                self.report.instead(text, "a clear coat over a diffuse base takes its place", plugin.span);
                let coated = CoatedDiffuse {
                    color,
                    specular,
                    ior: ior.into(),
                    roughness,
                    facets,
                    ..CoatedDiffuse::default()
                };
                MaterialKind::CoatedDiffuse(coated)
            }
            MaterialKind::Conductor(metal) => {
                self.report.instead(text, "a clear coat over the metal takes its place", plugin.span);
                let coat = match roughness {
                    Roughness::Alpha { along: FloatDesc::Value(a), .. } => FloatDesc::Value(a.sqrt()),
                    _ => 0.0.into(),
                };
                MaterialKind::CoatedConductor(scenefile::desc::CoatedConductor {
                    metal: metal.metal,
                    roughness: metal.roughness,
                    ior: ior.into(),
                    coat_roughness: coat,
                    depth: 0.0,
                    facets,
                })
            }
            other => {
                self.report.instead(text, "the surface has no coat", plugin.span);
                other
            }
        };
        Some(material)
    }
}
