//! Normal maps, bump maps and turned tangents, as rays meet them.
#![allow(clippy::unwrap_used)] // a test may

use bsdf::TransportMode;
use math::{Ray, Vec3};
use nephroid_scene as scene;
use sampling::{Domain, Sampler, warp};

use scenefile::SceneDesc;
use scenefile::desc::{
    Camera, ColorDesc, ColorSpace, Conductor, EmbeddedImage, Facets, FloatDesc, Group, Image, ImageSource,
    Instance, Mapping, Material, MaterialKind, Metal, Noise, NoiseKind, Object, Roughness, Shape, Texture,
    ThinFilm, TransformStep,
};

/// A square of side 1 in the plane y = 0, front up, u along x and v along −z where `uvs` is `None`.
fn square(uvs: Option<[[f32; 2]; 4]>) -> Shape {
    Shape::Triangles {
        positions: vec![[0.0; 3], [1.0, 0.0, 0.0], [1.0, 0.0, -1.0], [0.0, 0.0, -1.0]],
        indices: vec![[0, 1, 2], [0, 2, 3]],
        vertex_normals: vec![],
        uvs: uvs.unwrap_or([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]).to_vec(),
        uvs2: vec![],
        colors: vec![],
        normals: Default::default(),
    }
}

fn scene_of(shape: Shape, material: Material, texture: Texture) -> SceneDesc {
    let mut desc = SceneDesc { camera: Some(Camera::default().into()), ..SceneDesc::default() };
    desc.textures.insert("t".into(), texture.into());
    desc.materials.insert("m".into(), material.into());
    desc.objects.push(Object::new(shape, "m").into());
    desc
}

/// The shading normal that a ray from above meets at (x, z).
fn normal(desc: &SceneDesc, x: f32, z: f32) -> Vec3 {
    let (scene, _) = scene::compile(desc).expect("a sound scene");
    let hit = scene.intersect(&Ray::new(Vec3::new(x, 9.0, z), -Vec3::Y)).expect("a surface lies below");
    scene.bsdf(&hit, Vec3::Y, 1.0, 0.0).ns()
}

fn picture(width: u32, height: u32, texel: impl Fn(u32, u32) -> [u16; 3]) -> Image {
    let image = image::ImageBuffer::from_fn(width, height, |x, y| image::Rgb(texel(x, y)));
    let mut bytes = std::io::Cursor::new(Vec::new());
    image::DynamicImage::ImageRgb16(image).write_to(&mut bytes, image::ImageFormat::Png).unwrap();
    let bytes = bytes.into_inner().into();
    let embedded = EmbeddedImage { name: "p.png".into(), bytes };
    Image { color_space: ColorSpace::Linear, ..Image::new(ImageSource::Embedded(embedded)) }
}

fn bumped(height: f32) -> Material {
    Material { bump_map: Some("t".to_owned().into()), bump_height: height, ..Material::diffuse(1.0) }
}

fn close(a: Vec3, b: Vec3) {
    assert!(a.distance(b) < 2e-3, "{a} {b}");
}

#[test]
fn a_ramp_tilts_the_normal_by_its_slope() {
    // From 0.25 to 0.75 over 32 texels along x.
    let ramp = picture(32, 1, |x, _| [(65535.0 * (0.25 + 0.5 * (x as f32 + 0.5) / 32.0)) as u16; 3]);
    let expected = |slope: f32| Vec3::new(-slope, 1.0, 0.0).normalize();
    let desc = scene_of(square(None), bumped(4.0), Texture::Image(ramp.clone()));
    close(normal(&desc, 0.5, -0.4), expected(2.0));
    close(normal(&desc, 0.37, -0.8), expected(2.0));
    let desc = scene_of(square(None), bumped(-0.6), Texture::Image(ramp.clone()));
    close(normal(&desc, 0.5, -0.4), expected(-0.3));
    // Twice over the square, turned: the ramp goes against v.
    let mapping = Mapping::Uv { set: 0, scale: [2.0, 2.0], rotation: 90.0, offset: [0.0; 2] };
    let turned = Texture::Image(Image { mapping, ..ramp.clone() });
    // s = −2v, v = −z: s grows with z.
    close(
        normal(&scene_of(square(None), bumped(0.5), turned), 0.3, -0.3),
        Vec3::new(0.0, 1.0, -0.5).normalize(),
    );
    // Heights are those of the world, whatever an instance does to lengths: half the slope on twice the length.
    let mut desc = scene_of(square(None), bumped(2.0), Texture::Image(ramp));
    let object = desc.objects.pop().unwrap();
    desc.groups.insert("g".into(), Group { objects: vec![object] }.into());
    let transform = vec![TransformStep::Scale([2.0, 1.0, 1.0])];
    desc.instances.push(Instance { name: None, group: "g".into(), transform, material: None }.into());
    close(normal(&desc, 1.0, -0.4), expected(0.5));
}

