//! What must be known of pictures before a scene is described.

use std::io::{BufReader, Read};
use std::path::Path;

use image::{DynamicImage, ImageDecoder, ImageReader};

/// Width and height, by the file's head; `None` where it cannot be told.
pub(crate) fn size(path: &Path) -> Option<[u32; 2]> {
    if let Some(size) = pfm_size(path) {
        return Some(size);
    }
    let (width, height) = reader(path)?.into_dimensions().ok()?;
    Some([width, height])
}

/// Whether some of its pixels are not opaque. A file that cannot be read has none.
pub(crate) fn is_holey(path: &Path) -> bool {
    let Some(decoder) = reader(path).and_then(|r| r.into_decoder().ok()) else { return false };
    // A gigabyte of pixels: such a picture is rendered from a smaller one.
    if !decoder.color_type().has_alpha() || decoder.total_bytes() > 1 << 30 {
        return false;
    }
    match DynamicImage::from_decoder(decoder) {
        Ok(DynamicImage::ImageLumaA8(image)) => image.pixels().any(|p| p.0[1] != u8::MAX),
        Ok(DynamicImage::ImageRgba8(image)) => image.pixels().any(|p| p.0[3] != u8::MAX),
        Ok(DynamicImage::ImageLumaA16(image)) => image.pixels().any(|p| p.0[1] != u16::MAX),
        Ok(DynamicImage::ImageRgba16(image)) => image.pixels().any(|p| p.0[3] != u16::MAX),
        Ok(image) => image.into_rgba32f().pixels().any(|p| p.0[3] != 1.0),
        Err(_) => false,
    }
}

/// Of a portable float map: "PF" or "Pf", width and height in words.
fn pfm_size(path: &Path) -> Option<[u32; 2]> {
    let mut head = [0; 64];
    let length = path.is_file().then(|| std::fs::File::open(path).ok()?.read(&mut head).ok())??;
    let text = String::from_utf8_lossy(&head[..length]);
    let mut words = text.split_ascii_whitespace();
    matches!(words.next()?, "PF" | "Pf").then_some(())?;
    Some([words.next()?.parse().ok()?, words.next()?.parse().ok()?])
}

fn reader(path: &Path) -> Option<ImageReader<BufReader<std::fs::File>>> {
    if !path.is_file() {
        return None;
    }
    ImageReader::open(path).ok()?.with_guessed_format().ok()
}

#[cfg(test)]
mod tests {
    use image::{Rgba, RgbaImage};

    use super::*;

    #[test]
    fn sizes_and_holes() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        let mut image = RgbaImage::from_pixel(5, 3, Rgba([1, 2, 3, 255]));
        image.save(&path).unwrap();
        assert_eq!((size(&path), is_holey(&path)), (Some([5, 3]), false));
        image.put_pixel(4, 2, Rgba([1, 2, 3, 254]));
        image.save(&path).unwrap();
        assert!(is_holey(&path));
        std::fs::write(&path, b"no picture").unwrap();
        assert_eq!((size(&path), is_holey(&path)), (None, false));
        std::fs::write(&path, b"PF\n20 10\n-1.0\n\x00\x00").unwrap();
        assert_eq!(size(&path), Some([20, 10]));
        assert_eq!(size(&folder.path().join("none.png")), None);
    }
}
