use std::io::Cursor;

use image::{DynamicImage, ImageBuffer, ImageFormat, Rgb};
use math::{Vec2, Vec3};

use super::*;

fn close(a: [f32; 3], b: [f32; 3], tolerance: f32) {
    assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() <= tolerance), "{a:?} {b:?}");
}

fn grey(width: usize, height: usize, f: impl Fn(usize, usize) -> f32) -> ImageTexture {
    let texels = (0..width * height).map(|i| [f(i % width, i / width); 3]).collect();
    ImageTexture::from_linear(width, height, texels).unwrap()
}

/// 2×2: red, green / blue, grey 128.
fn png() -> Vec<u8> {
    let pixels = [[255, 0, 0], [0, 255, 0], [0, 0, 255], [128, 128, 128]];
    let image = ImageBuffer::from_fn(2, 2, |x, y| Rgb(pixels[(y * 2 + x) as usize]));
    let mut out = Cursor::new(Vec::new());
    DynamicImage::ImageRgb8(image).write_to(&mut out, ImageFormat::Png).unwrap();
    out.into_inner()
}

#[test]
fn png_is_decoded_linearised_and_upright() {
    let mut t = ImageTexture::from_bytes(&png(), Encoding::Srgb).unwrap();
    t.filter = Filter::Nearest;
    let t = Texture::Image(t);
    close(t.evaluate(Vec2::new(0.1, 0.9), 0.0), [1.0, 0.0, 0.0], 0.0);
    close(t.evaluate(Vec2::new(0.9, 0.9), 0.0), [0.0, 1.0, 0.0], 0.0);
    close(t.evaluate(Vec2::new(0.1, 0.1), 0.0), [0.0, 0.0, 1.0], 0.0);
    close(t.evaluate(Vec2::new(0.9, 0.1), 0.0), [0.215_861; 3], 1e-6);
    close(t.evaluate(Vec2::new(1.1, -0.1), 0.0), [1.0, 0.0, 0.0], 0.0);
    close(t.mean(), [(1.0 + 0.215_861) / 4.0; 3], 1e-6);
    let linear = ImageTexture::from_bytes(&png(), Encoding::Linear).unwrap();
    close(linear.mean(), [(1.0 + 128.0 / 255.0) / 4.0; 3], 1e-6);
}

#[test]
fn sixteen_bit_and_hdr_sources() {
    let image = ImageBuffer::from_pixel(3, 1, Rgb([65535u16, 32896, 0]));
    let mut out = Cursor::new(Vec::new());
    DynamicImage::ImageRgb16(image).write_to(&mut out, ImageFormat::Png).unwrap();
    let t = ImageTexture::from_bytes(out.get_ref(), Encoding::Srgb).unwrap();
    close(t.mean(), [1.0, 0.215_861, 0.0], 1e-6);
    let image = ImageBuffer::from_pixel(2, 2, Rgb([4.0f32, 2.0, 15.0]));
    let mut out = Cursor::new(Vec::new());
    DynamicImage::ImageRgb32F(image).write_to(&mut out, ImageFormat::Hdr).unwrap();
    let t = ImageTexture::from_bytes(out.get_ref(), Encoding::Srgb).unwrap();
    // Eight bits under a shared exponent: steps of 1/16.
    close(t.mean(), [4.0, 2.0, 15.0], 1.0 / 16.0);
}

