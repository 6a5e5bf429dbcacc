//! Lights without a surface.

use std::f32::consts::PI;

use super::amount::{self, Amount};
use crate::desc::{
    ImageSource, Light, LightKind, PointAmount, ProfileAmount, SkyMapping, SunSky, TransformStep, Triple,
};
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
        Some("profile") => profile(report, &r),
        Some("goniometric") => goniometric(report, &r),
        Some("projector") => projector(report, &r),
        Some("directional") => directional(report, &r),
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
    let amount = amount::amount(report, r, "radiance", &["nits", "lux"]);
    let radiance = amount.map(|amount| {
        amount.map(|amount| match amount {
            Amount::Channels(radiance) => radiance,
            // What a plane receives of a whole half of the sphere is π times the radiance.
            Amount::Scaled { key: "lux", value, color } => Amount::channels(value / PI, color),
            Amount::Scaled { value, color, .. } => Amount::channels(value, color),
        })
    });
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
        if let Some(None) = radiance {
            let message = format!("missing `radiance` or `file` in {}", r.what);
            report.push(
                Diagnostic::error("missing-key", message)
                    .at(r.span)
                    .help("`radiance` is W/(sr m^2) in each channel, `file` a picture of the sky"),
            );
        }
        return radiance?.map(|radiance| LightKind::Environment { radiance });
    };
    if let Some(other) = ["radiance", "nits", "lux"].iter().find_map(|key| r.given(key)) {
        r.conflict(report, other, named);
        return None;
    }
    // What is wrong with a colour has been said.
    radiance?;
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

/// `intensity`, `candela`, `power` or `lumens`.
fn amount(report: &mut Report, r: &Reader<'_>) -> Option<PointAmount> {
    Some(match amount::amount(report, r, "intensity", &["power", "lumens", "candela"])? {
        Some(Amount::Channels(intensity)) => PointAmount::Intensity(intensity),
        Some(Amount::Scaled { key: "candela", value, color }) => {
            PointAmount::Intensity(Amount::channels(value, color))
        }
        Some(Amount::Scaled { key, value, color }) => {
            PointAmount::Power { watts: Amount::watts(key, value, color), color }
        }
        None => {
            let message = format!("missing `intensity` or `power` in {}", r.what);
            report.push(Diagnostic::error("missing-key", message).at(r.span).help(
                "`intensity` is W/sr in each channel, `power` the total in W; or give `candela` or `lumens`",
            ));
            return None;
        }
    })
}

/// `irradiance` or `lux`.
fn directional(report: &mut Report, r: &Reader<'_>) -> Option<LightKind> {
    let direction = r.point(report, "direction");
    let irradiance = match amount::amount(report, r, "irradiance", &["lux"])? {
        Some(Amount::Channels(irradiance)) => irradiance,
        Some(Amount::Scaled { value, color, .. }) => Amount::channels(value, color),
        None => {
            r.missing(report, "irradiance");
            return None;
        }
    };
    Some(LightKind::Directional { direction: direction?, irradiance })
}

/// As the file says times `scale`, or `power` or `lumens` in all.
fn profile(report: &mut Report, r: &Reader<'_>) -> Option<LightKind> {
    let file = r.file(report, "file");
    let scale = r.number(report, "scale");
    let color = amount::color(report, r);
    let [watts, lumens] = ["power", "lumens"].map(|key| r.optional_number(report, key));
    let mut given = ["scale", "power", "lumens"].into_iter().filter_map(|key| r.given(key));
    if let (Some(a), Some(b)) = (given.next(), given.next()) {
        r.conflict(report, a, b);
        return None;
    }
    let color = color?;
    let amount = match (watts?, lumens?) {
        (Some(watts), _) => ProfileAmount::Power { watts, color },
        (None, Some(lumens)) => ProfileAmount::Power { watts: Amount::watts("lumens", lumens, color), color },
        (None, None) => ProfileAmount::AsFile { scale: scale?, color },
    };
    Some(LightKind::Profile { file: file?, transform: super::object::transform(report, r), amount })
}

/// `intensity` or `candela`, where the picture is 1.
fn picture_intensity(report: &mut Report, r: &Reader<'_>) -> Option<Triple> {
    match amount::amount(report, r, "intensity", &["candela"])? {
        Some(Amount::Channels(intensity)) => Some(intensity),
        Some(Amount::Scaled { value, color, .. }) => Some(Amount::channels(value, color)),
        None => {
            r.missing(report, "intensity");
            None
        }
    }
}

fn goniometric(report: &mut Report, r: &Reader<'_>) -> Option<LightKind> {
    let file = r.file(report, "file");
    let mapping = mapping(report, r);
    let intensity = picture_intensity(report, r);
    let transform = super::object::transform(report, r);
    let source = ImageSource::File(file?);
    Some(LightKind::Goniometric { source, mapping: mapping?, intensity: intensity?, transform })
}

fn projector(report: &mut Report, r: &Reader<'_>) -> Option<LightKind> {
    let file = r.file(report, "file");
    let fov = r.number(report, "fov");
    let intensity = picture_intensity(report, r);
    let transform = super::object::transform(report, r);
    let source = ImageSource::File(file?);
    Some(LightKind::Projector { source, fov: fov?, intensity: intensity?, transform })
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
