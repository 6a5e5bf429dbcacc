//! Sensors with their films, and the integrator.

use std::rc::Rc;

use scenefile::desc::{Camera, CameraKind, FilterKind, FovAxis, IntegratorKind, View};
use scenefile::{Diagnostic, Sourced};

use super::Importer;
use super::plugin::{Plugin, Tag};
use crate::matrix::{Matrix, add, cross, dot, length, narrow, times, unit};
use crate::report::nearest;

const SENSORS: [&str; 13] = [
    "perspective",
    "thinlens",
    "orthographic",
    "telecentric",
    "spherical",
    "perspective_rdist",
    "radiancemeter",
    "irradiancemeter",
    "fluencemeter",
    "distant",
    "batch",
    "measuredbsdf",
    "sphericalcamera",
];

const FILMS: [&str; 5] = ["hdrfilm", "ldrfilm", "mfilm", "tiledhdrfilm", "specfilm"];

const FILTERS: [&str; 6] = ["box", "tent", "gaussian", "mitchell", "catmullrom", "lanczos"];

/// The whole picture of a film, and the part of it that is rendered.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Window {
    size: [f64; 2],
    offset: [f64; 2],
    part: [f64; 2],
}

impl Window {
    /// How far the part's middle lies from the whole one's, in shares of the part: right and up.
    fn shift(&self) -> [f64; 2] {
        let off = |i: usize| (self.offset[i] + self.part[i] / 2.0 - self.size[i] / 2.0) / self.part[i];
        [off(0), -off(1)]
    }
}

impl Importer {
    /// Sets camera, film and sampler, and the mirror that the camera needs.
    pub(super) fn sensor(&mut self, plugin: &Rc<Plugin>) {
        self.desc.film.view = View::Srgb;
        // Mitsuba's defaults.
        self.desc.film.size = [768, 576];
        self.desc.film.filter = FilterKind::Gaussian;
        self.desc.film.filter_radius = Some(1.5);
        self.desc.render.passes = 4;
        let mut window = Window { size: [768.0, 576.0], offset: [0.0; 2], part: [768.0, 576.0] };
        if let Some(film) = self.children(plugin, Tag::Film).first() {
            window = self.film(film);
        }
        if let Some(sampler) = self.children(plugin, Tag::Sampler).first() {
            self.sampler(sampler);
        }
        if let Some(medium) = self.children(plugin, Tag::Medium).first() {
            let text = "a medium around the camera is not rendered";
            self.report.instead(text, "the camera stands in the clear", medium.span);
        }
        plugin.ignore(&[
            "near_clip",
            "far_clip",
            "shutter_open",
            "shutter_close",
            "shutter_open_time",
            "srf",
        ]);
        self.camera(plugin, &window);
        plugin.finish(&mut self.report);
    }

    fn film(&mut self, plugin: &Rc<Plugin>) -> Window {
        let report = &mut self.report;
        if !FILMS.contains(&plugin.kind.as_str()) {
            let wrong = Diagnostic::error("unknown-kind", format!("there is no film `{}`", plugin.kind));
            let help = nearest(&plugin.kind, FILMS.into_iter()).map(|n| format!("did you mean `{n}`?"));
            report.push(wrong.at(plugin.kind_span).maybe_help(help));
        }
        if plugin.kind == "specfilm" {
            report.instead("a spectral film is not rendered", "its picture is linear RGB", plugin.span);
        }
        let side = |report: &mut _, name: &str, default: i64| {
            plugin.integer(report, name, [1, 65536]).unwrap_or(default)
        };
        let size = [side(report, "width", 768), side(report, "height", 576)];
        let offset = ["crop_offset_x", "crop_offset_y"]
            .map(|name| plugin.integer(report, name, [0, 65535]).unwrap_or(0));
        let part = [
            side(report, "crop_width", (size[0] - offset[0]).max(1)),
            side(report, "crop_height", (size[1] - offset[1]).max(1)),
        ];
        if (0..2).any(|i| offset[i] + part[i] > size[i]) {
            let text = "the part of the film that is rendered lies outside of it";
            report.error("out-of-range", text, plugin.span);
        }
        self.desc.film.size = part.map(|n| n as u32);
        // Of what is stored, and how, nothing changes the radiance.
        plugin.ignore(&["file_format", "pixel_format", "component_format", "banner", "attach_log", "gamma"]);
        plugin.ignore(&["sample_border", "high_quality_edges", "compensate", "tonemap_method", "exposure"]);
        plugin.ignore(&["key", "burn", "label", "filename", "variable", "digits"]);
        if let Some(filter) = self.children(plugin, Tag::Filter).first() {
            self.filter(filter);
        }
        plugin.finish(&mut self.report);
        Window {
            size: size.map(|n| n as f64),
            offset: offset.map(|n| n as f64),
            part: part.map(|n| n as f64),
        }
    }

