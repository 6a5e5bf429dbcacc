//! What was typed, as the parser takes it: scenes without a command, and answers to flags that are not known.

use std::ffi::OsString;
use std::path::Path;

use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{CommandFactory, Error, Parser};

use crate::args::Cli;
use crate::failure::Failure;

/// What is meant by these words, the first of which names the program.
///
/// # Errors
/// Where they make no sense, as [`refused`] says it.
pub fn parse(words: Vec<OsString>) -> Result<Cli, Error> {
    Cli::try_parse_from(completed(words))
}

/// With `render` before a scene that comes without a command, and before flags that are not the program's own.
fn completed(mut words: Vec<OsString>) -> Vec<OsString> {
    let renders = words.get(1).is_some_and(|first| {
        let text = first.to_string_lossy();
        let is_command = Cli::command().get_subcommands().any(|c| c.get_name() == text);
        let is_own = ["help", "-h", "--help", "-V", "--version"].contains(&&*text);
        let is_file = || {
            let path = Path::new(first);
            text.contains(['.', '/', '\\']) || path.exists() || path.with_extension("toml").exists()
        };
        !is_command && !is_own && (text.starts_with('-') || is_file())
    });
    if renders {
        words.insert(1, "render".into());
    }
    words
}

/// Why the words make no sense; `None` where the parser itself says it well, or there is no mistake (help, say).
pub fn refused(error: &Error) -> Option<Failure> {
    if error.kind() != ErrorKind::UnknownArgument {
        return None;
    }
    let text = |kind| match error.get(kind) {
        Some(ContextValue::String(text)) => Some(text.as_str()),
        _ => None,
    };
    let flag = text(ContextKind::InvalidArg).filter(|flag| flag.starts_with('-'))?;
    let help = foreign(flag)
        .map(str::to_owned)
        .or_else(|| text(ContextKind::SuggestedArg).map(|near| format!("did you mean `{near}`?")))
        .or_else(|| elsewhere(flag));
    let help = help.unwrap_or_else(|| "`nephroid help COMMAND` lists the flags of a command".to_owned());
    Some(Failure::usage(format!("the flag `{flag}` is not known here\n  = help: {help}")))
}

/// Commands that do know the flag.
fn elsewhere(flag: &str) -> Option<String> {
    let command = Cli::command();
    let knows = |c: &&clap::Command| {
        c.get_arguments().any(|a| {
            let longs = a.get_long_and_visible_aliases().unwrap_or_default();
            longs.iter().any(|long| flag.strip_prefix("--") == Some(long))
        })
    };
    let names: Vec<_> =
        command.get_subcommands().filter(knows).map(|c| format!("`nephroid {}`", c.get_name())).collect();
    (!names.is_empty()).then(|| format!("it belongs to {}", names.join(", ")))
}

/// What to write for a flag that other renderers have.
fn foreign(flag: &str) -> Option<&'static str> {
    let answer = FOREIGN.iter().find(|(flags, _)| flags.contains(&flag));
    answer.map(|(_, answer)| *answer)
}

/// Flags of other programs, and what there is instead.
const FOREIGN: &[(&[&str], &str)] = &[
    (
        &["--gpu", "--cuda", "--optix", "--device", "--cycles-device", "--backend"],
        "Nephroid computes on the processor's cores; --threads says on how many",
    ),
    (&["--cpu"], "that is what Nephroid computes on; --threads says on how many cores"),
    (&["--nthreads", "--num-threads", "--cores", "-j", "-t"], "--threads N says how many"),
    (&["--outfile", "--out", "--save", "--render-output"], "-o NAME.png or -o NAME.exr names the picture"),
    (&["--format", "--render-format", "-F"], "the name says the format: -o NAME.png or -o NAME.exr"),
    (
        &["--engine", "-E", "--algorithm", "--mode", "-m", "--variant"],
        "--integrator NAME chooses the algorithm",
    ),
    (&["--bounces", "--max-bounces", "--depth"], "--max-depth N bounds the length of paths"),
    (&["--time-limit", "--timeout", "--max-time", "--minutes"], "--time 5m ends the render after so long"),
    (
        &["--noise-threshold", "--error", "--target-error", "--adaptive", "--threshold"],
        "--noise 2% ends the render once its grain is so fine",
    ),
    (
        &["--region", "--cropwindow", "--crop-window", "--border", "--window"],
        "--crop X0,Y0,X1,Y1 renders a part",
    ),
    (
        &["--verbose", "-v", "--debug", "--stats"],
        "--timings says what each part took; `nephroid info` what is in a scene",
    ),
    (&["--silent"], "--quiet, or -q, says nothing but what went wrong"),
    (&["--force", "--overwrite", "-y"], "pictures are replaced without asking; checkpoints never are"),
    (
        &["--gui", "--viewer", "--interactive", "--display-server", "--window-preview"],
        "there is no viewer: while it renders, the PNG is rewritten every few seconds (--preview-every)",
    ),
    (
        &["--frame", "--frames", "--animation", "-a", "--anim", "--frame-start"],
        "there is no animation: render each frame with --set, as --set camera.position=[0,1,5]",
    ),
    (&["--wavefront", "--spectral", "--lambda"], "light is linear RGB here; there is no such choice"),
    (&["--gamma", "--tonemap", "--tone-mapping"], "--exposure brightens; --view chooses the curve"),
    (&["--quick", "--draft", "--preview"], "fewer passes make a draft: --spp 8 --size 320"),
    (
        &["--scene", "-i", "--input", "-b", "--background"],
        "the scene's name is enough: `nephroid SCENE.toml`",
    ),
    (&["-D", "--define", "--param", "-x"], "--set PATH=VALUE replaces a value of the scene"),
    (&["--checkpoint-interval"], "--checkpoint-every TIME says how often to save"),
    (&["--tile", "--tile-size", "--bucket"], "a picture is made of passes over all of it, not of tiles"),
];

#[cfg(test)]
mod tests {
    use super::*;

    fn words(text: &str) -> Vec<OsString> {
        text.split(' ').map(OsString::from).collect()
    }

    #[test]
    fn a_scene_alone_is_rendered() {
        for (typed, meant) in [
            ("nephroid a.toml", "nephroid render a.toml"),
            ("nephroid a/b -q", "nephroid render a/b -q"),
            ("nephroid --spp 4 a.toml", "nephroid render --spp 4 a.toml"),
            ("nephroid render a.toml", "nephroid render a.toml"),
            ("nephroid help", "nephroid help"),
            ("nephroid -V", "nephroid -V"),
            ("nephroid rendr a.toml", "nephroid rendr a.toml"),
            ("nephroid", "nephroid"),
        ] {
            assert_eq!(completed(words(typed)), words(meant));
        }
    }

    #[test]
    fn answers_name_flags_that_there_are() {
        let command = Cli::command();
        let known: Vec<String> = command
            .get_subcommands()
            .flat_map(clap::Command::get_arguments)
            .flat_map(|a| a.get_long_and_visible_aliases().unwrap_or_default())
            .map(|long| format!("--{long}"))
            .collect();
        for (flags, answer) in FOREIGN {
            for flag in *flags {
                assert!(!known.iter().any(|k| k == flag), "{flag} is known");
            }
            let named = answer.split(|c: char| !(c.is_ascii_alphanumeric() || c == '-'));
            for flag in named.filter(|word| word.starts_with("--")) {
                assert!(known.iter().any(|k| k == flag), "{flag} is not");
            }
        }
    }
}
