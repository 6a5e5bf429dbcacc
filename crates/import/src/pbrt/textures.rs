//! Textures.

use std::collections::HashMap;

use scenefile::desc::{
    ColorDesc, ColorSpace, FloatDesc, Image, ImageSource, Mapping, Texture, TextureFilter, Wrap,
};
use scenefile::{Sourced, Span};

use super::Importer;
use super::params::{Param, Params};
use super::parser::Parsed;
use super::state::Target;

/// pbrt's textures by name: numbers and colours have names of their own.
#[derive(Debug, Default)]
pub(super) struct Textures {
    floats: HashMap<String, ColorDesc>,
    colors: HashMap<String, ColorDesc>,
}

/// Scale and offset of texture coordinates.
struct Placed {
    scale: [f32; 2],
    offset: [f32; 2],
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

    /// A parameter of a texture, which is a number, a colour or another texture.
    fn texture_input(&mut self, params: &Params, name: &str, default: f32, float: bool) -> ColorDesc {
        let value = if float {
            self.float(params, name).map(|value| match value {
                FloatDesc::Value(x) => ColorDesc::Rgb([x; 3]),
                FloatDesc::Texture(name) => ColorDesc::Texture(name),
            })
        } else {
            self.albedo(params, name)
        };
        value.unwrap_or(ColorDesc::Rgb([default; 3]))
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
        match class {
            "constant" => Some(input(self, "value", 1.0)),
            "imagemap" => self.image(name, params),
            "checkerboard" => {
                let (a, b) = (input(self, "tex1", 1.0), input(self, "tex2", 0.0));
                if params.integer(&mut self.report, "dimension", 2, [2, 3]) == 3 {
                    let text = "a checkerboard in space is not rendered";
                    self.report.instead(text, "it lies on the surface", params.span);
                }
                let Placed { scale, offset } = self.mapping(params);
                if offset != [0.0; 2] {
                    let text = "the offset of a checkerboard is not rendered";
                    self.report.instead(text, "it begins at the origin", params.span);
                }
                params.ignore(&["aamode"]);
                // pbrt's squares have side 1, ours 1/2.
                Some(self.add_texture(
                    name,
                    Texture::Checker { a, b, mapping: Mapping::scaled(scale.map(|s| s / 2.0)) },
                    params.span,
                ))
            }
            "scale" => {
                // Version 3 names the two alike.
                let [first, second] = if params.any("tex1").is_some() || params.any("tex2").is_some() {
                    ["tex1", "tex2"]
                } else {
                    ["tex", "scale"]
                };
                let (a, b) = (input(self, first, 1.0), input(self, second, 1.0));
                Some(self.product(a, b, params.span))
            }
            "mix" => {
                let (a, b) = (input(self, "tex1", 0.0), input(self, "tex2", 1.0));
                let amount = self.float(params, "amount").unwrap_or(0.5.into());
                Some(match (a, b, amount) {
                    (ColorDesc::Rgb(a), ColorDesc::Rgb(b), FloatDesc::Value(t)) => {
                        ColorDesc::Rgb([0, 1, 2].map(|i| (1.0 - t) * a[i] + t * b[i]))
                    }
                    (a, b, amount) => {
                        let text = "a mix of textures is not rendered";
                        self.report.instead(
                            text,
                            "the one of the greater share takes its place",
                            params.span,
                        );
                        if matches!(amount, FloatDesc::Value(t) if t > 0.5) { b } else { a }
                    }
                })
            }
            "bilerp" => {
                let corners = ["v00", "v01", "v10", "v11"];
                let colors =
                    corners.map(|c| match input(self, c, if c.ends_with('1') { 1.0 } else { 0.0 }) {
                        ColorDesc::Rgb(rgb) => rgb,
                        ColorDesc::Texture(_) => [0.5; 3],
                    });
                self.mapping(params);
                self.flat(class, params);
                let mean = |i: usize| colors.iter().map(|c| c[i]).sum::<f32>() / 4.0;
                Some(ColorDesc::Rgb([0, 1, 2].map(mean)))
            }
            "dots" => {
                let _ = input(self, "inside", 1.0);
                let outside = input(self, "outside", 0.0);
                self.mapping(params);
                self.flat(class, params);
                Some(outside)
            }
            "fbm" | "wrinkled" | "windy" | "marble" | "uv" | "ptex" | "directionmix" => {
                params.ignore(&["octaves", "roughness", "scale", "variation", "filename", "encoding"]);
                params.ignore(&["tex1", "tex2", "dir", "mapping", "uscale", "vscale", "udelta", "vdelta"]);
                self.flat(class, params);
                Some(ColorDesc::Rgb([0.5; 3]))
            }
            _ => {
                self.report.error("unknown-kind", format!("there is no texture `{class}`"), at);
                None
            }
        }
    }

