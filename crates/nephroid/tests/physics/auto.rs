//! The default integrator: its weights add up to 1 whatever shines and whatever throws the caustic, and it leaves out
//! what does not pay.

use nephroid::desc::{
    Emission, IntegratorKind, Light, LightKind, Material, Object, PointAmount, Principled, Render, Shape,
    Triple,
};
use nephroid::{Layer, SceneDesc};
use testkit::Moments;

use crate::support::*;

const AUTO: IntegratorKind = IntegratorKind::Auto;
const DOWN: Triple = [0.0, -1.0, 0.0];
/// What discs that reach beyond edges may lose.
const BLUR: f64 = 0.003;

/// An error of caustics that the comparisons below must find; they are a part of the picture's light, and `path` finds
/// them with noise.
const PLANTED_IN_CAUSTICS: f64 = 1.15;

/// The light of both integrators, caustics apart.
fn assert_like_path(what: &str, desc: &SceneDesc, [path, auto]: [u32; 2]) {
    let layers = |integrator, passes| {
        let each = runs(desc, integrator, 16, passes, |film| {
            [mean(film, Layer::Caustic), mean(film, Layer::Direct) + mean(film, Layer::Indirect)]
        });
        [0, 1].map(|layer| Moments::of(each.iter().map(|run| run[layer])))
    };
    let ([caustic, rest], [expected_caustic, expected_rest]) = (layers(AUTO, auto), layers(PATH, path));
    assert_same_within(&format!("{what}, caustics"), &caustic, &expected_caustic, BLUR, PLANTED_IN_CAUSTICS);
    assert_same(what, &rest, &expected_rest, BLUR);
}

/// A floor, a ball and a wall, seen from the side.
fn floor_with(ball: Material) -> SceneDesc {
    on_floor(grey(0.5), ball)
}

/// The same on a floor of some material.
fn on_floor(floor: Material, ball: Material) -> SceneDesc {
    let objects = vec![
        Object::new(sphere([0.0, 0.6, 0.0], 0.5), ball),
        Object::new(ground(0.0, 2.5), floor),
        Object::new(disk([0.0, 1.0, -2.0], [0.0, 0.0, 1.0], 2.0), grey(0.3)),
    ];
    scene_of(look([1.5, 1.5, 3.0], [0.0, 0.3, 0.0], 40.0), 24, objects)
}

fn glass() -> Material {
    Material::dielectric(1.5)
}

fn metal(roughness: f32) -> Material {
    Material::conductor("silver", roughness)
}

/// Lamps that eye paths find often enough to be the judge: every technique has its part.
#[test]
fn lamps_through_glass_and_off_metal() {
    let disc = lamp(disk([0.6, 2.4, 0.4], DOWN, 0.9), 2.0);
    // It shines to all sides, and is sampled in another way.
    let ball = lamp(sphere([0.9, 2.2, 0.6], 0.7), 2.0);
    for (name, material, lamp) in [
        ("glass, disc", glass(), &disc),
        ("rough, disc", metal(0.3), &disc),
        ("glass, sphere", glass(), &ball),
        ("satin, sphere", metal(0.6), &ball),
    ] {
        let mut desc = floor_with(material);
        desc.objects.push(lamp.clone().into());
        assert_like_path(name, &desc, [160, 120]);
    }
}

#[test]
fn skies_through_glass_and_rough_metal() {
    for (name, ball) in [("glass", glass()), ("rough", metal(0.4))] {
        let mut desc = floor_with(ball);
        desc.lights.push(Light::from(LightKind::Environment { radiance: [1.0; 3] }).into());
        assert_like_path(name, &desc, [50, 60]);
    }
}

/// No eye path meets a point; off rough metal light sampling finds it too.
#[test]
fn points_and_suns_off_rough_metal() {
    let amount = PointAmount::Intensity([4.0; 3]);
    for light in [
        LightKind::Point { position: [1.0, 2.2, 0.8], amount },
        LightKind::Directional { direction: [-0.4, -1.0, -0.3], irradiance: [2.0; 3] },
    ] {
        let mut desc = floor_with(metal(0.4));
        desc.lights.push(Light::from(light).into());
        assert_like_path("rough", &desc, [250, 120]);
    }
}

