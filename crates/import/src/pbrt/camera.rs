//! Cameras.

use scenefile::desc::{Camera, CameraKind, FovAxis};
use scenefile::{Sourced, Span};

use super::Importer;
use super::params::Params;
use crate::matrix::{Matrix, add, cross, dot, length, narrow, times, unit};

impl Importer {
    /// Sets the camera, and the mirror that it needs. `size`: of the picture.
    pub(super) fn camera(&mut self, size: [u32; 2], world: Span) {
        let Some((params, camera_to_world, kind)) = self.preamble.camera.take() else {
            self.report.instead("there is no `Camera`", "one at the origin looks along +z", world);
            let params = Params::new(String::new(), world, Default::default(), Vec::new(), &[]);
            self.perspective(&params, &Matrix::IDENTITY, size, None);
            return;
        };
        params.ignore(&["shutteropen", "shutterclose"]);
        let m = &camera_to_world;
        let span = params.span;
        match kind.as_str() {
            "perspective" => self.perspective(&params, m, size, None),
            "orthographic" => {
                self.report.instead(
                    "an orthographic camera is not rendered",
                    "a perspective one looks from far away",
                    span,
                );
                self.perspective(&params, m, size, Some(Self::FAR));
            }
            "realistic" => {
                self.report.instead(
                    "the lenses of a realistic camera are not traced",
                    "a thin lens of 50 mm before 35 mm film takes their place",
                    span,
                );
                params.ignore(&["lensfile", "aperture", "scale", "simpleweighting"]);
                self.perspective(&params, m, size, None);
            }
            "spherical" | "environment" => {
                self.report.instead(
                    "a spherical camera is not rendered",
                    "a perspective one shows 90 degrees of what it sees",
                    span,
                );
                params.ignore(&["mapping"]);
                self.perspective(&params, m, size, None);
            }
            _ => self.report.error("unknown-kind", format!("there is no camera `{kind}`"), span),
        }
        params.finish(&mut self.report);
    }

    /// Distance of the eye, in half heights of what it sees, from which perspective passes for none.
    const FAR: f64 = 1000.0;

    fn perspective(&mut self, params: &Params, m: &Matrix, size: [u32; 2], back: Option<f64>) {
        let span = params.span;
        let aspect = params.number_or("frameaspectratio", f64::from(size[0]) / f64::from(size[1]));
        let natural = if aspect > 1.0 {
            [-aspect, aspect, -1.0, 1.0]
        } else {
            [-1.0, 1.0, -1.0 / aspect, 1.0 / aspect]
        };
        let window = match params.find("screenwindow", &["float"]).map(|p| p.numbers().to_vec()) {
            Some(w) if w.len() == 4 => [w[0], w[1], w[2], w[3]],
            _ => natural,
        };
        let (width, height) = (window[1] - window[0], window[3] - window[2]);
        if !(width > 0.0 && height > 0.0) {
            self.report.error("out-of-range", "the screen window is empty", span);
            return;
        }
        let center = [(window[0] + window[1]) / 2.0, (window[2] + window[3]) / 2.0];
        if center.iter().any(|c| c.abs() > 1e-4 * height) {
            self.report.instead(
                "a screen window off the middle is not rendered",
                "it is moved to the middle",
                span,
            );
        }
        let shape = width / height * f64::from(size[1]) / f64::from(size[0]);
        if (shape - 1.0).abs() > 1e-3 {
            self.report.instead(
                "pixels that are not square are not rendered",
                "the picture keeps its width",
                span,
            );
        }
        let fov = params.number("fov").or(params.number("halffov").map(|h| 2.0 * h)).unwrap_or(90.0);
        // A 50 mm lens before 35 mm film, whose shorter side is 24 mm.
        let tangent = match (params.number("aperturediameter"), back) {
            (Some(_), _) => 12.0 / 50.0,
            (_, Some(far)) => 1.0 / far,
            _ => (fov.to_radians() / 2.0).tan(),
        };
        // `fov` spans the shorter side of a window of ±1 there.
        let half_height = tangent * width / 2.0 * f64::from(size[1]) / f64::from(size[0]);
        let degrees = 2.0 * half_height.atan().to_degrees();
        let as_given = window == natural && back.is_none() && params.number("frameaspectratio").is_none();
        let (fov, fov_axis) = if as_given && params.number("aperturediameter").is_none() {
            (fov, FovAxis::Smaller)
        } else {
            (degrees, FovAxis::Y)
        };
        if !(fov > 0.0 && fov < 180.0) {
            self.report.error("out-of-range", "the field of view is not between 0 and 180 degrees", span);
            return;
        }
        let [right, up, ahead] =
            [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|axis| m.vector(axis));
        let scale = length(ahead);
        let square = [dot(right, up), dot(up, ahead), dot(ahead, right)]
            .iter()
            .all(|d| d.abs() < 1e-3 * scale * scale);
        let even = (length(right) / scale - 1.0).abs() < 1e-3 && (length(up) / scale - 1.0).abs() < 1e-3;
        if !square || !even {
            self.report.instead(
                "a camera that is sheared or unevenly scaled is not rendered",
                "its view is made square",
                span,
            );
        }
        // pbrt's picture has `right` on the right, ours forward × up.
        if dot(cross(ahead, up), right) < 0.0 {
            self.mirror = Matrix::scale([-1.0, 1.0, 1.0]);
        }
        let radius = params.number("lensradius").or(params.number("aperturediameter").map(|d| d / 2000.0));
        let focus = params.number("focaldistance").or(params.number("focusdistance")).unwrap_or(1e6);
        let kind = match radius {
            Some(radius) if radius > 0.0 => CameraKind::ThinLens {
                lens_radius: (radius * scale) as f32,
                focus_distance: Some((focus * scale) as f32),
            },
            _ => CameraKind::Pinhole,
        };
        let (Some(ahead), Some(up)) = (unit(ahead), unit(up)) else { return };
        let eye = m.point([0.0; 3]);
        let eye = if let Some(far) = back { add(eye, times(ahead, -far * scale)) } else { eye };
        let world = |p| narrow(self.mirror.point(p));
        let camera = Camera {
            kind,
            position: world(eye),
            look_at: world(add(eye, times(ahead, length(eye).max(1.0)))),
            up: narrow(self.mirror.vector(up)),
            fov: fov as f32,
            fov_axis,
            shift: [0.0; 2],
        };
        self.desc.camera = Some(Sourced::at(camera, span));
    }
}