#[test]
fn noise_and_spheres_are_bumped() {
    let noise = Noise {
        kind: NoiseKind::Fbm,
        octaves: 3,
        roughness: 0.5,
        transform: vec![TransformStep::Scale([0.2; 3])],
    };
    let plain = scene_of(square(None), Material::diffuse(1.0), Texture::checker(0.0, 1.0, [1.0; 2]));
    assert_eq!(normal(&plain, 0.3, -0.3), Vec3::Y);
    for shape in [square(None), Shape::Sphere { center: [0.4, 0.0, -0.4], radius: 0.5 }] {
        let tilts: Vec<f32> = [0.2, 0.35, 0.41, 0.55]
            .iter()
            .map(|x| {
                let flat = scene_of(shape.clone(), Material::diffuse(1.0), Texture::Noise(noise.clone()));
                let bent = scene_of(shape.clone(), bumped(0.05), Texture::Noise(noise.clone()));
                normal(&flat, *x, -0.45).distance(normal(&bent, *x, -0.45))
            })
            .collect();
        assert!(tilts.iter().all(|t| *t < 1.0) && tilts.iter().any(|t| *t > 0.05), "{tilts:?}");
    }
    // On a sphere a ramp over v tilts toward the poles.
    let ramp = picture(1, 64, |_, y| [(65535.0 * (1.0 - (y as f32 + 0.5) / 64.0)) as u16; 3]);
    let sphere = Shape::Sphere { center: [0.0; 3], radius: 1.0 };
    let desc = scene_of(sphere, bumped(0.5), Texture::Image(ramp));
    let (scene, _) = scene::compile(&desc).unwrap();
    let hit = scene.intersect(&Ray::new(Vec3::new(0.0, 0.0, 9.0), -Vec3::Z)).unwrap();
    // v grows by 1/π a unit of length upward: the slope is 0.5/π.
    close(scene.bsdf(&hit, Vec3::Z, 1.0, 0.0).ns(), Vec3::new(0.0, -0.5 / math::PI, 1.0).normalize());
}

#[test]
fn mirrored_coordinates_mirror_a_normal_map() {
    // Tilted by 45° halfway between growing u and growing v.
    let s = |x: f32| (65535.0 * (0.5 + 0.5 * x)).round() as u16;
    let map = picture(1, 1, |_, _| [s(0.5), s(0.5), s(0.5f32.sqrt())]);
    let material = Material { normal_map: Some("t".to_owned().into()), ..Material::diffuse(1.0) };
    let tilted = |u: f32, v: f32| Vec3::new(0.5 * u, 0.5f32.sqrt(), -0.5 * v);
    let with = |uvs| normal(&scene_of(square(uvs), material.clone(), Texture::Image(map.clone())), 0.3, -0.4);
    close(with(None), tilted(1.0, 1.0));
    close(with(Some([[1.0, 0.0], [0.0, 0.0], [0.0, 1.0], [1.0, 1.0]])), tilted(-1.0, 1.0));
    close(with(Some([[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]])), tilted(1.0, -1.0));
    // A mapping that mirrors does the same, and one that turns turns.
    let mapped = |scale, rotation| {
        let mapping = Mapping::Uv { set: 0, scale, rotation, offset: [0.0; 2] };
        let image = Image { mapping, ..map.clone() };
        normal(&scene_of(square(None), material.clone(), Texture::Image(image)), 0.3, -0.4)
    };
    close(mapped([-3.0, 2.0], 0.0), tilted(-1.0, 1.0));
    // Turned coordinates: s = −v, t = u.
    close(mapped([1.0, 1.0], 90.0), tilted(1.0, -1.0));
    // Strength scales slopes.
    let strong = Material { normal_strength: 2.0, ..material.clone() };
    let desc = scene_of(square(None), strong, Texture::Image(map));
    close(normal(&desc, 0.3, -0.4), Vec3::new(1.0, 0.5f32.sqrt(), -1.0).normalize());
    // A metal is bent less: its mirror image of the ray stays above the surface.
    let metal = Material {
        normal_map: Some("t".to_owned().into()),
        normal_strength: 2.0,
        ..MaterialKind::Conductor(metal(0.0)).into()
    };
    let n = normal(&SceneDesc { materials: [("m".to_owned(), metal.into())].into(), ..desc }, 0.3, -0.4);
    assert!((2.0 * n.y * n.y - 1.0 - 0.01).abs() < 1e-4 && (n.x + n.z).abs() < 1e-5 && n.x > 0.0, "{n}");
}

