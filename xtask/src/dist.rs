//! `cargo xtask dist`: what a release hands out: the stripped program with its man page, completions and licences, as a
//! `.tar.gz` with the same bytes for the same program.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

use crate::{Outcome, root};

/// Files of the repository that go along as they are.
const ALONG: [&str; 5] = ["README.md", "CHANGELOG.md", "LICENSE-MIT", "LICENSE-APACHE", "NOTICE"];

/// Shells, and where each looks for completions below `share`.
const SHELLS: [(&str, &str); 3] = [
    ("bash", "share/bash-completion/completions/nephroid"),
    ("zsh", "share/zsh/site-functions/_nephroid"),
    ("fish", "share/fish/vendor_completions.d/nephroid.fish"),
];

/// A file of the archive: its path, its bytes, and whether it is a program.
struct Entry {
    path: String,
    bytes: Vec<u8>,
    runs: bool,
}

impl Entry {
    fn plain(path: impl Into<String>, bytes: impl Into<Vec<u8>>) -> Self {
        Self { path: path.into(), bytes: bytes.into(), runs: false }
    }
}

/// Builds, gathers and packs; `--target TRIPLE` builds for another target, as far as it is installed.
pub fn run(arguments: &[String]) -> Outcome {
    let target = match arguments {
        [] => host()?,
        [flag, target] if flag == "--target" => target.clone(),
        _ => return Err("usage: cargo xtask dist [--target TRIPLE]".into()),
    };
    let metadata = metadata(&target)?;
    let program = build(&target)?;
    let binary = read(&program)?;
    let mut entries = vec![Entry { path: "nephroid".into(), bytes: binary.clone(), runs: true }];
    for name in ALONG {
        entries.push(Entry::plain(name, read(&root().join(name))?));
    }
    entries.push(Entry::plain("THIRD-PARTY.txt", third_parties(&metadata)?));
    if target == host()? {
        entries.push(Entry::plain("share/man/man1/nephroid.1", said(&program, &["man"])?));
        for (shell, path) in SHELLS {
            entries.push(Entry::plain(path, said(&program, &["completions", shell])?));
        }
    } else {
        println!("no man page and completions: the program of another target does not run here");
    }
    let name = format!("nephroid-{}-{target}", env!("CARGO_PKG_VERSION"));
    let folder = root().join("target/dist");
    std::fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let archive = folder.join(format!("{name}.tar.gz"));
    let packed = pack(&name, &entries).map_err(|e| format!("the archive: {e}"))?;
    std::fs::write(&archive, &packed).map_err(|e| format!("{}: {e}", archive.display()))?;
    let needs = match newest_glibc(&binary) {
        Some([major, minor]) => format!("needs glibc {major}.{minor} or newer"),
        None => "needs no glibc (and so cannot load a denoiser)".into(),
    };
    println!("program {:.1} MB, {needs}", megabytes(binary.len()));
    println!("{}: {:.1} MB, {} files", archive.display(), megabytes(packed.len()), entries.len());
    Ok(())
}

fn megabytes(bytes: usize) -> f64 {
    bytes as f64 / 1e6
}

fn read(path: &Path) -> Result<Vec<u8>, String> {
    std::fs::read(path).map_err(|e| format!("{}: {e}", path.display()))
}

/// What a command writes to its standard output.
fn said(program: &Path, arguments: &[&str]) -> Result<Vec<u8>, String> {
    let output = Command::new(program)
        .args(arguments)
        .current_dir(root())
        .output()
        .map_err(|e| format!("{}: {e}", program.display()))?;
    if output.status.success() {
        Ok(output.stdout)
    } else {
        Err(format!(
            "{} {}: {}",
            program.display(),
            arguments.join(" "),
            String::from_utf8_lossy(&output.stderr)
        ))
    }
}

/// The target that this compiler builds for by itself.
fn host() -> Result<String, String> {
    let version = said(Path::new("rustc"), &["--version", "--verbose"])?;
    let version = String::from_utf8_lossy(&version).into_owned();
    let line = version.lines().find_map(|line| line.strip_prefix("host: "));
    line.map(str::to_owned).ok_or_else(|| "rustc does not say its host".into())
}

