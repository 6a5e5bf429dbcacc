//! Names of what is written, and materials by name.

use scenefile::desc::{Material, MaterialRef};
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
    pub(super) fn current_material(&mut self, span: Span) -> Option<MaterialRef> {
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
            MaterialUse::Key(key) => Some(MaterialRef::Named(Sourced::at(key, span))),
            MaterialUse::Interface => None,
        }
    }
}
