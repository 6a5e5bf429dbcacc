//! Aiming: photons leave a lamp within the cones of the specular objects' bounds, parallel light over their discs.

use std::f64::consts::PI;

use super::optics::{Circle, along, length, sub, unit};
use super::svg::{Canvas, FAINT, INK, Ink, LABEL, LIGHT, Point};

const LAMP: Point = [52.0, 74.0];

/// The bounds of the objects.
const BOUNDS: [Circle; 3] = [
    Circle { center: [300.0, 92.0], radius: 44.0 },
    Circle { center: [196.0, 208.0], radius: 62.0 },
    Circle { center: [376.0, 190.0], radius: 16.0 },
];

/// Half the angle at which a sphere is seen from the lamp, in radians.
fn half_angle(bound: Circle) -> f64 {
    (bound.radius / length(sub(bound.center, LAMP))).asin()
}

/// The share of the photons that are aimed at each object: half of it by solid angle, half evenly.
fn shares() -> [f64; 3] {
    let angles = BOUNDS.map(|bound| 2.0 * PI * (1.0 - half_angle(bound).cos()));
    let sum: f64 = angles.iter().sum();
    angles.map(|angle| 0.5 * angle / sum + 0.5 / 3.0)
}

/// The object within a bound: where a ray meets it first.
fn meets(which: usize, origin: Point, direction: Point) -> Option<Point> {
    let bound = BOUNDS[which];
    let parts = match which {
        // A ring, cut.
        0 => vec![
            Circle { center: [bound.center[0], bound.center[1] - 31.0], radius: 13.0 },
            Circle { center: [bound.center[0], bound.center[1] + 31.0], radius: 13.0 },
        ],
        _ => vec![bound],
    };
    let near = parts.iter().filter_map(|part| Some(part.meets(origin, direction)?[0]));
    near.min_by(f64::total_cmp).map(|distance| along(origin, direction, distance))
}

pub fn draw() -> Canvas {
    let mut canvas = Canvas::new([760.0, 352.0], "Aiming photons at specular objects");
    canvas.text([24.0, 34.0], "From a lamp: cones", LABEL.bold());
    let photons = 30.0;
    for (which, (bound, share)) in BOUNDS.into_iter().zip(shares()).enumerate() {
        let toward = sub(bound.center, LAMP);
        let (middle, half) = (toward[1].atan2(toward[0]), half_angle(bound));
        let reach = length(toward) * half.cos();
        let edge = |side: f64| along(LAMP, direction(middle + side * half), reach);
        canvas.polygon(&[LAMP, edge(-1.0), edge(1.0)], Ink::fill("#ffe8cc").filled("#ffe8cc", 0.8));
        canvas.circle(bound.center, bound.radius, Ink::line(FAINT).dashed().filled("#ffe8cc", 0.8));
        let count = (photons * share).round() as i32;
        for i in 0..count {
            let side = (2.0 * f64::from(i) + 1.0) / f64::from(count) - 1.0;
            let ray = direction(middle + side * half);
            let far = along(LAMP, ray, length(toward) + bound.radius + 8.0);
            match meets(which, LAMP, ray) {
                Some(hit) => canvas.path(&[LAMP, hit], Ink::line(LIGHT).wide(1.2)),
                None => {
                    canvas.path(&[LAMP, far], Ink::line(FAINT).wide(1.0));
                    cross(&mut canvas, far);
                }
            }
        }
    }
    let ring = BOUNDS[0].center;
    for y in [-31.0, 31.0] {
        canvas.circle([ring[0], ring[1] + y], 13.0, Ink::line(INK).filled("#e6cf80", 1.0));
    }
    for bound in &BOUNDS[1..] {
        canvas.circle(bound.center, bound.radius, Ink::line(INK).filled("#c9e1f2", 1.0));
    }
    canvas.circle(LAMP, 6.0, Ink::line(LIGHT).filled("#ffd8a8", 1.0));
    canvas.text([LAMP[0] - 22.0, LAMP[1] - 14.0], "lamp", LABEL.color(LIGHT));
    let [a, b, c] = shares().map(|share| format!("{:.0} %", 100.0 * share));
    canvas.text([368.0, 84.0], &a, LABEL.bold());
    canvas.text([196.0, 214.0], &b, LABEL.bold().middle());
    canvas.text([376.0, 226.0], &c, LABEL.bold().middle());
    canvas.text([24.0, 318.0], "Share of the photons: half by solid angle,", LABEL);
    canvas.text([24.0, 338.0], "half evenly. × met nothing, and ends.", LABEL);
    parallel(&mut canvas);
    canvas
}

fn direction(angle: f64) -> Point {
    [angle.cos(), angle.sin()]
}

fn cross(canvas: &mut Canvas, [x, y]: Point) {
    for side in [-1.0, 1.0] {
        canvas.path(&[[x - 4.0, y - 4.0 * side], [x + 4.0, y + 4.0 * side]], Ink::line(FAINT));
    }
}

fn parallel(canvas: &mut Canvas) {
    canvas.text([464.0, 34.0], "From the sun: discs", LABEL.bold());
    let ray = unit([0.35, 1.0]);
    let across = [ray[1], -ray[0]];
    for (bound, count) in [
        (Circle { center: [560.0, 220.0], radius: 56.0 }, 9),
        (Circle { center: [690.0, 244.0], radius: 20.0 }, 5),
    ] {
        let middle = along(bound.center, ray, -168.0);
        let [left, right] = [-1.0, 1.0].map(|side| along(middle, across, side * bound.radius));
        let down = |p: Point| along(p, ray, 168.0);
        canvas.polygon(&[left, right, down(right), down(left)], Ink::fill("#ffe8cc").filled("#ffe8cc", 0.8));
        canvas.path(&[left, right], Ink::line(LIGHT).wide(3.0));
        for i in 0..count {
            let side = (2.0 * f64::from(i) + 1.0) / f64::from(count) - 1.0;
            let start = along(middle, across, side * bound.radius);
            if let Some([near, _]) = bound.meets(start, ray) {
                canvas.path(&[start, along(start, ray, near)], Ink::line(LIGHT).wide(1.2));
            }
        }
        canvas.circle(bound.center, bound.radius, Ink::line(INK).filled("#c9e1f2", 1.0));
    }
    canvas.text([464.0, 318.0], "Points on the discs are drawn;", LABEL);
    canvas.text([464.0, 338.0], "all photons have one direction.", LABEL);
}

#[cfg(test)]
mod tests {
    #[test]
    fn shares_add_up() {
        assert!((super::shares().iter().sum::<f64>() - 1.0).abs() < 1e-12);
    }
}
