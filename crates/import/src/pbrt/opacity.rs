//! Surfaces that are there in part.

use scenefile::Span;
use scenefile::desc::{FloatDesc, MaterialKind};

use super::Importer;
use super::params::Params;

impl Importer {
    /// How much of a shape is there. Version 3's `shadowalpha` concerned shadows alone.
    pub(super) fn alpha(&mut self, params: &Params) -> FloatDesc {
        let alpha = self.float(params, "alpha").unwrap_or(1.0.into());
        if let Some(param) = params.any("shadowalpha")
            && param.numbers().first() != Some(&1.0)
            && params.any("alpha").map(|p| &p.values) != Some(&param.values)
        {
            let text = "shadows of their own opacity are not rendered";
            self.report.instead(text, "the surface's opacity holds for all rays", param.span);
        }
        match alpha {
            FloatDesc::Value(x) => FloatDesc::Value(x.clamp(0.0, 1.0)),
            texture => texture,
        }
    }

    /// The key of a material that is there in part: of a copy, made once for each opacity.
    pub(super) fn with_opacity(&mut self, key: &str, opacity: FloatDesc, span: Span) -> String {
        if opacity == FloatDesc::Value(1.0) {
            return key.to_owned();
        }
        let variant = match &opacity {
            FloatDesc::Value(x) => format!("{key}\n{x}"),
            FloatDesc::Texture(name) => format!("{key}\n\"{}", name.value),
        };
        if let Some(made) = self.variants.get(&variant) {
            return made.clone();
        }
        let Some(original) = self.desc.materials.get(key) else { return key.to_owned() };
        let mut copy = original.value.clone();
        copy.opacity = match std::mem::replace(&mut copy.opacity, 1.0.into()) {
            FloatDesc::Value(1.0) => opacity,
            before => self.number_product("opacity", before, opacity, span),
        };
        let super::lower::MaterialUse::Key(made) = self.add_material(&format!("{key}-cut"), copy, span)
        else {
            return key.to_owned();
        };
        self.variants.insert(variant, made.clone());
        made
    }

    /// The key of a copy of glass that absorbs, per unit of length; of the material itself if it is no glass.
    pub(super) fn with_absorption(&mut self, key: &str, absorption: [f32; 3], span: Span) -> String {
        let variant = format!("{key}\n{absorption:?}");
        if let Some(made) = self.variants.get(&variant) {
            return made.clone();
        }
        let Some(original) = self.desc.materials.get(key) else { return key.to_owned() };
        let mut copy = original.value.clone();
        let MaterialKind::Dielectric(glass) = &mut copy.kind else { return key.to_owned() };
        glass.absorption = absorption;
        let super::lower::MaterialUse::Key(made) = self.add_material(&format!("{key}-filled"), copy, span)
        else {
            return key.to_owned();
        };
        self.variants.insert(variant, made.clone());
        made
    }
}
