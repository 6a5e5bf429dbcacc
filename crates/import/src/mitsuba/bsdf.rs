//! BSDFs: those that change others, and materials by use.
//!
//! A BSDF of Mitsuba is black from behind unless light passes through it or it stands in `twosided`.

use std::rc::Rc;

use scenefile::desc::{ColorDesc, FloatDesc, Material, MaterialKind, MaterialRef, Texture};
use scenefile::{Diagnostic, Sourced, Span};

use super::Importer;
use super::plugin::{Param, Plugin, Tag, Value};
use crate::names::free_name;
use crate::report::nearest;

/// BSDFs within BSDFs, at most.
const MOST_DEEP: usize = 24;

/// Which way texture coordinates count on the shapes that a material is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Uv {
    /// v grows toward a picture's top, as in OBJ files, whose v Mitsuba turns.
    Up,
    /// v grows toward its bottom, as Mitsuba has it.
    Down,
}

/// What a material is for, beside its BSDF.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Use {
    pub uv: Uv,
    /// What the inside absorbs, per unit of length.
    pub absorption: [f32; 3],
}

/// A use of a plugin.
pub(super) type UseKey = (usize, Uv, [u32; 3]);

impl Use {
    pub(super) fn key(&self, plugin: &Plugin) -> UseKey {
        (plugin.index, self.uv, self.absorption.map(f32::to_bits))
    }
}

impl Importer {
    /// The material of a BSDF; `None`: nothing scatters.
    pub(super) fn material(&mut self, plugin: &Rc<Plugin>, used: Use) -> Option<String> {
        let key = used.key(plugin);
        if let Some(known) = self.materials.get(&key) {
            return known.clone();
        }
        let before = self.texture_uses;
        let name = self.bsdf(plugin, used, 0).map(|material| {
            let name = free_name(&self.desc.materials, plugin.label());
            if self.texture_uses > before {
                self.textured.insert(name.clone());
            }
            self.desc.materials.insert(name.clone(), Sourced::at(material, plugin.span));
            name
        });
        self.materials.insert(key, name.clone());
        name
    }

    /// `depth`: BSDFs around it. `None`: nothing scatters.
    pub(super) fn bsdf(&mut self, plugin: &Rc<Plugin>, used: Use, depth: usize) -> Option<Material> {
        if depth > MOST_DEEP {
            let text = format!("BSDFs are nested more than {MOST_DEEP} deep");
            let error = Diagnostic::error("cycle", text).at(plugin.span);
            self.report.push(error.help("a BSDF must not contain itself"));
            return None;
        }
        let made = match plugin.kind.as_str() {
            "twosided" => self.two_sided(plugin, used, depth),
            "mask" => self.mask(plugin, used, depth),
            "blendbsdf" => self.blend(plugin, used, depth),
            "mixturebsdf" => self.mixture(plugin, used, depth),
            "bumpmap" | "bump" => self.bump(plugin, used, depth),
            "normalmap" => self.normal_map(plugin, used, depth),
            "coating" | "roughcoating" => self.coating(plugin, used, depth),
            "null" => None,
            _ => Some(self.scattering(plugin, used)),
        };
        plugin.finish(&mut self.report);
        made
    }

    /// The BSDFs within one, in order.
    pub(super) fn nested_bsdfs(&mut self, plugin: &Rc<Plugin>) -> Vec<Rc<Plugin>> {
        self.children(plugin, Tag::Bsdf)
    }

    /// The one BSDF within; another number is an error.
    pub(super) fn nested(&mut self, plugin: &Rc<Plugin>, used: Use, depth: usize) -> Option<Material> {
        let nested = self.nested_bsdfs(plugin);
        if let [one] = &nested[..] {
            return self.bsdf(one, used, depth + 1);
        }
        let text = format!("{} needs one BSDF within, but has {}", plugin.what(), nested.len());
        self.report.error("missing-parameter", text, plugin.span);
        None
    }

