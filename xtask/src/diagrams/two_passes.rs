//! The two passes of photon mapping: photons from the light, then paths from the camera.

use super::optics::{Circle, along, on_floor, sub, unit};
use super::svg::{CAMERA, Canvas, FAINT, GLASS, GREEN, INK, Ink, LABEL, LIGHT, Point};

const FLOOR: f64 = 280.0;

/// The room of one of the two halves, whose left border lies at `x`.
struct Room {
    lamp: Point,
    ball: Circle,
    wall: f64,
    right: f64,
}

impl Room {
    fn at(x: f64) -> Self {
        let ball = Circle { center: [x + 205.0, 178.0], radius: 36.0 };
        Self { lamp: [x + 190.0, 62.0], ball, wall: x + 20.0, right: x + 350.0 }
    }

    fn draw(&self, canvas: &mut Canvas) {
        let edge = [[self.wall, 62.0], [self.wall, FLOOR], [self.right, FLOOR]];
        canvas.path(&edge, Ink::line(INK).wide(3.0));
        canvas.circle(self.ball.center, self.ball.radius, Ink::line(INK).filled(GLASS, 0.45));
        let [x, y] = self.lamp;
        canvas.rect([x - 16.0, y - 7.0], [32.0, 7.0], Ink::line(LIGHT).filled("#ffd8a8", 1.0));
        canvas.text([x + 26.0, y + 3.0], "L", LABEL.bold().color(LIGHT));
        let [x, y] = self.ball.center;
        canvas.text([x + 36.0, y + 46.0], "S", LABEL.bold());
        canvas.text([self.wall + 9.0, 78.0], "D", LABEL.bold());
    }

    /// The paths of caustic photons: from the lamp through the ball to the floor.
    fn caustic(&self) -> Vec<[Point; 4]> {
        let toward = unit(sub(self.ball.center, self.lamp));
        let across = [-toward[1], toward[0]];
        let path = |i: i32| {
            let target = along(self.ball.center, across, self.ball.radius * 0.86 * f64::from(i) / 4.0);
            let [enter, leave, out] = self.ball.refracts(self.lamp, unit(sub(target, self.lamp)), 1.5)?;
            Some([self.lamp, enter, leave, on_floor(leave, out, FLOOR)])
        };
        (-4..=4).filter_map(path).collect()
    }

    /// The paths of other photons: from the lamp to a matt surface, and on from there.
    fn others(&self) -> Vec<Vec<Point>> {
        let x = self.wall;
        vec![
            vec![self.lamp, [x, 118.0], [x + 58.0, FLOOR], [x + 30.0, 225.0]],
            vec![self.lamp, [x, 172.0], [x + 24.0, FLOOR]],
            vec![self.lamp, [x + 96.0, FLOOR], [x, 205.0]],
            vec![self.lamp, [x + 282.0, FLOOR]],
            vec![self.lamp, [x + 322.0, FLOOR]],
        ]
    }
}

pub fn draw() -> Canvas {
    let mut canvas = Canvas::new([760.0, 352.0], "The two passes of photon mapping");
    let photon = |canvas: &mut Canvas, at: Point, color| canvas.circle(at, 4.0, Ink::fill(color));

    let room = Room::at(10.0);
    canvas.text([24.0, 34.0], "1. From the light: photons", LABEL.bold());
    room.draw(&mut canvas);
    for path in room.others() {
        let end = if path.len() == 4 { 3 } else { path.len() };
        for pair in path[..end].windows(2) {
            canvas.path(pair, Ink::line(FAINT).wide(1.1));
        }
        for &at in &path[1..end] {
            photon(&mut canvas, at, FAINT);
        }
    }
    for path in room.caustic() {
        canvas.path(&path, Ink::line(LIGHT).wide(1.2));
        photon(&mut canvas, path[3], LIGHT);
    }
    photon(&mut canvas, [34.0, 310.0], LIGHT);
    canvas.text([44.0, 315.0], "caustic photons: L S⁺ D", LABEL.color(LIGHT));
    photon(&mut canvas, [34.0, 332.0], FAINT);
    canvas.text([44.0, 337.0], "photons of the global map: all that land on D", LABEL.color(FAINT));

    let room = Room::at(390.0);
    canvas.text([404.0, 34.0], "2. From the camera: estimates", LABEL.bold());
    room.draw(&mut canvas);
    let eye = [room.right - 8.0, 120.0];
    let landed: Vec<Point> = room.caustic().iter().map(|path| path[3]).collect();
    let x = [landed.iter().map(|p| p[0]).sum::<f64>() / landed.len() as f64, FLOOR];
    canvas.ellipse(x, [30.0, 8.0], Ink::line(LIGHT).filled("#ffd8a8", 0.7));
    for path in room.others() {
        for &at in &path[1..path.len().min(3)] {
            photon(&mut canvas, at, "#b5b2aa");
        }
    }
    for &at in &landed {
        photon(&mut canvas, at, LIGHT);
    }
    // A gather ray, and the disc in which the global map is looked up where it lands.
    let gathered = [room.wall, 190.0];
    canvas.ellipse(gathered, [8.0, 26.0], Ink::line(GREEN).filled("#bfe3cd", 0.7));
    canvas.arrow(&[x, along(gathered, [1.0, 0.0], 3.0)], Ink::line(GREEN));
    canvas.text([room.wall + 22.0, 180.0], "gather ray", LABEL.color(GREEN));
    // The shadow ray meets the ball.
    let toward = unit(sub(room.lamp, x));
    let stop = room.ball.meets(x, toward).map_or(0.0, |[near, _]| near);
    canvas.path(&[x, along(x, toward, stop)], Ink::line(INK).dashed());
    canvas.arrow(&[eye, along(x, unit(sub(eye, x)), 3.0)], Ink::line(CAMERA).wide(2.0));
    camera(&mut canvas, eye, unit(sub(x, eye)));
    canvas.text([room.right - 26.0, 114.0], "E", LABEL.bold().color(CAMERA).end());
    canvas.text([x[0], FLOOR + 24.0], "x", LABEL.bold().middle());
    canvas.text([x[0] + 26.0, FLOOR + 26.0], "disc, radius r", LABEL.color(LIGHT));
    canvas.text([404.0, 337.0], "dashed: a shadow ray, which S stops", LABEL);
    canvas
}

/// A camera at the start of a path.
pub fn camera(canvas: &mut Canvas, at: Point, toward: Point) {
    let across = [-toward[1], toward[0]];
    let corner = |x: f64, y: f64| along(along(at, toward, x), across, y);
    let body = [corner(-16.0, -8.0), corner(0.0, -8.0), corner(0.0, 8.0), corner(-16.0, 8.0)];
    canvas.polygon(&body, Ink::line(CAMERA).filled("#cfe0f7", 1.0));
    canvas.polygon(
        &[corner(0.0, -3.0), corner(7.0, -6.0), corner(7.0, 6.0), corner(0.0, 3.0)],
        Ink::line(CAMERA).filled("#cfe0f7", 1.0),
    );
}
