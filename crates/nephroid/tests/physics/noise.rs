//! The noise layer: whether the standard error that a film reports covers what its pixels are off by.

use nephroid::desc::IntegratorKind;

use crate::agreement::arena;
use crate::support::*;

/// Two films of one scene differ by no more than both say, and do differ. Passes count as independent, which they are not quite:
/// places in a pixel and the first scatterings fill their squares evenly, so films are better than they say. Of a normal
/// distribution, 95.4 % lie within twice the standard error; errors found from so many passes take a little off it.
#[test]
fn the_standard_error_covers_the_difference_of_two_films() {
    let desc = arena("box-spheres", 48);
    for integrator in [PATH, IntegratorKind::Auto, IntegratorKind::Sppm, IntegratorKind::Vcm] {
        let scene = compiled(&desc);
        let films = [1, 2].map(|seed| {
            let film = film(&desc, &scene, integrator, seed, 48);
            let luminance = film.beauty().into_iter().map(|p| color::luminance_f64(p.map(f64::from)));
            luminance.zip(film.noise().unwrap()).collect::<Vec<_>>()
        });
        // In units of the reported error.
        let differences = films[0].iter().zip(&films[1]).filter_map(|((a, da), (b, db))| {
            let error = f64::from(*da).hypot(f64::from(*db));
            (error > 0.0).then(|| (a - b).abs() / error)
        });
        let z: Vec<f64> = differences.collect();
        let within = |bound: f64| z.iter().filter(|z| **z < bound).count() as f64 / z.len() as f64;
        assert!(z.len() as f64 > 0.95 * films[0].len() as f64, "pixels without noise are those of the lamp");
        // A film that says half of its error has within(1) of its pixels within 2; one that says twice, within(2) within 1.
        const SURE: f64 = 0.93;
        const UNSURE: f64 = 0.87;
        assert!(within(2.0) > SURE, "{integrator:?}: too sure of itself: {}", within(2.0));
        assert!(within(1.0) < UNSURE, "{integrator:?}: not sure enough: {}", within(1.0));
        assert!(within(1.0) < SURE && within(2.0) > UNSURE, "{integrator:?}: blind to a factor of 2");
    }
}
