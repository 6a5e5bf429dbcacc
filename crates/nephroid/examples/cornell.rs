//! A Cornell box with a metal and a glass sphere, built in code: writes cornell.png and cornell.exr.

use std::path::Path;

use nephroid::desc::{Camera, Emission, Material, Object, Shape};
use nephroid::{Control, Job, Output, PictureInfo, SceneDesc, Session, compile, scene_hash};

/// A rectangle of the box, which has its middle at the origin and reaches from -1 to 1.
fn quad(origin: [f32; 3], edge_u: [f32; 3], edge_v: [f32; 3]) -> Shape {
    Shape::Quad { origin, edge_u, edge_v }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (white, red, green) = ([0.73; 3], [0.63, 0.065, 0.05], [0.14, 0.45, 0.091]);
    let wall = |shape, color: [f32; 3]| Object::new(shape, Material::diffuse(color)).into();
    let ball = |x, z, material: Material| {
        Object::new(Shape::Sphere { center: [x, -0.65, z], radius: 0.35 }, material).into()
    };
    let camera = Camera { position: [0.0, 0.0, 3.7], ..Camera::default() };
    let objects = vec![
        wall(quad([-1.0, -1.0, 1.0], [2.0, 0.0, 0.0], [0.0, 0.0, -2.0]), white),
        wall(quad([-1.0, 1.0, -1.0], [2.0, 0.0, 0.0], [0.0, 0.0, 2.0]), white),
        wall(quad([-1.0, -1.0, -1.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]), white),
        wall(quad([-1.0, -1.0, 1.0], [0.0, 0.0, -2.0], [0.0, 2.0, 0.0]), red),
        wall(quad([1.0, -1.0, -1.0], [0.0, 0.0, 2.0], [0.0, 2.0, 0.0]), green),
        ball(-0.4, -0.4, Material::conductor("gold", 0.0)),
        ball(0.4, 0.3, Material::dielectric(1.5)),
        Object::lamp(quad([-0.25, 0.99, -0.25], [0.5, 0.0, 0.0], [0.0, 0.0, 0.5]), Emission::power(12.0))
            .into(),
    ];
    let desc = SceneDesc { camera: Some(camera.into()), objects, ..SceneDesc::default() };
    let info = PictureInfo::new(&desc, scene_hash(&desc)?);
    let mut session = Session::new(Job::new(&desc, compile(&desc, 0)?.scene)?, 0)?;
    session.run(&mut |_event| Control::Continue)?;
    for name in ["cornell.png", "cornell.exr"] {
        Output::new(Path::new(name))?.write(session.film(), &info)?;
    }
    Ok(())
}
