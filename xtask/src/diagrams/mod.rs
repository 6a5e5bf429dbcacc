//! `cargo xtask diagrams`: the drawings of the book, docs/book/diagrams/*.svg, from the equations that they show.

mod aiming;
mod kernels;
mod optics;
mod plot;
mod priorities;
mod radius;
mod svg;
mod two_passes;
mod weights;

use std::path::PathBuf;

use svg::Canvas;

use crate::{Outcome, root};

/// Name of the file without its ending, and the drawing.
type Diagram = (&'static str, fn() -> Canvas);

const DIAGRAMS: &[Diagram] = &[
    ("two-passes", two_passes::draw),
    ("kernels", kernels::draw),
    ("aiming", aiming::draw),
    ("radius", radius::draw),
    ("weights", weights::draw),
    ("priorities", priorities::draw),
];

fn folder() -> PathBuf {
    root().join("docs/book/diagrams")
}

/// Writes the drawings; with `--check` only says whether they are current.
pub fn run(arguments: &[String]) -> Outcome {
    match arguments {
        [] => {
            let folder = folder();
            std::fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
            for (name, draw) in DIAGRAMS {
                let path = folder.join(name).with_extension("svg");
                std::fs::write(&path, draw().finish()).map_err(|e| format!("{}: {e}", path.display()))?;
            }
            Ok(())
        }
        [flag] if flag == "--check" => check(),
        _ => Err("usage: cargo xtask diagrams [--check]".into()),
    }
}

fn check() -> Outcome {
    for (name, draw) in DIAGRAMS {
        let path = folder().join(name).with_extension("svg");
        let text = std::fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
        if text != draw().finish() {
            return Err(format!("{} is old: run `cargo xtask diagrams`", path.display()));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_drawings_are_current() {
        assert_eq!(check(), Ok(()));
    }

    #[test]
    fn labels_stand_apart_and_inside() {
        for (name, draw) in DIAGRAMS {
            assert_eq!(draw().collisions(), Vec::<String>::new(), "{name}");
        }
    }
}
