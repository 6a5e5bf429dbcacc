//! Layers on request: what they hold, and that they add up.

use film::{ExrOptions, Film, encode_exr};
use nephroid::desc::{
    DirectLight, Emission, IntegratorKind, Layers, Light, LightKind, Material, PointAmount,
};
use nephroid::{Control, Job, SceneDesc, Session, compile, load};

use crate::support::root;

const BOTH: Layers = Layers { techniques: true, lights: true };

/// The box with a second light of another group.
fn desc(integrator: IntegratorKind) -> SceneDesc {
    let mut desc = load(&root().join("scenes/arena/box-spheres.toml"), &[]).desc.unwrap();
    desc.film.size = [24, 18];
    desc.film.layers = BOTH;
    desc.render.integrator = integrator;
    desc.photon_map.photons = 3000;
    desc.photon_map.caustic_photons = 3000;
    let position = [1.5, 4.0, 1.5];
    let amount = PointAmount::Power { watts: 100.0, color: [1.0, 0.6, 0.3] };
    let bulb = Light { light_group: Some("bulbs".into()), ..LightKind::Point { position, amount }.into() };
    desc.lights.push(bulb.into());
    desc
}

fn render(desc: &SceneDesc, passes: u64, threads: usize) -> Film {
    let scene = compile(desc, threads).unwrap().scene;
    let job = Job { passes: 0..passes, ..Job::new(desc, scene).unwrap() };
    let mut session = Session::new(job, threads).unwrap();
    session.run(&mut |_| Control::Continue).unwrap();
    session.into_film()
}

const KINDS: [IntegratorKind; 5] = [
    IntegratorKind::Path,
    IntegratorKind::PhotonMap,
    IntegratorKind::Sppm,
    IntegratorKind::Vcm,
    IntegratorKind::Auto,
];

/// Each integrator, and settings of it that find light in other ways.
fn descs() -> Vec<SceneDesc> {
    let mut all = KINDS.map(desc).to_vec();
    let mut without_gather = desc(IntegratorKind::PhotonMap);
    without_gather.photon_map.final_gather = 0;
    let mut by_photons = desc(IntegratorKind::Sppm);
    by_photons.sppm.direct = DirectLight::Photons;
    all.extend([without_gather, by_photons]);
    all
}

/// The layers whose names begin so, summed pixel by pixel.
fn sum(film: &Film, prefix: &str) -> Vec<[f64; 3]> {
    let mut sum = vec![[0.0; 3]; film.width() * film.height()];
    for (i, name) in film.layer_names().iter().enumerate() {
        if name.starts_with(prefix) {
            for (s, v) in sum.iter_mut().zip(film.named_layer(i).unwrap()) {
                s.iter_mut().zip(v).for_each(|(s, v)| *s += f64::from(v));
            }
        }
    }
    sum
}

fn mean(pixels: impl IntoIterator<Item = [f32; 3]>) -> f64 {
    let all: Vec<f64> = pixels.into_iter().map(|p| p.iter().map(|v| f64::from(*v)).sum()).collect();
    all.iter().sum::<f64>() / all.len() as f64
}

fn layer_mean(film: &Film, name: &str) -> f64 {
    let index = film.layer_names().iter().position(|n| n == name);
    mean(film.named_layer(index.unwrap_or_else(|| panic!("{name}: {:?}", film.layer_names()))).unwrap())
}

#[test]
fn layers_of_either_kind_add_up_to_the_picture() {
    for desc in descs() {
        let film = render(&desc, 2, 2);
        let name = desc.render.integrator.name();
        let beauty = film.beauty();
        let brightest = beauty.iter().flatten().fold(0.0f32, |a, b| a.max(*b));
        for prefix in ["technique-", "light-"] {
            for (i, (sum, beauty)) in sum(&film, prefix).iter().zip(&beauty).enumerate() {
                for (s, b) in sum.iter().zip(beauty) {
                    // Rounding of f32 sums within a pass.
                    let most = 4e-6 * f64::from(b.abs().max(1e-3 * brightest));
                    assert!((s - f64::from(*b)).abs() <= most, "{name} {prefix} pixel {i}: {s} for {b}");
                }
            }
        }
        // Layers change nothing else.
        let plain = render(&with_layers(&desc, Layers::default()), 2, 2);
        assert!(plain.layer_names().is_empty());
        assert!(plain.beauty() == beauty, "{name}");
    }
}

