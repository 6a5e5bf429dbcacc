//! Film, filter, sampler and integrator.

use scenefile::Span;
use scenefile::desc::{FilterKind, IntegratorKind, View};

use super::Importer;
use super::params::Params;
use super::white::WhiteBalance;

impl Importer {
    /// Understands what came before the world.
    pub(super) fn settle(&mut self, world: Span) {
        self.desc.film.view = View::Srgb;
        // pbrt's defaults.
        self.desc.film.size = [1280, 720];
        self.desc.film.filter = FilterKind::Gaussian;
        self.desc.film.filter_radius = Some(1.5);
        self.desc.render.passes = 16;
        self.desc.render.max_depth = Some(5);
        self.preamble.crop = crop(self.desc.film.size, None, None);
        self.preamble.diagonal_mm = 35.0;
        if let Some((params, kind)) = self.preamble.film.take() {
            self.film(&params, &kind);
        }
        if let Some((params, kind)) = self.preamble.filter.take() {
            self.filter(&params, &kind);
        }
        if let Some((params, kind)) = self.preamble.sampler.take() {
            self.sampler(&params, &kind);
        }
        if let Some((params, kind)) = self.preamble.integrator.take() {
            self.integrator(&params, &kind);
        }
        self.camera(world);
    }

    fn film(&mut self, params: &Params, kind: &str) {
        let report = &mut self.report;
        if !matches!(kind, "rgb" | "image" | "gbuffer" | "spectral") {
            report.error("unknown-kind", format!("there is no film `{kind}`"), params.span);
        }
        if kind == "spectral" {
            report.instead("a spectral film is not rendered", "its picture is linear RGB", params.span);
        }
        let side = [1, 65536];
        self.desc.film.size = [
            params.integer(report, "xresolution", 1280, side),
            params.integer(report, "yresolution", 720, side),
        ];
        let given = |name| params.find(name, &["float", "integer"]).map(|p| p.numbers().to_vec());
        self.preamble.crop = crop(self.desc.film.size, given("cropwindow"), given("pixelbounds"));
        if self.preamble.crop.is_none() {
            let text = "the part of the picture that is to be rendered is empty";
            report.error("out-of-range", text, params.span);
        }
        // Neither names nor what is stored beside the radiance change it.
        self.preamble.diagonal_mm = params.positive(report, "diagonal", 35.0);
        let names = ["filename", "savefp16", "maxcomponentvalue", "coordinatesystem", "nbuckets"];
        params.ignore(&names);
        params.ignore(&["lambdamin", "lambdamax"]);
        // pbrt-v4, PixelSensor: radiance is multiplied by the exposure time and by ISO / 100.
        let (iso, time) = (params.number_or("iso", 100.0), params.number_or("exposuretime", 1.0));
        self.gain = iso / 100.0 * time * params.number_or("scale", 1.0);
        if self.gain <= 0.0 {
            report.error("out-of-range", "`iso` and `exposuretime` must be greater than 0", params.span);
        }
        if let Some(sensor) = params.find("sensor", &["string"])
            && sensor.text() != Some("cie1931")
        {
            report.instead(
                "the colours of a camera's sensor are not imitated",
                "those of the eye are",
                sensor.span,
            );
        }
        if let Some(white) = params.find("whitebalance", &["float"])
            && let Some(&kelvin) = white.numbers().first().filter(|kelvin| **kelvin > 0.0)
        {
            self.white = WhiteBalance::from_kelvin(kelvin);
            let text = "the picture's white balance";
            report.instead(text, "the lights are balanced in its place", white.span);
        }
        params.finish(report);
    }

    fn filter(&mut self, params: &Params, kind: &str) {
        let radius = |default: f64| {
            let [x, y] = ["xradius", "yradius"].map(|name| params.number_or(name, default));
            ([x, y], x.max(y))
        };
        let (kind, ([x, y], radius)) = match kind {
            "box" => (FilterKind::Box, radius(0.5)),
            "gaussian" => (FilterKind::Gaussian, radius(1.5)),
            "mitchell" => (FilterKind::Mitchell, radius(2.0)),
            "triangle" => (FilterKind::Triangle, radius(2.0)),
            "sinc" => {
                let text = "the sinc filter is not rendered";
                self.report.instead(text, "Mitchell's filter of radius 2 takes its place", params.span);
                radius(4.0);
                (FilterKind::Mitchell, ([2.0, 2.0], 2.0))
            }
            _ => {
                self.report.error("unknown-kind", format!("there is no filter `{kind}`"), params.span);
                return;
            }
        };
        if x != y {
            let text = "a filter of unequal radii is not rendered";
            self.report.instead(text, "the greater one holds both ways", params.span);
        }
        if !(0.5..=16.0).contains(&radius) {
            self.report.error(
                "out-of-range",
                "the radius of the filter must be 0.5 to 16 pixels",
                params.span,
            );
            return;
        }
        params.ignore(&["B", "C", "tau", "sigma", "alpha"]);
        self.desc.film.filter = kind;
        self.desc.film.filter_radius = Some(radius as f32);
        params.finish(&mut self.report);
    }

