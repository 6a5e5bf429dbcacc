//! Prints what a hit costs by kind: nanoseconds to make the BSDF, to evaluate f and the density, and to sample, the least of several
//! rounds. `cargo run --release -p nephroid-bsdf --example cost`.

#![allow(clippy::print_stdout, reason = "a table is what it is for")]

use std::hint::black_box;
use std::time::Instant;

use color::Lanes;
use math::{Frame, Vec3};
use nephroid_bsdf::{Bsdf, BsdfKind, Facets, Film, Principled, PrincipledParameters, TransportMode};
use sampling::{Domain, Sampler, warp};

const CALLS: usize = 4000;
const ROUNDS: usize = 60;

/// The least time of a call in nanoseconds.
fn least(mut f: impl FnMut(usize)) -> f64 {
    let round = |f: &mut dyn FnMut(usize)| {
        let start = Instant::now();
        (0..CALLS).for_each(f);
        start.elapsed().as_secs_f64() * 1e9 / CALLS as f64
    };
    (0..ROUNDS).map(|_| round(&mut f)).fold(f64::INFINITY, f64::min)
}

fn main() {
    let one = Lanes::ONE;
    let (n, k) = (Lanes::rgb(0.16, 0.42, 1.51), Lanes::rgb(3.8, 2.4, 1.88));
    let (film, facets) = (Film::NONE, Facets::Conserving);
    let metal = |alpha, facets| BsdfKind::RoughConductor { n, k, reflectance: one, alpha, facets, film };
    let glass = |alpha| BsdfKind::RoughDielectric {
        eta: 1.5,
        alpha,
        reflectance: one,
        transmittance: one,
        facets,
        film,
    };
    let coated = |facets| BsdfKind::CoatedDiffuse {
        albedo: one * 0.5,
        specular: one,
        eta: 1.5,
        alpha: [0.2; 2],
        facets,
    };
    let coated_metal = |coat_alpha| BsdfKind::CoatedConductor {
        n,
        k,
        alpha: [0.2; 2],
        eta: 1.5,
        coat_alpha,
        depth: 0.01,
        facets,
    };
    let base = PrincipledParameters::default();
    let principled = |p: &PrincipledParameters| BsdfKind::Principled(Principled::new(p));
    let layered = PrincipledParameters { clearcoat: 1.0, sheen_color: one * 0.3, ..base };
    let kinds = [
        ("diffuse", BsdfKind::Diffuse { albedo: one * 0.5 }),
        ("mirror", BsdfKind::Mirror { color: one }),
        ("dielectric", BsdfKind::Dielectric { eta: 1.5, tint: one }),
        ("metal", BsdfKind::Conductor { n, k, alpha: 0.2 }),
        ("metal, anisotropic", metal([0.3, 0.1], facets)),
        ("metal, single bounce", metal([0.2; 2], Facets::SingleBounce)),
        ("metal, beckmann", metal([0.2; 2], Facets::Beckmann)),
        ("glass", glass([0.2; 2])),
        ("glass, anisotropic", glass([0.3, 0.1])),
        ("plastic", BsdfKind::Plastic { albedo: one * 0.5, eta: 1.5, alpha: 0.2 }),
        ("coated diffuse, single", coated(Facets::SingleBounce)),
        ("coated metal", coated_metal(0.0)),
        ("coated metal, rough coat", coated_metal(0.1)),
        ("principled", principled(&base)),
        ("principled, metal", principled(&PrincipledParameters { metallic: 1.0, ..base })),
        ("principled, glass", principled(&PrincipledParameters { transmission: 1.0, ..base })),
        ("principled, coat and sheen", principled(&layered)),
    ];
    let mut s = Sampler::new(1, 0, Domain::Other, 0);
    let ways: Vec<(Vec3, Vec3, f32, [f32; 2])> = (0..CALLS)
        .map(|_| {
            let up = |w: Vec3| Vec3::new(w.x, w.y, w.z.abs());
            (up(warp::sphere(s.next_2d())), up(warp::sphere(s.next_2d())), s.next_1d(), s.next_2d())
        })
        .collect();
    let frame = Frame { x: Vec3::X, y: Vec3::Y, z: Vec3::Z };
    let mode = TransportMode::Radiance;
    println!("{:28} {:>7} {:>7} {:>7} {:>7}  ns", "", "make", "eval", "pdf", "sample");
    for (name, kind) in kinds {
        let b = Bsdf::new(kind, frame, Vec3::Z);
        let times = [
            least(|_| {
                let kind = match kind {
                    BsdfKind::Principled(p) => BsdfKind::Principled(Principled::new(&p.parameters())),
                    other => other,
                };
                black_box(Bsdf::new(black_box(kind), frame, Vec3::Z));
            }),
            least(|i| {
                black_box(b.eval(ways[i].0, ways[i].1, mode));
            }),
            least(|i| {
                black_box(b.pdf_w(ways[i].0, ways[i].1, mode));
            }),
            least(|i| {
                black_box(b.sample(ways[i].0, ways[i].2, ways[i].3, mode));
            }),
        ];
        println!("{name:28} {:7.1} {:7.1} {:7.1} {:7.1}", times[0], times[1], times[2], times[3]);
    }
}