    fn flat(&mut self, class: &str, params: &Params) {
        let text = format!("the texture `{class}` is not rendered");
        self.report.instead(text, "its surfaces have one colour", params.span);
    }

    fn product(&mut self, a: ColorDesc, b: ColorDesc, span: Span) -> ColorDesc {
        match (a, b) {
            (ColorDesc::Rgb(a), ColorDesc::Rgb(b)) => ColorDesc::Rgb([0, 1, 2].map(|i| a[i] * b[i])),
            (texture, ColorDesc::Rgb([1.0, 1.0, 1.0])) | (ColorDesc::Rgb([1.0, 1.0, 1.0]), texture) => {
                texture
            }
            (ColorDesc::Texture(name), _) | (_, ColorDesc::Texture(name)) => {
                let text = "a scaled texture is not rendered";
                self.report.instead(text, "it is taken as it is", span);
                ColorDesc::Texture(name)
            }
        }
    }

    fn mapping(&mut self, params: &Params) -> Placed {
        let names = ["uscale", "vscale", "udelta", "vdelta"];
        let [us, vs, ud, vd] = names.map(|name| params.number(name).map(|x| x as f32));
        if let Some(mapping) = params.find("mapping", &["string"])
            && mapping.text() != Some("uv")
        {
            let text =
                format!("the texture mapping `{}` is not rendered", mapping.text().unwrap_or_default());
            self.report.instead(text, "the surface's own coordinates are used", mapping.span);
            params.ignore(&["v1", "v2"]);
        }
        Placed {
            scale: [us.unwrap_or(1.0), vs.unwrap_or(1.0)],
            offset: [ud.unwrap_or(0.0), vd.unwrap_or(0.0)],
        }
    }

    fn image(&mut self, name: &str, params: &Params) -> Option<ColorDesc> {
        let Some(file) = params.find("filename", &["string"]) else {
            let text = format!("{} has no `filename`", params.what);
            self.report.error("missing-parameter", text, params.span);
            return None;
        };
        let path = self.find_file(file.text().unwrap_or_default());
        let Placed { scale, offset } = self.mapping(params);
        let color_space = match params.text("encoding") {
            None | Some("sRGB") => ColorSpace::Srgb,
            Some("linear") => ColorSpace::Linear,
            Some(other) => {
                let text = format!("the encoding `{other}` is not known");
                self.report.instead(text, "the texture is read as sRGB", params.span);
                ColorSpace::Srgb
            }
        };
        // Version 3.
        let color_space = if params.truth("gamma") == Some(false) { ColorSpace::Linear } else { color_space };
        let wrap = match params.text("wrap") {
            None | Some("repeat") => Wrap::Repeat,
            Some("clamp") => Wrap::Clamp,
            Some(other) => {
                let text = format!("the wrap mode `{other}` is not rendered");
                self.report.instead(text, "the border's texels are repeated", params.span);
                Wrap::Clamp
            }
        };
        let filter = match params.text("filter") {
            Some("point") => TextureFilter::Nearest,
            Some("trilinear" | "ewa") => TextureFilter::Trilinear,
            _ => TextureFilter::Bilinear,
        };
        params.ignore(&["maxanisotropy", "trilinear"]);
        let unusual =
            params.number("scale").is_some_and(|s| s != 1.0) || params.truth("invert") == Some(true);
        if unusual {
            let text = "a scaled or inverted image is not rendered";
            self.report.instead(text, "it is taken as it is", params.span);
        }
        let file = Sourced::at(path, file.span);
        let image = Image {
            color_space,
            wrap: [wrap; 2],
            filter,
            mapping: Mapping::Uv { set: 0, scale, rotation: 0.0, offset },
            ..Image::new(ImageSource::File(file))
        };
        Some(self.add_texture(name, Texture::Image(image), params.span))
    }

    fn add_texture(&mut self, name: &str, texture: Texture, span: Span) -> ColorDesc {
        let key = crate::names::free_name(&self.desc.textures, name);
        self.desc.textures.insert(key.clone(), Sourced::at(texture, span));
        ColorDesc::Texture(Sourced::at(key, span))
    }
}
