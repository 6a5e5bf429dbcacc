use std::io::Cursor;
use std::sync::Arc;

use image::{DynamicImage, ImageBuffer, ImageFormat, Luma, Rgb, Rgba};
use math::{Vec2, Vec3};

use super::*;

fn close(a: [f32; 3], b: [f32; 3], tolerance: f32) {
    assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() <= tolerance), "{a:?} {b:?}");
}

fn of(picture: Picture) -> ImageTexture {
    ImageTexture::new(Arc::new(picture.with_pyramid()))
}

fn grey(width: usize, height: usize, f: impl Fn(usize, usize) -> f32) -> ImageTexture {
    let texels: Vec<_> = (0..width * height).map(|i| [f(i % width, i / width); 3]).collect();
    of(Picture::new(Pixels::linear(width, height, &texels).unwrap(), Encoding::Linear, Wanted::Color)
        .unwrap())
}

fn at(u: f32, v: f32, width: f32) -> TexturePoint<'static> {
    TexturePoint::of_uv(Vec2::new(u, v), width)
}

fn written(image: DynamicImage, format: ImageFormat) -> Vec<u8> {
    let mut out = Cursor::new(Vec::new());
    image.write_to(&mut out, format).unwrap();
    out.into_inner()
}

/// 2×2: red, green / blue, grey 128.
fn four() -> DynamicImage {
    let pixels = [[255, 0, 0], [0, 255, 0], [0, 0, 255], [128, 128, 128]];
    DynamicImage::ImageRgb8(ImageBuffer::from_fn(2, 2, |x, y| Rgb(pixels[(y * 2 + x) as usize])))
}

fn png() -> Vec<u8> {
    written(four(), ImageFormat::Png)
}

#[test]
fn png_is_decoded_linearised_and_upright() {
    let mut t = ImageTexture::from_bytes(&png(), Encoding::Srgb).unwrap();
    t.filter = Filter::Nearest;
    close(t.evaluate(&at(0.1, 0.9, 0.0)), [1.0, 0.0, 0.0], 0.0);
    close(t.evaluate(&at(0.9, 0.9, 0.0)), [0.0, 1.0, 0.0], 0.0);
    close(t.evaluate(&at(0.1, 0.1, 0.0)), [0.0, 0.0, 1.0], 0.0);
    close(t.evaluate(&at(0.9, 0.1, 0.0)), [0.215_861; 3], 1e-6);
    close(t.evaluate(&at(1.1, -0.1, 0.0)), [1.0, 0.0, 0.0], 0.0);
    close(t.mean(), [(1.0 + 0.215_861) / 4.0; 3], 1e-6);
    let linear = ImageTexture::from_bytes(&png(), Encoding::Linear).unwrap();
    close(linear.mean(), [(1.0 + 128.0 / 255.0) / 4.0; 3], 1e-6);
}

#[test]
fn every_lossless_format_gives_the_same_texels() {
    let expected = Picture::from_bytes(&png(), "", Encoding::Srgb, Wanted::Color).unwrap();
    let formats =
        [ImageFormat::Tiff, ImageFormat::WebP, ImageFormat::Bmp, ImageFormat::Pnm, ImageFormat::Tga];
    for format in formats {
        let name = if format == ImageFormat::Tga { "a.TGA" } else { "" };
        let picture =
            Picture::from_bytes(&written(four(), format), name, Encoding::Srgb, Wanted::Color).unwrap();
        assert_eq!(picture.memory_bytes(), 12, "{format:?}");
        for i in 0..4 {
            assert_eq!(picture.pixel(i), expected.pixel(i), "{format:?}");
        }
    }
    // A TGA has no sign of itself.
    assert!(
        Picture::from_bytes(&written(four(), ImageFormat::Tga), "a", Encoding::Srgb, Wanted::Color).is_err()
    );
    let jpeg = Picture::from_bytes(
        &written(
            DynamicImage::ImageRgb8(ImageBuffer::from_pixel(8, 8, Rgb([200, 100, 50]))),
            ImageFormat::Jpeg,
        ),
        "",
        Encoding::Linear,
        Wanted::Color,
    );
    close(jpeg.unwrap().pixel(9), [200.0 / 255.0, 100.0 / 255.0, 50.0 / 255.0], 0.02);
}

