//! Textures.

use std::collections::{HashMap, HashSet};

use scenefile::desc::{ColorDesc, FloatDesc, Image, Mapping, Noise, NoiseKind, Texture};
use scenefile::{Sourced, Span};

use super::Importer;
use super::params::{Param, Params};
use super::parser::Parsed;
use super::state::Target;
use crate::matrix::narrow;
use crate::names::free_name;

/// pbrt's textures by name: numbers and colours have names of their own.
#[derive(Debug, Default)]
pub(super) struct Textures {
    floats: HashMap<String, ColorDesc>,
    colors: HashMap<String, ColorDesc>,
}

impl Importer {
    pub(super) fn texture_directive(&mut self, span: Span) -> Parsed<()> {
        let (name, _) = self.string("Texture", span)?;
        let (kind, kind_span) = self.string("Texture", span)?;
        let (class, class_span) = self.string("Texture", span)?;
        let params = self.params(format!("the texture `{name}`"), span, Some(Target::Texture))?;
        let float = match kind.as_str() {
            "float" => true,
            "spectrum" | "color" => false,
            _ => {
                let text = format!("`{kind}` is none of float and spectrum");
                self.report.error("unknown-kind", text, kind_span);
                return Ok(());
            }
        };
        if let Some(value) = self.texture(&name, &class, class_span, &params, float) {
            let known = if float { &mut self.textures.floats } else { &mut self.textures.colors };
            known.insert(name, value);
        }
        params.finish(&mut self.report);
        Ok(())
    }

    /// A texture that a parameter names; an unknown one is an error.
    pub(super) fn color_texture(&mut self, param: &Param) -> ColorDesc {
        let name = param.text().unwrap_or_default();
        match self.textures.colors.get(name) {
            Some(ColorDesc::Rgb(rgb)) => ColorDesc::Rgb(*rgb),
            Some(ColorDesc::Texture(texture)) => {
                ColorDesc::Texture(Sourced::at(texture.value.clone(), param.span))
            }
            None => {
                let text = format!("no spectrum texture is named `{name}`");
                self.report.error("unknown-texture", text, param.span);
                ColorDesc::Rgb([0.5; 3])
            }
        }
    }

    /// The same of numbers.
    pub(super) fn float_texture(&mut self, param: &Param) -> FloatDesc {
        let name = param.text().unwrap_or_default();
        match self.textures.floats.get(name) {
            Some(ColorDesc::Rgb(rgb)) => FloatDesc::Value(rgb[0]),
            Some(ColorDesc::Texture(texture)) => {
                FloatDesc::Texture(Sourced::at(texture.value.clone(), param.span))
            }
            None => {
                let text = format!("no float texture is named `{name}`");
                self.report.error("unknown-texture", text, param.span);
                FloatDesc::Value(0.5)
            }
        }
    }

    /// A parameter of a texture, which is a number, a colour or another texture; a number's texture serves as a colour, too.
    fn texture_input(&mut self, params: &Params, name: &str, default: f32, float: bool) -> ColorDesc {
        let Some(param) = params.any(name) else { return ColorDesc::Rgb([default; 3]) };
        if param.kind == "texture" {
            let known = |textures: &HashMap<String, ColorDesc>| {
                param.text().is_some_and(|name| textures.contains_key(name))
            };
            if float || (!known(&self.textures.colors) && known(&self.textures.floats)) {
                return grey(self.float_texture(param));
            }
            return self.color_texture(param);
        }
        let value = if float { params.number(name).map(|x| [x; 3]) } else { self.unbounded(params, name) };
        ColorDesc::Rgb(value.map_or([default; 3], narrow))
    }

    fn texture(
        &mut self,
        name: &str,
        class: &str,
        at: Span,
        params: &Params,
        float: bool,
    ) -> Option<ColorDesc> {
        let input = |this: &mut Self, name, default| this.texture_input(params, name, default, float);
        let (texture, span) = match class {
            "constant" => return Some(input(self, "value", 1.0)),
            "imagemap" => return self.image_map(name, params, float),
            "checkerboard" => {
                let (a, b) = (input(self, "tex1", 1.0), input(self, "tex2", 0.0));
                if params.integer(&mut self.report, "dimension", 2, [2, 3]) == 3 {
                    let text = "a checkerboard in space is not rendered";
                    self.report.instead(text, "it lies on the surface", params.span);
                }
                // Version 3 may have its edges smoothed; so are those here, by many samples.
                params.ignore(&["aamode"]);
                // pbrt's squares have side 1, ours 1/2.
                (Texture::Checker { a, b, mapping: self.mapping(params, 0.5) }, params.span)
            }
            "scale" => {
                // Version 3 names the two alike.
                let [first, second] = if params.any("tex1").is_some() || params.any("tex2").is_some() {
                    ["tex1", "tex2"]
                } else {
                    ["tex", "scale"]
                };
                let (a, b) = (input(self, first, 1.0), input(self, second, 1.0));
                return Some(self.product(name, a, b, params.span));
            }
            "mix" => {
                let (a, b) = (input(self, "tex1", 0.0), input(self, "tex2", 1.0));
                let amount = self.float(params, "amount").unwrap_or(0.5.into());
                if let (ColorDesc::Rgb(a), ColorDesc::Rgb(b), FloatDesc::Value(t)) = (&a, &b, &amount) {
                    return Some(ColorDesc::Rgb([0, 1, 2].map(|i| (1.0 - t) * a[i] + t * b[i])));
                }
                (Texture::Mix { a, b, amount }, params.span)
            }
            "directionmix" => {
                let (a, b) = (input(self, "tex1", 0.0), input(self, "tex2", 1.0));
                params.ignore(&["dir"]);
                let text = "a mix of textures by direction is not rendered";
                self.report.instead(text, "each has half a share everywhere", params.span);
                (Texture::Mix { a, b, amount: 0.5.into() }, params.span)
            }
            "bilerp" => {
                let corners = ["v00", "v01", "v10", "v11"];
                let colors =
                    corners.map(|c| match input(self, c, if c.ends_with('1') { 1.0 } else { 0.0 }) {
                        ColorDesc::Rgb(rgb) => rgb,
                        ColorDesc::Texture(_) => [0.5; 3],
                    });
                self.mapping(params, 1.0);
                let mean = |i: usize| colors.iter().map(|c| c[i]).sum::<f32>() / 4.0;
                return Some(self.flat(class, [0, 1, 2].map(mean), params));
            }
            "dots" => {
                let (inside, outside) = (input(self, "inside", 1.0), input(self, "outside", 0.0));
                (Texture::Dots { inside, outside, mapping: self.mapping(params, 1.0) }, params.span)
            }
            "fbm" => (self.noise(NoiseKind::Fbm, params), params.span),
            "wrinkled" => (self.noise(NoiseKind::Wrinkled, params), params.span),
            "windy" => (self.noise(NoiseKind::Windy, params), params.span),
            "marble" => {
                let scale = params.number_or("scale", 1.0) as f32;
                let variation = params.number_or("variation", 0.2) as f32;
                (self.noise(NoiseKind::Marble { scale, variation }, params), params.span)
            }
            "uv" => {
                self.mapping(params, 1.0);
                return Some(self.flat(class, [0.5, 0.5, 0.0], params));
            }
            "ptex" => {
                params.ignore(&["filename", "encoding", "scale", "gamma"]);
                return Some(self.flat(class, [0.5; 3], params));
            }
            _ => {
                self.report.error("unknown-kind", format!("there is no texture `{class}`"), at);
                return None;
            }
        };
        Some(self.add_texture(name, texture, span))
    }

