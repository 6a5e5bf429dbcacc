//! How pictures are shown: the scene's settings and what replaces them on the command line.

use nephroid::{PictureInfo, SceneDesc, SceneHash, read_lut};

use crate::args::DisplayArgs;
use crate::failure::Failure;

/// What pictures of a scene are written with, `args` before the scene's own settings.
pub fn picture_info(desc: &SceneDesc, hash: SceneHash, args: &DisplayArgs) -> Result<PictureInfo, Failure> {
    let mut info = PictureInfo::new(desc, hash);
    info = match &args.lut {
        None => info.with_lut_of(desc).map_err(Failure::usage)?,
        Some(file) => {
            info.display.lut = Some(read_lut(file).map_err(Failure::usage)?);
            info
        }
    };
    let display = &mut info.display;
    display.exposure = args.exposure.unwrap_or(display.exposure);
    display.white_balance = args.white_balance.unwrap_or(display.white_balance);
    display.view = args.view.unwrap_or(display.view);
    Ok(info)
}