    fn filter(&mut self, plugin: &Plugin) {
        let report = &mut self.report;
        let (kind, radius) = match plugin.kind.as_str() {
            "box" => (FilterKind::Box, plugin.positive(report, "radius", 0.5)),
            "tent" => (FilterKind::Triangle, plugin.positive(report, "radius", 1.0)),
            // Cut at four deviations there, at three here.
            "gaussian" => (FilterKind::Gaussian, 3.0 * plugin.positive(report, "stddev", 0.5)),
            "mitchell" => {
                let third = 1.0 / 3.0;
                let [b, c] = [["A", "b"], ["B", "c"]]
                    .map(|names| names.iter().find_map(|name| plugin.number(report, name)).unwrap_or(third));
                if (b - third).abs() > 1e-2 || (c - third).abs() > 1e-2 {
                    let text = "Mitchell's filter with parameters of its own is not rendered";
                    report.instead(text, "both are 1/3", plugin.span);
                }
                (FilterKind::Mitchell, 2.0)
            }
            "catmullrom" | "lanczos" => {
                let text = format!("the filter `{}` is not rendered", plugin.kind);
                report.instead(text, "Mitchell's takes its place", plugin.span);
                plugin.ignore(&["lobes"]);
                (FilterKind::Mitchell, 2.0)
            }
            kind => {
                let wrong = Diagnostic::error("unknown-kind", format!("there is no filter `{kind}`"));
                let help = nearest(kind, FILTERS.into_iter()).map(|n| format!("did you mean `{n}`?"));
                report.push(wrong.at(plugin.kind_span).maybe_help(help));
                return;
            }
        };
        plugin.finish(report);
        if !(0.5..=16.0).contains(&radius) {
            report.instead(
                "a filter of a radius that is not 0.5 to 16 pixels is not rendered",
                "it is moved there",
                plugin.span,
            );
        }
        self.desc.film.filter = kind;
        self.desc.film.filter_radius = Some(radius.clamp(0.5, 16.0) as f32);
    }

    fn sampler(&mut self, plugin: &Plugin) {
        let report = &mut self.report;
        let passes = plugin.integer(report, "sample_count", [1, 4_194_304]).unwrap_or(4);
        self.desc.render.passes = passes as u32;
        if let Some(seed) = plugin.integer(report, "seed", [0, i64::from(u32::MAX)]) {
            self.desc.render.seed = seed as u64;
        }
        // How samples are spread does not change what they converge to.
        plugin.ignore(&["jitter", "dimension", "scramble"]);
        plugin.finish(report);
    }

