//! Lights without a surface.

use crate::desc::{ImageSource, Light, LightKind, PointAmount, SkyMapping, SunSky, TransformStep, Triple};
use crate::diagnostic::{Diagnostic, Report};
use crate::document::Node;
use crate::reader::{Reader, as_table};
use crate::spec;

pub(super) fn light(report: &mut Report, what: String, node: &Node) -> Option<Light> {
    let table = as_table(report, &what, node)?;
    let r = Reader::new(report, &spec::LIGHTS, what, table, node.span);
    let name = r.optional_text(report, "name");
    let light_group = r.optional_text(report, "light_group").flatten().map(|group| group.value);
    let kind = match r.variant() {
        Some("point") => {
            let position = r.point(report, "position");
            let amount = amount(report, &r);
            position.zip(amount).map(|(position, amount)| LightKind::Point { position, amount })
        }
        Some("spot") => spot(report, &r),
        Some("directional") => {
            let direction = r.point(report, "direction");
            let irradiance = r.color(report, "irradiance");
            direction
                .zip(irradiance)
                .map(|(direction, irradiance)| LightKind::Directional { direction, irradiance })
        }
        Some("sun-sky") => sun_sky(report, &r).map(LightKind::SunSky),
        Some(_) => environment(report, &r),
        None => None,
    };
    // A black environment after a mistake: nothing more is said of it, nor of a scene without light.
    let kind = kind.unwrap_or(LightKind::Environment { radiance: [0.0; 3] });
    Some(Light { name: name.flatten().map(|name| name.value), light_group, kind })
}

/// Either `radiance`, or a `file` and what goes with it.
fn environment(report: &mut Report, r: &Reader<'_>) -> Option<LightKind> {
    let radiance = r.optional_color(report, "radiance");
    let mapping = mapping(report, r);
    let scale = r.color(report, "scale");
    let rotation = r.number(report, "rotation");
    let mut transform = super::object::transform(report, r);
    let Some(named) = r.given("file") else {
        if let Some(entry) =
            ["mapping", "scale", "rotation", "transform"].iter().find_map(|name| r.given(name))
        {
            let message = format!("`{}` without `file` in {}", entry.key, r.what);
            report.push(Diagnostic::error("conflict", message).at(entry.key_span));
            return None;
        }
        if r.given("radiance").is_none() {
            let message = format!("missing `radiance` or `file` in {}", r.what);
            report.push(
                Diagnostic::error("missing-key", message)
                    .at(r.span)
                    .help("`radiance` is W/(sr m^2) in each channel, `file` a picture of the sky"),
            );
        }
        return radiance?.map(|radiance| LightKind::Environment { radiance });
    };
    if let Some(other) = r.given("radiance") {
        r.conflict(report, other, named);
        return None;
    }
    let file = r.file(report, "file");
    let degrees = rotation?;
    if degrees != 0.0 {
        transform.insert(0, TransformStep::Rotate { axis: [0.0, 1.0, 0.0], degrees });
    }
    Some(LightKind::Sky { source: ImageSource::File(file?), mapping: mapping?, scale: scale?, transform })
}

fn sun_sky(report: &mut Report, r: &Reader<'_>) -> Option<SunSky> {
    let sun_direction = r.point(report, "sun_direction");
    let turbidity = r.number(report, "turbidity");
    let ground_albedo = r.color(report, "ground_albedo");
    let sun_scale = r.number(report, "sun_scale");
    let sun_angle = r.number(report, "sun_angle");
    let sky_scale = r.number(report, "sky_scale");
    Some(SunSky {
        sun_direction: sun_direction?,
        turbidity: turbidity?,
        ground_albedo: ground_albedo?,
        sun_scale: sun_scale?,
        sun_angle: sun_angle?,
        sky_scale: sky_scale?,
        transform: super::object::transform(report, r),
    })
}

