//! Walks end, even where nothing absorbs.

use bsdf::TransportMode;
use color::Lanes;
use math::{Ray, Vec3};
use nephroid_transport::{ENDLESS_DEPTH, Walk};
use sampling::{Domain, Sampler};
use scenefile::SceneDesc;
use scenefile::desc::{Camera, Material, Object, Shape};

/// Between perfect mirrors a walk goes on for ever but for its roulette, which takes no energy on average.
#[test]
fn a_walk_in_a_closed_mirror_ends() {
    let mut desc = SceneDesc { camera: Some(Camera::default().into()), ..SceneDesc::default() };
    desc.materials.insert("mirror".into(), Material::mirror(1.0).into());
    desc.objects.push(Object::new(Shape::Sphere { center: [0.0; 3], radius: 1.0 }, "mirror").into());
    let (scene, _) = scene::compile(&desc).unwrap();
    let (mut events, mut carried) = (0u64, 0f64);
    let walks = 2000;
    for path in 0..walks {
        let mut sampler = Sampler::new(1, 0, Domain::Other, path);
        let w = sampling::warp::sphere(sampler.next_2d());
        let ray = Ray::new(Vec3::ZERO, w);
        let mut walk =
            Walk::new(&scene, TransportMode::Importance, ray, Lanes::rgb(1.0, 1.0, 1.0), Default::default());
        while let Some(vertex) = walk.next_vertex() {
            let scattered = walk.scatter(&vertex, &mut sampler).is_some();
            if !scattered || !walk.roulette(1.0, &mut sampler) {
                break;
            }
            if walk.depth == ENDLESS_DEPTH + 10 {
                carried += f64::from(walk.throughput.mean());
            }
        }
        events += u64::from(walk.depth);
    }
    let mean = events as f64 / walks as f64 - f64::from(ENDLESS_DEPTH);
    // Geometric with mean 10, standard deviation 9.5: standard error 0.21.
    assert!((mean - 10.0).abs() < 4.0 * 0.21, "one in ten ends at each event: {mean}");
    // One walk in 0.9⁻¹⁰ comes so far: standard error √((0.9⁻¹⁰ − 1)/2000) = 0.031.
    assert!((carried / walks as f64 - 1.0).abs() < 4.0 * 0.031, "{carried}");
}
