//! Vertex connection and merging, and each of its techniques alone, against `path` where both see the light, and against
//! closed forms.

use nephroid::desc::{
    CameraKind, Emission, FilterKind, IntegratorKind, Light, LightKind, Material, Object, PointAmount, Shape,
    VcmTechniques,
};
use nephroid::{Film, Layer, SceneDesc};
use testkit::Moments;

use crate::support::*;

const VCM: IntegratorKind = IntegratorKind::Vcm;

const ALL: [VcmTechniques; 5] = [
    VcmTechniques::Vcm,
    VcmTechniques::Bdpt,
    VcmTechniques::LightTracing,
    VcmTechniques::Bpm,
    VcmTechniques::Ppm,
];

fn with(desc: &SceneDesc, techniques: VcmTechniques) -> SceneDesc {
    let mut desc = desc.clone();
    desc.vcm.techniques = techniques;
    desc
}

fn merges(techniques: VcmTechniques) -> bool {
    matches!(techniques, VcmTechniques::Vcm | VcmTechniques::Bpm | VcmTechniques::Ppm)
}

fn ball(x: f32, z: f32, material: Material) -> Object {
    Object::new(sphere([x, -0.6, z], 0.4), material)
}

/// A closed room of 3 × 2 × 4.2 with things in it and no light.
fn room(objects: Vec<Object>) -> SceneDesc {
    let walls = Shape::Box { min: [-1.5, -1.0, -1.2], max: [1.5, 1.0, 3.0] };
    let mut all = vec![Object { flip_normals: true, ..Object::new(walls, grey(0.5)) }];
    all.extend(objects);
    let mut desc = scene_of(look([0.0, 0.0, 2.9], [0.0, -0.3, 0.0], 60.0), 16, all);
    desc.vcm.light_paths = Some(512);
    desc.vcm.radius = Some(0.02);
    desc.vcm.alpha = 1.0;
    desc
}

fn lit_from_above() -> Object {
    lamp(disk([0.0, 0.98, 0.0], [0.0, -1.0, 0.0], 0.9), 2.0)
}

/// What the blur of merging may cost: edges and corners within a radius see less light.
const BLUR: f64 = 0.004;

/// Every technique sees all the light of a scene without mirrors and glass: light tracing, too.
#[test]
fn each_technique_alone_agrees_with_path_in_a_diffuse_room() {
    let mut desc = room(vec![
        lit_from_above(),
        ball(-0.6, 0.0, grey(0.7)),
        ball(0.6, 0.2, Material::conductor("gold", 0.6)),
        ball(0.0, 0.6, Material::plastic(0.6, 0.4)),
    ]);
    let path = brightness(&desc, PATH, 12, 64);
    for techniques in ALL {
        desc.vcm.light_paths = Some(if techniques == VcmTechniques::Ppm { 2048 } else { 512 });
        let found = brightness(&with(&desc, techniques), VCM, 16, 80);
        let slack = if merges(techniques) { BLUR } else { 0.0 };
        assert_same(&format!("{techniques:?}"), &found, &path, slack);
    }
}

/// Layers, too: paths put together from both sides are sorted as whole ones.
#[test]
fn caustics_and_all_materials_agree_with_path_layer_by_layer() {
    let desc = room(vec![
        lit_from_above(),
        ball(-1.0, 0.0, Material::plastic(0.6, 0.0)),
        ball(0.0, -0.3, Material::phong([0.4, 0.3, 0.2], [0.5, 0.5, 0.5], 20.0)),
        ball(1.0, 0.0, Material::conductor("gold", 0.5)),
        ball(-0.5, 0.7, Material::dielectric(1.5)),
        ball(0.5, 0.7, Material::conductor("gold", 0.0)),
    ]);
    let layers = [Layer::Direct, Layer::Caustic, Layer::Indirect];
    let sums = |integrator, desc: &SceneDesc, passes| {
        let all = runs(desc, integrator, 16, passes, |f: &Film| layers.map(|l| mean(f, l)));
        [0, 1, 2].map(|i| Moments::of(all.iter().map(|s| s[i])))
    };
    let path = sums(PATH, &desc, 400);
    for techniques in [VcmTechniques::Vcm, VcmTechniques::Bdpt, VcmTechniques::Bpm] {
        let found = sums(VCM, &with(&desc, techniques), 96);
        let slack = if merges(techniques) { BLUR } else { 0.0 };
        for (i, layer) in layers.into_iter().enumerate() {
            // `path` knows the caustics to 2 % only, bidirectional photon mapping the rest.
            if layer == Layer::Caustic || techniques == VcmTechniques::Bpm {
                let noise = path[i].standard_error().hypot(found[i].standard_error());
                assert!(
                    noise < 0.02 * path[i].mean,
                    "{techniques:?}: too noisy: {:?} {:?}",
                    path[i],
                    found[i]
                );
                assert!(
                    (found[i].mean - path[i].mean).abs() < 4.0 * noise + slack * path[i].mean,
                    "{techniques:?}"
                );
            } else {
                assert_same(&format!("{techniques:?}, {layer:?}"), &found[i], &path[i], slack);
            }
        }
    }
}

