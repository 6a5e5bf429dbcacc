//! What a second thread gives.
#![allow(clippy::print_stdout)] // it reports

use crate::pairs::SCENE;
use crate::report::HEAVY;
use crate::scenes::Ready;
use crate::table::{Row, Rows};

/// Measures and prints.
///
/// # Errors
/// Where a scene cannot be rendered.
pub fn run(rows: &mut Rows, quick: bool) -> Result<(), String> {
    println!(
        "threads: time on one over time on two, by the wall clock without what other programs took, medians"
    );
    let rounds = if quick { 3 } else { 7 };
    let path = Ready::new("arena/box.toml", &["render.integrator=path"])?;
    scaling("threads.path", &path, 8, rounds, rows)?;
    let small = if quick { "film.size=[64, 64]" } else { "film.size=[256, 256]" };
    let map = Ready::new(HEAVY, &[small])?;
    scaling("threads.photon_map", &map, 1, rounds, rows)?;
    for (name, passes) in [("sppm", 8), ("vcm", 4), ("auto", 8)] {
        let ready = Ready::new(SCENE, &[&format!("render.integrator={name}")])?;
        let passes = if quick { 1 } else { passes };
        scaling(&format!("threads.{name}"), &ready, passes, rounds, rows)?;
    }
    Ok(())
}

fn scaling(name: &str, ready: &Ready, passes: u64, rounds: usize, rows: &mut Rows) -> Result<(), String> {
    let [one, two] = ready.one_and_two(passes, rounds)?;
    let ratio = one.undisturbed_s / two.undisturbed_s;
    println!(
        "  {name}: {:.3} s on one thread, {:.3} s on two: {ratio:.2}x (with what others took: {:.3} s, {:.3} s)",
        one.undisturbed_s, two.undisturbed_s, one.elapsed_s, two.elapsed_s
    );
    rows.push(Row::new(name, ratio).figures(1.0 / two.undisturbed_s, 1.0 / one.undisturbed_s, "renders/s"));
    Ok(())
}
