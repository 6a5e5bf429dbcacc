//! `cargo xtask spheres`: a ball of every material and texture, and every shape, for the book: docs/book/spheres/*.jpg; and
//! the scenes that stand on its pages: docs/book/pictures/*.jpg.

mod list;
mod pages;
mod studio;

use std::path::{Path, PathBuf};
use std::process::Command;

use image::RgbImage;

use crate::{Outcome, pictures, root};
use list::{Ball, MATERIALS, PRESETS, SHAPES, TEXTURES};
use pages::PAGES;

const SIZE: u32 = 240;

/// With a denoiser; without one the pictures keep some grain.
const PASSES: u32 = 40;

/// Bytes that a ball's picture, and a page's, may have.
const MOST_EACH: u64 = 15_000;
const MOST_OF_A_PAGE: u64 = 40_000;

fn balls() -> impl Iterator<Item = &'static Ball> {
    MATERIALS.iter().chain(PRESETS).chain(TEXTURES).chain(SHAPES)
}

fn folder() -> PathBuf {
    root().join("docs/book/spheres")
}

fn page_folder() -> PathBuf {
    root().join("docs/book/pictures")
}

/// Renders all balls and pages, or those named.
pub fn run(arguments: &[String]) -> Outcome {
    let names: Vec<_> = balls().map(|ball| ball.name).chain(PAGES.iter().map(|page| page.name)).collect();
    if let Some(name) = arguments.iter().find(|name| !names.contains(&name.as_str())) {
        return Err(format!("no picture is called `{name}`; there are {}", names.join(", ")));
    }
    let wanted = |name: &str| arguments.is_empty() || arguments.iter().any(|wanted| wanted == name);
    let nephroid = pictures::build()?;
    let work = root().join("target/spheres");
    for folder in [&work, &folder(), &page_folder()] {
        std::fs::create_dir_all(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    }
    studio::pictures(&work)?;
    let (size, passes) = (format!("{SIZE}x{SIZE}"), PASSES.to_string());
    let small = ["--size", &size, "--passes", &passes, "--denoise"];
    for ball in balls().filter(|ball| wanted(ball.name)) {
        let scene = work.join(ball.name).with_extension("toml");
        let picture = render(&nephroid, &scene, &studio::scene(ball), &small)?;
        write(&folder().join(ball.name), &picture, MOST_EACH)?;
    }
    for page in PAGES.iter().filter(|page| wanted(page.name)) {
        let scene = work.join(page.name).with_extension("toml");
        let picture = render(&nephroid, &scene, &page.scene()?, page.arguments)?;
        write(&page_folder().join(page.name), &picture, MOST_OF_A_PAGE)?;
    }
    Ok(())
}

/// Writes the scene to a file and renders it.
fn render(nephroid: &Path, scene: &Path, text: &str, arguments: &[&str]) -> Result<RgbImage, String> {
    let png = scene.with_extension("png");
    println!("{}", scene.display());
    std::fs::write(scene, text).map_err(|e| format!("{}: {e}", scene.display()))?;
    let name = scene.display().to_string();
    pictures::render(
        &name,
        Command::new(nephroid)
            .arg("render")
            .arg(scene)
            .arg("--output")
            .arg(&png)
            .args(arguments)
            .arg("--quiet"),
    )?;
    pictures::open(&png)
}

/// Writes the picture as JPEG, in the best quality that has no more than `most` bytes.
fn write(path: &Path, picture: &RgbImage, most: u64) -> Outcome {
    let path = path.with_extension("jpg");
    let bytes = jpeg(picture, most)?;
    std::fs::write(&path, bytes).map_err(|e| format!("{}: {e}", path.display()))
}

fn jpeg(picture: &RgbImage, most: u64) -> Result<Vec<u8>, String> {
    for quality in (30..=86).rev().step_by(4) {
        let bytes = pictures::jpeg(picture, quality)?;
        if bytes.len() as u64 <= most {
            return Ok(bytes);
        }
    }
    Err(format!("a picture has more than {most} bytes in any quality"))
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

    #[test]
    fn every_page_shows_its_picture() {
        for page in PAGES {
            let text = std::fs::read_to_string(root().join(format!("docs/book/{}.md", page.name))).unwrap();
            assert!(text.contains(&format!("](pictures/{}.jpg)", page.name)), "{}", page.name);
            assert!(page_folder().join(page.name).with_extension("jpg").exists(), "{}", page.name);
            // The page says the command that makes it.
            assert!(text.contains(&page.arguments.join(" ")), "{}", page.name);
            assert!(page.scene().unwrap().contains("[camera]"), "{}", page.name);
        }
    }
}