/// Kinds of light that start light paths each in their own way.
#[test]
fn all_kinds_of_light_agree_with_path() {
    let amount = PointAmount::Intensity([1.0; 3]);
    let point = LightKind::Point { position: [0.3, 0.5, 0.5], amount };
    let spot = LightKind::Spot {
        position: [0.3, 0.8, 1.0],
        direction: [-0.2, -1.0, -0.6],
        cone_angle: 50.0,
        falloff_angle: 20.0,
        amount,
    };
    let sun = LightKind::Directional { direction: [0.3, -1.0, -0.4], irradiance: [1.0; 3] };
    let sky = LightKind::Environment { radiance: [0.5; 3] };
    let globe = Emission::radiance([2.0; 3]);
    let things = || vec![ball(-0.6, 0.0, grey(0.7)), ball(0.6, 0.2, Material::conductor("gold", 0.6))];
    let mut scenes = vec![("point", room(things())), ("spot", room(things())), ("globe", room(things()))];
    scenes[0].1.lights.push(Light::from(point).into());
    scenes[1].1.lights.push(Light::from(spot).into());
    scenes[2].1.objects.push(Object::lamp(sphere([0.3, 0.5, 0.5], 0.2), globe).into());
    for (name, kind) in [("sun", sun), ("sky", sky)] {
        let mut objects = things();
        objects.push(Object::new(ground(-1.0, 1.5), grey(0.5)));
        let mut desc = scene_of(look([0.0, 0.4, 2.9], [0.0, -0.6, 0.0], 50.0), 16, objects);
        desc.vcm = room(vec![]).vcm;
        desc.lights.push(Light::from(kind).into());
        scenes.push((name, desc));
    }
    for (name, desc) in scenes {
        let path = brightness(&desc, PATH, 16, 64);
        assert_same(name, &brightness(&desc, VCM, 16, 64), &path, BLUR);
    }
}

/// What light paths leave on the film is spread by the filter that eye paths are drawn with, also through a lens, and in
/// its place: in both halves of a picture with a bright and a dark half.
#[test]
fn splats_go_where_pixels_look_through_lens_and_filters() {
    let mut desc = room(vec![lamp(disk([-0.7, 0.98, 0.3], [0.0, -1.0, 0.0], 0.7), 2.0)]);
    let camera = desc.camera.as_mut().unwrap();
    camera.value.kind = CameraKind::ThinLens { lens_radius: 0.1, focus_distance: Some(2.0) };
    for filter in [FilterKind::Box, FilterKind::Mitchell] {
        desc.film.filter = filter;
        let halves = |integrator, techniques, passes| {
            let all = runs(&with(&desc, techniques), integrator, 12, passes, |f: &Film| {
                [mean_where(f, Layer::Beauty, |x, _| x < 8), mean_where(f, Layer::Beauty, |x, _| x >= 8)]
            });
            [0, 1].map(|i| Moments::of(all.iter().map(|s| s[i])))
        };
        let path = halves(PATH, VcmTechniques::Vcm, 200);
        assert!((path[0].mean / path[1].mean - 1.0).abs() > 4.0 * (PLANTED - 1.0));
        // Beyond the film eye paths start that light paths cannot be joined to: only with a box light tracing alone has
        // all the light of the pixels at the border.
        let techniques = match filter {
            FilterKind::Box => VcmTechniques::LightTracing,
            _ => VcmTechniques::Bdpt,
        };
        let found = halves(VCM, techniques, 144);
        for i in [0, 1] {
            assert_same(&format!("{filter:?}, half {i}"), &found[i], &path[i], 0.0);
        }
    }
}

