//! `nephroid compare`.

use std::path::Path;

use nephroid::{
    Comparison, RgbImage, check_writable, compare, difference, encode_png_bytes, write_atomically,
};
use serde_json::json;

use crate::args::CompareArgs;
use crate::failure::{Failure, OK, Outcome};
use crate::say::print;

/// Compares pictures with a reference, one line each.
pub fn run(args: &CompareArgs) -> Outcome {
    let (pictures, reference, mask) = read_all(args)?;
    let mut out = String::new();
    for (path, image) in &pictures {
        let figures = compare(image, &reference, mask.as_deref())
            .map_err(|e| Failure::usage(format!("{}: {e}", path.display())))?;
        out += &if args.json { json_line(path, &figures) } else { line(path, &figures) };
        out.push('\n');
    }
    if let (Some(path), Some((_, image))) = (&args.diff, pictures.last()) {
        let sheet = difference(image, &reference).map_err(Failure::usage)?;
        let png =
            encode_png_bytes(3 * image.width(), image.height(), &sheet, &[]).map_err(Failure::runtime)?;
        write_atomically(path, &png).map_err(Failure::runtime)?;
    }
    print(&out)?;
    Ok(OK)
}

/// All pictures, the reference, and which of its pixels count.
type Pictures<'a> = (Vec<(&'a Path, RgbImage)>, RgbImage, Option<Vec<bool>>);

/// Reads all that is named; everything that is wrong is said.
fn read_all(args: &CompareArgs) -> Result<Pictures<'_>, Failure> {
    let mut wrong = Vec::new();
    let mut read = |path: &Path| RgbImage::read(path).map_err(|e| wrong.push(e.to_string())).ok();
    let reference = read(&args.reference);
    let images: Vec<_> = args.images.iter().map(|path| (path.as_path(), read(path))).collect();
    let mask = args.mask.as_deref().map_or(Some(None), |path| read(path).map(Some));
    if let Some(path) = &args.diff {
        wrong.extend(refused_difference(path));
    }
    let (Some(reference), Some(mask), true) = (reference, mask, wrong.is_empty()) else {
        return Err(Failure::Usage(wrong));
    };
    let size = |i: &RgbImage| (i.width(), i.height());
    let mask = match mask {
        Some(mask) if size(&mask) != size(&reference) => {
            let (w, h) = size(&mask);
            let (rw, rh) = size(&reference);
            return Err(Failure::usage(format!("the mask is {w}x{h} pixels, the reference {rw}x{rh}")));
        }
        Some(mask) => Some(mask.pixels().iter().map(|[r, g, b]| r + g + b > 1.5).collect()),
        None => None,
    };
    let images = images.into_iter().filter_map(|(path, image)| Some((path, image?))).collect();
    Ok((images, reference, mask))
}

/// Why a difference cannot be written.
fn refused_difference(path: &Path) -> Option<String> {
    if !path.extension().is_some_and(|e| e.eq_ignore_ascii_case("png")) {
        return Some(format!("cannot write {}: the difference is a .png", path.display()));
    }
    check_writable(path).err().map(|e| format!("{e}\n  = help: {}", e.help()))
}

/// Names and values, in the order of print.
fn figures(c: &Comparison) -> [(&'static str, Option<f64>); 7] {
    [
        ("relmse", Some(c.relmse)),
        ("relmse999", Some(c.relmse999)),
        ("bias", Some(c.bias)),
        ("block_median", c.block_median),
        ("block_max", c.block_max),
        ("nonfinite", Some(c.nonfinite as f64)),
        ("flip", Some(c.flip)),
    ]
}

fn line(path: &Path, c: &Comparison) -> String {
    let text = |value: Option<f64>| value.map_or("none".to_owned(), short);
    let parts = figures(c).map(|(name, value)| format!("{name} {}", text(value)));
    format!("{}: {}", path.display(), parts.join("  "))
}

/// Five figures.
fn short(value: f64) -> String {
    if value == 0.0 || !value.is_finite() || !(1e-4..1e6).contains(&value.abs()) {
        return if value == 0.0 { "0".into() } else { format!("{value:.4e}") };
    }
    let digits = (4 - value.abs().log10().floor() as i32).max(0) as usize;
    let text = format!("{value:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

fn json_line(path: &Path, c: &Comparison) -> String {
    let mut object = serde_json::Map::new();
    object.insert("image".into(), path.display().to_string().into());
    for (name, value) in figures(c) {
        let value = if name == "nonfinite" { json!(c.nonfinite) } else { json!(value) };
        object.insert(name.into(), value);
    }
    serde_json::Value::Object(object).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_are_short() {
        let said = [0.0, 1.0, -0.0123456, 0.00012344, 1234.5678, 123456.0, 1e-7, 2.5e9, f64::NAN].map(short);
        assert_eq!(
            said,
            ["0", "1", "-0.012346", "0.00012344", "1234.6", "123456", "1.0000e-7", "2.5000e9", "NaN"]
        );
    }
}
