//! Cameras.

use scenefile::desc::{Camera, CameraKind, FovAxis, SkyMapping};
use scenefile::{Sourced, Span};

use super::Importer;
use super::lens;
use super::params::Params;
use crate::matrix::{Matrix, add, cross, dot, length, narrow, times, unit};

/// What a camera shows on the plane at distance 1 before it (a parallel one: on its film): least and greatest x, then y.
type Window = [f64; 4];

/// The axes of a camera in the world, of any length, and where it stands.
struct Axes {
    right: [f64; 3],
    up: [f64; 3],
    ahead: [f64; 3],
    eye: [f64; 3],
}

impl Importer {
    /// Sets the camera, and the mirror that it needs.
    pub(super) fn camera(&mut self, world: Span) {
        let Some((params, camera_to_world, kind)) = self.preamble.camera.take() else {
            self.report.instead("there is no `Camera`", "one at the origin looks along +z", world);
            let params = Params::new(String::new(), world, Default::default(), Vec::new(), &[]);
            self.perspective(&params, &Axes::of(&Matrix::IDENTITY));
            return;
        };
        params.ignore(&["shutteropen", "shutterclose"]);
        let axes = Axes::of(&camera_to_world);
        match kind.as_str() {
            "perspective" => self.perspective(&params, &axes),
            "orthographic" => self.orthographic(&params, &axes),
            "realistic" => self.realistic(&params, &axes),
            "spherical" => self.spherical(&params, &axes, "equalarea"),
            // Version 3.
            "environment" => self.spherical(&params, &axes, "equirectangular"),
            _ => self.report.error("unknown-kind", format!("there is no camera `{kind}`"), params.span),
        }
        params.finish(&mut self.report);
    }

    fn perspective(&mut self, params: &Params, axes: &Axes) {
        let fov = params.number("fov").or(params.number("halffov").map(|h| 2.0 * h)).unwrap_or(90.0);
        if !(fov > 0.0 && fov < 180.0) {
            let text = "the field of view is not between 0 and 180 degrees";
            self.report.error("out-of-range", text, params.span);
            return;
        }
        let tangent = (fov.to_radians() / 2.0).tan();
        let Some((window, as_given)) = self.window(params) else { return };
        let radius = params.number_or("lensradius", 0.0);
        let focus = params.number("focaldistance").or(params.number("focusdistance")).unwrap_or(1e6);
        let as_given = as_given.then_some(fov);
        self.projective(params, axes, window.map(|x| x * tangent), as_given, [radius, focus]);
    }

    /// Through a lens of `[radius, distance in focus]` in the camera's units; a field of view over the shorter side may be given
    /// beside the window that it means.
    fn projective(
        &mut self,
        params: &Params,
        axes: &Axes,
        window: Window,
        fov: Option<f64>,
        [radius, focus]: [f64; 2],
    ) {
        self.square_axes(axes, params.span);
        self.hands(axes, -1.0);
        let (width, height) = (window[1] - window[0], window[3] - window[2]);
        let (fov, fov_axis) = match fov {
            Some(fov) => (fov, FovAxis::Smaller),
            None => (2.0 * (height / 2.0).atan().to_degrees(), FovAxis::Y),
        };
        let scale = length(axes.ahead);
        let kind = if radius > 0.0 {
            let focus_distance = Some((focus * scale) as f32);
            CameraKind::ThinLens { lens_radius: (radius * scale) as f32, focus_distance }
        } else {
            CameraKind::Pinhole
        };
        let shift = [(window[0] + window[1]) / 2.0 / width, (window[2] + window[3]) / 2.0 / height];
        let camera = Camera { kind, fov: fov as f32, fov_axis, shift: clean(shift), ..Camera::default() };
        self.place(camera, axes.eye, axes.ahead, axes.up, params.span);
    }

