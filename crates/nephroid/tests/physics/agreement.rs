//! Against pictures that another renderer made, and the integrators against each other.

use std::path::{Path, PathBuf};

use film::encode_exr_rgb;
use nephroid::desc::{IntegratorKind, Material, Object, Shape};
use nephroid::{Comparison, Film, Layer, RgbImage, SceneDesc, compare, difference, encode_png_bytes, load};
use testkit::Moments;

use crate::support::*;
use crate::window::Window;

/// What an image may differ by from its reference.
struct Bars {
    /// Of Σx/Σr − 1, either way.
    bias: f64,
    /// Of the median over 16 × 16 blocks of the relative difference.
    block_median: f64,
}

pub fn reference(name: &str) -> RgbImage {
    let path = root().join("tests/references").join(format!("{name}.exr"));
    RgbImage::read(&path)
        .unwrap_or_else(|e| panic!("{}: {e}: restore it from the repository", path.display()))
}

/// Pixels whose eight neighbours are all in the mask of a scene.
pub fn mask(name: &str) -> Vec<bool> {
    let image = reference(&format!("{name}-mask"));
    let (mask, w, h) = (image.to_mask(), image.width(), image.height());
    let inside = |x: usize, y: usize| {
        (y.saturating_sub(1)..h.min(y + 2))
            .all(|v| (x.saturating_sub(1)..w.min(x + 2)).all(|u| mask[v * w + u]))
    };
    (0..w * h).map(|i| inside(i % w, i / w)).collect()
}

pub fn arena(name: &str, size: u32) -> SceneDesc {
    let mut desc = load(&root().join(format!("scenes/arena/{name}.toml")), &[]).desc.unwrap();
    desc.film.size = [size; 2];
    desc
}

/// A film of 256 × 256 pixels, or of 128 × 128 with every pixel four times: with a box filter, its pixels are means over
/// four pixels of the reference.
pub fn picture(film: &Film) -> RgbImage {
    let (beauty, step) = (film.beauty(), 256 / film.width());
    let pixel = |i: usize| beauty[i / 256 / step * film.width() + i % 256 / step];
    RgbImage::new(256, 256, (0..256 * 256).map(pixel).collect()).unwrap()
}

pub fn average(pictures: &[RgbImage]) -> RgbImage {
    let n = pictures.len() as f32;
    let pixel = |i: usize| {
        pictures.iter().fold([0.0; 3], |s: [f32; 3], p| std::array::from_fn(|c| s[c] + p.pixels()[i][c] / n))
    };
    RgbImage::new(256, 256, (0..256 * 256).map(pixel).collect()).unwrap()
}

pub fn scaled(image: &RgbImage, factor: f32) -> RgbImage {
    let pixels = image.pixels().iter().map(|p| p.map(|v| v * factor)).collect();
    RgbImage::new(image.width(), image.height(), pixels).unwrap()
}

fn failures(c: &Comparison, bars: &Bars) -> Vec<String> {
    let mut failures = Vec::new();
    if c.bias.is_nan() || c.bias.abs() > bars.bias {
        failures.push(format!("bias {:+.3} %, allowed ±{:.3} %", 100.0 * c.bias, 100.0 * bars.bias));
    }
    let median = c.block_median.unwrap_or(f64::NAN);
    if median.is_nan() || median > bars.block_median {
        failures.push(format!(
            "block median {:.3} %, allowed {:.3} %",
            100.0 * median,
            100.0 * bars.block_median
        ));
    }
    if c.nonfinite > 0 {
        failures.push(format!("{} pixels are not finite", c.nonfinite));
    }
    failures
}

/// Writes image, reference and their difference, and returns the folder.
fn keep_for_inspection(name: &str, image: &RgbImage, reference: &RgbImage) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("failed").join(name);
    std::fs::create_dir_all(&folder).unwrap();
    for (file, image) in [("image.exr", image), ("reference.exr", reference)] {
        let bytes = encode_exr_rgb(image.width(), image.height(), image.pixels(), &[]).unwrap();
        std::fs::write(folder.join(file), bytes).unwrap();
    }
    let sheet =
        encode_png_bytes(3 * image.width(), image.height(), &difference(image, reference).unwrap(), &[]);
    std::fs::write(folder.join("difference.png"), sheet.unwrap()).unwrap();
    folder
}

/// Fails unless the mean of independent renders agrees with the reference, and unless the same check rejects it 2 %
/// brighter and 2 % darker. The scatter of the renders must leave room: three standard errors of the bias within the bar.
#[track_caller]
fn assert_agrees(what: &str, renders: &[RgbImage], name: &str, mask: Option<&[bool]>, bars: &Bars) {
    let reference = reference(name);
    let image = average(renders);
    let comparison = compare(&image, &reference, mask).unwrap();
    let failed = failures(&comparison, bars);
    if !failed.is_empty() {
        let folder = keep_for_inspection(what, &image, &reference);
        panic!("{what}: {}; see {}", failed.join(", "), folder.display());
    }
    let biases = Moments::of(renders.iter().map(|r| compare(r, &reference, mask).unwrap().bias));
    assert!(3.0 * biases.standard_error() < bars.bias, "{what}: too noisy to judge: {biases:?}");
    for factor in [PLANTED as f32, 1.0 / PLANTED as f32] {
        let planted = compare(&scaled(&image, factor), &reference, mask).unwrap();
        assert!(!failures(&planted, bars).is_empty(), "{what}: blind to a factor of {factor}: {planted:?}");
    }
}

fn renders(desc: &SceneDesc, integrator: IntegratorKind, n: u64, passes: u32) -> Vec<RgbImage> {
    runs(desc, integrator, n, passes, picture)
}

