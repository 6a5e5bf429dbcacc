//! The arrows between crates (ARCHITECTURE.md), and what each layer forbids: threads, `unsafe`, clocks, files.
#![allow(clippy::unwrap_used, reason = "helpers of tests, too")]

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::Command;

/// Which crates of the workspace a crate may depend on; dev-dependencies are free.
const LAYERS: &[(&str, &[&str])] = &[
    ("math", &[]),
    ("par", &[]),
    ("sampling", &["math"]),
    ("color", &["math"]),
    ("testkit", &["math", "sampling"]),
    ("accel", &["math", "par"]),
    ("photons", &["math", "par", "color"]),
    ("mesh", &["math", "sampling"]),
    ("photometry", &["math"]),
    ("bsdf", &["math", "sampling", "color"]),
    ("scenefile", &["color"]),
    ("import", &["math", "color", "mesh", "scenefile"]),
    ("scene", &["math", "par", "sampling", "color", "accel", "mesh", "photometry", "bsdf", "scenefile"]),
    ("film", &["math", "color"]),
    ("develop", &["color", "film"]),
    ("denoise", &[]),
    ("transport", &["math", "sampling", "color", "scene", "bsdf", "photons"]),
    ("integrators", &["math", "par", "sampling", "color", "scene", "bsdf", "photons", "film", "transport"]),
    ("session", &["par", "color", "denoise", "scenefile", "scene", "film", "develop", "integrators"]),
    (
        "nephroid",
        &["math", "color", "scenefile", "import", "scene", "film", "develop", "integrators", "session"],
    ),
    ("cli", &["nephroid"]),
];

/// Not layers: they measure and drive the others, and nothing depends on them.
const TOOLS: &[&str] = &["xtask", "benches"];

/// A word, the crates that may use it in `src`, and what it would bring in elsewhere.
const WORDS: &[(&str, &[&str], &str)] = &[
    ("rayon", &["par"], "threads"),
    ("std::thread", &["par"], "threads"),
    ("thread::spawn", &["par"], "threads"),
    ("thread_local", &[], "state that depends on the schedule"),
    ("unsafe", &["accel", "photons", "denoise"], "unsafe code"),
];

/// Layers that see no clock and no file.
const PURE: &[&str] =
    &["math", "sampling", "color", "bsdf", "photons", "transport", "integrators", "develop"];
const IMPURE: &[&str] = &["std::time", "std::fs", "Instant", "SystemTime", "std::env"];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Name without the workspace's prefix.
fn short(package: &str) -> &str {
    package.strip_prefix("nephroid-").unwrap_or(package)
}

struct Package {
    name: String,
    folder: PathBuf,
    /// Normal and build dependencies, workspace crates by their short names.
    depends: BTreeSet<String>,
}

fn packages() -> Vec<Package> {
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--no-deps", "--format-version", "1", "--offline"])
        .current_dir(root())
        .output()
        .expect("cargo runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let metadata: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let package = |p: &serde_json::Value| Package {
        name: short(p["name"].as_str().unwrap()).to_owned(),
        folder: Path::new(p["manifest_path"].as_str().unwrap()).parent().unwrap().to_owned(),
        depends: p["dependencies"]
            .as_array()
            .unwrap()
            .iter()
            .filter(|d| d["kind"].as_str() != Some("dev"))
            .map(|d| d["name"].as_str().unwrap())
            .map(|name| short(name).to_owned())
            .collect(),
    };
    metadata["packages"].as_array().unwrap().iter().map(package).collect()
}

/// Arrows that point up or sideways.
fn wrong_arrows(packages: &[Package]) -> Vec<String> {
    let ours: BTreeSet<&str> = packages.iter().map(|p| p.name.as_str()).collect();
    let allowed: BTreeMap<&str, &[&str]> = LAYERS.iter().copied().collect();
    let mut wrong = Vec::new();
    for package in packages.iter().filter(|p| !TOOLS.contains(&p.name.as_str())) {
        let Some(allowed) = allowed.get(package.name.as_str()) else {
            wrong.push(format!("{} has no place among the layers", package.name));
            continue;
        };
        for to in package.depends.iter().filter(|d| ours.contains(d.as_str())) {
            if !allowed.contains(&to.as_str()) {
                wrong.push(format!("{} -> {to}", package.name));
            }
        }
    }
    wrong
}

/// The code of a source file: no comments, no string or character literals (raw strings count as strings), nothing
/// from `#[cfg(test)]` on.
fn code(text: &str) -> String {
    let text = text.split("#[cfg(test)]").next().unwrap_or_default();
    let mut out = String::new();
    let mut rest = text;
    while let Some(c) = rest.chars().next() {
        let skip = if rest.starts_with("//") {
            rest.find('\n').unwrap_or(rest.len())
        } else if rest.starts_with("/*") {
            rest.find("*/").map_or(rest.len(), |i| i + 2)
        } else if rest.starts_with("r#\"") {
            rest.find("\"#").map_or(rest.len(), |i| i + 2)
        } else if rest.starts_with("'\"'") {
            3
        } else if c == '"' {
            string_end(rest)
        } else {
            out.push(c);
            c.len_utf8()
        };
        rest = &rest[skip..];
    }
    out
}