    fn orthographic(&mut self, params: &Params, axes: &Axes) {
        self.square_axes(axes, params.span);
        self.hands(axes, -1.0);
        if params.number_or("lensradius", 0.0) > 0.0 {
            let text = "the lens of an orthographic camera is not rendered";
            self.report.instead(text, "everything is in focus", params.span);
        }
        params.ignore(&["focaldistance", "focusdistance"]);
        let Some((window, _)) = self.window(params) else { return };
        let (width, height) = (window[1] - window[0], window[3] - window[2]);
        let camera = Camera {
            kind: CameraKind::Orthographic { extent: (height * length(axes.up)) as f32 },
            fov_axis: FovAxis::Y,
            shift: clean([(window[0] + window[1]) / 2.0 / width, (window[2] + window[3]) / 2.0 / height]),
            ..Camera::default()
        };
        self.place(camera, axes.eye, axes.ahead, axes.up, params.span);
    }

    /// The lens system as one thin lens of the same focal length.
    fn realistic(&mut self, params: &Params, axes: &Axes) {
        params.ignore(&["aperture", "scale", "simpleweighting"]);
        let focus = params.number("focusdistance").or(params.number("focaldistance")).unwrap_or(10.0);
        let focal = self.lens_file(params).filter(|f| *f > 0.0);
        let what = match focal {
            Some(f) => format!("a thin lens of its focal length, {:.1} mm, takes their place", f * 1e3),
            None => "a thin lens of 50 mm takes their place".to_owned(),
        };
        self.report.instead("the lenses of a realistic camera are not traced", &what, params.span);
        let focal = focal.unwrap_or(0.050);
        // Thin lens: 1/f = 1/focus + 1/image.
        let image = if focus > 1.001 * focal { 1.0 / (1.0 / focal - 1.0 / focus) } else { focal };
        let [w, h] = self.desc.film.size.map(f64::from);
        let diagonal = self.preamble.diagonal_mm / 1e3;
        let half = diagonal / 2.0 / w.hypot(h) / image;
        let whole = [-w * half, w * half, -h * half, h * half];
        let window = self.cropped(whole, params.span);
        // In metres; the stop's own diameter, as if it were seen from outside at its size.
        let radius = params.number_or("aperturediameter", 1.0) / 2e3;
        self.projective(params, axes, window, None, [radius, focus]);
    }

    /// Focal length in metres of the system of the `lensfile`.
    fn lens_file(&mut self, params: &Params) -> Option<f64> {
        let param = params.find("lensfile", &["string"])?;
        let path = self.base.join(self.find_file(param.text().unwrap_or_default()));
        let bytes = crate::file::read(&path, lens::MOST_BYTES).ok()?;
        lens::focal_length_mm(&String::from_utf8_lossy(&bytes)).map(|f| f / 1e3)
    }

    /// The whole sphere. pbrt's pictures of it are: of longitudes, u = 0 at +x and u = 1/4 at +z, the top at +y; of equal areas, the
    /// middle at +y, +x right, +z at the bottom (pbrt-v4, SphericalCamera).
    fn spherical(&mut self, params: &Params, axes: &Axes, default: &str) {
        self.square_axes(axes, params.span);
        let names = ["lensradius", "focaldistance", "focusdistance", "frameaspectratio", "screenwindow"];
        params.ignore(&names);
        let size = self.desc.film.size;
        if self.preamble.crop != Some([[0, size[0]], [0, size[1]]]) {
            let text = "a part of a picture of the sphere is not rendered alone";
            self.report.instead(text, "the whole picture is", params.span);
        }
        let back = |v: [f64; 3]| times(v, -1.0);
        let (mapping, hand, ahead, up) = match params.text("mapping").unwrap_or(default) {
            "equirectangular" => (SkyMapping::LatLong, 1.0, back(axes.right), axes.up),
            "equalarea" => (SkyMapping::EqualArea, -1.0, axes.up, back(axes.ahead)),
            other => {
                let text = format!("`{other}` is none of equalarea and equirectangular");
                self.report.error("parameter", text, params.span);
                return;
            }
        };
        self.hands(axes, hand);
        let camera = Camera { kind: CameraKind::Spherical { mapping }, ..Camera::default() };
        self.place(camera, axes.eye, ahead, up, params.span);
    }

