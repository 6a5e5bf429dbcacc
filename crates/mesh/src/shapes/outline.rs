use math::{DVec2, Vec2};

use crate::MeshError;

/// A point of an outline and the unit tangents with which the curve arrives there and leaves.
#[derive(Clone, Copy, Debug)]
pub(super) struct Station {
    pub(super) point: DVec2,
    pub(super) arrives: DVec2,
    pub(super) leaves: DVec2,
}

impl Station {
    pub(super) fn is_smooth(&self) -> bool {
        self.arrives.dot(self.leaves) > 1.0 - 1e-9
    }
}

/// The same outline travelled the other way.
pub(super) fn reversed(stations: &[Station]) -> Vec<Station> {
    stations
        .iter()
        .rev()
        .map(|s| Station { point: s.point, arrives: -s.leaves, leaves: -s.arrives })
        .collect()
}

/// Draws an outline of lines, arcs and Bézier curves with exact tangents.
pub(super) struct Pen {
    stations: Vec<Station>,
}

impl Pen {
    pub(super) fn at(x: f64, y: f64) -> Self {
        let point = DVec2::new(x, y);
        Self { stations: vec![Station { point, arrives: DVec2::ZERO, leaves: DVec2::ZERO }] }
    }

    fn go(mut self, point: DVec2, leaves_last: DVec2, arrives: DVec2) -> Self {
        let last = self.stations.len() - 1;
        self.stations[last].leaves = leaves_last;
        if last == 0 {
            self.stations[0].arrives = leaves_last;
        }
        self.stations.push(Station { point, arrives, leaves: arrives });
        self
    }

    fn here(&self) -> DVec2 {
        self.stations[self.stations.len() - 1].point
    }

    pub(super) fn line(self, x: f64, y: f64) -> Self {
        let to = DVec2::new(x, y);
        let tangent = (to - self.here()).normalize_or_zero();
        self.go(to, tangent, tangent)
    }

    /// An arc about (x, y) through `quarters` quarter turns, counter-clockwise where positive.
    pub(super) fn arc(mut self, x: f64, y: f64, quarters: f64, steps: u32) -> Self {
        let center = DVec2::new(x, y);
        let from = self.here() - center;
        let tangent = |radius: DVec2| (radius.perp() * quarters.signum()).normalize_or_zero();
        let mut last = from;
        for i in 1..=steps {
            let angle = f64::from(i) / f64::from(steps) * quarters * std::f64::consts::FRAC_PI_2;
            let radius = DVec2::from_angle(angle).rotate(from);
            self = self.go(center + radius, tangent(last), tangent(radius));
            last = radius;
        }
        self
    }

    /// A cubic Bézier curve whose inner control points differ from the outer ones.
    pub(super) fn curve(mut self, c: [f64; 2], d: [f64; 2], to: [f64; 2], steps: u32) -> Self {
        let p = [self.here(), c.into(), d.into(), to.into()];
        let tangent = |t: f64| {
            let s = 1.0 - t;
            ((p[1] - p[0]) * (s * s) + (p[2] - p[1]) * (2.0 * s * t) + (p[3] - p[2]) * (t * t))
                .normalize_or_zero()
        };
        for i in 1..=steps {
            let [before, t] = [i - 1, i].map(|i| f64::from(i) / f64::from(steps));
            let s = 1.0 - t;
            let point =
                p[0] * (s * s * s) + p[1] * (3.0 * s * s * t) + p[2] * (3.0 * s * t * t) + p[3] * (t * t * t);
            self = self.go(point, tangent(before), tangent(t));
        }
        self
    }

    /// Goes along stations that begin here.
    pub(super) fn follow(mut self, stations: &[Station]) -> Self {
        for pair in stations.windows(2) {
            self = self.go(pair[1].point, pair[0].leaves, pair[1].arrives);
        }
        self
    }

    pub(super) fn finish(self) -> Vec<Station> {
        self.stations
    }

    /// Joins the end to the beginning, which must be at the same place.
    pub(super) fn closed(mut self) -> Vec<Station> {
        let last = self.stations.len() - 1;
        self.stations[0].arrives = self.stations[last].arrives;
        self.stations[last].leaves = self.stations[0].leaves;
        self.stations[last].point = self.stations[0].point;
        self.stations
    }
}

/// The stations moved by `distance` to the right of the direction of travel: a parallel curve.
pub(super) fn offset(stations: &[Station], distance: f64) -> Vec<Station> {
    stations.iter().map(|s| Station { point: s.point - s.leaves.perp() * distance, ..*s }).collect()
}

/// The outline of a surface of revolution: (radius, y) from point to point.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    /// Points (radius ≥ 0, y), in order. An open profile may begin and end on the axis (radius 0), and only there.
    /// A point given twice in a row is a corner.
    pub points: Vec<Vec2>,
    /// Whether the last point is joined to the first, as for a ring; every radius is then positive.
    pub closed: bool,
    /// Parts into which the curve between two points is cut, 1 to 1024. 1 joins them by straight lines; more by a
    /// centripetal Catmull-Rom spline, which goes through all points.
    pub steps: u32,
    /// Where the outline turns by more than this angle (radians) at a point, the point is a corner: the spline and the
    /// normals break there. 0 makes every point a corner, π none.
    pub crease: f32,
}

impl Profile {
    /// Straight lines, smoothly shaded where they turn by less than 30°.
    pub fn polyline(points: Vec<Vec2>) -> Self {
        Self { points, closed: false, steps: 1, crease: math::PI / 6.0 }
    }

