//! The weights of vertex connection and merging, from three numbers a vertex, against the densities of all techniques
//! written out for whole paths; and their sum over the techniques of a path, which is 1.
#![allow(clippy::unwrap_used, reason = "helpers of tests, too")]

mod explicit;

use bsdf::{Lobes, TransportMode};
use color::Lanes;
use math::{Ray, Vec2, offset_ray_origin};
use nephroid_transport::{
    Connections, EyeEnd, LightClass, LightDensities, LightVertex, MergingWeights, PathVertex, Scattering,
    Subpath, SubpathMis, Walk, connect, connect_light, emission_against_all, escape_against_all, project,
};
use sampling::{Domain, Sampler};
use scene::camera::WePdf;
use scene::{LightId, Scene};
use scenefile::SceneDesc;
use scenefile::desc::{
    Camera, CameraKind, Emission, Light, LightKind, Material, Object, PointAmount, Shape, SkyMapping, Texture,
};

use explicit::{Explicit, FullPath, LightPoint, Node, ratio, survival};

/// η and camera paths for each light path and pixel, as a render would have them.
const ETA: f64 = 0.8;
const FILM_DENSITY: f64 = 0.25;
/// Relative; the numbers are stored in `f32`, the densities of narrow lobes vary within its rounding.
const TOLERANCE: f64 = 1e-3;

fn ball(center: [f32; 3], material: Material) -> Object {
    Object::new(Shape::Sphere { center, radius: 0.4 }, material)
}

/// A room of diffuse, rough, coated, mirroring and refracting things with one kind of light; an open one for lights at
/// infinity.
fn room(
    lens: CameraKind,
    lamps: impl IntoIterator<Item = Object>,
    lights: impl IntoIterator<Item = LightKind>,
) -> Scene {
    let wall =
        |origin, edge_u, edge_v| Object::new(Shape::Quad { origin, edge_u, edge_v }, Material::diffuse(0.7));
    let mut objects = vec![
        wall([-2.0, 0.0, 2.0], [4.0, 0.0, 0.0], [0.0, 0.0, -4.0]),
        wall([-2.0, 0.0, -2.0], [4.0, 0.0, 0.0], [0.0, 3.0, 0.0]),
        wall([-2.0, 0.0, 2.0], [0.0, 0.0, -4.0], [0.0, 3.0, 0.0]),
        ball([-1.2, 0.45, 0.0], Material::mirror(0.9)),
        ball([-0.4, 0.45, 0.5], Material::dielectric(1.5)),
        ball([0.4, 0.45, 0.0], Material::conductor("gold", 0.5)),
        ball([1.2, 0.45, 0.4], Material::plastic(0.6, 0.0)),
        ball([0.8, 1.3, -0.6], Material::plastic(0.6, 0.4)),
        ball([-0.8, 1.3, -0.6], Material::phong([0.4; 3], [0.4; 3], 15.0)),
    ];
    objects.extend(lamps);
    // Among the things, where all directions are seen.
    let away = if let CameraKind::Spherical { .. } = lens { 1.4 } else { 3.4 };
    let camera = Camera {
        kind: lens,
        position: [0.0, 1.4, away],
        look_at: [0.0, 0.8, 0.0],
        fov: 50.0,
        ..Camera::default()
    };
    let mut desc = SceneDesc {
        camera: Some(camera.into()),
        objects: objects.into_iter().map(Into::into).collect(),
        lights: lights.into_iter().map(|kind| Light::from(kind).into()).collect(),
        ..SceneDesc::default()
    };
    desc.film.size = [32, 24];
    desc.textures.insert("pattern".into(), Texture::checker([3.0, 1.0, 0.5], 0.2, [3.0; 2]).into());
    scene::compile(&desc).unwrap().0
}

/// A subpath as it was walked: its vertices, the numbers that the walk had there, and whether each event was a delta
/// lobe's.
#[derive(Default)]
struct Walked {
    vertices: Vec<PathVertex>,
    specular: Vec<bool>,
}

