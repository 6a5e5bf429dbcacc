//! Albedo, normal and depth are of what the camera sees in mirrors and through clear glass.

use nephroid::Layer;
use nephroid::desc::{IntegratorKind, Material, Object, ThinDielectric};

use crate::support::{compiled, disk, film, furnace, look, mean, scene_of, small_maps};

const ALL: [IntegratorKind; 5] = [
    IntegratorKind::Auto,
    IntegratorKind::Path,
    IntegratorKind::PhotonMap,
    IntegratorKind::Sppm,
    IntegratorKind::Vcm,
];

/// Means of albedo and of the normal's z, and the least depth, inside a sphere of radius 5 that reflects a half, seen from its
/// middle through or in a disk at z = −1 that fills the view.
fn seen(material: Material, integrator: IntegratorKind) -> [f64; 3] {
    let pane = Object::new(disk([0.0, 0.0, -1.0], [0.0, 0.0, 1.0], 2.0), material);
    let camera = look([0.0; 3], [0.0, 0.0, -1.0], 10.0);
    let mut desc = scene_of(camera, 4, vec![furnace(5.0, 0.5), pane]);
    small_maps(&mut desc);
    let film = film(&desc, &compiled(&desc), integrator, 7, 64);
    let normals = film.layer(Layer::Normal);
    let z = normals.iter().skip(2).step_by(3).map(|&v| f64::from(v)).sum::<f64>() / 16.0;
    let depth = film.layer(Layer::Depth).into_iter().fold(f32::INFINITY, f32::min);
    [mean(&film, Layer::Albedo), z, depth.into()]
}

#[test]
fn a_mirror_shows_what_it_mirrors() {
    for integrator in ALL {
        let [albedo, z, depth] = seen(Material::mirror(0.8), integrator);
        assert!((albedo - 0.4).abs() < 0.01, "{integrator:?}: 0.8 of a half, not {albedo}");
        assert!((-0.81..-0.75).contains(&z), "{integrator:?}: the wall behind the camera looks at −z: {z}");
        // To the mirror and back past the camera.
        assert!((depth - 7.0).abs() < 0.1, "{integrator:?}: {depth}");
    }
}

#[test]
fn a_pane_shows_the_wall_behind_it() {
    for integrator in ALL {
        let [albedo, z, depth] = seen(ThinDielectric::default().into(), integrator);
        assert!((albedo - 0.5).abs() < 0.02, "{integrator:?}: {albedo}");
        // Eight per cent see the wall behind the camera.
        assert!((0.75..0.95).contains(&z), "{integrator:?}: {z}");
        assert!((depth - 5.0).abs() < 0.1, "{integrator:?}: {depth}");
    }
}
