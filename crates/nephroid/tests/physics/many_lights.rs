//! Many lamps: one is picked by a tree for direct light, whose probabilities all weights know.

use nephroid::desc::{DirectLight, Emission, IntegratorKind, Light, LightKind, Object, PointAmount, Shape};

use crate::support::*;

/// Lamps of three kinds under a ceiling, from dim to bright, some of them turned away, over a floor and two balls.
fn hall() -> nephroid::SceneDesc {
    let mut objects = vec![
        Object::new(ground(-1.0, 3.0), grey(0.5)),
        Object::new(sphere([-0.6, -0.55, 0.0], 0.4), grey(0.7)),
        Object::new(sphere([0.6, -0.55, 0.3], 0.4), grey(0.4)),
    ];
    let mut lights = Vec::new();
    for i in 0..48 {
        let (x, z) = (0.8 * (i % 8) as f32 - 2.8, 0.9 * (i / 8) as f32 - 2.5);
        let radiance = 0.5 + 4.0 * ((i * 7) % 11) as f32;
        let y = 0.3 + 0.1 * (i % 5) as f32;
        match i % 4 {
            0 => objects.push(lamp(sphere([x, y, z], 0.08), radiance)),
            1 => objects
                .push(lamp(disk([x, y, z], [0.3, if i % 3 == 0 { 1.0 } else { -1.0 }, 0.1], 0.1), radiance)),
            2 => {
                let shape =
                    Shape::Quad { origin: [x, y, z], edge_u: [0.15, 0.0, 0.0], edge_v: [0.0, 0.02, 0.15] };
                let emission = Emission { two_sided: i % 8 == 2, ..Emission::radiance([radiance; 3]) };
                objects.push(Object::lamp(shape, emission));
            }
            _ => lights.push(Light::from(LightKind::Point {
                position: [x, y, z],
                amount: PointAmount::Intensity([0.02 * radiance; 3]),
            })),
        }
    }
    lights.push(LightKind::Environment { radiance: [0.05; 3] }.into());
    let mut desc = scene_of(look([0.0, 0.2, 2.2], [0.0, -1.1, 0.0], 40.0), 16, objects);
    desc.lights = lights.into_iter().map(Into::into).collect();
    small_maps(&mut desc);
    desc.sppm.photons = Some(30_000);
    desc
}

#[test]
fn many_lamps_agree_with_photons_alone() {
    let mut desc = hall();
    // All direct light by photons: no light is picked for a receiver.
    desc.sppm.direct = DirectLight::Photons;
    let photons = brightness(&desc, IntegratorKind::Sppm, 10, 64);
    for integrator in [PATH, IntegratorKind::Vcm, IntegratorKind::Auto] {
        let found = brightness(&desc, integrator, 10, 48);
        assert_same_within(integrator.name(), &found, &photons, 0.01, 1.06);
    }
}
