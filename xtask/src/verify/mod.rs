//! `cargo xtask verify`: scenes of other programs, rendered and held against pictures that came with them.

mod blocks;
mod list;
mod sheet;

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::pictures::build;
use crate::{Outcome, root};
use blocks::{agreement, shrunk};
use list::{CASES, Case, Reference};
use sheet::{Row, Tile, radiance};

/// Where things are, and how much is rendered.
struct Options {
    scenes: PathBuf,
    out: PathBuf,
    passes: Option<u32>,
    only: Vec<String>,
}

/// Renders every scene that has a picture, or those whose names contain one of the arguments; prints how far each is from its
/// reference and writes a contact sheet. An error where a scene does not render or lies beyond its bar.
pub fn run(arguments: &[String]) -> Outcome {
    let options = options(arguments)?;
    let nephroid = build()?;
    std::fs::create_dir_all(&options.out).map_err(|e| format!("{}: {e}", options.out.display()))?;
    println!("{:<66} {:>7} {:>7} {:>9}", "scene", "median", "spread", "relMSE");
    let wanted = |case: &&Case| {
        options.only.is_empty() || options.only.iter().any(|name| case.scene.contains(name.as_str()))
    };
    let (mut rows, mut failed) = (Vec::new(), Vec::new());
    for (i, case) in CASES.iter().enumerate().filter(|(_, case)| wanted(case)) {
        match verify(&nephroid, case, i, &options) {
            Ok((row, within)) => {
                println!("{}", row.caption);
                if !within {
                    failed.push(case.scene.to_owned());
                }
                rows.push(row);
            }
            Err(why) => {
                println!("{:<66} {why}", case.scene);
                failed.push(case.scene.to_owned());
            }
        }
    }
    sheet::write(&rows, &options.out)?;
    println!(
        "{} of {} scenes; the sheet is {}",
        rows.len(),
        CASES.len(),
        options.out.join("sheet.png").display()
    );
    if failed.is_empty() { Ok(()) } else { Err(format!("not as they should be: {}", failed.join(", "))) }
}

fn options(arguments: &[String]) -> Result<Options, String> {
    let target = root().join("target/verify");
    let mut options =
        Options { scenes: root().join("../shared/scenes"), out: target, passes: None, only: Vec::new() };
    let mut rest = arguments.iter();
    while let Some(argument) = rest.next() {
        let mut value = || rest.next().ok_or_else(|| format!("{argument} wants a value"));
        match argument.as_str() {
            "--scenes" => options.scenes = value()?.into(),
            "--out" => options.out = value()?.into(),
            "--passes" => {
                let n = value()?;
                options.passes = Some(n.parse().map_err(|_| format!("`{n}` is no number of passes"))?);
            }
            name if !name.starts_with('-') => options.only.push(name.to_owned()),
            other => return Err(format!("there is no option {other}")),
        }
    }
    match options.scenes.is_dir() {
        true => Ok(options),
        false => {
            Err(format!("{} is no folder; --scenes says where the scenes are", options.scenes.display()))
        }
    }
}

/// The row of a case, and whether it is as it should be.
fn verify(nephroid: &Path, case: &Case, index: usize, options: &Options) -> Result<(Row, bool), String> {
    let picture = |ending: &str| options.out.join(format!("{index:02}-render.{ending}"));
    let mut command = Command::new(nephroid);
    command.arg("render").arg(options.scenes.join(case.scene)).arg("--quiet");
    command.arg("-o").arg(picture("exr")).arg("-o").arg(picture("png"));
    command.args(["--passes", &options.passes.unwrap_or(case.passes).to_string()]);
    if let Some(depth) = case.max_depth {
        command.args(["--max-depth", &depth.to_string()]);
    }
    let mut reference = None;
    match &case.reference {
        Reference::Radiance { file, shrink, bar } => {
            let whole = radiance(&options.scenes.join(file))?;
            let (width, pixels) = shrunk(whole.width(), whole.pixels(), *shrink);
            command.args(["--size", &format!("{width}x{}", pixels.len() / width)]);
            reference = Some((width, pixels, *bar));
        }
        Reference::Screenshot(_) => {
            command.args(["--width", "320"]);
        }
    }
    let output = command.output().map_err(|e| format!("{}: {e}", nephroid.display()))?;
    if !output.status.success() {
        let text = String::from_utf8_lossy(&output.stderr);
        return Err(text
            .lines()
            .find(|line| line.starts_with("error"))
            .unwrap_or("it does not render")
            .into());
    }
    let Some((width, theirs, bar)) = reference else {
        let mut tiles = vec![Tile::of_file(&picture("png"))?];
        if let Reference::Screenshot(file) = case.reference
            && !file.is_empty()
        {
            tiles.push(Tile::of_file(&options.scenes.join(file))?);
        }
        return Ok((Row { caption: case.scene.to_owned(), tiles }, true));
    };
    let ours = radiance(&picture("exr"))?;
    let found = agreement(width, ours.pixels(), &theirs).ok_or("the reference is black")?;
    let within = (found.median - 1.0).abs() <= bar;
    let caption = format!(
        "{:<66} {:>7.4} {:>7.4} {:>9.5}{}",
        case.scene,
        found.median,
        found.spread,
        found.rel_mse,
        if within { "" } else { "  BEYOND ITS BAR" }
    );
    let tiles = vec![Tile::of_radiance(width, ours.pixels()), Tile::of_radiance(width, &theirs)];
    Ok((Row { caption, tiles }, within))
}
