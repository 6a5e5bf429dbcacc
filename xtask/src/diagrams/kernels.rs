//! The photons within the k-th neighbour's distance, and how each counts.

use std::f64::consts::PI;

use super::optics::{along, length, sub, unit};
use super::plot::Plot;
use super::svg::{CAMERA, Canvas, FAINT, GREEN, INK, Ink, LABEL, LIGHT, Point, VIOLET};

const K: usize = 21;

/// Name with equation, colour, and the kernel over t = d/r.
type Kernel = (&'static str, &'static str, fn(f64) -> f64);

const KERNELS: [Kernel; 4] = [
    ("Epanechnikov (2/π)(1 − t²)", LIGHT, |t| 2.0 / PI * (1.0 - t * t)),
    ("Silverman (3/π)(1 − t²)²", VIOLET, |t| 3.0 / PI * (1.0 - t * t).powi(2)),
    ("cone (3/π)(1 − t)", GREEN, |t| 3.0 / PI * (1.0 - t)),
    ("constant 1/π", CAMERA, |_| 1.0 / PI),
];

pub fn draw() -> Canvas {
    let mut canvas = Canvas::new([760.0, 350.0], "The k nearest photons, and kernels");
    neighbours(&mut canvas);

    canvas.text([404.0, 34.0], "How much each counts: k(t), t = d/r", LABEL.bold());
    let plot = Plot { origin: [440.0, 300.0], size: [290.0, 240.0], x: [0.0, 1.0], y: [0.0, 1.0] };
    let tops = [(0.0, "0"), (1.0 / PI, "1/π"), (2.0 / PI, "2/π"), (3.0 / PI, "3/π")];
    plot.axes(&mut canvas, &[(0.0, "0"), (0.5, "½"), (1.0, "1")], &tops);
    canvas.text([plot.at(0.75, 0.0)[0], 318.0], "t", LABEL.middle());
    for (i, (name, color, k)) in KERNELS.into_iter().enumerate() {
        plot.curve(&mut canvas, 60, Ink::line(color).wide(2.2), k);
        canvas.text([724.0, 76.0 + 20.0 * i as f64], name, LABEL.end().color(color));
    }
    canvas.text([440.0, 340.0], "Over the disc each has the integral 1.", LABEL.color(FAINT));
    canvas
}

/// A surface from above, with its photons.
fn neighbours(canvas: &mut Canvas) {
    canvas.text([24.0, 34.0], "The disc, from above", LABEL.bold());
    let x: Point = [180.0, 178.0];
    // Places that fill the square evenly (Roberts 2018).
    let place = |i: usize| {
        let share = |step: f64| (0.5 + step * (i + 1) as f64).fract();
        [40.0 + 280.0 * share(0.754_877_666_246_69), 56.0 + 244.0 * share(0.569_840_290_998_05)]
    };
    let mut photons: Vec<Point> = (0..64).map(place).collect();
    let distance = |p: &Point| length(sub(*p, x));
    photons.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
    let last = photons[K - 1];
    let radius = distance(&last);
    canvas.circle(x, radius, Ink::line(LIGHT).filled("#ffe8cc", 0.8));
    canvas.path(&[x, last], Ink::line(INK).dashed());
    for (i, &photon) in photons.iter().enumerate() {
        let ink = match i + 1 {
            K => Ink::line(LIGHT).filled("#ffffff", 1.0).wide(2.0),
            1..K => Ink::fill(LIGHT),
            _ => Ink::fill("#b5b2aa"),
        };
        canvas.circle(photon, 4.5, ink);
    }
    canvas.circle(x, 3.0, Ink::fill(INK));
    canvas.text([x[0] - 10.0, x[1] - 6.0], "x", LABEL.bold().end());
    let toward = unit(sub(last, x));
    let middle = along(x, toward, 0.5 * radius);
    canvas.text(along(middle, [-toward[1], toward[0]], -12.0), "r", LABEL.bold().middle());
    canvas.text([40.0, 322.0], "r is the distance of the k-th photon, here k = 21.", LABEL);
    canvas.text([40.0, 340.0], "The k-th (hollow) is dropped.", LABEL.color(FAINT));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kernels_have_the_integral_1() {
        for (name, _, k) in KERNELS {
            let n = 10_000;
            let ring = |i: usize| {
                let t = (i as f64 + 0.5) / f64::from(n);
                2.0 * PI * t * k(t) / f64::from(n)
            };
            let sum: f64 = (0..n as usize).map(ring).sum();
            assert!((sum - 1.0).abs() < 1e-6, "{name}: {sum}");
        }
    }
}
