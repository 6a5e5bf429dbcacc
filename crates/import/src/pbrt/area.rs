//! Shapes that shine.

use std::rc::Rc;

use scenefile::desc::{
    Emission, EmissionAmount, Image, ImageSource, Texture, TextureFilter, Wrap, channel_power,
};
use scenefile::{Diagnostic, Sourced, Span};

use super::Importer;
use super::params::Params;
use crate::matrix::{narrow, times};
use crate::names::free_name;

impl Importer {
    pub(super) fn area_light(&mut self, kind: &str, at: Span, params: Params) {
        if !matches!(kind, "diffuse" | "area") {
            self.report
                .push(Diagnostic::error("unknown-kind", format!("there is no area light `{kind}`")).at(at));
        }
        params.ignore(&["samples", "nsamples", "L", "scale", "twosided", "power"]);
        self.graphics.area_texture = params.find("filename", &["string"]).map(|file| {
            let path = self.find_file(file.text().unwrap_or_default());
            let image = Image {
                wrap: [Wrap::Clamp; 2],
                filter: TextureFilter::Bilinear,
                ..Image::new(ImageSource::File(Sourced::at(path, file.span)))
            };
            let key = free_name(&self.desc.textures, "emission");
            self.desc.textures.insert(key.clone(), Sourced::at(Texture::Image(image), file.span));
            Sourced::at(key, file.span)
        });
        params.finish(&mut self.report);
        self.graphics.area_light = Some(Rc::new(params));
    }

    /// The emission of a shape, if an area light is in force and the shape is one that may shine.
    pub(super) fn emission(&mut self, shape: Span) -> Option<Sourced<Emission>> {
        let params = self.graphics.area_light.clone()?;
        if self.object.is_some() {
            let text = "shapes of objects do not shine in pbrt";
            self.report.instead(text, "they are dark", shape);
            return None;
        }
        let two_sided = params.truth("twosided").unwrap_or(false);
        let rgb = self.amount(&params, "L", "power", 1.0);
        let amount = if params.number("power").is_some_and(|p| p > 0.0) {
            // The flux of each channel; its mean and its proportions.
            let watts = rgb.iter().sum::<f64>() / 3.0;
            if watts <= 0.0 {
                return None;
            }
            EmissionAmount::Power { watts: watts as f32, color: narrow(times(rgb, 1.0 / watts)) }
        } else {
            EmissionAmount::Radiance(narrow(rgb))
        };
        let light = match amount {
            EmissionAmount::Radiance(rgb) => rgb,
            EmissionAmount::Power { watts, color } => channel_power(watts, color),
        };
        if light.iter().all(|c| *c <= 0.0) {
            return None;
        }
        let texture = self.graphics.area_texture.clone();
        Some(Sourced::at(Emission { amount, texture, two_sided }, params.span))
    }
}
