//! `[render]`, `[film]`, `[camera]`, `[photon_map]`, `[sppm]`, `[vcm]`.

use crate::desc::{
    Camera, CameraKind, Denoise, DirectLight, Exposure, Film, FilterKind, FovAxis, IntegratorKind, Layers,
    PhotonFilter, PhotonMap, Render, SceneDesc, Sppm, Vcm, VcmTechniques, View, WhiteBalance,
};
use crate::diagnostic::{Diagnostic, Report};
use crate::reader::Reader;
use crate::source::Sourced;

/// Pixels of a picture, at most.
const MOST_PIXELS: u64 = 1 << 30;

pub(super) fn render(report: &mut Report, r: &Reader<'_>, desc: &mut SceneDesc) {
    let integrator = r.word(report, "integrator").map(|word| match word {
        "auto" => IntegratorKind::Auto,
        "path" => IntegratorKind::Path,
        "sppm" => IntegratorKind::Sppm,
        "vcm" => IntegratorKind::Vcm,
        _ => IntegratorKind::PhotonMap,
    });
    let passes = r.integer(report, "passes");
    let seed = r.integer(report, "seed");
    let max_depth = r.optional_integer(report, "max_depth");
    let noise = r.optional_number(report, "noise");
    if let (Some(integrator), Some(passes), Some(seed), Some(max_depth), Some(noise)) =
        (integrator, passes, seed, max_depth, noise)
    {
        desc.render = Render { integrator, passes, seed, max_depth, noise };
    }
}

pub(super) fn film(report: &mut Report, r: &Reader<'_>, desc: &mut SceneDesc) {
    let size = r.size(report, "size");
    let crop = r.optional_window(report, "crop");
    let filter = r.word(report, "filter").map(|word| match word {
        "box" => FilterKind::Box,
        "triangle" => FilterKind::Triangle,
        "gaussian" => FilterKind::Gaussian,
        "mitchell" => FilterKind::Mitchell,
        _ => FilterKind::BlackmanHarris,
    });
    let filter_radius = r.optional_number(report, "filter_radius");
    let exposure =
        r.number_or_word(report, "exposure").map(|value| value.map_or(Exposure::Auto, Exposure::Ev));
    let white_balance = r.number_or_word(report, "white_balance").and_then(|value| match value {
        Ok(kelvin) => Some(WhiteBalance::Kelvin(kelvin)),
        Err(word) => WhiteBalance::from_text(word),
    });
    let layers = r.words(report, "layers").map(|words| {
        let words = words.unwrap_or_default();
        Layers { techniques: words.contains(&"techniques"), lights: words.contains(&"lights") }
    });
    let view = r.word(report, "view").and_then(View::from_name);
    let lut = r.optional_file(report, "lut");
    if let (Some([width, height]), Some(entry)) = (size, r.given("size"))
        && width as u64 * height as u64 > MOST_PIXELS
    {
        let message = format!("a picture of {width} x {height} has more than 2^30 pixels");
        report.push(Diagnostic::error("out-of-range", message).at(entry.node.span));
    }
    if let (Some([width, height]), Some(Some([x0, y0, x1, y1])), Some(entry)) = (size, crop, r.given("crop"))
        && !(x0 < x1 && y0 < y1 && x1 <= width && y1 <= height)
    {
        let message = format!("`crop` is no part of a picture of {width} x {height}");
        let help = format!("[x0, y0, x1, y1]: 0 ≤ x0 < x1 ≤ {width}, 0 ≤ y0 < y1 ≤ {height}");
        report.push(Diagnostic::error("out-of-range", message).at(entry.node.span).help(help));
    }
    let denoise = r.word(report, "denoise").map(|word| match word {
        "auto" => Denoise::Auto,
        "require" => Denoise::Require,
        _ => Denoise::Off,
    });
    if let (Some(size), Some(crop), Some(filter), Some(filter_radius), Some(layers)) =
        (size, crop, filter, filter_radius, layers)
        && let (Some(exposure), Some(white_balance), Some(view), Some(lut), Some(denoise)) =
            (exposure, white_balance, view, lut, denoise)
    {
        desc.film =
            Film { size, crop, filter, filter_radius, exposure, white_balance, view, lut, denoise, layers };
    }
}

pub(super) fn camera(report: &mut Report, r: &Reader<'_>, desc: &mut SceneDesc) {
    let camera = read_camera(report, r);
    // Any camera will do once a mistake is reported, but for a check of its own geometry: the default passes.
    desc.camera = Some(Sourced::at(camera.unwrap_or_default(), r.span));
}

