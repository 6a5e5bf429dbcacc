//! Textures are averaged over less and less of a pixel as passes add up.

use nephroid::desc::{
    Camera, CameraKind, ColorDesc, Light, LightKind, Material, Object, Shape, Texture, Triple,
};

use crate::support::*;

/// Squares of white and black in a plane, lit from the front, and their radiance by pixels where white has 1.
fn checkered(camera: Camera, half: f32, squares: f32, passes: u32) -> Vec<f32> {
    let origin = [-half, -half, 0.0];
    let side = 2.0 * half;
    let quad = Shape::Quad { origin, edge_u: [side, 0.0, 0.0], edge_v: [0.0, side, 0.0] };
    let white = Material::diffuse(ColorDesc::Texture("squares".into()));
    let mut desc = scene_of(camera, 16, vec![Object::new(quad, white)]);
    desc.textures.insert("squares".into(), Texture::checker([1.0; 3], 0.0, [squares; 2]).into());
    let (direction, irradiance): (Triple, Triple) = ([0.0, 0.0, -1.0], [std::f32::consts::PI; 3]);
    desc.lights = vec![Light::from(LightKind::Directional { direction, irradiance }).into()];
    desc.render.max_depth = Some(1);
    film(&desc, &compiled(&desc), PATH, 1, passes).beauty().iter().map(|p| p[0]).collect()
}

/// Edges that lie on edges of pixels: what leaks into black pixels beside white ones.
#[test]
fn edges_get_sharp() {
    let camera =
        Camera { kind: CameraKind::Orthographic { extent: 4.0 }, ..look([0.0, 0.0, 5.0], [0.0; 3], 40.0) };
    // Four squares along either side of the picture, four pixels each.
    let leaks = |passes: u32| {
        let pixels = checkered(camera.clone(), 2.0, 2.0, passes);
        // A middle row of squares.
        let row = &pixels[5 * 16..6 * 16];
        assert!(row.iter().any(|&x| x > 0.98), "{row:?}");
        let black = row.windows(3).filter(|w| w[1] < 0.5 && w[0].max(w[2]) > 0.5).map(|w| f64::from(w[1]));
        let black: Vec<f64> = black.collect();
        assert!(black.len() >= 3, "{row:?}");
        black.iter().sum::<f64>() / black.len() as f64
    };
    let (few, many) = (leaks(4), leaks(256));
    assert!(few > 0.05, "{few}: a test of nothing");
    assert!(many < 0.02 && many < 0.2 * few, "{many} after {few}");
}

/// Squares far finer than pixels are grey from the first pass on.
#[test]
fn fine_patterns_have_no_grain() {
    for passes in [1, 2, 4] {
        let pixels = checkered(look([0.0, 0.0, 5.0], [0.0; 3], 40.0), 5.0, 730.0, passes);
        let mean = pixels.iter().sum::<f32>() / pixels.len() as f32;
        let rms = (pixels.iter().map(|p| (p - 0.5).powi(2)).sum::<f32>() / pixels.len() as f32).sqrt();
        // Points would be white or black: 0.5/√passes.
        assert!((mean - 0.5).abs() < 0.01 && rms < 0.03, "{passes}: {mean} {rms}");
    }
}
