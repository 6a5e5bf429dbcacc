//! The site as it was built: every link of a page to a file of the site finds it.

use std::path::{Path, PathBuf};

use super::links::{is_elsewhere, resolved};
use crate::Outcome;

/// What is wrong with the site in `folder`, one line each.
pub fn check(folder: &Path) -> Outcome {
    let mut wrong = Vec::new();
    for page in pages(folder, Path::new(""))? {
        // Its links start from the address that was not found.
        if page == Path::new("404.html") {
            continue;
        }
        let text =
            std::fs::read_to_string(folder.join(&page)).map_err(|e| format!("{}: {e}", page.display()))?;
        for target in targets(&text) {
            if !leads(folder, &page, &target)? {
                wrong.push(format!("{}: `{target}` is not there", page.display()));
            }
        }
    }
    if wrong.is_empty() { Ok(()) } else { Err(wrong.join("\n")) }
}

/// Whether a link of a page finds its file in the site, and there its anchor.
fn leads(folder: &Path, page: &Path, target: &str) -> Result<bool, String> {
    let (path, anchor) = target.split_once('#').unwrap_or((target, ""));
    if is_elsewhere(path) || path.starts_with("data:") {
        return Ok(true);
    }
    let file = if path.is_empty() { Some(page.to_owned()) } else { resolved(page, path) };
    let Some(file) = file.map(|file| folder.join(file)).filter(|file| file.exists()) else {
        return Ok(false);
    };
    // The page that prints all chapters has their anchors in another form.
    if anchor.is_empty() || page == Path::new("print.html") || file.extension().is_none_or(|e| e != "html") {
        return Ok(true);
    }
    let text = std::fs::read_to_string(&file).map_err(|e| format!("{}: {e}", file.display()))?;
    Ok(text.contains(&format!("id=\"{anchor}\"")))
}

/// The pages below `folder`, as paths from there.
fn pages(folder: &Path, below: &Path) -> Result<Vec<PathBuf>, String> {
    let error = |e: std::io::Error| format!("{}: {e}", folder.join(below).display());
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder.join(below)).map_err(error)? {
        let entry = entry.map_err(error)?;
        let path = below.join(entry.file_name());
        if folder.join(&path).is_dir() {
            found.extend(pages(folder, &path)?);
        } else if path.extension().is_some_and(|e| e == "html") {
            found.push(path);
        }
    }
    found.sort();
    Ok(found)
}

fn targets(html: &str) -> Vec<String> {
    let mut found = Vec::new();
    for key in [" href=\"", " src=\""] {
        let after = html.match_indices(key).map(|(at, _)| &html[at + key.len()..]);
        found.extend(after.filter_map(|rest| rest.split('"').next().map(str::to_owned)));
    }
    found
}

#[cfg(test)]
mod tests {
    #[test]
    fn targets_are_links_and_pictures() {
        assert_eq!(
            super::targets("<a class=\"x\" href=\"b.html#c\">b</a><img src=\"d.svg\">"),
            ["b.html#c", "d.svg"]
        );
    }
}
