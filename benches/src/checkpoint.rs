//! What saving a render takes.
#![allow(clippy::print_stdout)] // it reports

use std::time::Instant;

use nephroid::{Checkpoint, CheckpointInfo, write_checkpoint};

use crate::clock::{median, processor_s};
use crate::pairs::SCENE;
use crate::scenes::{self, Ready};

/// Measures and prints: into memory, and to a file of the system's temporary folder.
///
/// # Errors
/// Where the scene cannot be rendered or the file not be written.
pub fn run(quick: bool) -> Result<(), String> {
    let (passes, size, rounds) =
        if quick { (2, "film.size=[64, 64]", 3) } else { (16, "film.size=[1024, 1024]", 5) };
    let ready = Ready::new(SCENE, &["render.integrator=path", size])?;
    let mut session = ready.session(0..passes, 0)?;
    scenes::run(&mut session)?;
    let info = CheckpointInfo::new(&ready.desc)?;
    let film = session.into_film();
    let mut bytes = Vec::new();
    let mut spent = Vec::new();
    for _ in 0..rounds {
        bytes.clear();
        let (seconds, outcome) = processor_s(|| write_checkpoint(&mut bytes, &info, &film));
        outcome.map_err(|e| e.to_string())?;
        spent.push(seconds);
    }
    let file = std::env::temp_dir().join(format!("nephroid-bench-{}.checkpoint", std::process::id()));
    let checkpoint = Checkpoint { info, film };
    let start = Instant::now();
    checkpoint.write(&file).map_err(|e| e.to_string())?;
    let written = start.elapsed().as_secs_f64();
    let start = Instant::now();
    let read = Checkpoint::read(&file).map_err(|e| e.to_string());
    let reading = start.elapsed().as_secs_f64();
    std::fs::remove_file(&file).map_err(|e| format!("{}: {e}", file.display()))?;
    if read? != checkpoint {
        return Err("a checkpoint was read that is not the one that was written".into());
    }
    let seconds = median(&spent);
    println!(
        "checkpoint: {SCENE}, {size}, {passes} passes: {:.1} bytes a pixel; {:.0} MB/s of processor time ({:.1} ms for \
         a million pixels); by the wall clock {:.0} MB/s to a file and synced, {:.0} MB/s read",
        bytes.len() as f64 / ready.pixels(),
        bytes.len() as f64 / seconds * 1e-6,
        seconds / ready.pixels() * 1e9,
        bytes.len() as f64 / written * 1e-6,
        bytes.len() as f64 / reading * 1e-6,
    );
    Ok(())
}
