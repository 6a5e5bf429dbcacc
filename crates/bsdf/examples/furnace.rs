//! Prints the white furnace of every kind: the least and the greatest share of light that surfaces which absorb nothing return, over
//! roughness, anisotropy, index and angle, and where. `cargo run --release -p nephroid-bsdf --example furnace [FILTER]`.

#![allow(clippy::print_stdout, reason = "a table is what it is for")]

use color::Lanes;
use math::{Frame, Vec3};
use nephroid_bsdf::{
    Bsdf, BsdfKind, Facets, Film, Interior, Principled, PrincipledParameters, TransportMode, disney_alpha,
};

const ROUGHNESSES: [f32; 6] = [0.05, 0.2, 0.4, 0.6, 0.8, 1.0];
const ANISOTROPIES: [f32; 5] = [-0.9, -0.5, 0.4, 0.7, 0.9];
const INDICES: [f32; 4] = [1.05, 1.25, 1.5, 2.5];
const COSINES: [f32; 7] = [1.0, 0.8, 0.6, 0.4, 0.2, 0.1, 0.05];
const AZIMUTHS: [f32; 2] = [0.3, 1.3];
const POINTS: u32 = 3000;

/// A surface and what to call it.
type Case = (String, BsdfKind);

fn alphas(anisotropies: &[f32]) -> Vec<(String, [f32; 2])> {
    let mut all = Vec::new();
    for r in ROUGHNESSES {
        for &a in anisotropies {
            let [x, y] = disney_alpha(r, a.abs());
            all.push((format!("r {r} a {a}"), if a < 0.0 { [y, x] } else { [x, y] }));
        }
    }
    all
}

fn energy(b: &Bsdf, wo: Vec3) -> f64 {
    let at = |i: u32, step: f64| ((0.5 + step * f64::from(i)).fract() as f32).min(math::ONE_MINUS_EPSILON);
    let one = |i: u32| {
        let u = [at(i, 0.671_043_606_703_789_2), at(i, 0.549_700_477_901_970_3)];
        b.sample(wo, at(i, 0.819_172_513_396_164_4), u, TransportMode::Importance)
            .map_or(0.0, |s| f64::from(s.weight.0.x))
    };
    (0..POINTS).map(one).sum::<f64>() / f64::from(POINTS)
}

fn furnace(name: &str, cases: &[Case], sides: &[f32]) {
    if std::env::args().nth(1).is_some_and(|filter| !name.contains(&filter)) {
        return;
    }
    let (mut low, mut high) = ((f64::INFINITY, String::new()), (0.0, String::new()));
    let mut off = 0;
    let mut n = 0;
    for (label, kind) in cases {
        let b = Bsdf::new(*kind, Frame { x: Vec3::X, y: Vec3::Y, z: Vec3::Z }, Vec3::Z);
        for cos in COSINES {
            for phi in AZIMUTHS {
                for side in sides {
                    let e = energy(&b, math::spherical_direction(cos * side, phi));
                    let place = || format!("{label} cos {} azimuth {phi}", cos * side);
                    n += 1;
                    off += u32::from((e - 1.0).abs() > 0.01);
                    if e < low.0 {
                        low = (e, place());
                    }
                    if e > high.0 {
                        high = (e, place());
                    }
                }
            }
        }
    }
    let share = 100.0 * f64::from(off) / f64::from(n);
    println!(
        "{name:34} {:.4} … {:.4}  {share:5.1} % beyond 1 %   least: {}; greatest: {}",
        low.0, high.0, low.1, high.1
    );
}