    fn camera(&mut self, plugin: &Rc<Plugin>, window: &Window) {
        let span = plugin.span;
        let kind = plugin.kind.as_str();
        if !SENSORS.contains(&kind) {
            let wrong = Diagnostic::error("unknown-kind", format!("there is no sensor `{kind}`"));
            let help = nearest(kind, SENSORS.into_iter()).map(|n| format!("did you mean `{n}`?"));
            self.report.push(wrong.at(plugin.kind_span).maybe_help(help));
            return;
        }
        if !matches!(kind, "perspective" | "thinlens" | "orthographic") {
            let text = format!("the sensor `{kind}` is not rendered");
            self.report.instead(text, "a perspective one takes its place", span);
            plugin.params.iter().for_each(|p| p.mark());
        }
        let m = plugin.place(&mut self.report, "to_world");
        let [left, up, ahead] =
            [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|axis| m.vector(axis));
        let square = [(left, up), (up, ahead), (ahead, left)]
            .iter()
            .all(|(a, b)| dot(*a, *b).abs() < 1e-3 * length(*a) * length(*b));
        let orthographic = kind == "orthographic";
        let even = (length(left) / length(up) - 1.0).abs() < 1e-3
            && (orthographic || (length(ahead) / length(up) - 1.0).abs() < 1e-3);
        if !square || !even {
            let text = "a camera that is sheared or unevenly scaled is not rendered";
            self.report.instead(text, "its view is made square", span);
        }
        // The picture has `left` on its left, ours up × forward; else the world is mirrored, which shows the same.
        if dot(cross(up, ahead), left) < 0.0 {
            self.mirror = Matrix::scale([-1.0, 1.0, 1.0]);
        }
        let report = &mut self.report;
        let mut shift = window.shift();
        let offset = ["principal_point_offset_x", "principal_point_offset_y"]
            .map(|name| plugin.number_or(report, name, 0.0));
        shift[0] += offset[0] * window.size[0] / window.part[0];
        shift[1] -= offset[1] * window.size[1] / window.part[1];
        let half_width = if orthographic { length(left) } else { self.half_width(plugin, window) };
        let Some(half_width) = Some(half_width).filter(|w| *w > 0.0 && w.is_finite()) else {
            let text = "the field of view is not between 0 and 180 degrees";
            self.report.error("out-of-range", text, span);
            return;
        };
        // Of the part that is rendered.
        let half_width = half_width * window.part[0] / window.size[0];
        let scale = length(ahead);
        let focus = plugin.number_or(&mut self.report, "focus_distance", 10_000.0);
        let kind = match kind {
            "orthographic" => CameraKind::Orthographic { extent: 2.0 * half_width as f32 },
            "thinlens" => {
                let lens_radius = plugin.positive(&mut self.report, "aperture_radius", 0.1) * scale;
                let focus_distance = Some((focus * scale) as f32);
                CameraKind::ThinLens { lens_radius: lens_radius as f32, focus_distance }
            }
            _ => CameraKind::Pinhole,
        };
        let (Some(ahead), Some(up)) = (unit(ahead), unit(up)) else { return };
        let eye = m.point([0.0; 3]);
        let world = |p| narrow(self.mirror.point(p));
        let camera = Camera {
            kind,
            position: world(eye),
            look_at: world(add(eye, times(ahead, length(eye).max(1.0)))),
            up: narrow(self.mirror.vector(up)),
            fov: 2.0 * half_width.atan().to_degrees() as f32,
            fov_axis: FovAxis::X,
            shift: shift.map(|s| s as f32),
        };
        self.desc.camera = Some(Sourced::at(camera, span));
    }

    /// Half the width of what a perspective sensor sees at distance 1.
    fn half_width(&mut self, plugin: &Plugin, window: &Window) -> f64 {
        let [width, height] = window.size;
        let report = &mut self.report;
        let axis = plugin.text(report, "fov_axis").unwrap_or("x").to_owned();
        let diagonal = width.hypot(height);
        let Some(fov) = plugin.number(report, "fov") else {
            // In millimetres before a film of 36 × 24, whose diagonal the picture's is.
            let text = plugin.find("focal_length").map(|p| p.value.clone());
            let millimetres = match &text {
                Some(super::plugin::Value::Number(x)) => Some(*x),
                Some(super::plugin::Value::Text(t)) => t.trim().trim_end_matches("mm").trim().parse().ok(),
                _ => Some(50.0),
            };
            return match millimetres {
                Some(f) if f > 0.0 => 36.0f64.hypot(24.0) / (2.0 * f) * width / diagonal,
                _ => f64::NAN,
            };
        };
        plugin.ignore(&["focal_length"]);
        let tangent = (fov.to_radians() / 2.0).tan();
        if !(fov > 0.0 && fov < 180.0) {
            return f64::NAN;
        }
        match axis.as_str() {
            "x" => tangent,
            "y" => tangent * width / height,
            "diagonal" => tangent * width / diagonal,
            "smaller" => tangent * width / width.min(height),
            "larger" => tangent * width / width.max(height),
            other => {
                let text = format!("`{other}` is none of x, y, diagonal, smaller and larger");
                report.error("parameter", text, plugin.span);
                tangent
            }
        }
    }