/// Walks up to `most` vertices; calls `f` at each (and after the last with `None`, where the scene was left).
fn walk(
    path: &mut Subpath<'_>,
    most: usize,
    sampler: &mut Sampler,
    mut f: impl FnMut(&Walked, &Subpath<'_>, Option<&PathVertex>, &mut Sampler),
) -> Walked {
    let mut walked = Walked::default();
    while walked.vertices.len() < most {
        let vertex = path.next_vertex();
        f(&walked, path, vertex.as_ref(), sampler);
        let Some(at) = vertex else { break };
        walked.vertices.push(at);
        let Some(scattered) = path.scatter(&at, Lobes::ALL, sampler) else { break };
        walked.specular.push(scattered.lobes.contains(Lobes::SPECULAR));
    }
    walked
}

fn light_subpath<'s>(scene: &'s Scene, sampler: &mut Sampler) -> Option<(LightPoint, Subpath<'s>)> {
    let (index, pmf, u_pick) = scene.global_picker().sample(sampler.next_1d());
    let id = LightId(index as u32);
    let le = scene.sample_le(id, u_pick, sampler.next_2d(), sampler.next_2d())?;
    assert!(pmf > 0.0);
    let ray = Ray::new(offset_ray_origin(le.p, le.p_error, le.n, le.w), le.w);
    let walk = Walk::new(scene, TransportMode::Importance, ray, Lanes::ONE, scene.light_medium(id));
    let subpath = Subpath::from_light(walk, id, le, Connections::Made);
    Some((LightPoint::of_emission(scene, id, &le), subpath))
}

/// What was compared.
#[derive(Default, Debug)]
struct Tally {
    emission: usize,
    direct: usize,
    connection: usize,
    merge: usize,
    projection: usize,
    walked: usize,
}

/// Planted errors: factors, 1 where there is none.
#[derive(Clone, Copy)]
struct Fault {
    /// On one number of the recursion.
    recursion: f32,
    /// On the expected number of light samples.
    lights: f64,
}

impl Fault {
    const NONE: Self = Self { recursion: 1.0, lights: 1.0 };
}

struct Checker<'s> {
    scene: &'s Scene,
    tally: Tally,
    fault: Fault,
}

fn merging(vertex: &nephroid_transport::Vertex) -> f64 {
    if vertex.bsdf.lobes().contains(Lobes::TRANSMISSION) { 0.0 } else { 1.0 }
}

fn close(found: f64, expected: f64) -> bool {
    (found - expected).abs() <= TOLERANCE * expected.abs().max(1e-3)
}

