use math::{PI, Vec3};

use super::{Light, Sides};

/// Directions in which a group of lights shines (Conty Estévez & Kulla 2018, §4.1): normals lie within `spread` of the axis, and
/// light leaves within `reach` of them. Radians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cone {
    pub axis: Vec3,
    pub spread: f32,
    pub reach: f32,
}

impl Cone {
    /// In all directions.
    pub const ALL: Self = Self { axis: Vec3::Z, spread: PI, reach: 0.5 * PI };

    /// That of a light at a finite place.
    pub fn of(light: &Light) -> Self {
        let flat = |axis: Vec3, spread: f32, sides: Sides| match sides {
            Sides::Front => Self { axis, spread, reach: 0.5 * PI },
            Sides::Back => Self { axis: -axis, spread, reach: 0.5 * PI },
            Sides::Both => Self::ALL,
        };
        match light {
            Light::Spot(l) => Self { axis: l.axis(), spread: l.outer_angle(), reach: 0.0 },
            Light::Disk(l) => flat(l.normal(), 0.0, l.surface().sides),
            Light::Triangles(l) => {
                let normals = l.faces().map(|(_, axis)| Self { axis, spread: 0.0, reach: 0.5 * PI });
                let all = normals.reduce(Self::union).unwrap_or(Self::ALL);
                flat(all.axis, all.spread, l.surface().sides)
            }
            _ => Self::ALL,
        }
    }

    /// A cone around both.
    pub fn union(self, other: Self) -> Self {
        let (a, b) = if self.spread >= other.spread { (self, other) } else { (other, self) };
        let reach = a.reach.max(b.reach);
        let between = (0.5 * (a.axis - b.axis).length()).min(1.0).asin() * 2.0;
        if (between + b.spread).min(PI) <= a.spread {
            return Self { reach, ..a };
        }
        let spread = 0.5 * (a.spread + between + b.spread);
        let across = (b.axis - a.axis * a.axis.dot(b.axis)).try_normalize();
        match across {
            Some(across) if spread < PI => {
                let (s, c) = (spread - a.spread).sin_cos();
                // A little wider than the arithmetic says, for its roundings.
                Self { axis: (a.axis * c + across * s).normalize(), spread: (spread + 1e-4).min(PI), reach }
            }
            _ => Self { axis: a.axis, spread: PI, reach },
        }
    }

    /// ∫ of the cosine to the cone's border over what it lights (eq. 1).
    pub fn measure(self) -> f64 {
        use std::f64::consts::PI;
        let spread = f64::from(self.spread);
        let end = (spread + f64::from(self.reach)).min(PI);
        let (s, c) = spread.sin_cos();
        2.0 * PI * (1.0 - c) + 0.5 * PI * (2.0 * end * s - (spread - 2.0 * end).cos() - 2.0 * spread * s + c)
    }
}

#[cfg(test)]
mod tests {
    use sampling::{Domain, Sampler, warp};

    use super::*;

    #[test]
    fn unions_hold_both() {
        let mut s = Sampler::new(1, 1, Domain::Other, 1);
        for _ in 0..2000 {
            let mut cone = || Cone {
                axis: warp::sphere(s.next_2d()),
                spread: (s.next_1d() - 0.2).max(0.0) * PI,
                reach: s.next_1d(),
            };
            let (a, b) = (cone(), cone());
            let all = a.union(b);
            for part in [a, b] {
                let between = all.axis.dot(part.axis).clamp(-1.0, 1.0).acos();
                assert!(
                    between + part.spread <= all.spread + 1e-3 || all.spread >= PI,
                    "{a:?} {b:?} {all:?}"
                );
                assert!(part.reach <= all.reach);
            }
            assert!(all.spread <= a.spread.max(b.spread).max(0.5 * (a.spread + b.spread + PI)) + 1e-3);
        }
        // One direction of a Lambertian lamp: π; all directions: 4π.
        let lamp = Cone { axis: Vec3::X, spread: 0.0, reach: 0.5 * PI };
        assert!((lamp.measure() - std::f64::consts::PI).abs() < 1e-6, "{}", lamp.measure());
        assert!((Cone::ALL.measure() - 4.0 * std::f64::consts::PI).abs() < 1e-5, "{}", Cone::ALL.measure());
    }
}
