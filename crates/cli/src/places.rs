//! Which files a render writes, of the scenes and the names that were given.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// What stands for the scene's name in the name of a file.
const STEM: &str = "{}";

/// The file that `named` means for a scene: in a folder the scene's name with `extension`; with `{}`, that with the
/// scene's name in its place; else itself.
pub fn of_scene(named: &Path, scene: &Path, extension: &str) -> PathBuf {
    if is_folder(named) {
        return named.join(default(scene, extension));
    }
    match (named.to_str(), stem(scene).to_str()) {
        (Some(pattern), Some(stem)) => pattern.replace(STEM, stem).into(),
        _ => named.to_owned(),
    }
}

/// The scene's name with `extension`, in the working directory.
pub fn default(scene: &Path, extension: &str) -> PathBuf {
    let mut name = stem(scene);
    name.push(".");
    name.push(extension);
    name.into()
}

/// Whether each scene has a file of its own under this name.
pub fn is_for_many(named: &Path) -> bool {
    is_folder(named) || named.to_string_lossy().contains(STEM)
}

/// Whether a folder is meant: one that is there and is not named like a picture, or a name that ends like a folder's.
fn is_folder(named: &Path) -> bool {
    let picture = named
        .extension()
        .is_some_and(|e| ["png", "exr", "neph"].iter().any(|known| e.eq_ignore_ascii_case(known)));
    let slash = named.as_os_str().as_encoded_bytes().ends_with(b"/");
    slash || (!picture && named.is_dir())
}

/// The scene's name without its extension, or both of them (`.pbrt.gz`).
fn stem(scene: &Path) -> OsString {
    let stem = scene.file_stem().unwrap_or("picture".as_ref());
    let compressed = scene.extension().is_some_and(|e| e.eq_ignore_ascii_case("gz"));
    match Path::new(stem).file_stem() {
        Some(inner) if compressed => inner.to_owned(),
        _ => stem.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_files() {
        let of = |named: &str, scene: &str| of_scene(Path::new(named), Path::new(scene), "png");
        assert_eq!(of("a.exr", "ring.toml"), Path::new("a.exr"));
        assert_eq!(of("out/", "scenes/ring.toml"), Path::new("out/ring.png"));
        assert_eq!(of(".", "scenes/ring.toml"), Path::new("./ring.png"));
        assert_eq!(of("out/{}-draft.exr", "ring.toml"), Path::new("out/ring-draft.exr"));
        assert_eq!(default(Path::new("x/a.pbrt.gz"), "png"), Path::new("a.png"));
        assert_eq!(default(Path::new("x/a.b.toml"), "png"), Path::new("a.b.png"));
        assert_eq!(default(Path::new(".."), "png"), Path::new("picture.png"));
    }

    #[test]
    fn many_scenes_need_many_names() {
        for (named, many) in
            [("a.png", false), ("out/", true), (".", true), ("{}.exr", true), ("none", false)]
        {
            assert_eq!(is_for_many(Path::new(named)), many, "{named}");
        }
    }
}
