//! Shapes and textures.

use super::*;

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
    // A straight and thin tube has four sides.
    assert!(triangles(shapes[3]).len() > 100 && triangles(shapes[6]).len() == 8);
    // Faces turn to the side of their normals, as in pbrt.
    assert_eq!(triangles(shapes[7]), [[0, 2, 1], [2, 3, 1]]);
}

#[test]
fn where_textures_lie() {
    let text = "Translate 1 0 0 Scale 2 2 2\n\
                Texture \"board\" \"float\" \"checkerboard\" \"string mapping\" \"planar\" \"vector3 v1\" [0 0 1] \"vector3 v2\" [1 0 0] \"float udelta\" .5\n\
                Texture \"marble\" \"spectrum\" \"marble\" \"float scale\" 4 \"integer octaves\" 3\n\
                Texture \"spots\" \"spectrum\" \"dots\" \"rgb inside\" [1 0 0] \"float uscale\" 2\n\
                Texture \"both\" \"spectrum\" \"mix\" \"texture tex1\" \"spots\" \"texture tex2\" \"marble\" \"texture amount\" \"board\"\n\
                Material \"diffuse\" \"texture reflectance\" \"both\"\nShape \"sphere\"\n";
    let desc = desc(&format!("Camera \"perspective\"\nWorldBegin\nLightSource \"point\"\n{text}"));
    let Texture::Checker { mapping: Mapping::Planar { u, v, offset }, .. } = &desc.textures["board"].value
    else {
        panic!()
    };
    // In pbrt u = z/2 + 1/2 and v = (x − 1)/2; our x is −x, and our squares are half as large.
    close(*u, [0.0, 0.0, 0.25]);
    close(*v, [-0.25, 0.0, 0.0]);
    close(*offset, [0.25, -0.25]);
    let Texture::Noise(noise) = &desc.textures["marble"].value else { panic!() };
    assert_eq!((noise.kind, noise.octaves), (NoiseKind::Marble { scale: 4.0, variation: 0.2 }, 3));
    let [TransformStep::Matrix(m)] = noise.transform[..] else { panic!() };
    assert_eq!([m[0], m[3], m[5], m[10]], [-2.0, -1.0, 2.0, 2.0]);
    let Texture::Mix { a, b, amount } = &desc.textures["both"].value else { panic!() };
    assert_eq!(
        (a, b, amount),
        (&ColorDesc::texture("spots"), &ColorDesc::texture("marble"), &FloatDesc::texture("board"))
    );
    // Dots lie by the sphere's own coordinates, which are pbrt's: it is a mesh.
    assert!(matches!(desc.objects[0].shape.value, Shape::Triangles { .. }));
}

#[test]
fn pictures_of_numbers() {
    let folder = tempfile::tempdir().unwrap();
    let save = |name: &str, alpha| {
        let image = image::RgbaImage::from_pixel(2, 2, image::Rgba([9, 9, 9, alpha]));
        image.save(folder.path().join(name)).unwrap();
    };
    save("holes.png", 7);
    save("whole.png", 255);
    let map = |name: &str, more: &str| {
        format!("Texture \"{name}\" \"float\" \"imagemap\" \"string filename\" \"{name}.png\" {more}\n")
    };
    let text = format!(
        "{}{}Shape \"sphere\" \"texture alpha\" \"holes\"\nMaterial \"diffuse\" \"texture displacement\" \"whole\"\n{TRIANGLE}",
        map("holes", "\"bool invert\" true \"string wrap\" \"black\" \"string filter\" \"point\""),
        map("whole", "\"float scale\" .5 \"bool invert\" true \"string encoding\" \"gamma 1\""),
    );
    let loaded = read_in(folder.path(), &format!("{HEAD}{text}"));
    assert!(loaded.diagnostics.is_empty(), "{}", loaded.render());
    let desc = loaded.desc.unwrap();
    let Texture::Image(holes) = &desc.textures["holes"].value else { panic!() };
    // pbrt takes alpha where there are holes, else the mean.
    assert_eq!((holes.channel, holes.invert, holes.factor), (Channel::Alpha, true, [1.0; 3]));
    assert_eq!((holes.wrap, holes.filter), ([Wrap::Black; 2], TextureFilter::Nearest));
    // 1 − x/2, between 1 and 1/2.
    let name = desc.materials["diffuse"].bump_map.as_ref().unwrap();
    let Texture::Mix { a, b, amount: FloatDesc::Texture(map) } = &desc.textures[&name.value].value else {
        panic!()
    };
    assert_eq!((a, b), (&ColorDesc::from(1.0), &ColorDesc::from(0.5)));
    let Texture::Image(whole) = &desc.textures[&map.value].value else { panic!() };
    assert_eq!((whole.channel, whole.color_space), (Channel::Rgb, ColorSpace::Linear));
}

#[test]
fn many_curves_are_one_object() {
    let curve = "Shape \"curve\" \"string type\" \"cylinder\" \"point3 P\" [0 0 0 0 0 1 0 0 2 0 0 3] \"float width\" .1\n";
    let text = format!(
        "{curve}{curve}Translate 1 0 0\n{curve}{curve}Material \"conductor\"\n{curve}{TRIANGLE}{curve}"
    );
    let triangles: Vec<usize> = world(&text)
        .objects
        .iter()
        .map(|o| match &o.shape.value {
            Shape::Triangles { indices, positions, .. } => {
                assert!(indices.iter().flatten().all(|v| (*v as usize) < positions.len()));
                indices.len()
            }
            other => panic!("{other:?}"),
        })
        .collect();
    assert_eq!(triangles, [16, 16, 8, 1, 8]);
}
