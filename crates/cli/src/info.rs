//! `nephroid info`.

use std::fmt::Write as _;

use nephroid::desc::{self, Exposure, FilterKind, IntegratorKind, LightKind, Render, WhiteBalance};
use nephroid::{Checkpoint, Lanes, Light, SceneDesc, Survey, film_bytes, light_kind, scene_hash, shape_kind};

use crate::args::InfoArgs;
use crate::checkpoint;
use crate::failure::{Failure, OK, Outcome};
use crate::say;
use crate::scene::{describe, surveyed};

/// Lights that are listed one by one.
const LISTED: usize = 20;

/// Says what is in a scene.
pub fn run(args: &InfoArgs) -> Outcome {
    if Checkpoint::is_one(&args.scene.scene) {
        return checkpoint::info(&args.scene.scene);
    }
    let mut described = describe(&args.scene.scene, &args.scene.changes, Vec::new())?;
    let (survey, warnings) = surveyed(&mut described)?;
    if !warnings.is_empty() {
        say::say(say::painted(&warnings).trim_end());
    }
    let hash = scene_hash(&described.desc).map_err(Failure::runtime)?;
    let mut text = String::new();
    row(&mut text, "scene", &format!("{} ({hash})", args.scene.scene.display()));
    settings(&mut text, &described.desc);
    contents(&mut text, &survey);
    lights(&mut text, &described.desc, &survey.lights);
    say::print(&text)?;
    Ok(OK)
}

/// A name and a value.
pub fn row(text: &mut String, name: &str, value: &str) {
    let _ = writeln!(text, "{name:<11} {value}");
}

/// What would be computed.
pub fn settings(text: &mut String, desc: &SceneDesc) {
    let [w, h] = desc.film.size;
    let filter = match desc.film.filter {
        FilterKind::Box => "box",
        FilterKind::Triangle => "triangle",
        FilterKind::Gaussian => "gaussian",
        FilterKind::Mitchell => "mitchell",
        FilterKind::BlackmanHarris => "blackman-harris",
    };
    let exposure = match desc.film.exposure {
        Exposure::Auto => "automatic exposure".to_owned(),
        Exposure::Ev(ev) => format!("exposure {ev} EV"),
    };
    let white = match desc.film.white_balance {
        WhiteBalance::None => String::new(),
        balance => format!(", white balance {}", balance.text()),
    };
    let view = desc.film.view.name();
    row(text, "picture", &format!("{w}x{h}, {filter} filter, {exposure}{white}, view {view}"));
    let Render { passes, seed, max_depth, .. } = desc.render;
    let depth = max_depth.map_or("unlimited depth".to_owned(), |d| format!("depth {d}"));
    let name = desc.render.integrator.name();
    row(text, "integrator", &format!("{name}, {passes} passes, seed {seed}, {depth}"));
    if desc.render.integrator == IntegratorKind::PhotonMap {
        let m = &desc.photon_map;
        let map = format!(
            "{} photons, {} neighbours; caustics {} photons, {} neighbours; final gather {}",
            m.photons, m.knn, m.caustic_photons, m.caustic_knn, m.final_gather
        );
        row(text, "photon map", &map);
    }
}

/// Counts, bounds and memory.
fn contents(text: &mut String, survey: &Survey) {
    let s = survey.summary;
    let mut objects = format!("{}, {} triangles", s.objects, s.triangles);
    if s.groups + s.instances > 0 {
        let _ = write!(objects, "; {} instances of {} groups", s.instances, s.groups);
    }
    row(text, "objects", &objects);
    row(text, "materials", &format!("{}, {} textures", s.materials, s.textures));
    let b = survey.bounds;
    let point = |p: nephroid::Vec3| format!("({}, {}, {})", p.x, p.y, p.z);
    let bounds =
        if b.is_empty() { "empty".to_owned() } else { format!("{} to {}", point(b.min), point(b.max)) };
    row(text, "bounds", &bounds);
    let film = film_bytes(survey.resolution);
    let parts =
        [("meshes", s.mesh_bytes), ("BVH about", s.bvh_bytes), ("textures", s.texture_bytes), ("film", film)];
    let memory: Vec<_> = parts.iter().map(|(name, n)| format!("{name} {}", bytes(*n))).collect();
    row(text, "memory", &memory.join(", "));
}

