//! Picture files to numbers.

use std::fmt;
use std::io::Cursor;
use std::path::PathBuf;

use exr::image::FlatSamples;
use exr::prelude::{ReadChannels, ReadLayers};
use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader, Limits};

use super::Wanted;

/// Texels along a side, at most.
const MAX_SIDE: u64 = 1 << 16;
/// Bytes of decoded numbers, at most: a small file may claim to be large.
const MAX_BYTES: u64 = 1 << 30;

/// Why an image is no texture.
#[derive(Debug)]
pub enum TextureError {
    /// The file could not be read.
    Unreadable(PathBuf, std::io::Error),
    /// The bytes are no picture of a known kind, or a broken one.
    Undecodable(image::ImageError),
    /// The same of OpenEXR or PFM.
    Broken(String),
    /// The picture is larger than can be kept.
    TooLarge(u64, u64),
    /// The picture has no texel.
    Empty,
    /// A value is NaN or infinite.
    NotFinite,
}

impl fmt::Display for TextureError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unreadable(path, error) => write!(f, "cannot read {}: {error}", path.display()),
            Self::Undecodable(error) => write!(f, "cannot decode the image: {error}"),
            Self::Broken(error) => write!(f, "cannot decode the image: {error}"),
            Self::TooLarge(w, h) => {
                write!(f, "{w} × {h} texels are too many: at most {MAX_SIDE} along a side, and 1 GiB in all")
            }
            Self::Empty => f.write_str("the image has no pixel"),
            Self::NotFinite => f.write_str("the image holds a value that is not finite"),
        }
    }
}

impl std::error::Error for TextureError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Unreadable(_, error) => Some(error),
            Self::Undecodable(error) => Some(error),
            Self::Broken(_) | Self::TooLarge(..) | Self::Empty | Self::NotFinite => None,
        }
    }
}

/// Numbers as a file has them.
#[derive(Clone, Debug)]
pub(super) enum Numbers {
    Bytes(Vec<u8>),
    Words(Vec<u16>),
    Floats(Vec<f32>),
}

/// A decoded picture, row by row from the top: grey, grey and opacity, RGB, or RGB and opacity.
#[derive(Clone, Debug)]
pub struct Pixels {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) channels: usize,
    pub(super) numbers: Numbers,
}

impl Pixels {
    /// Linear RGB.
    ///
    /// # Errors
    /// [`TextureError::Empty`] where there is none, or the count is not that of the size.
    pub fn linear(width: usize, height: usize, texels: &[[f32; 3]]) -> Result<Self, TextureError> {
        if texels.is_empty() || width.checked_mul(height) != Some(texels.len()) {
            return Err(TextureError::Empty);
        }
        let numbers = Numbers::Floats(texels.as_flattened().to_vec());
        Ok(Self { width, height, channels: 3, numbers })
    }

    /// Decodes PNG, JPEG, TIFF, WebP, BMP, PNM, Radiance HDR, OpenEXR or PFM by the content, and TGA by the name.
    ///
    /// # Errors
    /// Where the bytes are none of these or broken, or the picture is empty or too large.
    pub fn decode(bytes: &[u8], name: &str) -> Result<Self, TextureError> {
        match bytes {
            [0x76, 0x2f, 0x31, 0x01, ..] => decode_exr(bytes),
            [b'P', b'F' | b'f', b'\n' | b'\r' | b' ' | b'\t', ..] => decode_pfm(bytes),
            _ => decode_other(bytes, name),
        }
    }

    /// From a decoded image.
    ///
    /// # Errors
    /// [`TextureError::Empty`] where it has no pixel.
    pub fn from_image(image: DynamicImage) -> Result<Self, TextureError> {
        use DynamicImage as D;
        use Numbers::{Bytes, Floats, Words};
        let (width, height) = (image.width() as usize, image.height() as usize);
        if width == 0 || height == 0 {
            return Err(TextureError::Empty);
        }
        let (channels, numbers) = match image {
            D::ImageLuma8(i) => (1, Bytes(i.into_raw())),
            D::ImageLumaA8(i) => (2, Bytes(i.into_raw())),
            D::ImageRgb8(i) => (3, Bytes(i.into_raw())),
            D::ImageRgba8(i) => (4, Bytes(i.into_raw())),
            D::ImageLuma16(i) => (1, Words(i.into_raw())),
            D::ImageLumaA16(i) => (2, Words(i.into_raw())),
            D::ImageRgb16(i) => (3, Words(i.into_raw())),
            D::ImageRgba16(i) => (4, Words(i.into_raw())),
            D::ImageRgb32F(i) => (3, Floats(i.into_raw())),
            other => (4, Floats(other.into_rgba32f().into_raw())),
        };
        Ok(Self { width, height, channels, numbers })
    }