impl Checker<'_> {
    /// The recursion over a whole path from its light: what a light path would have at each vertex.
    fn as_light_path(&self, path: &FullPath) -> Vec<SubpathMis> {
        let first = &path.nodes[0];
        let start =
            LightDensities::of_start(self.scene, path.light.id, &path.light.le, &first.vertex.receiver());
        self.along(
            path.nodes.iter().collect(),
            start.start(Connections::Made),
            |n| (n.to_light, n.to_camera),
            1.0,
        )
    }

    /// The same from the camera, in the order of the walk.
    fn as_eye_path(&self, path: &FullPath) -> Vec<SubpathMis> {
        let nodes: Vec<&Node> = path.nodes.iter().rev().collect();
        let first = nodes[0];
        let pdf = self.scene.camera().pdf_we(path.lens, -first.to_camera).times(FILM_DENSITY);
        let d2 = match pdf {
            WePdf::PerSteradian(_) => f64::from(path.lens.distance_squared(first.vertex.hit.p)),
            WePdf::PerArea(_) => 1.0,
        };
        self.along(nodes, SubpathMis::of_camera(pdf.across(1.0)), |n| (n.to_camera, n.to_light), d2)
    }

    fn along(
        &self,
        nodes: Vec<&Node>,
        start: SubpathMis,
        ways: impl Fn(&Node) -> (math::Vec3, math::Vec3),
        first_d2: f64,
    ) -> Vec<SubpathMis> {
        let (mut leaving, mut d2) = (start, first_d2);
        let mut all = Vec::new();
        for (i, node) in nodes.iter().enumerate() {
            let (back, on) = ways(node);
            let cos = |w: math::Vec3| f64::from(node.vertex.hit.ng.dot(w).abs());
            let mut arrived = leaving.arrived(d2, cos(back));
            arrived.merges *= self.fault.recursion;
            all.push(arrived);
            leaving = if node.specular {
                arrived.passed(cos(on) * ratio(&node.vertex, back, on))
            } else {
                let density = |wo, wi, mode| {
                    f64::from(node.vertex.bsdf.pdf_w(wo, wi, mode)) * survival(&node.vertex, wo)
                };
                let event = Scattering {
                    cos: cos(on),
                    forward: density(back, on, TransportMode::Radiance),
                    reverse: density(on, back, TransportMode::Radiance),
                    merging: merging(&node.vertex),
                };
                arrived.scattered(&event, Connections::Made)
            };
            if let Some(next) = nodes.get(i + 1) {
                d2 = f64::from(next.vertex.hit.p.distance_squared(node.vertex.hit.p));
            }
        }
        all
    }

    /// Compares the weight of every technique that may make this path; fails where the sum is not 1.
    fn check(&mut self, path: &FullPath) -> Result<(), String> {
        let explicit = Explicit::new(self.scene, path, ETA, FILM_DENSITY).times_drawn(self.fault.lights);
        let total = explicit.total();
        if !total.is_normal() {
            return Ok(());
        }
        let (light, mut eye) = (self.as_light_path(path), self.as_eye_path(path));
        eye.reverse();
        let m = path.nodes.len();
        let at = |i: usize, wo, mis: &[SubpathMis]| {
            let vertex = &path.nodes[i].vertex;
            PathVertex { vertex: nephroid_transport::Vertex { wo, ..*vertex }, mis: mis[i] }
        };
        // Where the point of the light is not that of a sample, light sampling cannot be called for its weight.
        let uncalled = if path.light.drawn.is_none() { explicit.direct() / total } else { 0.0 };
        let mut sum = uncalled;
        let mut compare = |what: &str, found: f64, density: f64, seen: &mut usize| {
            if density == 0.0 {
                return Ok(());
            }
            sum += found;
            *seen += 1;
            let expected = density / total;
            if close(found, expected) { Ok(()) } else { Err(format!("{what}: {found} for {expected}")) }
        };
        let scene = self.scene;
        // Emission.
        let last = &path.nodes[0];
        let cos = |n: &Node, w| f64::from(n.vertex.hit.ng.dot(w).abs());
        let mut leaving = eye[0];
        if explicit.emission() > 0.0 {
            leaving = if last.specular {
                leaving.passed(cos(last, last.to_light) * ratio(&last.vertex, last.to_camera, last.to_light))
            } else {
                let density = |wo, wi| {
                    f64::from(last.vertex.bsdf.pdf_w(wo, wi, TransportMode::Radiance))
                        * survival(&last.vertex, wo)
                };
                let event = Scattering {
                    cos: cos(last, last.to_light),
                    forward: density(last.to_camera, last.to_light),
                    reverse: density(last.to_light, last.to_camera),
                    merging: merging(&last.vertex),
                };
                leaving.scattered(&event, Connections::Made)
            };
            let end = EyeEnd { from: last.vertex.receiver(), direction: last.to_light, leaving };
            let found = match &path.light.surface {
                Some(vertex) => emission_against_all(scene, &end, vertex, ETA).map(|e| e.weight),
                None => {
                    escape_against_all(scene, end, ETA).find(|e| e.light == path.light.id).map(|e| e.weight)
                }
            };
            // A light that the path did not meet as a surface is met all the same where it is one.
            if let Some(found) = found {
                compare("emission", f64::from(found), explicit.emission(), &mut self.tally.emission)?;
            } else {
                return Ok(());
            }
        }
        // Light sampling.
        if let Some((sampler, unweighted)) = path.light.drawn {
            let mut sampler = sampler;
            let mut met = None;
            connect_light(scene, &at(0, last.to_camera, &eye), ETA, &mut sampler, |direct| {
                if direct.light == path.light.id {
                    met = Some(*direct);
                }
            });
            if let Some(direct) = met {
                let found = direct.radiance.mean() / unweighted;
                compare("direct", f64::from(found), explicit.direct(), &mut self.tally.direct)?;
            } else {
                return Ok(());
            }
        }
        // Connections and merges.
        let neutral = SubpathMis::default();
        for i in 0..m {
            let node = &path.nodes[i];
            if explicit.merge(i) > 0.0 {
                let eye_at = at(i, node.to_camera, &eye);
                let found = MergingWeights::new(&eye_at, ETA).weight(&light[i], node.to_light);
                compare("merge", f64::from(found), explicit.merge(i), &mut self.tally.merge)?;
            }
            if i + 1 < m && explicit.connection(i) > 0.0 {
                let light_at = |mis: SubpathMis| LightVertex {
                    at: PathVertex { mis, ..at(i, node.to_light, &light) },
                    flux: Lanes::ONE,
                    depth: 0,
                    class: LightClass::default(),
                    light: path.light.id,
                    u_lens: path.u_lens,
                };
                let eye_at =
                    |mis: SubpathMis| PathVertex { mis, ..at(i + 1, path.nodes[i + 1].to_camera, &eye) };
                // Without anything that competes the weight is 1.
                let whole = connect(scene, &eye_at(neutral), &light_at(neutral), 0.0);
                let part = connect(scene, &eye_at(eye[i + 1]), &light_at(light[i]), ETA);
                let (Some(whole), Some(part)) = (whole, part) else { return Ok(()) };
                let found = part.max() / whole.max();
                compare("connection", f64::from(found), explicit.connection(i), &mut self.tally.connection)?;
            }
        }
        if explicit.projection() > 0.0 {
            let node = &path.nodes[m - 1];
            let vertex = LightVertex {
                at: at(m - 1, node.to_light, &light),
                flux: Lanes::ONE,
                depth: 0,
                class: LightClass::default(),
                light: path.light.id,
                u_lens: path.u_lens,
            };
            let Some((projection, _)) = project(scene, &vertex) else { return Ok(()) };
            let found = projection.weight(ETA, FILM_DENSITY);
            compare("projection", f64::from(found), explicit.projection(), &mut self.tally.projection)?;
        }
        if close(sum, 1.0) { Ok(()) } else { Err(format!("the weights sum to {sum}")) }
    }

    /// The numbers that walks have are those of the recursion over whole paths.
    fn check_walk(&mut self, path: &FullPath, light: &Walked, eye: &Walked) -> Result<(), String> {
        let same = |found: f32, expected: f32| {
            (f64::from(found) - f64::from(expected)).abs() <= TOLERANCE * f64::from(expected).max(1e-6)
        };
        let from_light = self.as_light_path(path);
        let from_camera = self.as_eye_path(path);
        for (walked, expected) in [(light, from_light), (eye, from_camera)] {
            for (at, e) in walked.vertices.iter().zip(expected) {
                self.tally.walked += 1;
                let f = at.mis;
                if !(same(f.edge, e.edge) && same(f.rest, e.rest) && same(f.merges, e.merges)) {
                    return Err(format!("the walk has {f:?}, the path {e:?}"));
                }
            }
        }
        Ok(())
    }
}