    fn sampler(&mut self, params: &Params, kind: &str) {
        let report = &mut self.report;
        let most = [1, 4_194_304];
        let passes = if kind == "stratified" {
            let side = |report: &mut _, name| params.integer(report, name, 4, [1, 2048]);
            side(report, "xsamples") * side(report, "ysamples")
        } else {
            params.integer(report, "pixelsamples", 16, most)
        };
        self.desc.render.passes = passes;
        if let Some(seed) = params.number("seed") {
            self.desc.render.seed = seed.max(0.0) as u64;
        }
        // How samples are spread does not change what they converge to.
        params.ignore(&["randomization", "jitter", "dimensions"]);
        params.finish(report);
    }

    /// pbrt's `maxdepth` counts scattering events, as ours does: 0 is emission alone, 1 direct light. A path tracer
    /// adds emission, ends if it has scattered so often, else samples a light and scatters.
    fn integrator(&mut self, params: &Params, kind: &str) {
        let report = &mut self.report;
        let depth = params.integer(report, "maxdepth", 5, [0, u32::MAX]);
        if depth == 0 {
            let text = "a picture of lights alone is not rendered";
            report.instead(text, "it has direct light, too", params.span);
        }
        self.desc.render.max_depth = Some(depth.max(1));
        self.desc.render.integrator = match kind {
            "path" | "volpath" | "bdpt" | "mlt" | "simplepath" | "simplevolpath" | "randomwalk"
            | "lightpath" => IntegratorKind::Auto,
            "sppm" => {
                let sppm = &mut self.desc.sppm;
                if let Some(photons) = params.number("photonsperiteration").filter(|n| *n >= 1.0) {
                    sppm.photons = Some(photons as u64);
                }
                if let Some(radius) = params.number("radius").or(params.number("initialradius")) {
                    sppm.radius = Some(radius as f32);
                }
                if let Some(n) = params.number("iterations").or(params.number("numiterations")) {
                    self.desc.render.passes = (n as u32).clamp(1, 4_194_304);
                }
                report.asks_for_sppm(&self.desc.sppm, params.span);
                IntegratorKind::Sppm
            }
            "whitted" | "directlighting" | "ao" | "ambientocclusion" | "function" => {
                let text = format!("the integrator `{kind}` is not imitated");
                report.instead(text, "all light up to its depth is rendered", params.span);
                IntegratorKind::Auto
            }
            _ => {
                report.error("unknown-kind", format!("there is no integrator `{kind}`"), params.span);
                return;
            }
        };
        if params.truth("regularize") == Some(true) {
            report.instead("materials are not regularised", "they scatter as described", params.span);
        }
        // Means to the same end.
        let names = [
            "lightsampler",
            "lightsamplestrategy",
            "visualizestrategies",
            "visualizeweights",
            "bootstrapsamples",
            "chains",
            "mutationsperpixel",
            "largestepprobability",
            "sigma",
            "samplelights",
            "samplebsdf",
            "rrthreshold",
            "imagewritefrequency",
            "seed",
            "strategy",
            "cossample",
            "maxdistance",
            "function",
            "nsamples",
            "pixelbounds",
        ];
        params.ignore(&names);
        params.finish(report);
    }
}

/// The part of a picture that is rendered: columns and rows, each from and up to. `None`: nothing of it.
///
/// pbrt-v4, FilmBaseParameters: a window of shares is rounded up to whole pixels at either end; bounds in pixels come first.
fn crop(size: [u32; 2], window: Option<Vec<f64>>, bounds: Option<Vec<f64>>) -> Option<[[u32; 2]; 2]> {
    let clipped = |from: f64, to: f64, axis: usize| {
        let [from, to] = [from, to].map(|x| x.clamp(0.0, f64::from(size[axis])) as u32);
        (from < to).then_some([from, to])
    };
    let share = |x: f64, axis: usize| (x.clamp(0.0, 1.0) * f64::from(size[axis])).ceil();
    match (window.as_deref(), bounds.as_deref()) {
        (_, Some(&[x0, x1, y0, y1])) => Some([clipped(x0, x1, 0)?, clipped(y0, y1, 1)?]),
        (Some(&[x0, x1, y0, y1]), _) => {
            let [x0, x1, y0, y1] = [x0.min(x1), x0.max(x1), y0.min(y1), y0.max(y1)];
            Some([clipped(share(x0, 0), share(x1, 0), 0)?, clipped(share(y0, 1), share(y1, 1), 1)?])
        }
        _ => Some([[0, size[0]], [0, size[1]]]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_of_a_picture() {
        let size = [100, 50];
        assert_eq!(crop(size, None, None), Some([[0, 100], [0, 50]]));
        assert_eq!(crop(size, Some(vec![0.105, 0.5, 0.0, 0.5]), None), Some([[11, 50], [0, 25]]));
        let both = crop(size, Some(vec![0.0, 0.5, 0.0, 0.5]), Some(vec![10.0, 400.0, 20.0, 30.0]));
        assert_eq!(both, Some([[10, 100], [20, 30]]));
        assert_eq!(crop(size, Some(vec![0.5, 0.5, 0.0, 1.0]), None), None);
    }
}
