//! The site as it was built: every link of a page to a file of the site finds it.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::links::{is_elsewhere, resolved};
use crate::Outcome;

/// What is wrong with the site in `folder`, one line each.
pub fn check(folder: &Path) -> Outcome {
    let read = |page: PathBuf| {
        let text =
            std::fs::read_to_string(folder.join(&page)).map_err(|e| format!("{}: {e}", page.display()))?;
        Ok((page, text))
    };
    let pages: BTreeMap<PathBuf, String> =
        pages(folder, Path::new(""))?.into_iter().map(read).collect::<Result<_, String>>()?;
    let site = Site { folder, pages };
    let mut wrong = Vec::new();
    // The links of the page for addresses that are not found start from those.
    for (page, text) in site.pages.iter().filter(|(page, _)| *page != Path::new("404.html")) {
        for target in targets(text) {
            if !site.leads(page, &target) {
                wrong.push(format!("{}: `{target}` is not there", page.display()));
            }
        }
    }
    if wrong.is_empty() { Ok(()) } else { Err(wrong.join("\n")) }
}

struct Site<'a> {
    folder: &'a Path,
    /// Text by path from the folder.
    pages: BTreeMap<PathBuf, String>,
}

impl Site<'_> {
    /// Whether a link of a page finds its file in the site, and there its anchor.
    fn leads(&self, page: &Path, target: &str) -> bool {
        let (path, anchor) = target.split_once('#').unwrap_or((target, ""));
        if is_elsewhere(path) || path.starts_with("data:") {
            return true;
        }
        let file = if path.is_empty() { Some(page.to_owned()) } else { resolved(page, path) };
        let Some(file) = file.filter(|file| self.folder.join(file).exists()) else { return false };
        // The page that prints all chapters has their anchors in another form.
        if anchor.is_empty() || page == Path::new("print.html") {
            return true;
        }
        self.pages.get(&file).is_none_or(|text| text.contains(&format!("id=\"{anchor}\"")))
    }
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
