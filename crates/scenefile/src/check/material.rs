//! Names in materials, and reflectances that add up to too much.

use super::Checker;
use crate::desc::{ColorDesc, Ior, Material, MaterialKind, MaterialRef, Metal, Principled, Roughness};
use crate::diagnostic::{Diagnostic, Report, quoted};
use crate::nearest::nearest;
use crate::source::{Sourced, Span};

/// Mixes within mixes, at most.
const DEEPEST_MIX: u32 = 6;

impl Checker<'_> {
    pub(super) fn material(&self, report: &mut Report, what: &str, material: &Material, span: Option<Span>) {
        self.float(report, what, &material.opacity);
        self.float(report, what, &material.rotation);
        for name in material.normal_map.iter().chain(&material.bump_map) {
            self.texture_name(report, what, name);
        }
        match &material.kind {
            MaterialKind::Diffuse { color } | MaterialKind::Mirror { color } => {
                self.color(report, what, color)
            }
            MaterialKind::Phong { diffuse, specular, exponent } => {
                self.float(report, what, exponent);
                self.sum(report, what, span, ("diffuse", diffuse), ("specular", specular));
            }
            MaterialKind::Dielectric(m) => {
                substance_of(report, what, &m.ior);
                self.color(report, what, &m.color);
                self.color(report, what, &m.specular);
                self.roughness(report, what, &m.roughness);
            }
            MaterialKind::Conductor(m) => {
                metal_of(report, what, &m.metal);
                self.color(report, what, &m.specular);
                self.roughness(report, what, &m.roughness);
            }
            MaterialKind::Plastic { color, ior, roughness } => {
                substance_of(report, what, ior);
                self.color(report, what, color);
                self.roughness(report, what, roughness);
            }
            MaterialKind::RoughDiffuse { color, roughness } | MaterialKind::Sheen { color, roughness } => {
                self.color(report, what, color);
                self.float(report, what, roughness);
            }
            MaterialKind::DiffuseTransmission { reflectance, transmittance } => {
                let (r, t) = (("reflectance", reflectance), ("transmittance", transmittance));
                self.sum(report, what, span, r, t);
            }
            MaterialKind::ThinDielectric(m) => {
                substance_of(report, what, &m.ior);
                self.color(report, what, &m.color);
                self.color(report, what, &m.specular);
                self.roughness(report, what, &m.roughness);
            }
            MaterialKind::CoatedDiffuse(m) => {
                substance_of(report, what, &m.ior);
                self.color(report, what, &m.color);
                self.color(report, what, &m.specular);
                self.roughness(report, what, &m.roughness);
            }
            MaterialKind::CoatedConductor(m) => {
                metal_of(report, what, &m.metal);
                substance_of(report, what, &m.ior);
                self.roughness(report, what, &m.roughness);
                self.float(report, what, &m.coat_roughness);
            }
            MaterialKind::Principled(m) => self.principled(report, what, m),
            MaterialKind::Mix { a, b, amount } => {
                self.float(report, what, amount);
                self.material_ref(report, what, Some(a));
                self.material_ref(report, what, Some(b));
                if self.is_too_deep(material, 0) {
                    let message =
                        format!("{what} mixes mixes of mixes, more than {DEEPEST_MIX} deep, or itself");
                    report.push(Diagnostic::error("material-cycle", message).at(span));
                }
            }
        }
    }

    /// Whether more than so many mixes lie within each other, as where one is made of itself.
    fn is_too_deep(&self, material: &Material, depth: u32) -> bool {
        let MaterialKind::Mix { a, b, .. } = &material.kind else { return false };
        let below = |reference: &MaterialRef| match reference {
            MaterialRef::Inline(material) => self.is_too_deep(material, depth + 1),
            MaterialRef::Named(name) => {
                self.desc.materials.get(name.as_str()).is_some_and(|m| self.is_too_deep(m, depth + 1))
            }
        };
        depth >= DEEPEST_MIX || below(a) || below(b)
    }

    fn principled(&self, report: &mut Report, what: &str, m: &Principled) {
        substance_of(report, what, &m.ior);
        self.roughness(report, what, &m.roughness);
        for color in [&m.base_color, &m.specular_color, &m.sheen_color] {
            self.color(report, what, color);
        }
        let numbers = [
            &m.metallic,
            &m.specular,
            &m.transmission,
            &m.diffuse_transmission,
            &m.sheen_roughness,
            &m.clearcoat,
            &m.clearcoat_roughness,
            &m.film,
            &m.film_thickness_nm,
        ];
        for number in numbers {
            self.float(report, what, number);
        }
    }

    fn roughness(&self, report: &mut Report, what: &str, roughness: &Roughness) {
        let (Roughness::Perceived { roughness: a, anisotropy: b } | Roughness::Alpha { along: a, across: b }) =
            roughness;
        self.float(report, what, a);
        self.float(report, what, b);
    }

    /// Two colours that share the light.
    fn sum(
        &self,
        report: &mut Report,
        what: &str,
        span: Option<Span>,
        (name, one): (&str, &ColorDesc),
        (other_name, other): (&str, &ColorDesc),
    ) {
        self.color(report, what, one);
        self.color(report, what, other);
        if let (ColorDesc::Rgb(a), ColorDesc::Rgb(b)) = (one, other)
            && (0..3).any(|i| a[i] as f64 + b[i] as f64 > 1.0 + 1e-6)
        {
            let message = format!("{what} reflects more light than it gets");
            report.push(
                Diagnostic::error("out-of-range", message)
                    .at(span)
                    .help(format!("`{name}` and `{other_name}` must add up to at most 1 in each channel")),
            );
        }
    }
}

fn metal_of(report: &mut Report, what: &str, metal: &Metal) {
    if let Metal::Named(name) = metal
        && color::named_metal(name).is_none()
    {
        unknown_substance(report, "metal", what, name, color::metal_names());
    }
}

/// The name of a refractive index must be known.
fn substance_of(report: &mut Report, what: &str, ior: &Ior) {
    if let Ior::Glass(name) = ior
        && color::named_ior(name).is_none()
    {
        unknown_substance(report, "substance", what, name, color::ior_names());
    }
}

fn unknown_substance(
    report: &mut Report,
    noun: &str,
    what: &str,
    name: &Sourced<String>,
    known: impl Iterator<Item = &'static str>,
) {
    if report.count_if_full() {
        return;
    }
    let known: Vec<&str> = known.collect();
    let help = match nearest(name, known.iter().copied()) {
        Some(near) => format!("did you mean {}?", quoted(near)),
        None => format!("known are {}", known.join(", ")),
    };
    let message = format!("unknown {noun} {} in {what}", quoted(name));
    report.push(Diagnostic::error("unknown-substance", message).at(name.span).help(help));
}
