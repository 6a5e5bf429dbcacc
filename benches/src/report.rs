//! The report's heavy setting end to end, and what a second thread gives.
#![allow(clippy::print_stdout)] // it reports

use std::time::{Duration, Instant};

use nephroid::Phase;

use crate::clock::processor_s;
use crate::scenes::{self, Ready};
use crate::table::{Row, Rows};

/// The report's figure 2.1, right: 300 k + 600 k photons, 500 and 80 neighbours, 512×512.
const HEAVY: &str = "report/photons-high.toml";

/// Measures and prints.
///
/// # Errors
/// Where a scene cannot be rendered.
pub fn run(rows: &mut Rows, quick: bool) -> Result<(), String> {
    heavy(quick)?;
    println!(
        "threads: time on one over time on two, by the wall clock without what other programs took, medians"
    );
    let rounds = if quick { 3 } else { 7 };
    let path = Ready::new("arena/box.toml", &["render.integrator=path"])?;
    scaling("threads.path", &path, 8, rounds, rows)?;
    let small = if quick { "film.size=[64, 64]" } else { "film.size=[256, 256]" };
    let map = Ready::new(HEAVY, &[small])?;
    scaling("threads.photon_map", &map, 1, rounds, rows)
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

/// All that `nephroid render` does but the writing.
fn heavy(quick: bool) -> Result<(), String> {
    let change: &[&str] = if quick { &["film.size=[128, 128]"] } else { &[] };
    let start = Instant::now();
    let (processor, done) = processor_s(|| -> Result<_, String> {
        let ready = Ready::new(HEAVY, change)?;
        let mut session = ready.session(0..u64::from(ready.desc.render.passes), 0)?;
        scenes::run(&mut session)?;
        Ok((ready, session))
    });
    let (elapsed, (ready, session)) = (start.elapsed(), done?);
    let [width, height] = ready.scene.resolution();
    println!(
        "report: {HEAVY}, {width}x{height}, {} passes: {:.2} s by the wall clock on {} threads, \
         {processor:.2} s of processor time",
        session.done(),
        elapsed.as_secs_f64(),
        session.threads(),
    );
    let mut rest = elapsed;
    for phase in [Phase::Photons, Phase::MapBuild, Phase::EyePasses] {
        let spent = session.timings().get(phase);
        rest = rest.saturating_sub(spent);
        line(phase.name(), spent, elapsed);
    }
    line("load and compile", rest, elapsed);
    Ok(())
}

fn line(name: &str, spent: Duration, all: Duration) {
    let share = 100.0 * spent.as_secs_f64() / all.as_secs_f64();
    println!("  {name:<18} {:>8.3} s {share:>5.1} %", spent.as_secs_f64());
}
