//! Solids that overlap: the one of the higher priority is there.

use super::svg::{CAMERA, Canvas, FAINT, GLASS, GREEN, INK, Ink, LABEL, LIGHT, Point, VIOLET};

const WATER: &str = "#7fd0c0";
const ICE: &str = "#c9b8e8";

/// A solid, by where the ray goes in and out of it.
struct Solid {
    name: &'static str,
    priority: i32,
    index: &'static str,
    /// Spans along the ray, in pixels from the left border of a half.
    spans: &'static [[f64; 2]],
}

const SOLIDS: [Solid; 3] = [
    Solid { name: "glass", priority: 1, index: "1.5", spans: &[[60.0, 92.0], [268.0, 300.0]] },
    Solid { name: "water", priority: 0, index: "1.33", spans: &[[76.0, 284.0]] },
    Solid { name: "ice", priority: 2, index: "1.31", spans: &[[146.0, 214.0]] },
];

/// What is at `x`.
fn at(x: f64) -> Option<&'static Solid> {
    let holds = |solid: &&Solid| solid.spans.iter().any(|[from, to]| (*from..*to).contains(&x));
    SOLIDS.iter().filter(holds).max_by_key(|solid| solid.priority)
}

/// The borders along the ray, and whether something changes there.
fn borders() -> Vec<(f64, bool)> {
    let mut places: Vec<f64> =
        SOLIDS.iter().flat_map(|solid| solid.spans.iter().flatten().copied()).collect();
    places.sort_by(f64::total_cmp);
    let name = |x: f64| at(x).map(|solid| solid.name);
    places.into_iter().map(|x| (x, name(x - 0.5) != name(x + 0.5))).collect()
}

const RAY: f64 = 172.0;

pub fn draw() -> Canvas {
    let mut canvas = Canvas::new([760.0, 400.0], "Priorities of solids that overlap");
    let x = 14.0;
    canvas.text([x + 10.0, 34.0], "As modelled: solids overlap", LABEL.bold());
    glass(&mut canvas, x, true);
    canvas.rect([x + 76.0, 116.0], [208.0, 160.0], Ink::line(GREEN).filled(WATER, 0.4));
    canvas.rect([x + 146.0, 96.0], [68.0, 104.0], Ink::line(VIOLET).filled(ICE, 0.6));
    ray(&mut canvas, x);
    for (place, counts) in borders() {
        let ink = if counts { Ink::fill(LIGHT) } else { Ink::line(FAINT).filled("#ffffff", 1.0) };
        canvas.circle([x + place, RAY], 4.5, ink);
    }
    canvas.text([x + 180.0, 87.0], "ice: priority 2", LABEL.middle().color(VIOLET));
    canvas.text([x + 180.0, 248.0], "water: priority 0", LABEL.middle().color(GREEN));
    canvas.text([x + 180.0, 322.0], "glass: priority 1", LABEL.middle().color(CAMERA));
    canvas.circle([x + 22.0, 352.0], 4.5, Ink::fill(LIGHT));
    canvas.text([x + 34.0, 357.0], "interface: light is refracted", LABEL.color(LIGHT));
    canvas.circle([x + 22.0, 376.0], 4.5, Ink::line(FAINT).filled("#ffffff", 1.0));
    canvas.text([x + 34.0, 381.0], "hidden: a higher priority is there already", LABEL.color(FAINT));

    let x = 394.0;
    canvas.text([x + 10.0, 34.0], "As light meets it: no gaps of air", LABEL.bold());
    canvas.rect([x + 92.0, 116.0], [176.0, 144.0], Ink::line(GREEN).filled(WATER, 0.4));
    canvas.rect([x + 146.0, 96.0], [68.0, 104.0], Ink::line(VIOLET).filled("#e6def5", 1.0));
    glass(&mut canvas, x, false);
    ray(&mut canvas, x);
    let mut edges = vec![8.0];
    edges.extend(borders().iter().filter(|(_, counts)| *counts).map(|(place, _)| *place));
    edges.push(352.0);
    for place in &edges[1..edges.len() - 1] {
        canvas.circle([x + place, RAY], 4.5, Ink::fill(LIGHT));
    }
    for (i, pair) in edges.windows(2).enumerate() {
        let middle = 0.5 * (pair[0] + pair[1]);
        let index = at(middle).map_or("1", |solid| solid.index);
        // Narrow spans have their numbers by turns above and below the ray.
        let y = if i % 2 == 0 { RAY - 12.0 } else { RAY + 24.0 };
        canvas.text([x + middle, y], index, LABEL.middle().bold());
    }
    canvas.text([x + 10.0, 357.0], "Numbers are the index of refraction", LABEL);
    canvas.text([x + 10.0, 377.0], "along the ray.", LABEL);
    canvas
}

fn glass(canvas: &mut Canvas, x: f64, is_modelled: bool) {
    let outline: [Point; 8] = [
        [60.0, 70.0],
        [92.0, 70.0],
        [92.0, 260.0],
        [268.0, 260.0],
        [268.0, 70.0],
        [300.0, 70.0],
        [300.0, 292.0],
        [60.0, 292.0],
    ];
    let fill = if is_modelled { 0.5 } else { 1.0 };
    let color = if is_modelled { GLASS } else { "#c9e1f2" };
    canvas.polygon(&outline.map(|[px, py]| [x + px, py]), Ink::line(CAMERA).filled(color, fill));
}

fn ray(canvas: &mut Canvas, x: f64) {
    canvas.arrow(&[[x + 8.0, RAY], [x + 352.0, RAY]], Ink::line(INK).wide(1.8));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_higher_priority_is_there() {
        let names = [70.0, 85.0, 100.0, 180.0, 276.0, 290.0].map(|x| at(x).map(|solid| solid.name).unwrap());
        assert_eq!(names, ["glass", "glass", "water", "ice", "glass", "glass"]);
        let hidden: Vec<f64> = borders().into_iter().filter(|(_, counts)| !counts).map(|(x, _)| x).collect();
        assert_eq!(hidden, [76.0, 284.0]);
    }
}
