//! Lights that shine in pictures.

use scenefile::desc::SkyMapping;

use super::*;

/// A folder with a picture `square.png` and one twice as wide, `oblong.png`.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    image::RgbImage::new(4, 4).save(folder.path().join("square.png")).unwrap();
    image::RgbImage::new(8, 4).save(folder.path().join("oblong.png")).unwrap();
    folder
}

/// The description and the messages of its warnings.
fn lit(text: &str) -> (SceneDesc, Vec<String>) {
    let folder = folder();
    let loaded = read_in(folder.path(), text);
    let messages = loaded.diagnostics.iter().map(|d| d.message.clone()).collect();
    (loaded.desc.clone().unwrap_or_else(|| panic!("{}", loaded.render())), messages)
}

/// What the transform makes of a direction.
fn turned(steps: &[TransformStep], v: [f32; 3]) -> [f32; 3] {
    let m: [f32; 16] = match steps {
        [] => return v,
        [TransformStep::Matrix(m)] => *m,
        other => panic!("{other:?}"),
    };
    std::array::from_fn(|r| (0..3).map(|c| m[4 * r + c] * v[c]).sum())
}

#[test]
fn skies() {
    // The world is mirrored: pbrt's x is our −x. The picture's axes are those of the light.
    let text = "Camera \"perspective\"\nWorldBegin\nRotate 90 0 0 1\nLightSource \"infinite\" \"string filename\" \"square.png\" \"float scale\" 3\n";
    let (desc, warnings) = lit(&format!("{text}{TRIANGLE}"));
    assert!(warnings.is_empty(), "{warnings:?}");
    let LightKind::Sky { mapping: SkyMapping::EqualArea, scale, transform, .. } = &desc.lights[0].kind else {
        panic!("{:?}", desc.lights[0])
    };
    assert_eq!(*scale, [3.0; 3]);
    close(turned(transform, [1.0, 0.0, 0.0]), [0.0, 1.0, 0.0]);
    close(turned(transform, [0.0, 1.0, 0.0]), [1.0, 0.0, 0.0]);
    close(turned(transform, [0.0, 0.0, 1.0]), [0.0, 0.0, 1.0]);
    // Version 3: u = 0 and the middle row are +x, u = 1/4 is +y, the top +z. Ours: −z, +x and +y.
    let old = "Scale -1 1 1\nCamera \"perspective\"\nWorldBegin\nLightSource \"infinite\" \"string mapname\" \"oblong.png\"\n";
    let said = old.replace("mapname", "filename");
    let ended = format!("{said}{TRIANGLE}WorldEnd\n");
    for (text, warns) in
        [(format!("{old}{TRIANGLE}"), false), (ended, false), (format!("{said}{TRIANGLE}"), true)]
    {
        let (desc, warnings) = lit(&text);
        let said = warnings.iter().any(|w| w.contains("longitudes"));
        assert_eq!((said, warnings.len()), (warns, usize::from(warns)), "{warnings:?}");
        let LightKind::Sky { mapping: SkyMapping::LatLong, transform, .. } = &desc.lights[0].kind else {
            panic!("{:?}", desc.lights[0])
        };
        close(turned(transform, [0.0, 0.0, -1.0]), [1.0, 0.0, 0.0]);
        close(turned(transform, [1.0, 0.0, 0.0]), [0.0, 1.0, 0.0]);
        close(turned(transform, [0.0, 1.0, 0.0]), [0.0, 0.0, 1.0]);
    }
}

#[test]
fn lamps_with_pictures() {
    let lights = "LightSource \"goniometric\" \"string filename\" \"square.png\" \"rgb I\" [1 2 3]\n\
                  LightSource \"goniometric\" \"float scale\" 5\n\
                  Translate 0 7 0\nLightSource \"projection\" \"string filename\" \"oblong.png\" \"float fov\" 60 \"float scale\" 2\n\
                  AreaLightSource \"diffuse\" \"string filename\" \"square.png\" \"float scale\" 4\n";
    let (desc, warnings) = lit(&format!("{HEAD}{lights}{TRIANGLE}"));
    assert!(warnings.is_empty(), "{warnings:?}");
    let LightKind::Goniometric { mapping: SkyMapping::EqualArea, intensity, transform, .. } =
        &desc.lights[1].kind
    else {
        panic!("{:?}", desc.lights[1])
    };
    assert_eq!(*intensity, [1.0, 2.0, 3.0]);
    // Its y and z change places.
    close(turned(transform, [1.0, 2.0, 3.0]), [1.0, 3.0, 2.0]);
    assert!(matches!(desc.lights[2].kind, LightKind::Point { .. }));
    let LightKind::Projector { fov, intensity, transform, .. } = &desc.lights[3].kind else { panic!() };
    assert_eq!((*fov, *intensity), (60.0, [2.0; 3]));
    // The picture's right, −x in ours, is +x; it lies upright.
    close(turned(transform, [-1.0, 1.0, 1.0]), [1.0, 1.0, 1.0]);
    let emission = desc.objects[0].emission.as_ref().unwrap();
    assert_eq!(emission.amount, EmissionAmount::Radiance([4.0; 3]));
    let texture = emission.texture.as_ref().unwrap();
    let Texture::Image(image) = &desc.textures[&texture.value].value else { panic!() };
    assert_eq!(image.source.file().unwrap().value, Path::new("square.png"));
    // The triangle has pbrt's texture coordinates.
    let Shape::Triangles { uvs, .. } = &desc.objects[0].shape.value else { panic!() };
    assert_eq!(uvs[..], [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]]);
}

#[test]
fn spectra_of_version_3_have_their_size() {
    let text = format!("{HEAD}LightSource \"point\" \"spectrum I\" [300 7 900 7]\n{TRIANGLE}");
    let luminance = |text: &str| {
        let (desc, _) = lit(text);
        let LightKind::Point { amount: PointAmount::Intensity(rgb), .. } = desc.lights[1].kind else {
            panic!()
        };
        0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]
    };
    close([luminance(&text)], [1.0]);
    close([luminance(&format!("{text}WorldEnd\n"))], [7.0]);
}

#[test]
fn a_balanced_white() {
    let film = "Film \"rgb\" \"float whitebalance\" 3000\n";
    let (desc, warnings) =
        lit(&format!("{film}{HEAD}LightSource \"point\" \"blackbody I\" 3000\n{TRIANGLE}"));
    assert!(warnings.len() == 1 && warnings[0].contains("white balance"), "{warnings:?}");
    let LightKind::Point { amount: PointAmount::Intensity(rgb), .. } = desc.lights[1].kind else { panic!() };
    assert!(rgb.iter().all(|c| (c - 1.0).abs() < 2e-3), "{rgb:?}");
}
