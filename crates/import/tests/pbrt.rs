//! What pbrt scenes become. Expected values follow from the format's pages and are worked out beside each.
#![allow(clippy::unwrap_used, reason = "helpers of tests, too")]

use std::io::Write;
use std::path::Path;

use nephroid_import::{load, strict};
use scenefile::desc::{
    CameraKind, ColorDesc, EmissionAmount, FovAxis, IntegratorKind, LightKind, Mapping, MaterialKind,
    MaterialRef, Metal, Object, PointAmount, Roughness, SceneDesc, Shape, Texture, TransformStep,
};
use scenefile::{Loaded, Severity};

/// A camera that swaps no hands, so that nothing is mirrored.
const HEAD: &str = "Scale -1 1 1\nCamera \"perspective\"\nWorldBegin\nLightSource \"point\"\n";
const TRIANGLE: &str = "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0]\n";

fn read_in(folder: &Path, text: &str) -> Loaded {
    let path = folder.join("scene.pbrt");
    std::fs::write(&path, text).unwrap();
    load(&path, &[])
}

fn read(text: &str) -> Loaded {
    read_in(tempfile::tempdir().unwrap().path(), text)
}

/// The description of a text that gives no diagnostic.
fn desc(text: &str) -> SceneDesc {
    let loaded = read(text);
    assert!(loaded.diagnostics.is_empty(), "{}", loaded.render());
    loaded.desc.unwrap()
}

/// With the head before it.
fn world(text: &str) -> SceneDesc {
    desc(&format!("{HEAD}{text}"))
}

/// A description and the messages of its warnings.
fn warned(text: &str) -> (SceneDesc, Vec<String>) {
    let loaded = read(&format!("{HEAD}{text}"));
    assert!(loaded.diagnostics.iter().all(|d| d.severity == Severity::Warning), "{}", loaded.render());
    assert!(loaded.diagnostics.iter().all(|d| !d.labels.is_empty()), "each has a place");
    (loaded.desc.unwrap(), loaded.diagnostics.into_iter().map(|d| d.message).collect())
}

fn close(a: impl IntoIterator<Item = f32>, b: impl IntoIterator<Item = f32>) {
    let (a, b): (Vec<_>, Vec<_>) = (a.into_iter().collect(), b.into_iter().collect());
    let near = |(x, y): (&f32, &f32)| (x - y).abs() <= 1e-5 * (1.0 + y.abs());
    assert!(a.len() == b.len() && a.iter().zip(&b).all(near), "{a:?} {b:?}");
}

fn matrix(object: &Object) -> [f32; 16] {
    match object.transform[..] {
        [] => std::array::from_fn(|i| if i % 5 == 0 { 1.0 } else { 0.0 }),
        [TransformStep::Matrix(m)] => m,
        _ => panic!("{:?}", object.transform),
    }
}

fn kind<'a>(desc: &'a SceneDesc, object: &Object) -> &'a MaterialKind {
    match &object.material {
        Some(MaterialRef::Named(name)) => &desc.materials[&name.value].kind,
        other => panic!("{other:?}"),
    }
}

