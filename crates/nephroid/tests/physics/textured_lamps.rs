//! Lamps with textures.

use nephroid::desc::{Emission, EmissionAmount, IntegratorKind, Material, Object, Shape, Texture};
use nephroid::{Scene, SceneDesc, compile};
use transport::PhotonPaths;

use crate::support::*;

const FACTORS: [[f32; 3]; 2] = [[2.0, 1.0, 0.2], [0.1, 0.2, 0.4]];

fn glowing(shape: Shape, amount: EmissionAmount) -> Object {
    let texture = Some("pattern".to_owned().into());
    Object::lamp(shape, Emission { texture, two_sided: false, amount })
}

fn with_pattern(mut desc: SceneDesc, scale: f32) -> SceneDesc {
    let [a, b] = FACTORS;
    desc.textures.insert("pattern".into(), Texture::checker(a, b, [scale; 2]).into());
    desc
}

fn ceiling() -> Shape {
    Shape::Quad { origin: [-0.6, 0.9, -0.6], edge_u: [1.2, 0.0, 0.0], edge_v: [0.0, 0.0, 1.2] }
}

fn shapes() -> [(&'static str, Shape); 3] {
    [
        ("quad", ceiling()),
        ("disk", disk([0.0, 0.9, 0.0], [0.0, -1.0, 0.0], 0.7)),
        ("sphere", sphere([0.0, 0.6, 0.0], 0.3)),
    ]
}

/// The camera sees the texture itself, in its colours: the mean over whole periods is the mean of its squares.
#[test]
fn a_screen_shows_its_texture() {
    let screen = Shape::Quad { origin: [-1.0, -1.0, 0.0], edge_u: [2.0, 0.0, 0.0], edge_v: [0.0, 2.0, 0.0] };
    let fov = 2.0 * 0.5f32.atan().to_degrees();
    let desc = scene_of(
        look([0.0, 0.0, 2.0], [0.0; 3], fov),
        8,
        vec![glowing(screen, EmissionAmount::Radiance([3.0; 3]))],
    );
    // Pixels are squares of the checker.
    let desc = with_pattern(desc, 4.0);
    let scene = compiled(&desc);
    let picture = film(&desc, &scene, PATH, 1, 4);
    for (i, pixel) in picture.layer(nephroid::Layer::Beauty).chunks_exact(3).enumerate() {
        // The topmost row lies at v near 1: with eight squares to a side the first there is odd.
        let expected = FACTORS[(i % 8 + i / 8 + 1) % 2].map(|x| 3.0 * x);
        for c in 0..3 {
            assert!((pixel[c] - expected[c]).abs() < 1e-3, "{i}: {pixel:?} {expected:?}");
        }
    }
}

fn deposits(scene: &Scene) -> testkit::Moments {
    flux(scene, PhotonPaths::Global, 20_000, 12, 1, |_| true)
}

/// In a closed box all that a lamp of a given power sends out lands once.
#[test]
fn photons_of_a_textured_lamp_carry_its_power() {
    for (name, shape) in shapes() {
        let room = Object {
            flip_normals: true,
            ..Object::new(Shape::Box { min: [-1.0; 3], max: [1.0; 3] }, grey(0.5))
        };
        let lamp = glowing(shape, EmissionAmount::Power { watts: 7.0, color: [1.0, 0.5, 2.0] });
        let desc = scene_of(look([0.0, -0.5, 0.0], [0.5, 0.0, 0.0], 60.0), 4, vec![room, lamp]);
        let scene = compiled(&with_pattern(desc, 3.0));
        let power = f64::from(scene.power().mean());
        assert!((power - 7.0).abs() < 1e-3, "{name}: {power}");
        // The power is an integral over cells; a sphere's or disc's edges and squares are not aligned with them.
        assert_mean(name, &deposits(&scene), 7.0, 0.003);
    }
}

/// Found by rays, by light sampling and by photons.
#[test]
fn textured_lamps_agree_with_path() {
    for (name, shape) in shapes() {
        let ball = |x: f32, material: Material| Object::new(sphere([x, -0.6, 0.0], 0.4), material);
        let objects = vec![
            Object::new(ground(-1.0, 1.5), grey(0.5)),
            ball(-0.9, Material::conductor("gold", 0.4)),
            ball(0.0, grey(0.7)),
            ball(0.9, Material::plastic(0.5, 0.4)),
            glowing(shape, EmissionAmount::Radiance([5.0; 3])),
        ];
        let desc = scene_of(look([0.0, 0.4, 2.9], [0.0, -0.6, 0.0], 50.0), 16, objects);
        let mut desc = with_pattern(desc, 1.5);
        small_maps(&mut desc);
        let path = brightness(&desc, PATH, 12, 64);
        let others = [IntegratorKind::Sppm, IntegratorKind::Vcm, PHOTON_MAP, IntegratorKind::Auto];
        for integrator in others.into_iter().take(if name == "quad" { 4 } else { 1 }) {
            let found = brightness(&desc, integrator, 12, 40);
            assert_same_within(&format!("{name} {}", integrator.name()), &found, &path, 0.01, 1.06);
        }
    }
}

/// A small bright spot on a large dark lamp: light sampling finds it.
#[test]
fn a_bright_spot_is_sampled() {
    let mut pixels = vec![[0.0f32; 3]; 64 * 64];
    pixels[20 * 64 + 37] = [1000.0; 3];
    let path = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("spot.exr");
    std::fs::write(&path, ::film::encode_exr_rgb(64, 64, &pixels, &[]).unwrap()).unwrap();
    let objects = vec![
        Object::new(ground(-1.0, 1.5), grey(0.5)),
        glowing(ceiling(), EmissionAmount::Radiance([1.0; 3])),
    ];
    let mut desc = scene_of(look([0.0, 0.4, 2.9], [0.0, -0.6, 0.0], 50.0), 16, objects);
    desc.textures.insert("pattern".into(), Texture::image(path).into());
    desc.render.max_depth = Some(1);
    let error = |desc: &SceneDesc| {
        let m = brightness(desc, PATH, 16, 4);
        m.standard_error() / m.mean
    };
    let textured = error(&desc);
    // A lamp of the spot's size without a texture has as little noise, up to a tenth and the spread of the estimate; evenly drawn
    // points would miss the spot 4095 times out of 4096.
    assert!(textured < 0.02, "{textured}");
    assert!(compile(&desc, 1).is_ok());
}
