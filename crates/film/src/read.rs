use std::fmt;
use std::io::{self, Cursor};
use std::path::{Path, PathBuf};

use exr::image::FlatSamples;
use exr::prelude::{ReadChannels, ReadLayers};

/// A picture of linear Rec. 709 colours, row by row from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct RgbImage {
    width: usize,
    height: usize,
    pixels: Vec<[f32; 3]>,
}

/// Why a picture could not be read, with its path.
#[derive(Debug)]
pub struct ReadError {
    path: PathBuf,
    kind: ReadErrorKind,
}

/// The reasons of a [`ReadError`].
#[derive(Debug)]
pub enum ReadErrorKind {
    /// The file could not be opened or read.
    Io(io::Error),
    /// The content is no picture that can be read; the text says why.
    Format(String),
    /// An EXR file without red, green and blue; the channels that it has.
    NoRgb(Vec<String>),
}

impl ReadError {
    pub(crate) fn new(path: &Path, kind: ReadErrorKind) -> Self {
        Self { path: path.to_owned(), kind }
    }

    /// The file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The reason.
    pub fn kind(&self) -> &ReadErrorKind {
        &self.kind
    }
}

impl fmt::Display for ReadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "cannot read {}: ", self.path.display())?;
        match &self.kind {
            ReadErrorKind::Io(error) => write!(f, "{error}"),
            ReadErrorKind::Format(why) => write!(f, "{why}"),
            ReadErrorKind::NoRgb(channels) => write!(f, "no R, G, B channels among {}", channels.join(", ")),
        }
    }
}

impl std::error::Error for ReadError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match &self.kind {
            ReadErrorKind::Io(error) => Some(error),
            _ => None,
        }
    }
}

impl RgbImage {
    /// From pixels, row by row; none where there are not width × height.
    pub fn new(width: usize, height: usize, pixels: Vec<[f32; 3]>) -> Option<Self> {
        (width.checked_mul(height) == Some(pixels.len())).then_some(Self { width, height, pixels })
    }

    /// Reads a file; what it is, its first bytes say.
    ///
    /// EXR: the first part's R, G, B, else the first layer in alphabetical order that has them; any float or integer
    /// type, any compression that the crate `exr` knows; the data window. PNG (8 or 16 bits) and JPEG: taken as sRGB
    /// and made linear; alpha is dropped. Radiance HDR: as it is.
    ///
    /// # Errors
    /// Where the file can't be read, or is no such picture.
    pub fn read(path: &Path) -> Result<Self, ReadError> {
        let error = |kind| ReadError { path: path.to_owned(), kind };
        let bytes = std::fs::read(path).map_err(|e| error(ReadErrorKind::Io(e)))?;
        Self::decode(&bytes).map_err(error)
    }

    /// [`read`](Self::read) from the bytes of a file.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn decode(bytes: &[u8]) -> Result<Self, ReadErrorKind> {
        // OpenEXR's magic number, 20000630.
        if bytes.starts_with(&[0x76, 0x2f, 0x31, 0x01]) { decode_exr(bytes) } else { decode_other(bytes) }
    }

    /// Pixels a row.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> usize {
        self.height
    }

    /// The pixels whose channel mean is above 0.5, as a mask for [`crate::compare`].
    pub fn to_mask(&self) -> Vec<bool> {
        self.pixels
            .iter()
            .map(|p| (f64::from(p[0]) + f64::from(p[1]) + f64::from(p[2])) / 3.0 > 0.5)
            .collect()
    }

    /// The pixels, row by row.
    pub fn pixels(&self) -> &[[f32; 3]] {
        &self.pixels
    }
}

fn decode_exr(bytes: &[u8]) -> Result<RgbImage, ReadErrorKind> {
    let image = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .all_layers()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(bytes))
        .map_err(|e| ReadErrorKind::Format(e.to_string()))?;
    let part = image.layer_data.first().ok_or_else(|| ReadErrorKind::Format("it holds no part".into()))?;
    let channels = &part.channel_data.list;
    let find = |name: &str| channels.iter().find(|c| c.name.to_string() == name).map(|c| &c.sample_data);
    // Channels are sorted by name, so the first layer found is the first in the alphabet.
    let mut prefixes: Vec<String> = channels
        .iter()
        .filter_map(|c| c.name.to_string().strip_suffix(".R").map(|p| format!("{p}.")))
        .collect();
    prefixes.sort();
    prefixes.insert(0, String::new());
    let rgb: Option<Vec<&FlatSamples>> = prefixes
        .iter()
        .find_map(|prefix| ["R", "G", "B"].iter().map(|c| find(&format!("{prefix}{c}"))).collect());
    let Some(rgb) = rgb else {
        return Err(ReadErrorKind::NoRgb(channels.iter().map(|c| c.name.to_string()).collect()));
    };
    let (width, height) = (part.size.0, part.size.1);
    let planes: Vec<Vec<f32>> = rgb.iter().map(|plane| plane.values_as_f32().collect()).collect();
    if planes.iter().any(|p| p.len() != width * height) {
        return Err(ReadErrorKind::Format("R, G and B are not of the picture's resolution".into()));
    }
    let pixels = (0..width * height).map(|i| [planes[0][i], planes[1][i], planes[2][i]]).collect();
    Ok(RgbImage { width, height, pixels })
}

fn decode_other(bytes: &[u8]) -> Result<RgbImage, ReadErrorKind> {
    use image::DynamicImage::{ImageRgb32F, ImageRgba32F};
    let format = |e: image::ImageError| ReadErrorKind::Format(e.to_string());
    let picture = image::load_from_memory(bytes).map_err(format)?;
    let (width, height) = (picture.width() as usize, picture.height() as usize);
    let pixels = match &picture {
        ImageRgb32F(_) | ImageRgba32F(_) => picture.to_rgb32f().pixels().map(|p| p.0).collect(),
        _ if picture.color().bytes_per_pixel() > picture.color().channel_count() => {
            let linear = |v: u16| color::srgb_to_linear(f32::from(v) / 65535.0);
            picture.to_rgb16().pixels().map(|p| p.0.map(linear)).collect()
        }
        _ => picture.to_rgb8().pixels().map(|p| p.0.map(color::srgb8_to_linear)).collect(),
    };
    Ok(RgbImage { width, height, pixels })
}
