//! Axes.

use super::svg::{Canvas, FAINT, INK, Ink, LABEL, Point};

/// A rectangle of the drawing that shows x from `x[0]` to `x[1]` and y likewise, both already as logarithms where they
/// are to be.
pub struct Plot {
    pub origin: Point,
    pub size: Point,
    pub x: [f64; 2],
    pub y: [f64; 2],
}

impl Plot {
    pub fn at(&self, x: f64, y: f64) -> Point {
        let share = |value: f64, [from, to]: [f64; 2]| (value - from) / (to - from);
        [self.origin[0] + self.size[0] * share(x, self.x), self.origin[1] - self.size[1] * share(y, self.y)]
    }

    /// The axes with their ticks and grid.
    pub fn axes(&self, canvas: &mut Canvas, x_ticks: &[(f64, &str)], y_ticks: &[(f64, &str)]) {
        let [x0, x1] = self.x;
        let [y0, y1] = self.y;
        for &(x, label) in x_ticks {
            canvas.path(&[self.at(x, y0), self.at(x, y1)], Ink::line("#dddad2").wide(1.0));
            let [left, base] = self.at(x, y0);
            canvas.text([left, base + 20.0], label, LABEL.middle().color(FAINT));
        }
        for &(y, label) in y_ticks {
            canvas.path(&[self.at(x0, y), self.at(x1, y)], Ink::line("#dddad2").wide(1.0));
            let [left, base] = self.at(x0, y);
            canvas.text([left - 8.0, base + 5.0], label, LABEL.end().color(FAINT));
        }
        canvas.path(&[self.at(x0, y1), self.at(x0, y0), self.at(x1, y0)], Ink::line(INK).wide(1.2));
    }

    /// A curve of `steps` straight pieces.
    pub fn curve(&self, canvas: &mut Canvas, steps: usize, ink: Ink, f: impl Fn(f64) -> f64) {
        let [x0, x1] = self.x;
        let x = |i: usize| x0 + (x1 - x0) * i as f64 / steps as f64;
        let points: Vec<Point> = (0..=steps).map(|i| self.at(x(i), f(x(i)))).collect();
        canvas.path(&points, ink);
    }
}
