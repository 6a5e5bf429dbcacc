//! One meaning a word: the glossary says which, and pages use no other.

use std::path::Path;

use testkit::markdown;

use crate::Outcome;

/// Words that are not used, and what is written instead.
const BANNED: &[(&str, &str)] = &[
    ("eye path", "camera path"),
    ("eye ray", "camera path"),
    ("view ray", "camera path"),
    ("particle tracing", "tracing light paths"),
    ("nested medium", "a dielectric in a dielectric"),
    ("(said)", "⚠, and above the table what it stands for"),
];

/// The page that names the banned words.
const GLOSSARY: &str = "docs/book/glossary.md";

/// Banned words in the pages of docs/, one line each.
pub fn check(root: &Path) -> Outcome {
    let is_held = |page: &Path| page.starts_with("docs") && page != Path::new(GLOSSARY);
    let mut wrong = Vec::new();
    for (page, text) in markdown::pages(root)?.iter().filter(|(page, _)| is_held(page)) {
        wrong.extend(banned(text).into_iter().map(|(line, why)| format!("{}:{line}: {why}", page.display())));
    }
    if wrong.is_empty() { Ok(()) } else { Err(wrong.join("\n")) }
}

/// Line, counted from 1, and what to write instead, for each banned word; one that is broken over two lines counts.
fn banned(text: &str) -> Vec<(usize, String)> {
    let text = text.to_lowercase();
    let flat = text.replace('\n', " ");
    let mut found = Vec::new();
    for (word, instead) in BANNED {
        for (at, _) in flat.match_indices(word) {
            let line = 1 + text[..at].matches('\n').count();
            found.push((line, format!("`{word}`: the glossary says {instead}")));
        }
    }
    found
}

#[cfg(test)]
mod tests {
    #[test]
    fn banned_words_are_found() {
        let found = super::banned("A camera path.\nAn Eye\npath (said).\n");
        let lines: Vec<_> = found.iter().map(|(line, _)| *line).collect();
        assert_eq!(lines, [2, 3]);
    }

    #[test]
    fn pages_use_the_words_of_the_glossary() {
        assert_eq!(super::check(&crate::root()), Ok(()));
    }
}
