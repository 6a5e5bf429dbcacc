//! Textures from a description to the film's first hit.
#![allow(clippy::unwrap_used)] // a test may

use bsdf::BsdfKind;
use math::{Ray, Vec3};
use nephroid_scene as scene;

use scenefile::SceneDesc;
use scenefile::desc::{
    Camera, Channel, ColorDesc, EmbeddedImage, FloatDesc, Group, Image, ImageSource, Instance, Mapping,
    Material, Object, Shape, Texture, TextureFilter, TransformStep,
};

/// The albedo that a ray from above meets at (x, z) on the unit square.
fn albedo(desc: &SceneDesc, x: f32, z: f32) -> [f32; 3] {
    let (scene, _) = scene::compile(desc).expect("a sound scene");
    let hit = scene.intersect(&Ray::new(Vec3::new(x, 1.0, z), -Vec3::Y)).expect("the square lies below");
    match *scene.bsdf(&hit, Vec3::Y, 1.0, 0.0).kind() {
        BsdfKind::Diffuse { albedo } => albedo.to_rgb(),
        _ => panic!("not diffuse"),
    }
}

fn square(texture: &str) -> SceneDesc {
    let mut desc = SceneDesc { camera: Some(Camera::default().into()), ..SceneDesc::default() };
    // u along x, v along −z, front up.
    let quad = Shape::Quad { origin: [0.0, 0.0, 0.0], edge_u: [1.0, 0.0, 0.0], edge_v: [0.0, 0.0, -1.0] };
    desc.materials.insert("m".into(), Material::diffuse(ColorDesc::texture(texture)).into());
    desc.objects.push(Object::new(quad, "m").into());
    desc
}

#[test]
fn a_checker_has_one_period_a_unit() {
    let mut desc = square("tiles");
    desc.textures.insert("tiles".into(), Texture::checker(0.2, 0.8, [2.0, 1.0]).into());
    // Squares are 1/4 wide and 1/2 high.
    assert_eq!(albedo(&desc, 0.1, -0.1), [0.2; 3]);
    assert_eq!(albedo(&desc, 0.3, -0.1), [0.8; 3]);
    assert_eq!(albedo(&desc, 0.6, -0.1), [0.2; 3]);
    assert_eq!(albedo(&desc, 0.1, -0.6), [0.8; 3]);
}

#[test]
fn checkers_hold_textures() {
    let mut desc = square("outer");
    desc.textures.insert("inner".into(), Texture::checker(0.2, 0.8, [4.0, 4.0]).into());
    let outer = Texture::checker(ColorDesc::texture("inner"), 0.5, [1.0, 1.0]);
    desc.textures.insert("outer".into(), outer.into());
    assert_eq!(albedo(&desc, 0.06, -0.06), [0.2; 3]);
    assert_eq!(albedo(&desc, 0.18, -0.06), [0.8; 3]);
    assert_eq!(albedo(&desc, 0.6, -0.1), [0.5; 3]);
}

#[test]
fn a_checker_of_itself_is_refused() {
    let mut desc = square("loop");
    let texture = Texture::checker(ColorDesc::texture("loop"), 0.5, [1.0, 1.0]);
    desc.textures.insert("loop".into(), texture.into());
    let errors = scene::compile(&desc).unwrap_err();
    assert!(errors.iter().any(|d| d.code == "texture-cycle"), "{errors:?}");
}

/// A triangle of everything: corners at the origin, 2 along x and 2 along −z, front up.
fn painted() -> Shape {
    Shape::Triangles {
        positions: vec![[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 0.0, -2.0]],
        indices: vec![[0, 1, 2]],
        vertex_normals: vec![],
        uvs: vec![[0.0, 0.0], [2.0, 0.0], [0.0, 2.0]],
        uvs2: vec![[0.5, 0.5], [0.5, 0.5], [0.5, 2.5]],
        colors: vec![[1.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 0.5], [0.0, 0.0, 1.0, 0.0]],
        normals: Default::default(),
    }
}

fn with_shape(shape: Shape, texture: Texture) -> SceneDesc {
    let mut desc = square("t");
    desc.objects[0].value.shape = shape.into();
    desc.textures.insert("t".into(), texture.into());
    desc
}