    /// Only the channels that are wanted and say something: one for three that are equal, no opacity of 1.
    pub(super) fn kept(self, wanted: Wanted) -> Result<Self, TextureError> {
        let Self { width, height, channels, numbers } = self;
        if width == 0 || height == 0 {
            return Err(TextureError::Empty);
        }
        let one = match &numbers {
            Numbers::Bytes(_) => Numbers::Bytes(vec![u8::MAX]),
            Numbers::Words(_) => Numbers::Words(vec![u16::MAX]),
            Numbers::Floats(_) => Numbers::Floats(vec![1.0]),
        };
        let alpha = channels.is_multiple_of(2);
        let is_opaque = !alpha
            || match &numbers {
                Numbers::Bytes(n) => n.iter().skip(channels - 1).step_by(channels).all(|a| *a == u8::MAX),
                Numbers::Words(n) => n.iter().skip(channels - 1).step_by(channels).all(|a| *a == u16::MAX),
                Numbers::Floats(n) => n.iter().skip(channels - 1).step_by(channels).all(|a| *a == 1.0),
            };
        if wanted == Wanted::Alpha {
            if is_opaque {
                return Ok(Self { width: 1, height: 1, channels: 1, numbers: one });
            }
            let numbers = numbers.only(channels, &[channels - 1]);
            return Ok(Self { width, height, channels: 1, numbers });
        }
        let with_alpha = wanted == Wanted::Both && !is_opaque;
        let is_grey = channels < 3
            || match &numbers {
                Numbers::Bytes(n) => n.chunks_exact(channels).all(|t| t[0] == t[1] && t[1] == t[2]),
                Numbers::Words(n) => n.chunks_exact(channels).all(|t| t[0] == t[1] && t[1] == t[2]),
                Numbers::Floats(n) => n.chunks_exact(channels).all(|t| t[0] == t[1] && t[1] == t[2]),
            };
        let last = channels - 1;
        let list: &[usize] = match (is_grey, with_alpha) {
            (true, false) => &[0],
            (true, true) => &[0, last],
            (false, false) => &[0, 1, 2],
            (false, true) => &[0, 1, 2, last],
        };
        Ok(Self { width, height, channels: list.len(), numbers: numbers.only(channels, list) })
    }
}

impl Numbers {
    /// These channels of each pixel.
    fn only(self, channels: usize, list: &[usize]) -> Self {
        if list.len() == channels {
            return self;
        }
        match self {
            Self::Bytes(n) => Self::Bytes(picked(&n, channels, list)),
            Self::Words(n) => Self::Words(picked(&n, channels, list)),
            Self::Floats(n) => Self::Floats(picked(&n, channels, list)),
        }
    }
}

fn picked<T: Copy>(numbers: &[T], channels: usize, list: &[usize]) -> Vec<T> {
    let mut out = Vec::with_capacity(numbers.len() / channels * list.len());
    for pixel in numbers.chunks_exact(channels) {
        out.extend(list.iter().map(|c| pixel[*c]));
    }
    out
}

/// Refuses what is empty or would not fit in memory.
fn check(width: u64, height: u64, bytes: Option<u64>) -> Result<(), TextureError> {
    if width == 0 || height == 0 {
        return Err(TextureError::Empty);
    }
    let fits = width <= MAX_SIDE && height <= MAX_SIDE && bytes.is_some_and(|bytes| bytes <= MAX_BYTES);
    if fits { Ok(()) } else { Err(TextureError::TooLarge(width, height)) }
}

fn decode_other(bytes: &[u8], name: &str) -> Result<Pixels, TextureError> {
    let mut reader = ImageReader::new(Cursor::new(bytes))
        .with_guessed_format()
        .map_err(|e| TextureError::Undecodable(image::ImageError::IoError(e)))?;
    // TGA begins with no sign of itself.
    if reader.format().is_none() && name.to_lowercase().ends_with(".tga") {
        reader.set_format(ImageFormat::Tga);
    }
    let mut limits = Limits::default();
    limits.max_image_width = Some(MAX_SIDE as u32);
    limits.max_image_height = Some(MAX_SIDE as u32);
    limits.max_alloc = Some(MAX_BYTES);
    reader.limits(limits);
    let decoder = reader.into_decoder().map_err(TextureError::Undecodable)?;
    let (width, height) = decoder.dimensions();
    check(u64::from(width), u64::from(height), Some(decoder.total_bytes()))?;
    Pixels::from_image(DynamicImage::from_decoder(decoder).map_err(TextureError::Undecodable)?)
}

