//! Scene files that are not there, and which ones may be meant.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use scenefile::Diagnostic;

use crate::Format;
use crate::report::nearest;

/// Files of a folder that are looked at, at most.
const MOST: usize = 10_000;

/// Why a scene that is not there cannot be read; `None` where there is something of that name.
pub(crate) fn refusal(path: &Path) -> Option<Diagnostic> {
    std::fs::metadata(path).err().filter(|e| e.kind() == ErrorKind::NotFound)?;
    let missing = Diagnostic::error("file", format!("the scene {} is not there", path.display()));
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    Some(match (folder.is_dir(), meant(path, folder)) {
        (false, _) => missing.help(format!("there is no folder {}", folder.display())),
        (true, Some(name)) => missing.help(format!("did you mean {}?", name.display())),
        (true, None) => missing.help("the name is relative to the folder that the command is given in"),
    })
}

/// The scene in `folder` whose name is nearest: the same with an extension, in other letters, or with few other letters.
fn meant(path: &Path, folder: &Path) -> Option<PathBuf> {
    let wanted = path.file_name()?.to_str()?.to_lowercase();
    let mut names: Vec<String> = std::fs::read_dir(folder)
        .ok()?
        .take(MOST)
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        .filter(|name| is_scene(name))
        .collect();
    names.sort();
    let stem = |name: &str| Path::new(name).file_stem().map(|s| s.to_string_lossy().to_lowercase());
    let same = names.iter().find(|name| {
        name.to_lowercase() == wanted || stem(name).as_deref() == Some(&wanted) || stem(name) == stem(&wanted)
    });
    let near = || {
        let lower: Vec<String> = names.iter().map(|name| name.to_lowercase()).collect();
        let nearest = nearest(&wanted, lower.iter().map(String::as_str))?;
        lower.iter().position(|name| name == nearest).map(|i| &names[i])
    };
    same.or_else(near).map(|name| path.with_file_name(name))
}

/// Whether a file is named like a scene.
fn is_scene(name: &str) -> bool {
    let path = Path::new(name);
    match Format::of(path) {
        Format::Native => path.extension().is_some_and(|e| e.eq_ignore_ascii_case("toml")),
        _ => true,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_scene_is_named() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["first.toml", "Ring.toml", "pool.pbrt", "notes.txt", "frist.png"] {
            std::fs::write(folder.path().join(name), "").unwrap();
        }
        let help = |name: &str| refusal(&folder.path().join(name)).unwrap().help.unwrap();
        for (typed, meant) in [
            ("frist.toml", "first.toml"),
            ("first", "first.toml"),
            ("ring.TOML", "Ring.toml"),
            ("pool.toml", "pool.pbrt"),
        ] {
            assert!(help(typed).contains(&format!("{meant}?")), "{typed}: {}", help(typed));
        }
        assert!(!help("something-else.toml").contains("did you mean"));
        assert!(help("none/first.toml").contains("no folder"));
        assert!(refusal(&folder.path().join("first.toml")).is_none());
    }
}
