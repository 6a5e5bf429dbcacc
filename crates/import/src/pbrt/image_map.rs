//! Pictures on surfaces, and where textures lie.

use scenefile::Sourced;
use scenefile::desc::{
    Channel, ColorDesc, ColorSpace, Image, ImageSource, Mapping, Texture, TextureFilter, Wrap,
};

use super::Importer;
use super::params::Params;
use super::textures::number;
use crate::matrix::{Matrix, dot, narrow};
use crate::picture;

impl Importer {
    /// The texture `imagemap`: of colours, or of numbers (the mean of the channels, of a picture with holes its alpha: pbrt-v4, MIPMap).
    pub(super) fn image_map(&mut self, name: &str, params: &Params, float: bool) -> Option<ColorDesc> {
        let Some(param) = params.find("filename", &["string"]) else {
            let text = format!("{} has no `filename`", params.what);
            self.report.error("missing-parameter", text, params.span);
            return None;
        };
        let file = self.find_file(param.text().unwrap_or_default());
        let holey = float && picture::is_holey(&self.base.join(&file));
        let scale = params.number_or("scale", 1.0) as f32;
        let invert = params.truth("invert") == Some(true);
        let mut image = Image {
            color_space: self.encoding(params),
            wrap: [self.wrap(params); 2],
            filter: filter(params),
            mapping: self.mapping(params, 1.0),
            channel: if holey { Channel::Alpha } else { Channel::Rgb },
            ..Image::new(ImageSource::File(Sourced::at(file, param.span)))
        };
        // pbrt scales first: 1 − scale·x.
        if invert && scale != 1.0 {
            if !float {
                let text = "a scaled and inverted image is not rendered in colour";
                self.report.instead(text, "its mean over the channels is taken", params.span);
            }
            let map = self.add_texture(name, Texture::Image(image), params.span);
            let mix = Texture::Mix { a: 1.0.into(), b: (1.0 - scale).into(), amount: number(map) };
            return Some(self.add_texture(name, mix, params.span));
        }
        image.invert = invert;
        image.factor = [scale; 3];
        Some(self.add_texture(name, Texture::Image(image), params.span))
    }

    fn encoding(&mut self, params: &Params) -> ColorSpace {
        // Version 3.
        if params.truth("gamma") == Some(false) {
            return ColorSpace::Linear;
        }
        let Some(encoding) = params.find("encoding", &["string"]) else { return ColorSpace::Srgb };
        let text = encoding.text().unwrap_or_default();
        let gamma = text.strip_prefix("gamma").and_then(|g| g.trim().parse::<f64>().ok());
        match (text, gamma) {
            ("sRGB", _) => ColorSpace::Srgb,
            ("linear", _) | (_, Some(1.0)) => ColorSpace::Linear,
            _ => {
                let text = format!("the encoding `{text}` is not decoded exactly");
                self.report.instead(text, "the texture is read as sRGB", encoding.span);
                ColorSpace::Srgb
            }
        }
    }

    fn wrap(&mut self, params: &Params) -> Wrap {
        match params.text("wrap") {
            None | Some("repeat") => Wrap::Repeat,
            Some("clamp") => Wrap::Clamp,
            Some("black") => Wrap::Black,
            Some(other) => {
                let text = format!("the wrap mode `{other}` is not rendered");
                self.report.instead(text, "the border's texels are repeated", params.span);
                Wrap::Clamp
            }
        }
    }

    /// Where a texture lies; `shrink`: a factor on its coordinates.
    pub(super) fn mapping(&mut self, params: &Params, shrink: f64) -> Mapping {
        let delta = ["udelta", "vdelta"].map(|name| params.number_or(name, 0.0) * shrink);
        match params.text("mapping").unwrap_or("uv") {
            "uv" => {}
            "planar" => {
                if let Some(texture_from_world) = self.mirror.after(&self.graphics.ctm).inverse() {
                    let along = |axis: [f64; 3]| {
                        let gradient = texture_from_world.transposed_vector(axis).map(|x| x * shrink);
                        (narrow(gradient), dot(texture_from_world.point([0.0; 3]), axis) * shrink)
                    };
                    let (u, from_u) = along(params.point("v1").unwrap_or([1.0, 0.0, 0.0]));
                    let (v, from_v) = along(params.point("v2").unwrap_or([0.0, 1.0, 0.0]));
                    return Mapping::Planar {
                        u,
                        v,
                        offset: [(from_u + delta[0]) as f32, (from_v + delta[1]) as f32],
                    };
                }
            }
            other => {
                let text = format!("the texture mapping `{other}` is not rendered");
                self.report.instead(text, "the surface's own coordinates are used", params.span);
            }
        }
        let scale = ["uscale", "vscale"].map(|name| (params.number_or(name, 1.0) * shrink) as f32);
        Mapping::Uv { set: 0, scale, rotation: 0.0, offset: delta.map(|x| x as f32) }
    }
}

/// Version 4 has one parameter; in version 3 `trilinear` stands against EWA, its default.
fn filter(params: &Params) -> TextureFilter {
    params.ignore(&["maxanisotropy"]);
    match (params.text("filter"), params.truth("trilinear")) {
        (Some("point"), _) => TextureFilter::Nearest,
        (Some("trilinear" | "ewa" | "EWA"), _) | (None, Some(_)) => TextureFilter::Trilinear,
        _ => TextureFilter::Bilinear,
    }
}

impl Matrix {
    /// The transpose of the linear part times a vector: what it makes of gradients on the way back.
    fn transposed_vector(&self, v: [f64; 3]) -> [f64; 3] {
        [0, 1, 2].map(|c| (0..3).map(|r| self.0[r][c] * v[r]).sum())
    }
}
