//! What a render tells of itself on the way, and what ends it.

use expect_test::expect;
use serde_json::Value;

use crate::harness::{Place, masked, size};

#[test]
fn json_for_programs() {
    let place = Place::new();
    let render = ["box.toml", "--integrator", "path", "--passes", "9", "--progress", "json"];
    let ran = place.ok(&[&render[..], &["--preview-every", "1s", "-o", "a.png"]].concat());
    let objects: Vec<Value> = ran.err.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let of = |event: &str| objects.iter().filter(|o| o["event"] == event).collect::<Vec<_>>();
    let passes = of("pass");
    assert_eq!((&passes[0]["done"], &passes[0]["passes"]), (&1.into(), &9.into()));
    let last = passes[passes.len() - 1];
    assert_eq!((&last["done"], &last["share"]), (&9.into(), &1.0.into()));
    assert!(last["grain"].as_f64().unwrap() > 0.0 && last["elapsed_s"].is_number());
    assert_eq!(of("wrote")[0]["path"], "a.png");
    let end = of("end")[0];
    assert_eq!((&end["outcome"], &end["done"], &end["passes"]), (&"finished".into(), &9.into(), &9.into()));
    assert_eq!(objects.last(), Some(end));
    // Quietly, and without anything to say.
    for quiet in [&["--progress", "none"][..], &["-q"]] {
        let ran = place.ok(&[&["box.toml", "--passes", "1"][..], quiet].concat());
        assert_eq!(ran.err, "");
    }
}

#[test]
fn noise_ends_a_render_with_the_same_pass_however_it_was_cut() {
    let place = Place::new();
    let until = ["--integrator", "path", "--noise", "40%"];
    let render = |more: &[&str]| place.ok(&[&["box.toml"][..], &until, more].concat());
    let straight = render(&["-o", "a.exr"]).err;
    assert!(straight.contains("the grain is as fine as was asked for after "), "{straight}");
    // With a checkpoint that ended earlier.
    render(&["-o", "b.exr", "--passes", "9", "--checkpoint", "b.neph"]);
    place.ok(&["resume", "b.neph", "--passes", "+1"]);
    let resumed = place.ok(&["resume", "b.neph", "--noise", "40%"]).err;
    assert!(resumed.contains("the grain is as fine as was asked for after "), "{resumed}");
    assert_eq!(place.read("a.exr"), place.read("b.exr"));
    // Nothing is left, and it is not begun again.
    place.ok(&["resume", "b.neph", "--noise", "40%"]);
    assert_eq!(place.read("a.exr"), place.read("b.exr"));
    // Passes may come first, and the scene may ask for it.
    let ran = place.ok(&["box.toml", "--integrator", "path", "--noise", "0.1%", "--passes", "8"]);
    expect![[r#"
        pass 1/8 (12 %), _ s elapsed, _ s left
        pass 8/8 (100 %), grain _ % (to _ %), _ s elapsed
        wrote box.png (16x12, 8 passes)
        exposure _ EV, automatic
        all passes are done before the grain is as fine as was asked for (0.10 %)
        grain _ %: a first draft; clean (1.0 %) after about _ passes
    "#]]
    .assert_eq(&masked(&ran.err));
    let ran = place.ok(&["box.toml", "--integrator", "path", "--set", "render.noise=1", "--passes", "99"]);
    assert!(ran.err.contains("after 8 of 99 passes"), "{}", ran.err);
    let wrong = place.run(&["box.toml", "--noise", "2"]);
    assert!(wrong.code == Some(2) && wrong.err.contains("2%"), "{}", wrong.err);
}

#[test]
fn pictures_come_before_the_end() {
    let place = Place::new();
    let args = ["box.toml", "--passes", "4000000", "--preview-every", "1s", "-o", "a.png", "-o", "a.exr"];
    let mut started = place.start(&args);
    started.wait_for("pass 1/");
    let start = std::time::Instant::now();
    while !place.path("a.png").exists() {
        assert!(start.elapsed().as_secs() < 60);
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    assert_eq!(size(&place.path("a.png")), (16, 12));
    assert!(!place.path("a.exr").exists(), "linear pictures are written at the end only");
    started.signal("TERM");
    assert_eq!(started.end().code, Some(130));
    assert_eq!(place.files(), ["a.exr", "a.png", "box.toml"]);
}

#[test]
fn the_last_picture_is_the_whole() {
    let place = Place::new();
    place.ok(&["box.toml", "-q", "--passes", "40", "-o", "a.png"]);
    place.ok(&["box.toml", "-q", "--passes", "40", "-o", "b.png", "--preview-every", "0.001s"]);
    assert_eq!(place.read("a.png"), place.read("b.png"));
}
