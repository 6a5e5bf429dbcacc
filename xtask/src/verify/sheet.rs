//! A contact sheet: pictures side by side.

use std::fmt::Write as _;
use std::path::Path;

use color::ViewTransform;
use film::{RgbImage, encode_png_bytes};
use image::imageops::FilterType;

use crate::Outcome;

/// Pixels across a tile.
const TILE: u32 = 320;

/// Red, green and blue, row by row.
pub struct Tile {
    width: usize,
    pixels: Vec<[u8; 3]>,
}

impl Tile {
    /// Radiance as AgX shows it.
    pub fn of_radiance(width: usize, pixels: &[[f32; 3]]) -> Self {
        let shown = |p: &[f32; 3]| ViewTransform::Agx.apply(*p, 0.0).map(|x| (x * 255.0).round() as u8);
        Self::fitted(width, pixels.iter().map(shown).collect())
    }

    /// A picture file as it is.
    pub fn of_file(path: &Path) -> Result<Self, String> {
        let decoded = image::open(path).map_err(|e| format!("{}: {e}", path.display()))?.to_rgb8();
        Ok(Self::fitted(decoded.width() as usize, decoded.pixels().map(|p| p.0).collect()))
    }

    fn fitted(width: usize, pixels: Vec<[u8; 3]>) -> Self {
        let (w, h) = (width as u32, (pixels.len() / width) as u32);
        let Some(image) = image::RgbImage::from_raw(w, h, pixels.into_flattened()) else {
            return Self { width: 0, pixels: Vec::new() };
        };
        let height = (u64::from(h) * u64::from(TILE) / u64::from(w.max(1))).max(1) as u32;
        let fitted = image::imageops::resize(&image, TILE, height, FilterType::Triangle);
        Self { width: TILE as usize, pixels: fitted.pixels().map(|p| p.0).collect() }
    }

    fn height(&self) -> usize {
        self.pixels.len() / self.width.max(1)
    }
}

/// A line of the sheet.
pub struct Row {
    /// What it shows and how well.
    pub caption: String,
    /// Ours, then the reference.
    pub tiles: Vec<Tile>,
}

/// Writes `sheet.png` with all rows and `index.html` with the captions to a folder.
pub fn write(rows: &[Row], folder: &Path) -> Outcome {
    let columns = rows.iter().map(|row| row.tiles.len()).max().unwrap_or(0).max(1);
    let width = columns * TILE as usize;
    let mut sheet: Vec<[u8; 3]> = Vec::new();
    let mut html = String::from("<!doctype html><meta charset=\"utf-8\"><title>Verified scenes</title>\n");
    for (i, row) in rows.iter().enumerate() {
        let height = row.tiles.iter().map(Tile::height).max().unwrap_or(0);
        let first = sheet.len();
        sheet.resize(first + width * height, [24; 3]);
        for (column, tile) in row.tiles.iter().enumerate() {
            for (y, line) in tile.pixels.chunks(tile.width.max(1)).enumerate() {
                let at = first + y * width + column * TILE as usize;
                sheet[at..at + line.len()].copy_from_slice(line);
            }
        }
        let file = format!("{i:02}.png");
        save(&folder.join(&file), width, &sheet[first..])?;
        let _ = writeln!(html, "<p>{}<br><img src=\"{file}\">", escaped(&row.caption));
    }
    save(&folder.join("sheet.png"), width, &sheet)?;
    let page = folder.join("index.html");
    std::fs::write(&page, html).map_err(|e| format!("{}: {e}", page.display()))
}

fn save(path: &Path, width: usize, pixels: &[[u8; 3]]) -> Outcome {
    let wrong = |e: String| format!("{}: {e}", path.display());
    let png = encode_png_bytes(width, pixels.len() / width, pixels, &[]).map_err(|e| wrong(e.to_string()))?;
    std::fs::write(path, png).map_err(|e| wrong(e.to_string()))
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;")
}

/// Reads an EXR.
pub fn radiance(path: &Path) -> Result<RgbImage, String> {
    RgbImage::read(path).map_err(|e| e.to_string())
}
