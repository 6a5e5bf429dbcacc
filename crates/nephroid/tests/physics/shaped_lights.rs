//! Points that shine by direction, and amounts in photometric units.

use std::path::{Path, PathBuf};

use film::encode_exr_rgb;
use nephroid::SceneDesc;
use nephroid::desc::{
    IntegratorKind, Light, LightKind, Material, Object, PointAmount, ProfileAmount, SkyMapping, TransformStep,
};
use testkit::Moments;
use transport::PhotonPaths;

use crate::support::*;

fn written(name: &str, bytes: &[u8]) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::write(&path, bytes).unwrap();
    path
}

/// A picture with a bright pixel on its right.
fn picture(name: &str, width: usize, height: usize) -> PathBuf {
    let pixel = |i: usize| if i % width == width - 2 { [3.0, 2.0, 1.0] } else { [0.2, 0.4, 0.3] };
    let pixels: Vec<[f32; 3]> = (0..width * height).map(pixel).collect();
    written(name, &encode_exr_rgb(width, height, &pixels, &[]).unwrap())
}

/// A luminaire that shines down, more to one side, and is dark above 80°.
const LUMINAIRE: &str = "IESNA:LM-63-2002\nTILT=NONE\n1 1000 1 5 3 1 2 0 0 0 1 1 20\n0 20 40 60 80\n0 60 180\n\
                         300 280 240 100 0\n300 400 500 200 0\n300 200 100 40 0\n";

fn at(position: [f32; 3]) -> Vec<TransformStep> {
    vec![TransformStep::Rotate { axis: [0.6, 0.0, 0.8], degrees: 20.0 }, TransformStep::Translate(position)]
}

fn lights() -> Vec<(&'static str, LightKind)> {
    let above = [0.2, 0.9, 0.4];
    let file = written("luminaire.ies", LUMINAIRE.as_bytes()).into();
    let amount = ProfileAmount::AsFile { scale: 2.0, color: [1.0, 0.8, 0.5] };
    let down = TransformStep::LookAt { position: above, target: [0.0, -1.0, 0.2], up: [0.0, 0.0, 1.0] };
    vec![
        ("profile", LightKind::Profile { file, transform: at(above), amount }),
        (
            "goniometric",
            LightKind::Goniometric {
                source: picture("round.exr", 8, 4).into(),
                mapping: SkyMapping::LatLong,
                intensity: [1.0; 3],
                transform: at(above),
            },
        ),
        (
            "projector",
            LightKind::Projector {
                source: picture("slide.exr", 6, 4).into(),
                fov: 60.0,
                intensity: [2.0; 3],
                transform: vec![down],
            },
        ),
    ]
}

/// Direct light, photons and light paths see the same light.
#[test]
fn integrators_agree_on_each_light() {
    for (name, kind) in lights() {
        let objects = vec![
            Object::new(ground(-1.0, 1.5), grey(0.5)),
            Object::new(sphere([-0.6, -0.6, 0.0], 0.4), grey(0.7)),
            Object::new(sphere([0.6, -0.6, 0.2], 0.4), Material::conductor("gold", 0.5)),
        ];
        let mut desc = scene_of(look([0.0, 0.4, 2.9], [0.0, -0.6, 0.0], 50.0), 16, objects);
        desc.lights.push(Light::from(kind).into());
        desc.sppm = nephroid::desc::Sppm {
            photons: Some(24_000),
            radius: Some(0.03),
            alpha: 1.0,
            direct: nephroid::desc::DirectLight::Photons,
            ..desc.sppm
        };
        desc.vcm.light_paths = Some(512);
        desc.vcm.radius = Some(0.02);
        desc.vcm.alpha = 1.0;
        let path = brightness(&desc, PATH, 12, 48);
        for integrator in [IntegratorKind::Sppm, IntegratorKind::Vcm] {
            let found = brightness(&desc, integrator, 12, 24);
            assert_same_within(&format!("{name}, {}", integrator.name()), &found, &path, 0.01, 1.1);
        }
    }
}

