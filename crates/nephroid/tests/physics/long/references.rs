//! Every integrator on every scene of another renderer's pictures, block by block.

use nephroid::desc::{IntegratorKind, Render};
use nephroid::{Control, Job, RgbImage, Session};
use testkit::Moments;

use super::blocks::{assert_blocks, blocks};
use crate::agreement::{arena, mask, picture, reference};
use crate::support::*;

/// Standard error of a block of the references, of its radiance (README there, with some room for blocks that are darker
/// than most).
const ERROR: f64 = 0.0015;

/// Renders that share nothing but the scene.
const RUNS: u64 = 8;

struct Case {
    scene: &'static str,
    integrator: IntegratorKind,
    passes: u32,
    /// What blur may cost a block.
    bias: f64,
}

/// Where the passes of progressive integrators begin: radii have shrunk to a fifth of the first by then. Passes know of none
/// before them, so these are what a long render comes to. What discs lose at edges is a fifth, too.
const LATE: u64 = 1 << 14;

/// What is left of it in blocks with many edges: the first passes lose up to 3 % there.
const LATE_BIAS: f64 = 0.006;

fn check(case: &Case) {
    let mut desc = arena(case.scene, 256);
    desc.photon_map.final_gather = 4;
    desc.photon_map.photons = 400_000;
    desc.photon_map.caustic_photons = 400_000;
    let scene = compiled(&desc);
    let render = |seed: u64| {
        let mut desc = desc.clone();
        desc.render = Render { integrator: case.integrator, seed, ..desc.render };
        let passes = LATE..LATE + u64::from(case.passes);
        let mut session = Session::new(Job { passes, ..Job::new(&desc, scene.clone()).unwrap() }, 1).unwrap();
        session.run(&mut |_| Control::Continue).unwrap();
        picture(session.film())
    };
    judge(case, &(0..RUNS).map(render).collect::<Vec<_>>());
}

fn judge(case: &Case, renders: &[RgbImage]) {
    let mask = (case.scene == "globe").then(|| mask(case.scene));
    let what = format!("{:?} of {}", case.integrator, case.scene);
    assert_blocks(&what, renders, &reference(case.scene), mask.as_deref(), ERROR, case.bias);
}

#[test]
fn path_of_box() {
    check(&Case { scene: "box", integrator: PATH, passes: 8, bias: 0.0 });
}

#[test]
fn path_of_box_spheres() {
    check(&Case { scene: "box-spheres", integrator: PATH, passes: 48, bias: 0.0 });
}

/// Path tracing finds the lamp in its globe so rarely that only the whole picture can be judged.
#[test]
fn path_of_globe() {
    let renders = runs(&arena("globe", 128), PATH, RUNS, 96, picture);
    let (mask, reference) = (mask("globe"), reference("globe"));
    let mean = |p: &RgbImage| {
        let blocks = blocks(p, Some(&mask));
        blocks.means.iter().zip(&blocks.shares).map(|(m, s)| m * s).sum::<f64>()
            / blocks.shares.iter().sum::<f64>()
    };
    let found = Moments::of(renders.iter().map(mean));
    println!(
        "path of globe: {:.5} ± {:.5} against {:.5}",
        found.mean,
        found.standard_error(),
        mean(&reference)
    );
    assert_same_within(
        "path of globe",
        &found,
        &Moments { n: 1 << 40, mean: mean(&reference), m2: 0.0 },
        0.001,
        1.05,
    );
}

#[test]
fn auto_of_box() {
    check(&Case { scene: "box", integrator: IntegratorKind::Auto, passes: 8, bias: 0.0 });
}

#[test]
fn auto_of_box_spheres() {
    check(&Case { scene: "box-spheres", integrator: IntegratorKind::Auto, passes: 16, bias: LATE_BIAS });
}

#[test]
fn auto_of_globe() {
    check(&Case { scene: "globe", integrator: IntegratorKind::Auto, passes: 20, bias: LATE_BIAS });
}

#[test]
fn vcm_of_box() {
    check(&Case { scene: "box", integrator: IntegratorKind::Vcm, passes: 6, bias: LATE_BIAS });
}

#[test]
fn vcm_of_box_spheres() {
    check(&Case { scene: "box-spheres", integrator: IntegratorKind::Vcm, passes: 8, bias: LATE_BIAS });
}

#[test]
fn vcm_of_globe() {
    check(&Case { scene: "globe", integrator: IntegratorKind::Vcm, passes: 8, bias: LATE_BIAS });
}

/// Photon maps with k nearest neighbours own up to a bias of 2 % away from edges; blocks have edges.
const MAP_BIAS: f64 = 0.01;

#[test]
fn photon_map_of_box() {
    check(&Case { scene: "box", integrator: PHOTON_MAP, passes: 8, bias: MAP_BIAS });
}

#[test]
fn photon_map_of_box_spheres() {
    check(&Case { scene: "box-spheres", integrator: PHOTON_MAP, passes: 12, bias: MAP_BIAS });
}

#[test]
fn photon_map_of_globe() {
    check(&Case { scene: "globe", integrator: PHOTON_MAP, passes: 8, bias: MAP_BIAS });
}

/// What discs lose at edges goes as their radius, and what they blur as its square: renders of two constant radii,
/// extrapolated to none, have the second alone.
fn sppm(scene: &'static str, passes: u32) {
    let mut desc = arena(scene, 256);
    desc.sppm.alpha = 1.0;
    let mut at = |radius_pixels: f32| {
        desc.sppm.radius_pixels = radius_pixels;
        runs(&desc, IntegratorKind::Sppm, RUNS, passes, picture)
    };
    let (near, far) = (at(0.7), at(1.4));
    let extrapolate = |near: &RgbImage, far: &RgbImage| {
        let pixels = near.pixels().iter().zip(far.pixels());
        let pixels = pixels.map(|(n, f)| std::array::from_fn(|c| 2.0 * n[c] - f[c])).collect();
        RgbImage::new(near.width(), near.height(), pixels).unwrap()
    };
    let both: Vec<RgbImage> = near.iter().zip(&far).map(|(n, f)| extrapolate(n, f)).collect();
    judge(&Case { scene, integrator: IntegratorKind::Sppm, passes, bias: LATE_BIAS }, &both);
}

#[test]
fn sppm_of_box() {
    sppm("box", 16);
}

#[test]
fn sppm_of_box_spheres() {
    sppm("box-spheres", 16);
}

#[test]
fn sppm_of_globe() {
    sppm("globe", 16);
}
