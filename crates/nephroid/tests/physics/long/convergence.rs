//! How errors fall with passes.

use nephroid::desc::{DirectLight, IntegratorKind, Render};
use nephroid::{Control, Film, Job, Layer, SceneDesc, Session};

use crate::agreement::arena;
use crate::support::*;

/// Films of passes that follow one another, added up: after 4, 8, 16, … passes.
fn after_doublings(desc: &SceneDesc, integrator: IntegratorKind, seed: u64, doublings: u32) -> Vec<Film> {
    let mut desc = desc.clone();
    desc.render = Render { integrator, seed, ..desc.render };
    let scene = compiled(&desc);
    let range = |passes: std::ops::Range<u64>| {
        let job = Job { passes, ..Job::new(&desc, scene.clone()).unwrap() };
        let mut session = Session::new(job, 1).unwrap();
        session.run(&mut |_| Control::Continue).unwrap();
        session.into_film()
    };
    let mut films = vec![range(0..4)];
    for k in 0..doublings {
        let mut film = range(4 << k..8 << k);
        film.merge(&films[k as usize]).unwrap();
        films.push(film);
    }
    films
}

/// What pixels should be, from two halves that tell its own noise.
struct Truth {
    mean: Vec<f64>,
    /// Mean over the pixels that count of variance over (truth² + 0.01).
    error: f64,
    counts: Vec<bool>,
}

fn luminances(film: &Film) -> Vec<f64> {
    film.beauty().into_iter().map(|p| color::luminance_f64(p.map(f64::from))).collect()
}

impl Truth {
    /// By that many passes twice, over the pixels of which caustics are less than `caustic`.
    fn new(desc: &SceneDesc, integrator: IntegratorKind, passes: u32, caustic: f64) -> Self {
        let scene = compiled(desc);
        let halves = [1001, 1002].map(|seed| film(desc, &scene, integrator, seed, passes));
        let [a, b] = [&halves[0], &halves[1]].map(luminances);
        let mean: Vec<f64> = a.iter().zip(&b).map(|(a, b)| 0.5 * (a + b)).collect();
        let layer = halves[0].layer(Layer::Caustic);
        let counts: Vec<bool> = layer
            .chunks_exact(3)
            .zip(&mean)
            .map(|(l, m)| color::luminance_f64([l[0], l[1], l[2]].map(f64::from)) <= caustic * m)
            .collect();
        let mut truth = Self { mean, error: 0.0, counts };
        // Of a mean of two, the variance is a quarter of their difference's square.
        truth.error = truth.average(|i| 0.25 * (a[i] - b[i]).powi(2));
        truth
    }

    fn average(&self, square: impl Fn(usize) -> f64) -> f64 {
        let all = (0..self.mean.len()).filter(|&i| self.counts[i]);
        let sum: f64 = all.map(|i| square(i) / (self.mean[i].powi(2) + 0.01)).sum();
        sum / self.counts.iter().filter(|c| **c).count() as f64
    }

    /// Mean squared error, relative, without the truth's own.
    fn mse(&self, film: &Film) -> f64 {
        let found = luminances(film);
        self.average(|i| (found[i] - self.mean[i]).powi(2)) - self.error
    }
}

/// Slope of the logarithms by least squares, with its standard error from the residuals.
fn slope(errors: &[f64]) -> (f64, f64) {
    let n = errors.len() as f64;
    let y: Vec<f64> = errors.iter().map(|e| e.log2()).collect();
    let (mx, my) = ((n - 1.0) / 2.0, y.iter().sum::<f64>() / n);
    let sxx: f64 = (0..errors.len()).map(|i| (i as f64 - mx).powi(2)).sum();
    let b = y.iter().enumerate().map(|(i, y)| (i as f64 - mx) * (y - my)).sum::<f64>() / sxx;
    let rest: f64 = y.iter().enumerate().map(|(i, y)| (y - my - b * (i as f64 - mx)).powi(2)).sum();
    (b, (rest / (n - 2.0) / sxx).sqrt())
}

/// The slope of the mean error of four renders, over the last five films.
fn measured(what: &str, desc: &SceneDesc, integrator: IntegratorKind, truth: &Truth, doublings: u32) -> f64 {
    let mut errors = vec![0.0; doublings as usize + 1];
    for seed in 0..4 {
        for (sum, film) in errors.iter_mut().zip(after_doublings(desc, integrator, seed, doublings)) {
            *sum += truth.mse(&film) / 4.0;
        }
    }
    let (slope, noise) = slope(&errors[errors.len() - 5..]);
    let share = truth.counts.iter().filter(|c| **c).count() as f64 / truth.counts.len() as f64;
    println!(
        "{what}: slope {slope:.3} ± {noise:.3}, {:.0} % of the pixels, truth's error {:.2e}, errors {errors:.6?}",
        100.0 * share,
        truth.error
    );
    assert!(truth.error < 0.5 * errors[doublings as usize], "{what}: the truth is too noisy");
    slope
}

const SIZE: u32 = 48;

/// α = 2/3: variance falls as passes^−2/3, and so does the square of a bias that goes as the radius squared (Knaus &
/// Zwicker 2011, §5.2).
#[test]
fn pure_merging_falls_as_its_radii_say() {
    let mut desc = arena("box", SIZE);
    let truth = Truth::new(&desc, PATH, 1024, 1.0);
    desc.sppm.direct = DirectLight::Photons;
    let slope = measured("sppm, direct light by photons", &desc, IntegratorKind::Sppm, &truth, 8);
    assert!((slope + 0.65).abs() < 0.07, "{slope}");
}

/// Of independent passes it would be −1. Places in a pixel and the first two vertices of a path take numbers that fill
/// their squares evenly over the passes, by which errors fall faster where the integrand is smooth; by how much
/// depends on the scene.
const EVEN: std::ops::Range<f64> = -1.5..-0.9;

#[test]
fn path_tracing_falls_as_passes() {
    let desc = arena("box", SIZE);
    let truth = Truth::new(&desc, PATH, 2048, 1.0);
    let slope = measured("path", &desc, PATH, &truth, 6);
    assert!(EVEN.contains(&slope), "{slope}");
}

#[test]
fn auto_falls_as_passes_where_there_are_no_caustics() {
    let desc = arena("box-spheres", SIZE);
    let truth = Truth::new(&desc, IntegratorKind::Auto, 2048, 0.02);
    let slope = measured("auto", &desc, IntegratorKind::Auto, &truth, 6);
    assert!(EVEN.contains(&slope), "{slope}");
}