    fn two_sided(&mut self, plugin: &Rc<Plugin>, used: Use, depth: usize) -> Option<Material> {
        let nested = self.nested_bsdfs(plugin);
        if nested.len() == 2 && nested[0].index != nested[1].index {
            let text = "sides of different BSDFs are not rendered";
            self.report.instead(text, "the first one is on both", plugin.span);
        } else if nested.is_empty() || nested.len() > 2 {
            let text = format!("{} needs one or two BSDFs within, but has {}", plugin.what(), nested.len());
            self.report.error("missing-parameter", text, plugin.span);
            return None;
        }
        let mut material = self.bsdf(&nested[0], used, depth + 1)?;
        each_part(&mut material, &mut |m| m.two_sided = true);
        Some(material)
    }

    fn mask(&mut self, plugin: &Rc<Plugin>, used: Use, depth: usize) -> Option<Material> {
        let opacity = self.float(plugin, "opacity", 0.5, used.uv);
        let material = self.nested(plugin, used, depth)?;
        Some(self.masked(material, opacity, plugin.span))
    }

    /// Of a material only so much.
    fn masked(&mut self, mut material: Material, opacity: FloatDesc, span: Span) -> Material {
        material.opacity = match (material.opacity, opacity) {
            (FloatDesc::Value(a), FloatDesc::Value(b)) => FloatDesc::Value((a * b).clamp(0.0, 1.0)),
            (FloatDesc::Value(1.0), other) => other,
            (a, b) => {
                let texture = Texture::Product { a: color_of(a), b: color_of(b) };
                FloatDesc::Texture(Sourced::at(self.add_texture("opacity", texture, span), span))
            }
        };
        material
    }

    fn blend(&mut self, plugin: &Rc<Plugin>, used: Use, depth: usize) -> Option<Material> {
        let amount = self.float(plugin, "weight", 0.5, used.uv);
        let nested = self.nested_bsdfs(plugin);
        let [a, b] = &nested[..] else {
            let text = format!("{} needs two BSDFs within, but has {}", plugin.what(), nested.len());
            self.report.error("missing-parameter", text, plugin.span);
            return None;
        };
        let [a, b] = [a, b].map(|bsdf| self.bsdf(bsdf, used, depth + 1));
        self.mixed(a, b, amount, plugin.span)
    }

    /// `b` by the share `amount`, else `a`; where one scatters nothing its share lets light pass.
    fn mixed(
        &mut self,
        a: Option<Material>,
        b: Option<Material>,
        amount: FloatDesc,
        span: Span,
    ) -> Option<Material> {
        match (a, b, amount) {
            (a, _, FloatDesc::Value(t)) if t <= 0.0 => a,
            (_, b, FloatDesc::Value(t)) if t >= 1.0 => b,
            (Some(a), Some(b), amount) => {
                let [a, b] = [a, b].map(MaterialRef::from);
                Some(MaterialKind::Mix { a, b, amount }.into())
            }
            (None, Some(b), amount) => Some(self.masked(b, amount, span)),
            (Some(a), None, FloatDesc::Value(t)) => Some(self.masked(a, FloatDesc::Value(1.0 - t), span)),
            (Some(a), None, amount) => {
                let texture = Texture::Mix { a: 1.0.into(), b: 0.0.into(), amount };
                let name = self.add_texture("opacity", texture, span);
                Some(self.masked(a, FloatDesc::Texture(Sourced::at(name, span)), span))
            }
            (None, None, _) => None,
        }
    }

    /// Mitsuba 0.6: any number of BSDFs, each with its weight.
    fn mixture(&mut self, plugin: &Rc<Plugin>, used: Use, depth: usize) -> Option<Material> {
        let nested = self.nested_bsdfs(plugin);
        let weights =
            plugin.text(&mut self.report, "weights").and_then(super::build::numbers).unwrap_or_default();
        if nested.is_empty() || weights.len() != nested.len() || weights.iter().any(|w| *w < 0.0) {
            let text = format!("{} needs a weight ≥ 0 for each BSDF within", plugin.what());
            self.report.error("missing-parameter", text, plugin.span);
            return None;
        }
        let mut all: Option<Material> = None;
        let mut sum = 0.0;
        for (bsdf, weight) in nested.iter().zip(weights) {
            let part = self.bsdf(bsdf, used, depth + 1);
            sum += weight;
            if weight > 0.0 {
                let share = (weight / sum) as f32;
                all = if share >= 1.0 { part } else { self.mixed(all, part, share.into(), plugin.span) };
            }
        }
        if sum < 0.999 {
            // What has no share absorbs.
            let black = Some(Material::diffuse(0.0));
            all = self.mixed(black, all, (sum as f32).into(), plugin.span);
        } else if sum > 1.001 {
            let text = "the weights of a mixture add up to more than 1";
            self.report.instead(text, "they are made smaller", plugin.span);
        }
        all
    }