pub(super) fn mapping(report: &mut Report, r: &Reader<'_>) -> Option<SkyMapping> {
    r.word(report, "mapping").map(|word| match word {
        "equal-area" => SkyMapping::EqualArea,
        _ => SkyMapping::LatLong,
    })
}

/// Either `intensity` or `power` with `color`.
fn amount(report: &mut Report, r: &Reader<'_>) -> Option<PointAmount> {
    let intensity = r.optional_color(report, "intensity");
    let power = power(report, r, "intensity");
    match (intensity?, power?) {
        (Some(intensity), _) => Some(PointAmount::Intensity(intensity)),
        (None, Some((watts, color))) => Some(PointAmount::Power { watts, color }),
        (None, None) => {
            let message = format!("missing `intensity` or `power` in {}", r.what);
            report.push(
                Diagnostic::error("missing-key", message)
                    .at(r.span)
                    .help("`intensity` is W/sr in each channel, `power` the total in W"),
            );
            None
        }
    }
}

/// `power` and `color`, and their conflicts with the other way to say how much.
pub(super) fn power(report: &mut Report, r: &Reader<'_>, other: &str) -> Option<Option<(f32, Triple)>> {
    let watts = r.optional_number(report, "power");
    let color = r.optional_color(report, "color");
    if let (Some(a), Some(b)) = (r.given(other), r.given("power")) {
        r.conflict(report, a, b);
        return None;
    }
    if let (Some(entry), None) = (r.given("color"), r.given("power")) {
        let message = format!("`color` without `power` in {}", r.what);
        let help = match r.given(other) {
            Some(_) => format!("write the colour into `{other}`"),
            None if other == "radiance" => "the colour of a surface belongs to its material".to_owned(),
            None => "give the `power` in W".to_owned(),
        };
        report.push(Diagnostic::error("conflict", message).at(entry.key_span).help(help));
        return None;
    }
    let color = color?.unwrap_or([1.0; 3]);
    if let (Some(entry), [0.0, 0.0, 0.0]) = (r.given("color"), color) {
        report.push(
            Diagnostic::error(
                "out-of-range",
                format!("{} is black: it cannot be scaled to a power", r.label("color")),
            )
            .at(entry.node.span),
        );
        return None;
    }
    Some(watts?.map(|watts| (watts, color)))
}

fn spot(report: &mut Report, r: &Reader<'_>) -> Option<LightKind> {
    let position = r.point(report, "position");
    let direction = r.optional_point(report, "direction");
    let target = r.optional_point(report, "target");
    let cone_angle = r.number(report, "cone_angle");
    let falloff_angle = r.number(report, "falloff_angle");
    let amount = amount(report, r);
    if let (Some(cone), Some(falloff)) = (cone_angle, falloff_angle)
        && falloff > cone
    {
        // The default falloff gives way to a narrow cone.
        if let Some(entry) = r.given("falloff_angle") {
            let message = format!("`falloff_angle` of {} is greater than the cone's {cone} degrees", r.what);
            report.push(Diagnostic::error("out-of-range", message).at(entry.node.span));
            return None;
        }
    }
    let falloff_angle = falloff_angle?.min(cone_angle?);
    let (position, direction, target) = (position?, direction?, target?);
    let direction = match (direction, target) {
        (Some(_), Some(_)) => {
            if let (Some(a), Some(b)) = (r.given("direction"), r.given("target")) {
                r.conflict(report, a, b);
            }
            return None;
        }
        (Some(direction), None) => direction,
        (None, Some(target)) => [0, 1, 2].map(|i| target[i] - position[i]),
        (None, None) => {
            r.missing(report, "target");
            return None;
        }
    };
    if direction == [0.0; 3] || !direction.iter().all(|x| x.is_finite()) {
        let message = format!("the target of {} is its position", r.what);
        report.push(
            Diagnostic::error("degenerate", message).at(r.given("target").map(|entry| entry.node.span)),
        );
        return None;
    }
    Some(LightKind::Spot { position, direction, cone_angle: cone_angle?, falloff_angle, amount: amount? })
}