#[test]
fn bilinear_is_linear_between_texel_centres_and_wraps() {
    let mut t = grey(4, 1, |x, _| x as f32);
    t.filter = Filter::Bilinear;
    let at = |t: &ImageTexture, u: f32| t.evaluate(Vec2::new(u, 0.5), 0.0)[0];
    assert!((at(&t, 1.5 / 4.0) - 1.0).abs() < 1e-6);
    assert!((at(&t, 0.5) - 1.5).abs() < 1e-6);
    assert!((at(&t, 0.0) - 1.5).abs() < 1e-6, "repeat: between 3 and 0");
    assert!((at(&t, -0.125) - 3.0).abs() < 1e-6);
    t.wrap = Wrap::Clamp;
    assert_eq!((at(&t, -7.0), at(&t, 0.0), at(&t, 9.0)), (0.0, 0.0, 3.0));
    t.wrap = Wrap::Mirror;
    assert!((at(&t, -0.375) - 1.0).abs() < 1e-6);
    assert!((at(&t, 1.0 + 0.375) - 2.0).abs() < 1e-6);
    t.map = UvMap { scale: Vec2::new(0.5, 1.0), offset: Vec2::new(0.25, 0.0) };
    assert!((at(&t, 0.5) - 1.5).abs() < 1e-6);
}

#[test]
fn pyramid_keeps_the_mean_of_odd_sizes_and_trilinear_blurs() {
    let t = grey(7, 5, |x, y| ((x * 31 + y * 17) % 11) as f32);
    let wide = t.evaluate(Vec2::new(0.3, 0.8), 4.0);
    close(wide, t.mean(), 1e-5);
    // Stripes two texels wide: a footprint of a whole period averages them, one of zero does not.
    let stripes = grey(64, 64, |x, _| ((x / 2) % 2) as f32);
    let uv = Vec2::new(0.5 + 1.0 / 64.0, 0.5);
    let (sharp, soft) = (stripes.evaluate(uv, 0.0)[0], stripes.evaluate(uv, 4.0 / 64.0)[0]);
    assert!(sharp < 1e-6 && (soft - 0.5).abs() < 1e-6, "{sharp} {soft}");
    // Between two levels the blend is linear in log₂ of the footprint.
    let between = stripes.evaluate(uv, 2.0f32.sqrt() / 64.0)[0];
    let next = stripes.evaluate(uv, 2.0 / 64.0)[0];
    assert!((between - 0.5 * (sharp + next)).abs() < 1e-5);
}

#[test]
fn normals_are_unit_vectors() {
    let flat = Texture::Constant([0.5, 0.5, 1.0]);
    assert_eq!(flat.evaluate_normal(Vec2::ZERO, 0.0), Vec3::Z);
    let tilted = Texture::Constant([1.0, 0.5, 1.0]).evaluate_normal(Vec2::ZERO, 0.0);
    assert!((tilted - Vec3::new(0.5f32.sqrt(), 0.0, 0.5f32.sqrt())).length() < 1e-6);
    assert_eq!(Texture::Constant([0.5; 3]).evaluate_normal(Vec2::ZERO, 0.0), Vec3::Z);
}

#[test]
fn mistakes_are_errors() {
    let decode = |bytes: &[u8]| ImageTexture::from_bytes(bytes, Encoding::Srgb).err();
    assert!(matches!(decode(b"no image"), Some(TextureError::Undecodable(_))));
    let whole = png();
    assert!(matches!(decode(&whole[..whole.len() / 2]), Some(TextureError::Undecodable(_))));
    let missing = ImageTexture::from_path(std::path::Path::new("missing.png"), Encoding::Srgb).err().unwrap();
    assert!(missing.to_string().contains("missing.png"));
    assert!(matches!(ImageTexture::from_linear(0, 3, vec![]), Err(TextureError::Empty)));
    assert!(matches!(ImageTexture::from_linear(1, 1, vec![[f32::NAN; 3]]), Err(TextureError::NotFinite)));
}

#[test]
fn far_coordinates_do_not_panic() {
    let mut t = grey(3, 3, |x, _| x as f32);
    for wrap in [Wrap::Repeat, Wrap::Clamp, Wrap::Mirror] {
        t.wrap = wrap;
        for x in [1e30, -1e30, f32::INFINITY, f32::NAN] {
            let _ = t.evaluate(Vec2::new(x, x), 0.1);
        }
        let _ = t.evaluate(Vec2::ZERO, f32::INFINITY);
        let _ = t.evaluate(Vec2::ZERO, f32::NAN);
    }
}