fn read_camera(report: &mut Report, r: &Reader<'_>) -> Option<Camera> {
    let kind = match r.variant() {
        Some("thin-lens") => {
            let lens_radius = r.number(report, "lens_radius");
            let focus_distance = r.optional_number(report, "focus_distance");
            lens_radius
                .zip(focus_distance)
                .map(|(lens_radius, focus_distance)| CameraKind::ThinLens { lens_radius, focus_distance })
        }
        Some("orthographic") => r.number(report, "extent").map(|extent| CameraKind::Orthographic { extent }),
        Some("spherical") => {
            super::light::mapping(report, r).map(|mapping| CameraKind::Spherical { mapping })
        }
        Some(_) => Some(CameraKind::Pinhole),
        None => None,
    };
    let position = r.point(report, "position");
    let look_at = r.point(report, "look_at");
    let up = r.point(report, "up");
    let Camera { fov, fov_axis, shift, .. } = Camera::default();
    let fov = if r.has("fov") { r.number(report, "fov") } else { Some(fov) };
    let fov_axis = if r.has("fov_axis") { self::fov_axis(report, r) } else { Some(fov_axis) };
    let shift = if r.has("shift") { r.pair(report, "shift") } else { Some(shift) };
    Some(Camera {
        kind: kind?,
        position: position?,
        look_at: look_at?,
        up: up?,
        fov: fov?,
        fov_axis: fov_axis?,
        shift: shift?,
    })
}

fn fov_axis(report: &mut Report, r: &Reader<'_>) -> Option<FovAxis> {
    r.word(report, "fov_axis").map(|word| match word {
        "x" => FovAxis::X,
        "y" => FovAxis::Y,
        _ => FovAxis::Smaller,
    })
}

fn kernel(report: &mut Report, r: &Reader<'_>, name: &str) -> Option<PhotonFilter> {
    r.word(report, name).map(|word| match word {
        "cone" => PhotonFilter::Cone,
        "epanechnikov" => PhotonFilter::Epanechnikov,
        _ => PhotonFilter::Constant,
    })
}

pub(super) fn photon_map(report: &mut Report, r: &Reader<'_>, desc: &mut SceneDesc) {
    if let Some(photon_map) = read_photon_map(report, r) {
        desc.photon_map = photon_map;
    }
}

fn read_photon_map(report: &mut Report, r: &Reader<'_>) -> Option<PhotonMap> {
    let photons = r.integer(report, "photons");
    let caustic_photons = r.integer(report, "caustic_photons");
    let knn = r.integer(report, "knn");
    let caustic_knn = r.integer(report, "caustic_knn");
    let filter = kernel(report, r, "filter");
    let caustic_filter = kernel(report, r, "caustic_filter");
    let radius = r.optional_number(report, "radius");
    let caustic_radius = r.optional_number(report, "caustic_radius");
    let final_gather = r.integer(report, "final_gather");
    let caustic_gain = r.number(report, "caustic_gain");
    Some(PhotonMap {
        photons: photons?,
        caustic_photons: caustic_photons?,
        knn: knn?,
        caustic_knn: caustic_knn?,
        filter: filter?,
        caustic_filter: caustic_filter?,
        radius: radius?,
        caustic_radius: caustic_radius?,
        final_gather: final_gather?,
        caustic_gain: caustic_gain?,
    })
}

pub(super) fn sppm(report: &mut Report, r: &Reader<'_>, desc: &mut SceneDesc) {
    if let Some(sppm) = read_sppm(report, r) {
        desc.sppm = sppm;
    }
}

fn read_sppm(report: &mut Report, r: &Reader<'_>) -> Option<Sppm> {
    let photons = r.optional_integer(report, "photons");
    let radius = r.optional_number(report, "radius");
    let radius_pixels = r.number(report, "radius_pixels");
    let alpha = r.number(report, "alpha");
    let direct = r.word(report, "direct").map(|word| match word {
        "photons" => DirectLight::Photons,
        _ => DirectLight::Sampling,
    });
    Some(Sppm {
        photons: photons?,
        radius: radius?,
        radius_pixels: radius_pixels?,
        alpha: alpha?,
        direct: direct?,
    })
}

pub(super) fn vcm(report: &mut Report, r: &Reader<'_>, desc: &mut SceneDesc) {
    if let Some(vcm) = read_vcm(report, r) {
        desc.vcm = vcm;
    }
}

fn read_vcm(report: &mut Report, r: &Reader<'_>) -> Option<Vcm> {
    let techniques = r.word(report, "techniques").map(|word| match word {
        "bdpt" => VcmTechniques::Bdpt,
        "light-tracing" => VcmTechniques::LightTracing,
        "bpm" => VcmTechniques::Bpm,
        "ppm" => VcmTechniques::Ppm,
        _ => VcmTechniques::Vcm,
    });
    let light_paths = r.optional_integer(report, "light_paths");
    let radius = r.optional_number(report, "radius");
    let radius_pixels = r.number(report, "radius_pixels");
    let alpha = r.number(report, "alpha");
    Some(Vcm {
        techniques: techniques?,
        light_paths: light_paths?,
        radius: radius?,
        radius_pixels: radius_pixels?,
        alpha: alpha?,
    })
}
