//! Light in a plane, for drawings that are right.

use super::svg::Point;

pub fn sub(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1]]
}

pub fn along(origin: Point, direction: Point, distance: f64) -> Point {
    [origin[0] + distance * direction[0], origin[1] + distance * direction[1]]
}

fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

pub fn length(a: Point) -> f64 {
    a[0].hypot(a[1])
}

pub fn unit(a: Point) -> Point {
    a.map(|x| x / length(a))
}

/// A circle.
#[derive(Clone, Copy)]
pub struct Circle {
    pub center: Point,
    pub radius: f64,
}

impl Circle {
    /// Distances along a ray of unit direction at which it meets the circle's line; `None` where it passes by.
    pub fn meets(self, origin: Point, direction: Point) -> Option<[f64; 2]> {
        let from = sub(origin, self.center);
        let b = dot(from, direction);
        let under = b * b - dot(from, from) + self.radius * self.radius;
        (under > 0.0).then(|| [-b - under.sqrt(), -b + under.sqrt()])
    }

    /// Where a ray enters a ball of this index of refraction, where it leaves it, and its direction then.
    pub fn refracts(self, origin: Point, direction: Point, index: f64) -> Option<[Point; 3]> {
        let enter = along(origin, direction, self.meets(origin, direction)?[0]);
        let inside = snell(direction, unit(sub(enter, self.center)), 1.0 / index)?;
        let leave = along(enter, inside, self.meets(enter, inside)?[1]);
        let out = snell(inside, unit(sub(self.center, leave)), index)?;
        Some([enter, leave, out])
    }
}

/// The direction behind a surface whose normal points against `direction`; `ratio` is n_before/n_behind. `None`: all is
/// reflected.
fn snell(direction: Point, normal: Point, ratio: f64) -> Option<Point> {
    let cos = -dot(direction, normal);
    let under = 1.0 - ratio * ratio * (1.0 - cos * cos);
    (under > 0.0).then(|| along(direction.map(|x| ratio * x), normal, ratio * cos - under.sqrt()))
}

/// Where a ray meets the horizontal line at `y`.
pub fn on_floor(origin: Point, direction: Point, y: f64) -> Point {
    along(origin, direction, (y - origin[1]) / direction[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ball_refracts_by_snells_law() {
        let ball = Circle { center: [0.0, 0.0], radius: 1.0 };
        let [enter, leave, out] = ball.refracts([-0.5, -3.0], [0.0, 1.0], 1.5).unwrap();
        let sine = |a: Point, n: Point| (a[0] * n[1] - a[1] * n[0]).abs();
        let inside = unit(sub(leave, enter));
        assert!((sine([0.0, 1.0], enter) - 1.5 * sine(inside, enter)).abs() < 1e-12);
        assert!((sine(out, leave) - 1.5 * sine(inside, leave)).abs() < 1e-12);
        assert!((length(out) - 1.0).abs() < 1e-12);
        assert!(ball.refracts([-1.5, -3.0], [0.0, 1.0], 1.5).is_none());
    }
}
