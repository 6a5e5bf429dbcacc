//! `cargo xtask gallery`: the small pictures of docs/gallery/, rendered from scenes/ by the release build.

use std::path::Path;
use std::process::Command;

use crate::{Outcome, pictures, root};

/// A picture, and what it changes of its scene to be small and quick.
struct Picture {
    /// Of the scene, below `scenes/` and without its ending; the picture is called by its last part.
    scene: &'static str,
    size: [u32; 2],
    passes: u32,
    /// Rays of a final gather, where the scene asks for a photon map; 0 looks the global map up directly, as the report
    /// does.
    final_gather: u32,
}

const fn square(scene: &'static str, passes: u32, final_gather: u32) -> Picture {
    Picture { scene, size: [320, 320], passes, final_gather }
}

const PICTURES: &[Picture] = &[
    square("report/teapot-glass", 160, 0),
    square("report/water-sphere", 160, 0),
    Picture { scene: "report/steel-and-glass", size: [384, 384], passes: 160, final_gather: 0 },
    square("report/photons-low", 32, 0),
    square("report/photons-high", 32, 0),
    square("report/caustic-gain-1", 20, 8),
    square("report/caustic-gain-2", 20, 8),
    square("report/caustic-gain-3", 20, 8),
    square("report/lighting-a", 160, 0),
    square("report/lighting-b", 160, 0),
    square("report/lighting-c", 160, 0),
    Picture { scene: "report/teapot-in-box", size: [384, 384], passes: 192, final_gather: 0 },
    Picture { scene: "coffee-cup", size: [400, 300], passes: 256, final_gather: 0 },
    Picture { scene: "metal-ring", size: [400, 300], passes: 256, final_gather: 0 },
    Picture { scene: "wine-glass", size: [300, 400], passes: 256, final_gather: 0 },
    Picture { scene: "furnace", size: [128, 128], passes: 16, final_gather: 8 },
];

/// Bytes that a picture, and all of them, may have.
const MOST_EACH: u64 = 400_000;
const MOST_TOGETHER: u64 = 6_000_000;

impl Picture {
    fn name(&self) -> &'static str {
        self.scene.rsplit('/').next().unwrap_or(self.scene)
    }
}

/// Renders all pictures, or those named.
pub fn run(arguments: &[String]) -> Outcome {
    let unknown = arguments.iter().find(|name| !PICTURES.iter().any(|picture| picture.name() == **name));
    if let Some(name) = unknown {
        let names: Vec<_> = PICTURES.iter().map(Picture::name).collect();
        return Err(format!("no picture is called `{name}`; there are {}", names.join(", ")));
    }
    let nephroid = pictures::build()?;
    let folder = root().join("docs/gallery");
    std::fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    for picture in PICTURES {
        if arguments.is_empty() || arguments.iter().any(|name| name == picture.name()) {
            render(&nephroid, picture, &folder)?;
        }
    }
    weigh(&folder)
}

fn render(nephroid: &Path, picture: &Picture, folder: &Path) -> Outcome {
    let [width, height] = picture.size;
    let output = folder.join(format!("{}.png", picture.name()));
    println!("{}", picture.name());
    pictures::render(
        picture.scene,
        Command::new(nephroid)
            .arg("render")
            .arg(root().join("scenes").join(format!("{}.toml", picture.scene)))
            .arg("--output")
            .arg(output)
            .args(["--size", &format!("{width}x{height}"), "--passes", &picture.passes.to_string()])
            .args(["--set", &format!("photon_map.final_gather={}", picture.final_gather), "--quiet"]),
    )
}

/// Holds the pictures to their sizes.
fn weigh(folder: &Path) -> Outcome {
    let mut together = 0;
    for picture in PICTURES {
        let path = folder.join(format!("{}.png", picture.name()));
        let bytes = std::fs::metadata(&path).map_err(|e| format!("{}: {e}", path.display()))?.len();
        if bytes > MOST_EACH {
            return Err(format!("{} has {bytes} bytes, more than {MOST_EACH}", path.display()));
        }
        together += bytes;
    }
    println!("{} pictures, {together} bytes", PICTURES.len());
    if together <= MOST_TOGETHER {
        Ok(())
    } else {
        Err(format!("{together} bytes are more than {MOST_TOGETHER}"))
    }
}
