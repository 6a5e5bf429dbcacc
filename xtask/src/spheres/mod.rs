//! `cargo xtask spheres`: a ball of every material and texture, and every shape, for the book: docs/book/spheres/*.jpg.

mod list;
mod studio;

use std::path::{Path, PathBuf};
use std::process::Command;

use image::codecs::jpeg::JpegEncoder;

use crate::gallery::build;
use crate::{Outcome, root};
use list::{Ball, MATERIALS, PRESETS, SHAPES, TEXTURES};

const SIZE: u32 = 240;

/// With a denoiser; without one the pictures keep some grain.
const PASSES: u32 = 40;

/// Bytes that a picture may have.
const MOST_EACH: u64 = 15_000;

fn balls() -> impl Iterator<Item = &'static Ball> {
    MATERIALS.iter().chain(PRESETS).chain(TEXTURES).chain(SHAPES)
}

fn folder() -> PathBuf {
    root().join("docs/book/spheres")
}

/// Renders all balls, or those named.
pub fn run(arguments: &[String]) -> Outcome {
    if let Some(name) = arguments.iter().find(|name| !balls().any(|ball| ball.name == **name)) {
        let names: Vec<_> = balls().map(|ball| ball.name).collect();
        return Err(format!("no ball is called `{name}`; there are {}", names.join(", ")));
    }
    let nephroid = build()?;
    let work = root().join("target/spheres");
    for folder in [&work, &folder()] {
        std::fs::create_dir_all(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    }
    studio::pictures(&work)?;
    for ball in balls().filter(|ball| arguments.is_empty() || arguments.iter().any(|name| name == ball.name))
    {
        println!("{}", ball.name);
        render(&nephroid, ball, &work)?;
    }
    Ok(())
}

fn render(nephroid: &Path, ball: &Ball, work: &Path) -> Outcome {
    let scene = work.join(ball.name).with_extension("toml");
    let png = scene.with_extension("png");
    std::fs::write(&scene, studio::scene(ball)).map_err(|e| format!("{}: {e}", scene.display()))?;
    let status = Command::new(nephroid)
        .arg("render")
        .arg(&scene)
        .arg("--output")
        .arg(&png)
        .args(["--size", &format!("{SIZE}x{SIZE}"), "--passes", &PASSES.to_string(), "--denoise", "--quiet"])
        .status()
        .map_err(|e| format!("{}: {e}", nephroid.display()))?;
    if !status.success() {
        return Err(format!("{} was not rendered", ball.name));
    }
    let picture = image::open(&png).map_err(|e| format!("{}: {e}", png.display()))?.into_rgb8();
    let path = folder().join(ball.name).with_extension("jpg");
    std::fs::write(&path, jpeg(&picture)?).map_err(|e| format!("{}: {e}", path.display()))
}

/// The picture in the best quality that is small enough.
fn jpeg(picture: &image::RgbImage) -> Result<Vec<u8>, String> {
    for quality in (30..=86).rev().step_by(4) {
        let mut bytes = Vec::new();
        JpegEncoder::new_with_quality(&mut bytes, quality)
            .encode_image(picture)
            .map_err(|e| format!("JPEG: {e}"))?;
        if bytes.len() as u64 <= MOST_EACH {
            return Ok(bytes);
        }
    }
    Err(format!("a picture has more than {MOST_EACH} bytes in any quality"))
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn every_scene_is_one() {
        let names: BTreeSet<_> = balls().map(|ball| ball.name).collect();
        assert_eq!(names.len(), balls().count(), "two balls have one name");
        let work = std::env::temp_dir();
        for ball in balls() {
            let loaded = scenefile::parse(&studio::scene(ball), &work.join("scene.toml"), &[]);
            let wrong = loaded.diagnostics.iter().filter(|d| d.code != "missing-file");
            let wrong: Vec<_> = wrong.map(|d| &d.message).collect();
            assert_eq!(wrong, Vec::<&String>::new(), "{}", ball.name);
        }
    }

    #[test]
    fn every_kind_has_a_ball() {
        // Flat ones, what comes from files, and what fills another shape.
        let plain = ["disk", "quad", "mesh", "triangles", "sphere", "wine"];
        for (section, balls) in [("materials", MATERIALS), ("textures", TEXTURES), ("objects", SHAPES)] {
            let section = scenefile::spec::SECTIONS.iter().find(|s| s.name == section).unwrap();
            for kind in section.variants().iter().filter(|kind| !plain.contains(&kind.name)) {
                let line = format!(" = \"{}\"", kind.name);
                let has = |ball: &Ball| {
                    let keys = match ball.shape {
                        list::Shape::Other(keys) => keys,
                        list::Shape::Sphere | list::Shape::Painted => "",
                    };
                    [ball.material, ball.tables, keys].iter().any(|text| text.contains(&line))
                };
                assert!(balls.iter().any(has), "{}: {}", section.name, kind.name);
            }
        }
    }

    #[test]
    fn every_ball_has_its_picture_on_a_page() {
        let page = |name: &str| std::fs::read_to_string(root().join("docs/book").join(name)).unwrap();
        let pages = [page("materials.md"), page("textures.md"), page("shapes.md")];
        for ball in balls() {
            let path = folder().join(ball.name).with_extension("jpg");
            let bytes = std::fs::metadata(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display())).len();
            assert!(bytes <= MOST_EACH, "{}: {bytes} bytes", ball.name);
            let link = format!("spheres/{}.jpg", ball.name);
            assert!(pages.iter().any(|page| page.contains(&link)), "{} is on no page", ball.name);
        }
    }
}