    /// The screen window with its part that is rendered, which sets the size of the picture, and whether it is the one that an
    /// absent window means.
    fn window(&mut self, params: &Params) -> Option<(Window, bool)> {
        let size = self.desc.film.size;
        let plain = f64::from(size[0]) / f64::from(size[1]);
        let aspect = params.number("frameaspectratio").filter(|a| *a > 0.0).unwrap_or(plain);
        let natural = |aspect: f64| {
            if aspect > 1.0 { [-aspect, aspect, -1.0, 1.0] } else { [-1.0, 1.0, -1.0 / aspect, 1.0 / aspect] }
        };
        let window = match params.find("screenwindow", &["float"]).map(|p| p.numbers().to_vec()) {
            Some(w) if w.len() == 4 => [w[0], w[1], w[2], w[3]],
            _ => natural(aspect),
        };
        if !(window[1] > window[0] && window[3] > window[2]) {
            self.report.error("out-of-range", "the screen window is empty", params.span);
            return None;
        }
        let cropped = self.cropped(window, params.span);
        Some((cropped, cropped == natural(plain)))
    }

    /// The part of a window that is rendered; the picture has that part's size from now on.
    fn cropped(&mut self, window: Window, span: Span) -> Window {
        let size = self.desc.film.size;
        let [width, height] = [window[1] - window[0], window[3] - window[2]];
        let mut part = window;
        if let Some([columns, rows]) = self.preamble.crop
            && [columns, rows] != [[0, size[0]], [0, size[1]]]
        {
            let x = |column: u32| window[0] + width * f64::from(column) / f64::from(size[0]);
            // Rows count from the top.
            let y = |row: u32| window[3] - height * f64::from(row) / f64::from(size[1]);
            part = [x(columns[0]), x(columns[1]), y(rows[1]), y(rows[0])];
            self.desc.film.size = [columns[1] - columns[0], rows[1] - rows[0]];
        }
        let stretch = width / height * f64::from(size[1]) / f64::from(size[0]);
        if (stretch - 1.0).abs() > 1e-3 {
            let text = "pixels that are not square are not rendered";
            self.report.instead(text, "the picture keeps its width", span);
            let middle = (part[2] + part[3]) / 2.0;
            let half = (part[3] - part[2]) / 2.0 * stretch;
            [part[2], part[3]] = [middle - half, middle + half];
        }
        part
    }

    fn square_axes(&mut self, axes: &Axes, span: Span) {
        let Axes { right, up, ahead, .. } = *axes;
        let scale = length(ahead);
        let square = [dot(right, up), dot(up, ahead), dot(ahead, right)]
            .iter()
            .all(|d| d.abs() < 1e-3 * scale * scale);
        let even = (length(right) / scale - 1.0).abs() < 1e-3 && (length(up) / scale - 1.0).abs() < 1e-3;
        if !square || !even {
            let text = "a camera that is sheared or unevenly scaled is not rendered";
            self.report.instead(text, "its view is made square", span);
        }
    }

    /// Mirrors the world unless `right` lies to the side of `up` × `ahead` times `hand`.
    fn hands(&mut self, axes: &Axes, hand: f64) {
        if hand * dot(cross(axes.up, axes.ahead), axes.right) < 0.0 {
            self.mirror = Matrix::scale([-1.0, 1.0, 1.0]);
        }
    }

    fn place(&mut self, camera: Camera, eye: [f64; 3], ahead: [f64; 3], up: [f64; 3], span: Span) {
        let (Some(ahead), Some(up)) = (unit(ahead), unit(up)) else { return };
        let world = |p| narrow(self.mirror.point(p));
        let camera = Camera {
            position: world(eye),
            look_at: world(add(eye, times(ahead, length(eye).max(1.0)))),
            up: narrow(self.mirror.vector(up)),
            ..camera
        };
        self.desc.camera = Some(Sourced::at(camera, span));
    }
}

impl Axes {
    fn of(camera_to_world: &Matrix) -> Self {
        let [right, up, ahead] =
            [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|axis| camera_to_world.vector(axis));
        Self { right, up, ahead, eye: camera_to_world.point([0.0; 3]) }
    }
}

/// Without the rounding of a window about the middle.
fn clean(shift: [f64; 2]) -> [f32; 2] {
    shift.map(|s| if s.abs() < 1e-6 { 0.0 } else { s as f32 })
}