/// Random paths of a scene, each found by emission, light sampling or a connection.
fn check_scene(scene: &Scene, paths: u64, fault: Fault) -> Result<Tally, String> {
    let mut checker = Checker { scene, tally: Tally::default(), fault };
    for index in 0..paths {
        let mut sampler = Sampler::new(7, 0, Domain::Other, index);
        let light = light_subpath(scene, &mut sampler).map(|(point, mut subpath)| {
            let most = 1 + (sampler.next_1d() * 3.0) as usize;
            (point, walk(&mut subpath, most, &mut sampler, |_, _, _, _| ()))
        });
        let u_lens = sampler.next_2d();
        let film = Vec2::new(32.0 * sampler.next_1d(), 24.0 * sampler.next_1d());
        let ray = scene.camera().sample_we(film, u_lens).ray;
        let camera =
            Walk::new(scene, TransportMode::Radiance, ray, Lanes::ONE, scene.camera_medium(ray.origin));
        let density = scene.camera().pdf_we(ray.origin, ray.direction).times(FILM_DENSITY);
        let mut eye = Subpath::from_camera(camera, density, Connections::Made);
        let mut failed = Ok(());
        walk(&mut eye, 4, &mut sampler, |walked, subpath, vertex, sampler| {
            let run = |checker: &mut Checker<'_>| -> Result<(), String> {
                for path in FullPath::at_light(scene, walked, subpath, vertex, ray.origin, u_lens) {
                    checker.check(&path)?;
                }
                let Some(at) = vertex.filter(|at| !at.vertex.bsdf.is_delta_only()) else { return Ok(()) };
                for path in FullPath::by_light_sampling(scene, walked, at, ray.origin, u_lens, *sampler) {
                    checker.check(&path)?;
                }
                let Some((point, light)) = &light else { return Ok(()) };
                if let Some(path) =
                    FullPath::by_connection(scene, walked, at, point, light, ray.origin, u_lens)
                {
                    checker.check(&path)?;
                    let upto = Walked {
                        vertices: walked.vertices.iter().chain([at]).copied().collect(),
                        specular: Vec::new(),
                    };
                    checker.check_walk(&path, light, &upto)?;
                }
                Ok(())
            };
            if failed.is_ok() {
                failed = run(&mut checker);
            }
        });
        failed.map_err(|e| format!("path {index}: {e}"))?;
    }
    Ok(checker.tally)
}