#[test]
fn sixteen_bit_sources() {
    let image = ImageBuffer::from_pixel(3, 1, Rgb([65535u16, 32896, 0]));
    let bytes = written(DynamicImage::ImageRgb16(image), ImageFormat::Png);
    let t = ImageTexture::from_bytes(&bytes, Encoding::Srgb).unwrap();
    close(t.mean(), [1.0, 0.215_861, 0.0], 1e-4);
    // Linear ones keep every bit, as heights need.
    let ramp = ImageBuffer::from_fn(16, 1, |x, _| Luma([40_000u16 + x as u16]));
    let bytes = written(DynamicImage::ImageLuma16(ramp), ImageFormat::Tiff);
    let t = Picture::from_bytes(&bytes, "", Encoding::Linear, Wanted::Color).unwrap();
    for i in 0..16 {
        assert_eq!(t.pixel(i)[0], (40_000 + i) as f32 * (1.0 / 65535.0));
    }
    assert_eq!(t.memory_bytes(), 32);
}

#[test]
fn floating_point_sources() {
    let image = ImageBuffer::from_pixel(2, 2, Rgb([4.0f32, 2.0, 15.0]));
    let bytes = written(DynamicImage::ImageRgb32F(image.clone()), ImageFormat::Hdr);
    let hdr = Picture::from_bytes(&bytes, "", Encoding::Srgb, Wanted::Color).unwrap();
    // Eight bits under a shared exponent: steps of 1/16.
    close(hdr.pixel(3), [4.0, 2.0, 15.0], 1.0 / 16.0);
    let bytes = written(DynamicImage::ImageRgb32F(image), ImageFormat::OpenExr);
    let exr = Picture::from_bytes(&bytes, "", Encoding::Srgb, Wanted::Color).unwrap();
    assert_eq!((exr.pixel(1), exr.memory_bytes()), ([4.0, 2.0, 15.0], 4 * 6));
    // Too bright for halves.
    let image = ImageBuffer::from_pixel(2, 2, Rgb([4e6f32, 2.0, 15.0]));
    let bytes = written(DynamicImage::ImageRgb32F(image), ImageFormat::OpenExr);
    let exr = Picture::from_bytes(&bytes, "", Encoding::Srgb, Wanted::Color).unwrap();
    assert_eq!((exr.pixel(1), exr.memory_bytes()), ([4e6, 2.0, 15.0], 4 * 12));
    let mut pfm = b"PF\n2 2\n-1.0\n".to_vec();
    (0..12).for_each(|i| pfm.extend((i as f32).to_le_bytes()));
    let t = Picture::from_bytes(&pfm, "", Encoding::Srgb, Wanted::Color).unwrap();
    assert_eq!((t.pixel(2), t.pixel(0)), ([0.0, 1.0, 2.0], [6.0, 7.0, 8.0]), "rows go upward");
    let mut grey = b"Pf 1 2 1\n".to_vec();
    [0.125f32, 5.0].iter().for_each(|x| grey.extend(x.to_be_bytes()));
    let t = Picture::from_bytes(&grey, "", Encoding::Srgb, Wanted::Color).unwrap();
    assert_eq!((t.pixel(0), t.pixel(1)), ([5.0; 3], [0.125; 3]));
}

#[test]
fn a_grey_exr_is_read() {
    use exr::prelude::{AnyChannel, AnyChannels, FlatSamples, Image, WritableImage};
    let luminance = AnyChannel::new("Y", FlatSamples::F32(vec![0.5, 1.5]));
    let channels = AnyChannels::sort(std::iter::once(luminance).collect());
    let image = Image::from_channels((2, 1), channels);
    let mut bytes = Cursor::new(Vec::new());
    image.write().non_parallel().to_buffered(&mut bytes).unwrap();
    let t = Picture::from_bytes(bytes.get_ref(), "", Encoding::Srgb, Wanted::Color).unwrap();
    // One channel is data: no half.
    assert_eq!((t.pixel(0), t.pixel(1), t.memory_bytes()), ([0.5; 3], [1.5; 3], 8));
}

