//! Textures, and parameters that may be one.

use std::rc::Rc;

use scenefile::desc::{
    Channel, ColorDesc, ColorSpace, FloatDesc, Image, ImageSource, Mapping, Texture, TextureFilter, Wrap,
};
use scenefile::{Diagnostic, Sourced, Span};

use super::Importer;
use super::bsdf::Uv;
use super::plugin::{Plugin, Tag, Value};
use super::transform::UvMap;
use crate::matrix::narrow;
use crate::names::free_name;
use crate::report::nearest;

/// Textures within textures, at most.
const MOST_DEEP: usize = 16;

/// Kinds that are known, for those that are not.
const KINDS: [&str; 16] = [
    "bitmap",
    "checkerboard",
    "mesh_attribute",
    "vertexcolors",
    "scale",
    "gridtexture",
    "volume",
    "curvature",
    "wireframe",
    "ldrtexture",
    "uniform",
    "srgb",
    "d65",
    "blackbody",
    "regular",
    "irregular",
];

impl Importer {
    /// A reflectance or the like, 0..=1, by any of the names.
    pub(super) fn color(&mut self, plugin: &Rc<Plugin>, names: &[&str], default: f32, uv: Uv) -> ColorDesc {
        let Some(param) = plugin.find_any(names) else { return default.into() };
        let rgb = match &param.value {
            Value::Number(x) => [*x; 3],
            Value::Triple(rgb) => *rgb,
            Value::Color(color) => color.reflectance(),
            Value::Plugin(_) | Value::Reference(_) => {
                let Some(texture) = self.resolve(param) else { return default.into() };
                match self.spectrum_plugin(&texture) {
                    Some(color) => color.reflectance(),
                    None => return self.texture(&texture, uv, 0),
                }
            }
            _ => return self.wrong_color(plugin, &param.name.clone(), param.span, default),
        };
        ColorDesc::Rgb(self.within_one(rgb, &plugin.what(), param.span))
    }

    fn wrong_color(&mut self, plugin: &Plugin, name: &str, span: Span, default: f32) -> ColorDesc {
        let text = format!("`{name}` of {} must be a colour", plugin.what());
        self.report.error("parameter", text, span);
        default.into()
    }

    /// Moved into 0..=1; that changes what is rendered if it is off by more than rounding.
    fn within_one(&mut self, rgb: [f64; 3], what: &str, span: Span) -> [f32; 3] {
        if rgb.iter().any(|c| !(-1e-3..=1.001).contains(c)) {
            let text = format!("a colour of {what} is not within 0 and 1");
            self.report.instead(text, "it is moved there", span);
        }
        narrow(rgb.map(|c| c.clamp(0.0, 1.0)))
    }

    /// A number or a texture of numbers.
    pub(super) fn float(&mut self, plugin: &Rc<Plugin>, name: &str, default: f32, uv: Uv) -> FloatDesc {
        let Some(param) = plugin.find(name) else { return default.into() };
        let mean = |rgb: [f64; 3]| FloatDesc::Value((rgb.iter().sum::<f64>() / 3.0) as f32);
        match &param.value {
            Value::Number(x) => FloatDesc::Value(*x as f32),
            Value::Triple(rgb) => mean(*rgb),
            Value::Color(color) => mean(color.reflectance()),
            Value::Plugin(_) | Value::Reference(_) => {
                let Some(texture) = self.resolve(param) else { return default.into() };
                if let Some(color) = self.spectrum_plugin(&texture) {
                    return mean(color.reflectance());
                }
                match self.texture(&texture, uv, 0) {
                    ColorDesc::Rgb(rgb) => mean(rgb.map(f64::from)),
                    ColorDesc::Texture(name) => FloatDesc::Texture(name),
                }
            }
            _ => {
                let text = format!("`{name}` of {} must be a number", plugin.what());
                self.report.error("parameter", text, param.span);
                default.into()
            }
        }
    }

