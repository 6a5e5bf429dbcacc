//! Multiple importance sampling in `auto`: three ways to one path, and their weights.

use super::optics::{along, sub, unit};
use super::plot::Plot;
use super::svg::{CAMERA, Canvas, FAINT, GREEN, INK, Ink, LABEL, LIGHT, Point};
use super::two_passes::camera;

const FLOOR: f64 = 220.0;

/// The weight of merging in a plane mirror, where the lamp is a disc of radius `a`: n photons, not aimed, within r. There
/// n·π·r²·p_L/p_E = n·π·r²/(π·a²).
fn merge(a: f64, n: f64, r: f64) -> f64 {
    n * r * r / (n * r * r + a * a)
}

/// What all three ways have in common; `left` is the border of its third.
struct Scene {
    eye: Point,
    x: Point,
    z: Point,
    lamp: Point,
}

impl Scene {
    fn draw(canvas: &mut Canvas, left: f64) -> Self {
        let scene = Self {
            eye: [left + 222.0, 104.0],
            x: [left + 128.0, FLOOR],
            z: [0.0; 2],
            lamp: [left + 150.0, 70.0],
        };
        // The lamp's image in the mirror gives the place of the reflection.
        let mirror = left + 36.0;
        let image = [2.0 * mirror - scene.lamp[0], scene.lamp[1]];
        let way = sub(image, scene.x);
        let z = along(scene.x, way, (mirror - scene.x[0]) / way[0]);
        canvas.path(&[[left + 12.0, FLOOR], [left + 240.0, FLOOR]], Ink::line(INK).wide(3.0));
        canvas.rect([mirror - 8.0, z[1] - 44.0], [8.0, 88.0], Ink::line(INK).filled("#c8ccd0", 1.0));
        let [x, y] = scene.lamp;
        canvas.rect([x - 16.0, y - 7.0], [32.0, 7.0], Ink::line(LIGHT).filled("#ffd8a8", 1.0));
        canvas.text([x + 22.0, y + 2.0], "L", LABEL.bold().color(LIGHT));
        canvas.text([scene.x[0], FLOOR + 20.0], "x (D)", LABEL.bold().middle());
        canvas.text([left + 16.0, z[1] - 54.0], "S", LABEL.bold());
        canvas.text([left + 206.0, 98.0], "E", LABEL.bold().color(CAMERA).middle());
        Self { z, ..scene }
    }
}

pub fn draw() -> Canvas {
    let mut canvas = Canvas::new([760.0, 500.0], "Three techniques for one path, and their weights");
    let seen = Ink::line(CAMERA).wide(2.0);
    let lit = Ink::line(LIGHT).wide(2.0);

    canvas.text([24.0, 34.0], "Emission", LABEL.bold());
    let scene = Scene::draw(&mut canvas, 8.0);
    canvas.arrow(&[scene.eye, scene.x, scene.z, scene.lamp], seen);
    camera(&mut canvas, scene.eye, unit(sub(scene.x, scene.eye)));

    canvas.text([276.0, 34.0], "Direct, if S is rough", LABEL.bold());
    let scene = Scene::draw(&mut canvas, 260.0);
    canvas.arrow(&[scene.eye, scene.x, scene.z], seen);
    canvas.path(&[scene.z, scene.lamp], Ink::line(CAMERA).wide(2.0).dashed());
    camera(&mut canvas, scene.eye, unit(sub(scene.x, scene.eye)));

    canvas.text([528.0, 34.0], "Merge", LABEL.bold());
    let scene = Scene::draw(&mut canvas, 512.0);
    canvas.ellipse(scene.x, [24.0, 7.0], Ink::line(LIGHT).filled("#ffd8a8", 0.7));
    canvas.arrow(&[scene.eye, scene.x], seen);
    let landed = along(scene.x, [1.0, 0.0], -12.0);
    // The photon's own reflection, from its own image of the lamp.
    let mirror = scene.z[0];
    let way = sub([2.0 * mirror - scene.lamp[0], scene.lamp[1]], landed);
    let z = along(landed, way, (mirror - landed[0]) / way[0]);
    canvas.arrow(&[scene.lamp, z, landed], lit);
    camera(&mut canvas, scene.eye, unit(sub(scene.x, scene.eye)));

    canvas.text([24.0, 282.0], "Weights in a smooth mirror, by the size of the lamp", LABEL.bold());
    let plot = Plot { origin: [64.0, 452.0], size: [400.0, 150.0], x: [-2.0, 1.0], y: [0.0, 1.0] };
    let x_ticks = [(-2.0, "1 cm"), (-1.0, "10 cm"), (0.0, "1 m"), (1.0, "10 m")];
    plot.axes(&mut canvas, &x_ticks, &[(0.0, "0"), (0.5, "½"), (1.0, "1")]);
    canvas.text([264.0, 490.0], "radius a of the lamp", LABEL.middle());
    let (n, r) = (65_536.0, 0.003);
    plot.curve(&mut canvas, 90, lit, |x| merge(10f64.powf(x), n, r));
    plot.curve(&mut canvas, 90, seen, |x| 1.0 - merge(10f64.powf(x), n, r));
    canvas.text([96.0, 326.0], "merge", LABEL.color(LIGHT));
    canvas.text([96.0, 440.0], "emission", LABEL.color(CAMERA));
    canvas.text([496.0, 324.0], "w_merge = n·r²/(n·r² + a²)", LABEL.color(LIGHT));
    canvas.text([496.0, 348.0], "w_emission = a²/(n·r² + a²)", LABEL.color(CAMERA));
    canvas.text([496.0, 380.0], "n = 65 536 photons, not aimed,", LABEL.color(FAINT));
    canvas.text([496.0, 400.0], "r = 3 mm. Both are ½ where", LABEL.color(FAINT));
    canvas.text([496.0, 420.0], &format!("a = r·√n = {:.2} m.", r * f64::sqrt(n)), LABEL.color(FAINT));
    canvas.text([496.0, 444.0], "A point has a = 0: merge alone.", LABEL.color(GREEN));
    canvas
}

#[cfg(test)]
mod tests {
    #[test]
    fn weights_are_even_where_the_lamp_is_as_large_as_all_discs() {
        assert!((super::merge(0.768, 65_536.0, 0.003) - 0.5).abs() < 1e-12);
        assert_eq!(super::merge(0.0, 65_536.0, 0.003), 1.0);
    }
}