/// The same as an instance of a group, moved, turned and stretched, and the transform's inverse for points looked at.
fn instanced(desc: &SceneDesc) -> SceneDesc {
    let mut placed = desc.clone();
    let object = placed.objects.pop().unwrap();
    // An object and an instance before it, so that numbers count.
    let far = Shape::Sphere { center: [90.0, 0.0, 0.0], radius: 1.0 };
    placed.objects.push(Object::new(far.clone(), "m").into());
    let other = Object::new(far, "m").into();
    placed.groups.insert("g".into(), Group { objects: vec![other, object] }.into());
    for x in [0.0, 10.0] {
        let transform = vec![TransformStep::Scale([3.0, 1.0, 2.0]), TransformStep::Translate([x, 0.0, 0.0])];
        let instance = Instance { name: None, group: "g".into(), transform, material: None };
        placed.instances.push(instance.into());
    }
    placed
}

fn near(a: [f32; 3], b: [f32; 3]) {
    assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-5), "{a:?} {b:?}");
}

#[test]
fn vertex_colours_are_interpolated() {
    let texture = |channel| Texture::VertexColor { channel };
    let desc = with_shape(painted(), texture(Channel::Rgb));
    // Shares 1/2, 1/4, 1/4.
    near(albedo(&desc, 0.5, -0.5), [0.5, 0.25, 0.25]);
    near(albedo(&desc, 1.5, -0.25), [0.125, 0.75, 0.125]);
    near(albedo(&with_shape(painted(), texture(Channel::Green)), 1.5, -0.25), [0.75; 3]);
    near(albedo(&with_shape(painted(), texture(Channel::Alpha)), 0.5, -0.5), [0.625; 3]);
    let placed = instanced(&desc);
    near(albedo(&placed, 1.5, -1.0), [0.5, 0.25, 0.25]);
    near(albedo(&placed, 11.5, -1.0), [0.5, 0.25, 0.25]);
    // A mesh without colours is white.
    let plain = with_shape(
        Shape::Quad { origin: [0.0; 3], edge_u: [1.0, 0.0, 0.0], edge_v: [0.0, 0.0, -1.0] },
        texture(Channel::Rgb),
    );
    assert_eq!(albedo(&plain, 0.5, -0.5), [1.0; 3]);
}

#[test]
fn second_coordinates_are_their_own() {
    let texture = |set, shape| {
        let mapping = Mapping::Uv { set, scale: [1.0; 2], rotation: 0.0, offset: [0.0; 2] };
        with_shape(shape, Texture::Checker { a: 0.2.into(), b: 0.8.into(), mapping })
    };
    // uv (0.25, 0.1) and (0.25, 0.6); uv2 (0.5, 0.6) and (0.5, 1.1).
    for (z, first, second) in [(-0.1, 0.2, 0.2), (-0.6, 0.8, 0.8)] {
        near(albedo(&texture(0, painted()), 0.25, z), [first; 3]);
        near(albedo(&texture(1, painted()), 0.25, z), [second; 3]);
    }
    // Along x the first changes, the second does not.
    near(albedo(&texture(0, painted()), 0.75, -0.1), [0.8; 3]);
    near(albedo(&texture(1, painted()), 0.75, -0.1), [0.2; 3]);
    near(albedo(&instanced(&texture(1, painted())), 10.0 + 3.0 * 0.75, -0.2), [0.2; 3]);
    near(albedo(&instanced(&texture(1, painted())), 10.0 + 3.0 * 0.75, -1.2), [0.8; 3]);
    // Where there is no second set the first stands in.
    let quad = Shape::Quad { origin: [0.0; 3], edge_u: [1.0, 0.0, 0.0], edge_v: [0.0, 0.0, -1.0] };
    near(albedo(&texture(1, quad), 0.75, -0.1), [0.8; 3]);
}

#[test]
fn planar_textures_lie_in_the_world() {
    let mapping = Mapping::Planar { u: [0.5, 0.0, 0.0], v: [0.0, 0.0, 1.0], offset: [0.0; 2] };
    let desc = with_shape(painted(), Texture::Checker { a: 0.2.into(), b: 0.8.into(), mapping });
    // Squares 1 wide in x, 0.5 in z.
    for (x, z, expected) in [(0.5, -0.25, 0.8), (0.5, -0.75, 0.2), (1.5, -0.25, 0.2)] {
        near(albedo(&desc, x, z), [expected; 3]);
        near(albedo(&instanced(&desc), x, z), [expected; 3]);
    }
}

