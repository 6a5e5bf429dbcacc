//! What the materials of a file become.
//!
//! The models that `illum` chooses among are no physical ones. With the keywords of the PBR extension a material is principled as
//! they say; else `illum` tells glass (4, 6, 7, 9), what reflects as metal does (3, 5, 8, by the share of `Ks`), and the rest: a diffuse
//! base under a coat whose roughness follows `Ns`.

use std::path::{Path, PathBuf};

use scenefile::desc::{
    Channel, ColorDesc, ColorSpace, Dielectric, Emission, EmissionAmount, FloatDesc, Image, ImageSource,
    Mapping, Material, Principled, Roughness, Texture, Triple,
};
use scenefile::spec::PICTURES;
use scenefile::{Sourced, Span};

use super::map::Map;
use super::mtl::Mtl;
use super::{Importer, Surface, slashed};
use crate::names::free_name;
use crate::ply::GREY;

/// How a picture's values are used.
#[derive(Clone, Copy)]
struct Reading {
    space: ColorSpace,
    channel: Channel,
    factor: Triple,
}

const COLOR: Reading = Reading { space: ColorSpace::Srgb, channel: Channel::Rgb, factor: [1.0; 3] };
const NUMBER: Reading = Reading { space: ColorSpace::Linear, ..COLOR };

impl Importer {
    /// The surface of a material by name; one that no file has is grey.
    pub(super) fn surface(&mut self, name: &str, colored: bool, used: Span) -> Surface {
        let key = if name.is_empty() { "surface" } else { name };
        let (material, emission) = match self.materials.get(name).cloned() {
            Some(mtl) => self.lower(&mtl, colored),
            None => {
                if !name.is_empty() {
                    self.report.instead(format!("no material file has `{name}`"), "it is grey", used);
                }
                let mut plain = Principled { base_color: GREY.into(), ..Principled::default() };
                if colored {
                    plain.base_color = self.vertex_color(used);
                }
                (plain.into(), None)
            }
        };
        let key = free_name(&self.desc.materials, key);
        self.desc.materials.insert(key.clone(), Sourced::at(material, used));
        Surface { key, emission }
    }

    fn vertex_color(&mut self, span: Span) -> ColorDesc {
        let texture = Texture::VertexColor { channel: Channel::Rgb };
        ColorDesc::Texture(Sourced::at(self.add_texture("vertex-colors", texture, span), span))
    }

    fn lower(&mut self, mtl: &Mtl, colored: bool) -> (Material, Option<Emission>) {
        let illum = mtl.number("illum").unwrap_or(2.0) as i32;
        let pbr = ["Pr", "Pm", "Ps", "Pc"].iter().any(|k| mtl.numbers.contains_key(k))
            || ["map_Pr", "map_Pm", "map_Ps"].iter().any(|k| mtl.maps.contains_key(k));
        let glass = matches!(illum, 4 | 6 | 7 | 9);
        let mut made: Material = if glass && !pbr {
            Dielectric {
                ior: mtl.number("Ni").filter(|n| *n > 1.0).unwrap_or(1.5).into(),
                color: mtl
                    .color("Tf")
                    .map_or(ColorDesc::Rgb([1.0; 3]), |tf| ColorDesc::Rgb(tf.map(|x| x.min(1.0)))),
                ..Dielectric::default()
            }
            .into()
        } else {
            let base = self.base_color(mtl, colored);
            self.principled(mtl, base, illum, pbr).into()
        };
        if !glass || pbr {
            made.opacity = self.opacity(mtl);
        }
        self.bumps(mtl, &mut made);
        if let Some(turn) = mtl.number("anisor") {
            made.rotation = (turn * 360.0).into();
        }
        (made, self.emission(mtl))
    }