/// The first part of an OpenEXR file that has colours: R, G, B and A, or Y, or the first channel.
fn decode_exr(bytes: &[u8]) -> Result<Pixels, TextureError> {
    let broken = |e: exr::error::Error| TextureError::Broken(e.to_string());
    let meta = exr::meta::MetaData::read_from_buffered(Cursor::new(bytes), false).map_err(broken)?;
    for header in &meta.headers {
        let (w, h) = (header.layer_size.0 as u64, header.layer_size.1 as u64);
        let texel: u64 = header.channels.list.iter().map(|c| c.sample_type.bytes_per_sample() as u64).sum();
        check(w, h, w.checked_mul(h).and_then(|n| n.checked_mul(texel.max(4))))?;
    }
    let image = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(bytes))
        .map_err(broken)?;
    let layer = &image.layer_data;
    let (width, height) = (layer.size.0, layer.size.1);
    let list = &layer.channel_data.list;
    let named = |wanted: &str| {
        let is = |c: &&exr::image::AnyChannel<FlatSamples>| {
            let name = c.name.to_string();
            // Layers in a part are told by prefixes.
            name.rsplit('.').next().is_some_and(|last| last == wanted)
        };
        list.iter().find(is).map(|c| &c.sample_data)
    };
    let mut planes: Vec<&FlatSamples> = ["R", "G", "B"].iter().filter_map(|c| named(c)).collect();
    if planes.len() != 3 {
        planes = named("Y").or_else(|| list.first().map(|c| &c.sample_data)).into_iter().collect();
    }
    planes.extend(named("A").filter(|_| !planes.is_empty() && list.len() > 1));
    if planes.is_empty() || planes.iter().any(|plane| plane.len() != width * height) {
        return Err(TextureError::Broken("the channels are not of the picture's resolution".into()));
    }
    let channels = planes.len();
    let mut floats = vec![0.0; width * height * channels];
    for (c, plane) in planes.iter().enumerate() {
        for (out, x) in floats.iter_mut().skip(c).step_by(channels).zip(plane.values_as_f32()) {
            *out = x;
        }
    }
    Ok(Pixels { width, height, channels, numbers: Numbers::Floats(floats) })
}

/// Portable float map: `PF` or `Pf`, width, height, a scale whose sign tells the byte order, then rows from the bottom
/// (Debevec, *PFM format description*).
fn decode_pfm(bytes: &[u8]) -> Result<Pixels, TextureError> {
    let broken = |what: &str| TextureError::Broken(format!("{what} of the float map"));
    let mut rest = bytes;
    let mut word = || -> Option<&str> {
        let start = rest.iter().position(|b| !b.is_ascii_whitespace())?;
        let tail = &rest[start..];
        let end = tail.iter().position(u8::is_ascii_whitespace)?;
        // One blank ends the header; what follows are numbers.
        rest = &tail[end + 1..];
        std::str::from_utf8(&tail[..end]).ok()
    };
    let channels = if word() == Some("PF") { 3 } else { 1 };
    let width: u64 = word().and_then(|w| w.parse().ok()).ok_or_else(|| broken("no width"))?;
    let height: u64 = word().and_then(|w| w.parse().ok()).ok_or_else(|| broken("no height"))?;
    let scale: f32 = word().and_then(|w| w.parse().ok()).ok_or_else(|| broken("no scale"))?;
    let size = width.checked_mul(height).and_then(|n| n.checked_mul(4 * channels));
    check(width, height, size)?;
    let data = rest.get(..size.unwrap_or(0) as usize).ok_or_else(|| broken("the end is missing"))?;
    let (width, height, channels) = (width as usize, height as usize, channels as usize);
    let number = |b: &[u8]| {
        let b = [b[0], b[1], b[2], b[3]];
        if scale < 0.0 { f32::from_le_bytes(b) } else { f32::from_be_bytes(b) }
    };
    let rows = data.chunks_exact(4 * width * channels).rev();
    let floats = rows.flat_map(|row| row.chunks_exact(4).map(number)).collect();
    Ok(Pixels { width, height, channels, numbers: Numbers::Floats(floats) })
}
