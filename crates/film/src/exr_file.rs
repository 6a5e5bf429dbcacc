use std::io::Cursor;
use std::path::Path;

use exr::image::write::WritableImage;
use exr::image::{AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer as ExrLayer};
use exr::meta::attribute::{Chromaticities, Text};
use exr::meta::header::LayerAttributes;
use exr::prelude::{Vec2, f16};

use crate::output::{OutputError, OutputErrorKind, write_atomically};
use crate::{Film, Layer};

/// How values are stored in a file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Precision {
    /// 32-bit float.
    #[default]
    F32,
    /// 16-bit float: 11 significant bits, magnitudes up to 65 504, at which greater ones are cut.
    F16,
}

/// What an EXR file holds.
#[derive(Clone, Debug, PartialEq)]
pub struct ExrOptions {
    /// The layers; beauty, where listed, is the root layer R, G, B. Noise is left out of films of one pass, which know
    /// none. The film's named layers are always written, as NAME.R, NAME.G, NAME.B.
    pub layers: Vec<Layer>,
    /// Precision of all layers but beauty and depth, which are 32-bit.
    pub precision: Precision,
    /// Pictures made of the film, written in 32-bit floats as NAME.R, NAME.G, NAME.B: names, and pixels row by row.
    pub more: Vec<(String, Vec<[f32; 3]>)>,
    /// String attributes, in this order. Names are of 1 to 31 bytes, without NUL.
    pub metadata: Vec<(String, String)>,
}

impl Default for ExrOptions {
    /// All layers in 32-bit floats, no attributes.
    fn default() -> Self {
        Self {
            layers: Layer::ALL.to_vec(),
            precision: Precision::F32,
            more: Vec::new(),
            metadata: Vec::new(),
        }
    }
}

/// Writes a film as EXR (see [`encode_exr`]) by [`write_atomically`].
///
/// # Errors
/// Where the file can't be encoded or written.
pub fn write_exr(path: &Path, film: &Film, options: &ExrOptions) -> Result<(), OutputError> {
    let bytes =
        encode_exr(film, options).map_err(|why| OutputError::new(path, OutputErrorKind::Encoding(why)))?;
    write_atomically(path, &bytes)
}

/// The bytes of an EXR file: one part of scan lines, linear Rec. 709 (with the attribute that says so), ZIP
/// compression in blocks of 16 lines (lossless). They depend on the arguments alone: no date, no host, no thread.
///
/// # Errors
/// An empty picture, no layer, or an attribute's name that the format refuses.
pub fn encode_exr(film: &Film, options: &ExrOptions) -> Result<Vec<u8>, String> {
    let mut channels = Vec::new();
    let known = |layer: &&Layer| **layer != Layer::Noise || film.passes() >= 2;
    for &layer in options.layers.iter().filter(known) {
        let precision = match layer {
            Layer::Beauty | Layer::Depth => Precision::F32,
            _ => options.precision,
        };
        let (values, count) = (film.layer(layer), layer.channels());
        for (i, name) in layer.channel_names().iter().enumerate() {
            let values = values.iter().skip(i).step_by(count).copied();
            channels.push(channel(name, values, precision));
        }
    }
    for (index, name) in film.layer_names().iter().enumerate() {
        let values = film.named_layer(index).unwrap_or_default();
        for (c, letter) in ["R", "G", "B"].iter().enumerate() {
            let values = values.iter().map(|p| p[c]);
            channels.push(channel(&format!("{name}.{letter}"), values, options.precision));
        }
    }
    for (name, pixels) in &options.more {
        if pixels.len() != film.width() * film.height() {
            return Err(format!("the layer {name} has another size than the film"));
        }
        for (c, letter) in ["R", "G", "B"].iter().enumerate() {
            channels.push(channel(&format!("{name}.{letter}"), pixels.iter().map(|p| p[c]), Precision::F32));
        }
    }
    encode(film.width(), film.height(), channels, &options.metadata)
}

/// The bytes of an EXR file that holds one picture of linear Rec. 709 in 32-bit floats, row by row; otherwise as
/// [`encode_exr`].
///
/// # Errors
/// As [`encode_exr`], and where there are not width × height pixels.
pub fn encode_exr_rgb(
    width: usize,
    height: usize,
    pixels: &[[f32; 3]],
    metadata: &[(String, String)],
) -> Result<Vec<u8>, String> {
    if width.checked_mul(height) != Some(pixels.len()) {
        return Err(format!("{} pixels do not make a picture of {width}x{height}", pixels.len()));
    }
    let channels = ["R", "G", "B"].iter().enumerate();
    let channels = channels.map(|(c, name)| channel(name, pixels.iter().map(|p| p[c]), Precision::F32));
    encode(width, height, channels.collect(), metadata)
}

