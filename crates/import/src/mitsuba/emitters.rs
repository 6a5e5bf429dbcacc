//! Emitters.

use std::rc::Rc;

use scenefile::desc::{
    Emission, EmissionAmount, Image, ImageSource, Light, LightKind, PointAmount, SkyMapping,
};
use scenefile::{Diagnostic, Sourced};

use super::bsdf::Uv;
use super::plugin::{Plugin, Tag};
use super::{Importer, sunsky};
use crate::matrix::narrow;
use crate::picture;
use crate::report::nearest;

/// Kinds that are known, for those that are not.
const KINDS: [&str; 15] = [
    "area",
    "point",
    "spot",
    "directional",
    "directionalarea",
    "constant",
    "envmap",
    "sunsky",
    "timed_sunsky",
    "sun",
    "sky",
    "projector",
    "collimated",
    "volumelight",
    "ies",
];

impl Importer {
    /// What a shape's emitter gives off; `None` where it gives no light.
    pub(super) fn area_emission(&mut self, plugin: &Rc<Plugin>, uv: Uv) -> Option<Sourced<Emission>> {
        plugin.ignore(&["sampling_weight"]);
        if plugin.kind == "directionalarea" {
            let text = "light that leaves a surface in one direction is not rendered";
            self.report.instead(text, "the shape is dark", plugin.span);
            plugin.params.iter().for_each(|p| p.mark());
            return None;
        }
        if plugin.kind != "area" {
            self.unknown_emitter(plugin, "on a shape");
            return None;
        }
        self.light_media(plugin);
        let (rgb, texture) = self.light_color(plugin, "radiance", uv);
        plugin.finish(&mut self.report);
        if rgb.iter().all(|c| *c == 0.0) {
            return None;
        }
        let amount = EmissionAmount::Radiance(narrow(rgb));
        Some(Sourced::at(Emission { amount, texture, two_sided: false }, plugin.span))
    }

    fn unknown_emitter(&mut self, plugin: &Plugin, place: &str) {
        let kind = &plugin.kind;
        if KINDS.contains(&kind.as_str()) {
            let text = format!("the emitter `{kind}` is not rendered {place}");
            self.report.instead(text, "it is dark", plugin.span);
        } else {
            let wrong = Diagnostic::error("unknown-kind", format!("there is no emitter `{kind}`"));
            let help = nearest(kind, KINDS.into_iter()).map(|n| format!("did you mean `{n}`?"));
            self.report.push(wrong.at(plugin.kind_span).maybe_help(help));
        }
        plugin.params.iter().for_each(|p| p.mark());
    }

    /// A medium around a light.
    fn light_media(&mut self, plugin: &Plugin) {
        if let Some(medium) = self.children(plugin, Tag::Medium).first() {
            let text = "media around lights are not rendered";
            self.report.instead(text, "the light stands in the clear", medium.span);
        }
    }

    /// A colour where a texture is not possible.
    fn plain_color(&mut self, plugin: &Rc<Plugin>, name: &str) -> [f64; 3] {
        let (rgb, texture) = self.light_color(plugin, name, Uv::Down);
        if texture.is_some() {
            let text = format!("a texture of {} is not rendered", plugin.what());
            self.report.instead(text, "it shines in white", plugin.span);
        }
        rgb
    }

