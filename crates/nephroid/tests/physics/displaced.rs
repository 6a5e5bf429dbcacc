//! Displaced surfaces are watertight, and bend light as the surface does that they stand for.

use nephroid::SceneDesc;
use nephroid::desc::{
    Displacement, EdgeLength, IntegratorKind, Light, LightKind, Material, Noise, NoiseKind, Object, Shape,
    Texture, TransformStep, Triple,
};
use transport::PhotonPaths;

use crate::oracle::{GlassSphere, Source};
use crate::support::*;

fn displaced(shape: Shape, texture: &str, scale: f32, edge: f32) -> Object {
    let displacement = Displacement {
        texture: texture.to_owned().into(),
        scale,
        midlevel: 0.0,
        edge: EdgeLength::Units(edge),
    };
    Object { displacement: Some(displacement.into()), ..Object::new(shape, Material::dielectric(1.5)) }
}

/// A constant, hills in space, and squares that break off at the seams of coordinates.
fn textures(desc: &mut SceneDesc) {
    let hills = Noise {
        kind: NoiseKind::Fbm,
        octaves: 4,
        roughness: 0.5,
        transform: vec![TransformStep::Scale([0.4; 3])],
    };
    let all = [
        ("one", Texture::Product { a: 1.0.into(), b: 1.0.into() }),
        ("hills", Texture::Noise(hills)),
        ("squares", Texture::checker(1.0, 0.0, [3.3, 2.7])),
    ];
    desc.textures.extend(all.map(|(name, texture)| (name.to_owned(), texture.into())));
}

#[test]
fn displaced_glass_is_not_seen_in_a_white_furnace() {
    let cube = || Shape::Box { min: [-0.5; 3], max: [0.5; 3] };
    for (what, shape, texture, scale) in [
        ("hilly sphere", sphere([0.0; 3], 0.7), "hills", 0.15),
        ("stepped sphere", sphere([0.0; 3], 0.7), "squares", 0.1),
        ("hilly box", cube(), "hills", 0.2),
        ("stepped box", cube(), "squares", 0.1),
    ] {
        let mut desc = scene_of(
            look([0.0, 0.6, 2.0], [0.0; 3], 40.0),
            12,
            vec![furnace(4.0, 0.5), displaced(shape, texture, scale, 0.03)],
        );
        textures(&mut desc);
        assert_mean(what, &brightness(&desc, PATH, 16, 32), 2.0, 2e-4);
    }
}

/// A small ball that is blown up is the large ball, whose caustic is known in closed form.
#[test]
fn a_ball_that_grows_casts_the_caustic_of_the_large_one() {
    let s = GlassSphere { center: 1.0, radius: 0.3, index: 1.5, floor_radius: 1.5 };
    let ball = displaced(sphere([0.0, s.center as f32, 0.0], 0.2), "one", 0.1, 0.01);
    let down: Triple = [0.0, -1.0, 0.0];
    let floor = Object::new(disk([0.0; 3], [0.0, 1.0, 0.0], s.floor_radius as f32), grey(0.5));
    let mut desc = scene_of(look([2.0, 1.2, 2.0], [0.0, 0.1, 0.0], 20.0), 24, vec![ball, floor]);
    textures(&mut desc);
    let light = LightKind::Directional { direction: down, irradiance: [1.0; 3] };
    desc.lights.push(Light::from(light).into());
    let scene = compiled(&desc);
    let m = flux(&scene, PhotonPaths::Caustic, 8_000, 24, u32::MAX, |_| true);
    assert_mean("flux", &m, s.flux(Source::Parallel)[0], 1e-3);
    // Where it goes: the inner half of it lies as near to the axis.
    let radius2 = |p: &photons::Photon| p.position.x.powi(2) + p.position.z.powi(2);
    let exact = scene_with(sphere([0.0, s.center as f32, 0.0], s.radius as f32), &desc);
    for r in [0.04f32, 0.08, 0.15] {
        let [found, wanted] = [&scene, &exact]
            .map(|scene| flux(scene, PhotonPaths::Caustic, 40_000, 24, u32::MAX, |p| radius2(p) < r * r));
        assert_same_within(&format!("within {r}"), &found, &wanted, 0.01, 1.1);
    }
}

fn scene_with(shape: Shape, desc: &SceneDesc) -> std::sync::Arc<nephroid::Scene> {
    let mut desc = desc.clone();
    desc.objects[0] = Object::new(shape, Material::dielectric(1.5)).into();
    compiled(&desc)
}

/// Photons find the caustics of a hilly sheet of glass that paths find, too.
#[test]
fn photons_and_paths_agree_on_hills() {
    let sheet = Shape::Box { min: [-0.6, 0.8, -0.6], max: [0.6, 0.9, 0.6] };
    let lamp = lamp(disk([0.3, 2.5, 0.2], [0.0, -1.0, 0.0], 0.6), 10.0);
    let objects = vec![displaced(sheet, "hills", 0.06, 0.03), Object::new(ground(0.0, 1.5), grey(0.6)), lamp];
    let mut desc = scene_of(look([0.0, 1.4, 3.0], [0.0, 0.2, 0.0], 30.0), 16, objects);
    textures(&mut desc);
    let path = brightness(&desc, PATH, 16, 128);
    let auto = brightness(&desc, IntegratorKind::Auto, 16, 48);
    assert_same_within("hills", &auto, &path, 0.006, 1.1);
}