/// The bytes of an EXR file of channels in 32-bit floats, each row by row and with its name; otherwise as [`encode_exr`].
///
/// # Errors
/// As [`encode_exr`], and where a channel has not width × height values.
pub fn encode_exr_channels(
    width: usize,
    height: usize,
    channels: &[(String, Vec<f32>)],
    metadata: &[(String, String)],
) -> Result<Vec<u8>, String> {
    if let Some((name, values)) = channels.iter().find(|(_, v)| width.checked_mul(height) != Some(v.len())) {
        return Err(format!("{} values of {name} do not make a picture of {width}x{height}", values.len()));
    }
    let channels = channels.iter().map(|(name, v)| channel(name, v.iter().copied(), Precision::F32));
    encode(width, height, channels.collect(), metadata)
}

/// Writes channels as EXR (see [`encode_exr_channels`]) by [`write_atomically`].
///
/// # Errors
/// Where the file can't be encoded or written.
pub fn write_exr_channels(
    path: &Path,
    [width, height]: [usize; 2],
    channels: &[(String, Vec<f32>)],
    metadata: &[(String, String)],
) -> Result<(), OutputError> {
    let bytes = encode_exr_channels(width, height, channels, metadata)
        .map_err(|why| OutputError::new(path, OutputErrorKind::Encoding(why)))?;
    write_atomically(path, &bytes)
}

fn channel(name: &str, values: impl Iterator<Item = f32>, precision: Precision) -> AnyChannel<FlatSamples> {
    let samples = match precision {
        Precision::F32 => FlatSamples::F32(values.collect()),
        Precision::F16 => {
            let limit = f16::MAX.to_f32();
            FlatSamples::F16(values.map(|v| f16::from_f32(v.clamp(-limit, limit))).collect())
        }
    };
    AnyChannel::new(Text::from(name), samples)
}

fn encode(
    width: usize,
    height: usize,
    channels: Vec<AnyChannel<FlatSamples>>,
    metadata: &[(String, String)],
) -> Result<Vec<u8>, String> {
    if width == 0 || height == 0 || channels.is_empty() {
        return Err("the picture has no pixel or no layer".into());
    }
    let layer = ExrLayer::new(
        (width, height),
        LayerAttributes::default(),
        Encoding::SMALL_LOSSLESS,
        AnyChannels::sort(channels.into_iter().collect()),
    );
    let mut image = Image::from_layer(layer);
    // ITU-R BT.709, items 1.3 and 1.4.
    image.attributes.chromaticities = Some(Chromaticities {
        red: Vec2(0.64, 0.33),
        green: Vec2(0.30, 0.60),
        blue: Vec2(0.15, 0.06),
        white: Vec2(0.3127, 0.3290),
    });
    let mut bytes = Cursor::new(Vec::new());
    image.write().non_parallel().to_buffered(&mut bytes).map_err(|e| e.to_string())?;
    with_attributes(bytes.into_inner(), height, metadata)
}

/// Adds string attributes at the end of the header of a single-part file of 16-line blocks. (The library keeps
/// attributes in a hash map with a random order, which would make the bytes differ from run to run.)
///
/// The format, from OpenEXR's technical introduction: magic and version of 4 bytes each; attributes (name, NUL, type,
/// NUL, size as i32, value) up to a NUL; a u64 for each block, its offset from the start of the file; blocks.
fn with_attributes(bytes: Vec<u8>, height: usize, metadata: &[(String, String)]) -> Result<Vec<u8>, String> {
    let mut added = Vec::new();
    for (name, value) in metadata {
        if name.is_empty() || name.len() > 31 || name.contains('\0') {
            return Err(format!("the attribute name {name:?} must have 1 to 31 bytes without NUL"));
        }
        let size = i32::try_from(value.len()).map_err(|_| format!("the attribute {name} is too long"))?;
        added.extend_from_slice(name.as_bytes());
        added.extend_from_slice(b"\0string\0");
        added.extend_from_slice(&size.to_le_bytes());
        added.extend_from_slice(value.as_bytes());
    }
    let end = header_end(&bytes).ok_or("the header of the file is malformed")?;
    let table = end + 1;
    let blocks = table + 8 * height.div_ceil(16);
    let mut out = Vec::with_capacity(bytes.len() + added.len());
    out.extend_from_slice(&bytes[..end]);
    out.extend_from_slice(&added);
    out.push(0);
    for offset in bytes[table..blocks].chunks_exact(8) {
        let offset = u64::from_le_bytes(std::array::from_fn(|i| offset[i]));
        out.extend_from_slice(&(offset + added.len() as u64).to_le_bytes());
    }
    out.extend_from_slice(&bytes[blocks..]);
    Ok(out)
}

/// Index of the NUL that ends the attributes.
fn header_end(bytes: &[u8]) -> Option<usize> {
    let mut at = 8;
    while *bytes.get(at)? != 0 {
        for _ in 0..2 {
            at += bytes.get(at..)?.iter().position(|&b| b == 0)? + 1;
        }
        let size = i32::from_le_bytes(bytes.get(at..at + 4)?.try_into().ok()?);
        at += 4 + usize::try_from(size).ok()?;
    }
    Some(at)
}
