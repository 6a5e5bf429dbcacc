use std::path::Path;

use crate::output::{OutputError, OutputErrorKind, write_atomically};

/// Writes sRGB-encoded pixels, row by row, as PNG (see [`encode_png_bytes`]) by [`write_atomically`].
///
/// # Errors
/// Where the file can't be encoded or written.
pub fn write_png(
    path: &Path,
    width: usize,
    height: usize,
    pixels: &[[u8; 3]],
    metadata: &[(String, String)],
) -> Result<(), OutputError> {
    let bytes = encode_png_bytes(width, height, pixels, metadata)
        .map_err(|why| OutputError::new(path, OutputErrorKind::Encoding(why)))?;
    write_atomically(path, &bytes)
}

/// The bytes of a PNG file of sRGB-encoded pixels of 8 bits a channel, row by row; marked as sRGB. `metadata`: texts, in this
/// order; keywords are of 1 to 79 Latin-1 characters.
///
/// # Errors
/// An empty picture, another number of pixels than width × height, or a keyword that the format refuses.
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
