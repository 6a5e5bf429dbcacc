//! Material files (MTL): what each material says, by keyword.
//!
//! Facts: Wavefront, *MTL material format* 4.2 (1995); the keywords `Pr`, `Pm`, `Ps`, `Pc`, `Pcr`, `aniso`, `anisor`, `norm` are those of
//! the PBR extension by Exocortex.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use scenefile::{FileId, Span};

use super::map::{Map, parse_map};
use crate::report::Report;

/// A material as written.
#[derive(Clone, Debug)]
pub(super) struct Mtl {
    pub span: Span,
    /// Where its pictures are looked for, from the scene's folder.
    pub folder: PathBuf,
    /// Colours by keyword: `Kd`, `Ks`, `Ke`, `Tf`.
    pub colors: BTreeMap<&'static str, [f32; 3]>,
    /// Numbers by keyword.
    pub numbers: BTreeMap<&'static str, f32>,
    /// Pictures by keyword.
    pub maps: BTreeMap<&'static str, Map>,
}

impl Mtl {
    pub(super) fn color(&self, key: &str) -> Option<[f32; 3]> {
        self.colors.get(key).copied()
    }

    pub(super) fn number(&self, key: &str) -> Option<f32> {
        self.numbers.get(key).copied()
    }
}

const COLORS: &[&str] = &["Kd", "Ks", "Ke", "Tf"];
const NUMBERS: &[&str] = &["Ns", "Ni", "d", "Tr", "illum", "Pr", "Pm", "Ps", "Pc", "Pcr", "aniso", "anisor"];
const MAPS: &[(&str, &str)] = &[
    ("map_Kd", "map_Kd"),
    ("map_Ks", "map_Ks"),
    ("map_Ke", "map_Ke"),
    ("map_Ns", "map_Ns"),
    ("map_d", "map_d"),
    ("map_opacity", "map_d"),
    ("map_Pr", "map_Pr"),
    ("map_Pm", "map_Pm"),
    ("map_Ps", "map_Ps"),
    ("map_bump", "bump"),
    ("map_Bump", "bump"),
    ("bump", "bump"),
    ("norm", "norm"),
    ("map_Kn", "norm"),
];
/// What says nothing to a path tracer.
const QUIET: &[&str] = &["Ka", "map_Ka", "sharpness", "map_aat"];

/// The materials of a text by name.
pub(super) fn parse(text: &str, file: FileId, folder: &Path, report: &mut Report) -> BTreeMap<String, Mtl> {
    let mut all = BTreeMap::new();
    let mut open: Option<(String, Mtl)> = None;
    let mut start = 0;
    for raw in text.split_inclusive('\n') {
        let lead = raw.len() - raw.trim_start().len();
        let line = raw.split('#').next().unwrap_or_default().trim();
        let span = Span { file, start: start + lead, end: start + lead + line.len() };
        start += raw.len();
        let Some(keyword) = line.split_ascii_whitespace().next() else { continue };
        let rest = line[keyword.len()..].trim();
        if keyword == "newmtl" {
            let made = Mtl {
                span,
                folder: folder.to_path_buf(),
                colors: BTreeMap::new(),
                numbers: BTreeMap::new(),
                maps: BTreeMap::new(),
            };
            if let Some((name, done)) = open.replace((rest.to_owned(), made)) {
                all.entry(name).or_insert(done);
            }
            continue;
        }
        let Some((_, material)) = &mut open else {
            report.instead(format!("`{keyword}` before the first `newmtl`"), "it is left out", span);
            continue;
        };
        statement(material, keyword, rest, span, report);
    }
    if let Some((name, done)) = open {
        all.entry(name).or_insert(done);
    }
    all
}

fn statement(material: &mut Mtl, keyword: &str, rest: &str, span: Span, report: &mut Report) {
    let same = |known: &str| known.eq_ignore_ascii_case(keyword);
    if let Some(key) = COLORS.iter().find(|k| same(k)) {
        match color(rest) {
            Some(color) => {
                material.colors.insert(key, color);
            }
            None => report.instead(
                format!("`{keyword}` without a colour of three numbers"),
                "it is left out",
                span,
            ),
        }
    } else if let Some(key) = NUMBERS.iter().find(|k| same(k)) {
        // `d -halo 0.5` fades toward the border.
        let number = rest.strip_prefix("-halo").unwrap_or(rest).trim().parse::<f32>();
        match number {
            Ok(number) if number.is_finite() => {
                material.numbers.insert(key, number);
            }
            _ => report.instead(format!("`{keyword}` without a number"), "it is left out", span),
        }
    } else if let Some((_, key)) = MAPS.iter().find(|(k, _)| same(k)) {
        if let Some(map) = parse_map(rest, span, report) {
            material.maps.insert(key, map);
        }
    } else if !QUIET.iter().any(|k| same(k)) {
        report.instead(format!("`{keyword}` of a material is not rendered"), "it is left out", span);
    }
}

/// Three numbers, or one for all.
fn color(rest: &str) -> Option<[f32; 3]> {
    let numbers: Option<Vec<f32>> = rest.split_ascii_whitespace().map(|word| word.parse().ok()).collect();
    match numbers?[..] {
        [r, g, b] | [r, g, b, _] => Some([r, g, b]),
        [grey] => Some([grey; 3]),
        _ => None,
    }
    .filter(|rgb| rgb.iter().all(|x| x.is_finite()))
    .map(|rgb| rgb.map(|x| x.max(0.0)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn statements() {
        let text = "# c\nKd 1 1 1\nnewmtl a b\n  Kd 0.5 0.25 0 # c\nKS 1\n\tNs 10\nd -halo 0.5\nKe spectral x\nfoo 1\n\
                    newmtl c\r\nmap_kd -s 2 3 1 -o .5 a b.png\r\nnewmtl a b\nKd 0 0 0\n";
        let mut report = Report::default();
        let all = parse(text, FileId(0), Path::new("f"), &mut report);
        assert_eq!(all.keys().collect::<Vec<_>>(), ["a b", "c"]);
        let a = &all["a b"];
        assert_eq!((a.color("Kd"), a.color("Ks")), (Some([0.5, 0.25, 0.0]), Some([1.0; 3])));
        assert_eq!((a.number("Ns"), a.number("d"), a.color("Ke")), (Some(10.0), Some(0.5), None));
        let map = &all["c"].maps["map_Kd"];
        assert_eq!((map.file.as_str(), map.scale, map.offset), ("a b.png", [2.0, 3.0], [0.5, 0.0]));
        let said: Vec<String> = report.finish().into_iter().map(|d| d.message).collect();
        assert_eq!(said.len(), 3, "{said:?}");
    }
}
