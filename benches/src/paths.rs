//! Path tracing against Mitsuba 3: the same box, samples, depth and roulette, in alternating rounds.
#![allow(clippy::print_stdout)] // it reports

use crate::clock::{median, processor_s};
use crate::mitsuba::{Mitsuba, Request};
use crate::scenes::{self, Ready};
use crate::table::{Row, Rows};

const SCENE: &str = "arena/box.toml";
/// Scattering events of the measured paths, at most.
const DEPTH: u32 = 6;
/// Scattering events before the roulette of `path` begins: the peer is set to the same.
const ROULETTE: u32 = 3;
/// The means of the pictures agree to this: the same work is done.
const AGREE: f64 = 0.01;

/// Measures and prints.
///
/// # Errors
/// Where the peer renders another picture, or something breaks.
pub fn run(rows: &mut Rows, quick: bool) -> Result<(), String> {
    let (spp, rounds) = if quick { (16, 3) } else { (64, 5) };
    println!(
        "paths: {SCENE}, {spp} samples a pixel, medians of {rounds} rounds, millions a second of processor time"
    );
    for (variant, name) in [("scalar_rgb", "scalar"), ("llvm_ad_rgb", "llvm")] {
        let first = Request { spp, depth: Some(DEPTH), roulette: ROULETTE, seed: 0 };
        match Mitsuba::start(&scenes::path(SCENE), variant, first) {
            Ok(mut peer) => {
                let (ours, theirs) = compare(&mut peer, variant, first, rounds)?;
                let name = format!("paths.box.vs_mitsuba_{name}");
                rows.push(Row::new(name, ours / theirs).figures(ours, theirs, "M paths/s"));
                let endless = Request { depth: None, ..first };
                peer.render(endless)?; // its kernel is compiled
                compare(&mut peer, variant, endless, rounds.min(3))?;
            }
            Err(why) => println!("  Mitsuba ({variant}) skipped: {why}"),
        }
    }
    Ok(())
}

/// Millions of paths in a second of processor time: ours, theirs.
fn compare(peer: &mut Mitsuba, variant: &str, first: Request, rounds: u64) -> Result<(f64, f64), String> {
    let ready = Ready::new(SCENE, &["render.integrator=path"])?;
    let ready = Ready { desc: with_depth(ready.desc, first.depth), ..ready };
    let [width, height] = ready.scene.resolution();
    let paths = f64::from(width) * f64::from(height) * first.spp as f64 * 1e-6;
    let (mut ours, mut theirs) = (Vec::new(), Vec::new());
    let mut means = [[0.0; 3]; 2];
    for round in 0..rounds {
        let mut session = ready.session(round * first.spp..(round + 1) * first.spp, 1)?;
        let (seconds, pixels) = processor_s(|| scenes::run(&mut session).map(|()| session.film().beauty()));
        ours.push(paths / seconds);
        for pixel in pixels? {
            for (mean, value) in means[0].iter_mut().zip(pixel) {
                *mean += f64::from(value) / (f64::from(width) * f64::from(height) * rounds as f64);
            }
        }
        let (seconds, mean) = peer.render(Request { seed: round + 1, ..first })?;
        theirs.push(paths / seconds);
        for (sum, value) in means[1].iter_mut().zip(mean) {
            *sum += value / rounds as f64;
        }
    }
    let (ours, theirs) = (median(&ours), median(&theirs));
    let depth = first.depth.map_or("any depth".to_owned(), |d| format!("{d} events"));
    println!(
        "  {depth}: ours {ours:.3}, Mitsuba {} {variant} {theirs:.3}: {:.2}x",
        peer.version,
        ours / theirs
    );
    for (a, b) in means[0].iter().zip(&means[1]) {
        if (a - b).abs() > AGREE * b {
            return Err(format!("the pictures differ: means {:?} and {:?}", means[0], means[1]));
        }
    }
    Ok((ours, theirs))
}

fn with_depth(mut desc: nephroid::SceneDesc, depth: Option<u32>) -> nephroid::SceneDesc {
    desc.render.max_depth = depth;
    desc
}
