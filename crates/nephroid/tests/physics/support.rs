//! Scenes in a few words, renders as samples, and checks that show their own power.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use nephroid::desc::{self, Camera, Emission, IntegratorKind, Material, Object, Shape, Triple};
use nephroid::{Film, Job, Layer, Scene, SceneDesc, Session, compile};
use photons::{Photon, PhotonMap};
use testkit::{Moments, welch_p_value};
use transport::{PhotonBatch, PhotonJob, PhotonPaths, trace_photons};

/// Significance of one check. There are some 100 of them, with fixed seeds: a change of the random numbers fails one
/// for no reason with a probability of about 1 %.
pub const LEVEL: f64 = 1e-4;

/// The error that every check must find.
pub const PLANTED: f64 = 1.02;

pub const PATH: IntegratorKind = IntegratorKind::Path;
pub const PHOTON_MAP: IntegratorKind = IntegratorKind::PhotonMap;

/// Root of the repository.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// A description with a small square film, a box filter, a camera, and a photon map of little cost.
pub fn scene_of(camera: Camera, size: u32, objects: Vec<Object>) -> SceneDesc {
    let mut desc = SceneDesc::default();
    desc.film.size = [size; 2];
    desc.film.filter = desc::FilterKind::Box;
    desc.camera = Some(camera.into());
    desc.objects = objects.into_iter().map(Into::into).collect();
    desc.photon_map = desc::PhotonMap {
        photons: 20_000,
        caustic_photons: 20_000,
        knn: 50,
        caustic_knn: 40,
        final_gather: 4,
        ..desc::PhotonMap::default()
    };
    desc
}

/// A camera at `position`, `fov` degrees wide.
pub fn look(position: Triple, look_at: Triple, fov: f32) -> Camera {
    let along_y = position[0] == look_at[0] && position[2] == look_at[2];
    let up = if along_y { [0.0, 0.0, 1.0] } else { [0.0, 1.0, 0.0] };
    Camera { position, look_at, up, fov, ..Camera::default() }
}

pub fn sphere(center: Triple, radius: f32) -> Shape {
    Shape::Sphere { center, radius }
}

pub fn disk(center: Triple, normal: Triple, radius: f32) -> Shape {
    Shape::Disk { center, normal, radius }
}

/// Few photons and light paths in radii that do not shrink: the least that agrees with paths within a per cent, on films of 16
/// pixels a side.
pub fn small_maps(desc: &mut SceneDesc) {
    desc.photon_map.photons = 40_000;
    desc.photon_map.caustic_photons = 40_000;
    desc.sppm.photons = Some(16_000);
    desc.sppm.radius = Some(0.03);
    desc.sppm.alpha = 1.0;
    desc.vcm.light_paths = Some(512);
    desc.vcm.radius = Some(0.02);
    desc.vcm.alpha = 1.0;
}

/// A square of side `2·half` that faces up, at height `y`.
pub fn ground(y: f32, half: f32) -> Shape {
    let side = 2.0 * half;
    Shape::Quad { origin: [-half, y, half], edge_u: [side, 0.0, 0.0], edge_v: [0.0, 0.0, -side] }
}

pub fn grey(albedo: f32) -> Material {
    Material::diffuse(albedo)
}

pub fn lamp(shape: Shape, radiance: f32) -> Object {
    Object::lamp(shape, Emission::radiance([radiance; 3]))
}

/// The inside of a sphere about the origin that emits radiance 1 and reflects `albedo`.
pub fn furnace(radius: f32, albedo: f32) -> Object {
    let emission = Some(Emission::radiance([1.0; 3]).into());
    Object { emission, flip_normals: true, ..Object::new(sphere([0.0; 3], radius), grey(albedo)) }
}

pub fn compiled(desc: &SceneDesc) -> Arc<Scene> {
    compile(desc, 1).unwrap().scene
}

/// `desc` rendered by `integrator` on one thread (tests themselves run side by side).
pub fn film(
    desc: &SceneDesc,
    scene: &Arc<Scene>,
    integrator: IntegratorKind,
    seed: u64,
    passes: u32,
) -> Film {
    let mut desc = desc.clone();
    desc.render = desc::Render { integrator, seed, passes, ..desc.render };
    let mut session = Session::new(Job::new(&desc, scene.clone()).unwrap(), 1).unwrap();
    session.run(&mut |_| nephroid::Control::Continue).unwrap();
    let film = session.into_film();
    assert_eq!(film.nonfinite_count(), 0);
    film
}

/// `f` of `runs` renders that share nothing but the scene: samples of one distribution.
pub fn runs<T>(
    desc: &SceneDesc,
    integrator: IntegratorKind,
    runs: u64,
    passes: u32,
    f: impl Fn(&Film) -> T,
) -> Vec<T> {
    let scene = compiled(desc);
    (0..runs).map(|seed| f(&film(desc, &scene, integrator, seed, passes))).collect()
}

/// Mean of the picture over pixels and channels, in `runs` renders.
pub fn brightness(desc: &SceneDesc, integrator: IntegratorKind, n: u64, passes: u32) -> Moments {
    Moments::of(runs(desc, integrator, n, passes, |film| mean(film, Layer::Beauty)))
}

