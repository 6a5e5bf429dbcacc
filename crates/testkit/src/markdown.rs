//! Markdown as the tests of the documentation read it: code blocks, links and anchors.

use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};

/// A fenced code block.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Block {
    /// The first word behind the opening fence; empty where there is none.
    pub language: String,
    /// What stands between the fences, with the line feeds.
    pub text: String,
    /// The line of the opening fence, counted from 1.
    pub line: usize,
}

/// A link or an image.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Link {
    /// Where it leads, without a title.
    pub target: String,
    /// The text of a link; of an image what is read out in its place.
    pub text: String,
    /// The byte of the page at which the target begins.
    pub at: usize,
    /// The line on which the target begins, counted from 1.
    pub line: usize,
    /// Whether the page shows the target instead of leading to it.
    pub is_image: bool,
}

/// All Markdown files below `root`, as paths from there, sorted; folders of builds and of Git are left out.
///
/// # Errors
/// Where a folder cannot be read.
pub fn files(root: &Path) -> io::Result<Vec<PathBuf>> {
    let mut found = Vec::new();
    let mut folders = vec![PathBuf::new()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(root.join(&folder))? {
            let entry = entry?;
            let path = folder.join(entry.file_name());
            let name = entry.file_name();
            let name = name.to_string_lossy();
            if entry.file_type()?.is_dir() {
                let is_built = ["target", "out", "artifacts", "corpus"].contains(&&*name);
                if !is_built && (!name.starts_with('.') || name == ".github") {
                    folders.push(path);
                }
            } else if name.ends_with(".md") {
                found.push(path);
            }
        }
    }
    found.sort();
    Ok(found)
}

/// All Markdown files below `root` with their texts, in the order of [`files`]; paths from there.
///
/// # Errors
/// Where a folder or a file cannot be read, with its path.
pub fn pages(root: &Path) -> Result<BTreeMap<PathBuf, String>, String> {
    let error = |path: &Path, e: io::Error| format!("{}: {e}", path.display());
    let read = |page: PathBuf| {
        let text = std::fs::read_to_string(root.join(&page)).map_err(|e| error(&page, e))?;
        Ok((page, text))
    };
    files(root).map_err(|e| error(root, e))?.into_iter().map(read).collect()
}

/// The mark that opens a fence on this line: three or more of ` or ~.
fn fence(line: &str) -> Option<&str> {
    let line = line.trim_start();
    let mark = line.chars().next().filter(|c| ['`', '~'].contains(c))?;
    let length = line.len() - line.trim_start_matches(mark).len();
    (length >= 3).then(|| &line[..length])
}

/// The fenced code blocks of a page, in order.
pub fn blocks(page: &str) -> Vec<Block> {
    let mut found = Vec::new();
    let mut open: Option<(&str, Block)> = None;
    for (number, line) in page.lines().enumerate() {
        match &mut open {
            Some((mark, _)) if line.trim() == *mark => found.extend(open.take().map(|(_, block)| block)),
            Some((_, block)) => {
                block.text.push_str(line);
                block.text.push('\n');
            }
            None => {
                let Some(mark) = fence(line) else { continue };
                let info = line.trim_start()[mark.len()..].split([' ', ',']).next().unwrap_or_default();
                let block = Block { language: info.to_owned(), text: String::new(), line: number + 1 };
                open = Some((mark, block));
            }
        }
    }
    found.extend(open.map(|(_, block)| block));
    found
}

