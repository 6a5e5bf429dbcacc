//! What the photons of a pass take: as their maps tell, and as the system sees a process that renders one pass.
#![allow(clippy::print_stdout)] // it reports

use std::fs;
use std::process::Command;

use nephroid::{Control, Event};

use crate::pairs::SCENE;
use crate::scenes::Ready;
use crate::table::{Row, Rows};

/// First argument of this program where it is the process whose memory is looked at; the integrator and the number of
/// light paths follow.
pub const PROBE: &str = "--memory-of";
/// Bytes that a vertex of vertex connection and merging may take beyond the photon.
const VERTEX_BYTES: f64 = 64.0;
/// A small picture, so that photons are what there is.
const SIZE: &str = "film.size=[64, 64]";

/// Photons of one pass.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Stored {
    photons: usize,
    bytes: usize,
}

/// Measures and prints.
///
/// # Errors
/// Where the scene cannot be rendered or this program not be started again.
pub fn run(rows: &mut Rows, quick: bool) -> Result<(), String> {
    println!("memory: {SCENE}, one pass");
    let few: u64 = if quick { 50_000 } else { 500_000 };
    let mut bytes_each = Vec::new();
    for name in ["sppm", "vcm"] {
        let (a, peak_a) = probe(name, few)?;
        let (b, peak_b) = probe(name, 3 * few)?;
        let each = b.bytes as f64 / b.photons as f64;
        bytes_each.push(each);
        let grown = b.photons as f64 - a.photons as f64;
        let peak = match (peak_a, peak_b) {
            (Some(a), Some(b)) => format!("{:.1} MB", (b as f64 - a as f64) / grown),
            _ => "unknown".into(),
        };
        println!(
            "  {name}: {each:.1} MB per million photons of a map; {peak} while they are traced and sorted; \
             {:.2} photons a light path",
            b.photons as f64 / (3 * few) as f64
        );
    }
    let auto = photons_of(&Ready::new(SCENE, &["render.integrator=auto"])?)?;
    println!("  auto: {:.1} MB per million photons of a map", auto.bytes as f64 / auto.photons as f64);
    if let [photon, vertex] = bytes_each[..] {
        println!("  a vertex of vcm: {:.1} bytes beyond the photon", vertex - photon);
        let row = Row::new("memory.vcm.vs_64_bytes", VERTEX_BYTES / (vertex - photon));
        rows.push(row.figures(vertex - photon, VERTEX_BYTES, "bytes"));
    }
    Ok(())
}

/// One pass; what its maps say.
fn photons_of(ready: &Ready) -> Result<Stored, String> {
    let mut stored = Stored { photons: 0, bytes: 0 };
    let mut session = ready.session(0..1, 1)?;
    let outcome = session.run(&mut |event| {
        if let Event::MapsReady { reports, .. } = event {
            for report in reports {
                stored.photons += report.photons;
                stored.bytes += report.bytes;
            }
        }
        Control::Continue
    });
    outcome.map_err(|e| e.to_string())?;
    if stored.photons == 0 { Err(format!("{SCENE}: no photon landed")) } else { Ok(stored) }
}

/// What the process that was started with [`PROBE`] does: renders, and prints photons, bytes and the most memory in
/// bytes that the process had, if the system tells.
///
/// # Errors
/// Where the scene cannot be rendered.
pub fn be_probed(arguments: &[String]) -> Result<(), String> {
    let [name, paths] = arguments else {
        return Err("an integrator and a number of paths are needed".into());
    };
    let count = match name.as_str() {
        "vcm" => format!("vcm.light_paths={paths}"),
        _ => format!("sppm.photons={paths}"),
    };
    let ready = Ready::new(SCENE, &[&format!("render.integrator={name}"), SIZE, &count])?;
    let stored = photons_of(&ready)?;
    let peak = peak_bytes().map_or_else(|| "unknown".into(), |bytes| bytes.to_string());
    println!("{} {} {peak}", stored.photons, stored.bytes);
    Ok(())
}

fn probe(name: &str, paths: u64) -> Result<(Stored, Option<u64>), String> {
    let program = std::env::current_exe().map_err(|e| e.to_string())?;
    let output = Command::new(program)
        .args([PROBE, name, &paths.to_string()])
        .output()
        .map_err(|e| format!("this program does not start again: {e}"))?;
    let text = String::from_utf8_lossy(&output.stdout);
    answer(&text).ok_or_else(|| format!("{name}: no answer: {}", String::from_utf8_lossy(&output.stderr)))
}

fn answer(text: &str) -> Option<(Stored, Option<u64>)> {
    let mut words = text.split_whitespace();
    let stored = Stored { photons: words.next()?.parse().ok()?, bytes: words.next()?.parse().ok()? };
    Some((stored, words.next()?.parse().ok()))
}

/// The most memory that this process has had; Linux tells.
fn peak_bytes() -> Option<u64> {
    let text = fs::read_to_string("/proc/self/status").ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    line.split_whitespace().next()?.parse::<u64>().ok().map(|kib| kib * 1024)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn answers_are_read() {
        let stored = Stored { photons: 3, bytes: 120 };
        assert_eq!(answer("3 120 4096\n"), Some((stored, Some(4096))));
        assert_eq!(answer("3 120 unknown\n"), Some((stored, None)));
        assert_eq!(answer(""), None);
    }

    #[test]
    fn a_process_has_had_memory() {
        if cfg!(target_os = "linux") {
            assert!(peak_bytes().unwrap() > 100_000);
        }
    }
}
