use sampling::Discrete;

use super::Light;
use crate::target::Targets;

/// Chooses a light; the probabilities are exact, so any choice leaves estimates unbiased.
#[derive(Clone, Debug, Default)]
pub struct LightPicker {
    picks: Discrete,
}

/// Samples per light from which the power toward targets is estimated, and of all lights about as many at most.
const ESTIMATE_SAMPLES: usize = 512;
const ESTIMATE_SAMPLES_OF_ALL: usize = 1 << 18;
const LEAST_ESTIMATE_SAMPLES: usize = 32;

impl LightPicker {
    /// For direct light from lights at infinity: ½ by power, ½ uniform over those that have any; no other light.
    pub fn far(lights: &[Light]) -> Self {
        let power = |light: &Light| if light.is_infinite() { f64::from(light.power().mean()) } else { 0.0 };
        let weights: Vec<f64> = lights.iter().map(power).collect();
        let seen: Vec<bool> = weights.iter().map(|&w| w > 0.0).collect();
        Self::mixed(&weights, &seen)
    }

    /// For photons of the global map: by power, so that all carry like flux.
    pub fn photons(lights: &[Light]) -> Self {
        Self { picks: Discrete::new(powers(lights)) }
    }

    /// For caustic photons: ½ by the power that [`Light::sample_le_toward`] sends to the targets' boxes (estimated
    /// from a fixed low-discrepancy set), ½ uniform over the lights that may reach a target
    /// ([`Light::may_reach`]): however dim, each of them has at least 1/(2·lights) of the photons.
    pub fn caustics(lights: &[Light], targets: &Targets) -> Self {
        let lit: Vec<bool> = lights.iter().map(|l| !l.power().is_zero() && l.may_reach(targets)).collect();
        let samples =
            (ESTIMATE_SAMPLES_OF_ALL / lights.len().max(1)).clamp(LEAST_ESTIMATE_SAMPLES, ESTIMATE_SAMPLES);
        let estimate = |(l, &lit): (&Light, &bool)| if lit { power_toward(l, targets, samples) } else { 0.0 };
        let sent: Vec<f64> = lights.iter().zip(&lit).map(estimate).collect();
        Self::mixed(&sent, &lit)
    }

    fn mixed(weights: &[f64], lit: &[bool]) -> Self {
        let total: f64 = weights.iter().sum();
        let count = lit.iter().filter(|&&l| l).count() as f64;
        // Where no light is of use all weights are 0, and `Discrete` draws them alike.
        let share = |(&w, &lit): (&f64, &bool)| {
            let by_weight = if total > 0.0 { w / total } else { 0.0 };
            if lit { by_weight + 1.0 / count } else { 0.0 }
        };
        Self { picks: Discrete::new(weights.iter().zip(lit).map(share)) }
    }

    /// Number of lights.
    pub fn len(&self) -> usize {
        self.picks.len()
    }

    /// Whether there is no light.
    pub fn is_empty(&self) -> bool {
        self.picks.is_empty()
    }

    /// Index of a light for `u` in [0, 1), its probability, and `u` mapped back to [0, 1) for reuse. Where there is
    /// no light the probability is 0.
    #[inline]
    pub fn sample(&self, u: f32) -> (usize, f32, f32) {
        self.picks.sample(u)
    }

    /// Probability of a light.
    #[inline]
    pub fn pmf(&self, light: usize) -> f32 {
        self.picks.pmf(light)
    }
}

fn powers(lights: &[Light]) -> Vec<f64> {
    lights.iter().map(|l| f64::from(l.power().mean())).collect()
}

/// Flux sent toward the targets, in watts (mean of the lanes).
fn power_toward(light: &Light, targets: &Targets, samples: usize) -> f64 {
    let mut sum = 0.0;
    for i in 0..samples as u32 {
        let u = kronecker(i);
        if let Some(s) = light.sample_le_toward(targets, u[0], [u[1], u[2]], [u[3], u[4]]) {
            sum += f64::from(light.radiance_about(&s).mean() * s.cos)
                / (f64::from(s.pdf_a) * f64::from(s.pdf_w));
        }
    }
    sum / samples as f64
}

/// Point `i` of the Kronecker sequence whose steps are the powers of 1/φ₅, φ₅⁶ = φ₅ + 1 (Roberts 2018).
fn kronecker(i: u32) -> [f32; 5] {
    const STEP: f64 = 1.0 / 1.134_724_138_401_519_5;
    std::array::from_fn(|k| {
        let x = (0.5 + f64::from(i) * STEP.powi(k as i32 + 1)).fract();
        (x as f32).min(math::ONE_MINUS_EPSILON)
    })
}
