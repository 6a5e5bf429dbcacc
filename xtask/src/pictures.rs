//! What chores that render pictures share: calling the program, and writing JPEG.

use std::path::{Path, PathBuf};
use std::process::Command;

use image::RgbImage;
use image::codecs::jpeg::JpegEncoder;

use crate::{Outcome, root};

/// The release build of the command line, which lies beside this program.
pub fn build() -> Result<PathBuf, String> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let status = Command::new(cargo)
        .args(["build", "--quiet", "--release", "--package", "nephroid-cli"])
        .current_dir(root())
        .status()
        .map_err(|e| format!("cargo does not start: {e}"))?;
    if !status.success() {
        return Err("the command line does not build".into());
    }
    let here = std::env::current_exe().map_err(|e| format!("this program cannot find itself: {e}"))?;
    Ok(here.with_file_name(format!("nephroid{}", std::env::consts::EXE_SUFFIX)))
}

/// Makes a picture: calls the program with a command line that is complete. `what` is its name in messages.
pub fn render(what: &str, program: &mut Command) -> Outcome {
    let status = program.status().map_err(|e| format!("{}: {e}", program.get_program().display()))?;
    if status.success() { Ok(()) } else { Err(format!("{what} was not rendered")) }
}

/// The colours of a picture in a file.
pub fn open(path: &Path) -> Result<RgbImage, String> {
    Ok(image::open(path).map_err(|e| format!("{}: {e}", path.display()))?.into_rgb8())
}

/// The bytes of a JPEG file in this quality, 1 to 100.
pub fn jpeg(picture: &RgbImage, quality: u8) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::new();
    let encoder = JpegEncoder::new_with_quality(&mut bytes, quality);
    picture.write_with_encoder(encoder).map_err(|e| format!("JPEG: {e}"))?;
    Ok(bytes)
}
