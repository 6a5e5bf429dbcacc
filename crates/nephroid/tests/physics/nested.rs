//! Dielectrics within dielectrics.

use nephroid::SceneDesc;
use nephroid::desc::{Dielectric, Material, MaterialRef, Object, Shape};

use transport::PhotonPaths;

use crate::support::*;

fn glass(ior: f32, priority: i32) -> Material {
    Dielectric { ior: ior.into(), priority, ..Dielectric::default() }.into()
}

fn block(min: f32, max: f32, material: impl Into<MaterialRef>) -> Object {
    Object::new(Shape::Box { min: [min; 3], max: [max; 3] }, material)
}

fn inward(object: Object) -> Object {
    Object { flip_normals: true, ..object }
}

/// A block in front of a wall with a lamp, seen from an angle; a diffuse ball within the block.
fn seen(block: Vec<Object>) -> SceneDesc {
    let mut objects = block;
    objects.extend([
        Object::new(sphere([0.1, -0.1, 0.0], 0.3), Material::diffuse([0.8, 0.5, 0.2])),
        Object::new(ground(-1.2, 4.0), grey(0.6)),
        lamp(disk([0.5, 3.0, 0.5], [0.0, -1.0, 0.0], 1.5), 3.0),
    ]);
    let mut desc = scene_of(look([2.0, 1.5, 4.0], [0.0; 3], 30.0), 24, objects);
    // A skin leaves what was entered through the same material.
    desc.materials.insert("shell".to_owned(), glass(1.5, 1).into());
    desc
}

/// Water that overlaps the wall of its glass is cut off where the glass begins: the same picture as water that just touches.
#[test]
fn water_that_overlaps_its_glass_equals_water_that_touches_it() {
    // A block of glass, and the water a hollow in it: entered last, it counts.
    let touching = vec![block(-1.0, 1.0, glass(1.5, 0)), block(-0.8, 0.8, glass(1.33, 0))];
    // The glass a shell with an inner skin; the water reaches into it and gives way.
    let shell = |water: Object| vec![block(-1.0, 1.0, "shell"), inward(block(-0.8, 0.8, "shell")), water];
    let overlapping = shell(block(-0.9, 0.9, glass(1.33, 0)));
    // Water that wins is too wide.
    let wrong = shell(block(-0.9, 0.9, glass(1.33, 2)));
    let other_index = shell(block(-0.9, 0.9, glass(1.33 * PLANTED as f32, 0)));
    assert_equal_pictures(&seen(touching), &seen(overlapping), &[seen(wrong), seen(other_index)]);
}

/// A hollow globe, written as a sphere of vacuum in a sphere of glass, and as a sphere of glass with an inner skin.
#[test]
fn a_hollow_globe_is_the_same_however_it_is_written() {
    let ball = |radius, material: MaterialRef| Object::new(sphere([0.0; 3], radius), material);
    let outside = || ball(1.0, "shell".into());
    let vacuum = vec![outside(), ball(0.9, glass(1.0, 1).into())];
    let skin = vec![outside(), inward(ball(0.9, "shell".into()))];
    let solid = vec![outside()];
    let thicker = vec![outside(), ball(0.9 / PLANTED as f32, glass(1.0, 1).into())];
    assert_equal_pictures(&seen(vacuum), &seen(skin), &[seen(solid), seen(thicker)]);
}

/// Paths take the same random numbers at the same places, so that pixels agree to rounding, but for paths that rounding
/// sends to another side of some edge. Photons, which are aimed at other targets, bring the
/// same flux.
fn assert_equal_pictures(a: &SceneDesc, b: &SceneDesc, wrong: &[SceneDesc]) {
    let pixels = |desc: &SceneDesc| film(desc, &compiled(desc), PATH, 3, 2).beauty();
    let one = pixels(a);
    let share_of_equals = |desc: &SceneDesc| {
        let other = pixels(desc);
        let equal = one
            .iter()
            .zip(&other)
            .filter(|(p, q)| p.iter().zip(*q).all(|(x, y)| (x - y).abs() <= 1e-3 * (x.abs() + y.abs())));
        equal.count() as f64 / one.len() as f64
    };
    let same = share_of_equals(b);
    assert!(same > 0.95, "{same}");
    for w in wrong {
        let same = share_of_equals(w);
        assert!(same < 0.9, "blind: {same}");
    }
    let received =
        |desc: &SceneDesc| flux(&compiled(desc), PhotonPaths::Caustic, 20_000, 24, u32::MAX, |_| true);
    assert_same("flux of the caustic", &received(b), &received(a), 0.0);
}
