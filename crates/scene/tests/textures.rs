//! Textures from a description to the film's first hit.

use bsdf::BsdfKind;
use math::{Ray, Vec3};
use nephroid_scene as scene;

use scenefile::SceneDesc;
use scenefile::desc::{Camera, ColorDesc, Material, Object, Shape, Texture};

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