fn metal(alpha: f32) -> Conductor {
    Conductor {
        metal: Metal::Index { n: [0.0; 3], k: [1e4; 3] },
        specular: ColorDesc::from(1.0),
        roughness: Roughness::Alpha { along: alpha.into(), across: alpha.into() },
        facets: Facets::Conserving,
        film: ThinFilm { thickness_nm: 0.0, ior: 1.5 },
    }
}

#[test]
fn rotation_turns_the_tangent_toward_growing_v() {
    let roughness = Roughness::Alpha { along: 0.1.into(), across: 0.6.into() };
    let tangent = |uvs, degrees: FloatDesc| {
        let conductor = Conductor { roughness: roughness.clone(), ..metal(0.0) };
        let material = Material { rotation: degrees, ..MaterialKind::Conductor(conductor).into() };
        let desc = scene_of(square(uvs), material, Texture::checker(30.0, 30.0, [1.0; 2]));
        let (scene, _) = scene::compile(&desc).unwrap();
        let hit = scene.intersect(&Ray::new(Vec3::new(0.3, 9.0, -0.4), -Vec3::Y)).unwrap();
        scene.bsdf(&hit, Vec3::Y, 1.0, 0.0).frame().x
    };
    let (sin, cos) = 30f32.to_radians().sin_cos();
    close(tangent(None, 0.0.into()), Vec3::X);
    close(tangent(None, 30.0.into()), Vec3::new(cos, 0.0, -sin));
    close(tangent(None, FloatDesc::texture("t")), Vec3::new(cos, 0.0, -sin));
    // v the other way round.
    let mirrored = Some([[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]]);
    close(tangent(mirrored, 30.0.into()), Vec3::new(cos, 0.0, sin));
}

/// What a plane under strong bumps returns of a white sky toward `wo`, and the least of any place.
fn returned(material: Material, wo: Vec3) -> (f64, f64) {
    let noise = Noise {
        kind: NoiseKind::Fbm,
        octaves: 4,
        roughness: 0.5,
        transform: vec![TransformStep::Scale([0.1; 3])],
    };
    // Slopes of about a half.
    let material = Material { bump_map: Some("t".to_owned().into()), bump_height: 0.03, ..material };
    let (scene, _) = scene::compile(&scene_of(square(None), material, Texture::Noise(noise))).unwrap();
    let (places, samples) = (300, 200);
    let (mut sum, mut least) = (0.0, f64::INFINITY);
    for place in 0..places {
        let mut s = Sampler::new(1, place, Domain::Other, 0);
        let [x, z] = s.next_2d();
        let hit = scene.intersect(&Ray::new(Vec3::new(x, 9.0, -z), -Vec3::Y)).unwrap();
        let bsdf = scene.bsdf(&hit, wo, 1.0, 0.0);
        let mut here = 0.0;
        for _ in 0..samples {
            let (u_lobe, u) = (s.next_1d(), s.next_2d());
            if let Some(sample) = bsdf.sample(wo, u_lobe, u, TransportMode::Radiance) {
                here += f64::from(sample.weight.mean());
                assert!(sample.wi.dot(hit.ng) * wo.dot(hit.ng) > 0.0, "light from behind");
            }
            let behind = warp::sphere(s.next_2d());
            if behind.dot(hit.ng) * wo.dot(hit.ng) < 0.0 {
                assert!(bsdf.eval(wo, behind, TransportMode::Radiance).is_zero());
            }
        }
        here /= f64::from(samples);
        assert!(here < 1.06, "{here}");
        sum += here;
        least = least.min(here);
    }
    (sum / f64::from(places as u32), least)
}

#[test]
fn bumps_lose_little_light_and_let_none_through() {
    for degrees in [0.0f32, 45.0, 75.0, 87.0] {
        for side in [1.0, -1.0] {
            let (sin, cos) = degrees.to_radians().sin_cos();
            let wo = Vec3::new(sin * 0.8, cos * side, sin * 0.6);
            // A Lambertian plane tilted by θ keeps (1 + cos θ)/2 above the horizon: 85 % at 45°.
            let (diffuse, darkest) = returned(Material::diffuse(1.0), wo);
            assert!(diffuse > 0.92 && darkest > 0.5, "{degrees}: {diffuse} {darkest}");
            // A mirror image lies above the surface wherever it is seen from.
            let (smooth, darkest) = returned(MaterialKind::Conductor(metal(0.0)).into(), wo);
            assert!(smooth > 0.995 && darkest > 0.99, "{degrees}: {smooth} {darkest}");
            let (rough, darkest) = returned(MaterialKind::Conductor(metal(0.2)).into(), wo);
            assert!(rough > 0.8 && darkest > 0.3, "{degrees}: {rough} {darkest}");
        }
    }
}
