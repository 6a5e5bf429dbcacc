//! Lamps seen through glass and in mirrors.

use nephroid::desc::Object;
use nephroid::{Layer, SceneDesc, load};
use testkit::Moments;

use crate::support::*;
use crate::window::Window;

/// Mean over columns 110 to 145 and rows 51 to 86 of `globe`, by channel, as the reference has it, and its standard error.
pub const WINDOW: [f64; 3] = [3.9438, 2.7690, 0.9165];
const WINDOW_ERROR: [f64; 3] = [0.0023, 0.0016, 0.0005];

/// Pure E S* L paths are not counted among what merging or light sampling could have found. Statistics, the reference's and
/// our own, and 0.3 % for the edge of the window.
#[test]
fn trap_the_lamp_seen_through_its_globe_has_its_full_radiance_in_path() {
    let (desc, window) = globe();
    let means = window.means(&desc, PATH, 16, 50, &[Layer::Beauty]);
    for ((m, expected), error) in means.iter().zip(WINDOW).zip(WINDOW_ERROR) {
        assert_mean("lamp in its globe", m, expected, 0.003 + 2.0 * error / expected);
    }
}

/// The lamp is the picture's direct layer: no surface sees it. What the walls behind it send, 3 % of the window, comes by caustic
/// paths; it is taken off as path tracing knows it.
#[test]
fn trap_the_lamp_seen_through_its_globe_has_its_full_radiance_in_photon_map() {
    let (mut desc, window) = globe();
    let rest = window.means(&desc, PATH, 16, 20, &[Layer::Caustic, Layer::Indirect]);
    desc.photon_map.photons = 1;
    desc.photon_map.caustic_photons = 1;
    desc.photon_map.final_gather = 0;
    let lamp = window.means(&desc, PHOTON_MAP, 16, 5, &[Layer::Direct]);
    for c in 0..3 {
        assert!(rest[c].mean < 0.05 * WINDOW[c], "{:?}", rest[c]);
        let expected = Moments { mean: WINDOW[c] - rest[c].mean, ..rest[c] };
        assert_same("lamp in its globe", &lamp[c], &expected, 0.003 + 2.0 * WINDOW_ERROR[c] / WINDOW[c]);
    }
}

pub fn globe() -> (SceneDesc, Window) {
    let desc = load(&root().join("scenes/arena/globe.toml"), &[]).desc.unwrap();
    (desc, Window::new(110.0..146.0, 51.0..87.0, 64))
}

/// A lamp in a mirror, and through a glass sphere that magnifies it: the closed forms are its radiance, and its radiance
/// less what is reflected. On the axis the transmittance of two crossings is (1 − R)²; light that went to and fro inside
/// adds (1 − R)²(R² + R⁴ + …): together (1 − R)/(1 + R), R = 0.04.
#[test]
fn lamps_in_mirrors_and_through_glass_have_their_radiance() {
    let backdrop = lamp(disk([0.0, 0.0, -5.0], [0.0, 0.0, 1.0], 50.0), 3.0);
    let facing = look([0.0, 0.0, 1.0], [0.0, 0.0, -1.0], 0.5);
    let mirror =
        Object::new(disk([0.0, 0.0, 2.0], [0.0, 0.0, -1.0], 1.0), nephroid::desc::Material::mirror(0.9));
    let away = look([0.0, 0.0, 1.0], [0.0, 0.0, 3.0], 0.5);
    let glass = Object::new(
        nephroid::desc::Shape::Box { min: [-1.0, -1.0, -1.0], max: [1.0, 1.0, -0.5] },
        nephroid::desc::Material::dielectric(1.5),
    );
    for integrator in [PATH, PHOTON_MAP] {
        let scene = scene_of(away.clone(), 8, vec![backdrop.clone(), mirror.clone()]);
        assert_mean("mirror", &brightness(&scene, integrator, 4, 2), 2.7, 1e-5);
        // The camera lies between slab and lamp's plane's other side; behind it is nothing.
        let scene = scene_of(facing.clone(), 8, vec![backdrop.clone(), glass.clone()]);
        assert_mean("slab", &brightness(&scene, integrator, 24, 24), 3.0 * 0.96 / 1.04, 1e-4);
    }
}
