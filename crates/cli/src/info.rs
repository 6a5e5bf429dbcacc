//! `nephroid info`.

use std::fmt::Write as _;

use nephroid::desc::{FilterKind, IntegratorKind, Render, View};
use nephroid::{Checkpoint, Light, SceneDesc, Survey, film_bytes, scene_hash};

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
    lights(&mut text, &survey.lights);
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
    let view = match desc.film.view {
        View::Agx => "agx",
        View::Srgb => "srgb",
    };
    row(
        text,
        "picture",
        &format!("{w}x{h}, {filter} filter, exposure {} EV, view {view}", desc.film.exposure),
    );
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
fn lights(text: &mut String, lights: &[(String, Light)]) {
    let watts = |light: &Light| light.power().to_rgb().map(f64::from).iter().sum::<f64>() / 3.0;
    let mut all: Vec<(usize, f64)> = lights.iter().map(|(_, light)| watts(light)).enumerate().collect();
    all.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
    let total: f64 = all.iter().map(|(_, w)| w).sum();
    row(text, "lights", &format!("{}, {} W", all.len(), watts_text(total)));
    for (id, power) in all.iter().take(LISTED) {
        let share = if total > 0.0 { 100.0 * power / total } else { 0.0 };
        let (name, light) = &lights[*id];
        let kind = kind(light);
        let _ = writeln!(text, "{:>10} W {share:>5.1} %  {kind} {name}", watts_text(*power));
    }
    if all.len() > LISTED {
        let rest: f64 = all[LISTED..].iter().map(|(_, w)| w).sum();
        let _ = writeln!(text, "{:>10} W in {} more", watts_text(rest), all.len() - LISTED);
    }
}

fn kind(light: &Light) -> &'static str {
    match light {
        Light::Point(_) => "point",
        Light::Spot(_) => "spot",
        Light::Shaped(_) => "shaped",
        Light::Directional(_) => "directional",
        Light::Environment(_) | Light::Sky(_) => "environment",
        Light::Sun(_) => "sun",
        Light::Sphere(_) => "sphere",
        Light::Disk(_) => "disk",
        Light::Triangles(_) => "triangles",
    }
}

/// Four figures.
fn watts_text(watts: f64) -> String {
    if watts != 0.0 && !(1e-3..1e6).contains(&watts.abs()) {
        return format!("{watts:.3e}");
    }
    let whole = watts.abs().max(1.0).log10().floor() as usize + 1;
    format!("{watts:.*}", 4usize.saturating_sub(whole))
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
        let powers = [0.0, 0.5, 12.345, 1234.5, 99999.0, 1e-5, 3e9].map(watts_text);
        assert_eq!(powers, ["0.000", "0.500", "12.35", "1234", "99999", "1.000e-5", "3.000e9"]);
    }
}