/// The program without symbols. Only its last step differs from the ordinary release build.
fn build(target: &str) -> Result<PathBuf, String> {
    let mut arguments =
        vec!["rustc", "--release", "--locked", "--package", "nephroid-cli", "--bin", "nephroid"];
    let other = target != host()?;
    if other {
        arguments.extend(["--target", target]);
    }
    arguments.extend(["--", "-C", "strip=symbols"]);
    let status = Command::new(env!("CARGO"))
        .args(&arguments)
        .current_dir(root())
        .status()
        .map_err(|e| format!("cargo does not start: {e}"))?;
    if !status.success() {
        return Err(format!("the program does not build for {target}"));
    }
    let here = std::env::current_exe().map_err(|e| format!("this program cannot find itself: {e}"))?;
    let suffix = if target.contains("windows") { ".exe" } else { "" };
    let file = format!("nephroid{suffix}");
    let release = here.parent().ok_or("this program lies nowhere")?;
    let folder = if other { release.join("..").join(target).join("release") } else { release.to_owned() };
    Ok(folder.join(file))
}

fn metadata(target: &str) -> Result<Value, String> {
    let arguments = ["metadata", "--format-version", "1", "--locked", "--filter-platform", target];
    let text = said(Path::new(env!("CARGO")), &arguments)?;
    serde_json::from_slice(&text).map_err(|e| format!("cargo metadata: {e}"))
}

fn list<'a>(value: &'a Value, key: &str) -> &'a [Value] {
    value[key].as_array().map_or(&[], Vec::as_slice)
}

/// Ids of the packages that the program is linked with: normal dependencies only, from `nephroid-cli` on.
fn linked(metadata: &Value) -> BTreeSet<&str> {
    let package = |id: &str| list(metadata, "packages").iter().find(|package| package["id"] == id);
    let mut open: Vec<&str> = list(metadata, "packages")
        .iter()
        .filter(|package| package["name"] == "nephroid-cli")
        .filter_map(|package| package["id"].as_str())
        .collect();
    let mut found = BTreeSet::new();
    while let Some(id) = open.pop() {
        let macros = package(id).is_some_and(|package| {
            list(package, "targets")
                .iter()
                .any(|target| list(target, "kind").iter().any(|kind| kind == "proc-macro"))
        });
        if macros || !found.insert(id) {
            continue; // a macro runs in the compiler and is no part of the program
        }
        let Some(node) = list(&metadata["resolve"], "nodes").iter().find(|node| node["id"] == id) else {
            continue;
        };
        for dependency in list(node, "deps") {
            if list(dependency, "dep_kinds").iter().any(|kind| kind["kind"].is_null()) {
                open.extend(dependency["pkg"].as_str());
            }
        }
    }
    found
}

/// Licences of all that others made: a list, then every text once, with the packages that it stands in.
fn third_parties(metadata: &Value) -> Result<String, String> {
    let ids = linked(metadata);
    let mut rows = Vec::new();
    let mut texts: Vec<(String, Vec<String>)> = Vec::new();
    for package in list(metadata, "packages") {
        let text = |key: &str| package[key].as_str().unwrap_or_default();
        if !ids.contains(text("id")) || package["source"].is_null() {
            continue;
        }
        let name = format!("{} {}", text("name"), text("version"));
        let licence = if text("license").is_empty() { "see its text" } else { text("license") };
        rows.push(format!("{name}: {licence}; {}", text("repository")));
        let folder = Path::new(text("manifest_path")).parent().ok_or("a package lies nowhere")?;
        for licence in licences(folder)? {
            match texts.iter_mut().find(|(text, _)| *text == licence) {
                Some((_, names)) => names.push(name.clone()),
                None => texts.push((licence, vec![name.clone()])),
            }
        }
    }
    rows.sort();
    let mut out = format!("Nephroid is linked with {} packages of others:\n\n", rows.len());
    rows.iter().for_each(|row| {
        let _ = writeln!(out, "  {row}");
    });
    for (text, names) in texts {
        let _ = write!(out, "\n{}\n{}\n\n{}\n", "=".repeat(78), names.join(", "), text.trim_end());
    }
    Ok(out)
}