    /// An index or coefficient by channel.
    pub(super) fn channels(&mut self, plugin: &Plugin, name: &str) -> Option<[f64; 3]> {
        let param = plugin.find(name)?;
        match &param.value {
            Value::Number(x) => Some([*x; 3]),
            Value::Triple(rgb) => Some(*rgb),
            Value::Color(color) => Some(color.channels()),
            Value::Plugin(_) | Value::Reference(_) => {
                let texture = self.resolve(param)?;
                if let Some(color) = self.spectrum_plugin(&texture) {
                    return Some(color.channels());
                }
                let text = format!("`{name}` of {} as a texture is not rendered", plugin.what());
                self.report.instead(text, "its default is taken", param.span);
                None
            }
            _ => None,
        }
    }

    /// What a light emits: its colour, and a texture that is a factor on it.
    pub(super) fn light_color(
        &mut self,
        plugin: &Rc<Plugin>,
        name: &str,
        uv: Uv,
    ) -> ([f64; 3], Option<Sourced<String>>) {
        let Some(param) = plugin.find(name) else { return ([1.0; 3], None) };
        let rgb = match &param.value {
            Value::Number(x) => [*x; 3],
            Value::Triple(rgb) => *rgb,
            Value::Color(color) => color.light(),
            Value::Plugin(_) | Value::Reference(_) => {
                let Some(texture) = self.resolve(param) else { return ([1.0; 3], None) };
                match self.spectrum_plugin(&texture) {
                    Some(color) => color.light(),
                    None => match self.texture(&texture, uv, 0) {
                        ColorDesc::Rgb(rgb) => rgb.map(f64::from),
                        ColorDesc::Texture(name) => return ([1.0; 3], Some(name)),
                    },
                }
            }
            _ => {
                self.wrong_color(plugin, name, param.span, 0.0);
                [0.0; 3]
            }
        };
        if rgb.iter().any(|c| *c < 0.0) {
            let text = format!("a colour of {} lies outside Rec. 709", plugin.what());
            self.report.instead(text, "its negative channels are 0", param.span);
        }
        (rgb.map(|c| c.max(0.0)), None)
    }

    /// Keeps a texture under a name near `wanted`.
    pub(super) fn add_texture(&mut self, wanted: &str, texture: Texture, span: Span) -> String {
        let name = free_name(&self.desc.textures, wanted);
        self.desc.textures.insert(name.clone(), Sourced::at(texture, span));
        name
    }

    /// `depth`: textures around it.
    pub(super) fn texture(&mut self, plugin: &Rc<Plugin>, uv: Uv, depth: usize) -> ColorDesc {
        let key = (plugin.index, uv);
        self.texture_uses += 1;
        if let Some(known) = self.textures.get(&key) {
            return known.clone();
        }
        if depth > MOST_DEEP {
            let text = format!("textures are nested more than {MOST_DEEP} deep");
            let error = Diagnostic::error("cycle", text).at(plugin.span);
            self.report.push(error.help("a texture must not contain itself"));
            return 0.5.into();
        }
        let made = self.made_texture(plugin, uv, depth);
        plugin.finish(&mut self.report);
        let made = match made {
            Made::Color(color) => color,
            Made::Texture(texture) => {
                let name = self.add_texture(plugin.label(), texture, plugin.span);
                ColorDesc::Texture(Sourced::at(name, plugin.span))
            }
        };
        self.textures.insert(key, made.clone());
        made
    }

