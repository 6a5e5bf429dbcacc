//! Cameras (glTF 2.0 §3.10): the first that the scene has is used. They look along −z of their nodes, +y up.

use scenefile::Sourced;
use scenefile::desc::{Camera, CameraKind, FovAxis};

use super::Importer;
use super::fault::{Fault, Known};
use super::json::Value;
use crate::matrix::{Matrix, add, narrow, unit};
use crate::stage;

/// Pixels of the picture's shorter side, and of the longer at most.
const SHORTER: f64 = 600.0;
const LONGEST: f64 = 2400.0;

impl<'t> Importer<'t> {
    /// Takes the camera of a node, if it has one and there is none yet.
    pub(super) fn camera(&mut self, node: &'t Value<'t>, world: &Matrix) -> Known<()> {
        let Some((_, camera)) = node.pick("camera", "camera", self.list("cameras")?)? else { return Ok(()) };
        if self.desc.camera.is_some() {
            self.report.note("camera", "the scene has more cameras: the first one is used", node.span());
            return Ok(());
        }
        let wrong = |text: &str| Fault::new("out-of-range", text, camera.span());
        let axis =
            |v: [f64; 3]| unit(world.vector(v)).ok_or_else(|| wrong("the camera's node has no extent"));
        let (forward, up) = (axis([0.0, 0.0, -1.0])?, axis([0.0, 1.0, 0.0])?);
        let position = world.point([0.0; 3]);
        let mut made = Camera {
            position: narrow(position),
            look_at: narrow(add(position, forward)),
            up: narrow(up),
            fov_axis: FovAxis::Y,
            ..Camera::default()
        };
        let aspect;
        if let Some(flat) = camera.get("orthographic") {
            let [x, y] = [flat.number("xmag", 1.0)?.abs(), flat.number("ymag", 1.0)?.abs()];
            if !(x > 0.0 && y > 0.0) {
                return Err(wrong("an orthographic camera without extent"));
            }
            // Half the width and height that are seen.
            made.kind = CameraKind::Orthographic { extent: (2.0 * y) as f32 };
            aspect = x / y;
        } else {
            let lens = camera.get("perspective").ok_or_else(|| wrong("a camera of no known kind"))?;
            let fov = lens.number("yfov", 0.7)?.to_degrees();
            if !(fov > 0.0 && fov < 180.0) {
                return Err(wrong("`yfov` is not in 0..π"));
            }
            made.fov = fov as f32;
            aspect = lens.number("aspectRatio", stage::ASPECT)?;
        }
        if !(1e-3..=1e3).contains(&aspect) {
            return Err(wrong("the camera's aspect is not plausible"));
        }
        let side = |a: f64| (SHORTER * a.max(1.0)).min(LONGEST).round();
        self.desc.film.size = [side(aspect) as u32, side(1.0 / aspect) as u32];
        self.desc.camera = Some(Sourced::at(made, camera.span()));
        Ok(())
    }
}
