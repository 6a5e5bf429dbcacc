//! Few lights: no noise comes of choosing among them.

use nephroid::desc::{IntegratorKind, Light, LightKind, Object, SunSky};

use crate::support::*;

/// A flat stone under the sun, the sky, or both.
fn stone(sun_scale: f32, sky_scale: f32) -> nephroid::SceneDesc {
    let objects = vec![Object::new(ground(0.0, 20.0), grey(0.6))];
    let mut desc = scene_of(look([0.0, 3.0, 4.0], [0.0; 3], 20.0), 16, objects);
    let sun_direction = [0.6, 1.2, -0.4];
    let kind = LightKind::SunSky(SunSky { sun_direction, sun_scale, sky_scale, ..SunSky::default() });
    desc.lights = vec![Light::from(kind).into()];
    desc
}

/// Mean of the pixels, and their variance.
fn of_pixels(desc: &nephroid::SceneDesc, integrator: IntegratorKind, passes: u32) -> [f64; 2] {
    let film = film(desc, &compiled(desc), integrator, 3, passes);
    let pixels: Vec<f64> =
        film.beauty().iter().map(|p| p.iter().map(|&v| f64::from(v)).sum::<f64>() / 3.0).collect();
    let n = pixels.len() as f64;
    let mean = pixels.iter().sum::<f64>() / n;
    [mean, pixels.iter().map(|p| (p - mean).powi(2)).sum::<f64>() / (n - 1.0)]
}

/// Pixels of a flat stone scatter as little as its sky alone makes them, where a choice between sun and sky for each pass, even the
/// best, would make them scatter far more.
#[test]
fn sun_and_sky_are_no_choice() {
    const PASSES: u32 = 16;
    for integrator in [PATH, IntegratorKind::Auto, IntegratorKind::Sppm] {
        let [sun, _] = of_pixels(&stone(1.0, 0.0), integrator, PASSES);
        let [sky, of_sky] = of_pixels(&stone(0.0, 1.0), integrator, PASSES);
        let [both, variance] = of_pixels(&stone(1.0, 1.0), integrator, PASSES);
        let name = integrator.name();
        assert!((both / (sun + sky) - 1.0).abs() < 0.01, "{name}: {both} for {sun} + {sky}");
        assert!(variance < 2.0 * of_sky + 1e-6 * both * both, "{name}: {variance} for {of_sky}");
        // Independent choices of probability p: sun²/p + sky²/(1 − p) − (sun + sky)² for each pass; with p = ½, as with p by
        // what each brings half the time and alike half the time, it is no less than a tenth of sun·sky.
        let chosen = 0.1 * sun * sky / f64::from(PASSES);
        assert!(5.0 * variance < chosen, "{name}: {variance} for {chosen}");
    }
}