    fn bump(&mut self, plugin: &Rc<Plugin>, used: Use, depth: usize) -> Option<Material> {
        let scale = plugin.number_or(&mut self.report, "scale", 1.0);
        let map = self.only_texture(plugin, used.uv);
        let mut material = self.nested(plugin, used, depth)?;
        if let Some(ColorDesc::Texture(name)) = map {
            each_part(&mut material, &mut |m| {
                m.bump_map = Some(name.clone());
                m.bump_height = scale as f32;
            });
        }
        Some(material)
    }

    fn normal_map(&mut self, plugin: &Rc<Plugin>, used: Use, depth: usize) -> Option<Material> {
        plugin.ignore(&["flip_invalid_normals", "use_shadowing_function"]);
        let map = self.only_texture(plugin, used.uv);
        let mut material = self.nested(plugin, used, depth)?;
        if used.uv == Uv::Down {
            let text = "a normal map on a shape whose pictures stand on their heads is not rendered as it is";
            self.report.instead(text, "its green channel counts the other way", plugin.span);
        }
        if let Some(ColorDesc::Texture(name)) = map {
            each_part(&mut material, &mut |m| m.normal_map = Some(name.clone()));
        }
        Some(material)
    }

    /// The texture within, whatever its name.
    fn only_texture(&mut self, plugin: &Rc<Plugin>, uv: Uv) -> Option<ColorDesc> {
        let textures = self.children(plugin, Tag::Texture);
        let Some(texture) = textures.first() else {
            let text = format!("{} needs a texture within", plugin.what());
            self.report.error("missing-parameter", text, plugin.span);
            return None;
        };
        Some(self.texture(texture, uv, 0))
    }

    /// The plugin that a parameter names or holds; an unknown id is an error.
    pub(super) fn resolve(&mut self, param: &Param) -> Option<Rc<Plugin>> {
        match &param.value {
            Value::Plugin(plugin) => Some(plugin.clone()),
            Value::Reference(id) => {
                let found = self.ids.get(id).cloned();
                if found.is_none() {
                    let help = nearest(id, self.ids.keys().map(String::as_str));
                    let wrong = Diagnostic::error("unknown-id", format!("nothing has the id `{id}`"));
                    let help = help.map(|n| format!("did you mean `{n}`?"));
                    self.report.push(wrong.at(param.span).maybe_help(help));
                }
                found
            }
            _ => None,
        }
    }

    /// What a plugin has within or refers to that is for one thing; they count as used.
    pub(super) fn children(&mut self, plugin: &Plugin, tag: Tag) -> Vec<Rc<Plugin>> {
        let mut found = Vec::new();
        for param in &plugin.params {
            let is = |p: &Rc<Plugin>| p.tag == tag;
            let wanted = match &param.value {
                Value::Plugin(child) => is(child),
                Value::Reference(id) => self.ids.get(id).is_none_or(is),
                _ => false,
            };
            if wanted {
                param.mark();
                found.extend(self.resolve(param));
            }
        }
        found
    }
}

/// A material and all that it is mixed of.
pub(super) fn each_part(material: &mut Material, f: &mut dyn FnMut(&mut Material)) {
    f(material);
    if let MaterialKind::Mix { a, b, .. } = &mut material.kind {
        for part in [a, b] {
            if let MaterialRef::Inline(part) = part {
                each_part(part, f);
            }
        }
    }
}

fn color_of(float: FloatDesc) -> ColorDesc {
    match float {
        FloatDesc::Value(x) => x.into(),
        FloatDesc::Texture(name) => ColorDesc::Texture(name),
    }
}
