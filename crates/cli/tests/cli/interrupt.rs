//! Signals and failures in mid-render.
#![cfg(unix)]

use std::time::{Duration, Instant};

use crate::harness::{Place, size};

/// Ends with a line on the maps once signals are caught, then goes on for ever.
const FOREVER: [&str; 6] = ["render", "box.toml", "--passes", "4000000", "-o", "a.png"];

fn interrupted_by(signal: &str) {
    let place = Place::new();
    let mut started = place.start(&FOREVER);
    started.wait_for(" map:");
    started.signal(signal);
    let ran = started.end();
    assert_eq!(ran.code, Some(130), "{}", ran.err);
    assert_eq!(size(&place.path("a.png")), (16, 12));
    assert_eq!(place.files(), ["a.png", "box.toml"]);
    for said in ["interrupted:", "wrote a.png (16x12, ", "interrupted after ", " of 4000000 passes"] {
        assert!(ran.err.contains(said), "{said}: {}", ran.err);
    }
}

#[test]
fn the_first_interrupt_writes_the_picture() {
    interrupted_by("INT");
}

#[test]
fn so_does_termination() {
    interrupted_by("TERM");
}

#[test]
fn a_signal_that_comes_twice_is_one() {
    let place = Place::new();
    let mut started = place.start(&FOREVER);
    started.wait_for(" map:");
    started.signal("TERM");
    started.signal("TERM");
    let ran = started.end();
    assert_eq!(ran.code, Some(130), "{}", ran.err);
    assert_eq!(place.files(), ["a.png", "box.toml"]);
}

#[test]
fn the_second_interrupt_ends_at_once() {
    let place = Place::new();
    let slow = ["--integrator", "photon_map", "--size", "512x512", "--set", "photon_map.final_gather=4096"];
    let mut started = place.start(&[&FOREVER[..], &slow].concat());
    started.wait_for(" map:");
    started.signal("INT");
    started.wait_for("interrupted:");
    let start = Instant::now();
    started.signal_again("INT");
    let ran = started.end();
    assert_eq!(ran.code, Some(130), "{}", ran.err);
    assert!(start.elapsed() < Duration::from_secs(5), "{:?}", start.elapsed());
    assert_eq!(place.files(), ["box.toml"]);
}

#[test]
fn a_folder_that_goes_away_costs_one_output_not_the_others() {
    let place = Place::new();
    std::fs::create_dir(place.path("gone")).unwrap();
    let mut started = place.start(&[&FOREVER[..], &["-o", "gone/a.exr", "-o", "b.exr"]].concat());
    started.wait_for(" map:");
    std::fs::remove_dir(place.path("gone")).unwrap();
    started.signal("INT");
    let ran = started.end();
    assert_eq!(ran.code, Some(1), "{}", ran.err);
    assert!(ran.err.contains("cannot write gone/a.exr"), "{}", ran.err);
    assert_eq!(place.files(), ["a.png", "b.exr", "box.toml"]);
    assert_eq!(size(&place.path("b.exr")), (16, 12));
}