    fn made_texture(&mut self, plugin: &Rc<Plugin>, uv: Uv, depth: usize) -> Made {
        if plugin.tag == Tag::Texture
            && let Some(color) = self.spectrum_plugin(plugin)
        {
            return Made::Color(ColorDesc::Rgb(narrow(color.reflectance())));
        }
        match plugin.kind.as_str() {
            "bitmap" | "ldrtexture" => match self.image(plugin, uv) {
                Some(image) => Made::Texture(Texture::Image(image)),
                None => Made::Color(0.5.into()),
            },
            "checkerboard" => {
                let [a, b] = [("color0", 0.4), ("color1", 0.2)]
                    .map(|(name, default)| self.color(plugin, &[name], default, uv));
                let map = self.uv_map(plugin);
                let map = if uv == Uv::Up { map.after(&UvMap::FLIP) } else { map };
                Made::Texture(Texture::Checker { a, b, mapping: self.mapping(&map, plugin.span) })
            }
            "mesh_attribute" | "vertexcolors" => {
                if let Some(name) = plugin.text(&mut self.report, "name").map(str::to_owned)
                    && name != "vertex_color"
                {
                    let text = format!("the attribute `{name}` of a mesh is not rendered");
                    self.report.instead(text, "the colours of its vertices are", plugin.span);
                }
                let scale = plugin.number_or(&mut self.report, "scale", 1.0);
                let colors = Texture::VertexColor { channel: Channel::Rgb };
                if scale == 1.0 {
                    return Made::Texture(colors);
                }
                let name = self.add_texture(plugin.label(), colors, plugin.span);
                let a = ColorDesc::Texture(Sourced::at(name, plugin.span));
                Made::Texture(Texture::Product { a, b: (scale as f32).into() })
            }
            "scale" => self.scaled(plugin, uv, depth),
            "gridtexture" => {
                let text = "the texture `gridtexture` is not rendered";
                self.report.instead(text, "the colour between its lines is everywhere", plugin.span);
                let ground = self.color(plugin, &["color0"], 0.2, uv);
                plugin.ignore(&["color1", "line_width"]);
                self.uv_map(plugin);
                Made::Color(ground)
            }
            kind if KINDS.contains(&kind) => {
                let text = format!("the texture `{kind}` is not rendered");
                self.report.instead(text, "its surfaces are grey", plugin.span);
                plugin.params.iter().for_each(|p| p.mark());
                Made::Color(0.5.into())
            }
            kind => {
                let wrong = Diagnostic::error("unknown-kind", format!("there is no texture `{kind}`"));
                let help = nearest(kind, KINDS.into_iter()).map(|n| format!("did you mean `{n}`?"));
                self.report.push(wrong.at(plugin.kind_span).maybe_help(help));
                plugin.params.iter().for_each(|p| p.mark());
                Made::Color(0.5.into())
            }
        }
    }

    /// Mitsuba 0.6: a texture times a number or colour.
    fn scaled(&mut self, plugin: &Rc<Plugin>, uv: Uv, depth: usize) -> Made {
        let scale = self.channels(plugin, "scale").unwrap_or([1.0; 3]);
        let nested = self.children(plugin, Tag::Texture);
        let Some(nested) = nested.first() else {
            let text = format!("{} needs a texture within", plugin.what());
            self.report.error("missing-parameter", text, plugin.span);
            return Made::Color(0.5.into());
        };
        match self.texture(nested, uv, depth + 1) {
            ColorDesc::Rgb(rgb) => Made::Color(ColorDesc::Rgb([0, 1, 2].map(|i| rgb[i] * scale[i] as f32))),
            ColorDesc::Texture(name) => {
                if let Some(Texture::Image(image)) = self.desc.textures.get(&name.value).map(|t| &t.value) {
                    let factor = [0, 1, 2].map(|i| image.factor[i] * scale[i] as f32);
                    return Made::Texture(Texture::Image(Image { factor, ..image.clone() }));
                }
                Made::Texture(Texture::Product {
                    a: ColorDesc::Texture(name),
                    b: ColorDesc::Rgb(narrow(scale)),
                })
            }
        }
    }

    /// What is done to texture coordinates.
    fn uv_map(&mut self, plugin: &Plugin) -> UvMap {
        let map = UvMap::of(&plugin.place(&mut self.report, "to_uv"));
        let both = plugin.number_or(&mut self.report, "uvscale", 1.0);
        let mut number = |names: [&str; 2], default| {
            names.iter().find_map(|n| plugin.number(&mut self.report, n)).unwrap_or(default)
        };
        let scale = [number(["uscale", "u_scale"], both), number(["vscale", "v_scale"], both)];
        let offset = [number(["uoffset", "u_offset"], 0.0), number(["voffset", "v_offset"], 0.0)];
        UvMap::scaled(scale, offset).after(&map)
    }

    fn mapping(&mut self, map: &UvMap, span: Span) -> Mapping {
        match map.parts() {
            Some((scale, rotation, offset)) => Mapping::Uv { set: 0, scale, rotation, offset },
            None => {
                let text = "texture coordinates that are sheared or flat are not rendered";
                self.report.instead(text, "they are taken as they are", span);
                Mapping::default()
            }
        }
    }