fn scenes() -> Vec<(&'static str, Scene)> {
    let pinhole = CameraKind::Pinhole;
    let lens = CameraKind::ThinLens { lens_radius: 0.1, focus_distance: Some(3.0) };
    let parallel = CameraKind::Orthographic { extent: 3.0 };
    let all_around = CameraKind::Spherical { mapping: SkyMapping::LatLong };
    let glow =
        |shape, two_sided| Some(Object::lamp(shape, Emission { two_sided, ..Emission::radiance([3.0; 3]) }));
    let glow_by = |texture: &str, shape| {
        let texture = Some(texture.to_owned().into());
        Some(Object::lamp(shape, Emission { texture, ..Emission::radiance([3.0; 3]) }))
    };
    let disk = Shape::Disk { center: [0.0, 2.8, 0.5], normal: [0.0, -1.0, 0.0], radius: 0.6 };
    let globe = Shape::Sphere { center: [0.3, 2.2, 0.6], radius: 0.3 };
    let quad = Shape::Quad { origin: [-0.5, 2.5, 0.0], edge_u: [1.0, 0.0, 0.0], edge_v: [0.0, 0.2, 1.0] };
    let amount = PointAmount::Intensity([2.0; 3]);
    let point = LightKind::Point { position: [0.2, 2.4, 0.8], amount };
    let spot = LightKind::Spot {
        position: [0.2, 2.6, 1.4],
        direction: [-0.1, -1.0, -0.6],
        cone_angle: 40.0,
        falloff_angle: 15.0,
        amount,
    };
    let sun = LightKind::Directional { direction: [0.3, -1.0, -0.4], irradiance: [1.0; 3] };
    let sky = LightKind::Environment { radiance: [0.5; 3] };
    let many: Vec<Object> = (0..12)
        .filter_map(|i| {
            let (x, z) = (0.4 * i as f32 - 2.0, 0.3 * (i % 5) as f32 - 0.2);
            let disk = Shape::Disk { center: [x, 2.7, z], normal: [0.1 * x, -1.0, 0.0], radius: 0.2 };
            let globe = Shape::Sphere { center: [x, 2.4, z], radius: 0.1 };
            glow(if i % 2 == 0 { disk } else { globe }, i % 4 == 0)
        })
        .collect();
    let few = many[..2].to_vec();
    vec![
        ("disk", room(pinhole, glow(disk.clone(), false), None)),
        ("disk, thin lens", room(lens, glow(disk.clone(), false), None)),
        ("disk, parallel rays", room(parallel, glow(disk.clone(), false), None)),
        ("disk, all directions", room(all_around, glow(disk.clone(), false), None)),
        ("sphere", room(pinhole, glow(globe.clone(), false), None)),
        ("two-sided quad", room(pinhole, glow(quad.clone(), true), None)),
        ("many lamps", room(pinhole, many.clone(), None)),
        ("many lamps and a sky", room(pinhole, many, Some(sky.clone()))),
        ("textured quad", room(pinhole, glow_by("pattern", quad), None)),
        ("textured disk", room(pinhole, glow_by("pattern", disk.clone()), None)),
        ("textured sphere", room(pinhole, glow_by("pattern", globe.clone()), None)),
        ("point", room(pinhole, None, Some(point))),
        ("spot", room(pinhole, None, Some(spot))),
        ("sun and sky", room(pinhole, None, [sun.clone(), sky.clone()])),
        ("sun, sky and two lamps", room(pinhole, few, [sun.clone(), sky.clone()])),
        ("sun", room(pinhole, None, Some(sun))),
        ("sky, thin lens", room(lens, None, Some(sky))),
    ]
}

#[test]
fn recursive_weights_are_the_explicit_ones_and_sum_to_1() {
    for (name, scene) in scenes() {
        // Most of all directions see nothing there.
        let paths = if name.ends_with("all directions") { 3000 } else { 1500 };
        let tally = check_scene(&scene, paths, Fault::NONE).unwrap_or_else(|e| panic!("{name}: {e}"));
        let seen = [tally.direct, tally.connection, tally.merge, tally.projection, tally.walked];
        assert!(seen.iter().all(|&n| n > 200), "{name}: {tally:?}");
        let delta = scene.lights().iter().all(|l| l.is_delta());
        assert!(tally.emission > 50 || delta, "{name}: {tally:?}");
    }
}

/// One per cent in one of the three numbers is found, and in how often lights are sampled.
#[test]
fn a_planted_error_is_found() {
    for (name, scene) in scenes() {
        if ["disk", "sun, sky and two lamps"].contains(&name) {
            assert!(check_scene(&scene, 300, Fault { recursion: 1.01, ..Fault::NONE }).is_err(), "{name}");
            assert!(check_scene(&scene, 300, Fault { lights: 1.01, ..Fault::NONE }).is_err(), "{name}");
        }
    }
}