    fn noise(&mut self, kind: NoiseKind, params: &Params) -> Texture {
        let octaves = params.integer(&mut self.report, "octaves", 8, [1, 32]);
        let roughness = params.number_or("roughness", 0.5).clamp(0.0, 1.0) as f32;
        params.ignore(&["mapping"]);
        let transform = self.mirror.after(&self.graphics.ctm).steps();
        Texture::Noise(Noise { kind, octaves, roughness, transform })
    }

    fn flat(&mut self, class: &str, rgb: [f32; 3], params: &Params) -> ColorDesc {
        let text = format!("the texture `{class}` is not rendered");
        self.report.instead(text, "its surfaces have one colour", params.span);
        ColorDesc::Rgb(rgb)
    }

    /// The product of two; a texture of it if it is no constant.
    pub(super) fn product(&mut self, name: &str, a: ColorDesc, b: ColorDesc, span: Span) -> ColorDesc {
        match (a, b) {
            (ColorDesc::Rgb(a), ColorDesc::Rgb(b)) => ColorDesc::Rgb([0, 1, 2].map(|i| a[i] * b[i])),
            (texture, ColorDesc::Rgb([1.0, 1.0, 1.0])) | (ColorDesc::Rgb([1.0, 1.0, 1.0]), texture) => {
                texture
            }
            (a, b) => self.add_texture(name, Texture::Product { a, b }, span),
        }
    }

    /// 1 minus a number.
    pub(super) fn complement(&mut self, name: &str, value: FloatDesc, span: Span) -> FloatDesc {
        match value {
            FloatDesc::Value(x) => FloatDesc::Value(1.0 - x),
            texture => {
                let mix = Texture::Mix { a: 1.0.into(), b: 0.0.into(), amount: texture };
                number(self.add_texture(name, mix, span))
            }
        }
    }

    /// The product of two numbers.
    pub(super) fn number_product(&mut self, name: &str, a: FloatDesc, b: FloatDesc, span: Span) -> FloatDesc {
        number(self.product(name, grey(a), grey(b), span))
    }

    pub(super) fn add_texture(&mut self, name: &str, texture: Texture, span: Span) -> ColorDesc {
        let key = free_name(&self.desc.textures, name);
        self.desc.textures.insert(key.clone(), Sourced::at(texture, span));
        ColorDesc::Texture(Sourced::at(key, span))
    }

    /// Whether a texture or one that it is made of lies by the surface's own coordinates.
    pub(super) fn lies_by_uv(&self, name: &str) -> bool {
        let mut open = vec![name];
        let mut seen = HashSet::new();
        while let Some(name) = open.pop() {
            let Some(texture) = self.desc.textures.get(name).filter(|_| seen.insert(name)) else { continue };
            match &texture.value {
                Texture::Image(Image { mapping: Mapping::Uv { .. }, .. })
                | Texture::Checker { mapping: Mapping::Uv { .. }, .. }
                | Texture::Dots { mapping: Mapping::Uv { .. }, .. } => return true,
                other => open.extend(other.parts().into_iter().map(|part| part.value.as_str())),
            }
        }
        false
    }
}

/// A number as a colour.
pub(super) fn grey(value: FloatDesc) -> ColorDesc {
    match value {
        FloatDesc::Value(x) => ColorDesc::Rgb([x; 3]),
        FloatDesc::Texture(name) => ColorDesc::Texture(name),
    }
}

/// A colour as a number: the mean of its channels.
pub(super) fn number(color: ColorDesc) -> FloatDesc {
    match color {
        ColorDesc::Rgb(rgb) => FloatDesc::Value(rgb.iter().sum::<f32>() / 3.0),
        ColorDesc::Texture(name) => FloatDesc::Texture(name),
    }
}