/// The bars of the project: ±0.5 % and 1 %. A block's own noise: about 40 % a pixel and pass, so 40 %/√(48·256) = 0.4 % a
/// block, of which the median of the absolute value is 0.67 parts; the reference has 0.12 % more.
const PATH_BARS: Bars = Bars { bias: 0.005, block_median: 0.01 };

#[test]
fn path_agrees_with_the_reference_of_box() {
    let renders = renders(&arena("box", 256), PATH, 4, 12);
    assert_agrees("path-box", &renders, "box", None, &PATH_BARS);
}

#[test]
fn path_agrees_with_the_reference_of_box_spheres() {
    let renders = renders(&arena("box-spheres", 256), PATH, 4, 24);
    assert_agrees("path-box-spheres", &renders, "box-spheres", None, &PATH_BARS);
}

/// Photon maps blur, so they are biased where irradiance bends: 2 % is what the project promises outside edges. The
/// tests hold them to 1 % over all pixels, edges included, so that a factor of 2 % on top is found.
const MAP_BARS: Bars = Bars { bias: 0.01, block_median: 0.015 };

/// Four renders of 128 × 128 pixels, each with maps of its own. Few gather rays and many passes, so that direct light is
/// sampled as often as indirect.
fn mapped(name: &str, passes: u32) -> Vec<RgbImage> {
    let mut desc = arena(name, 128);
    desc.photon_map.final_gather = 4;
    renders(&desc, PHOTON_MAP, 4, passes)
}

#[test]
fn photon_map_agrees_with_the_reference_of_box() {
    let renders = mapped("box", 16);
    assert_agrees("photon_map-box", &renders, "box", None, &MAP_BARS);
}

/// All light is caustic here. Only what sees diffuse surfaces directly is in the reference.
#[test]
fn photon_map_agrees_with_the_reference_of_globe() {
    let renders = mapped("globe", 3);
    assert_agrees("photon_map-globe", &renders, "globe", Some(&mask("globe")), &MAP_BARS);
}

/// The energy of the caustic under the glass sphere, seen beside it and through it: what the reference shows there, less
/// direct and indirect light, which path tracing knows with little noise, against the caustic layer of the photon map.
#[test]
fn photon_map_has_the_energy_of_the_caustic_under_the_glass_sphere() {
    let reference = reference("box-spheres");
    let (columns, rows) = (150..210, 200..240);
    let mut total = [0.0; 3];
    for y in rows.clone() {
        for x in columns.clone() {
            let pixel = reference.pixels()[y * 256 + x];
            (0..3).for_each(|c| total[c] += f64::from(pixel[c]) / (columns.len() * rows.len()) as f64);
        }
    }
    let range = |r: &std::ops::Range<usize>| r.start as f64..r.end as f64;
    let window = Window::new(range(&columns), range(&rows), 64);
    let mut desc = arena("box-spheres", 256);
    let rest = window.means(&desc, PATH, 16, 64, &[Layer::Direct, Layer::Indirect]);
    desc.photon_map.final_gather = 1;
    desc.photon_map.photons = 2000;
    desc.photon_map.caustic_photons = 200_000;
    let found = window.means(&desc, PHOTON_MAP, 16, 2, &[Layer::Caustic]);
    for c in 0..3 {
        let truth = Moments { mean: total[c] - rest[c].mean, ..rest[c] };
        assert!(truth.mean > 0.3 * total[c], "the caustic is bright");
        // The project's bar is 2 %; half of it may be what blur carries over the border of the window. Three standard errors
        // of the ratio must lie within the other half, and twice the bar must be found.
        let ratio = found[c].mean / truth.mean;
        let noise = (found[c].standard_error() / found[c].mean).hypot(truth.standard_error() / truth.mean);
        assert!(3.0 * noise < 0.01, "too noisy to judge: {noise}");
        assert!((ratio - 1.0).abs() < 0.02, "{ratio} of the energy, ± {noise}");
        for planted in [1.04, 1.0 / 1.04] {
            assert!((ratio * planted - 1.0).abs() >= 0.02, "blind to a factor of {planted}: {ratio}");
        }
    }
}

/// A room of every material: `photon_map` against `path`, z-tested by blocks and as a whole.
#[test]
fn photon_map_agrees_with_path_in_a_room_of_all_materials() {
    let wall = |shape: Shape, albedo: f32| Object::new(shape, grey(albedo));
    let inside = |shape: Shape| Object { flip_normals: true, ..wall(shape, 0.5) };
    let ball = |x: f32, z: f32, material: Material| Object::new(sphere([x, -0.6, z], 0.4), material);
    let gold = |roughness: f32| Material::conductor("gold", roughness);
    let objects = vec![
        inside(Shape::Box { min: [-1.5, -1.0, -1.2], max: [1.5, 1.0, 3.0] }),
        lamp(disk([0.0, 0.98, 0.0], [0.0, -1.0, 0.0], 0.5), 5.0),
        ball(-1.0, 0.0, Material::plastic(0.6, 0.3)),
        ball(0.0, -0.3, Material::phong([0.4, 0.3, 0.2], [0.5, 0.5, 0.5], 20.0)),
        ball(1.0, 0.0, gold(0.5)),
        ball(-0.5, 0.7, Material::dielectric(1.5)),
        ball(0.5, 0.7, gold(0.0)),
    ];
    let mut desc = scene_of(look([0.0, 0.0, 2.9], [0.0, -0.3, 0.0], 60.0), 32, objects);
    desc.photon_map.photons = 50_000;
    desc.photon_map.caustic_photons = 50_000;
    let path = brightness(&desc, PATH, 16, 96);
    let map = brightness(&desc, PHOTON_MAP, 16, 16);
    // What the blur of the maps may cost.
    assert_same("all materials", &map, &path, 0.005);
}
