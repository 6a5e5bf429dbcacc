//! Where the directions of the whole sphere lie on the unit square; v runs downward, as the rows of pictures do.

use math::{PI, Vec3};
use scenefile::desc::SkyMapping;

/// The point of [0, 1]² that stands for the unit vector `d`.
pub(crate) fn square(mapping: SkyMapping, d: Vec3) -> [f32; 2] {
    match mapping {
        SkyMapping::LatLong => {
            let u = d.x.atan2(-d.z) / (2.0 * PI);
            [if u < 0.0 { u + 1.0 } else { u }, d.x.hypot(d.z).atan2(d.y) / PI]
        }
        SkyMapping::EqualArea => {
            // Clarberg 2008, §2: r = √(1 − |z|), here without cancellation, and the angle as a share of the quadrant.
            let (x, y, z) = (d.x.abs(), d.y.abs(), d.z.abs());
            let r = ((x * x + y * y) / (1.0 + z)).sqrt().min(1.0);
            let along = r * (y.atan2(x) / (0.5 * PI));
            let (u, v) = (r - along, along);
            // The lower hemisphere is folded outward over the diamond's edges.
            let (u, v) = if d.z < 0.0 { (1.0 - v, 1.0 - u) } else { (u, v) };
            [u.copysign(d.x), v.copysign(d.y)].map(|x| (0.5 * x + 0.5).clamp(0.0, 1.0))
        }
    }
}

/// The unit vector for which a point of [0, 1]² stands: the inverse of [`square`].
pub(crate) fn direction(mapping: SkyMapping, [u, v]: [f64; 2]) -> Vec3 {
    use std::f64::consts::PI;
    let (x, y, z) = match mapping {
        SkyMapping::LatLong => {
            let ((s, c), (sin, cos)) = ((2.0 * PI * u).sin_cos(), (PI * v).sin_cos());
            (sin * s, cos, -sin * c)
        }
        SkyMapping::EqualArea => {
            let (u, v) = (2.0 * u - 1.0, 2.0 * v - 1.0);
            let inside = 1.0 - (u.abs() + v.abs());
            let r = 1.0 - inside.abs();
            let quarter = if r > 0.0 { (v.abs() - u.abs()) / r + 1.0 } else { 1.0 };
            let (s, c) = (0.25 * PI * quarter).sin_cos();
            let reach = r * (2.0 - r * r).max(0.0).sqrt();
            ((reach * c).copysign(u), (reach * s).copysign(v), (1.0 - r * r).copysign(inside))
        }
    };
    Vec3::new(x as f32, y as f32, z as f32).normalize()
}

/// The point of [0, 1]² that stands for what a point, less than 1 beyond an edge, would go on with over the sphere. Of longitudes
/// and latitudes all points may stand as they are.
pub(crate) fn continued(mapping: SkyMapping, [u, v]: [f64; 2]) -> [f64; 2] {
    if mapping == SkyMapping::LatLong {
        return [u, v];
    }
    let beyond = |x: f64| !(0.0..=1.0).contains(&x);
    let folded = |x: f64| if x < 0.0 { -x } else { 2.0 - x };
    let [u, v] = if beyond(u) { [folded(u), 1.0 - v] } else { [u, v] };
    if beyond(v) { [1.0 - u, folded(v)] } else { [u, v] }
}

/// Solid angle over area of the square at its height `v`, steradians.
pub(crate) fn solid_angle(mapping: SkyMapping, v: f64) -> f64 {
    use std::f64::consts::PI;
    match mapping {
        SkyMapping::LatLong => 2.0 * PI * PI * (PI * v).sin().abs(),
        SkyMapping::EqualArea => 4.0 * PI,
    }
}

/// The pixel of a picture of `size` that stands where (column, row), which may lie up to a picture's width outside, would
/// go on over the sphere.
pub(crate) fn wrapped(mapping: SkyMapping, [width, height]: [usize; 2], i: i64, j: i64) -> [usize; 2] {
    let (w, h) = (width as i64, height as i64);
    let (i, j) = match mapping {
        // Columns go round; beyond a pole lies the row at the pole.
        SkyMapping::LatLong => (i.rem_euclid(w), j.clamp(0, h - 1)),
        // Each edge is sewn to itself, turned about its middle.
        SkyMapping::EqualArea => {
            let (i, j) = match i {
                i if i < 0 => (-1 - i, h - 1 - j),
                i if i >= w => (2 * w - 1 - i, h - 1 - j),
                i => (i, j),
            };
            match j {
                j if j < 0 => (w - 1 - i, -1 - j),
                j if j >= h => (w - 1 - i, 2 * h - 1 - j),
                j => (i, j),
            }
        }
    };
    [i.clamp(0, w - 1) as usize, j.clamp(0, h - 1) as usize]
}

