//! Every kind of material under every integrator: a ball (or a pane) of it in a closed room, against `path`.

use nephroid::SceneDesc;
use nephroid::desc::{
    CoatedConductor, CoatedDiffuse, Conductor, Dielectric, IntegratorKind, Material, MaterialKind, Object,
    Principled, Roughness, Shape, ThinDielectric,
};
use testkit::Moments;

use crate::support::*;

const OTHERS: [IntegratorKind; 4] =
    [PHOTON_MAP, IntegratorKind::Sppm, IntegratorKind::Vcm, IntegratorKind::Auto];

/// A closed room with a broad lamp and the given things; little photon work, small radii.
fn room(things: Vec<Object>) -> SceneDesc {
    let walls = Shape::Box { min: [-1.5, -1.0, -1.2], max: [1.5, 1.0, 3.0] };
    let mut objects = vec![
        Object { flip_normals: true, ..Object::new(walls, grey(0.5)) },
        lamp(disk([0.0, 0.98, 0.0], [0.0, -1.0, 0.0], 0.9), 2.0),
    ];
    objects.extend(things);
    let mut desc = scene_of(look([0.0, 0.0, 2.9], [0.0, -0.3, 0.0], 60.0), 16, objects);
    small_maps(&mut desc);
    desc.sppm.photons = Some(4_000);
    desc
}

fn ball(x: f32, z: f32, material: impl Into<Material>) -> Object {
    Object::new(sphere([x, -0.6, z], 0.4), material.into())
}

/// A pane across the room, between the lamp and the floor in front.
fn pane(material: impl Into<Material>) -> Object {
    let side = 1.6;
    let quad = Shape::Quad { origin: [-0.8, -0.2, 0.9], edge_u: [side, 0.0, 0.0], edge_v: [0.0, 0.3, -side] };
    Object::new(quad, material.into())
}

/// Renders of every integrator against `path`. What the blur of photons may cost is 0.6 %: edges and corners within a
/// radius see less light, and a ball's foot hides some.
#[track_caller]
fn agree(what: &str, desc: &SceneDesc, passes: u32) {
    let path = brightness(desc, PATH, 12, 2 * passes);
    for integrator in OTHERS {
        let name = format!("{what}, {}", integrator.name());
        let found: Moments = brightness(desc, integrator, 12, passes);
        assert_same_within(&name, &found, &path, 0.006, 1.04);
    }
}

fn frosted(roughness: f32) -> Dielectric {
    Dielectric { roughness: roughness.into(), ..Dielectric::default() }
}

#[test]
fn rough_and_thin_glass() {
    let thin = ThinDielectric { color: [0.9, 0.8, 0.7].into(), ..ThinDielectric::default() };
    let hazy = ThinDielectric { roughness: 0.5.into(), ..ThinDielectric::default() };
    let brushed =
        Dielectric { roughness: Roughness::Alpha { along: 0.5.into(), across: 0.2.into() }, ..frosted(0.0) };
    let desc = room(vec![
        ball(-0.9, 0.0, frosted(0.6)),
        ball(0.0, 0.5, brushed),
        ball(0.9, 0.0, frosted(0.4)),
        pane(thin),
        Object::new(disk([0.0, 0.3, 0.8], [0.3, 1.0, 0.2], 0.5), Material::from(hazy)),
    ]);
    agree("rough glass", &desc, 24);
}

#[test]
fn light_that_passes_diffusely() {
    let paper = MaterialKind::DiffuseTransmission {
        reflectance: [0.3, 0.4, 0.2].into(),
        transmittance: [0.6, 0.4, 0.5].into(),
    };
    let leaf = Principled {
        diffuse_transmission: 0.5.into(),
        base_color: 0.9.into(),
        thin: true,
        ..Principled::default()
    };
    let desc = room(vec![
        pane(paper.clone()),
        // A shade about nothing, and a leaf under a glass ball: photons arrive from behind.
        ball(0.8, -0.4, paper),
        Object::new(disk([-0.8, -0.55, 0.6], [0.2, 1.0, 0.1], 0.4), Material::from(leaf)),
        Object::new(sphere([-0.8, 0.1, 0.6], 0.25), Material::dielectric(1.5)),
    ]);
    agree("diffuse transmission", &desc, 24);
}

#[test]
fn coats_cloth_and_plaster() {
    let varnish = CoatedConductor {
        roughness: 0.5.into(),
        coat_roughness: 0.0.into(),
        depth: 0.1,
        ..CoatedConductor::default()
    };
    let enamel = CoatedDiffuse {
        color: [0.2, 0.5, 0.8].into(),
        roughness: Roughness::Perceived { roughness: 0.6.into(), anisotropy: 0.7.into() },
        depth: 0.1,
        ..CoatedDiffuse::default()
    };
    let desc = room(vec![
        ball(-0.9, 0.0, varnish),
        ball(0.0, -0.4, enamel),
        ball(0.9, 0.0, MaterialKind::Sheen { color: 0.9.into(), roughness: 0.6.into() }),
        ball(0.4, 0.7, MaterialKind::RoughDiffuse { color: 0.7.into(), roughness: 0.9.into() }),
        ball(
            -0.4,
            0.7,
            Conductor {
                roughness: Roughness::Alpha { along: 0.6.into(), across: 0.3.into() },
                ..Conductor::default()
            },
        ),
    ]);
    agree("coats", &desc, 24);
}

