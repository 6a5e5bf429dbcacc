//! What mdBook asks for before it makes pages: links that work in the repository become links that work in the site.

use std::io::Read as _;
use std::path::Path;

use serde_json::Value;
use testkit::markdown;

use super::REPOSITORY;
use super::links::{is_elsewhere, resolved};
use crate::{Outcome, root};

/// Reads `[context, book]` from standard input and writes the book, its links changed, to standard output.
pub fn run() -> Outcome {
    let mut text = String::new();
    std::io::stdin().read_to_string(&mut text).map_err(|e| format!("mdBook's book: {e}"))?;
    let read: Result<(Value, Value), _> = serde_json::from_str(&text);
    let (_, mut book) = read.map_err(|e| format!("mdBook's book: {e}"))?;
    chapters(&mut book);
    println!("{book}");
    Ok(())
}

/// Changes every chapter, however deep it lies.
fn chapters(value: &mut Value) {
    match value {
        Value::Object(fields) => {
            let source = fields.get("source_path").and_then(Value::as_str).map(str::to_owned);
            if let (Some(source), Some(Value::String(content))) = (source, fields.get_mut("content")) {
                *content = for_the_site(content, &Path::new("docs").join(source));
            }
            fields.values_mut().for_each(chapters);
        }
        Value::Array(items) => items.iter_mut().for_each(chapters),
        Value::Null | Value::Bool(_) | Value::Number(_) | Value::String(_) => {}
    }
}

/// A page, which lies at `page` from the root, with the links that the site needs: what lies outside of docs/ is shown by the
/// repository, and README.md is the index of its folder.
fn for_the_site(text: &str, page: &Path) -> String {
    let mut out = String::new();
    let mut from = 0;
    for link in markdown::links(text) {
        let (path, anchor) = link.target.split_at(link.target.find('#').unwrap_or(link.target.len()));
        if path.is_empty() || is_elsewhere(path) {
            continue;
        }
        let Some(file) = resolved(page, path) else { continue };
        // The site shows its contents beside every page, and as no page.
        let target = if file.starts_with("docs") && file != Path::new("docs/SUMMARY.md") {
            match path.strip_suffix("README.md") {
                Some(folder) => format!("{folder}index.md"),
                None => path.to_owned(),
            }
        } else {
            let how = if root().join(&file).is_dir() { "tree" } else { "blob" };
            format!("{REPOSITORY}/{how}/main/{}", file.display())
        };
        out.push_str(&text[from..link.at]);
        out.push_str(&target);
        out.push_str(anchor);
        from = link.at + link.target.len();
    }
    out + &text[from..]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_are_those_of_the_site() {
        let page = Path::new("docs/book/a.md");
        let site = |text: &str| for_the_site(text, page);
        assert_eq!(
            site("[b](b.md#c) [d](https://e.org/README.md)"),
            "[b](b.md#c) [d](https://e.org/README.md)"
        );
        assert_eq!(
            site("[a](../../ARCHITECTURE.md#crates), [s](../../scenes)."),
            format!(
                "[a]({REPOSITORY}/blob/main/ARCHITECTURE.md#crates), [s]({REPOSITORY}/tree/main/scenes)."
            )
        );
        assert_eq!(site("[g](../gallery/README.md#x)"), "[g](../gallery/index.md#x)");
    }

    #[test]
    fn chapters_within_chapters_are_changed() {
        let mut book = serde_json::json!({ "items": [{ "Chapter": {
            "content": "", "source_path": "README.md", "sub_items": [{ "Chapter": {
                "content": "[x](../../LICENSE-MIT)", "source_path": "book/a.md", "sub_items": [] } }] } }] });
        chapters(&mut book);
        let content = &book["items"][0]["Chapter"]["sub_items"][0]["Chapter"]["content"];
        assert_eq!(*content, format!("[x]({REPOSITORY}/blob/main/LICENSE-MIT)"));
    }
}
