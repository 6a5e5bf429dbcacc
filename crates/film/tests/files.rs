//! EXR and PNG files: what is written is read again, and the bytes depend on nothing else.

#![allow(clippy::unwrap_used)] // Helpers of tests are not seen as tests.

use exr::prelude::{ReadChannels, ReadLayers};
use nephroid_film::{
    ExrOptions, Film, Layer, PassFilm, PixelSample, Precision, ReadErrorKind, RgbImage, encode_exr,
    encode_exr_rgb, encode_png_bytes, write_exr, write_png,
};

const WIDTH: usize = 21;
const HEIGHT: usize = 37;

fn film() -> Film {
    let mut film = Film::new(WIDTH, HEIGHT);
    for pass in 0..3 {
        let pixels = (0..WIDTH * HEIGHT)
            .map(|i| {
                let v = (i * 3 + pass as usize * 7) as f32 * 0.37;
                PixelSample {
                    direct: [v, v * 0.5, 0.1],
                    caustic: [0.0, 1e5, v * v],
                    indirect: [1e-3, v, 2.0],
                    albedo: [0.25, 0.5, 0.75],
                    normal: [0.0, 0.6, -0.8],
                    depth: v + 0.5,
                    photon_density: 1e6 + v,
                    weight: 1.0,
                }
            })
            .collect();
        film.add(pass, &PassFilm::new(WIDTH, HEIGHT, pixels).unwrap()).unwrap();
    }
    film
}

fn options(precision: Precision) -> ExrOptions {
    let metadata =
        [("nephroid:sceneHash", "0123abcd"), ("nephroid:passes", "3"), ("note", "Größe 1,5 µm"), ("a", "")];
    ExrOptions {
        precision,
        metadata: metadata.map(|(n, v)| (n.into(), v.into())).into(),
        ..ExrOptions::default()
    }
}

#[test]
fn every_layer_of_an_exr_comes_back() {
    let film = film();
    for precision in [Precision::F32, Precision::F16] {
        let bytes = encode_exr(&film, &options(precision)).unwrap();
        let image = exr::prelude::read()
            .no_deep_data()
            .largest_resolution_level()
            .all_channels()
            .all_layers()
            .all_attributes()
            .from_buffered(std::io::Cursor::new(&bytes))
            .unwrap();
        let part = &image.layer_data[0];
        assert_eq!((image.layer_data.len(), part.size.0, part.size.1), (1, WIDTH, HEIGHT));
        let channels = &part.channel_data.list;
        assert_eq!(channels.len(), Layer::ALL.iter().map(|l| l.channels()).sum::<usize>());
        for layer in Layer::ALL {
            let values = film.layer(layer);
            for (c, name) in layer.channel_names().iter().enumerate() {
                let stored = &channels.iter().find(|s| s.name.to_string() == *name).unwrap().sample_data;
                let exact = precision == Precision::F32 || matches!(layer, Layer::Beauty | Layer::Depth);
                for (i, found) in stored.values_as_f32().enumerate() {
                    let value = values[i * layer.channels() + c];
                    let expected = if exact { value } else { value.min(65504.0) };
                    let tolerance = if exact { 0.0 } else { expected.abs() * 5e-4 };
                    assert!((found - expected).abs() <= tolerance, "{name}: {found} {expected}");
                }
            }
        }
        for (name, value) in options(precision).metadata {
            let found = part.attributes.other.iter().find(|(n, _)| n.to_string() == name).map(|(_, v)| v);
            let text = match found {
                Some(exr::meta::attribute::AttributeValue::Text(text)) => text.as_slice().to_vec(),
                other => panic!("{name}: {other:?}"),
            };
            assert_eq!(text, value.as_bytes());
        }
    }
}

#[test]
fn exr_bytes_are_the_same_each_time_and_attributes_in_order() {
    let film = film();
    let bytes = encode_exr(&film, &options(Precision::F32)).unwrap();
    for _ in 0..5 {
        assert!(encode_exr(&film, &options(Precision::F32)).unwrap() == bytes);
    }
    let at = |text: &str| bytes.windows(text.len()).position(|w| w == text.as_bytes()).unwrap();
    assert!(at("nephroid:sceneHash") < at("nephroid:passes") && at("nephroid:passes") < at("note\0string"));
}

