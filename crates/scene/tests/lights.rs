//! Lights: samplers against their densities, powers against fluxes, closed forms of irradiance.

use std::f64::consts::PI;

use color::Lanes;
use math::{Bounds3, DVec3, Frame, Vec3};
use nephroid_scene::light::{
    DirectionalLight, DiskLight, EnvironmentLight, LeSample, Light, LightHit, LightPicker, PointLight, Sides,
    SphereLight, SpotLight, TriangleLight,
};
use nephroid_scene::target::{MAX_TARGETS, Target, Targets};
use sampling::{Domain, Sampler, warp};
use testkit::{Moments, Rect, Settings, chi2_p_value, chi2_rect, chi2_sphere, significance, z_p_value};

/// Level of one of the file's tests, of which there are fewer than 200.
fn level() -> f64 {
    significance(0.01, 200)
}

/// What a ray finds of a light, computed apart from the crate.
enum Geometry {
    Nothing,
    Sphere(DVec3, f64),
    Disk(DVec3, DVec3, f64),
    Triangles(Vec<[Vec3; 3]>),
}

struct Case {
    name: &'static str,
    light: Light,
    geometry: Geometry,
}

impl Case {
    /// Geometric normal of the front at the start of a path. Two-sided lights are disks here.
    fn front_normal(&self, l: &LeSample) -> Vec3 {
        match self.geometry {
            Geometry::Disk(_, n, _) => n.as_vec3(),
            _ => l.n,
        }
    }
}

impl Geometry {
    fn hit(&self, p: Vec3, w: Vec3) -> Option<LightHit> {
        let (o, d) = (p.as_dvec3(), w.as_dvec3());
        let hit = |t: f64, ng: DVec3, prim: usize| LightHit {
            p: (o + d * t).as_vec3(),
            ng: ng.as_vec3(),
            prim: prim as u32,
        };
        match self {
            Self::Nothing => None,
            Self::Sphere(c, r) => {
                let (b, gap) = (d.dot(o - c), (o - c).length_squared() - r * r);
                let root = (b * b - d.length_squared() * gap).max(-1.0);
                let t = [-b - root.sqrt(), -b + root.sqrt()].map(|t| t / d.length_squared());
                let t = t.into_iter().find(|t| *t > 1e-6)?;
                Some(hit(t, (o + d * t - c).normalize(), 0))
            }
            Self::Disk(c, n, r) => {
                let t = (c - o).dot(*n) / d.dot(*n);
                (t > 0.0 && (o + d * t).distance(*c) < *r).then(|| hit(t, *n, 0))
            }
            Self::Triangles(triangles) => triangles.iter().enumerate().find_map(|(i, t)| {
                let v = t.map(|v| v.as_dvec3());
                let n = (v[1] - v[0]).cross(v[2] - v[0]);
                let t = (v[0] - o).dot(n) / d.dot(n);
                let q = o + d * t;
                let side = |a: DVec3, b: DVec3| (b - a).cross(q - a).dot(n) > 0.0;
                let inside = t > 0.0 && side(v[0], v[1]) && side(v[1], v[2]) && side(v[2], v[0]);
                inside.then(|| hit(t, n.normalize(), i))
            }),
        }
    }
}

fn scene_bounds() -> Bounds3 {
    Bounds3 { min: Vec3::splat(-2.0), max: Vec3::splat(2.0) }
}

fn lanes(x: f32) -> Lanes {
    Lanes::rgb(x, 0.5 * x, 2.0 * x)
}

fn sphere(center: Vec3, radius: f32, sides: Sides) -> Case {
    let light = Light::Sphere(SphereLight::new(center, radius, lanes(2.0), sides).unwrap());
    Case { name: "sphere", light, geometry: Geometry::Sphere(center.as_dvec3(), f64::from(radius)) }
}

fn disk(sides: Sides) -> Case {
    let (c, n, r) = (Vec3::new(-0.2, 1.5, 0.1), Vec3::new(0.36, -0.8, 0.48), 0.5);
    let light = Light::Disk(DiskLight::new(c, n, r, lanes(1.5), sides).unwrap());
    Case { name: "disk", light, geometry: Geometry::Disk(c.as_dvec3(), n.as_dvec3(), f64::from(r)) }
}