#[cfg(test)]
mod tests {
    use sampling::{Domain, Sampler, warp};

    use super::*;

    const BOTH: [SkyMapping; 2] = [SkyMapping::LatLong, SkyMapping::EqualArea];

    #[test]
    fn known_points() {
        let equal = [
            ([0.5, 0.5], Vec3::Z),
            ([1.0, 0.5], Vec3::X),
            ([0.0, 0.5], -Vec3::X),
            ([0.5, 1.0], Vec3::Y),
            ([0.5, 0.0], -Vec3::Y),
            ([0.0, 0.0], -Vec3::Z),
            ([1.0, 0.0], -Vec3::Z),
        ];
        for (uv, w) in equal {
            assert!(direction(SkyMapping::EqualArea, uv).distance(w) < 1e-6, "{uv:?}");
        }
        let lat_long =
            [([0.5, 0.5], Vec3::Z), ([0.25, 0.5], Vec3::X), ([0.3, 0.0], Vec3::Y), ([0.3, 1.0], -Vec3::Y)];
        for (uv, w) in lat_long {
            assert!(direction(SkyMapping::LatLong, uv).distance(w) < 1e-6, "{uv:?}");
        }
    }

    #[test]
    fn there_and_back() {
        let mut s = Sampler::new(1, 2, Domain::Other, 3);
        for mapping in BOTH {
            for _ in 0..10_000 {
                let w = warp::sphere(s.next_2d());
                let back = direction(mapping, square(mapping, w).map(f64::from));
                assert!(back.distance(w) < 2e-6, "{mapping:?} {w} {back}");
            }
        }
    }

    #[test]
    fn solid_angles_are_the_jacobian_and_edges_are_sewn() {
        let h = 1e-3;
        for mapping in BOTH {
            for k in 0..100 {
                let [u, v] = [0.031 + 0.0931 * f64::from(k % 10), 0.047 + 0.0911 * f64::from(k / 10)];
                let d = |du: f64, dv: f64| direction(mapping, [u + du, v + dv]).as_dvec3() / (2.0 * h);
                let area = (d(h, 0.0) - d(-h, 0.0)).cross(d(0.0, h) - d(0.0, -h)).length();
                assert!((area / solid_angle(mapping, v) - 1.0).abs() < 0.01, "{mapping:?} {u} {v} {area}");
                let at = |u: f64, v: f64| direction(mapping, continued(mapping, [u, v]));
                let sewn = [(at(-h, v), at(h, v)), (at(1.0 + h, v), at(1.0 - h, v))];
                let poles = [(at(u, -h), at(u, h)), (at(u, 1.0 + h), at(u, 1.0 - h))];
                assert!(sewn.iter().chain(&poles).all(|(a, b)| a.distance(*b) < 0.02), "{mapping:?} {u} {v}");
            }
        }
    }

    /// As many directions of the sphere fall into each of 8 × 8 squares (4096 expected, so 64 is one deviation).
    #[test]
    fn areas_are_equal() {
        let mut counts = [0f64; 64];
        let mut s = Sampler::new(4, 2, Domain::Other, 3);
        for _ in 0..64 * 4096 {
            let [u, v] =
                square(SkyMapping::EqualArea, warp::sphere(s.next_2d())).map(|x| ((x * 8.0) as usize).min(7));
            counts[v * 8 + u] += 1.0;
        }
        let (_, _, p) = testkit::chi2_counts(&counts, &[4096.0; 64]);
        assert!(p > 1e-4, "{p}");
    }

    /// Neighbours across an edge of the picture are neighbours on the sphere.
    #[test]
    fn what_lies_beyond_an_edge_lies_beside_it() {
        let n = 64;
        let middle =
            |mapping, [i, j]: [usize; 2]| direction(mapping, [i, j].map(|x| (x as f64 + 0.5) / n as f64));
        for k in 0..n {
            let m = n as i64;
            let edges = [
                ([0, k], [-1, k as i64]),
                ([n - 1, k], [m, k as i64]),
                ([k, 0], [k as i64, -1]),
                ([k, n - 1], [k as i64, m]),
            ];
            for (inside, [i, j]) in edges {
                let equal = SkyMapping::EqualArea;
                let gap = middle(equal, inside).distance(middle(equal, wrapped(equal, [n; 2], i, j)));
                assert!(gap < 0.1, "{inside:?} {gap}");
            }
            let around = middle(SkyMapping::LatLong, wrapped(SkyMapping::LatLong, [n; 2], -1, k as i64));
            assert!(middle(SkyMapping::LatLong, [0, k]).distance(around) < 0.1);
        }
        assert_eq!(wrapped(SkyMapping::EqualArea, [4, 4], -1, -1), [3, 3]);
    }
}