/// Flux of the photons that leave a light within a dark sphere, by channel.
fn emitted(kind: LightKind) -> [Moments; 3] {
    let walls = Object { flip_normals: true, ..Object::new(sphere([0.0; 3], 5.0), grey(0.5)) };
    let mut desc = scene_of(look([0.0; 3], [0.0, 0.0, 1.0], 50.0), 2, vec![walls]);
    desc.lights.push(Light::from(kind).into());
    let scene = compiled(&desc);
    let power = scene.power().to_rgb();
    let all: Vec<[f64; 3]> = (0..12)
        .map(|seed| {
            let batch = photons(&scene, PhotonPaths::Global, 20_000, seed, 1);
            [0, 1, 2].map(|c| batch.photons.iter().map(|p| f64::from(p.power.to_rgb()[c])).sum())
        })
        .collect();
    let sums = [0, 1, 2].map(|c| Moments::of(all.iter().map(|s| s[c])));
    (0..3).for_each(|c| assert_mean("photons carry the power", &sums[c], f64::from(power[c]), 1e-3));
    sums
}

/// The luminous flux of a profile is that of its file over the efficacy, whatever its colour; a power is a power.
#[test]
fn profiles_have_their_flux() {
    let file = written("flux.ies", LUMINAIRE.as_bytes());
    let lumens = photometry::read(LUMINAIRE.as_bytes()).unwrap().web.lumens();
    let profile = |amount| LightKind::Profile { file: file.clone().into(), transform: at([0.0; 3]), amount };
    let rgb = emitted(profile(ProfileAmount::AsFile { scale: 0.5, color: [1.0, 0.6, 0.2] })).map(|m| m.mean);
    let luminous = color::luminance_f64(rgb) * f64::from(nephroid::desc::WHITE_EFFICACY);
    assert!((luminous / (0.5 * lumens) - 1.0).abs() < 2e-3, "{luminous} lm of {lumens}");
    assert!((rgb[1] / rgb[0] - 0.6).abs() < 1e-3 && (rgb[2] / rgb[0] - 0.2).abs() < 1e-3, "{rgb:?}");
    let rgb = emitted(profile(ProfileAmount::Power { watts: 3.0, color: [1.0, 0.6, 0.2] })).map(|m| m.mean);
    assert!(((rgb[0] + rgb[1] + rgb[2]) / 9.0 - 1.0).abs() < 2e-3, "{rgb:?}");
}

/// What is thrown lies where it should: +z ahead, the right at −x; turned by the light's transform.
#[test]
fn projectors_throw_their_picture_the_right_way_round() {
    let source = picture("right.exr", 6, 4).into();
    let kind = LightKind::Projector { source, fov: 60.0, intensity: [1.0; 3], transform: Vec::new() };
    let wall = nephroid::desc::Shape::Quad {
        origin: [9.0, -9.0, 2.0],
        edge_u: [-18.0, 0.0, 0.0],
        edge_v: [0.0, 18.0, 0.0],
    };
    // The camera, behind the light, sees the wall as one who stands by the projector: −x is on its right.
    let mut desc =
        scene_of(look([0.0, 0.0, 0.0], [0.0, 0.0, 1.0], 60.0), 12, vec![Object::new(wall, grey(1.0))]);
    desc.lights.push(Light::from(kind).into());
    let picture = film(&desc, &compiled(&desc), PATH, 1, 16);
    let half = |right: bool| mean_where(&picture, nephroid::Layer::Beauty, |x, _| (x >= 6) == right);
    assert!(half(true) > 2.0 * half(false), "{} {}", half(true), half(false));
}

