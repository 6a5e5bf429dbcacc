//! Lights: samplers against their densities (here), powers against fluxes, closed forms of irradiance (`flux`).

#[path = "lights/cases.rs"]
mod cases;
#[path = "lights/flux.rs"]
mod flux;

use std::f64::consts::PI;

use math::{DVec3, Frame, Vec3};
use nephroid_scene::light::{Light, LightHit, Sides};
use sampling::{Domain, Sampler, warp};
use testkit::{Rect, Settings, chi2_p_value, chi2_rect, chi2_sphere, z_p_value};

use cases::*;

#[test]
fn li_follows_its_density() {
    let origin = Vec3::new(0.2, -1.0, 0.3);
    let around = Vec3::new(0.48, -0.6, 0.64);
    let unit = |sides| sphere(Vec3::ZERO, 1.0, sides);
    let mut tests: Vec<(Case, Vec3)> = vec![
        (patterned(unit(Sides::Back), "patterned shell"), around * 0.7),
        (unit(Sides::Front), around * 1.01),
        (unit(Sides::Front), around * 1.000_1),
        (unit(Sides::Front), around * 2e3),
        (unit(Sides::Both), around * 3.0),
        (unit(Sides::Both), around * 0.6),
        (unit(Sides::Back), around * 0.999),
        (disk(Sides::Both), Vec3::new(0.0, 1.9, 0.0)),
        (disk(Sides::Front), Vec3::new(-0.1, 1.0, 0.2)),
    ];
    tests.extend(
        cases()
            .into_iter()
            .filter(|c| !c.light.is_delta() && !["disk", "quad"].contains(&c.name))
            .map(|c| (c, origin)),
    );
    for (case, p) in tests {
        let light = &case.light;
        let hit = |w: Vec3| case.geometry.hit(p, w);
        let pdf = |w: Vec3| match hit(w) {
            None if !light.is_infinite() => 0.0,
            hit => f64::from(light.pdf_li_w(p, w, hit)),
        };
        let draw = |s: &mut Sampler| light.sample_li(p, Vec3::ZERO, s.next_1d(), s.next_2d());
        let result = chi2_sphere(&Settings::default(), |s| draw(s).map(|l| l.wi), pdf);
        assert_eq!(result.failures(level()), [""; 0], "{} from {p}: {result:?}", case.name);
        // Each draw ends where it says, with the density and radiance that a ray along it would meet.
        let mut differ = 0;
        for mut s in samples(1, 2000) {
            let Some(l) = draw(&mut s) else { continue };
            assert!(!l.is_delta && (l.wi.length() - 1.0).abs() < 1e-6);
            if light.is_infinite() {
                assert!(l.distance == f32::INFINITY && light.escaped(l.wi) == l.radiance);
                continue;
            }
            assert!(l.n.dot(l.wi) < 1e-3 && (l.n.length() - 1.0).abs() < 1e-5, "{} {l:?}", case.name);
            let found = hit(l.wi).map(|h| (pdf(l.wi), light.emitted(h.ng, -l.wi), h.p));
            // Along a silhouette a ray may miss by rounding, or the cosine have few digits.
            let same = found.is_some_and(|(pdf, le, q)| {
                let off = q.distance(l.p).max((p + l.wi * l.distance).distance(l.p));
                (pdf / f64::from(l.pdf_w) - 1.0).abs() < 1e-2 && le == l.radiance && off < 1e-3
            });
            differ += usize::from(!same);
        }
        assert!(differ <= 20, "{} from {p}: {differ} of 2000", case.name);
    }
}

#[test]
fn le_directions_follow_their_density() {
    let mut cases = cases();
    cases.push(spot(0.3, 0.3));
    cases.push(Case { name: "narrow spot", ..spot(0.0, 0.02) });
    cases.push(disk(Sides::Back));
    let targets = targets();
    let mut tested = 0;
    for case in cases.iter().filter(|c| !matches!(c.light, Light::Directional(_))) {
        for (position, (u_pick, u_pos)) in [(0.2, [0.3, 0.6]), (0.9, [0.8, 0.1])].into_iter().enumerate() {
            let own = |s: &mut Sampler| case.light.sample_le(u_pick, u_pos, s.next_2d());
            let aimed = |s: &mut Sampler| case.light.sample_le_toward(&targets, u_pick, u_pos, s.next_2d());
            let first = samples(2, 100).find_map(|mut s| own(&mut s)).unwrap();
            let ng = case.front_normal(&first);
            if position == 0 {
                let start = LightHit { p: first.p, ng, prim: first.prim };
                let density = |w| f64::from(case.light.pdf_le(&start, w).1);
                let result = chi2_sphere(&Settings::default(), |s| own(s).map(|l| l.w), density);
                assert_eq!(result.failures(level()), [""; 0], "{} own: {result:?}", case.name);
                assert!((result.integral - 1.0).abs() < 1e-3);
            }
            // The grid does not resolve the narrow spot.
            let dark = samples(2, 1000).all(|mut s| aimed(&mut s).is_none());
            if dark || case.light.is_infinite() || case.name == "narrow spot" {
                continue;
            }
            tested += 1;
            let start = LightHit { p: first.p, ng, prim: first.prim };
            let density = |w| f64::from(case.light.pdf_le_toward(&targets, &start, w).1);
            let p = compare_directions(|s| aimed(s).map(|l| l.w), density);
            assert!(p > level(), "{} aimed: p = {p:.1e}", case.name);
            let p = compare_directions(|s| aimed(s).map(|l| l.w), |w| 1.02 * density(w));
            assert!(p < level(), "{} aimed: 2 % unseen, p = {p:.1e}", case.name);
        }
    }
    assert!(tested >= 12, "{tested}");
}