#[test]
fn memory_is_what_the_file_needs() {
    let n = 64;
    let bytes = |image: DynamicImage, wanted: Wanted| {
        let pixels = Pixels::from_image(image).unwrap();
        Picture::new(pixels, Encoding::Srgb, wanted).unwrap().with_pyramid().memory_bytes() as f64
            / (n * n) as f64
    };
    let coloured = |a: u8| ImageBuffer::from_fn(n, n, move |x, y| Rgba([x as u8, y as u8, 7, a]));
    let third = 4.0 / 3.0;
    let near = |a: f64, b: f64| assert!((a - b).abs() < 0.01 * b, "{a} {b}");
    near(bytes(DynamicImage::ImageRgba8(coloured(9)), Wanted::Color), 3.0 * third);
    near(bytes(DynamicImage::ImageRgba8(coloured(9)), Wanted::Both), 4.0 * third);
    near(bytes(DynamicImage::ImageRgba8(coloured(9)), Wanted::Alpha), third);
    // Opaque, or grey though stored in colour.
    near(bytes(DynamicImage::ImageRgba8(coloured(255)), Wanted::Both), 3.0 * third);
    let same = ImageBuffer::from_fn(n, n, |x, _| Rgb([x as u8; 3]));
    near(bytes(DynamicImage::ImageRgb8(same), Wanted::Color), third);
    let words = ImageBuffer::from_fn(n, n, |x, y| Rgb([x as u16, y as u16, 7]));
    near(bytes(DynamicImage::ImageRgb16(words), Wanted::Color), 6.0 * third);
    let floats = ImageBuffer::from_fn(n, n, |x, y| Rgb([x as f32, y as f32, 7.0]));
    near(bytes(DynamicImage::ImageRgb32F(floats), Wanted::Color), 6.0 * third);
}

#[test]
fn opacity_is_never_decoded_and_channels_are_single() {
    let image = DynamicImage::ImageRgba8(ImageBuffer::from_pixel(2, 2, Rgba([255, 0, 128, 128])));
    let pixels =
        |wanted| Picture::new(Pixels::from_image(image.clone()).unwrap(), Encoding::Srgb, wanted).unwrap();
    for wanted in [Wanted::Alpha, Wanted::Both] {
        let mut t = of(pixels(wanted));
        t.channel = Channel::Alpha;
        close(t.evaluate(&at(0.3, 0.3, 0.7)), [128.0 / 255.0; 3], 1e-6);
        t.invert = true;
        t.factor = [0.5, 1.0, -2.0];
        let rest = 127.0 / 255.0;
        close(t.evaluate(&at(0.3, 0.3, 0.0)), [0.5 * rest, rest, -2.0 * rest], 1e-6);
        close(t.mean(), [0.5 * rest, rest, -2.0 * rest], 1e-6);
    }
    let mut t = of(pixels(Wanted::Both));
    for (channel, value) in [(0, 1.0), (1, 0.0), (2, 0.215_861)] {
        t.channel = Channel::One(channel);
        close(t.evaluate(&at(0.3, 0.3, 0.0)), [value; 3], 1e-6);
    }
    // No opacity in the file: opaque.
    let mut plain = of(Picture::from_bytes(&png(), "", Encoding::Srgb, Wanted::Alpha).unwrap());
    plain.channel = Channel::Alpha;
    assert_eq!(plain.evaluate(&at(0.2, 0.4, 0.0)), [1.0; 3]);
}

#[test]
fn bilinear_is_linear_between_texel_centres_and_wraps() {
    let mut t = grey(4, 1, |x, _| x as f32);
    t.filter = Filter::Bilinear;
    let look = |t: &ImageTexture, u: f32| t.evaluate(&at(u, 0.5, 0.0))[0];
    assert!((look(&t, 1.5 / 4.0) - 1.0).abs() < 1e-6);
    assert!((look(&t, 0.5) - 1.5).abs() < 1e-6);
    assert!((look(&t, 0.0) - 1.5).abs() < 1e-6, "repeat: between 3 and 0");
    assert!((look(&t, -0.125) - 3.0).abs() < 1e-6);
    t.wrap = [Wrap::Clamp, Wrap::Repeat];
    assert_eq!((look(&t, -7.0), look(&t, 0.0), look(&t, 9.0)), (0.0, 0.0, 3.0));
    t.wrap[0] = Wrap::Mirror;
    assert!((look(&t, -0.375) - 1.0).abs() < 1e-6);
    assert!((look(&t, 1.0 + 0.375) - 2.0).abs() < 1e-6);
    t.wrap[0] = Wrap::Black;
    assert_eq!((look(&t, -0.3), look(&t, 1.3)), (0.0, 0.0));
    assert!((look(&t, 1.0) - 1.5).abs() < 1e-6, "half of 3");
    t.invert = true;
    assert_eq!(look(&t, 1.3), 1.0);
    t.invert = false;
    t.wrap[0] = Wrap::Mirror;
    t.map = Mapping::uv(0, Vec2::new(0.5, 1.0), 0.0, Vec2::new(0.25, 0.0));
    assert!((look(&t, 0.5) - 1.5).abs() < 1e-6);
}