fn material(text: &str) -> MaterialKind {
    let desc = world(&format!("{text}\n{TRIANGLE}"));
    kind(&desc, &desc.objects[0]).clone()
}

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
    let sppm = desc(&format!("{sppm}{HEAD}{TRIANGLE}"));
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
fn lights() {
    let text = "LightSource \"point\" \"rgb I\" [1 2 3] \"float scale\" 2 \"point3 from\" [1 1 1]\n\
                LightSource \"point\" \"float power\" 12.566371\n\
                LightSource \"spot\" \"float coneangle\" 40 \"float conedeltaangle\" 10 \"point3 to\" [0 -1 0]\n\
                LightSource \"distant\" \"rgb L\" [2 2 2] \"point3 from\" [0 3 0] \"point3 to\" [0 0 0] \"float illuminance\" 5\n\
                LightSource \"infinite\" \"rgb L\" [.5 .25 0] \"float scale\" 4\n\
                LightSource \"infinite\" \"float illuminance\" 3.1415927\n\
                LightSource \"point\" \"blackbody I\" 6504\n\
                LightSource \"point\" \"spectrum I\" [300 7 900 7]\n";
    let desc = world(&format!("{text}{TRIANGLE}"));
    let kinds: Vec<LightKind> = desc.lights.iter().skip(1).map(|l| l.kind.clone()).collect();
    let intensity = |kind: &LightKind| match kind {
        LightKind::Point { amount: PointAmount::Intensity(i), .. }
        | LightKind::Spot { amount: PointAmount::Intensity(i), .. } => *i,
        other => panic!("{other:?}"),
    };
    close(intensity(&kinds[0]), [2.0, 4.0, 6.0]);
    close(intensity(&kinds[1]), [1.0; 3]);
    let LightKind::Spot { direction, cone_angle, falloff_angle, .. } = kinds[2] else { panic!() };
    assert_eq!((direction, cone_angle, falloff_angle), ([0.0, -1.0, 0.0], 40.0, 10.0));
    let LightKind::Directional { direction, irradiance } = kinds[3] else { panic!() };
    assert_eq!((direction, irradiance), ([0.0, -3.0, 0.0], [10.0; 3]));
    assert_eq!(kinds[4], LightKind::Environment { radiance: [2.0, 1.0, 0.0] });
    let LightKind::Environment { radiance } = kinds[5] else { panic!() };
    close(radiance, [1.0; 3]);
    // Of luminance 1, whatever their size: near white, and warmer than D65 as equal energy is.
    for (kind, red) in [(&kinds[6], 0.9..1.1), (&kinds[7], 1.15..1.25)] {
        let rgb = intensity(kind);
        let luminance = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
        assert!((luminance - 1.0).abs() < 1e-4 && red.contains(&rgb[0]), "{rgb:?}");
    }
}

#[test]
fn area_lights_and_the_film() {
    let head = "Film \"rgb\" \"float iso\" 200 \"float exposuretime\" .25\n";
    let text = "AreaLightSource \"diffuse\" \"rgb L\" [4 2 0] \"bool twosided\" true\nShape \"sphere\"\n\
                AreaLightSource \"diffuse\" \"rgb L\" [1 1 .4] \"float power\" 30\nShape \"disk\"\n\
                AreaLightSource \"diffuse\" \"rgb L\" [0 0 0]\nShape \"disk\"\n";
    let desc = desc(&format!("{head}{HEAD}{text}"));
    let emission: Vec<_> = desc.objects.iter().map(|o| o.emission.as_deref()).collect();
    let first = emission[0].unwrap();
    assert!(first.two_sided);
    // Half as bright: 0.25 s at twice the speed.
    assert_eq!(first.amount, EmissionAmount::Radiance([2.0, 1.0, 0.0]));
    // 30 for white is 30, 30, 12 W here, halved: 12 W in the mean.
    let EmissionAmount::Power { watts, color } = emission[1].unwrap().amount else { panic!() };
    close([watts, color[0], color[2]], [12.0, 1.25, 0.5]);
    assert!(emission[2].is_none());
}