/// χ² over 16 × 16 cells of equal solid angle of the counts of `draw` and an estimate of ∫`pdf_w` from directions
/// uniform over the sphere, and a z-test of the two sums; the lesser p-value. Fit for densities with many edges.
fn compare_directions(draw: impl Fn(&mut Sampler) -> Option<Vec3>, pdf_w: impl Fn(Vec3) -> f64) -> f64 {
    let cell = |w: Vec3| {
        let (z, phi) = (f64::from(w.z).clamp(-1.0, 1.0), f64::from(w.y).atan2(f64::from(w.x)));
        let index = |x: f64| ((x * 16.0) as usize).min(15);
        16 * index(0.5 + 0.5 * z) + index(0.5 + 0.5 * phi / PI)
    };
    let (n, grid) = (1 << 17, 512);
    let mut s = Sampler::new(11, 80, Domain::Other, 0);
    let (mut counts, mut sums, mut squares) = ([0.0; 256], [0.0; 256], [0.0; 256]);
    (0..n).filter_map(|_| draw(&mut s)).for_each(|w| counts[cell(w)] += 1.0 / f64::from(n));
    for i in 0..grid * grid {
        // Jittered; the variance over a cell's points bounds the estimate's from above.
        let [a, b] = s.next_2d();
        let u = [((i % grid) as f32 + a) / grid as f32, ((i / grid) as f32 + b) / grid as f32];
        let w = warp::sphere(u.map(|x| x.min(math::ONE_MINUS_EPSILON)));
        let x = 4.0 * PI * pdf_w(w) / f64::from(grid * grid);
        sums[cell(w)] += x;
        squares[cell(w)] += x * x;
    }
    let per_cell = f64::from(grid * grid) / 256.0;
    let (mut chi2, mut dof) = (0.0, 0);
    for i in 0..256 {
        let variance = sums[i] / f64::from(n) + (squares[i] - sums[i] * sums[i] / per_cell).max(0.0);
        if sums[i] * f64::from(n) > 20.0 {
            chi2 += (counts[i] - sums[i]).powi(2) / variance;
            dof += 1;
        }
    }
    let [share, integral]: [f64; 2] = [counts.iter().sum(), sums.iter().sum()];
    // Edges cross few of the grid's squares, so that its sum is good to a thousandth.
    let deviation = (share * (1.0 - share) / f64::from(n)).sqrt();
    let z = ((share - integral).abs() - 1e-3 * integral).max(0.0) / deviation;
    chi2_p_value(chi2, dof).min(z_p_value(z))
}

/// Coordinates in which area on a light (or on the plane before the scene) is proportional to area of a rectangle.
enum Sheet {
    Plane(Vec3, Frame),
    Sphere(Vec3, f32),
}

impl Sheet {
    fn coordinates(&self, p: Vec3) -> [f64; 2] {
        match self {
            Self::Plane(o, f) => {
                let q = f.to_local(p - *o);
                [f64::from(q.x), f64::from(q.y)]
            }
            Self::Sphere(c, r) => {
                let q = (p - *c).as_dvec3();
                [q.z, f64::from(*r) * q.y.atan2(q.x)]
            }
        }
    }

    fn point(&self, [x, y]: [f64; 2]) -> Vec3 {
        match self {
            Self::Plane(o, f) => *o + f.x * x as f32 + f.y * y as f32,
            Self::Sphere(c, r) => {
                let z = x / f64::from(*r);
                let (phi, s) = (y / f64::from(*r), (1.0 - z * z).max(0.0).sqrt());
                *c + *r * DVec3::new(s * phi.cos(), s * phi.sin(), z).as_vec3()
            }
        }
    }

    fn domain(&self) -> Rect {
        match self {
            Self::Plane(..) => Rect { min: [-4.0; 2], max: [4.0; 2] },
            Self::Sphere(_, r) => {
                let r = f64::from(*r);
                Rect { min: [-r, -PI * r], max: [r, PI * r] }
            }
        }
    }
}