/// Mean of a layer over pixels and channels.
pub fn mean(film: &Film, layer: Layer) -> f64 {
    mean_where(film, layer, |_, _| true)
}

/// Mean of a layer of three channels over the pixels (column, row) that `keep` takes.
pub fn mean_where(film: &Film, layer: Layer, keep: impl Fn(usize, usize) -> bool) -> f64 {
    let values = film.layer(layer);
    let (mut sum, mut count) = (0.0, 0usize);
    for (i, pixel) in values.chunks_exact(3).enumerate() {
        if keep(i % film.width(), i / film.width()) {
            sum += pixel.iter().map(|&v| f64::from(v)).sum::<f64>();
            count += 3;
        }
    }
    sum / count as f64
}

/// Two-sided p-value of Student's test that the mean is `expected`, up to `tolerance` (absolute).
pub fn p_value(m: &Moments, expected: f64, tolerance: f64) -> f64 {
    let nearest = expected + (m.mean - expected).clamp(-tolerance, tolerance);
    if m.mean == nearest {
        return 1.0;
    }
    // Student's test is Welch's against a value known from so many samples that it does not vary.
    welch_p_value(m, &Moments { n: 1 << 40, mean: nearest, m2: 0.0 }).unwrap_or(0.0)
}

/// Fails unless the mean is `expected` within `tolerance` (relative: a bias that is owned up to) and statistics, and
/// unless the same test rejects 2 % more and 2 % less.
#[track_caller]
pub fn assert_mean(what: &str, m: &Moments, expected: f64, tolerance: f64) {
    let p = |factor: f64| p_value(m, expected * factor, expected.abs() * tolerance);
    assert!(
        p(1.0) >= LEVEL,
        "{what}: {:.6} ± {:.6} (n = {}), expected {expected:.6}: off by {:+.3} %, p = {:.1e}",
        m.mean,
        m.standard_error(),
        m.n,
        100.0 * (m.mean / expected - 1.0),
        p(1.0)
    );
    for factor in [PLANTED, 1.0 / PLANTED] {
        assert!(
            p(factor) < LEVEL,
            "{what}: blind to a factor of {factor:.3}: {:.6} ± {:.6}, expected {expected:.6}, p = {:.1e}",
            m.mean,
            m.standard_error(),
            p(factor)
        );
    }
}

/// Fails unless two samples have the same mean (Welch's test; `tolerance` as above), and unless the test rejects one
/// of them scaled by 2 % up and down.
#[track_caller]
pub fn assert_same(what: &str, a: &Moments, b: &Moments, tolerance: f64) {
    assert_same_within(what, a, b, tolerance, PLANTED);
}

/// [`assert_same`] with another error that it must find: for what one of the samples finds with much noise.
#[track_caller]
pub fn assert_same_within(what: &str, a: &Moments, b: &Moments, tolerance: f64, planted: f64) {
    let p = |factor: f64| {
        let scaled = Moments { n: a.n, mean: a.mean * factor, m2: a.m2 * factor * factor };
        let slack = tolerance * b.mean.abs();
        let mean = scaled.mean - (scaled.mean - b.mean).clamp(-slack, slack);
        if mean == b.mean { 1.0 } else { welch_p_value(&Moments { mean, ..scaled }, b).unwrap() }
    };
    let report = format!(
        "{:.6} ± {:.6} against {:.6} ± {:.6}: {:+.3} %, p = {:.1e}",
        a.mean,
        a.standard_error(),
        b.mean,
        b.standard_error(),
        100.0 * (a.mean / b.mean - 1.0),
        p(1.0)
    );
    assert!(p(1.0) >= LEVEL, "{what}: {report}");
    for factor in [planted, 1.0 / planted] {
        assert!(
            p(factor) < LEVEL,
            "{what}: blind to a factor of {factor:.3}: {report}, p = {:.1e}",
            p(factor)
        );
    }
}

/// A whole job of photons.
pub fn photons(scene: &Scene, paths: PhotonPaths, count: u64, seed: u64, max_depth: u32) -> PhotonBatch {
    trace_photons(scene, &PhotonJob { paths, count, seed, map_index: 0, max_depth }, 0..count)
}

/// Flux of the photons that `keep` takes in `n` independent jobs, W, mean of the channels.
pub fn flux(
    scene: &Scene,
    paths: PhotonPaths,
    count: u64,
    n: u64,
    max_depth: u32,
    keep: impl Fn(&Photon) -> bool,
) -> Moments {
    Moments::of((0..n).map(|seed| {
        let batch = photons(scene, paths, count, seed, max_depth);
        assert!(batch.nonfinite.is_empty());
        batch.photons.iter().filter(|p| keep(p)).map(|p| f64::from(p.power.mean())).sum()
    }))
}

/// The map of a job.
pub fn map(scene: &Scene, paths: PhotonPaths, count: u64, seed: u64, max_depth: u32) -> PhotonMap {
    PhotonMap::build(photons(scene, paths, count, seed, max_depth).photons)
}
