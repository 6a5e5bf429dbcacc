//! Presets of materials in a furnace.
#![allow(clippy::unwrap_used)] // a test may

use bsdf::TransportMode;
use math::{Ray, Vec3};
use nephroid_scene as scene;
use sampling::{Domain, Sampler};

/// The greatest share of light over the lanes that a ray at a cosine gives back, with its standard error.
fn albedo(scene: &scene::Scene, cosine: f32) -> (f64, f64) {
    const SIDE: usize = 24;
    let sine = (1.0 - cosine * cosine).sqrt();
    let wo = Vec3::new(sine, cosine, 0.0);
    let hit = scene.intersect(&Ray::new(wo * 3.0, -wo)).expect("the sheet lies there");
    let bsdf = scene.bsdf(&hit, wo, 1.0, 0.0);
    let mut sampler = Sampler::new(3, 0, Domain::Other, 0);
    let mut sums = [[0.0; 2]; 3];
    for i in 0..SIDE * SIDE {
        let jitter = sampler.next_2d();
        let at = |k: usize, j: f32| ((k as f32 + j) / SIDE as f32).min(math::ONE_MINUS_EPSILON);
        let u_lobe = (i as f32 * 0.618_034 + jitter[0]).fract();
        let u = [at(i % SIDE, jitter[0]), at(i / SIDE, jitter[1])];
        let weight = bsdf.sample(wo, u_lobe, u, TransportMode::Importance).map(|s| s.weight.0.to_array());
        let weight = weight.unwrap_or_default();
        for (sum, w) in sums.iter_mut().zip(weight) {
            let w = f64::from(w);
            *sum = [sum[0] + w, sum[1] + w * w];
        }
    }
    let n = (SIDE * SIDE) as f64;
    let of = |[s, s2]: [f64; 2]| (s / n, ((s2 / n - (s / n) * (s / n)).max(0.0) / n).sqrt());
    sums.map(of).into_iter().fold((0.0, 0.0), |a, b| if b.0 > a.0 { b } else { a })
}

fn compiled(preset: &str) -> scene::Scene {
    let text = format!(
        "[camera]\nposition = [0, 1, 5]\nlook_at = [0, 1, 0]\n[[objects]]\nshape = \"quad\"\norigin = [-1, 0, 1]\nedge_u = [2, 0, 0]\nedge_v = [0, 0, -2]\nmaterial = {{ preset = \"{preset}\" }}\n"
    );
    let desc = scenefile::parse(&text, "scene.toml".as_ref(), &[]).desc.unwrap();
    scene::compile(&desc).expect("a sound scene").0
}

/// The tables of rough materials are exact to 1.5 %.
#[test]
fn no_preset_makes_light_and_none_is_black() {
    for preset in scenefile::presets() {
        let scene = compiled(preset.name);
        for cosine in [0.95, 0.5, 0.1] {
            let (mean, error) = albedo(&scene, cosine);
            assert!(mean < 1.015 + 4.0 * error, "{} at {cosine}: {mean} ± {error}", preset.name);
            assert!(mean > 0.004, "{} at {cosine}: {mean} ± {error}", preset.name);
        }
    }
}
