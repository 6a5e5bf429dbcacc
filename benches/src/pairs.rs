//! The progressive integrators: pairs of a camera path and a light path in a second of processor time, and what the
//! default costs over path tracing.
#![allow(clippy::print_stdout)] // it reports

use nephroid::Phase;

use crate::clock::{median, processor_s};
use crate::scenes::{self, Ready};
use crate::table::{Row, Rows};

/// 256×256: 65 536 camera paths a pass, and by default as many light paths.
pub(crate) const SCENE: &str = "arena/box-spheres.toml";
/// Without caustics: nothing there for photons to find.
const PLAIN: &str = "arena/box.toml";

/// Measures and prints.
///
/// # Errors
/// Where a scene cannot be rendered.
pub fn pairs(rows: &mut Rows, quick: bool) -> Result<(), String> {
    let (passes, rounds) = if quick { (2, 3) } else { (8, 9) };
    println!(
        "pairs: {SCENE}, {passes} passes, medians of {rounds} rounds, one thread: photons, maps, eye passes, film"
    );
    for name in ["sppm", "vcm", "auto"] {
        let ready = Ready::new(SCENE, &[&format!("render.integrator={name}")])?;
        let camera_paths = ready.pixels() * passes as f64;
        let (mut speeds, mut shares) = (Vec::new(), [0.0; 3]);
        for round in 0..rounds {
            let mut session = ready.session(round * passes..(round + 1) * passes, 1)?;
            let (seconds, outcome) = processor_s(|| scenes::run(&mut session));
            outcome?;
            speeds.push(camera_paths / seconds * 1e-6);
            let phases = [Phase::Photons, Phase::MapBuild, Phase::EyePasses];
            let spent = phases.map(|phase| session.timings().get(phase).as_secs_f64());
            for (share, time) in shares.iter_mut().zip(spent) {
                *share += 100.0 * time / spent.iter().sum::<f64>() / rounds as f64;
            }
        }
        let light_paths = match name {
            "auto" => ready.photon_paths()?,
            _ => ready.pixels() as u64,
        };
        println!(
            "  {name}: {:.3} M a second; {light_paths} light paths a pass; photons {:.0} %, maps {:.0} %, eye {:.0} %",
            median(&speeds),
            shares[0],
            shares[1],
            shares[2]
        );
        rows.push(Row::new(format!("pairs.{name}"), median(&speeds)));
    }
    Ok(())
}

/// Measures and prints what the default takes beside path tracing, for as many passes.
///
/// # Errors
/// Where a scene cannot be rendered.
pub fn default_cost(rows: &mut Rows, quick: bool) -> Result<(), String> {
    let (passes, rounds) = if quick { (2, 3) } else { (16, 7) };
    println!("auto: processor time of path over that of auto, its pilot included, {passes} passes each");
    for (name, scene) in [("auto.box.vs_path", PLAIN), ("auto.box_spheres.vs_path", SCENE)] {
        let path = Ready::new(scene, &["render.integrator=path"])?;
        let auto = Ready::new(scene, &["render.integrator=auto"])?;
        let (mut of_path, mut of_auto, mut pilots) = (Vec::new(), Vec::new(), Vec::new());
        for round in 0..rounds {
            let range = || round * passes..(round + 1) * passes;
            let (seconds, outcome) = processor_s(|| scenes::run(&mut path.session(range(), 1)?));
            outcome?;
            of_path.push(seconds);
            let (pilot, session) = processor_s(|| auto.session(range(), 1));
            let mut session = session?;
            let (seconds, outcome) = processor_s(|| scenes::run(&mut session));
            outcome?;
            of_auto.push(pilot + seconds);
            pilots.push(pilot);
        }
        let (path_s, auto_s) = (median(&of_path), median(&of_auto));
        println!(
            "  {scene}: path {path_s:.3} s, auto {auto_s:.3} s, of which the pilot {:.4} s: {:.3}x",
            median(&pilots),
            path_s / auto_s
        );
        rows.push(Row::new(name, path_s / auto_s).figures(1.0 / auto_s, 1.0 / path_s, "renders/s"));
    }
    Ok(())
}
