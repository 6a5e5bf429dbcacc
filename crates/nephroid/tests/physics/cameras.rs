//! Cameras that are no pinhole: light traced to them against paths traced from them.

use nephroid::desc::{
    CameraKind, FilterKind, IntegratorKind, Material, Object, Shape, SkyMapping, VcmTechniques,
};
use nephroid::{Film, Layer, SceneDesc};
use testkit::Moments;

use crate::support::*;

/// A closed room with a bright and a dark side, and things in it.
fn room(kind: CameraKind, shift: [f32; 2], size: [u32; 2]) -> SceneDesc {
    let walls = Shape::Box { min: [-1.5, -1.0, -1.2], max: [1.5, 1.0, 3.0] };
    let mut camera = look([0.1, 0.0, 2.4], [0.0, -0.2, 0.0], 60.0);
    (camera.kind, camera.shift) = (kind, shift);
    let objects = vec![
        Object { flip_normals: true, ..Object::new(walls, grey(0.5)) },
        lamp(disk([-0.7, 0.98, 0.3], [0.0, -1.0, 0.0], 0.7), 2.0),
        Object::new(sphere([-0.6, -0.6, 0.0], 0.4), grey(0.7)),
        Object::new(sphere([0.6, -0.6, 0.2], 0.4), Material::conductor("gold", 0.6)),
    ];
    let mut desc = scene_of(camera, 16, objects);
    desc.film.size = size;
    desc.render.max_depth = Some(3);
    desc.vcm.light_paths = Some(512);
    desc
}

const CAMERAS: [(&str, CameraKind, [f32; 2], [u32; 2]); 4] = [
    ("shifted", CameraKind::Pinhole, [0.3, -0.2], [16, 12]),
    ("parallel", CameraKind::Orthographic { extent: 1.4 }, [-0.1, 0.1], [16, 12]),
    ("longitudes", CameraKind::Spherical { mapping: SkyMapping::LatLong }, [0.0; 2], [16, 8]),
    ("equal areas", CameraKind::Spherical { mapping: SkyMapping::EqualArea }, [0.0; 2], [12, 12]),
];

/// The factor that is found in half a picture: a wrong density of rays is another matter.
const FOUND: f64 = 1.05;

fn halves(desc: &SceneDesc, integrator: IntegratorKind, passes: u32) -> [Moments; 2] {
    let half = desc.film.size[0] as usize / 2;
    let all = runs(desc, integrator, 12, passes, |f: &Film| {
        [mean_where(f, Layer::Beauty, |x, _| x < half), mean_where(f, Layer::Beauty, |x, _| x >= half)]
    });
    [0, 1].map(|i| Moments::of(all.iter().map(|s| s[i])))
}

/// In its place, too: in both halves of the picture.
#[test]
fn light_tracing_agrees_with_path_for_each_camera() {
    for (name, kind, shift, size) in CAMERAS {
        let mut desc = room(kind, shift, size);
        let path = halves(&desc, PATH, 200);
        desc.vcm.techniques = VcmTechniques::LightTracing;
        let found = halves(&desc, IntegratorKind::Vcm, 200);
        assert!((path[0].mean / path[1].mean - 1.0).abs() > 4.0 * (PLANTED - 1.0), "{name}: {path:?}");
        for i in [0, 1] {
            assert_same_within(&format!("{name}, half {i}"), &found[i], &path[i], 0.0, FOUND);
        }
    }
}

/// With weights, and with a filter that reaches beyond the border: what a picture of all directions has there is seen from the
/// other side of it as well, but light paths are joined to one of the two alone.
#[test]
fn bidirectional_paths_agree_with_path_for_each_camera() {
    for (name, kind, shift, size) in CAMERAS {
        let mut desc = room(kind, shift, size);
        desc.film.filter = FilterKind::Mitchell;
        let path = halves(&desc, PATH, 200);
        desc.vcm.techniques = VcmTechniques::Bdpt;
        let found = halves(&desc, IntegratorKind::Vcm, 140);
        for i in [0, 1] {
            assert_same_within(&format!("{name}, half {i}"), &found[i], &path[i], 0.0, FOUND);
        }
    }
}

/// Photons are gathered over footprints: those of parallel rays have a width and do not grow.
#[test]
fn photons_agree_with_path_for_each_camera() {
    for (name, kind, shift, size) in CAMERAS {
        let mut desc = room(kind, shift, size);
        let path = halves(&desc, PATH, 200);
        desc.sppm.photons = Some(4000);
        desc.sppm.radius_pixels = 0.5;
        let found = halves(&desc, IntegratorKind::Sppm, 40);
        for i in [0, 1] {
            // What the blur costs along edges.
            assert_same_within(&format!("{name}, half {i}"), &found[i], &path[i], 0.005, 1.1);
        }
    }
}

/// Parallel rays start in different media: over a tank of water the half outside sees through air.
#[test]
fn parallel_rays_know_what_they_start_in() {
    let water = Material::dielectric(1.33);
    let tank = Shape::Box { min: [-4.0, -1.0, -4.0], max: [0.0, 4.0, 4.0] };
    let mut camera = look([0.0, 2.0, 0.0], [0.0, -2.0, 0.0], 60.0);
    camera.kind = CameraKind::Orthographic { extent: 2.0 };
    let mut desc = scene_of(
        camera,
        8,
        vec![Object::new(tank, water), lamp(disk([0.0, -2.0, 0.0], [0.0, 1.0, 0.0], 50.0), 1.0)],
    );
    desc.render.max_depth = Some(1);
    let all = runs(&desc, PATH, 2, 4, |f: &Film| {
        [mean_where(f, Layer::Beauty, |x, _| x < 4), mean_where(f, Layer::Beauty, |x, _| x >= 4)]
    });
    let (low, high) = (all[0][0].min(all[0][1]), all[0][0].max(all[0][1]));
    // Radiance in water is n² times what falls in from air, less what is reflected; that of a ray which begins in it is so.
    let reflected = ((1.33f64 - 1.0) / 2.33).powi(2);
    assert!((low - 1.0).abs() < 1e-6, "{all:?}");
    assert!((high - (1.0 - reflected) * 1.33f64.powi(2)).abs() < 0.01, "{all:?}");
}
