//! Textures (glTF 2.0 §3.8), `KHR_texture_transform`, and how they enter numbers and colours.

use std::path::PathBuf;
use std::sync::Arc;

use scenefile::desc::{
    Channel, ColorDesc, ColorSpace, EmbeddedImage, FloatDesc, Image, ImageSource, Mapping, Texture,
    TextureFilter, Triple, Wrap,
};
use scenefile::{Sourced, Span};

use super::Importer;
use super::bytes::{data_uri, local_path};
use super::fault::{Fault, Known};
use super::json::Value;
use crate::names::free_name;

/// What of a texture's values is used, and how.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reading {
    pub space: ColorSpace,
    pub channel: Channel,
    pub factor: Triple,
}

impl Reading {
    pub(super) fn color(factor: [f64; 3]) -> Self {
        Self { space: ColorSpace::Srgb, channel: Channel::Rgb, factor: factor.map(|x| x as f32) }
    }

    pub(super) fn number(channel: Channel, factor: f64) -> Self {
        Self { space: ColorSpace::Linear, channel, factor: [factor as f32; 3] }
    }
}

impl<'t> Importer<'t> {
    /// A colour: a factor, times what a texture has if there is one.
    pub(super) fn color(&mut self, factor: [f64; 3], info: Option<&'t Value<'t>>) -> ColorDesc {
        let reading = Reading::color(factor);
        let texture = info.filter(|_| factor != [0.0; 3]).and_then(|info| self.texture(info, reading));
        texture.map_or(ColorDesc::Rgb(reading.factor), ColorDesc::Texture)
    }

    /// A number: a factor, times a channel of a texture if there is one.
    pub(super) fn float(&mut self, factor: f64, info: Option<&'t Value<'t>>, channel: Channel) -> FloatDesc {
        let texture = info
            .filter(|_| factor != 0.0)
            .and_then(|info| self.texture(info, Reading::number(channel, factor)));
        texture.map_or(FloatDesc::Value(factor as f32), FloatDesc::Texture)
    }

    /// The texture that a material's `textureInfo` names; what is wrong with it is reported, and `None` then.
    pub(super) fn texture(&mut self, info: &'t Value<'t>, reading: Reading) -> Option<Sourced<String>> {
        let image = self.image_texture(info, reading);
        let image = self.told(image)??;
        Some(Sourced::at(self.add_texture(Texture::Image(image), info.span()), info.span()))
    }

    /// The name of a texture that is this one.
    pub(super) fn add_texture(&mut self, texture: Texture, span: Span) -> String {
        let mut identity = texture.clone();
        let wanted = match &mut identity {
            Texture::Image(image) => {
                let name = image.source.written().into_owned();
                // By its name alone: its bytes are many.
                image.source = ImageSource::File(PathBuf::from(&name).into());
                std::path::Path::new(&name).file_stem().unwrap_or_default().to_string_lossy().into_owned()
            }
            Texture::VertexColor { .. } => "vertex-colors".to_owned(),
            _ => "texture".to_owned(),
        };
        let identity = format!("{identity:?}");
        if let Some(name) = self.textures.get(&identity) {
            return name.clone();
        }
        let name = free_name(&self.desc.textures, &wanted);
        self.desc.textures.insert(name.clone(), Sourced::at(texture, span));
        self.textures.insert(identity, name.clone());
        name
    }

    /// The product of two colours.
    pub(super) fn product(&mut self, a: ColorDesc, b: ColorDesc, span: Span) -> ColorDesc {
        let white = ColorDesc::Rgb([1.0; 3]);
        match (a, b) {
            (ColorDesc::Rgb(a), ColorDesc::Rgb(b)) => ColorDesc::Rgb([0, 1, 2].map(|i| a[i] * b[i])),
            (a, b) if b == white => a,
            (a, b) if a == white => b,
            (a, b) => {
                ColorDesc::Texture(Sourced::at(self.add_texture(Texture::Product { a, b }, span), span))
            }
        }
    }

