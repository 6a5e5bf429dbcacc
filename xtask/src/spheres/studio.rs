//! The studio that every ball stands in, as a scene file, and the pictures that textures are made of.

use std::f64::consts::PI;
use std::fmt::Write as _;
use std::path::Path;

use image::RgbImage;

use super::list::{Ball, Shape};
use crate::Outcome;

/// Camera, ground, wall and lights: a softbox on the left above, a strip behind on the right, and a dim room.
const STUDIO: &str = r#"
[film]
exposure = 0.3

[camera]
position = [0.5, 2.6, 6]
look_at = [0.04, 0.9, 0]
fov = 26

[textures.tiles]
kind = "checker"
a = 0.55
b = 0.16
scale = [12, 12]

[[objects]]
shape = "quad"
origin = [-9, 0, 9]
edge_u = [18, 0, 0]
edge_v = [0, 0, -18]
material = { kind = "diffuse", color = { texture = "tiles" } }

[[objects]]
shape = "quad"
origin = [-9, 0, -5]
edge_u = [18, 0, 0]
edge_v = [0, 9, 0]
material = { kind = "diffuse", color = 0.35 }

[[objects]]
shape = "quad"
origin = [-5.64, 2.42, 3.46]
edge_u = [-0.96, 0, -3.88]
edge_v = [2.66, 3.96, -0.66]
radiance = 9

[[objects]]
shape = "quad"
origin = [3.9, 0.3, -3.1]
edge_u = [0.5, 0, 0.9]
edge_v = [-0.8, 3.7, 0.6]
radiance = 14

[[lights]]
kind = "environment"
radiance = 0.25
"#;

/// The scene file of a ball.
pub fn scene(ball: &Ball) -> String {
    let shape = match ball.shape {
        Shape::Sphere => "shape = \"sphere\"\ncenter = [0, 1, 0]\nradius = 1\n".to_owned(),
        Shape::Painted => painted(),
        Shape::Other(keys) => keys.to_owned(),
    };
    let Ball { material, tables, .. } = ball;
    format!("{STUDIO}\n[materials.ball]\n{material}\n{tables}\n\n[[objects]]\nmaterial = \"ball\"\n{shape}")
}

/// A ball of triangles whose vertices have the colours of a rainbow.
fn painted() -> String {
    const ROWS: usize = 32;
    const COLUMNS: usize = 64;
    let (mut positions, mut colors, mut indices) = (String::new(), String::new(), String::new());
    for row in 0..=ROWS {
        for column in 0..=COLUMNS {
            let (down, around) = (PI * row as f64 / ROWS as f64, 2.0 * PI * column as f64 / COLUMNS as f64);
            let [x, y, z] = [down.sin() * around.sin(), 1.0 + down.cos(), down.sin() * around.cos()];
            let _ = write!(positions, "[{x:.4}, {y:.4}, {z:.4}], ");
            let [r, g, b] = hue(around / (2.0 * PI) * 3.0 + row as f64 / ROWS as f64);
            let _ = write!(colors, "[{r:.3}, {g:.3}, {b:.3}], ");
        }
    }
    for row in 0..ROWS {
        for column in 0..COLUMNS {
            let a = row * (COLUMNS + 1) + column;
            let b = a + COLUMNS + 1;
            let _ = write!(indices, "[{a}, {b}, {}], [{a}, {}, {}], ", b + 1, b + 1, a + 1);
        }
    }
    format!(
        "shape = \"triangles\"\npositions = [{positions}]\nindices = [{indices}]\ncolors = [{colors}]\nnormals = \"smooth\"\n"
    )
}

/// Colours of a circle, linear, 0.08 to 0.8; turns beyond 1 begin anew.
fn hue(turn: f64) -> [f64; 3] {
    [0.0, 1.0 / 3.0, 2.0 / 3.0].map(|shift| 0.44 + 0.36 * (2.0 * PI * (turn - shift)).cos())
}

/// Writes the pictures that balls name.
pub fn pictures(folder: &Path) -> Outcome {
    let save = |name: &str, picture: RgbImage| {
        let path = folder.join(name);
        picture.save(&path).map_err(|e| format!("{}: {e}", path.display()))
    };
    save("map.png", RgbImage::from_fn(512, 256, map))?;
    save("quilt.png", RgbImage::from_fn(1024, 512, quilt))?;
    let path = folder.join("hills.png");
    let hills = image::ImageBuffer::<image::Luma<u16>, _>::from_fn(256, 256, hills);
    hills.save(&path).map_err(|e| format!("{}: {e}", path.display()))
}

/// Heights of three hills.
fn hills(x: u32, y: u32) -> image::Luma<u16> {
    let hill = |[u, v, width, height]: [f64; 4]| {
        let [x, y] = [f64::from(x) / 255.0 - u, f64::from(y) / 255.0 - v];
        height * (-(x * x + y * y) / (width * width)).exp()
    };
    let sum: f64 =
        [[0.38, 0.42, 0.2, 0.9], [0.72, 0.6, 0.14, 0.6], [0.3, 0.78, 0.12, 0.4]].map(hill).iter().sum();
    image::Luma([(65_535.0 * sum.min(1.0)) as u16])
}

/// A map: colours by longitude, brighter toward the top, lines every 32 texels.
fn map(x: u32, y: u32) -> image::Rgb<u8> {
    if x % 32 < 2 || y % 32 < 2 {
        return image::Rgb([245; 3]);
    }
    let bright = 1.0 - 0.6 * f64::from(y) / 255.0;
    image::Rgb(hue(f64::from(x) / 512.0).map(|c| (255.0 * (bright * c).powf(1.0 / 2.2)) as u8))
}

/// The normals of a quilt: heights sin·sin, 12 by 6 waves.
fn quilt(x: u32, y: u32) -> image::Rgb<u8> {
    let (u, v) = (24.0 * PI * f64::from(x) / 1024.0, 12.0 * PI * f64::from(y) / 512.0);
    let slope = [0.7 * u.cos() * v.sin(), -0.7 * u.sin() * v.cos()];
    let length = (slope[0] * slope[0] + slope[1] * slope[1] + 1.0).sqrt();
    let normal = [-slope[0] / length, -slope[1] / length, 1.0 / length];
    image::Rgb(normal.map(|c| (127.5 + 127.5 * c).round() as u8))
}