/// Bytes of the string literal that `text` starts with.
fn string_end(text: &str) -> usize {
    let mut escaped = false;
    for (i, b) in text.bytes().enumerate().skip(1) {
        match b {
            _ if escaped => escaped = false,
            b'\\' => escaped = true,
            b'"' => return i + 1,
            _ => {}
        }
    }
    text.len()
}

/// Whether `word` stands in `code` on its own.
fn has_word(code: &str, word: &str) -> bool {
    let part = |c: char| c.is_alphanumeric() || c == '_';
    code.match_indices(word)
        .any(|(i, _)| !code[..i].ends_with(part) && !code[i + word.len()..].starts_with(part))
}

fn sources(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(sources(&path));
        } else if path.extension().is_some_and(|e| e == "rs") {
            found.push(path);
        }
    }
    found.sort();
    found
}

/// What a source file of a crate uses that its layer forbids.
fn forbidden_words(name: &str, text: &str) -> Vec<String> {
    let code = code(text);
    let mut wrong = Vec::new();
    for (word, allowed, what) in WORDS {
        if !allowed.contains(&name) && has_word(&code, word) {
            wrong.push(format!("`{word}` ({what})"));
        }
    }
    if PURE.contains(&name) {
        wrong.extend(
            IMPURE
                .iter()
                .filter(|w| has_word(&code, w))
                .map(|w| format!("`{w}` (clock, file or environment)")),
        );
    }
    wrong
}

#[test]
fn arrows_point_down() {
    let packages = packages();
    assert_eq!(wrong_arrows(&packages), Vec::<String>::new());
    let found: BTreeSet<&str> = packages.iter().map(|p| p.name.as_str()).collect();
    let gone: Vec<_> = LAYERS.iter().map(|(name, _)| *name).filter(|name| !found.contains(name)).collect();
    assert_eq!(gone, Vec::<&str>::new(), "rows of crates that are no more");
}

#[test]
fn the_table_has_no_cycle() {
    let mut placed = BTreeSet::new();
    for (name, below) in LAYERS {
        let early: Vec<_> = below.iter().filter(|b| !placed.contains(*b)).collect();
        assert!(early.is_empty(), "{name} stands above {early:?} in the table");
        placed.insert(name);
    }
}

#[test]
fn rayon_is_a_dependency_of_par_alone() {
    let users: Vec<_> =
        packages().into_iter().filter(|p| p.depends.contains("rayon")).map(|p| p.name).collect();
    assert_eq!(users, ["par"]);
}

#[test]
fn layers_keep_what_they_promise() {
    let mut wrong = Vec::new();
    let mut files = 0;
    for package in packages().iter().filter(|p| !TOOLS.contains(&p.name.as_str())) {
        for file in sources(&package.folder.join("src")) {
            files += 1;
            let text = std::fs::read_to_string(&file).unwrap();
            for what in forbidden_words(&package.name, &text) {
                let short = file.strip_prefix(&package.folder).unwrap().display().to_string();
                wrong.push(format!("{}: {short}: {what}", package.name));
            }
        }
    }
    assert!(files > LAYERS.len(), "{files} sources found");
    assert_eq!(wrong, Vec::<String>::new());
}

#[test]
fn a_planted_arrow_is_found() {
    let mut packages = packages();
    packages.iter_mut().find(|p| p.name == "film").unwrap().depends.insert("scene".into());
    packages.push(Package { name: "new".into(), folder: PathBuf::new(), depends: BTreeSet::new() });
    assert_eq!(wrong_arrows(&packages), ["film -> scene", "new has no place among the layers"]);
}

#[test]
fn planted_words_are_found() {
    let text = "// unsafe\nuse std::time::Instant;\nfn f() -> &'static str { \"rayon // unsafe \\\" std::fs\" }\n\
                fn g() { unsafe { h() } }\n#[cfg(test)]\nmod tests { use std::fs; }\n";
    assert_eq!(
        forbidden_words("transport", text),
        [
            "`unsafe` (unsafe code)",
            "`std::time` (clock, file or environment)",
            "`Instant` (clock, file or environment)"
        ]
    );
    assert_eq!(forbidden_words("accel", text), Vec::<String>::new());
    assert!(!has_word("unsafe_code", "unsafe"));
    assert!(has_word("(unsafe)", "unsafe"));
    assert_eq!(code("a /* unsafe */ b r#\"unsafe \"x\" \"# '\"' c // d\ne"), "a  b   c \ne");
}