fn with_layers(desc: &SceneDesc, layers: Layers) -> SceneDesc {
    let mut desc = desc.clone();
    desc.film.layers = layers;
    desc
}

#[test]
fn each_technique_finds_something_and_names_are_as_documented() {
    let names = |film: &Film| film.layer_names().join(" ");
    let path = render(&desc(IntegratorKind::Path), 1, 1);
    assert_eq!(names(&path), "technique-emission technique-direct light-lamp light-bulbs");
    let mapped = render(&desc(IntegratorKind::PhotonMap), 1, 1);
    let expected = "technique-emission technique-direct technique-merge light-lamp light-bulbs light-other";
    assert_eq!(names(&mapped), expected);
    let vcm = render(&desc(IntegratorKind::Vcm), 2, 2);
    for technique in ["emission", "direct", "merge", "connect", "project"] {
        let part = layer_mean(&vcm, &format!("technique-{technique}")) / mean(vcm.beauty());
        assert!(part > 1e-3, "{technique}: {part}");
    }
    let lights = Layers { lights: true, ..Layers::default() };
    assert_eq!(
        names(&render(&with_layers(&desc(IntegratorKind::Path), lights), 1, 1)),
        "light-lamp light-bulbs"
    );
}

/// Mean and its standard error.
fn with_error(values: &[f64]) -> [f64; 2] {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (n - 1.0);
    [mean, (variance / n).sqrt()]
}

/// Standard errors between two means.
fn apart([a, ea]: [f64; 2], [b, eb]: [f64; 2]) -> f64 {
    (a - b).abs() / ea.hypot(eb)
}

/// Over some seeds, the layer of a group and renders with the lights of that group alone.
#[test]
fn a_group_s_layer_is_the_picture_with_its_lights_alone() {
    for kind in KINDS {
        let mut means: [Vec<f64>; 5] = Default::default();
        for seed in 0..16 {
            let mut both = desc(kind);
            both.render.seed = seed;
            both.photon_map.final_gather = 0;
            both.film.layers.techniques = false;
            let film = render(&both, 2, 2);
            let mut lamp = with_layers(&both, Layers::default());
            lamp.render.seed += 100;
            let mut bulbs = lamp.clone();
            lamp.lights.clear();
            for object in &mut bulbs.objects {
                let shone = object.value.emission.take().is_some();
                if shone && object.value.material.is_none() {
                    object.value.material = Some(Material::diffuse(0.0).into());
                }
            }
            let found = [
                layer_mean(&film, "light-lamp"),
                mean(render(&lamp, 2, 2).beauty()),
                layer_mean(&film, "light-bulbs"),
                mean(render(&bulbs, 2, 2).beauty()),
                mean(film.beauty()),
            ];
            means.iter_mut().zip(found).for_each(|(all, one)| all.push(one));
        }
        let [lamp, lamp_alone, bulbs, bulbs_alone, all] = means.map(|m| with_error(&m));
        for (layer, alone) in [(lamp, lamp_alone), (bulbs, bulbs_alone)] {
            let z = apart(layer, alone);
            assert!(z < 4.0 && alone[1] < 0.06 * alone[0], "{kind:?}: {layer:?} for {alone:?}, z {z:.1}");
            // A control: the other group's light would show.
            assert!(apart(all, alone) > 4.0, "{kind:?}: {all:?} for {alone:?}");
        }
    }
}

#[test]
fn bytes_do_not_depend_on_threads() {
    for kind in KINDS {
        let exr = |threads| encode_exr(&render(&desc(kind), 2, threads), &ExrOptions::default()).unwrap();
        let one = exr(1);
        let text = String::from_utf8_lossy(&one);
        assert!(text.contains("light-bulbs.R") && text.contains("technique-direct.B"));
        for threads in [2, 3, 7] {
            assert!(one == exr(threads), "{kind:?} on {threads} threads");
        }
    }
}

#[test]
fn lights_that_share_a_group_share_a_layer() {
    let mut desc = desc(IntegratorKind::Path);
    for object in &mut desc.objects {
        if let Some(emission) = object.value.emission.clone() {
            object.value.emission = Some(Emission { two_sided: true, ..emission.value }.into());
            object.value.light_group = Some("bulbs".into());
        }
    }
    let film = render(&desc, 1, 1);
    assert_eq!(film.layer_names()[2..], ["light-bulbs"]);
}
