//! Photons on the lit side of a partition without thickness are none of the dark side's, though they lie within its discs.

use nephroid::desc::{DirectLight, IntegratorKind, Material, MaterialRef, Object, Shape, Triple};
use testkit::Moments;

use crate::support::*;

const DOWN: Triple = [0.0, -1.0, 0.0];
const SIZE: usize = 64;
/// Of the camera, degrees: pixels are so small that discs have their default size.
const FOV: f32 = 10.0;

/// A floor with a partition on it at x = 0, the lamp at x > 0, seen from above on either side: distances to the
/// partition's foot in pixels and the radiance there, by columns of the picture.
fn floor(
    side: f32,
    partition: impl Into<MaterialRef>,
    integrator: IntegratorKind,
    direct: DirectLight,
) -> Vec<(f64, f64)> {
    let walls =
        Object { flip_normals: true, ..Object::new(Shape::Box { min: [-1.0; 3], max: [1.0; 3] }, grey(0.7)) };
    let quad = Shape::Quad { origin: [0.0, -1.0, -1.0], edge_u: [0.0, 2.0, 0.0], edge_v: [0.0, 0.0, 2.0] };
    let objects = vec![walls, Object::new(quad, partition), lamp(disk([0.5, 0.99, 0.0], DOWN, 0.3), 10.0)];
    let middle = 0.08 * side;
    let mut desc = scene_of(look([middle, 0.5, 0.0], [middle, -1.0, 0.0], FOV), SIZE as u32, objects);
    desc.sppm.direct = direct;
    let pixel = 2.0 * 1.5 * f64::from((0.5 * FOV).to_radians().tan()) / SIZE as f64;
    let beauty = film(&desc, &compiled(&desc), integrator, 1, 16).beauty();
    let column = |c: usize| {
        // +x is left.
        let x = f64::from(middle) - (c as f64 + 0.5 - SIZE as f64 / 2.0) * pixel;
        let rows = (0..SIZE).map(|row| f64::from(beauty[row * SIZE + c][0]));
        (x * f64::from(side) / pixel, Moments::of(rows).mean)
    };
    let mut columns: Vec<_> = (0..SIZE).map(column).filter(|(distance, _)| *distance > 0.0).collect();
    columns.sort_by(|a, b| a.0.total_cmp(&b.0));
    columns
}

/// Darkness over light at the worst column beyond one pixel.
fn leak(partition: impl Into<MaterialRef> + Clone, integrator: IntegratorKind, direct: DirectLight) -> f64 {
    let lit = floor(1.0, partition.clone(), integrator, direct);
    let dark = floor(-1.0, partition, integrator, direct);
    let beyond = dark.iter().zip(&lit).filter(|(d, _)| d.0 > 1.0);
    beyond.map(|(d, l)| d.1 / l.1).fold(0.0, f64::max)
}

/// The project's bar is 1 %.
#[test]
fn trap_light_does_not_leak_under_a_partition() {
    let wall = || grey(0.7);
    for (integrator, direct) in [
        (IntegratorKind::Auto, DirectLight::Sampling),
        (IntegratorKind::Sppm, DirectLight::Sampling),
        (IntegratorKind::Sppm, DirectLight::Photons),
        (IntegratorKind::Vcm, DirectLight::Sampling),
    ] {
        let found = leak(wall(), integrator, direct);
        assert!(found < 0.01, "{integrator:?}, direct light by {direct:?}: {found}");
    }
    // The check can fail: glass hides nothing.
    let found = leak(Material::dielectric(1.0001), IntegratorKind::Sppm, DirectLight::Photons);
    assert!(found > 0.05, "{found}");
}
