//! Whatever the bytes, there is an answer: no panic, no hang.
#![allow(clippy::unwrap_used)] // a test may

use std::path::Path;
use std::time::{Duration, Instant};

use nephroid_scenefile::diagnostic::CODES;
use nephroid_scenefile::spec::SECTIONS;
use nephroid_scenefile::{Loaded, parse};

/// Reads a text, and whatever it is, renders what is to be said of it.
fn read(text: &str, overrides: &[String]) -> Loaded {
    let loaded = parse(text, Path::new("hostile.toml"), overrides);
    let rendered = loaded.render();
    assert!(loaded.desc.is_some() != loaded.diagnostics.iter().any(|d| d.is_error()), "{text}\n{rendered}");
    assert!(loaded.diagnostics.len() <= 101);
    for diagnostic in &loaded.diagnostics {
        assert!(CODES.iter().any(|(code, _)| *code == diagnostic.code), "{}", diagnostic.code);
    }
    loaded
}

fn next(state: &mut u64) -> u64 {
    // xorshift64 (Marsaglia 2003).
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    *state
}

/// Every example of the reference: all keys and kinds between them.
fn corpus() -> Vec<String> {
    let examples = SECTIONS
        .iter()
        .flat_map(|s| std::iter::once(s.example).chain(s.variants().iter().map(|v| v.example)));
    let mut all: Vec<String> = examples.filter(|example| !example.is_empty()).map(str::to_owned).collect();
    all.push(all.concat());
    all
}

#[test]
fn mutated_scenes() {
    const PIECES: &[&str] = &[
        "[",
        "]",
        "{",
        "}",
        "\"",
        "'",
        "'''",
        "=",
        ".",
        ",",
        "\n",
        "\r\n",
        "#",
        "nan",
        "-inf",
        "1e999",
        "-1",
        "0x7f",
        "99999999999999999999999999999999999999999999",
        "\u{feff}",
        "\u{0}",
        "漢",
        "\t",
        "[[objects]]\n",
        "[camera]\n",
        "[[groups.a.objects]]\n",
        "texture = ",
        "{ texture = 3 }",
        "1979-05-27",
        "true",
        "\\u0000",
        "\\",
    ];
    let corpus = corpus();
    let mut state = 0x1234_5678_9abc_def1;
    let start = Instant::now();
    let mut errors = 0;
    for round in 0..4000 {
        let mut bytes = corpus[next(&mut state) as usize % corpus.len()].clone().into_bytes();
        for _ in 0..1 + next(&mut state) % 6 {
            let at = next(&mut state) as usize % (bytes.len() + 1);
            let length = (next(&mut state) % 12) as usize;
            let end = (at + length).min(bytes.len());
            match next(&mut state) % 5 {
                0 => drop(bytes.drain(at..end)),
                1 => {
                    let piece = PIECES[next(&mut state) as usize % PIECES.len()];
                    bytes.splice(at..at, piece.bytes());
                }
                2 => {
                    let piece = bytes[at..end].to_vec();
                    let to = next(&mut state) as usize % (bytes.len() + 1);
                    bytes.splice(to..to, piece);
                }
                3 => {
                    let piece = PIECES[next(&mut state) as usize % PIECES.len()];
                    bytes.splice(at..end, piece.bytes());
                }
                _ => {
                    if let Some(byte) = bytes.get_mut(at) {
                        *byte = next(&mut state) as u8;
                    }
                }
            }
        }
        let text = String::from_utf8_lossy(&bytes);
        // Every other round the mutated text also serves as an override.
        let line = text.lines().nth(round % 3).unwrap_or("").to_owned();
        let overrides = [line, format!("objects.{}", text.trim())];
        errors += usize::from(read(&text, &overrides[..(round % 3)]).desc.is_none());
    }
    assert!(errors > 1000);
    assert!(start.elapsed() < Duration::from_secs(30));
}

#[test]
fn truncated_scenes() {
    let text = corpus().pop().unwrap();
    for end in (0..text.len()).filter(|&end| text.is_char_boundary(end)).step_by(7) {
        read(&text[..end], &[]);
    }
}

#[test]
fn deep_long_and_many() {
    let n = 200_000;
    let texts = [
        "[".repeat(n),
        format!("a = {}", "[".repeat(n)),
        format!("a = {}{}", "[".repeat(n), "]".repeat(n)),
        format!("a = {}", "{ b = ".repeat(n)),
        format!("{}c = 1", "a.".repeat(n)),
        format!("[{}a]", "a.".repeat(n)),
        "[[objects]]\n".repeat(n / 4),
        "[[objects]]\nshape = \"sphere\"\nradius = -1\n".repeat(n / 20),
        (0..n / 4).map(|i| format!("key{i} = 1\n")).collect(),
        format!("[[objects]]\n{}", (0..n / 4).map(|i| format!("key{i} = 1\n")).collect::<String>()),
        (0..n / 20)
            .map(|i| {
                format!("[textures.t{i}]\nkind = \"checker\"\na = 0\nb = {{ texture = \"t{}\" }}\n", i + 1)
            })
            .collect(),
        format!("{} = 1", "k".repeat(n)),
        format!("a = \"{}", "x".repeat(n)),
        "= \n".repeat(n / 4),
        "\u{0}".repeat(n),
        format!(
            "[[objects]]\nshape = \"triangles\"\npositions = [{}]\nindices = [[0, 1, 2]]",
            "[0, 0, \"\"],".repeat(n / 10)
        ),
        format!("[[objects]]\nshape = \"sphere\"\ntransform = [{}]", "{ scale = 0 },".repeat(n / 10)),
        format!("[materials.{0}]\nkind = \"{0}\"\n", "x".repeat(n)),
    ];
    for text in texts {
        let start = Instant::now();
        assert!(read(&text, &[]).desc.is_none());
        assert!(start.elapsed() < Duration::from_secs(5), "{:.40}: {:?}", text, start.elapsed());
    }
}

#[test]
fn a_hundred_mistakes_are_shown_and_the_rest_counted() {
    let loaded = read(
        &"[[objects]]\nshape = \"sphere\"\nradius = -1\nmaterial = { kind = \"mirror\" }\n".repeat(150),
        &[],
    );
    assert_eq!(loaded.diagnostics.len(), 101);
    // 150 radii and no camera.
    assert_eq!(loaded.diagnostics[100].message, "51 more mistakes are not shown");
}