    /// A light of the scene itself.
    pub(super) fn emitter(&mut self, plugin: &Rc<Plugin>) {
        // One that stands alone so that shapes may refer to it.
        if plugin.kind == "area" {
            return;
        }
        plugin.ignore(&["sampling_weight", "samplingweight"]);
        self.light_media(plugin);
        let place = self.mirror.after(&plugin.place(&mut self.report, "to_world"));
        let kind = match plugin.kind.as_str() {
            "point" => {
                let position = match plugin.triple(&mut self.report, "position") {
                    Some(position) => self.mirror.point(position),
                    None => place.point([0.0; 3]),
                };
                let intensity = narrow(self.plain_color(plugin, "intensity"));
                LightKind::Point { position: narrow(position), amount: PointAmount::Intensity(intensity) }
            }
            "spot" => {
                let cutoff = plugin.number_or(&mut self.report, "cutoff_angle", 20.0).clamp(0.01, 180.0);
                let beam = plugin.number_or(&mut self.report, "beam_width", cutoff * 0.75);
                if !(0.6..0.9).contains(&(beam / cutoff)) {
                    let text = "the edge of a spot light that falls evenly with the angle is not rendered";
                    self.report.instead(text, "it falls smoothly", plugin.span);
                }
                if plugin.find("texture").is_some() {
                    let text = "the texture of a spot light is not rendered";
                    self.report.instead(text, "it shines in one colour", plugin.span);
                }
                LightKind::Spot {
                    position: narrow(place.point([0.0; 3])),
                    direction: narrow(place.vector([0.0, 0.0, 1.0])),
                    cone_angle: cutoff as f32,
                    falloff_angle: (cutoff - beam.clamp(0.0, cutoff)) as f32,
                    amount: PointAmount::Intensity(narrow(self.plain_color(plugin, "intensity"))),
                }
            }
            "directional" => {
                let direction = match plugin.triple(&mut self.report, "direction") {
                    Some(direction) => self.mirror.vector(direction),
                    None => place.vector([0.0, 0.0, 1.0]),
                };
                let irradiance = narrow(self.plain_color(plugin, "irradiance"));
                LightKind::Directional { direction: narrow(direction), irradiance }
            }
            "constant" => LightKind::Environment { radiance: narrow(self.plain_color(plugin, "radiance")) },
            "envmap" => {
                plugin.ignore(&["cache", "gamma", "intensity_scale", "mis_compensation"]);
                let scale = plugin.number_or(&mut self.report, "scale", 1.0) as f32;
                let Some(source) = self.image_file(plugin) else { return };
                let mapping = SkyMapping::LatLong;
                LightKind::Sky { source, mapping, scale: [scale; 3], transform: place.steps() }
            }
            "sunsky" | "timed_sunsky" | "sun" | "sky" => {
                let Some(sky) = sunsky::sun_sky(&mut self.report, plugin, &self.mirror) else { return };
                // Version 3 gives the ground's albedo as a colour.
                let albedo = self.channels(plugin, "albedo");
                let sky = match albedo {
                    Some(albedo) => scenefile::desc::SunSky { ground_albedo: narrow(albedo), ..sky },
                    None => sky,
                };
                LightKind::SunSky(sky)
            }
            "projector" => {
                let Some(kind) = self.projector(plugin, &place) else { return };
                kind
            }
            _ => return self.unknown_emitter(plugin, "here"),
        };
        plugin.finish(&mut self.report);
        if !gives_light(&kind) {
            return;
        }
        let light = Light { name: None, light_group: None, kind };
        self.desc.lights.push(Sourced::at(light, plugin.span));
    }

    fn projector(&mut self, plugin: &Rc<Plugin>, place: &crate::matrix::Matrix) -> Option<LightKind> {
        let scale = plugin.number_or(&mut self.report, "scale", 1.0);
        let fov = plugin.number_or(&mut self.report, "fov", 40.0);
        let textures = self.children(plugin, Tag::Texture);
        plugin.ignore(&["focal_length", "near_clip", "far_clip", "irradiance"]);
        let image: Option<Image> = textures.first().filter(|t| t.kind == "bitmap").and_then(|t| {
            let image = self.image(t, Uv::Down);
            t.finish(&mut self.report);
            image
        });
        let Some(image) = image else {
            let text = "a projector without a picture is not rendered";
            self.report.instead(text, "it is dark", plugin.span);
            return None;
        };
        let source: ImageSource = image.source;
        if !(0.0 < fov && fov < 180.0) {
            let text = "the field of view of a projector is not between 0 and 180 degrees";
            self.report.error("out-of-range", text, plugin.span);
            return None;
        }
        let file = source.file().map(|file| self.desc.resolve(file));
        let size = file.and_then(|file| picture::size(&file)).map(|size| size.map(f64::from));
        let spans_height = plugin.text(&mut self.report, "fov_axis") == Some("y");
        let fov = match size {
            // Over the width or the height there, here over the shorter of the two.
            Some([w, h]) => {
                let over = if spans_height { h } else { w };
                2.0 * ((fov.to_radians() / 2.0).tan() * w.min(h) / over).atan().to_degrees()
            }
            None => fov,
        };
        let text = "the light of a projector is not even on a wall";
        self.report.instead(
            text,
            "its intensity is: it falls by the cube of the cosine to its axis",
            plugin.span,
        );
        // The picture is irradiance / π at distance 1 from the pinhole.
        let intensity = [(scale * std::f64::consts::PI) as f32; 3];
        Some(LightKind::Projector { source, fov: fov as f32, intensity, transform: place.steps() })
    }
}

/// Whether any of it arrives.
fn gives_light(kind: &LightKind) -> bool {
    let lit = |rgb: &[f32; 3]| rgb.iter().any(|c| *c > 0.0);
    match kind {
        LightKind::Point { amount: PointAmount::Intensity(rgb), .. }
        | LightKind::Spot { amount: PointAmount::Intensity(rgb), .. }
        | LightKind::Directional { irradiance: rgb, .. }
        | LightKind::Environment { radiance: rgb }
        | LightKind::Sky { scale: rgb, .. }
        | LightKind::Projector { intensity: rgb, .. } => lit(rgb),
        LightKind::SunSky(sky) => sky.sun_scale > 0.0 || sky.sky_scale > 0.0,
        _ => true,
    }
}