    /// A spline in 8 steps between points, with corners where the polyline turns by more than 75°.
    pub fn smooth(points: Vec<Vec2>) -> Self {
        Self { points, closed: false, steps: 8, crease: math::PI * 75.0 / 180.0 }
    }

    pub(super) fn stations(&self) -> Result<Vec<Station>, MeshError> {
        let (points, marked) = self.distinct_points()?;
        let n = points.len();
        let spans = if self.closed { n } else { n - 1 };
        let at = |i: usize| points[i % n];
        let length = |i: usize| (at(i + 1) - at(i)).length();
        // Spacing of the knots: by chord for the tangents of a polyline, centripetal (Yuksel et al. 2011) for a spline.
        let knot = |i: usize| if self.steps == 1 { length(i) } else { length(i).sqrt() };
        let slope = |i: usize| (at(i + 1) - at(i)) / knot(i);

        // Tangent at each smooth point: of the parabola through it and its neighbours.
        let tangents: Vec<Option<DVec2>> = (0..n)
            .map(|i| {
                if !self.closed && (i == 0 || i == n - 1) {
                    let (end, neighbour) =
                        if i == 0 { (points[0], points[1]) } else { (points[i], points[i - 1]) };
                    let span = neighbour - end;
                    // On the axis the curve goes on as its own mirror image, hence level.
                    let turn = 2.0 * span.y.abs().atan2(span.x);
                    let level = DVec2::new(if i == 0 { span.x } else { -span.x }, 0.0);
                    let knot = if i == 0 { knot(0) } else { knot(i - 1) };
                    return (end.x == 0.0 && turn <= f64::from(self.crease)).then(|| level / knot);
                }
                let before = (i + n - 1) % n;
                let (s, t) = (slope(before), slope(i));
                let turn = s.angle_to(t).abs();
                let (d, e) = (knot(before), knot(i));
                (!marked[i] && turn <= f64::from(self.crease)).then(|| (s * e + t * d) / (d + e))
            })
            .collect();

        let mut stations = Vec::with_capacity(spans * self.steps as usize + 1);
        for i in 0..spans {
            let (p, q, h) = (at(i), at(i + 1), knot(i));
            let chord = (q - p) / h;
            let natural = |other: DVec2| (chord * 3.0 - other) * 0.5;
            let (m, l) = match (tangents[i], tangents[(i + 1) % n]) {
                (Some(m), Some(l)) => (m, l),
                (Some(m), None) => (m, natural(m)),
                (None, Some(l)) => (natural(l), l),
                (None, None) => (chord, chord),
            };
            let steps = f64::from(self.steps);
            let derivative = |t: f64| {
                let bend = (p - q) * (6.0 * t * (1.0 - t));
                (m * (h * (1.0 - t) * (1.0 - 3.0 * t)) + l * (h * t * (3.0 * t - 2.0)) - bend)
                    .normalize_or_zero()
            };
            for k in 0..=self.steps {
                let t = f64::from(k) / steps;
                // Cubic Hermite basis.
                let s = 1.0 - t;
                let point = if k == self.steps {
                    q
                } else {
                    p * (s * s * (1.0 + 2.0 * t))
                        + q * (t * t * (3.0 - 2.0 * t))
                        + (m * s - l * t) * (h * s * t)
                };
                let tangent = derivative(t);
                match stations.last_mut() {
                    Some(Station { leaves, .. }) if k == 0 => *leaves = tangent,
                    _ => stations.push(Station { point, arrives: tangent, leaves: tangent }),
                }
            }
        }
        if self.closed {
            let last = stations.len() - 1;
            stations[0].arrives = stations[last].arrives;
            stations[last].leaves = stations[0].leaves;
        }
        let inner = if self.closed { &stations[..] } else { &stations[1..stations.len() - 1] };
        if let Some(s) = inner.iter().find(|s| s.point.x <= 0.0) {
            return Err(MeshError::whole(
                format!("the profile meets the axis at y = {:.6}", s.point.y),
                "only the ends of an open profile may lie on the axis; where a spline swings over it, add points",
            ));
        }
        Ok(stations)
    }

    /// The points without repetitions, and whether each was repeated.
    fn distinct_points(&self) -> Result<(Vec<DVec2>, Vec<bool>), MeshError> {
        let fault = |message: String| {
            Err(MeshError::whole(message, "give a profile as points [radius, y] with radius ≥ 0, in order"))
        };
        if !(1..=1024).contains(&self.steps) || !(0.0..=math::PI + 1e-6).contains(&self.crease) {
            return fault(format!(
                "{} steps (1 to 1024) or a crease of {} (0 to π)",
                self.steps, self.crease
            ));
        }
        let mut points: Vec<DVec2> = Vec::new();
        let mut marked: Vec<bool> = Vec::new();
        for (i, p) in self.points.iter().enumerate() {
            if !p.is_finite() || p.x < 0.0 {
                return fault(format!("point {i} of the profile is {p}"));
            }
            // −0 is the axis, too.
            let p = p.as_dvec2() + DVec2::ZERO;
            if points.last() == Some(&p) {
                *marked.last_mut().unwrap_or(&mut false) = true;
            } else {
                points.push(p);
                marked.push(false);
            }
        }
        if self.closed && points.len() > 1 && points.first() == points.last() {
            points.pop();
            marked.pop();
        }
        let least = if self.closed { 3 } else { 2 };
        if points.len() < least {
            return fault(format!("a profile of {} different points, not {least} or more", points.len()));
        }
        if points.iter().all(|p| p.x == 0.0) {
            return fault("a profile that lies on the axis".into());
        }
        Ok((points, marked))
    }
}