fn main() {
    const FRONT: &[f32] = &[1.0];
    const BOTH: &[f32] = &[1.0, -1.0];
    let one = Lanes::ONE;
    let (n, k) = (Lanes::ZERO, Lanes::splat(5.0));
    let facets = Facets::Conserving;
    let of = |anisotropies: &[f32], make: &dyn Fn([f32; 2]) -> BsdfKind| -> Vec<Case> {
        alphas(anisotropies).into_iter().map(|(l, a)| (l, make(a))).collect()
    };
    let indexed = |anisotropies: &[f32], make: &dyn Fn(f32, [f32; 2]) -> BsdfKind| -> Vec<Case> {
        let mut all = Vec::new();
        for eta in INDICES {
            all.extend(
                alphas(anisotropies).into_iter().map(|(l, a)| (format!("{l} ior {eta}"), make(eta, a))),
            );
        }
        all
    };
    let metal = |alpha| BsdfKind::RoughConductor { n, k, reflectance: one, alpha, facets, film: Film::NONE };
    furnace("metal", &of(&[0.0], &metal), FRONT);
    furnace("metal, anisotropic", &of(&ANISOTROPIES, &metal), FRONT);
    let glass = |eta, alpha| BsdfKind::RoughDielectric {
        eta,
        alpha,
        reflectance: one,
        transmittance: one,
        facets,
        film: Film::NONE,
    };
    furnace("glass", &indexed(&[0.0], &glass), BOTH);
    furnace("glass, anisotropic", &indexed(&ANISOTROPIES, &glass), BOTH);
    let thin = |eta, alpha| BsdfKind::ThinDielectric { eta, alpha, reflectance: one, transmittance: one };
    furnace("thin glass", &indexed(&[0.0], &thin), FRONT);
    furnace("thin glass, anisotropic", &indexed(&ANISOTROPIES, &thin), FRONT);
    let coated = |eta, alpha| BsdfKind::CoatedDiffuse { albedo: one, specular: one, eta, alpha, facets };
    furnace("coated diffuse", &indexed(&[0.0], &coated), FRONT);
    furnace("coated diffuse, anisotropic", &indexed(&ANISOTROPIES, &coated), FRONT);
    for coat_alpha in [0.0, 0.01, 0.1, 0.4] {
        let coated =
            |eta, alpha| BsdfKind::CoatedConductor { n, k, alpha, eta, coat_alpha, depth: 0.0, facets };
        furnace(&format!("coated metal, coat {coat_alpha}"), &indexed(&[0.0], &coated), FRONT);
        furnace(&format!("coated metal, coat {coat_alpha}, aniso"), &indexed(&[-0.5, 0.9], &coated), FRONT);
    }
    let rough = |alpha: [f32; 2]| BsdfKind::RoughDiffuse { albedo: one, roughness: alpha[0] };
    furnace("rough diffuse", &of(&[0.0], &rough), FRONT);
    let white = PrincipledParameters { base_color: one, ..Default::default() };
    let slab = |p: PrincipledParameters| {
        move |eta, alpha| BsdfKind::Principled(Principled::new(&PrincipledParameters { eta, alpha, ..p }))
    };
    let metallic = PrincipledParameters { metallic: 1.0, ..white };
    let clear = PrincipledParameters { transmission: 1.0, ..white };
    let sheet = PrincipledParameters { transmission: 1.0, interior: Interior::Thin, ..white };
    for (name, p, sides) in [
        ("base", white, FRONT),
        ("metal", metallic, FRONT),
        ("glass", clear, BOTH),
        ("sheet", sheet, FRONT),
        ("half of all", PrincipledParameters { metallic: 0.3, transmission: 0.5, ..white }, FRONT),
    ] {
        furnace(&format!("principled {name}"), &indexed(&[0.0, 0.7], &slab(p)), sides);
        for alpha in [0.001, 0.1] {
            let p = PrincipledParameters { clearcoat: 1.0, clearcoat_alpha: alpha, ..p };
            furnace(&format!("principled {name}, coat {alpha}"), &indexed(&[0.0, 0.7], &slab(p)), sides);
        }
        let p = PrincipledParameters { sheen_color: one, sheen_alpha: 0.3, ..p };
        furnace(&format!("principled {name}, sheen"), &indexed(&[0.0, 0.7], &slab(p)), sides);
        let p = PrincipledParameters { clearcoat: 0.5, clearcoat_alpha: 0.02, ..p };
        furnace(&format!("principled {name}, sheen and coat"), &indexed(&[0.0, 0.7], &slab(p)), sides);
    }
}
