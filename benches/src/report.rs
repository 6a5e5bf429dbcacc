//! The report's heavy setting end to end.
#![allow(clippy::print_stdout)] // it reports

use std::time::{Duration, Instant};

use nephroid::Phase;

use crate::clock::processor_s;
use crate::scenes::{self, Ready};

/// The report's figure 2.1, right: 300 k + 600 k photons, 500 and 80 neighbours, 512×512.
pub(crate) const HEAVY: &str = "report/photons-high.toml";

/// Measures and prints.
///
/// # Errors
/// Where a scene cannot be rendered.
pub fn run(quick: bool) -> Result<(), String> {
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
