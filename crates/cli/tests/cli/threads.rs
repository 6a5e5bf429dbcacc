//! The same bytes on any number of threads.

use crate::harness::Place;

fn same_bytes(integrator: &str, more: &[&str]) {
    let place = Place::new();
    let render = |threads: &str| {
        let name = format!("{threads}.exr");
        let mut args = vec!["render", "box.toml", "-q", "--integrator", integrator, "--size", "37x29"];
        args.extend(["--threads", threads, "-o", &name]);
        args.extend(more);
        place.ok(&args);
        place.read(&name)
    };
    let one = render("1");
    assert!(one.len() > 37 * 29);
    for threads in ["2", "3", "7"] {
        assert!(render(threads) == one, "{integrator} on {threads} threads differs");
    }
}

#[test]
fn photon_maps_with_final_gather() {
    same_bytes(
        "photon_map",
        &["--set", "photon_map.photons=20000", "--set", "photon_map.caustic_photons=20000"],
    );
}

#[test]
fn photon_maps_looked_up_directly() {
    same_bytes("photon_map", &["--set", "photon_map.final_gather=0"]);
}

#[test]
fn paths() {
    same_bytes("path", &["--passes", "4"]);
}
