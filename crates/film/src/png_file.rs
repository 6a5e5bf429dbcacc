use std::path::Path;

use color::ViewTransform;

use crate::output::{OutputError, OutputErrorKind, write_atomically};

/// How radiance is shown in a PNG file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PngOptions {
    /// Radiance is multiplied by 2 to this power first.
    pub exposure_ev: f32,
    /// The view transform.
    pub view: ViewTransform,
    /// Texts, in this order. Keywords are of 1 to 79 Latin-1 characters.
    pub metadata: Vec<(String, String)>,
}

/// Writes linear Rec. 709 pixels, row by row, as PNG (see [`encode_png`]) by [`write_atomically`].
///
/// # Errors
/// Where the file can't be encoded or written.
pub fn write_png(
    path: &Path,
    width: usize,
    height: usize,
    pixels: &[[f32; 3]],
    options: &PngOptions,
) -> Result<(), OutputError> {
    let bytes = encode_png(width, height, pixels, options)
        .map_err(|why| OutputError::new(path, OutputErrorKind::Encoding(why)))?;
    write_atomically(path, &bytes)
}

/// The bytes of a PNG file of 8 bits a channel: exposed, transformed, rounded to the nearest of 256 steps; marked as
/// sRGB.
///
/// # Errors
/// An empty picture, another number of pixels than width × height, or a keyword that the format refuses.
pub fn encode_png(
    width: usize,
    height: usize,
    pixels: &[[f32; 3]],
    options: &PngOptions,
) -> Result<Vec<u8>, String> {
    let shown: Vec<[u8; 3]> = pixels
        .iter()
        // The cast saturates.
        .map(|&p| options.view.apply(p, options.exposure_ev).map(|v| (v * 255.0 + 0.5) as u8))
        .collect();
    encode_png_bytes(width, height, &shown, &options.metadata)
}

/// The bytes of a PNG file of sRGB-encoded pixels, row by row.
///
/// # Errors
/// As [`encode_png`].
pub fn encode_png_bytes(
    width: usize,
    height: usize,
    pixels: &[[u8; 3]],
    metadata: &[(String, String)],
) -> Result<Vec<u8>, String> {
    let size = u32::try_from(width).ok().zip(u32::try_from(height).ok());
    let (Some((w, h)), true) = (size, width.checked_mul(height) == Some(pixels.len())) else {
        return Err(format!("{} pixels do not make a picture of {width}x{height}", pixels.len()));
    };
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, w, h);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    let text = |e: png::EncodingError| e.to_string();
    for (keyword, value) in metadata {
        if keyword.is_empty() || keyword.chars().count() > 79 {
            return Err(format!("the keyword {keyword:?} must have 1 to 79 characters"));
        }
        if value.is_ascii() {
            encoder.add_text_chunk(keyword.clone(), value.clone()).map_err(text)?;
        } else {
            encoder.add_itxt_chunk(keyword.clone(), value.clone()).map_err(text)?;
        }
    }
    let mut writer = encoder.write_header().map_err(text)?;
    writer.write_image_data(pixels.as_flattened()).map_err(text)?;
    writer.finish().map_err(text)?;
    Ok(bytes)
}