    /// The product of two numbers.
    pub(super) fn float_product(&mut self, a: FloatDesc, b: FloatDesc, span: Span) -> FloatDesc {
        as_float(self.product(as_color(a), as_color(b), span))
    }

    /// From `a` to `b` by a share.
    pub(super) fn float_mix(
        &mut self,
        a: FloatDesc,
        b: FloatDesc,
        share: FloatDesc,
        span: Span,
    ) -> FloatDesc {
        match (a, b, share) {
            (FloatDesc::Value(a), FloatDesc::Value(b), FloatDesc::Value(t)) => {
                FloatDesc::Value(a + (b - a) * t)
            }
            (a, _, FloatDesc::Value(0.0)) => a,
            (_, b, FloatDesc::Value(1.0)) => b,
            (a, b, amount) => {
                let mix = Texture::Mix { a: as_color(a), b: as_color(b), amount };
                FloatDesc::Texture(Sourced::at(self.add_texture(mix, span), span))
            }
        }
    }

    fn image_texture(&mut self, info: &'t Value<'t>, reading: Reading) -> Known<Option<Image>> {
        let textures = self.list("textures")?;
        let Some((_, texture)) = info.pick("index", "texture", textures)? else {
            return Err(Fault::new("missing-key", "a texture without `index`", info.span()));
        };
        let Some(source) = self.source_of(texture, info)? else { return Ok(None) };
        let sampler = texture.pick("sampler", "sampler", self.list("samplers")?)?.map(|(_, sampler)| sampler);
        let [mut s, mut t] = [Wrap::Repeat; 2];
        let mut filter = TextureFilter::Trilinear;
        if let Some(sampler) = sampler {
            (s, t) = (wrap(sampler, "wrapS")?, wrap(sampler, "wrapT")?);
            filter = match (sampler.whole("magFilter")?, sampler.whole("minFilter")?) {
                // Where texels are large on the screen their edges are to be seen.
                (Some(9728), _) => TextureFilter::Nearest,
                (_, Some(9728 | 9729)) => TextureFilter::Bilinear,
                _ => TextureFilter::Trilinear,
            };
        }
        Ok(Some(Image {
            color_space: reading.space,
            wrap: [s, t],
            filter,
            mapping: self.mapping(info)?,
            channel: reading.channel,
            factor: reading.factor,
            ..Image::new(source)
        }))
    }

    /// The set of coordinates and their change. With u right and v down, `KHR_texture_transform` scales, turns by an angle θ
    /// from v to u, and moves: u' = c·su·u + s·sv·v + ou, v' = −s·su·u + c·sv·v + ov. Our v is 1 − v.
    fn mapping(&mut self, info: &'t Value<'t>) -> Known<Mapping> {
        let mut set = info.whole("texCoord")?.unwrap_or(0);
        let (mut scale, mut offset, mut angle) = ([1.0; 2], [0.0; 2], 0.0f64);
        if let Some(transform) = info.extension("KHR_texture_transform") {
            set = transform.whole("texCoord")?.unwrap_or(set);
            scale = transform.numbers("scale", scale)?;
            offset = transform.numbers("offset", offset)?;
            angle = transform.number("rotation", 0.0)?;
        }
        if set > 1 {
            let text = format!("texture coordinates of set {set} are not read");
            self.report.instead(text, "set 0 takes their place", info.span());
            set = 0;
        }
        let (sine, cosine) = angle.sin_cos();
        let offset = [offset[0] + sine * scale[1], 1.0 - offset[1] - cosine * scale[1]];
        Ok(Mapping::Uv {
            set: set as u8,
            scale: scale.map(|x| x as f32),
            rotation: angle.to_degrees() as f32,
            offset: offset.map(|x| x as f32 + 0.0),
        })
    }

