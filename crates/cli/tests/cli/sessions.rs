//! Renders that end by time, are saved, go on, and are put together.

use std::path::Path;

use expect_test::expect;

use crate::harness::{Place, Ran, masked, size};

/// A quick one.
const PATH: [&str; 4] = ["render", "box.toml", "--integrator", "path"];

fn with<'a>(first: &[&'a str], more: &[&'a str]) -> Vec<&'a str> {
    [first, more].concat()
}

fn refused(place: &Place, args: &[&str]) -> Ran {
    let before = place.files();
    let ran = place.run(args);
    assert_eq!(ran.code, Some(2), "{args:?}: {}{}", ran.out, ran.err);
    assert_eq!(place.files(), before, "{args:?}");
    assert!(!ran.err.lines().any(|l| l.starts_with("pass ")), "{args:?} began to render: {}", ran.err);
    ran
}

#[test]
fn straight_resumed_and_merged_pictures_have_the_same_bytes() {
    let place = Place::new();
    place.ok(&with(&PATH, &["--passes", "6", "-q", "-o", "straight.exr"]));
    let straight = place.read("straight.exr");

    place.ok(&with(&PATH, &["--passes", "2", "-q", "-o", "resumed.exr", "--checkpoint", "a.neph"]));
    assert_ne!(place.read("resumed.exr"), straight);
    place.ok(&["resume", "a.neph", "--passes", "+1", "-q", "--threads", "3"]);
    place.ok(&["resume", "a.neph", "--passes", "6", "-q", "--threads", "1"]);
    assert!(place.read("resumed.exr") == straight, "the picture asked for first is written again");

    for (range, name) in [("4..6", "b.neph"), ("0..1", "c.neph"), ("1..4", "d.neph")] {
        place.ok(&with(&PATH, &["--pass-range", range, "-q", "-o", "part.exr", "--checkpoint", name]));
    }
    place.ok(&["merge", "b.neph", "c.neph", "d.neph", "-o", "merged.exr", "-o", "merged.png", "-q"]);
    assert!(place.read("merged.exr") == straight);
    assert_eq!(size(&place.path("merged.png")), (16, 12));
    let ran = place.ok(&["merge", "b.neph", "c.neph", "-o", "two.neph"]);
    assert!(ran.err.contains("3 passes of 2 files; passes 1..4 are not among them"), "{}", ran.err);
    place.ok(&["merge", "d.neph", "two.neph", "-o", "all.exr", "-q"]);
    assert!(place.read("all.exr") == straight);
}

#[test]
fn what_is_said_of_a_checkpoint() {
    let place = Place::new();
    let ran = place.ok(&with(&PATH, &["--checkpoint", "a.neph"]));
    expect![[r#"
        pass 1/2 (50 %), _ s elapsed, _ s left
        pass 2/2 (100 %), grain _ %, _ s elapsed
        saved a.neph (2 passes, _ KiB)
        wrote box.png (16x12, 2 passes)
        exposure _ EV, automatic
        grain _ %: a first draft; clean (1.0 %) after about _ passes
    "#]]
    .assert_eq(&masked(&ran.err));
    assert_eq!(place.files(), ["a.neph", "box.png", "box.toml"]);
    let ran = place.ok(&["resume", "a.neph", "--passes", "+2", "-o", "b.exr"]);
    expect![[r#"
        going on with a.neph: 2 of 4 passes are done
        pass 3/4 (75 %), grain _ %, _ s elapsed, _ s left
        pass 4/4 (100 %), grain _ %, _ s elapsed
        saved a.neph (4 passes, _ KiB)
        wrote b.exr (16x12, 4 passes)
        grain _ %: a first draft; clean (1.0 %) after about _ passes
    "#]]
    .assert_eq(&masked(&ran.err));
    let out = place.ok(&["info", "a.neph"]).out;
    let lines: Vec<&str> =
        out.lines().filter(|l| !l.starts_with("scene") && !l.starts_with("to write")).collect();
    expect![[r#"
        checkpoint  a.neph, _ KiB, undamaged
        picture     16x12, blackman-harris filter, automatic exposure, view agx-punchy
        integrator  path, 2 passes, seed 0, depth 4
        holds       4 passes: passes 0..4
        asked for   passes 0..4
        took        _ s
        grain       _ %: a first draft; clean (1.0 %) after about _ passes"#]]
    .assert_eq(masked(&lines.join("\n")).trim_end());
    let ran = place.ok(&["resume", "a.neph"]);
    assert!(ran.err.contains("nothing is left to render") && ran.err.contains("b.exr"), "{}", ran.err);
    assert!(refused(&place, &["render", "a.neph"]).err.contains("nephroid resume a.neph"));
}

#[test]
fn time_ends_a_render() {
    let place = Place::new();
    let ran = place.ok(&with(&PATH, &["--time", "0.2s", "-o", "a.exr", "--checkpoint", "a.neph"]));
    assert!(ran.err.contains("the time is up after ") && ran.err.contains(" s left\n"), "{}", ran.err);
    assert!(refused(&place, &["resume", "a.neph"]).err.contains("--time or --passes"));
    let ran = place.ok(&["resume", "a.neph", "--time", "0.1"]);
    assert!(ran.err.contains("going on with a.neph: ") && ran.err.contains("the time is up"), "{}", ran.err);
    // One pass at least; and passes that end before the time.
    let ran = place.ok(&with(&PATH, &["--time", "0.000001", "-o", "b.exr"]));
    assert!(ran.err.contains("wrote b.exr (16x12, 1 pass)"), "{}", ran.err);
    let ran = place.ok(&with(&PATH, &["--time", "1h", "--passes", "3", "-o", "b.exr"]));
    assert!(
        ran.err.contains("wrote b.exr (16x12, 3 passes)") && !ran.err.contains("time is up"),
        "{}",
        ran.err
    );
}

#[test]
fn what_makes_no_sense_is_refused() {
    let place = Place::new();
    let said = |more: &[&str], parts: &[&str]| {
        let err = refused(&place, &with(&PATH, more)).err;
        assert!(parts.iter().all(|part| err.contains(part)), "{more:?}: {err}");
    };
    said(&["--time", "0"], &["more than 0"]);
    said(&["--time", "soon"], &["5m"]);
    said(&["--pass-range", "5..5"], &["empty"]);
    said(&["--pass-range", "9..5"], &["reversed"]);
    said(&["--pass-range", "0..4", "--passes", "4"], &["--passes"]);
    said(&["--checkpoint", "a.exr"], &["another kind of file", ".neph"]);
    said(&["--checkpoint", "no/a.neph"], &["no", "does not exist"]);
    said(&["--checkpoint", "."], &["folder"]);
    said(&["--checkpoint-every", "5"], &["--checkpoint"]);
    said(&["--checkpoint", "box.toml"], &["box.toml"]);
    place.write("a.neph", "mine");
    said(&["--checkpoint", "a.neph", "-o", "b.jpg"], &["there is such a file already", "b.jpg"]);
    assert_eq!(place.read("a.neph"), b"mine");
    for args in [["resume", "a.neph"], ["resume", "none.neph"], ["resume", "box.toml"]] {
        assert!(refused(&place, &args).err.contains("cannot read"), "{args:?}");
    }
    assert!(refused(&place, &["merge", "a.neph", "-o", "b.exr"]).err.contains("no checkpoint"));
    assert!(refused(&place, &["merge", "a.neph", "-o", "a.neph"]).err.contains("already"));
    refused(&place, &["merge", "a.neph"]);
}

#[test]
fn what_cannot_be_merged_is_refused_by_name() {
    let place = Place::new();
    let part = |range: &str, name: &str, more: &[&str]| {
        place.ok(&with(&with(&PATH, &["--pass-range", range, "-q", "--checkpoint", name]), more));
    };
    part("0..4", "a.neph", &[]);
    part("3..6", "overlap.neph", &[]);
    part("4..6", "seed.neph", &["--seed", "9"]);
    part("4..6", "size.neph", &["--size", "5x5"]);
    part("4..6", "depth.neph", &["--max-depth", "7"]);
    let said = |other: &str| {
        let err = refused(&place, &["merge", "a.neph", other, "-o", "m.exr"]).err;
        assert!(err.contains("a.neph") && err.contains(other), "{err}");
        err
    };
    assert!(said("overlap.neph").contains("both hold pass 3"));
    assert!(said("seed.neph").contains("render.seed: 0, 9"));
    assert!(said("size.neph").contains("film.size: [16, 12], [5, 5]"));
    assert!(said("depth.neph").contains("render.max_depth: 4, 7"));
    let mut bytes = place.read("a.neph");
    let middle = bytes.len() / 2;
    bytes[middle] ^= 8;
    std::fs::write(place.path("bad.neph"), &bytes).unwrap();
    assert!(refused(&place, &["merge", "bad.neph", "-o", "m.exr"]).err.contains("damaged"));
    assert!(refused(&place, &["info", "bad.neph"]).err.contains("damaged"));
    assert!(refused(&place, &["resume", "bad.neph", "--passes", "+1"]).err.contains("damaged"));
    std::fs::write(place.path("cut.neph"), &bytes[..middle]).unwrap();
    assert!(refused(&place, &["merge", "cut.neph", "-o", "m.exr"]).err.contains("cut off"));
}

/// What the checkpoint a.neph holds.
#[cfg(unix)]
pub fn passes_of(place: &Place) -> u64 {
    let out = place.ok(&["info", "a.neph"]).out;
    let line = out.lines().find(|l| l.starts_with("holds")).unwrap();
    line.split_whitespace().nth(1).unwrap().parse().unwrap()
}

#[cfg(unix)]
mod unix {
    use super::*;
    use std::process::Stdio;

    /// Goes on for ever and is saved all the time.
    const FOREVER: [&str; 9] = [
        "--time",
        "1000h",
        "-o",
        "a.exr",
        "--checkpoint",
        "a.neph",
        "--checkpoint-every",
        "0.01",
        "--passes",
    ];

    fn forever() -> Vec<&'static str> {
        with(&with(&PATH, &FOREVER), &["4000000"])
    }

    fn wait_for(path: &Path) {
        while !path.exists() {
            std::thread::sleep(std::time::Duration::from_millis(5));
        }
    }

    #[test]
    fn an_interrupted_render_goes_on_where_it_was() {
        let place = Place::new();
        let started = place.start(&forever());
        wait_for(&place.path("a.neph"));
        started.signal("TERM");
        let ran = started.end();
        assert_eq!(ran.code, Some(130), "{}", ran.err);
        assert!(ran.err.contains("`nephroid resume a.neph` goes on"), "{}", ran.err);
        assert_eq!(place.files(), ["a.exr", "a.neph", "box.toml"]);
        let said = format!("{} of 4000000 passes", passes_of(&place));
        assert!(ran.err.contains(&said), "{said}: {}", ran.err);
    }

    #[test]
    fn a_killed_render_goes_on_from_its_last_checkpoint() {
        let place = Place::new();
        let started = place.start(&forever());
        wait_for(&place.path("a.neph"));
        started.signal("KILL");
        assert_eq!(started.end().code, None);
        let done = passes_of(&place);
        let total = (done + 2).to_string();
        place.ok(&["resume", "a.neph", "--passes", "+2", "-q", "-o", "b.exr"]);
        place.ok(&with(&PATH, &["--passes", &total, "-q", "-o", "c.exr"]));
        assert!(place.read("b.exr") == place.read("c.exr"));
    }

    #[test]
    fn two_renders_do_not_share_a_checkpoint() {
        let place = Place::new();
        let started = place.start(&forever());
        wait_for(&place.path("a.neph"));
        assert!(place.run(&["resume", "a.neph", "--passes", "+1"]).err.contains("another render writes it"));
        started.signal("INT");
        started.end();
        place.ok(&["resume", "a.neph", "--passes", "+1", "-q"]);
    }

    #[test]
    fn a_second_interrupt_while_writing_leaves_nothing_half_written() {
        let place = Place::new();
        // Large pictures, of which the first is written for a while.
        let args = ["--size", "1200x1200", "--max-depth", "1", "--passes", "10"];
        let outputs = ["-o", "a.exr", "-o", "b.exr", "-o", "c.exr", "--checkpoint", "d.neph"];
        let mut started = place.start(&with(&with(&PATH, &args), &outputs));
        started.wait_for("pass 1/10");
        started.signal("INT");
        started.wait_for("saved d.neph");
        let part = || place.files().iter().any(|name| name.ends_with(".part"));
        started.signal_again("INT");
        assert_eq!(started.end().code, Some(130));
        assert!(!part(), "{:?}", place.files());
        for name in place.files().iter().filter(|name| name.ends_with(".exr")) {
            assert_eq!(size(&place.path(name)), (1200, 1200), "{name}");
        }
        place.ok(&["info", "d.neph"]);
    }

    /// Runs under a limit on the size of files, of blocks of 512 or 1024 bytes.
    fn limited(place: &Place, blocks: u32, args: &[&str]) -> Ran {
        let program = env!("CARGO_BIN_EXE_nephroid");
        let script = format!("trap '' XFSZ; ulimit -f {blocks} && exec {program} \"$@\"");
        let mut command = std::process::Command::new("sh");
        command.args(["-c", &script, "sh"]).args(args).current_dir(place.path("")).stdin(Stdio::null());
        let output = command.output().unwrap();
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
        Ran { code: output.status.code(), out: text(output.stdout), err: text(output.stderr) }
    }

    #[test]
    fn what_a_disk_does_not_take_is_told_and_the_rest_is_kept() {
        let place = Place::new();
        let args =
            with(&PATH, &["--size", "128x128", "-o", "a.exr", "-o", "a.png", "--checkpoint", "a.neph"]);
        let ran = limited(&place, 64, &args);
        assert_eq!(ran.code, Some(1), "{}", ran.err);
        for said in ["cannot write a.neph", "cannot write a.exr", "ulimit", "wrote a.png (128x128, 2 passes)"]
        {
            assert!(ran.err.contains(said), "{said}: {}", ran.err);
        }
        assert_eq!(place.files(), ["a.png", "box.toml"]);
    }

    #[test]
    fn a_checkpoint_that_fails_leaves_the_older_one_and_the_render() {
        let place = Place::new();
        std::fs::create_dir(place.path("home")).unwrap();
        let args =
            ["--time", "1000h", "-o", "a.exr", "--checkpoint", "home/a.neph", "--checkpoint-every", "0.01"];
        let mut started = place.start(&with(&PATH, &args));
        wait_for(&place.path("home/a.neph"));
        // In one step: a checkpoint may be under way in it.
        std::fs::rename(place.path("home"), place.path("gone")).unwrap();
        started.wait_for("warning: cannot write home/a.neph");
        started.signal("INT");
        let ran = started.end();
        assert_eq!(ran.code, Some(1), "{}", ran.err);
        assert!(ran.err.contains("wrote a.exr") && ran.err.contains("is still there"), "{}", ran.err);
    }
}