#[test]
fn wraps_differ_by_axis() {
    let mut t = grey(2, 2, |x, y| (x + 2 * y) as f32);
    t.filter = Filter::Nearest;
    t.wrap = [Wrap::Clamp, Wrap::Repeat];
    // Row 1 (below) repeats above the top; the right column goes on to the right.
    assert_eq!(t.evaluate(&at(5.2, 1.2, 0.0)), [3.0; 3]);
    t.wrap = [Wrap::Repeat, Wrap::Clamp];
    assert_eq!(t.evaluate(&at(5.2, 1.2, 0.0)), [0.0; 3]);
}

#[test]
fn mappings_scale_turn_and_move() {
    // (1, 0) scaled by (2, 3), turned by 90° from u toward v, moved.
    let turned = Mapping::uv(0, Vec2::new(2.0, 3.0), 90.0, Vec2::new(0.5, 0.25));
    let (p, width) = turned.apply(&at(1.0, 0.0, 0.1));
    assert!((p - Vec2::new(0.5, 2.25)).length() < 1e-6, "{p}");
    assert!((width - Vec2::new(0.3, 0.2)).length() < 1e-6, "{width}");
    let (p, _) = turned.apply(&at(0.0, 1.0, 0.1));
    assert!((p - Vec2::new(-2.5, 0.25)).length() < 1e-6, "{p}");
    let planar = Mapping::Planar { rows: [Vec3::new(0.0, 0.0, 2.0), Vec3::X], offset: Vec2::new(0.5, 0.0) };
    let place = TexturePoint { p: Vec3::new(7.0, 1.0, 3.0), ..at(0.0, 0.0, 0.1) };
    let (p, width) = planar.apply(&place);
    assert_eq!((p, width), (Vec2::new(6.5, 7.0), Vec2::new(0.2, 0.1)));
    // Growing u of the turned map is where its own first coordinate grows and its second does not.
    let tangents = [Vec3::X, Vec3::Y];
    let [du, dv] = turned.directions(Vec3::Z, |_| tangents);
    let [u, v] = [du, dv].map(|d| d.normalize());
    assert!((u - Vec3::new(0.0, -1.0, 0.0)).length() < 1e-6, "{u}");
    assert!((v - Vec3::X).length() < 1e-6, "{v}");
    let mirrored = Mapping::uv(0, Vec2::new(-1.0, 1.0), 0.0, Vec2::ZERO);
    let [du, dv] = mirrored.directions(Vec3::Z, |_| tangents);
    assert!(du.x < 0.0 && dv.y > 0.0, "{du} {dv}");
}

#[test]
fn pyramid_keeps_the_mean_of_odd_sizes_and_trilinear_blurs() {
    let t = grey(7, 5, |x, y| ((x * 31 + y * 17) % 11) as f32);
    let wide = t.evaluate(&at(0.3, 0.8, 4.0));
    close(wide, t.mean(), 1e-5);
    // Stripes two texels wide: a footprint of a whole period averages them, one of zero does not.
    let stripes = grey(64, 64, |x, _| ((x / 2) % 2) as f32);
    let look = |width: f32| stripes.evaluate(&at(0.5 + 1.0 / 64.0, 0.5, width))[0];
    let (sharp, soft) = (look(0.0), look(4.0 / 64.0));
    assert!(sharp < 1e-6 && (soft - 0.5).abs() < 1e-6, "{sharp} {soft}");
    // Between two levels the blend is linear in log₂ of the footprint.
    let between = look(2.0f32.sqrt() / 64.0);
    assert!((between - 0.5 * (sharp + look(2.0 / 64.0))).abs() < 1e-5);
}