/// The texts of licences in a package's folder, by name.
fn licences(folder: &Path) -> Result<Vec<String>, String> {
    let says = |name: &str| {
        ["LICENSE", "LICENCE", "COPYING", "NOTICE", "UNLICENSE"].iter().any(|w| name.starts_with(w))
    };
    let entries = std::fs::read_dir(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let mut paths: Vec<_> = entries
        .filter_map(Result::ok)
        .map(|entry| entry.path())
        .filter(|path| path.is_file())
        .filter(|path| path.file_name().is_some_and(|name| says(&name.to_string_lossy().to_uppercase())))
        .collect();
    paths.sort();
    paths.iter().map(|path| Ok(String::from_utf8_lossy(&read(path)?).replace('\r', ""))).collect()
}

/// The newest version of glibc whose symbols a program asks for: the greatest `GLIBC_2.x` among its strings.
fn newest_glibc(binary: &[u8]) -> Option<[u32; 2]> {
    let mark = b"GLIBC_";
    let number = |bytes: &[u8]| {
        let text: String = bytes.iter().take(8).map(|&b| char::from(b)).collect();
        let mut parts = text.split(|c: char| !c.is_ascii_digit() && c != '.').next()?.split('.');
        Some([parts.next()?.parse().ok()?, parts.next()?.parse().ok()?])
    };
    let found = binary.windows(mark.len()).enumerate().filter(|(_, window)| window == mark);
    found.filter_map(|(i, _)| number(&binary[i + mark.len()..])).max()
}

/// A `.tar.gz` without clocks and owners in it.
fn pack(name: &str, entries: &[Entry]) -> std::io::Result<Vec<u8>> {
    let gzip = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::best());
    let mut archive = tar::Builder::new(gzip);
    for entry in entries {
        let mut header = tar::Header::new_gnu();
        header.set_size(entry.bytes.len() as u64);
        header.set_mode(if entry.runs { 0o755 } else { 0o644 });
        header.set_mtime(0);
        header.set_cksum();
        archive.append_data(&mut header, format!("{name}/{}", entry.path), entry.bytes.as_slice())?;
    }
    let mut gzip = archive.into_inner()?;
    gzip.flush()?;
    gzip.finish()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Read as _;

    #[test]
    fn the_newest_glibc_is_found() {
        assert_eq!(newest_glibc(b"\0GLIBC_2.2.5\0GLIBC_2.34\0GLIBC_2.9\0GLIBC_PRIVATE\0"), Some([2, 34]));
        assert_eq!(newest_glibc(b"GLIBC_"), None);
        assert_eq!(newest_glibc(b""), None);
    }

    #[test]
    fn archives_have_equal_bytes_and_modes() {
        let entries = [
            Entry { path: "nephroid".into(), bytes: b"program".to_vec(), runs: true },
            Entry::plain("share/man/man1/nephroid.1", "page"),
        ];
        let packed = pack("nephroid-0", &entries).unwrap();
        assert_eq!(packed, pack("nephroid-0", &entries).unwrap());
        let mut archive = tar::Archive::new(flate2::read::GzDecoder::new(packed.as_slice()));
        let mut seen = Vec::new();
        for entry in archive.entries().unwrap() {
            let mut entry = entry.unwrap();
            let mut text = String::new();
            entry.read_to_string(&mut text).unwrap();
            let header = entry.header();
            seen.push((entry.path().unwrap().display().to_string(), header.mode().unwrap(), text.clone()));
        }
        let wanted = [
            ("nephroid-0/nephroid", 0o755, "program"),
            ("nephroid-0/share/man/man1/nephroid.1", 0o644, "page"),
        ];
        assert_eq!(seen, wanted.map(|(path, mode, text)| (path.to_owned(), mode, text.to_owned())));
    }

    #[test]
    fn licences_of_what_is_linked_are_listed() {
        let text = third_parties(&metadata(&host().unwrap()).unwrap()).unwrap();
        for name in ["clap ", "exr ", "image ", "rayon "] {
            assert!(text.contains(&format!("\n  {name}")), "{name}");
        }
        assert!(!text.contains("\n  expect-test "), "needed by tests alone");
        assert!(text.contains("Permission is hereby granted"));
    }
}