fn embedded(name: &str, texels: &[[u8; 4]], width: u32) -> Image {
    let height = texels.len() as u32 / width;
    let image =
        image::ImageBuffer::from_fn(width, height, |x, y| image::Rgba(texels[(y * width + x) as usize]));
    let mut bytes = std::io::Cursor::new(Vec::new());
    image.write_to(&mut bytes, image::ImageFormat::Png).unwrap();
    let bytes = bytes.into_inner().into();
    Image::new(ImageSource::Embedded(EmbeddedImage { name: name.into(), bytes }))
}

#[test]
fn pictures_in_memory_are_shared_and_decoded_as_each_use_says() {
    let picture = embedded("p.png", &[[255, 0, 128, 0], [255, 0, 128, 255]], 2);
    let mut desc = square("color");
    let add = |desc: &mut SceneDesc, name: &str, image: Image| {
        desc.textures.insert(name.into(), Texture::Image(image).into());
    };
    let nearest = |channel| Image { channel, filter: TextureFilter::Nearest, ..picture.clone() };
    add(&mut desc, "color", nearest(Channel::Rgb));
    add(&mut desc, "alpha", nearest(Channel::Alpha));
    add(&mut desc, "half", Image { factor: [0.5; 3], invert: true, ..nearest(Channel::Blue) });
    near(albedo(&desc, 0.2, -0.5), [1.0, 0.0, 0.215_861]);
    let blue = |x| {
        let mut other = desc.clone();
        other.materials.insert("m".into(), Material::diffuse(ColorDesc::texture("half")).into());
        albedo(&other, x, -0.5)
    };
    near(blue(0.2), [0.5 * (1.0 - 0.215_861); 3]);
    // Opacity, of the same picture: the left half is not there.
    let cut =
        Material { opacity: FloatDesc::texture("alpha"), ..Material::diffuse(ColorDesc::texture("color")) };
    desc.materials.insert("m".into(), cut.into());
    let (scene, _) = scene::compile(&desc).unwrap();
    let down = |x| scene.intersect(&Ray::new(Vec3::new(x, 1.0, -0.5), -Vec3::Y));
    assert!(down(0.2).is_none() && down(0.8).is_some());
    assert!(!scene.occluded(&Ray::new(Vec3::new(0.2, 1.0, -0.5), -Vec3::Y)));
    // Two texels of four bytes and one smaller of them, once.
    assert_eq!(scene.summary().texture_bytes, 12);
}

#[test]
fn broken_pictures_are_told_by_name() {
    let image =
        Image::new(ImageSource::Embedded(EmbeddedImage { name: "wood.png".into(), bytes: [1, 2, 3].into() }));
    let mut desc = square("t");
    desc.textures.insert("t".into(), Texture::Image(image).into());
    let errors = scene::compile(&desc).unwrap_err();
    assert!(errors.iter().any(|d| d.code == "bad-image" && d.message.contains("wood.png")), "{errors:?}");
}

#[test]
fn textures_of_textures_of_textures_are_refused_before_they_take_all_day() {
    let mut desc = square("t20");
    desc.textures.insert("t0".into(), Texture::checker(1.0, 0.999, [1.0; 2]).into());
    for i in 1..=20 {
        let part = ColorDesc::texture(format!("t{}", i - 1));
        let product = Texture::Product { a: part.clone(), b: part };
        desc.textures.insert(format!("t{i}"), product.into());
    }
    let errors = scene::compile(&desc).unwrap_err();
    assert!(errors.iter().any(|d| d.code == "too-large"), "{errors:?}");
    // Ten of them are a thousand lookups.
    desc.materials.insert("m".into(), Material::diffuse(ColorDesc::texture("t10")).into());
    (11..=20).for_each(|i| drop(desc.textures.remove(&format!("t{i}"))));
    assert!((albedo(&desc, 0.1, -0.6)[0] - 0.999f32.powi(1024)).abs() < 1e-4);
}