    /// The image of a plugin with a `filename`; `None` where there is none, which is reported.
    pub(super) fn image(&mut self, plugin: &Plugin, uv: Uv) -> Option<Image> {
        let file = self.image_file(plugin)?;
        let report = &mut self.report;
        let raw = plugin.is(report, "raw");
        // Version 0.6: 1 is linear, −1 as the file has it.
        let gamma = match plugin.find("gamma").map(|p| &p.value) {
            Some(Value::Number(g)) => *g,
            Some(Value::Text(g)) if g == "srgb" => 2.2,
            _ => -1.0,
        };
        if gamma > 0.0 && gamma != 1.0 && (gamma - 2.2).abs() > 0.3 {
            report.instead(
                format!("the gamma {gamma} of a texture is not imitated"),
                "it is taken as sRGB",
                plugin.span,
            );
        }
        let color_space = if raw || gamma == 1.0 { ColorSpace::Linear } else { ColorSpace::Srgb };
        let filter = match plugin.text(report, "filter_type") {
            Some("nearest") => TextureFilter::Nearest,
            Some("trilinear" | "ewa") => TextureFilter::Trilinear,
            None if plugin.old => TextureFilter::Trilinear,
            None | Some("bilinear") => TextureFilter::Bilinear,
            Some(other) => {
                let text = format!("the filter `{other}` of a texture is not known");
                report.instead(text, "it is bilinear", plugin.span);
                TextureFilter::Bilinear
            }
        };
        let both = plugin.text(report, "wrap_mode").unwrap_or("repeat").to_owned();
        let wrap =
            ["wrap_mode_u", "wrap_mode_v"].map(|name| match plugin.text(report, name).unwrap_or(&both) {
                "repeat" => Wrap::Repeat,
                "clamp" => Wrap::Clamp,
                "mirror" => Wrap::Mirror,
                "zero" => Wrap::Black,
                other => {
                    let text = format!("the wrap mode `{other}` is not rendered");
                    report.instead(text, "the border's texels are repeated", plugin.span);
                    Wrap::Clamp
                }
            });
        let channel = match plugin.text(report, "channel") {
            None | Some("all" | "rgb" | "") => Channel::Rgb,
            Some("r" | "x") => Channel::Red,
            Some("g" | "y") => Channel::Green,
            Some("b" | "z") => Channel::Blue,
            Some("a") => Channel::Alpha,
            Some(other) => {
                let text = format!("the channel `{other}` of a texture is not known");
                report.instead(text, "all are used", plugin.span);
                Channel::Rgb
            }
        };
        plugin.ignore(&["format", "max_anisotropy", "cache", "accel"]);
        // Mitsuba's pictures have v = 0 at their top, ours at their bottom.
        let map = UvMap::FLIP.after(&self.uv_map(plugin));
        let map = if uv == Uv::Up { map.after(&UvMap::FLIP) } else { map };
        let mapping = self.mapping(&map, plugin.span);
        Some(Image { color_space, wrap, filter, mapping, channel, ..Image::new(file) })
    }

    /// The picture that `filename` names; none is an error.
    pub(super) fn image_file(&mut self, plugin: &Plugin) -> Option<ImageSource> {
        let name = plugin.text(&mut self.report, "filename").map(str::to_owned);
        let Some(name) = name else {
            if let Some(param) = plugin.find_any(&["bitmap", "data"]) {
                let text = "a picture that is no file is not read";
                self.report.instead(text, "grey takes its place", param.span);
            } else {
                let text = format!("{} has no `filename`", plugin.what());
                self.report.error("missing-parameter", text, plugin.span);
            }
            return None;
        };
        let span = plugin.find("filename").map_or(plugin.span, |p| p.span);
        let path = self.find_file(&name);
        let known = path.extension().and_then(|e| e.to_str()).map(str::to_ascii_lowercase);
        let readable = ["png", "jpg", "jpeg", "hdr", "exr", "tif", "tiff", "webp"];
        if !known.is_some_and(|e| readable.contains(&e.as_str())) {
            let text = format!("the picture {name} is of a format that is not read");
            self.report.instead(text, "grey takes its place", span);
            return None;
        }
        Some(ImageSource::File(Sourced::at(path, span)))
    }
}

/// What a texture is: one colour, or varied.
enum Made {
    Color(ColorDesc),
    Texture(Texture),
}