fn mesh() -> Case {
    // Three unequal triangles whose shadows on any receiver below do not overlap.
    let v = |x, y, z| Vec3::new(x, y, z);
    let triangles = vec![
        [v(-0.8, 1.5, -0.5), v(0.4, 1.5, -0.5), v(-0.8, 1.4, 0.9)],
        [v(0.5, 1.6, -0.5), v(1.1, 1.7, -0.5), v(0.8, 1.6, 0.2)],
        [v(0.3, 1.5, 0.6), v(0.6, 1.5, 0.6), v(0.3, 1.5, 0.9)],
    ];
    let light = TriangleLight::new(triangles.clone(), lanes(3.0), Sides::Front).unwrap();
    Case { name: "mesh", light: Light::Triangles(light), geometry: Geometry::Triangles(triangles) }
}

fn quad() -> Case {
    let (o, u, w) = (Vec3::new(-0.4, 1.7, -0.6), Vec3::new(0.9, 0.1, 0.0), Vec3::new(0.2, 0.0, 0.8));
    let light = TriangleLight::quad(o, u, w, lanes(1.0), Sides::Front).unwrap();
    let triangles = vec![[o, o + u, o + u + w], [o, o + u + w, o + w]];
    Case { name: "quad", light: Light::Triangles(light), geometry: Geometry::Triangles(triangles) }
}

fn spot(inner: f32, outer: f32) -> Case {
    let axis = Vec3::new(0.5, -1.5, 0.2);
    let light = SpotLight::new(Vec3::new(0.1, 1.7, 0.2), axis, lanes(4.0), inner, outer).unwrap();
    Case { name: "spot", light: Light::Spot(light), geometry: Geometry::Nothing }
}

/// One of each, above the targets.
fn cases() -> Vec<Case> {
    let nothing = |name, light| Case { name, light, geometry: Geometry::Nothing };
    let mut cases = vec![
        nothing("point", Light::Point(PointLight::new(Vec3::new(0.3, 1.4, -0.2), lanes(2.0)).unwrap())),
        spot(0.35, 0.8),
        nothing(
            "directional",
            Light::Directional(DirectionalLight::new(Vec3::new(0.3, -1.0, 0.2), lanes(3.0)).unwrap()),
        ),
        nothing("environment", Light::Environment(EnvironmentLight::new(lanes(0.7)).unwrap())),
        sphere(Vec3::new(0.0, 1.4, 0.0), 0.4, Sides::Front),
        disk(Sides::Front),
        disk(Sides::Both),
        quad(),
        mesh(),
    ];
    cases.iter_mut().for_each(|c| c.light.preprocess(scene_bounds()));
    cases
}

/// Two overlapping spheres and a flat box.
fn targets() -> Targets {
    let ball = |c: Vec3, r: f32, weight| Target {
        bounds: Bounds3 { min: c - Vec3::splat(r), max: c + Vec3::splat(r) },
        center: c,
        radius: r,
        weight,
    };
    let slab = Bounds3 { min: Vec3::new(-1.9, -1.9, -1.5), max: Vec3::new(-0.9, -1.9, 0.5) };
    Targets::new(vec![
        ball(Vec3::new(0.6, -0.7, 0.3), 1.1, 1.0),
        ball(Vec3::new(-0.4, -1.0, 0.9), 0.8, 0.3),
        Target::from_bounds(slab, 0.05),
    ])
}

fn samples(key: u64, n: u64) -> impl Iterator<Item = Sampler> {
    (0..n).map(move |i| Sampler::new(11, key, Domain::Other, i))
}

fn flux(s: &LeSample) -> f64 {
    f64::from(s.radiance.0.x * s.cos) / (f64::from(s.pdf_a) * f64::from(s.pdf_w))
}

#[track_caller]
fn assert_close(a: f64, b: f64, relative: f64) {
    assert!((a - b).abs() <= relative * b.abs(), "{a} {b}");
}