    /// Mitsuba's depth counts a path's edges: 1 is emission alone, 2 direct light. Ours counts scattering events.
    pub(super) fn integrator(&mut self, plugin: &Rc<Plugin>) {
        let mut plugin = plugin.clone();
        // What only adds to a picture, or decides how it is sampled, holds what renders.
        for _ in 0..8 {
            let wraps =
                ["aov", "moment", "stokes", "adaptive", "irrcache", "multichannel", "volpath_simple_wrapper"];
            let nested = self.children(&plugin, Tag::Integrator);
            match nested.first() {
                Some(inner) if wraps.contains(&plugin.kind.as_str()) => {
                    if matches!(plugin.kind.as_str(), "aov" | "multichannel" | "stokes") {
                        let text = format!("the layers of `{}` are not rendered", plugin.kind);
                        self.report.instead(text, "the picture is", plugin.span);
                    }
                    plugin = inner.clone();
                }
                _ => break,
            }
        }
        let report = &mut self.report;
        let unbounded = plugin.kind == "ao";
        let depth = plugin.integer(report, "max_depth", [-1, i64::from(u32::MAX)]);
        self.desc.render.max_depth = match depth {
            _ if unbounded => Some(1),
            None if plugin.kind == "direct" => Some(1),
            None | Some(-1) => None,
            Some(n @ 0..=1) => {
                let text = format!("a picture of lights alone (`max_depth` {n}) is not rendered");
                report.instead(text, "it has direct light, too", plugin.span);
                Some(1)
            }
            Some(n) => Some((n - 1) as u32),
        };
        if plugin.is(report, "hide_emitters") {
            let text = "lights are not hidden from the camera";
            report.instead(
                text,
                "they are seen",
                plugin.find("hide_emitters").map_or(plugin.span, |p| p.span),
            );
        }
        self.desc.render.integrator = match plugin.kind.as_str() {
            "path" | "volpath" | "volpathmis" | "volpath_simple" | "bdpt" | "mlt" | "pssmlt" | "erpt"
            | "ptracer" | "prb" | "prb_basic" | "prbvolpath" | "direct_reparam" | "prb_reparam"
            | "prb_projective" | "direct_projective" | "emission_reparam" => IntegratorKind::Auto,
            "photonmapper" => IntegratorKind::PhotonMap,
            "sppm" | "ppm" => {
                let sppm = &mut self.desc.sppm;
                if let Some(photons) = plugin.number(report, "photon_count").filter(|n| *n >= 1.0) {
                    sppm.photons = Some(photons as u64);
                }
                if let Some(radius) = plugin.number(report, "initial_radius").filter(|r| *r > 0.0) {
                    sppm.radius = Some(radius as f32);
                }
                if let Some(alpha) = plugin.number(report, "alpha").filter(|a| *a > 0.0 && *a < 1.0) {
                    sppm.alpha = alpha as f32;
                }
                if let Some(n) = plugin.number(report, "max_passes").filter(|n| *n >= 1.0) {
                    self.desc.render.passes = (n as u32).clamp(1, 4_194_304);
                }
                report.asks_for_sppm(&self.desc.sppm, plugin.span);
                IntegratorKind::Sppm
            }
            "direct" => IntegratorKind::Auto,
            "ao" | "vpl" | "depth" | "whitted" | "aov" | "moment" | "stokes" | "multichannel"
            | "adaptive" | "irrcache" | "motion" => {
                let text = format!("the integrator `{}` is not imitated", plugin.kind);
                report.instead(text, "all light up to its depth is rendered", plugin.span);
                IntegratorKind::Auto
            }
            other => {
                let text = format!("there is no integrator `{other}`");
                report.error("unknown-kind", text, plugin.kind_span);
                return;
            }
        };
        // What decides how and not what.
        plugin.params.iter().for_each(|p| p.mark());
    }
}
