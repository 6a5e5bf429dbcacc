//! What takes minutes: `cargo xtask long`.

use std::time::Duration;

use crate::harness::Place;
use crate::sessions::passes_of;

/// Killed at moments that have nothing to do with what it does, again and again; what a checkpoint held once is never
/// lost, none is ever damaged, and the picture in the end is that of a render that nobody disturbed.
#[test]
fn a_render_that_is_killed_again_and_again_loses_nothing_that_was_saved() {
    for integrator in ["path", "sppm"] {
        let place = Place::new();
        let size = ["--integrator", integrator, "--size", "200x150", "-q", "-o", "a.exr"];
        let begin = [&["render", "box.toml"][..], &size].concat();
        let save = ["--checkpoint", "a.neph", "--checkpoint-every", "0.02", "--passes", "1000000"];
        let go_on = ["resume", "a.neph", "-q", "--checkpoint-every", "0.02"];
        let mut moment = 1u64;
        let mut random = move |most: u64| {
            // Knuth's MMIX generator.
            moment = moment.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (moment >> 33) % most
        };
        let mut done = 0;
        for round in 0..40 {
            let fresh = !place.path("a.neph").exists();
            let started = place.start(&if fresh { [&begin[..], &save].concat() } else { go_on.to_vec() });
            std::thread::sleep(Duration::from_millis(20 + random(700)));
            let seen = if place.path("a.neph").exists() { passes_of(&place) } else { 0 };
            std::thread::sleep(Duration::from_millis(random(50)));
            started.signal("KILL");
            assert_eq!(started.end().code, None);
            let kept = if place.path("a.neph").exists() { passes_of(&place) } else { 0 };
            assert!(seen >= done && kept >= seen, "round {round}: {done}, {seen}, {kept}");
            done = kept;
        }
        assert!(done > 5, "it came to {done} passes");
        let total = (done + 1).to_string();
        place.ok(&["resume", "a.neph", "--passes", &total, "-q"]);
        let resumed = place.read("a.exr");
        assert_eq!(place.files(), ["a.exr", "a.neph", "box.toml"], "nothing else is left");
        place.ok(&[&begin[..], &["--passes", &total]].concat());
        assert!(place.read("a.exr") == resumed, "{integrator}");
    }
}
