//! `nephroid develop`.

use std::path::Path;

use nephroid::desc::Denoise;
use nephroid::{
    Checkpoint, ExrChannels, MixError, OutputKind, PictureInfo, Planes, SceneDesc, SceneHash, is_same_file,
    merge, nearest,
};

use crate::args::DevelopArgs;
use crate::denoise::Denoising;
use crate::display::picture_info;
use crate::failure::{FAILED, Failure, OK, Outcome};
use crate::progress::Progress;
use crate::render::checked;
use crate::say;

/// Shows a picture in another way, or mixes its lights anew.
pub fn run(args: &DevelopArgs) -> Outcome {
    let mut messages = Vec::new();
    let outputs = checked(&args.output, &mut messages);
    for output in outputs.iter().filter(|output| is_same_file(output.path(), &args.file)) {
        messages.push(format!(
            "cannot write {}: it is the picture that is developed\n  = help: give another name",
            output.path().display()
        ));
    }
    if !messages.is_empty() {
        return Err(Failure::Usage(messages));
    }
    let Read { mut planes, mut info, denoise } = read(args)?;
    let factors: Vec<(String, [f32; 3])> =
        args.light.iter().map(|light| (light.group.clone(), light.factor)).collect();
    planes.mix(&factors).map_err(|error| Failure::usage(refusal(&args.file, &error)))?;
    let mut code = OK;
    let progress = Progress::plain(args.quiet);
    if args.denoise.is_some() {
        planes.denoised.clear();
    }
    if let Some(denoising) = Denoising::find(denoise, &progress)? {
        match denoising.apply(&planes, &progress) {
            Ok(denoised) => {
                if let Some(denoised) = denoised {
                    info.metadata.push(denoised.metadata());
                    planes.denoised = denoised.into_pixels();
                }
            }
            Err(()) => code = FAILED,
        }
    }
    for output in &outputs {
        match output.write_planes(&planes, &info) {
            Ok(()) if args.quiet => {}
            Ok(()) => {
                let path = output.path().display();
                say::say(&format!("wrote {path} ({}x{})", planes.width, planes.height));
            }
            Err(error) => {
                say::error(&format!("{error}\n  = help: {}", error.help()));
                code = FAILED;
            }
        }
    }
    if !args.quiet && outputs.iter().any(|output| output.kind() == OutputKind::Png) {
        say::say(&info.display.settle(&planes).text());
    }
    Ok(code)
}

/// What was read.
struct Read {
    planes: Planes,
    /// What pictures of it are written with.
    info: PictureInfo,
    /// Whether noise is to be taken out.
    denoise: Denoise,
}

/// A checkpoint or an EXR file.
fn read(args: &DevelopArgs) -> Result<Read, Failure> {
    let wanted = args.denoise.map(Denoise::from);
    if Checkpoint::is_one(&args.file) {
        let one = merge(std::slice::from_ref(&args.file));
        let Checkpoint { info, film } =
            one.map_err(|errors| Failure::Usage(errors.iter().map(ToString::to_string).collect()))?;
        let picture = picture_info(&info.desc, info.hash, &args.display)?;
        let denoise = wanted.unwrap_or(info.desc.film.denoise);
        return Ok(Read { planes: Planes::of(&film), info: picture, denoise });
    }
    let name = args.file.display();
    let exr = ExrChannels::read(&args.file).map_err(|error| {
        Failure::usage(format!("{error}\n  = help: develop takes an EXR picture or a checkpoint (.neph)"))
    })?;
    let planes = Planes::of_exr(&exr).ok_or_else(|| {
        let names: Vec<&str> = exr.names().collect();
        Failure::usage(format!("{name} has no channels R, G, B among {}", names.join(", ")))
    })?;
    let mut info = picture_info(&SceneDesc::default(), SceneHash(0), &args.display)?;
    info.metadata.retain(|(key, _)| key == "software");
    Ok(Read { planes, info, denoise: wanted.unwrap_or_default() })
}

fn refusal(file: &Path, error: &MixError) -> String {
    let name = file.display();
    match error {
        MixError::NoGroups => format!(
            "{name} does not keep its lights apart\n  = help: render it with `--layers lights`, and give lights a \
             light_group in the scene"
        ),
        MixError::Unknown(group, known) => {
            let meant = nearest(group, known.iter().map(String::as_str));
            let help = meant.map_or_else(
                || format!("it has {}", known.join(", ")),
                |meant| format!("did you mean `{meant}`? It has {}", known.join(", ")),
            );
            format!("{name} has no group of lights `{group}`\n  = help: {help}")
        }
    }
}
