//! Settings, cameras, transforms, names and files.

use super::*;

#[test]
fn settings_and_their_defaults() {
    let plain = desc(&format!("{HEAD}{TRIANGLE}"));
    assert_eq!((plain.film.size, plain.render.passes, plain.render.max_depth), ([1280, 720], 16, Some(5)));
    let text = "Film \"rgb\" \"integer xresolution\" 64 \"integer yresolution\" [32] \"string filename\" \"a.exr\"\n\
                Sampler \"stratified\" \"integer xsamples\" 3 \"integer ysamples\" 5\n\
                Integrator \"path\" \"integer maxdepth\" [ 7 ]\nPixelFilter \"box\" \"float xradius\" 0.5 \"float yradius\" 0.5\n";
    let set = desc(&format!("{text}{HEAD}{TRIANGLE}"));
    assert_eq!((set.film.size, set.render.passes, set.render.max_depth), ([64, 32], 15, Some(7)));
    assert_eq!(set.render.integrator, IntegratorKind::Auto);
    let sppm = "Integrator \"sppm\" \"integer photonsperiteration\" 5000 \"float radius\" .25\n";
    let loaded = read(&format!("{sppm}{HEAD}{TRIANGLE}"));
    let said = "the file asks for `sppm`, with a radius of 0.25 and 5000 photons a pass";
    assert!(
        loaded.render().contains(said) && loaded.render().contains("--integrator auto"),
        "{}",
        loaded.render()
    );
    assert_eq!(loaded.diagnostics.len(), 1);
    let sppm = loaded.desc.unwrap();
    assert_eq!(
        (sppm.render.integrator, sppm.sppm.photons, sppm.sppm.radius),
        (IntegratorKind::Sppm, Some(5000), Some(0.25))
    );
}

#[test]
fn cameras_show_right_on_the_right() {
    // +x of the camera is on the right; ours has forward × up there.
    let right = |desc: &SceneDesc| {
        let c = desc.camera.as_ref().unwrap();
        let f: [f32; 3] = std::array::from_fn(|i| c.look_at[i] - c.position[i]);
        [f[1] * c.up[2] - f[2] * c.up[1], f[2] * c.up[0] - f[0] * c.up[2], f[0] * c.up[1] - f[1] * c.up[0]]
    };
    let ball = "LightSource \"point\"\nTranslate 2 0 5\nShape \"sphere\"\n";
    let plain = desc(&format!("Camera \"perspective\" \"float fov\" 60\nWorldBegin\n{ball}"));
    // pbrt: the ball at x = +2 is on the right. The world is mirrored, and with it the ball.
    let m = matrix(&plain.objects[0]);
    assert_eq!([m[3], m[7], m[11]], [-2.0, 0.0, 5.0]);
    assert!(right(&plain)[0] < 0.0, "so it is on our right, too");
    let camera = plain.camera.as_ref().unwrap();
    assert_eq!((camera.fov, camera.fov_axis, camera.kind), (60.0, FovAxis::Smaller, CameraKind::Pinhole));
    let swapped = desc(&format!("Scale -1 1 1\nCamera \"perspective\"\nWorldBegin\n{ball}"));
    assert_eq!(matrix(&swapped.objects[0])[3], 2.0);
    assert!(right(&swapped)[0] < 0.0, "the ball is on the left in both");
    // LookAt from the side, with a lens in a world of twice the camera's size.
    let text = "Scale 0.5 0.5 0.5\nLookAt 3 4 5  3 4 9  0 1 0\nCamera \"perspective\" \"float lensradius\" .1 \"float focaldistance\" 3\n";
    let lens = desc(&format!("{text}WorldBegin\n{ball}"));
    let camera = lens.camera.as_ref().unwrap();
    close(camera.position, [-3.0, 4.0, 5.0]);
    close(camera.up, [0.0, 1.0, 0.0]);
    let CameraKind::ThinLens { lens_radius, focus_distance } = camera.kind else { panic!() };
    close([lens_radius, focus_distance.unwrap()], [0.2, 6.0]);
    // A window of half the height sees tan(fov/2)/2 up and down.
    let text = "Camera \"perspective\" \"float fov\" 90 \"float screenwindow\" [-1 1 -.5 .5]\n";
    let film = "Film \"rgb\" \"integer xresolution\" 200 \"integer yresolution\" 100\n";
    let window = desc(&format!("{film}{text}WorldBegin\n{ball}"));
    let camera = window.camera.as_ref().unwrap();
    assert_eq!(camera.fov_axis, FovAxis::Y);
    close([camera.fov], [2.0 * 0.5f32.atan().to_degrees()]);
}

#[test]
fn transforms_stack() {
    let text = "AttributeBegin Translate 1 2 3 Rotate 90 0 0 1 Scale 2 2 2\nShape \"sphere\" AttributeEnd\n\
                TransformBegin Transform [1 0 0 0 0 1 0 0 0 0 1 0 5 6 7 1] CoordinateSystem \"here\" TransformEnd\n\
                Shape \"sphere\" CoordSysTransform \"here\" ReverseOrientation\nShape \"sphere\"\n\
                ConcatTransform [0 1 0 0 -1 0 0 0 0 0 1 0 0 0 0 1]\nShape \"sphere\"\n";
    let desc = world(text);
    let rows: Vec<[f32; 16]> = desc.objects.iter().map(|o| matrix(o)).collect();
    // First scaled, then turned: x goes to y.
    close(rows[0], [0., -2., 0., 1., 2., 0., 0., 2., 0., 0., 2., 3., 0., 0., 0., 1.]);
    assert!(desc.objects[1].transform.is_empty());
    close(rows[2], [1., 0., 0., 5., 0., 1., 0., 6., 0., 0., 1., 7., 0., 0., 0., 1.]);
    // Column by column: x goes to y again.
    close(rows[3], [0., -1., 0., 5., 1., 0., 0., 6., 0., 0., 1., 7., 0., 0., 0., 1.]);
    assert_eq!(desc.objects.iter().map(|o| o.flip_normals).collect::<Vec<_>>(), [false, false, true, true]);
}