fn scene(lights: &str) -> SceneDesc {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let text = format!("[camera]\nposition = [0, 0, 1]\nlook_at = [0, 0, 0]\n{lights}");
    let path = folder.join("units.toml");
    let loaded = nephroid::parse(&text, &path, &[]);
    loaded.desc.clone().unwrap_or_else(|| panic!("{}", loaded.render()))
}

/// Amounts in photometric units are the radiometric ones of the description.
#[test]
fn photometric_amounts() {
    let close = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-5, "{a} {b}");
    let luminance = |rgb: [f32; 3]| 179.0 * color::luminance_f64(rgb.map(f64::from));
    let light = |text: &str| scene(&format!("[[lights]]\n{text}\n")).lights[0].kind.clone();
    let warm = color::blackbody_rgb(2700.0);
    match light("kind = \"point\"\nposition = [0, 0, 0]\ncandela = 80\ntemperature = 2700") {
        LightKind::Point { amount: PointAmount::Intensity(rgb), .. } => {
            close(luminance(rgb), 80.0);
            close(f64::from(rgb[0] / rgb[2]), f64::from(warm[0] / warm[2]));
        }
        other => panic!("{other:?}"),
    }
    for position in [
        "kind = \"point\"\nposition = [0, 0, 0]",
        "kind = \"spot\"\nposition = [0, 0, 0]\ntarget = [0, 0, 1]",
    ] {
        match light(&format!("{position}\nlumens = 800\ncolor = [1, 0.5, 0]")) {
            LightKind::Point { amount: PointAmount::Power { watts, color }, .. }
            | LightKind::Spot { amount: PointAmount::Power { watts, color }, .. } => {
                close(luminance(nephroid::desc::channel_power(watts, color)), 800.0);
            }
            other => panic!("{other:?}"),
        }
    }
    match light("kind = \"directional\"\ndirection = [0, -1, 0]\nlux = 100000") {
        LightKind::Directional { irradiance, .. } => close(luminance(irradiance), 1e5),
        other => panic!("{other:?}"),
    }
    match light("kind = \"environment\"\nlux = 10000\ntemperature = 10000") {
        LightKind::Environment { radiance } => close(luminance(radiance) * std::f64::consts::PI, 1e4),
        other => panic!("{other:?}"),
    }
    match light("kind = \"environment\"\nnits = 300") {
        LightKind::Environment { radiance } => close(luminance(radiance), 300.0),
        other => panic!("{other:?}"),
    }
    let lamp = |text: &str| {
        let desc = scene(&format!("[[objects]]\nshape = \"sphere\"\n{text}\n"));
        compiled(&desc).power().to_rgb()
    };
    close(luminance(lamp("lumens = 1500\ntemperature = 4000")), 1500.0);
    // A sphere of radius 1: Φ = π·4π·L.
    close(luminance(lamp("nits = 20\ncolor = [0, 1, 1]")), 20.0 * 4.0 * std::f64::consts::PI.powi(2));
}

/// What a file says that is not rendered is told, and what is wrong with it has its line.
#[test]
fn profiles_that_are_wrong_are_told() {
    let told = |text: &str| {
        let file = written("told.ies", text.as_bytes());
        let mut desc = scene("");
        let amount = ProfileAmount::AsFile { scale: 1.0, color: [1.0; 3] };
        let kind = LightKind::Profile { file: file.into(), transform: Vec::new(), amount };
        desc.lights.push(Light::from(kind).into());
        match nephroid::compile(&desc, 1) {
            Ok(compiled) => {
                compiled.warnings.iter().map(|d| d.message.clone()).collect::<Vec<_>>().join("\n")
            }
            Err(errors) => format!("{errors:?}"),
        }
    };
    assert_eq!(told(LUMINAIRE), "");
    assert!(told(&LUMINAIRE.replace("NONE", "lamp.tlt")).contains("told.ies`, line 2: TILT=lamp.tlt"));
    assert!(
        told(&LUMINAIRE.replace("240", "wide")).contains("line 6: intensities must be a number, not `wide`")
    );
}
