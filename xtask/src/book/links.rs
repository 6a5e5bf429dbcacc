//! What Markdown pages link to: files, anchors and pictures that are there.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Component, Path, PathBuf};

use testkit::markdown::{self, Link};

use super::REPOSITORY;
use crate::Outcome;

/// The contents of the site, from the root.
const SUMMARY: &str = "docs/SUMMARY.md";

/// Bytes that the pictures of docs/ may have, all together.
const MOST_OF_PICTURES: u64 = 12_000_000;

/// What is wrong with any page of the repository at `root`, one line each.
pub fn check(root: &Path) -> Outcome {
    let repository = Repository { root, pages: markdown::pages(root)? };
    let mut wrong = Vec::new();
    for (page, text) in &repository.pages {
        for link in markdown::links(text) {
            if let Err(why) = repository.follow(page, &link) {
                wrong.push(format!("{}:{}: `{}` {why}", page.display(), link.line, link.target));
            }
        }
    }
    wrong.extend(repository.unlisted());
    let bytes = pictures(&root.join("docs"))?;
    if bytes > MOST_OF_PICTURES {
        wrong.push(format!("docs: pictures have {bytes} bytes, more than {MOST_OF_PICTURES}"));
    }
    if wrong.is_empty() { Ok(()) } else { Err(wrong.join("\n")) }
}

struct Repository<'a> {
    root: &'a Path,
    /// Text by path from the root.
    pages: BTreeMap<PathBuf, String>,
}

impl Repository<'_> {
    /// Why a link of a page leads nowhere.
    fn follow(&self, page: &Path, link: &Link) -> Outcome {
        if link.is_image && link.text.trim().is_empty() {
            return Err("says nothing to those who cannot see it: write ![what it shows](…)".into());
        }
        let (path, anchor) = match link.target.split_once('#') {
            Some((path, anchor)) => (path, Some(anchor)),
            None => (link.target.as_str(), None),
        };
        let own = path.strip_prefix(REPOSITORY).and_then(|rest| rest.strip_prefix('/'));
        let file = if path.is_empty() {
            page.to_owned()
        } else if let Some(rest) = own {
            match rest.strip_prefix("blob/main/").or_else(|| rest.strip_prefix("tree/main/")) {
                Some(file) => PathBuf::from(file),
                None => return Ok(()), // issues, releases
            }
        } else if is_elsewhere(path) {
            return Ok(());
        } else {
            resolved(page, path).ok_or("leaves the repository")?
        };
        if !self.pages.contains_key(&file) && !self.root.join(&file).exists() {
            return Err("is not there".into());
        }
        if link.is_image && page.starts_with("docs") && !file.starts_with("docs") {
            return Err("lies outside of docs/, where the site does not find it".into());
        }
        match (anchor, self.pages.get(&file)) {
            (Some(anchor), Some(text)) => names_heading(anchor, &markdown::anchors(text)),
            _ => Ok(()),
        }
    }

    /// Pages of docs/ that the contents of the site do not list.
    fn unlisted(&self) -> Vec<String> {
        let summary = Path::new(SUMMARY);
        let Some(text) = self.pages.get(summary) else { return vec![format!("{SUMMARY} is not there")] };
        let listed: BTreeSet<PathBuf> =
            markdown::links(text).iter().filter_map(|link| resolved(summary, &link.target)).collect();
        let pages = self.pages.keys().filter(|page| page.starts_with("docs") && *page != summary);
        let missing = pages.filter(|page| !listed.contains(*page));
        missing.map(|page| format!("{}: {SUMMARY} does not list it", page.display())).collect()
    }
}

fn names_heading(anchor: &str, headings: &[String]) -> Outcome {
    if headings.iter().any(|heading| heading == anchor) {
        return Ok(());
    }
    let near = scenefile::nearest(anchor, headings.iter().map(String::as_str));
    let help = near.map(|near| format!("; did you mean #{near}?")).unwrap_or_default();
    Err(format!("names no heading there{help}"))
}

/// Whether a target is an address of its own.
pub fn is_elsewhere(target: &str) -> bool {
    ["https:", "http:", "mailto:"].iter().any(|scheme| target.starts_with(scheme))
}

/// The file, from the root, that `target` names on `page`; `None` where it leaves the root.
pub fn resolved(page: &Path, target: &str) -> Option<PathBuf> {
    let mut file = page.parent().unwrap_or(Path::new("")).to_owned();
    for part in Path::new(target).components() {
        match part {
            Component::ParentDir => {
                if !file.pop() {
                    return None;
                }
            }
            Component::Normal(name) => file.push(name),
            Component::CurDir => {}
            Component::RootDir | Component::Prefix(_) => return None,
        }
    }
    Some(file)
}

/// Bytes of the pictures in a folder and those below.
fn pictures(folder: &Path) -> Result<u64, String> {
    let error = |e: std::io::Error| format!("{}: {e}", folder.display());
    let mut sum = 0;
    for entry in std::fs::read_dir(folder).map_err(error)? {
        let path = entry.map_err(error)?.path();
        let ending = path.extension().and_then(|e| e.to_str()).unwrap_or_default();
        if path.is_dir() {
            sum += pictures(&path)?;
        } else if ["png", "jpg", "jpeg", "webp", "gif", "svg"].contains(&ending) {
            sum += path.metadata().map_err(error)?.len();
        }
    }
    Ok(sum)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wrong(page: &str) -> Vec<String> {
        let page = page.to_owned();
        let pages = BTreeMap::from([
            (PathBuf::from("docs/SUMMARY.md"), "[a](book/a.md)".to_owned()),
            (PathBuf::from("docs/book/a.md"), "# A\n\n## Two words\n".to_owned()),
            (PathBuf::from("docs/book/b.md"), page.clone()),
        ]);
        let root = crate::root();
        let repository = Repository { root: &root, pages };
        let follow = |link: &Link| repository.follow(Path::new("docs/book/b.md"), link).err();
        markdown::links(&page).iter().filter_map(follow).chain(repository.unlisted()).collect()
    }

    #[test]
    fn what_leads_nowhere_is_found() {
        let unlisted = "docs/book/b.md: docs/SUMMARY.md does not list it";
        assert_eq!(wrong("[x](https://example.org) [y](../../README.md) [z](#b)\n\n# B\n"), [unlisted]);
        assert_eq!(wrong("[x](nowhere.md)"), ["is not there", unlisted]);
        assert_eq!(wrong("[x](../../../../x)"), ["leaves the repository", unlisted]);
        assert_eq!(wrong("[x](#headin)\n\n# Heading\n")[0], "names no heading there; did you mean #heading?");
        assert_eq!(wrong(&format!("[x]({REPOSITORY}/blob/main/nowhere.rs)"))[0], "is not there");
        assert_eq!(wrong(&format!("[x]({REPOSITORY}/blob/main/Cargo.toml)")), [unlisted]);
        assert!(wrong("![](../SUMMARY.md)")[0].starts_with("says nothing"));
        assert!(wrong("![x](../../README.md)")[0].starts_with("lies outside of docs/"));
    }
}