#[test]
fn pyramids_of_bytes_average_light_not_codes() {
    // Black and white in turn: the mean of light is 1/2, whose code is 188, not 128.
    let image = ImageBuffer::from_fn(16, 16, |x, y| Rgb([if (x + y) % 2 == 0 { 255u8 } else { 0 }, 255, 0]));
    let pixels = Pixels::from_image(DynamicImage::ImageRgb8(image)).unwrap();
    let t = of(Picture::new(pixels, Encoding::Srgb, Wanted::Color).unwrap());
    for width in [2.0, 5.0, 16.0, 99.0] {
        close(t.evaluate(&at(0.4, 0.7, width / 16.0)), [0.5, 1.0, 0.0], 0.004);
    }
    close(t.mean(), [0.5, 1.0, 0.0], 1e-6);
}

#[test]
fn products_and_mixes() {
    let textures = [
        Texture::Constant([0.5, 1.0, 2.0]),
        Texture::Checker(Checker {
            even: Source::Texture(0),
            odd: Source::Constant([0.0; 3]),
            map: Mapping::default(),
        }),
    ];
    let product = Texture::Product(Source::Texture(1), Source::Constant([3.0, 1.0, 0.5]));
    let look = |t: &Texture, u: f32| t.evaluate(&textures, &at(u, 0.5, 0.0));
    assert_eq!((look(&product, 0.5), look(&product, 1.5)), ([1.5, 1.0, 1.0], [0.0; 3]));
    assert_eq!(product.mean(&textures), [0.75, 0.5, 0.5]);
    let mix = Texture::Mix(Source::Constant([1.0; 3]), Source::Texture(0), Source::Constant([0.25; 3]));
    assert_eq!(look(&mix, 0.0), [0.875, 1.0, 1.25]);
    let by_checker = Texture::Mix(Source::Constant([0.0; 3]), Source::Constant([9.0; 3]), Source::Texture(1));
    // The mean of (0.5, 1, 2) is more than 1: extrapolated.
    assert!((look(&by_checker, 0.5)[0] - 10.5).abs() < 1e-5);
    assert_eq!(look(&by_checker, 1.5), [0.0; 3]);
    assert_eq!(product.parts().collect::<Vec<_>>(), [1]);
    // What is not there is black, not a panic.
    assert_eq!(Source::Texture(9).evaluate(&textures, &at(0.0, 0.0, 0.0)), [0.0; 3]);
}

#[test]
fn normals_are_unit_vectors() {
    let flat = Texture::Constant([0.5, 0.5, 1.0]);
    let point = at(0.0, 0.0, 0.0);
    assert_eq!(flat.evaluate_normal(&[], &point), Vec3::Z);
    let tilted = Texture::Constant([1.0, 0.5, 1.0]).evaluate_normal(&[], &point);
    assert!((tilted - Vec3::new(0.5f32.sqrt(), 0.0, 0.5f32.sqrt())).length() < 1e-6);
    assert_eq!(Texture::Constant([0.5; 3]).evaluate_normal(&[], &point), Vec3::Z);
}

#[test]
fn mistakes_are_errors() {
    let decode = |bytes: &[u8]| ImageTexture::from_bytes(bytes, Encoding::Srgb).err();
    assert!(matches!(decode(b"no image"), Some(TextureError::Undecodable(_))));
    let whole = png();
    assert!(matches!(decode(&whole[..whole.len() / 2]), Some(TextureError::Undecodable(_))));
    let missing = ImageTexture::from_path(std::path::Path::new("missing.png"), Encoding::Srgb).err().unwrap();
    assert!(missing.to_string().contains("missing.png"));
    assert!(matches!(Pixels::linear(0, 3, &[]), Err(TextureError::Empty)));
    let nan = Pixels::linear(1, 1, &[[f32::NAN; 3]]).unwrap();
    assert!(matches!(Picture::new(nan, Encoding::Srgb, Wanted::Color), Err(TextureError::NotFinite)));
    for text in ["PF\n", "PF\n2 2\n", "PF\n2 2\n-1\n123", "PF\n-2 2\n-1\n", "Pf x 2 -1\n", "PF\n2 2\nno\n"] {
        assert!(matches!(decode(text.as_bytes()), Some(TextureError::Broken(_))), "{text}");
    }
    assert!(matches!(decode(b"\x76\x2f\x31\x01\x02\0\0\0garbage"), Some(TextureError::Broken(_))));
}