    /// `Kd` times its picture and the vertices' colours. A picture under a black `Kd` is shown as it is: many files are so.
    fn base_color(&mut self, mtl: &Mtl, colored: bool) -> ColorDesc {
        let kd = mtl.color("Kd");
        let picture = mtl.maps.get("map_Kd");
        let factor = match (kd, picture) {
            (Some(kd), Some(_)) if kd == [0.0; 3] => [1.0; 3],
            (Some(kd), _) => kd.map(|x| x.min(1.0)),
            (None, Some(_)) => [1.0; 3],
            (None, None) => [GREY; 3],
        };
        let color = picture.and_then(|map| self.picture(mtl, map, Reading { factor, ..COLOR }));
        let color = color.map_or(ColorDesc::Rgb(factor), ColorDesc::Texture);
        if !colored {
            return color;
        }
        let vertex = self.vertex_color(mtl.span);
        match color {
            ColorDesc::Rgb(rgb) if rgb == [1.0; 3] || kd.is_none() => vertex,
            a => {
                let product = Texture::Product { a, b: vertex };
                ColorDesc::Texture(Sourced::at(self.add_texture("color", product, mtl.span), mtl.span))
            }
        }
    }

    fn principled(&mut self, mtl: &Mtl, base: ColorDesc, illum: i32, pbr: bool) -> Principled {
        let mut made = Principled { base_color: base, ..Principled::default() };
        if let Some(ior) = mtl.number("Ni").filter(|n| (1.01..=4.0).contains(n)) {
            made.ior = ior.into();
        }
        let share = |x: Option<f32>, default: f32| x.unwrap_or(default).clamp(0.0, 1.0);
        if pbr {
            let roughness =
                self.float(mtl, "map_Pr", share(mtl.number("Pr"), 0.5), mtl.number("Pr").is_some());
            let anisotropy = mtl.number("aniso").unwrap_or(0.0).clamp(-1.0, 1.0).into();
            made.roughness = Roughness::Perceived { roughness, anisotropy };
            made.metallic =
                self.float(mtl, "map_Pm", share(mtl.number("Pm"), 0.0), mtl.number("Pm").is_some());
            made.sheen_color = share(mtl.number("Ps"), 0.0).into();
            if let Some(map) = mtl.maps.get("map_Ps").cloned()
                && let Some(name) = self.picture(mtl, &map, NUMBER)
            {
                made.sheen_color = ColorDesc::Texture(name);
            }
            made.clearcoat = share(mtl.number("Pc"), 0.0).into();
            made.clearcoat_roughness = share(mtl.number("Pcr"), 0.03).into();
            if matches!(illum, 4 | 6 | 7 | 9) {
                made.transmission = 1.0.into();
            }
            return made;
        }
        // Blinn's exponent n and Beckmann's or GGX's α are near one another at α² = 2/(n + 2) (Walter et al. 2007), and α is the
        // square of the roughness.
        let exponent = mtl.number("Ns").unwrap_or(0.0).max(0.0);
        let smooth = matches!(illum, 3 | 5 | 8) && exponent >= 900.0;
        made.roughness = if smooth { 0.0 } else { (2.0 / (exponent + 2.0)).powf(0.25) }.into();
        let ks = mtl.color("Ks").unwrap_or([0.0; 3]).map(|x| x.min(1.0));
        let most = ks[0].max(ks[1]).max(ks[2]);
        let kd = match &made.base_color {
            ColorDesc::Rgb(rgb) => rgb[0].max(rgb[1]).max(rgb[2]),
            ColorDesc::Texture(_) => 0.5,
        };
        if illum < 2 {
            made.specular = 0.0.into();
            made.roughness = 1.0.into();
        } else if matches!(illum, 3 | 5 | 8) && most > kd {
            made.metallic = 1.0.into();
            made.base_color = match mtl
                .maps
                .get("map_Ks")
                .cloned()
                .and_then(|map| self.picture(mtl, &map, Reading { factor: ks, ..COLOR }))
            {
                Some(name) => ColorDesc::Texture(name),
                None => ColorDesc::Rgb(ks),
            };
        } else {
            // A `Ks` of 1/2 is what exporters write of common surfaces.
            made.specular = self.float(mtl, "map_Ks", (2.0 * most).min(1.0), true);
        }
        made
    }

    /// A number, times a channel of a picture; `given`: whether the number is written.
    fn float(&mut self, mtl: &Mtl, key: &str, number: f32, given: bool) -> FloatDesc {
        let Some(map) = mtl.maps.get(key).cloned() else { return number.into() };
        // Files that have a picture often have 0 beside it.
        let factor = if given && number > 0.0 { number } else { 1.0 };
        let texture = self.picture(mtl, &map, Reading { factor: [factor; 3], ..NUMBER });
        texture.map_or(FloatDesc::Value(number), FloatDesc::Texture)
    }