/// The page with blanks in place of code, byte for byte: fenced blocks, and spans between backticks. Line feeds stay.
fn prose(page: &str) -> String {
    let mut bytes = page.as_bytes().to_vec();
    let mut start = 0;
    let mut open: Option<&str> = None;
    for line in page.split_inclusive('\n') {
        let is_code = open.is_some();
        match open {
            Some(mark) if line.trim() == mark => open = None,
            Some(_) => {}
            None => open = fence(line),
        }
        if is_code || open.is_some() {
            blank(&mut bytes[start..start + line.len()]);
        }
        start += line.len();
    }
    let mut from = 0;
    while let Some(at) = bytes[from..].iter().position(|&b| b == b'`').map(|i| from + i) {
        let length = bytes[at..].iter().take_while(|&&b| b == b'`').count();
        // A span ends at as many backticks, within its paragraph.
        let paragraph = bytes[at..].windows(2).position(|w| w == b"\n\n").map_or(bytes.len(), |i| at + i);
        let mut end = None;
        let mut i = at + length;
        while i < paragraph && end.is_none() {
            let run = bytes[i..paragraph].iter().take_while(|&&b| b == b'`').count();
            end = (run == length).then_some(i + run);
            i += run.max(1);
        }
        if let Some(end) = end {
            blank(&mut bytes[at..end]);
        }
        from = end.unwrap_or(at + length);
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

fn blank(bytes: &mut [u8]) {
    for byte in bytes.iter_mut().filter(|byte| **byte != b'\n') {
        *byte = b' ';
    }
}

/// The links and images of a page, in order: `[text](target)`, `![text](target)`, and `src` and `href` of HTML.
pub fn links(page: &str) -> Vec<Link> {
    let prose = prose(page);
    let line = |at: usize| 1 + prose[..at].matches('\n').count();
    let mut found = Vec::new();
    for (at, _) in prose.match_indices("](") {
        let Some(length) = closing(&prose[at + 2..]) else { continue };
        let inside = &prose[at + 2..at + 2 + length];
        let target = inside.split_whitespace().next().unwrap_or_default();
        let target = target.trim_start_matches('<').trim_end_matches('>');
        let start = at + 2 + inside.find(target).unwrap_or_default();
        let Some(open) = opening(&prose[..at]) else { continue };
        let is_image = prose[..open].ends_with('!');
        let text = page.get(open + 1..at).unwrap_or_default();
        found.push(Link { target: target.into(), text: text.into(), at: start, line: line(start), is_image });
    }
    for (key, is_image) in [(" src=\"", true), (" href=\"", false)] {
        for (at, _) in prose.match_indices(key) {
            let rest = &prose[at + key.len()..];
            let Some(end) = rest.find('"') else { continue };
            // The text is the tag's, which tells what an image shows by `alt`.
            let tag = &prose[prose[..at].rfind('<').unwrap_or(at)..];
            let tag = &tag[..tag.find('>').unwrap_or(tag.len())];
            let shown = tag.split(" alt=\"").nth(1).and_then(|rest| rest.split('"').next());
            let text = if is_image { shown.unwrap_or_default() } else { tag };
            let start = at + key.len();
            let target = rest[..end].into();
            found.push(Link { target, text: text.into(), at: start, line: line(start), is_image });
        }
    }
    found.sort_by_key(|link| link.at);
    found
}

/// Bytes before the parenthesis that closes the one before `text`.
fn closing(text: &str) -> Option<usize> {
    let mut depth = 1;
    text.char_indices().find_map(|(i, c)| {
        depth += match c {
            '(' => 1,
            ')' => -1,
            _ => 0,
        };
        (depth == 0).then_some(i)
    })
}

/// The byte at which the bracket opens that closes behind `text`.
fn opening(text: &str) -> Option<usize> {
    let mut depth = 1;
    text.char_indices().rev().find_map(|(i, c)| {
        depth += match c {
            ']' => 1,
            '[' => -1,
            _ => 0,
        };
        (depth == 0).then_some(i)
    })
}

/// The anchors of a page: one for each heading, made as GitHub makes them, and the ids of HTML.
pub fn anchors(page: &str) -> Vec<String> {
    let prose = prose(page);
    let mut found: Vec<String> = Vec::new();
    for (line, shown) in page.lines().zip(prose.lines()) {
        let level = shown.len() - shown.trim_start_matches('#').len();
        if (1..=6).contains(&level) && shown[level..].starts_with(' ') {
            let slug = slug(&line[level..]);
            let twins = found.iter().filter(|known| is_twin(known, &slug)).count();
            found.push(if twins == 0 { slug } else { format!("{slug}-{twins}") });
        }
    }
    for (at, key) in prose.match_indices(" id=\"") {
        found.extend(prose[at + key.len()..].split('"').next().map(str::to_owned));
    }
    found
}

fn is_twin(known: &str, slug: &str) -> bool {
    let number = known.strip_prefix(slug).and_then(|rest| rest.strip_prefix('-'));
    known == slug || number.is_some_and(|n| n.parse::<u32>().is_ok())
}

fn slug(heading: &str) -> String {
    let mut text = String::new();
    let mut rest = heading.trim();
    // Of a link only the text is shown.
    while let Some(at) = rest.find("](") {
        text.push_str(&rest[..at]);
        rest = rest[at + 2..].split_once(')').map_or("", |(_, behind)| behind);
    }
    text.push_str(rest);
    let letter = |c: char| match c {
        ' ' => Some('-'),
        _ => (c.is_alphanumeric() || c == '-' || c == '_').then_some(c),
    };
    text.to_lowercase().chars().filter_map(letter).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAGE: &str = "# One `two`: three\n\nSee [a\nb](x.md#y \"title\") and `[no](no.md)`.\n\n```sh\n[no](no.md)\n# no\n```\n\
        \n## What [it](z.md) does\n![alt](p.png)\n~~~toml\na = 1\n~~~\n<img src=\"q.jpg\" alt=\"q\">\n## One two three\n";

    #[test]
    fn blocks_have_languages_and_lines() {
        let blocks = blocks(PAGE);
        let seen: Vec<_> = blocks.iter().map(|b| (b.language.as_str(), b.text.as_str(), b.line)).collect();
        assert_eq!(seen, [("sh", "[no](no.md)\n# no\n", 6), ("toml", "a = 1\n", 13)]);
    }

    #[test]
    fn links_are_those_outside_of_code() {
        let links = links(PAGE);
        assert!(links.iter().all(|link| PAGE[link.at..].starts_with(&link.target)));
        let seen: Vec<_> =
            links.iter().map(|l| (l.target.as_str(), l.text.as_str(), l.line, l.is_image)).collect();
        assert_eq!(
            seen,
            [
                ("x.md#y", "a\nb", 4, false),
                ("z.md", "it", 11, false),
                ("p.png", "alt", 12, true),
                ("q.jpg", "q", 16, true)
            ]
        );
    }

    #[test]
    fn anchors_are_those_of_headings() {
        assert_eq!(anchors(PAGE), ["one-two-three", "what-it-does", "one-two-three-1"]);
    }

    #[test]
    fn a_span_that_is_not_closed_is_no_code() {
        assert_eq!(links("a ` b [c](d.md)\n\n` e\n").len(), 1);
    }
}
