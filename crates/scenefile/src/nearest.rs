//! The known name that a misspelt one most likely meant.

/// What other programs call our keys.
const SYNONYMS: &[(&str, &[&str])] = &[
    ("albedo", &["color", "diffuse"]),
    ("reflectance", &["color"]),
    ("kd", &["diffuse", "color"]),
    ("ks", &["specular"]),
    ("shininess", &["exponent"]),
    ("eta", &["ior", "n"]),
    ("index", &["ior"]),
    ("type", &["kind", "shape"]),
    ("kind", &["shape"]),
    ("shape", &["kind"]),
    ("spp", &["passes"]),
    ("samples", &["passes"]),
    ("resolution", &["size"]),
    ("width", &["size"]),
    ("height", &["size"]),
    ("eye", &["position"]),
    ("from", &["position"]),
    ("to", &["target", "look_at"]),
    ("target", &["look_at"]),
    ("aperture", &["lens_radius"]),
    ("emission", &["radiance"]),
    ("emit", &["radiance"]),
    ("path_tracer", &["path"]),
    ("pathtracer", &["path"]),
    ("filename", &["file"]),
    ("path", &["file"]),
    ("glass", &["dielectric"]),
    ("metal", &["conductor"]),
    ("lambertian", &["diffuse"]),
    ("cube", &["box"]),
    ("rectangle", &["quad"]),
];

/// Optimal-string-alignment distance: insertions, deletions, substitutions, swaps of neighbours.
fn distance(a: &[char], b: &[char]) -> usize {
    let mut before = vec![0; b.len() + 1];
    let mut last: Vec<usize> = (0..=b.len()).collect();
    let mut row = vec![0; b.len() + 1];
    for i in 1..=a.len() {
        row[0] = i;
        for j in 1..=b.len() {
            let same = usize::from(a[i - 1] != b[j - 1]);
            let mut d = (last[j] + 1).min(row[j - 1] + 1).min(last[j - 1] + same);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                d = d.min(before[j - 2] + 1);
            }
            row[j] = d;
        }
        (before, last, row) = (last, row, before);
    }
    last[b.len()]
}

/// Letters in lower case, `-` and ` ` as `_`.
fn folded(name: &str) -> Vec<char> {
    name.chars().flat_map(char::to_lowercase).map(|c| if c == '-' || c == ' ' { '_' } else { c }).collect()
}

/// The candidate that differs from `name` by the fewest edits, a third of its length at most; the first of equals.
/// Failing that, one that other programs call `name`.
pub fn nearest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    const LONGEST: usize = 64;
    let wanted = folded(name.get(..name.len().min(4 * LONGEST)).unwrap_or_default());
    if wanted.is_empty() || wanted.len() > LONGEST {
        return None;
    }
    let synonyms =
        SYNONYMS.iter().find(|(other, _)| folded(other) == wanted).map_or(&[][..], |(_, ours)| *ours);
    let mut best: Option<(usize, &str)> = None;
    // The rank of the best synonym so far, and the candidate.
    let mut synonym: Option<(usize, &str)> = None;
    for candidate in candidates {
        if let Some(rank) = synonyms.iter().position(|ours| *ours == candidate)
            && synonym.is_none_or(|(least, _)| rank < least)
        {
            synonym = Some((rank, candidate));
        }
        // Before anything is allocated: there may be very many candidates.
        let length = candidate.chars().take(LONGEST + 1).count();
        let longer = length.max(wanted.len());
        let allowed = (longer / 3).max(1);
        if length.abs_diff(wanted.len()) > allowed || longer > LONGEST {
            continue;
        }
        let letters = folded(candidate);
        let d = distance(&wanted, &letters);
        // A single letter says nothing about another.
        if d <= allowed && d < longer && best.is_none_or(|(least, _)| d < least) {
            best = Some((d, candidate));
        }
    }
    best.or(synonym).map(|(_, candidate)| candidate)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_what_was_meant() {
        let keys = ["color", "roughness", "metal", "n", "k", "ior"];
        for (typed, meant) in [
            ("colour", Some("color")),
            ("COLOR", Some("color")),
            ("roughnes", Some("roughness")),
            ("roguhness", Some("roughness")),
            ("metla", Some("metal")),
            ("albedo", Some("color")),
            ("eta", Some("ior")),
            ("x", None),
            ("", None),
            ("something_else", None),
        ] {
            assert_eq!(nearest(typed, keys), meant, "{typed}");
        }
        assert_eq!(nearest(&"ö".repeat(1000), keys), None);
    }

    #[test]
    fn counts_edits() {
        let d = |a: &str, b: &str| distance(&folded(a), &folded(b));
        assert_eq!([d("abc", "abc"), d("abc", "acb"), d("kitten", "sitting"), d("", "ab")], [0, 1, 3, 2]);
    }
}
