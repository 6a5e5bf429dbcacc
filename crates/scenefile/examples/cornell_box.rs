//! A Cornell box with a glass sphere, described in code and written as a scene file.
#![allow(clippy::print_stdout)] // an example shows its result

use nephroid_scenefile::SceneDesc;
use nephroid_scenefile::desc::{Camera, Emission, Material, Object, Shape};

fn wall(origin: [f32; 3], edge_u: [f32; 3], edge_v: [f32; 3], material: &str) -> Object {
    Object::new(Shape::Quad { origin, edge_u, edge_v }, material)
}

fn main() {
    let mut scene = SceneDesc::default();
    let camera =
        Camera { position: [0.0, 1.0, 3.9], look_at: [0.0, 1.0, 0.0], fov: 40.0, ..Camera::default() };
    scene.camera = Some(camera.into());
    for (name, color) in
        [("white", [0.73, 0.71, 0.68]), ("red", [0.63, 0.06, 0.05]), ("green", [0.14, 0.45, 0.09])]
    {
        scene.materials.insert(name.into(), Material::diffuse(color).into());
    }
    let lamp = Shape::Quad { origin: [-0.3, 1.98, -0.3], edge_u: [0.6, 0.0, 0.0], edge_v: [0.0, 0.0, 0.6] };
    let ball = Shape::Sphere { center: [0.3, 0.4, 0.3], radius: 0.4 };
    let (x, y, z) = ([2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0]);
    for object in [
        wall([-1.0, 0.0, -1.0], z, x, "white"),
        wall([-1.0, 2.0, -1.0], x, z, "white"),
        wall([-1.0, 0.0, -1.0], x, y, "white"),
        wall([-1.0, 0.0, -1.0], y, z, "red"),
        wall([1.0, 0.0, -1.0], z, y, "green"),
        Object::new(ball, Material::dielectric(1.5)),
        Object::lamp(lamp, Emission::radiance([17.0, 12.0, 4.0])),
    ] {
        scene.objects.push(object.into());
    }
    assert!(nephroid_scenefile::check(&scene).is_empty());
    println!("{}", nephroid_scenefile::to_toml(&scene));
}
