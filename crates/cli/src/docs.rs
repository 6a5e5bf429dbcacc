//! Tests of the documentation: what its pages tell people to type and to write is taken by the program.

use std::path::{Path, PathBuf};

use nephroid::{Severity, compile, parse};
use testkit::markdown::{self, Block};

use crate::typed;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// What is wrong with the blocks of a page, each with its place.
fn wrong(page: &Path, text: &str) -> Vec<String> {
    let mut wrong = Vec::new();
    for block in markdown::blocks(text) {
        let found = match block.language.as_str() {
            "" | "sh" | "bash" | "console" | "text" => {
                commands(&block).iter().filter_map(|words| refused(words)).collect()
            }
            "toml" => mistakes(&block.text),
            _ => Vec::new(),
        };
        wrong.extend(found.into_iter().map(|why| format!("{}:{}: {why}", page.display(), block.line)));
    }
    wrong
}

/// The command lines of a block that call the program, word by word, the program's name first.
fn commands(block: &Block) -> Vec<Vec<String>> {
    let joined = block.text.replace("\\\n", " ");
    let mut found = Vec::new();
    for line in joined.lines() {
        let line = line.trim_start().trim_start_matches("$ ");
        for mut words in calls(line) {
            let is_prefix = |word: &str| ["time", "nice", "do"].contains(&word) || word.contains('=');
            while words.first().is_some_and(|word| is_prefix(word)) {
                words.remove(0);
            }
            let from = match words.first().map(String::as_str) {
                Some("nephroid") => 0,
                Some("cargo") if words.get(1).is_some_and(|word| word == "run") => {
                    let Some(dashes) = words.iter().position(|word| word == "--") else { continue };
                    let before = &words[..dashes];
                    if before.iter().any(|word| word == "-p" || word.starts_with("--package")) {
                        continue;
                    }
                    dashes
                }
                _ => continue,
            };
            let rest = words[from + 1..].iter().cloned();
            found.push(std::iter::once("nephroid".to_owned()).chain(rest).collect());
        }
    }
    found
}

/// The calls of a shell's line, word by word: quotes are taken off, a comment and what is redirected are left out.
fn calls(line: &str) -> Vec<Vec<String>> {
    let mut calls = vec![Vec::new()];
    let mut word: Option<String> = None;
    let mut quote = None;
    for c in line.chars() {
        match (quote, c) {
            (Some(q), _) if c == q => quote = None,
            (Some(_), _) => word.get_or_insert_default().push(c),
            (None, '\'' | '"') => {
                quote = Some(c);
                word.get_or_insert_default();
            }
            (None, '#') if word.is_none() => break,
            (None, '>') => break,
            (None, ' ' | '|' | '&' | ';') => {
                calls.last_mut().unwrap().extend(word.take());
                if c != ' ' {
                    calls.push(Vec::new());
                }
            }
            (None, _) => word.get_or_insert_default().push(c),
        }
    }
    calls.last_mut().unwrap().extend(word);
    calls
}

/// Why the parser refuses a command line.
fn refused(words: &[String]) -> Option<String> {
    use clap::error::ErrorKind::{DisplayHelp, DisplayVersion};
    let error = typed::parse(words.iter().map(Into::into).collect()).err()?;
    let is_answer = [DisplayHelp, DisplayVersion].contains(&error.kind());
    (!is_answer)
        .then(|| format!("`{}`: {}", words.join(" "), error.to_string().lines().next().unwrap_or_default()))
}

/// What a part of a scene may lack, for another part has it.
const ELSEWHERE: [&str; 7] = [
    "no-camera",
    "empty-scene",
    "no-light",
    "unknown-material",
    "unknown-texture",
    "unknown-group",
    "missing-material",
];

/// Files that a page names need not be there.
const OF_FILES: [&str; 2] = ["missing-file", "include"];

/// What a page may do on purpose: look out from under water.
const MEANT: &str = "camera-inside";

/// Errors and warnings of a scene, or of a part of one. A whole scene, which has a camera and objects, is compiled as well.
fn mistakes(text: &str) -> Vec<String> {
    let has = |head: &str| text.lines().any(|line| line.trim() == head);
    let is_whole = has("[camera]") && has("[[objects]]");
    let loaded = parse(text, &root().join("scene.toml"), &[]);
    let needs_files = loaded.diagnostics.iter().any(|d| OF_FILES.contains(&d.code));
    let told = |diagnostics: &[nephroid::Diagnostic]| -> Vec<String> {
        let counts = |d: &&nephroid::Diagnostic| {
            let may_lack =
                OF_FILES.contains(&d.code) || d.code == MEANT || (!is_whole && ELSEWHERE.contains(&d.code));
            d.severity != Severity::Note && !may_lack
        };
        diagnostics.iter().filter(counts).map(|d| format!("{}: {}", d.code, d.message)).collect()
    };
    let mut found = told(&loaded.diagnostics);
    if let Some(desc) = loaded.desc.filter(|_| is_whole && !needs_files) {
        match compile(&desc, 0) {
            Ok(compiled) => found.extend(told(&compiled.warnings)),
            Err(error) => found.push(error.to_string()),
        }
    }
    found
}

#[test]
fn the_program_takes_what_pages_say() {
    let pages = markdown::pages(&root()).unwrap();
    let found: Vec<String> = pages.iter().flat_map(|(page, text)| wrong(page, text)).collect();
    assert!(found.is_empty(), "{}", found.join("\n"));
    // The pages have been read: there is something to hold them to.
    let blocks = pages.values().flat_map(|text| markdown::blocks(text));
    let (mut typed, mut scenes) = (0, 0);
    for block in blocks {
        typed += if block.language == "toml" { 0 } else { commands(&block).len() };
        scenes += usize::from(block.language == "toml");
    }
    assert!(typed > 30 && scenes > 50, "{typed} commands, {scenes} scenes");
}

#[test]
fn what_the_program_refuses_is_found() {
    let page = "```sh\n$ nephroid render a.toml -o b.png  # --no\ntime nephroid a.toml | nephroid inof a.toml\n```\n\n\
                ```text\nnephroid render a.toml \\\n    --exposer 1\ncargo run --release -- --set 'a b'\n```\n\n\
                ```toml\n[[objects]]\nshape = \"sphere\"\nradios = 1\nmaterial = \"elsewhere\"\n```\n\n\
                ```toml\n[camera]\nposition = [0, 0, 4]\nlook_at = [0, 0, 0]\n[[objects]]\n\
                shape = \"sphere\"\nradius = 1\nmaterial = { kind = \"diffuse\" }\n```\n";
    let found = wrong(Path::new("a.md"), page);
    let expected = [
        "a.md:1: `nephroid inof a.toml`",
        "a.md:6: `nephroid render a.toml --exposer 1`",
        "a.md:6: `nephroid --set a b`",
        "a.md:12: unknown-key",
        "a.md:19: no-light",
    ];
    for start in expected {
        assert!(found.iter().any(|line| line.starts_with(start)), "{start}: {found:#?}");
    }
    for line in &found {
        assert!(expected.iter().any(|start| line.starts_with(start)), "{line}");
    }
}