#[test]
fn objects_are_placed_by_both_transforms() {
    let text = "Translate 0 0 9 ObjectBegin \"thing\" Translate 1 0 0 Shape \"sphere\" ObjectEnd\n\
                ObjectInstance \"thing\" Translate 0 5 0 ObjectInstance \"thing\"\n";
    let loaded = read(&format!("Camera \"perspective\"\nWorldBegin LightSource \"point\"\n{text}"));
    let desc = loaded.desc.unwrap();
    // The transform at the object's begin counts in its shapes, and again where it is placed.
    let m = matrix(&desc.groups["thing"].objects[0]);
    assert_eq!([m[3], m[7], m[11]], [1.0, 0.0, 9.0]);
    let places: Vec<_> = desc.instances.iter().map(|i| i.transform[0]).collect();
    // The mirror acts once, outside.
    let TransformStep::Matrix(m) = places[1] else { panic!() };
    assert_eq!([m[0], m[5], m[7], m[11]], [-1.0, 1.0, 5.0, 9.0]);
}

#[test]
fn included_files_and_compressed_ones() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    std::fs::create_dir(folder.path().join("parts")).unwrap();
    write("parts/balls.pbrt", "Translate 1 0 0\nShape \"sphere\"\nInclude \"more.pbrt\"\n");
    write("parts/more.pbrt", "Shape \"disk\"\n");
    let mut packed = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    packed.write_all(b"Shape \"sphere\" \"float radius\" 7").unwrap();
    std::fs::write(folder.path().join("packed.pbrt.gz"), packed.finish().unwrap()).unwrap();
    write("glow.spd", "# lamp\n300 2\n800 2\n");
    let text = "Include \"parts/balls.pbrt\"\nInclude \"packed.pbrt.gz\"\nImport \"parts/balls.pbrt\"\nShape \"disk\"\n\
                LightSource \"infinite\" \"spectrum L\" \"glow.spd\"\n";
    let loaded = read_in(folder.path(), &format!("{HEAD}{text}"));
    assert!(loaded.diagnostics.is_empty(), "{}", loaded.render());
    let desc = loaded.desc.unwrap();
    // What is included moves what follows; what is imported does not.
    let x: Vec<f32> = desc.objects.iter().map(|o| matrix(o)[3]).collect();
    assert_eq!(x, [1.0, 1.0, 1.0, 2.0, 2.0, 1.0]);
    assert_eq!(loaded.sources.iter().count(), 6);
}

#[test]
fn attributes_give_defaults() {
    let text = "AttributeBegin Attribute \"shape\" \"float radius\" 3 Shape \"sphere\" Shape \"sphere\" \"float radius\" 2\n\
                AttributeEnd Shape \"sphere\"\nColorSpace \"rec2020\" Material \"diffuse\" \"rgb reflectance\" [.5 .5 .5] Shape \"disk\"\n";
    let desc = world(text);
    let radius = |i: usize| match desc.objects[i].shape.value {
        Shape::Sphere { radius, .. } => radius,
        _ => panic!(),
    };
    assert_eq!([radius(0), radius(1), radius(2)], [3.0, 2.0, 1.0]);
    let MaterialKind::Diffuse { color: ColorDesc::Rgb(rgb) } = kind(&desc, &desc.objects[3]) else {
        panic!()
    };
    close(*rgb, [0.5; 3]);
}

#[test]
fn what_is_not_rendered_is_said_once() {
    let text = format!(
        "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\"\nMediumInterface \"fog\" \"\"\n\
         LightSource \"infinite\" \"point3 portal\" [0 0 0 1 0 0 1 1 0 0 1 0]\nShape \"heightfield\"\n\
         Material \"hair\"\nShape \"sphere\" \"float alpha\" 0.25\nMaterial \"hair\"\n\
         Shape \"sphere\" \"float raduis\" 2\n{TRIANGLE}"
    );
    let (_, warnings) = warned(&text);
    let begins = [
        "media that scatter light are not rendered",
        "portals guide no light here",
        "the shape `heightfield` is not rendered",
        "the material `hair` is not rendered",
        "the shape `sphere` has no parameter `float raduis`",
    ];
    assert_eq!(warnings.len(), begins.len(), "{warnings:#?}");
    for (warning, begin) in warnings.iter().zip(begins) {
        assert!(warning.starts_with(begin), "{warning}");
    }
    let loaded = read(&format!("{HEAD}{text}"));
    assert!(strict(loaded.clone()).desc.is_none() && loaded.desc.is_some());
}

#[test]
fn a_description_survives_toml() {
    let text = "AttributeBegin AreaLightSource \"diffuse\" \"float power\" 3\nTranslate .1 .2 .3 Rotate 12 1 2 3\nShape \"cylinder\"\nAttributeEnd\n\
                Material \"conductor\" \"float roughness\" .3\nObjectBegin \"x y\" Shape \"sphere\" ObjectEnd ObjectInstance \"x y\"\n\
                Material \"diffusetransmission\"\nShape \"disk\"\n";
    let first = desc(&format!("Film \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 9\nLookAt 1 2 3 0 0 0 0 1 0\n{HEAD}{text}")
        .replace("Scale -1 1 1\n", ""));
    let again = scenefile::parse(&scenefile::to_toml(&first), &first.base.join("a.toml"), &[]);
    assert!(again.diagnostics.is_empty(), "{}", again.render());
    assert_eq!(again.desc.unwrap(), first);
}