#[test]
fn materials_of_version_4() {
    assert_eq!(material("Material \"diffuse\""), MaterialKind::Diffuse { color: 0.5.into() });
    assert_eq!(
        material(
            "MakeNamedMaterial \"m\" \"string type\" \"diffuse\" \"rgb reflectance\" [.1 .2 .3]\nNamedMaterial \"m\""
        ),
        MaterialKind::Diffuse { color: [0.1, 0.2, 0.3].into() }
    );
    let alpha = |r: &Roughness| match r {
        Roughness::Alpha { along, across } => [along.clone(), across.clone()],
        other => panic!("{other:?}"),
    };
    let MaterialKind::Conductor(c) = material(
        "Material \"conductor\" \"float roughness\" .04 \"spectrum eta\" \"metal-Au-eta\" \"spectrum k\" \"metal-Au-k\"",
    ) else {
        panic!()
    };
    assert_eq!(c.metal, Metal::Named("Au".into()));
    assert_eq!(alpha(&c.roughness), [0.2.into(), 0.2.into()], "α = √0.04");
    let text = "Material \"conductor\" \"rgb eta\" [1 2 3] \"rgb k\" [4 5 6] \"float uroughness\" .3 \"float vroughness\" .1 \"bool remaproughness\" false";
    let MaterialKind::Conductor(c) = material(text) else { panic!() };
    assert_eq!(c.metal, Metal::Index { n: [1.0, 2.0, 3.0], k: [4.0, 5.0, 6.0] });
    assert_eq!(alpha(&c.roughness), [0.3.into(), 0.1.into()]);
    let MaterialKind::Conductor(c) = material("Material \"conductor\" \"rgb reflectance\" [.25 .5 .75]")
    else {
        panic!()
    };
    let Metal::Index { n, k } = c.metal else { panic!() };
    // ((n − 1)² + k²)/((n + 1)² + k²) gives the reflectance back.
    close([0, 1, 2].map(|i| k[i] * k[i] / ((n[i] + 1.0).powi(2) + k[i] * k[i])), [0.25, 0.5, 0.75]);
    let MaterialKind::Dielectric(d) = material("Material \"dielectric\" \"spectrum eta\" \"glass-BK7\"")
    else {
        panic!()
    };
    assert!(matches!(d.ior, scenefile::desc::Ior::Value(n) if (n - 1.5168).abs() < 1e-4));
    assert!(matches!(material("Material \"thindielectric\""), MaterialKind::ThinDielectric(_)));
    assert!(matches!(
        material("Material \"coateddiffuse\" \"float thickness\" .02"),
        MaterialKind::CoatedDiffuse(_)
    ));
    assert!(matches!(
        material("Material \"coatedconductor\" \"float conductor.roughness\" .1"),
        MaterialKind::CoatedConductor(_)
    ));
    let MaterialKind::DiffuseTransmission { reflectance, .. } =
        material("Material \"diffusetransmission\" \"rgb reflectance\" [.2 .2 .2] \"float scale\" 2")
    else {
        panic!()
    };
    assert_eq!(reflectance, ColorDesc::Rgb([0.4; 3]));
    let text = "MakeNamedMaterial \"a\" \"string type\" \"diffuse\"\nMakeNamedMaterial \"b\" \"string type\" \"thindielectric\"\n\
                Material \"mix\" \"string materials\" [\"a\" \"b\"] \"float amount\"";
    let MaterialKind::Mix { a, b, amount } = material(&format!("{text} .25")) else { panic!() };
    assert_eq!((a, b, amount), ("a".into(), "b".into(), 0.25.into()));
    assert!(matches!(material(&format!("{text} 1")), MaterialKind::ThinDielectric(_)));
    // A surface that only bounds a medium is not there.
    assert!(
        world(&format!("Material \"interface\"\n{TRIANGLE}Material \"diffuse\"\n{TRIANGLE}")).objects.len()
            == 1
    );
}

#[test]
fn materials_of_version_3() {
    assert_eq!(
        material("Material \"matte\" \"color Kd\" [.1 .2 .3]"),
        MaterialKind::Diffuse { color: [0.1, 0.2, 0.3].into() }
    );
    assert_eq!(material("Material \"mirror\""), MaterialKind::Mirror { color: 0.9.into() });
    let MaterialKind::Dielectric(d) = material("Material \"glass\" \"float index\" 1.33") else { panic!() };
    assert_eq!(d.ior, 1.33.into());
    // With x = ln 0.01 its remapping gives 1.6214 − 3.7760 + 3.6775 − 1.6721 + 0.2882 = 0.1390.
    let MaterialKind::Conductor(c) = material("Material \"metal\" \"float roughness\" .01") else { panic!() };
    let Roughness::Alpha { along: scenefile::desc::FloatDesc::Value(a), .. } = c.roughness else { panic!() };
    assert!((a - 0.1390).abs() < 2e-4, "{a}");
    let (desc, warnings) = warned(&format!("Material \"substrate\" \"rgb Ks\" [.04 .04 .04]\n{TRIANGLE}"));
    let MaterialKind::CoatedDiffuse(c) = kind(&desc, &desc.objects[0]) else { panic!() };
    assert_eq!(warnings.len(), 1);
    assert!(
        matches!(c.ior, scenefile::desc::Ior::Value(n) if (n - 1.5).abs() < 1e-3),
        "0.04 is the glance of 1.5"
    );
}

