//! Materials written at objects.

use math::Vec3;
use nephroid_scene as scene;
use scenefile::SceneDesc;
use scenefile::desc::{Camera, Material, MaterialRef, Object, Shape};

fn ball(radius: f32, ior: f32, flip_normals: bool) -> Object {
    let shape = Shape::Sphere { center: [0.0; 3], radius };
    let material: MaterialRef = Material::dielectric(ior).into();
    Object { flip_normals, ..Object::new(shape, material) }
}

/// A glass shell of two spheres with materials written twice: inside it is vacuum again, since the inner skin, turned
/// inside out, bounds the same glass.
#[test]
fn equal_inline_dielectrics_are_one_medium() {
    let desc = SceneDesc {
        camera: Some(Camera { position: [0.0, 0.0, 0.1], ..Camera::default() }.into()),
        objects: [ball(1.0, 1.5, false), ball(0.8, 1.5, true), ball(0.3, 1.33, false)]
            .map(Into::into)
            .to_vec(),
        ..SceneDesc::default()
    };
    let (scene, _) = scene::compile(&desc).unwrap();
    assert_eq!(scene.materials().len(), 2);
    let ior_at = |p: Vec3| {
        let mut desc = desc.clone();
        desc.camera = Some(Camera { position: p.to_array(), look_at: [9.0; 3], ..Camera::default() }.into());
        scene::compile(&desc).unwrap().0.camera_medium(Vec3::ZERO).ior()
    };
    assert_eq!(ior_at(Vec3::X * 0.1), 1.33);
    assert_eq!(ior_at(Vec3::X * 0.5), 1.0);
    assert_eq!(ior_at(Vec3::X * 0.9), 1.5);
    assert_eq!(ior_at(Vec3::X * 1.5), 1.0);
}