#[test]
fn the_principled_slab() {
    let car = Principled {
        base_color: [0.6, 0.1, 0.1].into(),
        metallic: 0.5.into(),
        clearcoat: 1.0.into(),
        sheen_color: 0.3.into(),
        film: 0.5.into(),
        ..Principled::default()
    };
    let glass = Principled {
        transmission: 1.0.into(),
        roughness: 0.5.into(),
        base_color: 0.9.into(),
        ..Principled::default()
    };
    let milk = Principled {
        transmission: 0.5.into(),
        roughness: 0.5.into(),
        base_color: 0.8.into(),
        ..Principled::default()
    };
    let metal = Principled {
        metallic: 1.0.into(),
        roughness: 0.6.into(),
        base_color: 0.9.into(),
        ..Principled::default()
    };
    let desc =
        room(vec![ball(-0.9, 0.0, car), ball(0.0, 0.4, glass), ball(0.9, 0.0, milk), ball(0.4, -0.5, metal)]);
    agree("principled", &desc, 24);
}

/// Half of the rays pass a surface of opacity 1/2, and a mix is the mean of its parts.
#[test]
fn opacity_and_mixes_are_means() {
    let seen = |material: Material| {
        let objects = vec![
            Object::new(disk([0.0; 3], [0.0, 0.0, 1.0], 1.0), material),
            lamp(disk([0.0, 0.0, -3.0], [0.0, 0.0, 1.0], 9.0), 1.0),
        ];
        let desc = scene_of(look([0.0, 0.0, 4.0], [0.0, 0.0, 0.0], 5.0), 32, objects);
        brightness(&desc, PATH, 12, 32)
    };
    let film = Material { opacity: 0.3.into(), ..grey(0.0) };
    assert_mean("opacity", &seen(film.clone()), 0.7, 0.0);
    let cut = Material { opacity_cutoff: Some(0.3), ..film.clone() };
    assert_eq!(seen(cut).mean, 0.0);
    let gone = Material { opacity_cutoff: Some(0.31), ..film.clone() };
    assert!((seen(gone).mean - 1.0).abs() < 1e-6);
    let mix = MaterialKind::Mix { a: film.into(), b: grey(0.0).into(), amount: 0.5.into() };
    assert_mean("mix", &seen(mix.into()), 0.35, 0.0);
}

#[test]
fn things_that_are_there_by_chance() {
    let rust = MaterialKind::Mix {
        a: Material::conductor("gold", 0.5).into(),
        b: grey(0.6).into(),
        amount: 0.6.into(),
    };
    let gauze = Material { opacity: 0.5.into(), ..grey(0.8) };
    let jelly = MaterialKind::Mix {
        a: Material::plastic(0.6, 0.5).into(),
        b: Material { opacity: 0.6.into(), ..grey(0.3) }.into(),
        amount: 0.5.into(),
    };
    let desc = room(vec![ball(-0.8, 0.0, rust), pane(gauze), ball(0.6, 0.3, jelly)]);
    agree("by chance", &desc, 16);
}

/// Beer–Lambert in closed form: a lamp seen through two units of an absorber of index 1, by every integrator.
#[test]
fn a_lamp_behind_an_absorber_is_dimmed_exponentially() {
    let absorption = [0.2, 0.5, 1.0];
    let tinted = Dielectric { ior: 1.0.into(), absorption, ..Dielectric::default() };
    let objects = vec![
        Object::new(Shape::Box { min: [-9.0, -9.0, -1.0], max: [9.0, 9.0, 1.0] }, Material::from(tinted)),
        lamp(disk([0.0, 0.0, -3.0], [0.0, 0.0, 1.0], 9.0), 1.0),
    ];
    // So narrow that all rays are as long.
    let desc = scene_of(look([0.0, 0.0, 4.0], [0.0, 0.0, 0.0], 0.5), 4, objects);
    let expected: f64 = absorption.iter().map(|s| (-2.0 * f64::from(*s)).exp()).sum::<f64>() / 3.0;
    for integrator in [PATH].into_iter().chain(OTHERS) {
        let found = brightness(&desc, integrator, 4, 2);
        let error = found.mean / expected - 1.0;
        assert!(error.abs() < 1e-4, "{}: {error}", integrator.name());
    }
}

/// A room full of an absorber, with camera and lamp inside: all that joins two points within it must attenuate.
#[test]
fn light_is_absorbed_on_the_way_between_surfaces() {
    let fog = Dielectric { ior: 1.3.into(), absorption: [0.1, 0.2, 0.4], ..Dielectric::default() };
    let amber = Dielectric { absorption: [0.5, 1.5, 4.0], ior: 1.6.into(), priority: 1, ..frosted(0.4) };
    let around = Shape::Box { min: [-5.0; 3], max: [5.0; 3] };
    let mut desc = room(vec![
        Object::new(around, Material::from(fog)),
        ball(-0.8, 0.0, grey(0.7)),
        ball(0.0, 0.5, amber),
        ball(0.8, 0.0, Material::conductor("gold", 0.6)),
    ]);
    agree("absorption", &desc, 24);
    // What is tested here is there: without it the picture is another.
    let with = brightness(&desc, PATH, 4, 8).mean;
    let clear = Dielectric { ior: 1.3.into(), ..Dielectric::default() };
    desc.objects[2].value.material = Some(Material::from(clear).into());
    assert!(brightness(&desc, PATH, 4, 8).mean > 1.3 * with);
}
