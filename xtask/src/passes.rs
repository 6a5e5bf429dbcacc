//! `cargo xtask passes`: docs/cookbook/passes.gif, a picture after 1, 2, 4 … 128 passes.

use std::fs::File;
use std::process::Command;

use gif::{Encoder, Frame, Repeat};

use crate::{Outcome, pictures, root};

const SCENE: &str = "scenes/cookbook/coffee-cup.toml";
const SIZE: [u16; 2] = [400, 300];
const DOUBLINGS: u32 = 8;
/// How long a frame stays (1/100 s), and how long the last one does.
const STAY: [u16; 2] = [70, 250];
const MOST_BYTES: u64 = 2_000_000;

/// Renders the frames and writes them as one file.
pub fn run(arguments: &[String]) -> Outcome {
    if !arguments.is_empty() {
        return Err("usage: cargo xtask passes".into());
    }
    let nephroid = pictures::build()?;
    let folder = root().join("target/passes");
    std::fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let path = root().join("docs/cookbook/passes.gif");
    let file = File::create(&path).map_err(|e| format!("{}: {e}", path.display()))?;
    let mut gif = Encoder::new(file, SIZE[0], SIZE[1], &[]).map_err(|e| e.to_string())?;
    gif.set_repeat(Repeat::Infinite).map_err(|e| e.to_string())?;
    for passes in (0..DOUBLINGS).map(|k| 1_u32 << k) {
        let picture = folder.join(format!("{passes}.png"));
        pictures::render(
            SCENE,
            Command::new(&nephroid)
                .arg(root().join(SCENE))
                .args(["--size", &format!("{}x{}", SIZE[0], SIZE[1]), "--passes", &passes.to_string()])
                .args(["--exposure", "-6.9", "--quiet", "-o"])
                .arg(&picture),
        )?;
        let mut picture = image::open(&picture).map_err(|e| e.to_string())?.to_rgba8();
        let [width, height] = SIZE.map(u32::from);
        let bar = width * (passes.ilog2() + 1) / DOUBLINGS;
        for (x, y) in (0..bar).flat_map(|x| (height - 4..height).map(move |y| (x, y))) {
            picture.put_pixel(x, y, image::Rgba([255, 190, 60, 255]));
        }
        let mut frame = Frame::from_rgba_speed(SIZE[0], SIZE[1], &mut picture, 1);
        frame.delay = if passes == 1 << (DOUBLINGS - 1) { STAY[1] } else { STAY[0] };
        gif.write_frame(&frame).map_err(|e| e.to_string())?;
    }
    drop(gif);
    let bytes = std::fs::metadata(&path).map_err(|e| format!("{}: {e}", path.display()))?.len();
    println!("{bytes} bytes");
    if bytes <= MOST_BYTES { Ok(()) } else { Err(format!("{bytes} bytes are more than {MOST_BYTES}")) }
}