#[test]
fn textures() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("maps")).unwrap();
    std::fs::write(folder.path().join("maps/a.png"), "").unwrap();
    let text = "Texture \"grey\" \"float\" \"constant\" \"float value\" .25\n\
                Texture \"red\" \"spectrum\" \"constant\" \"rgb value\" [1 .5 .5]\n\
                Texture \"dim\" \"spectrum\" \"scale\" \"texture tex\" \"red\" \"rgb scale\" [.5 .5 .5]\n\
                Texture \"board\" \"spectrum\" \"checkerboard\" \"float uscale\" 8 \"float vscale\" 4 \"texture tex1\" \"dim\"\n\
                Texture \"map\" \"spectrum\" \"imagemap\" \"string filename\" \"maps/a.png\" \"string wrap\" \"clamp\"\n\
                Material \"diffuse\" \"texture reflectance\" \"board\"\nShape \"sphere\"\n\
                Material \"diffuse\" \"texture reflectance\" \"map\"\nShape \"sphere\"\n\
                Material \"conductor\" \"texture roughness\" \"grey\" \"bool remaproughness\" false\nShape \"sphere\"\n";
    let loaded = read_in(folder.path(), &format!("{HEAD}{text}"));
    assert!(loaded.diagnostics.is_empty(), "{}", loaded.render());
    let desc = loaded.desc.unwrap();
    // pbrt's squares have side 1 in scaled coordinates.
    let Texture::Checker { a, b, mapping } = &desc.textures["board"].value else { panic!() };
    assert_eq!((a, b), (&ColorDesc::Rgb([0.5, 0.25, 0.25]), &ColorDesc::Rgb([0.0; 3])));
    assert_eq!(*mapping, Mapping::scaled([4.0, 2.0]));
    let Texture::Image(image) = &desc.textures["map"].value else { panic!() };
    assert_eq!(image.source.file().unwrap().value, Path::new("maps/a.png"));
    assert!(
        matches!(kind(&desc, &desc.objects[2]), MaterialKind::Conductor(c) if c.roughness == Roughness::alpha(0.25))
    );
}

#[test]
fn shapes() {
    let text = "Shape \"sphere\" \"float radius\" 2\nShape \"sphere\" \"float zmax\" 0\nShape \"disk\" \"float height\" 3\n\
                Shape \"cylinder\"\nShape \"bilinearmesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 0]\n\
                Shape \"loopsubdiv\" \"integer levels\" 1 \"point3 P\" [0 0 0 1 0 0 0 1 0] \"integer indices\" [0 1 2]\n\
                Shape \"curve\" \"string type\" \"cylinder\" \"point3 P\" [0 0 0 0 0 1 0 0 2 0 0 3] \"float width\" .1\n\
                Shape \"trianglemesh\" \"integer indices\" [0 1 2 2 1 3] \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 0]\n\
                \"normal N\" [0 0 -1 0 0 -1 0 0 -1 0 0 -1]\n";
    let desc = world(text);
    let shapes: Vec<&Shape> = desc.objects.iter().map(|o| &o.shape.value).collect();
    assert_eq!(shapes[0], &Shape::Sphere { center: [0.0; 3], radius: 2.0 });
    assert_eq!(shapes[2], &Shape::Disk { center: [0.0, 0.0, 3.0], normal: [0.0, 0.0, 1.0], radius: 1.0 });
    let triangles = |shape: &Shape| match shape {
        Shape::Triangles { indices, .. } => indices.clone(),
        other => panic!("{other:?}"),
    };
    assert!(matches!(shapes[1], Shape::Triangles { positions, .. } if positions.iter().all(|p| p[2] < 1e-6)));
    assert_eq!([4, 5].map(|i| triangles(shapes[i]).len()), [2, 4]);
    assert!(triangles(shapes[3]).len() > 100 && triangles(shapes[6]).len() > 100);
    // Faces turn to the side of their normals, as in pbrt.
    assert_eq!(triangles(shapes[7]), [[0, 2, 1], [2, 3, 1]]);
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
         LightSource \"infinite\" \"string filename\" \"sky.exr\"\nShape \"sphere\" \"float alpha\" 0.5\n\
         Material \"hair\"\nShape \"sphere\" \"float alpha\" 0.25\nMaterial \"hair\"\n\
         Shape \"sphere\" \"float raduis\" 2\n{TRIANGLE}"
    );
    let (_, warnings) = warned(&text);
    let begins = [
        "participating media are not rendered",
        "the image of an infinite light is not rendered",
        "the opacity of shapes is not rendered",
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
