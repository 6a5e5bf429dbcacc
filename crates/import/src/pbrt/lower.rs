//! Names of what is written, and materials by name.

use scenefile::desc::{ColorDesc, FloatDesc, Material, MaterialKind, MaterialRef, Roughness};
use scenefile::{Sourced, Span};

use super::Importer;
use crate::names::free_name;

/// What a surface is made of.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum MaterialUse {
    /// A key of the description's materials.
    Key(String),
    /// Nothing: a surface that only bounds a medium.
    Interface,
}

impl Importer {
    /// Keeps a material under a name near `wanted`.
    pub(super) fn add_material(&mut self, wanted: &str, material: Material, span: Span) -> MaterialUse {
        let key = free_name(&self.desc.materials, wanted);
        self.desc.materials.insert(key.clone(), Sourced::at(material, span));
        MaterialUse::Key(key)
    }

    pub(super) fn named_material(&mut self, name: &str, at: Span) -> MaterialUse {
        match self.materials.get(name) {
            Some(found) => found.clone(),
            None => {
                self.report.error(
                    "unknown-material",
                    format!("no material is named `{name}` before here"),
                    at,
                );
                MaterialUse::Interface
            }
        }
    }

    /// The material in force; pbrt's default is grey and diffuse. `None`: nothing scatters.
    pub(super) fn current_material(&mut self, span: Span) -> Option<String> {
        let used = match &self.graphics.material {
            Some(used) => used.clone(),
            None => match self.materials.get("") {
                Some(used) => used.clone(),
                None => {
                    let used = self.add_material("default", Material::diffuse(0.5), span);
                    self.materials.insert(String::new(), used.clone());
                    used
                }
            },
        };
        match used {
            MaterialUse::Key(key) => Some(key),
            MaterialUse::Interface => None,
        }
    }

    /// Whether it matters which side of a surface is its front.
    pub(super) fn has_sides(&self, key: &str) -> bool {
        self.any_material(key, 0, &|material| match &material.kind {
            MaterialKind::Dielectric(_) => true,
            MaterialKind::Principled(m) => m.is_solid(),
            _ => false,
        })
    }

    /// Whether a texture of a material lies by the surface's own coordinates.
    pub(super) fn has_uv_textures(&self, key: &str) -> bool {
        let lies = |name: &Sourced<String>| self.lies_by_uv(name);
        self.any_material(key, 0, &|material| textures_of(material).into_iter().any(lies))
    }

    /// Whether one of the materials of which a mix is made is such.
    fn any_material(&self, key: &str, depth: u32, is: &impl Fn(&Material) -> bool) -> bool {
        let Some(material) = self.desc.materials.get(key).filter(|_| depth < 8) else { return false };
        let below = |part: &MaterialRef| match part {
            MaterialRef::Named(name) => self.any_material(name, depth + 1, is),
            MaterialRef::Inline(material) => is(material),
        };
        match &material.kind {
            MaterialKind::Mix { a, b, .. } => is(material) || below(a) || below(b),
            _ => is(material),
        }
    }
}

/// The names of the textures that a material has itself.
fn textures_of(material: &Material) -> Vec<&Sourced<String>> {
    let mut names: Vec<&Sourced<String>> = material.normal_map.iter().chain(&material.bump_map).collect();
    let mut numbers = vec![&material.opacity, &material.rotation];
    let mut colors = Vec::new();
    let mut roughness = None;
    match &material.kind {
        MaterialKind::Diffuse { color } | MaterialKind::Mirror { color } => colors.push(color),
        MaterialKind::Phong { diffuse, specular, exponent } => {
            colors.extend([diffuse, specular]);
            numbers.push(exponent);
        }
        MaterialKind::Dielectric(m) => {
            colors.extend([&m.color, &m.specular]);
            roughness = Some(&m.roughness);
        }
        MaterialKind::Conductor(m) => {
            colors.push(&m.specular);
            roughness = Some(&m.roughness);
        }
        MaterialKind::Plastic { color, roughness: r, .. } => {
            colors.push(color);
            roughness = Some(r);
        }
        MaterialKind::RoughDiffuse { color, roughness } | MaterialKind::Sheen { color, roughness } => {
            colors.push(color);
            numbers.push(roughness);
        }
        MaterialKind::DiffuseTransmission { reflectance, transmittance } => {
            colors.extend([reflectance, transmittance]);
        }
        MaterialKind::ThinDielectric(m) => {
            colors.extend([&m.color, &m.specular]);
            roughness = Some(&m.roughness);
        }
        MaterialKind::CoatedDiffuse(m) => {
            colors.extend([&m.color, &m.specular]);
            roughness = Some(&m.roughness);
        }
        MaterialKind::CoatedConductor(m) => {
            numbers.push(&m.coat_roughness);
            roughness = Some(&m.roughness);
        }
        MaterialKind::Principled(m) => {
            colors.extend([&m.base_color, &m.specular_color, &m.sheen_color]);
            numbers.extend([&m.metallic, &m.specular, &m.transmission, &m.diffuse_transmission]);
            numbers.extend([&m.sheen_roughness, &m.clearcoat, &m.clearcoat_roughness, &m.film]);
            numbers.push(&m.film_thickness_nm);
            roughness = Some(&m.roughness);
        }
        MaterialKind::Mix { amount, .. } => numbers.push(amount),
    }
    if let Some(
        Roughness::Perceived { roughness: a, anisotropy: b } | Roughness::Alpha { along: a, across: b },
    ) = roughness
    {
        numbers.extend([a, b]);
    }
    names.extend(numbers.into_iter().filter_map(FloatDesc::named));
    names.extend(colors.into_iter().filter_map(ColorDesc::named));
    names
}