#[test]
fn sizes_that_are_claimed_are_not_believed() {
    let decode = |bytes: &[u8]| ImageTexture::from_bytes(bytes, Encoding::Srgb).err();
    assert!(matches!(decode(b"PF\n99999999 99999999\n-1\n"), Some(TextureError::TooLarge(..))));
    assert!(matches!(decode(b"PF\n18446744073709551615 9\n-1\n"), Some(TextureError::TooLarge(..))));
    assert!(matches!(decode(b"PF\n60000 60000\n-1\n"), Some(TextureError::TooLarge(..))));
    assert!(matches!(decode(b"PF\n0 5\n-1\n"), Some(TextureError::Empty)));
    // The header of a PNG of 60000 × 60000, with its right checksum, and little else.
    let mut huge = png();
    huge[16..24].copy_from_slice(&[0, 0, 0xea, 0x60, 0, 0, 0xea, 0x60]);
    let mut crc = !0u32;
    for byte in &huge[12..29] {
        crc ^= u32::from(*byte);
        (0..8).for_each(|_| crc = if crc & 1 == 1 { (crc >> 1) ^ 0xedb8_8320 } else { crc >> 1 });
    }
    huge[29..33].copy_from_slice(&(!crc).to_be_bytes());
    let error = decode(&huge).unwrap();
    assert!(matches!(error, TextureError::TooLarge(60000, 60000)), "{error}");
}

#[test]
fn far_coordinates_do_not_panic() {
    let mut t = grey(3, 3, |x, _| x as f32);
    for wrap in [Wrap::Repeat, Wrap::Clamp, Wrap::Mirror, Wrap::Black] {
        t.wrap = [wrap; 2];
        for x in [1e30, -1e30, f32::INFINITY, f32::NAN] {
            let _ = t.evaluate(&at(x, x, 0.1));
        }
        let _ = t.evaluate(&at(0.0, 0.0, f32::INFINITY));
        let _ = t.evaluate(&at(0.0, 0.0, f32::NAN));
    }
}

#[test]
fn damaged_files_are_errors_or_pictures() {
    use sampling::{Domain, Sampler};
    let image = ImageBuffer::from_fn(9, 7, |x, y| Rgb([(x * 20) as u8, (y * 30) as u8, 7]));
    let bytes = DynamicImage::ImageRgb8(image);
    let floats = DynamicImage::ImageRgb32F(bytes.to_rgb32f());
    let mut files: Vec<Vec<u8>> =
        [ImageFormat::Png, ImageFormat::Jpeg, ImageFormat::Tiff, ImageFormat::WebP, ImageFormat::Bmp]
            .into_iter()
            .chain([ImageFormat::Pnm, ImageFormat::Tga])
            .map(|format| written(bytes.clone(), format))
            .collect();
    files.extend([ImageFormat::Hdr, ImageFormat::OpenExr].map(|format| written(floats.clone(), format)));
    let mut pfm = b"PF\n3 2\n-1.0\n".to_vec();
    pfm.extend([0x3f; 72]);
    files.push(pfm);
    for (kind, whole) in files.iter().enumerate() {
        let mut decoded = 0;
        for trial in 0..150 {
            let mut s = Sampler::new(kind as u64, trial, Domain::Other, 0);
            let mut file = whole.clone();
            // Bytes changed, most often in the header, or the end cut off.
            for _ in 0..1 + s.next_u32() % 4 {
                let within = if s.next_u32().is_multiple_of(4) { file.len() } else { file.len().min(64) };
                let place = s.next_u32() as usize % within;
                file[place] = [0, 0xff, 0x7f, s.next_u32() as u8][s.next_u32() as usize % 4];
            }
            if s.next_u32().is_multiple_of(4) {
                file.truncate(s.next_u32() as usize % file.len());
            }
            decoded += u32::from(Picture::from_bytes(&file, "x.tga", Encoding::Srgb, Wanted::Both).is_ok());
        }
        assert!(decoded < 150, "{kind}: none of the damage is noticed");
    }
}