/// Photon density in the sphere is exact at any radius. Its weights are not: they take a photon for one that lies where the
/// eye path is, which is a matter of (radius)².
#[test]
fn sphere_furnace() {
    let (albedo, radius) = (0.7, 0.15);
    let mut desc = scene_of(look([0.2, 0.1, 0.3], [-0.4, 0.3, -1.0], 80.0), 8, vec![furnace(1.0, albedo)]);
    desc.vcm.radius = Some(radius);
    desc.vcm.light_paths = Some(2000);
    for techniques in ALL {
        let m = brightness(&with(&desc, techniques), VCM, 16, 16);
        assert_mean(&format!("{techniques:?}"), &m, 1.0 / (1.0 - f64::from(albedo)), 0.004);
    }
}

#[test]
fn depths_are_partial_sums_of_the_furnace() {
    let mut desc = scene_of(look([0.2, 0.1, 0.3], [-0.4, 0.3, -1.0], 80.0), 8, vec![furnace(1.0, 0.7)]);
    desc.vcm.radius = Some(0.2);
    desc.vcm.light_paths = Some(2000);
    for techniques in ALL {
        for depth in [0, 1, 3] {
            desc.render.max_depth = Some(depth);
            let expected: f64 = (0..=depth as i32).map(|k| 0.7f64.powi(k)).sum();
            let m = brightness(&with(&desc, techniques), VCM, 12, 12);
            assert_mean(&format!("{techniques:?}, depth {depth}"), &m, expected, 1e-5);
        }
    }
}

/// The lamp behind glass, which only the eye path itself finds.
#[test]
fn a_lamp_seen_through_its_globe_is_as_bright_as_path_says() {
    let globe = Object::new(sphere([0.0; 3], 1.0), Material::dielectric(1.5));
    let desc =
        scene_of(look([0.0, 0.0, 6.0], [0.0; 3], 12.0), 16, vec![globe, lamp(sphere([0.0; 3], 0.3), 1.0)]);
    let path = brightness(&desc, PATH, 12, 64);
    for techniques in [VcmTechniques::Vcm, VcmTechniques::Bdpt, VcmTechniques::Bpm, VcmTechniques::Ppm] {
        assert_same(
            &format!("{techniques:?}"),
            &brightness(&with(&desc, techniques), VCM, 12, 64),
            &path,
            0.0,
        );
    }
}

/// A boundary between equal glasses is none to walks, but shadow rays stop there: no technique that needs one may have a
/// share of what lies across.
#[test]
fn connections_across_invisible_boundaries_have_no_share() {
    let glass = || Material::dielectric(1.5);
    let objects = vec![
        Object::new(sphere([0.0; 3], 2.0), glass()),
        Object::new(sphere([0.0; 3], 0.7), glass()),
        Object::new(sphere([0.0; 3], 0.4), grey(0.8)),
        lamp(sphere([0.0, 0.9, 0.95], 0.55), 3.0),
    ];
    let mut desc = scene_of(look([0.0, 0.0, 8.0], [0.0; 3], 5.0), 8, objects);
    desc.vcm.radius = Some(0.02);
    let path = brightness(&desc, PATH, 16, 100);
    for techniques in [VcmTechniques::Vcm, VcmTechniques::Bdpt] {
        let found = brightness(&with(&desc, techniques), VCM, 16, 100);
        // With such a share five sixths of the light are missing.
        let noise = path.standard_error().hypot(found.standard_error());
        assert!(
            noise < 0.02 * path.mean && (found.mean - path.mean).abs() < 4.0 * noise,
            "{techniques:?}: {found:?}"
        );
    }
}