#[test]
fn le_positions_follow_their_density() {
    let targets = targets();
    let u_dir = [0.37, 0.81];
    let mut first_disk = true;
    for case in cases() {
        let light = &case.light;
        if case.name == "disk" && !std::mem::take(&mut first_disk) {
            continue;
        }
        let draw = |s: &mut Sampler| light.sample_le(s.next_1d(), s.next_2d(), u_dir);
        let aimed = |s: &mut Sampler| light.sample_le_toward(&targets, s.next_1d(), s.next_2d(), u_dir);
        let first = samples(3, 100).find_map(|mut s| draw(&mut s)).unwrap();
        let sheet = match (&case.geometry, light) {
            (Geometry::Sphere(c, r), _) => Sheet::Sphere(c.as_vec3(), *r as f32),
            (Geometry::Disk(c, n, _), _) => Sheet::Plane(c.as_vec3(), Frame::from_z(n.as_vec3())),
            (Geometry::Triangles(_), _) if case.name.ends_with("quad") => {
                Sheet::Plane(first.p, Frame::from_z(first.n))
            }
            (
                Geometry::Nothing,
                Light::Directional(_) | Light::Environment(_) | Light::Sky(_) | Light::Sun(_),
            ) => Sheet::Plane(-3.0 * first.w, Frame::from_z(first.w)),
            _ => continue,
        };
        // A ray from well before the sheet along its normal meets it where it meets the light.
        let density = |c: [f64; 2]| {
            let p = sheet.point(c);
            let start = match (&sheet, &case.geometry) {
                (Sheet::Plane(_, f), Geometry::Disk(..) | Geometry::Triangles(_)) => {
                    case.geometry.hit(p - f.z, f.z).map(|hit| LightHit { ng: first.n, ..hit })
                }
                _ => Some(LightHit { p, ng: first.n, prim: 0 }),
            };
            start.map_or(0.0, |start| f64::from(light.pdf_le(&start, first.w).0))
        };
        let settings = Settings::default();
        let result =
            chi2_rect(&settings, sheet.domain(), |s| draw(s).map(|l| sheet.coordinates(l.p)), density);
        assert_eq!(result.failures(level()), [""; 0], "{}: {result:?}", case.name);
        if light.is_infinite() {
            let first = samples(3, 100).find_map(|mut s| aimed(&mut s)).unwrap();
            let density = |c| {
                let start = LightHit { p: sheet.point(c), ng: first.n, prim: 0 };
                f64::from(light.pdf_le_toward(&targets, &start, first.w).0)
            };
            let result =
                chi2_rect(&settings, sheet.domain(), |s| aimed(s).map(|l| sheet.coordinates(l.p)), density);
            assert_eq!(result.failures(level()), [""; 0], "{} aimed: {result:?}", case.name);
        }
    }
    // A mesh: triangles in proportion to area.
    let case = mesh();
    let Geometry::Triangles(triangles) = &case.geometry else { panic!() };
    let mut counts = [0.0; 3];
    for mut s in samples(4, 100_000) {
        let u = s.next_1d();
        let l = case.light.sample_le(u, s.next_2d(), s.next_2d()).unwrap();
        counts[l.prim as usize] += 1.0;
        assert!(case.geometry.hit(l.p + 0.1 * l.n, -l.n).is_none_or(|h| h.prim == l.prim));
    }
    let areas = triangles.iter().map(|t| f64::from(0.5 * (t[1] - t[0]).cross(t[2] - t[0]).length()));
    let total: f64 = areas.clone().sum();
    let expected: Vec<f64> = areas.map(|a| a / total * 1e5).collect();
    assert!(testkit::chi2_counts(&counts, &expected).2 > level(), "{counts:?} {expected:?}");
}

#[test]
fn every_draw_knows_its_density() {
    let targets = targets();
    for case in cases() {
        let (mut drawn, mut differ) = (0, 0);
        for mut s in samples(5, 20_000) {
            let [(a, b), c] = [(s.next_1d(), s.next_2d()), (s.next_1d(), s.next_2d())];
            for aim in [false, true] {
                let l = if aim {
                    case.light.sample_le_toward(&targets, a, b, c.1)
                } else {
                    case.light.sample_le(a, b, c.1)
                };
                let Some(l) = l else { continue };
                assert!(l.cos > 0.0 && (l.w.length() - 1.0).abs() < 1e-6);
                assert!(l.n == Vec3::ZERO || (l.n.dot(l.w) - l.cos).abs() < 1e-6);
                let ng = case.front_normal(&l);
                let start = LightHit { p: l.p, ng, prim: l.prim };
                let (pdf_a, pdf_w) = if aim {
                    case.light.pdf_le_toward(&targets, &start, l.w)
                } else {
                    case.light.pdf_le(&start, l.w)
                };
                let close = |a: f32, b: f32| (a - b).abs() <= 1e-3 * b;
                drawn += 1;
                differ += usize::from(!close(pdf_a, l.pdf_a) || !close(pdf_w, l.pdf_w));
            }
        }
        // On the edge of a cone or box the two may disagree by rounding.
        assert!(drawn > 10_000 && differ * 1000 < drawn, "{}: {differ} of {drawn}", case.name);
    }
}