/// Lights by power, the strongest first.
fn lights(text: &mut String, desc: &SceneDesc, lights: &[(String, Light)]) {
    let watts = |light: &Light| light.power().to_rgb().map(f64::from).iter().sum::<f64>() / 3.0;
    let mut all: Vec<(usize, f64)> = lights.iter().map(|(_, light)| watts(light)).enumerate().collect();
    all.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
    let total: f64 = all.iter().map(|(_, w)| w).sum();
    let lumens: f64 = lights.iter().map(|(_, light)| seen(light.power())).sum();
    row(text, "lights", &format!("{}, {} W, {} lm", all.len(), figures(total), figures(lumens)));
    for (id, power) in all.iter().take(LISTED) {
        let share = if total > 0.0 { 100.0 * power / total } else { 0.0 };
        let (name, light) = &lights[*id];
        let candela = light.greatest_intensity().map(|i| format!(", {} cd", figures(seen(i))));
        let _ = writeln!(
            text,
            "{:>10} W {:>9} lm {share:>5.1} %  {}{}",
            figures(*power),
            figures(seen(light.power())),
            written(desc, name, light),
            candela.unwrap_or_default()
        );
    }
    if all.len() > LISTED {
        let rest: f64 = all[LISTED..].iter().map(|(_, w)| w).sum();
        let _ = writeln!(text, "{:>10} W in {} more", figures(rest), all.len() - LISTED);
    }
}

/// What the eye sees of watts: lumens, of W/sr candela.
fn seen(watts: Lanes) -> f64 {
    let [r, g, b] = watts.to_rgb().map(f64::from);
    f64::from(desc::WHITE_EFFICACY) * (0.2126 * r + 0.7152 * g + 0.0722 * b)
}

/// Kind and name of a light, as the scene has them.
fn written(desc: &SceneDesc, name: &str, light: &Light) -> String {
    let is_named = |own: &Option<String>| own.as_deref() == Some(name);
    // Sun and sky are two lights of one table.
    let is_part = |own: &Option<String>| {
        own.as_deref()
            .is_some_and(|own| [" (sun)", " (sky)"].iter().any(|part| name.strip_suffix(part) == Some(own)))
    };
    if let Some(light) = desc.lights.iter().find(|light| is_named(&light.name) || is_part(&light.name)) {
        let file = match &light.kind {
            LightKind::Profile { file, .. } => Some(file.display().to_string()),
            LightKind::Sky { source, .. }
            | LightKind::Goniometric { source, .. }
            | LightKind::Projector { source, .. } => Some(source.written().into_owned()),
            LightKind::Point { .. }
            | LightKind::Spot { .. }
            | LightKind::Directional { .. }
            | LightKind::Environment { .. }
            | LightKind::SunSky(_) => None,
        };
        let file = file.map_or(String::new(), |file| format!(" ({file})"));
        return format!("{}{file} {name}", light_kind(light));
    }
    let grouped = desc.groups.values().flat_map(|group| &group.objects);
    let shining: Vec<_> = desc.objects.iter().chain(grouped).filter(|o| o.emission.is_some()).collect();
    if let Some(object) = shining.iter().find(|object| is_named(&object.name)) {
        return format!("{} {name}", shape_kind(&object.shape));
    }
    match light {
        Light::Sphere(_) | Light::Disk(_) | Light::Triangles(_) => {
            // Those without a name are known by their number alone.
            let mut kinds = shining.iter().filter(|o| o.name.is_none()).map(|o| shape_kind(&o.shape));
            let first = kinds.next().unwrap_or("surface");
            let kind = if kinds.all(|kind| kind == first) { first } else { "surface" };
            format!("{kind} {name}")
        }
        // Their names say what they are.
        Light::Point(_)
        | Light::Spot(_)
        | Light::Shaped(_)
        | Light::Directional(_)
        | Light::Environment(_)
        | Light::Sky(_)
        | Light::Sun(_) => name.to_owned(),
    }
}

/// Four figures.
fn figures(number: f64) -> String {
    if number != 0.0 && !(1e-3..1e6).contains(&number.abs()) {
        return format!("{number:.3e}");
    }
    let whole = number.abs().max(1.0).log10().floor() as usize + 1;
    format!("{number:.*}", 4usize.saturating_sub(whole))
}

/// Bytes as people read them, in powers of 1024.
pub fn bytes(n: u64) -> String {
    let mut value = n as f64;
    for unit in ["B", "KiB", "MiB", "GiB"] {
        if value < 1000.0 {
            let digits = usize::from(unit != "B" && value < 99.95);
            return format!("{value:.digits$} {unit}");
        }
        value /= 1024.0;
    }
    format!("{value:.1} TiB")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_and_powers() {
        let sizes = [0, 999, 1000, 1536, 110_000, 5 << 20, 3 << 40].map(bytes);
        assert_eq!(sizes, ["0 B", "999 B", "1.0 KiB", "1.5 KiB", "107 KiB", "5.0 MiB", "3.0 TiB"]);
        let powers = [0.0, 0.5, 12.345, 1234.5, 99999.0, 1e-5, 3e9].map(figures);
        assert_eq!(powers, ["0.000", "0.500", "12.35", "1234", "99999", "1.000e-5", "3.000e9"]);
    }
}