    /// The picture of a texture.
    fn source_of(&mut self, texture: &'t Value<'t>, info: &'t Value<'t>) -> Known<Option<ImageSource>> {
        let images = self.list("images")?;
        let webp = texture.extension("EXT_texture_webp");
        let picked = match webp.map(|webp| webp.pick("source", "image", images)).transpose()?.flatten() {
            None => texture.pick("source", "image", images)?,
            found => found,
        };
        let Some((index, image)) = picked else {
            let packed = ["KHR_texture_basisu", "MSFT_texture_dds"]
                .into_iter()
                .find(|e| texture.extension(e).is_some());
            let text = match packed {
                Some(name) => format!("textures of `{name}` are not read"),
                None => "a texture without an image".to_owned(),
            };
            self.report.instead(text, "factors alone take its place", info.span());
            return Ok(None);
        };
        if let Some(known) = self.images.get(&index) {
            return Ok(known.clone());
        }
        let read = self.read_image(index, image);
        let source = self.told(read).flatten();
        self.images.insert(index, source.clone());
        Ok(source)
    }

    fn read_image(&mut self, index: usize, image: &'t Value<'t>) -> Known<Option<ImageSource>> {
        let source = self.source;
        let at = image.get("uri").or(image.get("bufferView")).unwrap_or(image).span();
        let bytes: Arc<[u8]> = match image.text("uri")? {
            Some(uri) => match data_uri(uri, at) {
                None => return Ok(Some(ImageSource::File(Sourced::at(local_path(uri, at)?, at)))),
                Some(decoded) => decoded?.1.into(),
            },
            None => {
                let views = source.root.array("bufferViews")?;
                let (_, view) = image
                    .pick("bufferView", "bufferView", views)?
                    .ok_or_else(|| Fault::new("missing-key", "an image without `uri` or `bufferView`", at))?;
                let bytes = source.view(view)?.0;
                // Images may share their bytes.
                self.spend(bytes.len(), at)?;
                bytes.into()
            }
        };
        let Some(extension) = extension(&bytes) else {
            self.report.instead("an image of no known format", "factors alone take its place", at);
            return Ok(None);
        };
        let plain = |c: char| if c.is_alphanumeric() || matches!(c, '-' | '_') { c } else { '_' };
        let stem: String = image.name().chars().take(60).map(plain).collect();
        let stem = if stem.is_empty() { format!("image{index}") } else { stem };
        let mut name = format!("{stem}.{extension}");
        if !self.image_names.insert(name.to_lowercase()) {
            name = format!("{stem}-{index}.{extension}");
            self.image_names.insert(name.to_lowercase());
        }
        Ok(Some(ImageSource::Embedded(EmbeddedImage { name, bytes })))
    }
}

/// What a file of these bytes is called.
fn extension(bytes: &[u8]) -> Option<&'static str> {
    if bytes.starts_with(b"\x89PNG") {
        Some("png")
    } else if bytes.starts_with(b"\xff\xd8") {
        Some("jpg")
    } else if bytes.starts_with(b"RIFF") && bytes.get(8..12) == Some(b"WEBP") {
        Some("webp")
    } else {
        None
    }
}

fn wrap(sampler: &Value<'_>, key: &str) -> Known<Wrap> {
    match sampler.whole(key)? {
        None | Some(10497) => Ok(Wrap::Repeat),
        Some(33071) => Ok(Wrap::Clamp),
        Some(33648) => Ok(Wrap::Mirror),
        Some(other) => {
            Err(Fault::new("unknown-kind", format!("{other} is no way to wrap textures"), sampler.span()))
        }
    }
}

pub(super) fn as_color(float: FloatDesc) -> ColorDesc {
    match float {
        FloatDesc::Value(x) => ColorDesc::Rgb([x; 3]),
        FloatDesc::Texture(name) => ColorDesc::Texture(name),
    }
}

pub(super) fn as_float(color: ColorDesc) -> FloatDesc {
    match color {
        ColorDesc::Rgb(rgb) => FloatDesc::Value(rgb[0]),
        ColorDesc::Texture(name) => FloatDesc::Texture(name),
    }
}