#[test]
fn exr_files_are_read_as_beauty() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("film.exr");
    let film = film();
    write_exr(&path, &film, &options(Precision::F16)).unwrap();
    let image = RgbImage::read(&path).unwrap();
    assert_eq!((image.width(), image.height()), (WIDTH, HEIGHT));
    assert_eq!(image.pixels(), film.beauty());
    // Without the root layer, the first in the alphabet that has R, G, B.
    let some =
        ExrOptions { layers: vec![Layer::Depth, Layer::Direct, Layer::Caustic], ..ExrOptions::default() };
    let caustic = RgbImage::decode(&encode_exr(&film, &some).unwrap()).unwrap();
    assert_eq!(caustic.pixels().as_flattened(), film.layer(Layer::Caustic));
    let none = ExrOptions { layers: vec![Layer::Depth], ..ExrOptions::default() };
    let error = RgbImage::decode(&encode_exr(&film, &none).unwrap()).unwrap_err();
    assert!(matches!(error, ReadErrorKind::NoRgb(names) if names == ["depth.Z"]));
}

#[test]
fn values_that_are_not_finite_survive_an_exr() {
    let pixels = [[f32::NAN, f32::INFINITY, -1.5], [0.0, 1e30, 1e-30]];
    let image = RgbImage::decode(&encode_exr_rgb(2, 1, &pixels, &[]).unwrap()).unwrap();
    assert!(image.pixels()[0][0].is_nan());
    assert_eq!(
        (image.pixels()[0][1], image.pixels()[0][2], image.pixels()[1]),
        (f32::INFINITY, -1.5, pixels[1])
    );
}

#[test]
fn png_files_come_back_to_half_a_step() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.png");
    let pixels: Vec<[f32; 3]> = (0..64).map(|i| [i as f32 / 64.0, 0.25, (i as f32 / 64.0).powi(3)]).collect();
    let metadata = vec![("Software".into(), "nephroid".into()), ("scene".into(), "Tasse № 1".into())];
    let shown: Vec<[u8; 3]> = pixels.iter().map(|p| p.map(|v| color::linear_to_srgb8(v * 0.5))).collect();
    write_png(&path, 8, 8, &shown, &metadata).unwrap();
    let bytes = std::fs::read(&path).unwrap();
    assert_eq!(bytes, encode_png_bytes(8, 8, &shown, &metadata).unwrap());
    let image = RgbImage::read(&path).unwrap();
    for (found, expected) in image.pixels().iter().flatten().zip(pixels.iter().flatten()) {
        let (found, expected) = (color::linear_to_srgb(*found), color::linear_to_srgb(expected * 0.5));
        assert!((found - expected).abs() <= 0.5001 / 255.0, "{found} {expected}");
    }
    let info = png::Decoder::new(std::io::Cursor::new(&bytes)).read_info().unwrap().info().clone();
    assert!(info.srgb.is_some());
    assert_eq!(info.uncompressed_latin1_text[0].text, "nephroid");
    assert_eq!(info.utf8_text[0].get_text().unwrap(), "Tasse № 1");
}

#[test]
fn sixteen_bit_png_is_made_linear() {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 1, 1);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Sixteen);
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(&[0xff, 0xff, 0x80, 0x00, 0x00, 0x01, 0x00, 0x00]).unwrap();
    writer.finish().unwrap();
    let image = RgbImage::decode(&bytes).unwrap();
    // 32768/65535 decodes to ((0.500008 + 0.055)/1.055)^2.4; 1/65535 lies on the line.
    for (found, expected) in image.pixels()[0].iter().zip([1.0, 0.214_047, 1.181_04e-6]) {
        assert!((found - expected).abs() < 2e-5 * expected, "{found} {expected}");
    }
}

#[test]
fn refusals() {
    assert!(encode_exr(&Film::new(0, 4), &ExrOptions::default()).is_err());
    let named = |name: &str| vec![(name.to_owned(), String::new())];
    for name in ["", "a\0b", "a name of more than thirty-one bytes"] {
        assert!(encode_exr_rgb(1, 1, &[[0.0; 3]], &named(name)).is_err(), "{name}");
    }
    assert!(encode_exr_rgb(2, 1, &[[0.0; 3]], &[]).is_err());
    assert!(encode_png_bytes(2, 1, &[[0; 3]], &[]).is_err());
    assert!(encode_png_bytes(1, 1, &[[0; 3]], &named("")).is_err());
    assert!(matches!(RgbImage::decode(b"no picture"), Err(ReadErrorKind::Format(_))));
    let exr = encode_exr_rgb(64, 64, &vec![[1.0; 3]; 4096], &[]).unwrap();
    assert!(RgbImage::decode(&exr[..exr.len() / 2]).is_err());
    let missing = RgbImage::read(std::path::Path::new("no/such.exr")).unwrap_err();
    assert!(missing.to_string().contains("no/such.exr"));
}