    /// `d`, or 1 − `Tr`, times `map_d`.
    fn opacity(&mut self, mtl: &Mtl) -> FloatDesc {
        let opacity = mtl.number("d").or(mtl.number("Tr").map(|tr| 1.0 - tr)).unwrap_or(1.0).clamp(0.0, 1.0);
        let Some(map) = mtl.maps.get("map_d").cloned() else { return opacity.into() };
        // A picture that has an alpha channel and is the colour's too means that channel.
        let same = mtl.maps.get("map_Kd").is_some_and(|kd| kd.file == map.file);
        let channel = if same { Channel::Alpha } else { Channel::Rgb };
        let factor = if opacity > 0.0 { opacity } else { 1.0 };
        let texture = self.picture(mtl, &map, Reading { channel, factor: [factor; 3], ..NUMBER });
        texture.map_or(FloatDesc::Value(opacity), FloatDesc::Texture)
    }

    fn bumps(&mut self, mtl: &Mtl, made: &mut Material) {
        if let Some(map) = mtl.maps.get("norm").cloned() {
            made.normal_map = self.picture(mtl, &map, NUMBER);
            made.normal_strength = map.bump;
        }
        if let Some(map) = mtl.maps.get("bump").cloned() {
            let said = "the height of a bump map has no unit in material files";
            self.report.instead(said, "1 % of a scene unit for each of `-bm` is taken", map.span);
            made.bump_map = self.picture(mtl, &map, NUMBER);
            made.bump_height = 0.01 * map.bump;
        }
        for key in ["map_Ns"] {
            if let Some(map) = mtl.maps.get(key) {
                self.report.instead(format!("`{key}` is not rendered"), "the number alone counts", map.span);
            }
        }
    }

    fn emission(&mut self, mtl: &Mtl) -> Option<Emission> {
        let map = mtl.maps.get("map_Ke").cloned();
        let ke = match (mtl.color("Ke"), &map) {
            (Some(ke), Some(_)) if ke == [0.0; 3] => [1.0; 3],
            (Some(ke), _) => ke,
            (None, Some(_)) => [1.0; 3],
            (None, None) => return None,
        };
        let texture = map.and_then(|map| self.picture(mtl, &map, COLOR));
        (ke != [0.0; 3]).then_some(Emission {
            amount: EmissionAmount::Radiance(ke),
            texture,
            two_sided: false,
        })
    }

    /// A texture of a picture; `None`, said, where there is none of a known format.
    fn picture(&mut self, mtl: &Mtl, map: &Map, reading: Reading) -> Option<Sourced<String>> {
        let written = slashed(&map.file);
        let beside = written.file_name().map(PathBuf::from).unwrap_or_default();
        let ways = [mtl.folder.join(&written), written.clone(), mtl.folder.join(&beside), beside];
        let Some(path) = ways.into_iter().find(|way| self.desc.base.join(way).is_file()) else {
            let text = format!("the texture `{}` is not there", written.display());
            self.report.instead(text, "colours and numbers alone take its place", map.span);
            return None;
        };
        let extension = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        if !PICTURES.contains(&extension.as_str()) {
            let text = format!("pictures of the format `.{extension}` are not read");
            self.report.instead(text, "colours and numbers alone take its place", map.span);
            return None;
        }
        let stem = Path::new(&path).file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let image = Image {
            color_space: reading.space,
            wrap: [map.wrap; 2],
            mapping: Mapping::Uv { set: 0, scale: map.scale, rotation: 0.0, offset: map.offset },
            channel: map.channel.unwrap_or(reading.channel),
            factor: reading.factor.map(|x| x * map.gain),
            ..Image::new(ImageSource::File(Sourced::at(path, map.span)))
        };
        let name = self.add_texture(&stem, Texture::Image(image), map.span);
        Some(Sourced::at(name, map.span))
    }

    /// The name of a texture that is this one.
    fn add_texture(&mut self, wanted: &str, texture: Texture, span: Span) -> String {
        let identity = format!("{texture:?}");
        if let Some(name) = self.textures.get(&identity) {
            return name.clone();
        }
        let name = free_name(&self.desc.textures, wanted);
        self.desc.textures.insert(name.clone(), Sourced::at(texture, span));
        self.textures.insert(identity, name.clone());
        name
    }
}