#[test]
fn li_follows_its_density() {
    let origin = Vec3::new(0.2, -1.0, 0.3);
    let around = Vec3::new(0.48, -0.6, 0.64);
    let unit = |sides| sphere(Vec3::ZERO, 1.0, sides);
    let mut tests: Vec<(Case, Vec3)> = vec![
        (unit(Sides::Front), around * 1.01),
        (unit(Sides::Front), around * 1.000_1),
        (unit(Sides::Front), around * 2e3),
        (unit(Sides::Both), around * 3.0),
        (unit(Sides::Both), around * 0.6),
        (unit(Sides::Back), around * 0.999),
        (disk(Sides::Both), Vec3::new(0.0, 1.9, 0.0)),
        (disk(Sides::Front), Vec3::new(-0.1, 1.0, 0.2)),
    ];
    tests
        .extend(cases().into_iter().filter(|c| !c.light.is_delta() && c.name != "disk").map(|c| (c, origin)));
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
        for (u_pick, u_pos) in [(0.2, [0.3, 0.6]), (0.9, [0.8, 0.1])] {
            let own = |s: &mut Sampler| case.light.sample_le(u_pick, u_pos, s.next_2d());
            let aimed = |s: &mut Sampler| case.light.sample_le_toward(&targets, u_pick, u_pos, s.next_2d());
            let first = samples(2, 100).find_map(|mut s| own(&mut s)).unwrap();
            let ng = case.front_normal(&first);
            let density = |w| f64::from(case.light.pdf_le(first.p, ng, w).1);
            let result = chi2_sphere(&Settings::default(), |s| own(s).map(|l| l.w), density);
            assert_eq!(result.failures(level()), [""; 0], "{} own: {result:?}", case.name);
            assert!((result.integral - 1.0).abs() < 1e-3);
            // The grid does not resolve the narrow spot.
            let dark = samples(2, 1000).all(|mut s| aimed(&mut s).is_none());
            if dark || case.light.is_infinite() || case.name == "narrow spot" {
                continue;
            }
            tested += 1;
            let density = |w| f64::from(case.light.pdf_le_toward(&targets, first.p, ng, w).1);
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
    for case in cases() {
        let light = &case.light;
        let draw = |s: &mut Sampler| light.sample_le(s.next_1d(), s.next_2d(), u_dir);
        let aimed = |s: &mut Sampler| light.sample_le_toward(&targets, s.next_1d(), s.next_2d(), u_dir);
        let first = samples(3, 100).find_map(|mut s| draw(&mut s)).unwrap();
        let sheet = match (&case.geometry, light) {
            (Geometry::Sphere(c, r), _) => Sheet::Sphere(c.as_vec3(), *r as f32),
            (Geometry::Disk(c, n, _), _) => Sheet::Plane(c.as_vec3(), Frame::from_z(n.as_vec3())),
            (Geometry::Triangles(_), _) if case.name == "quad" => {
                Sheet::Plane(first.p, Frame::from_z(first.n))
            }
            (Geometry::Nothing, Light::Directional(_) | Light::Environment(_)) => {
                Sheet::Plane(-3.0 * first.w, Frame::from_z(first.w))
            }
            _ => continue,
        };
        // A ray from well before the sheet along its normal meets it where it meets the light.
        let density = |c: [f64; 2]| {
            let p = sheet.point(c);
            let on_light = match (&sheet, &case.geometry) {
                (Sheet::Plane(_, f), Geometry::Disk(..) | Geometry::Triangles(_)) => {
                    case.geometry.hit(p - f.z, f.z).is_some()
                }
                _ => true,
            };
            if on_light { f64::from(light.pdf_le(p, first.n, first.w).0) } else { 0.0 }
        };
        let settings = Settings::default();
        let result =
            chi2_rect(&settings, sheet.domain(), |s| draw(s).map(|l| sheet.coordinates(l.p)), density);
        assert_eq!(result.failures(level()), [""; 0], "{}: {result:?}", case.name);
        if light.is_infinite() {
            let first = samples(3, 100).find_map(|mut s| aimed(&mut s)).unwrap();
            let density = |c| f64::from(light.pdf_le_toward(&targets, sheet.point(c), first.n, first.w).0);
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
                let (pdf_a, pdf_w) = if aim {
                    case.light.pdf_le_toward(&targets, l.p, ng, l.w)
                } else {
                    case.light.pdf_le(l.p, ng, l.w)
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

#[test]
fn power_is_the_flux_of_le() {
    for case in cases().into_iter().chain([spot(0.4, 0.4), spot(0.0, 0.01), disk(Sides::Back)]) {
        let all = samples(6, 20_000).map(|mut s| {
            let u = s.next_1d();
            case.light.sample_le(u, s.next_2d(), s.next_2d()).map_or(0.0, |l| flux(&l))
        });
        let flux = Moments::of(all);
        let power = f64::from(case.light.power().0.x);
        assert!(power > 0.0);
        let z = flux.z(power, 2e-4 * power);
        assert!(z_p_value(z) > level(), "{}: {flux:?} {power}", case.name);
        // The same check sees an error of 2 %.
        assert!(z_p_value(flux.z(1.02 * power, 2e-4 * power)) < level(), "{}", case.name);
    }
}

#[test]
fn power_closed_forms() {
    let power = |l: &Light| f64::from(l.power().0.x);
    let bounds = scene_bounds();
    let r2 = 12.0 * 1.0001 * 1.0001;
    for case in cases() {
        let expected = match case.name {
            "point" => 4.0 * PI * 2.0,
            "directional" => PI * r2 * 3.0,
            "environment" => 4.0 * PI * PI * r2 * f64::from(0.7f32),
            "sphere" => PI * 2.0 * 4.0 * PI * 0.16,
            _ => continue,
        };
        assert_close(power(&case.light), expected, 1e-5);
    }
    assert_close(power(&disk(Sides::Both).light), 2.0 * power(&disk(Sides::Front).light), 1e-6);
    assert_close(power(&disk(Sides::Front).light), PI * 1.5 * PI * 0.25, 1e-5);
    // A spot by quadrature of its documented falloff: ∫ I·(3t² − 2t³) 2π d cos θ.
    let (ci, co) = (0.35f64.cos(), 0.8f64.cos());
    let n = 10_000;
    let mean: f64 = (0..n)
        .map(|i| (f64::from(i) + 0.5) / f64::from(n))
        .map(|t| t * t * (3.0 - 2.0 * t) / f64::from(n))
        .sum();
    assert_close(power(&spot(0.35, 0.8).light), 4.0 * 2.0 * PI * (1.0 - ci + (ci - co) * mean), 1e-5);
    let mut sun = DirectionalLight::new(Vec3::X, lanes(1.0)).map(Light::Directional).unwrap();
    assert!(power(&sun) == 0.0 && sun.sample_le(0.0, [0.5; 2], [0.5; 2]).is_none(), "no scene yet");
    sun.preprocess(bounds);
    assert!(power(&sun) > 0.0);
    assert!(sun.bounds().is_empty() && disk(Sides::Front).light.bounds().size().min_element() > 0.0);
}

/// Whether a path meets one of the specular objects within the first two targets.
fn meets_object(l: &LeSample) -> bool {
    let balls = [(Vec3::new(0.6, -0.7, 0.3), 1.1f32), (Vec3::new(-0.4, -1.0, 0.9), 0.8)];
    balls.iter().any(|(c, r)| {
        let v = *c - l.p;
        let along = v.dot(l.w);
        along > 0.0 && (v - l.w * along).length_squared() < r * r
    })
}

#[test]
fn aimed_photons_carry_the_flux_of_all_photons() {
    let targets = targets();
    for (i, case) in cases().iter().enumerate() {
        let run = |n: usize, aim: bool| {
            let mut s = Sampler::new(11, 20 + i as u64, Domain::Other, u64::from(aim));
            Moments::of((0..n).map(|_| {
                let (a, b, c) = (s.next_1d(), s.next_2d(), s.next_2d());
                let l = if aim {
                    case.light.sample_le_toward(&targets, a, b, c)
                } else {
                    case.light.sample_le(a, b, c)
                };
                l.filter(meets_object).map_or(0.0, |l| flux(&l))
            }))
        };
        let (all, aimed) = (run(1 << 21, false), run(1 << 19, true));
        let z = all.z_between(&aimed);
        assert!(z_p_value(z) > level(), "{}: {z} {all:?} {aimed:?}", case.name);
        let off = Moments { mean: 1.02 * aimed.mean, m2: 1.02 * 1.02 * aimed.m2, ..aimed };
        let planted = all.z_between(&off);
        assert!(z_p_value(planted) < level(), "{}: 2 % unseen: {planted}", case.name);
        // Aiming pays: the same count of photons has a smaller error.
        assert!(aimed.variance() < all.variance(), "{}", case.name);
    }
}

#[test]
fn a_lamp_within_its_globe_sends_all_its_light_to_it() {
    let globe = Target::from_bounds(Bounds3 { min: Vec3::splat(-1.5), max: Vec3::splat(1.5) }, 1.0);
    let far = Bounds3 { min: Vec3::new(4.0, -1.0, -1.0), max: Vec3::new(6.0, 1.0, 1.0) };
    let targets = Targets::new(vec![globe, Target::from_bounds(far, 1.0)]);
    let lamps = [
        Light::Point(PointLight::new(Vec3::new(0.1, 0.2, 0.0), lanes(1.0)).unwrap()),
        sphere(Vec3::ZERO, 0.5, Sides::Front).light,
    ];
    for lamp in lamps {
        let sent = Moments::of(samples(60, 1 << 17).map(|mut s| {
            let u = s.next_1d();
            lamp.sample_le_toward(&targets, u, s.next_2d(), s.next_2d()).map_or(0.0, |l| flux(&l))
        }));
        let power = f64::from(lamp.power().0.x);
        assert!(z_p_value(sent.z(power, 0.0)) > level(), "{sent:?} {power}");
        assert!(z_p_value(sent.z(1.02 * power, 0.0)) < level());
    }
}

/// ∫ L cos⁺ dω at `p` by a grid over the numbers of `sample_li`.
fn irradiance(light: &Light, p: Vec3, n: Vec3) -> f64 {
    let side = 400;
    let mut sum = 0.0;
    for i in 0..side * side {
        let at = |k: i32| (k as f32 + 0.5) / side as f32;
        let u = [at(i % side), at(i / side)];
        let pick = (i as f32 * 0.618_034).fract();
        if let Some(l) = light.sample_li(p, n, pick, u) {
            sum += f64::from(l.radiance.0.x * l.wi.dot(n).max(0.0) / l.pdf_w);
        }
    }
    sum / f64::from(side * side)
}

#[test]
fn irradiance_closed_forms() {
    let up = Vec3::Y;
    // Point and spot over a plane: I cos θ/d².
    let p = Vec3::new(1.0, -1.0, 0.5);
    let point = PointLight::new(Vec3::new(0.3, 1.4, -0.2), lanes(2.0)).map(Light::Point).unwrap();
    let d = Vec3::new(0.3, 1.4, -0.2) - p;
    let d3 = f64::from(d.length()).powi(3);
    assert_close(irradiance(&point, p, up), 2.0 * f64::from(d.y) / d3, 1e-5);
    let spot = SpotLight::new(Vec3::new(0.0, 2.0, 0.0), -up, lanes(4.0), 0.2, 0.6).map(Light::Spot).unwrap();
    assert_close(irradiance(&spot, Vec3::ZERO, up), 1.0, 1e-5);
    let theta = 0.4f64;
    let t = (theta.cos() - 0.6f64.cos()) / (0.2f64.cos() - 0.6f64.cos());
    let expected = 4.0 * t * t * (3.0 - 2.0 * t) * theta.cos().powi(3) / 4.0;
    assert_close(irradiance(&spot, Vec3::X * (2.0 * theta.tan()) as f32, up), expected, 1e-4);
    assert_eq!(irradiance(&spot, Vec3::X * 1.4, up), 0.0, "beyond the outer angle");
    // Sun and sky.
    let sun = DirectionalLight::new(Vec3::new(0.0, -3.0, 4.0), lanes(2.0)).map(Light::Directional).unwrap();
    assert_close(irradiance(&sun, p, up), 1.2, 1e-6);
    let sky = EnvironmentLight::new(lanes(2.0)).map(Light::Environment).unwrap();
    assert_close(irradiance(&sky, p, up), 2.0 * PI, 1e-3);
    // Disc on its axis: πL r²/(r² + h²).
    for (r, h) in [(0.5f32, 2.0f32), (1.0, 0.3), (0.01, 5.0)] {
        let light = DiskLight::new(up * h, -up, r, lanes(1.5), Sides::Front).map(Light::Disk).unwrap();
        let (r2, h2) = (f64::from(r * r), f64::from(h * h));
        assert_close(irradiance(&light, Vec3::ZERO, up), 1.5 * PI * r2 / (r2 + h2), 2e-3);
        let dark = DiskLight::new(up * h, up, r, lanes(1.5), Sides::Front).map(Light::Disk).unwrap();
        assert_eq!(irradiance(&dark, Vec3::ZERO, up), 0.0, "the back of a one-sided lamp");
    }
    // Sphere straight above, from far away to almost touching: πL(R/d)².
    for d in [1.000_01f32, 1.01, 3.0, 1e3, 1e5] {
        let light = SphereLight::new(up * d, 1.0, lanes(2.0), Sides::Front).map(Light::Sphere).unwrap();
        assert_close(irradiance(&light, Vec3::ZERO, up), 2.0 * PI / f64::from(d).powi(2), 1e-3);
    }
    // Inside a sphere that shines inward, anywhere: πL.
    let shell = SphereLight::new(Vec3::ZERO, 1.0, lanes(2.0), Sides::Back).map(Light::Sphere).unwrap();
    for y in [0.0, -0.5, -0.9] {
        assert_close(irradiance(&shell, up * y, up), 2.0 * PI, 5e-3);
    }
    // A parallel rectangle a × b at height h over one corner (Lambert): sums of atan terms.
    let (a, b, h) = (0.8f64, 1.2f64, 0.7f64);
    let edge = |x: f64, y: f64| x / (h * h + x * x).sqrt() * (y / (h * h + x * x).sqrt()).atan();
    let expected = 0.5 * (edge(a, b) + edge(b, a));
    let quad =
        TriangleLight::quad(up * h as f32, Vec3::X * a as f32, Vec3::Z * b as f32, lanes(1.0), Sides::Back)
            .map(Light::Triangles)
            .unwrap();
    let (x, z) = (Vec3::X * a as f32, Vec3::Z * b as f32);
    assert!(quad.emitted(x.cross(z).normalize(), -up).is_zero());
    let front =
        TriangleLight::quad(up * h as f32, x, z, lanes(1.0), Sides::Front).map(Light::Triangles).unwrap();
    assert_close(irradiance(&front, Vec3::ZERO, up), expected, 2e-3);
    assert_eq!(irradiance(&quad, Vec3::ZERO, up), 0.0);
}

#[test]
fn dim_lights_are_not_starved() {
    let targets = targets();
    let point = |x: f32, i: f32| Light::Point(PointLight::new(Vec3::new(x, 1.5, 0.0), lanes(i)).unwrap());
    let lights = vec![point(0.0, 1e4), point(0.5, 1.0), point(-0.5, 0.0)];
    for (picker, floor) in [
        (LightPicker::direct(&lights), 0.25),
        (LightPicker::caustics(&lights, &targets), 0.25),
        (LightPicker::photons(&lights), 0.0),
    ] {
        let pmf: Vec<f32> = (0..3).map(|i| picker.pmf(i)).collect();
        assert!((pmf.iter().sum::<f32>() - 1.0).abs() < 1e-6 && pmf[2] == 0.0, "{pmf:?}");
        assert!(pmf[1] >= floor && pmf[0] > pmf[1], "{pmf:?}");
        if floor == 0.0 {
            assert_close(f64::from(pmf[1] / pmf[0]), 1e-4, 1e-3);
        }
        // Shares as announced.
        let mut counts = [0.0; 3];
        let n = 50_000;
        for i in 0..n {
            let (k, p, _) = picker.sample((i as f32 + 0.5) / n as f32);
            assert_eq!(p, picker.pmf(k));
            counts[k] += 1.0;
        }
        for (c, p) in counts.iter().zip(&pmf) {
            assert!((c / f64::from(n) - f64::from(*p)).abs() < 1e-4, "{counts:?} {pmf:?}");
        }
    }
    // By power that reaches the targets, not by power: a bright spot that looks away gets the floor alone.
    let away = SpotLight::new(Vec3::new(0.0, 1.5, 0.0), Vec3::Y, lanes(1e4), 0.1, 0.2).map(Light::Spot);
    let picker = LightPicker::caustics(&[away.unwrap(), point(0.0, 1.0)], &targets);
    assert!((picker.pmf(0) - 0.25).abs() < 1e-6 && (picker.pmf(1) - 0.75).abs() < 1e-6);
    let none = LightPicker::direct(&[]);
    assert!(none.is_empty() && none.sample(0.5).1 == 0.0);
}

#[test]
fn many_targets_are_merged_without_losing_any() {
    let all: Vec<Target> = samples(70, 300)
        .map(|mut s| {
            let c = Vec3::new(s.next_1d(), s.next_1d(), s.next_1d()) * 4.0 - Vec3::splat(2.0);
            let r = Vec3::splat(0.05 + 0.1 * s.next_1d());
            Target::from_bounds(Bounds3 { min: c - r, max: c + r }, s.next_1d())
        })
        .collect();
    let targets = Targets::new(all.clone());
    assert_eq!(targets.len(), MAX_TARGETS);
    assert_eq!(targets.as_slice(), Targets::new(all.clone()).as_slice());
    for t in &all {
        let held = |m: &Target| {
            let sphere = t.bounds.corners().iter().all(|c| c.distance(m.center) <= m.radius);
            sphere && t.bounds.corners().iter().all(|c| m.bounds.contains(*c))
        };
        assert!(targets.as_slice().iter().any(held));
    }
    let broken = Target { radius: f32::NAN, ..all[0] };
    assert!(Targets::new(vec![broken]).is_empty());
    let point = PointLight::new(Vec3::ZERO, lanes(1.0)).map(Light::Point).unwrap();
    let nothing = Targets::default();
    assert!(point.sample_le_toward(&nothing, 0.5, [0.5; 2], [0.5; 2]).is_none());
    assert_eq!(point.pdf_le_toward(&nothing, Vec3::ZERO, Vec3::ZERO, Vec3::X).1, 0.0);
}

#[test]
fn lights_that_make_no_sense_are_refused() {
    let (o, l) = (Vec3::ZERO, lanes(1.0));
    assert!(PointLight::new(Vec3::NAN, l).is_none() && PointLight::new(o, lanes(-1.0)).is_none());
    assert!(PointLight::new(o, lanes(f32::INFINITY)).is_none());
    assert!(SpotLight::new(o, o, l, 0.1, 0.2).is_none() && SpotLight::new(o, Vec3::X, l, 0.3, 0.2).is_none());
    assert!(SpotLight::new(o, Vec3::X, l, 0.0, 0.0).is_none());
    assert!(DirectionalLight::new(o, l).is_none() && EnvironmentLight::new(lanes(f32::NAN)).is_none());
    assert!(SphereLight::new(o, 0.0, l, Sides::Front).is_none());
    assert!(DiskLight::new(o, Vec3::X, -1.0, l, Sides::Front).is_none());
    assert!(DiskLight::new(o, o, 1.0, l, Sides::Front).is_none());
    assert!(TriangleLight::new(vec![[o, Vec3::X, Vec3::X]], l, Sides::Front).is_none(), "no area");
    assert!(TriangleLight::new(vec![], l, Sides::Front).is_none());
}
