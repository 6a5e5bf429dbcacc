//! What the tests of the photon map share.
#![allow(dead_code)] // each test binary uses a part

use color::Lanes;
use math::Vec3;
use nephroid_photons::{Photon, PhotonFlags, PhotonMap, Query};
use proptest::prelude::ProptestConfig;
use proptest::test_runner::RngSeed;

/// So many cases of a property test, the same ones in every run.
pub fn cases(cases: u32) -> ProptestConfig {
    ProptestConfig {
        rng_seed: RngSeed::Fixed(7),
        failure_persistence: None,
        ..ProptestConfig::with_cases(cases)
    }
}

/// A photon that came straight down on its surface.
pub fn photon(position: Vec3, normal: Vec3, power: f32) -> Photon {
    let power = Lanes::splat(power);
    Photon { position, direction: normal, normal, power, depth: 0, flags: PhotonFlags::NONE }
}

/// Sorted slots that a fixed-radius gather shows.
pub fn slots(map: &PhotonMap, query: &Query) -> Vec<u32> {
    let mut slots = Vec::new();
    let count = map.gather(query, |p, _| slots.push(p.slot));
    assert_eq!(count, slots.len());
    slots.sort_unstable();
    slots
}

/// Whether independent `samples` have the mean `exact`: within 4.5 of their own standard errors (one chance in
/// 150 000 of a false alarm). Samples too noisy to tell an error of 2 % never agree.
pub fn agree(samples: &[f64], exact: f64) -> bool {
    let n = samples.len() as f64;
    let mean = samples.iter().sum::<f64>() / n;
    let variance = samples.iter().map(|s| (s - mean).powi(2)).sum::<f64>() / (n - 1.0);
    let error = (variance / n).sqrt();
    error < 0.0042 * exact && (mean - exact).abs() < 4.5 * error
}

/// The samples agree with `exact`, and would not if they were 2 % brighter or darker.
pub fn assert_agree(samples: &[f64], exact: f64, what: &str) {
    let mean = samples.iter().sum::<f64>() / samples.len() as f64;
    assert!(agree(samples, exact), "{what}: mean {mean}, exact {exact}");
    for planted in [0.98, 1.02] {
        let wrong: Vec<f64> = samples.iter().map(|s| s * planted).collect();
        assert!(!agree(&wrong, exact), "{what}: a planted error ×{planted} passes");
    }
}