/// Through glass only photons find a point: as many as progressive photon mapping finds.
#[test]
fn points_and_suns_through_glass() {
    let amount = PointAmount::Intensity([4.0; 3]);
    for light in [
        LightKind::Point { position: [0.3, 2.2, 0.2], amount },
        LightKind::Directional { direction: [-0.1, -1.0, -0.1], irradiance: [2.0; 3] },
    ] {
        let mut desc = floor_with(glass());
        desc.lights.push(Light::from(light).into());
        desc.sppm.photons = Some(20_000);
        let caustic = |integrator, passes| {
            Moments::of(runs(&desc, integrator, 16, passes, |film| mean(film, Layer::Caustic)))
        };
        assert_same_within("caustic", &caustic(AUTO, 120), &caustic(IntegratorKind::Sppm, 30), 0.01, 1.1);
    }
}

/// Floors whose coat reflects the caustic in a lobe: narrow, wide, and in two lobes of the principled model.
fn glossy_floors() -> [(&'static str, Material); 3] {
    [
        ("satin coat", Material::plastic(0.3, 0.3)),
        ("dull coat", Material::plastic(0.3, 0.6)),
        ("principled", Principled { roughness: 0.3.into(), ..Principled::default() }.into()),
    ]
}

/// A lamp that camera paths meet through the ball by the lobe and by the base, and photons too.
#[test]
fn glossy_floors_reflect_the_caustic_of_a_lamp_once() {
    for (name, floor) in glossy_floors() {
        let mut desc = on_floor(floor, glass());
        // Behind the ball: its light goes on to the camera by the lobe.
        desc.objects.push(lamp(sphere([-0.9, 1.9, -1.4], 0.5), 4.0).into());
        assert_like_path(name, &desc, [160, 120]);
    }
}

/// Of a point, photons alone find the caustic: its glints must not be left to paths that cannot meet it.
#[test]
fn glossy_floors_reflect_the_whole_caustic_of_a_point() {
    let amount = PointAmount::Intensity([4.0; 3]);
    for (name, floor) in glossy_floors() {
        let mut desc = on_floor(floor, glass());
        desc.lights.push(Light::from(LightKind::Point { position: [-0.9, 1.9, -1.4], amount }).into());
        desc.sppm.photons = Some(40_000);
        let caustic = |integrator, passes| {
            Moments::of(runs(&desc, integrator, 16, passes, |film| mean(film, Layer::Caustic)))
        };
        let expected = caustic(IntegratorKind::Sppm, 60);
        assert_same_within(name, &caustic(AUTO, 120), &expected, 0.01, 1.1);
    }
}

/// Lamps in glass, coats that mirror, chains of both, seen directly and in a mirror.
#[test]
fn a_room_of_glass_and_mirrors() {
    let walls = Object {
        flip_normals: true,
        ..Object::new(Shape::Box { min: [-1.5, -1.0, -1.2], max: [1.5, 1.0, 3.0] }, grey(0.5))
    };
    let ball = |x: f32, z: f32, material| Object::new(sphere([x, -0.6, z], 0.4), material);
    let objects = vec![
        walls,
        lamp(sphere([0.0, 0.5, 0.5], 0.25), 4.0),
        Object::new(sphere([0.0, 0.5, 0.5], 0.32), glass()),
        ball(-0.9, 0.2, glass()),
        ball(0.0, -0.6, metal(0.0)),
        ball(0.9, 0.2, Material::plastic(0.4, 0.0)),
    ];
    let desc = scene_of(look([0.0, 0.0, 2.9], [0.0, -0.2, 0.0], 60.0), 24, objects);
    assert_like_path("room", &desc, [250, 120]);
    let short = SceneDesc { render: Render { max_depth: Some(3), ..desc.render.clone() }, ..desc.clone() };
    assert_like_path("depth 3", &short, [250, 120]);
}

/// The inside of a sphere that shines, with a mirror in it: 1/(1 − ρ) everywhere, whoever finds it.
#[test]
fn sphere_furnace() {
    let objects = vec![furnace(1.0, 0.5), Object::new(sphere([0.3, -0.2, -0.3], 0.25), metal_white())];
    let desc = scene_of(look([0.2, 0.1, 0.7], [0.0, 0.0, -1.0], 80.0), 12, objects);
    assert_mean("furnace", &brightness(&desc, AUTO, 24, 24), 2.0, 0.0);
}

/// A mirror that loses nothing.
fn metal_white() -> Material {
    Material::mirror(1.0)
}

/// Without specular objects there is nothing to trace photons for: the bytes are those of `path`.
#[test]
fn without_caustics_it_is_the_path_tracer() {
    let mut desc = floor_with(grey(0.7));
    desc.objects.push(Object::lamp(disk([0.6, 2.4, 0.4], DOWN, 0.8), Emission::radiance([2.0; 3])).into());
    let scene = compiled(&desc);
    assert!(film(&desc, &scene, AUTO, 3, 2) == film(&desc, &scene, PATH, 3, 2));
}
