//! Rays against Embree: closest hits, one ray at a time, on one thread, in alternating rounds.
#![allow(clippy::print_stdout)] // it reports

use accel::{Bvh, Geometry};
use math::{Frame, PI, Ray, Vec3, offset_ray_origin, spherical_direction};
use sampling::{Domain, Sampler, warp};

use crate::embree::{Embree, EmbreeScene};

/// Seconds of processor time of this thread, which other programs on the machine do not lengthen.
struct Clock(f64);

impl Clock {
    fn start() -> Self {
        Self(Self::now())
    }

    fn now() -> f64 {
        let t = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
        t.tv_sec as f64 + t.tv_nsec as f64 * 1e-9
    }

    fn elapsed_s(&self) -> f64 {
        Self::now() - self.0
    }
}

struct Mesh {
    positions: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
}

/// Measures, prints, and adds `(name, ratio)`, > 1 where we are faster; `quick` takes smaller scenes and fewer rounds.
pub fn run(results: &mut Vec<(String, f64)>, quick: bool) {
    let embree = match Embree::load() {
        Ok(embree) => Some(embree),
        Err(why) => {
            println!("rays: Embree is skipped: {why}");
            None
        }
    };
    let workers = match par::Workers::new(1) {
        Ok(workers) => workers,
        Err(why) => return println!("rays: skipped: {why}"),
    };
    let rounds = if quick { 3 } else { 9 };
    let room = room(if quick { 24 } else { 104 });
    let eye = Vec3::new(-8.5, -8.0, 1.0);
    let mut builds = Vec::new();
    let side = if quick { 256 } else { 512 };
    let bench = Bench { embree: embree.as_ref(), rounds, one_thread: workers };
    bench.scene("room", &room, eye, Vec3::new(2.0, 1.5, -0.3), side, true, results, &mut builds);
    let ball = displaced(if quick { 5 } else { 8 });
    bench.scene("displaced", &ball, Vec3::new(0.0, -3.0, 0.8), Vec3::ZERO, side, false, results, &mut builds);
    if !builds.is_empty() {
        results.push(("rays.build.vs_embree".into(), median(builds)));
    }
}

struct Bench<'a> {
    embree: Option<&'a Embree>,
    rounds: usize,
    one_thread: par::Workers,
}

impl Bench<'_> {
    fn scene(
        &self,
        name: &str,
        mesh: &Mesh,
        eye: Vec3,
        target: Vec3,
        side: usize,
        closed: bool,
        results: &mut Vec<(String, f64)>,
        builds: &mut Vec<f64>,
    ) {
        let (mut ours_s, mut theirs_s) = (Vec::new(), Vec::new());
        let (mut bvh, mut peer): (Option<Bvh>, Option<EmbreeScene<'_>>) = (None, None);
        for _ in 0..self.rounds.min(3) {
            // The old tree goes first, so that both have the same memory.
            drop(bvh.take());
            let (built, seconds) = self.one_thread.run(|| {
                let clock = Clock::start();
                let mut geometry = Geometry::new();
                geometry.add_triangles(&mesh.positions, &mesh.triangles);
                let built = Bvh::build(geometry);
                (built, clock.elapsed_s())
            });
            bvh = Some(built);
            ours_s.push(seconds);
            if let Some(embree) = self.embree {
                drop(peer.take());
                let clock = Clock::start();
                peer = Some(embree.scene(&mesh.positions, &mesh.triangles));
                theirs_s.push(clock.elapsed_s());
            }
        }
        let Some(bvh) = bvh else { return };
        println!("rays.{name}: {} triangles, {} MB", mesh.triangles.len(), bvh.memory_bytes() / 1_000_000);
        builds.extend(theirs_s.iter().zip(&ours_s).map(|(t, o)| t / o));
        println!("  build: {:.2} s, Embree {:.2} s", median(ours_s), median(theirs_s));
        let camera = camera_rays(eye, target, side);
        let bounces = bounce_rays(mesh, &bvh, &camera);
        for (kind, rays) in [("camera", &camera), ("incoherent", &bounces)] {
            let (ratio, lost) = self.compare(rays, &bvh, peer.as_ref(), closed);
            if let Some(ratio) = ratio {
                println!("  {kind}: {ratio:.3} of Embree");
                results.push((format!("rays.{name}.{kind}.vs_embree_robust"), ratio));
            }
            if closed {
                results.push((format!("rays.{name}.{kind}.lost"), lost as f64));
            }
        }
    }

    /// Median ratio of the times of alternating rounds, and rays without a hit.
    fn compare(
        &self,
        rays: &[Ray],
        bvh: &Bvh,
        peer: Option<&EmbreeScene<'_>>,
        closed: bool,
    ) -> (Option<f64>, usize) {
        let (mut ours, mut theirs, mut ratios) = (Vec::new(), Vec::new(), Vec::new());
        let (mut hits, mut peer_hits) = (0, 0);
        for _ in 0..self.rounds {
            let clock = Clock::start();
            hits = rays.iter().filter(|r| bvh.closest(r).is_some()).count();
            let own = clock.elapsed_s();
            ours.push(rays.len() as f64 / own * 1e-6);
            if let Some(peer) = peer {
                let clock = Clock::start();
                peer_hits = rays.iter().filter(|r| peer.closest(r).is_some()).count();
                let other = clock.elapsed_s();
                theirs.push(rays.len() as f64 / other * 1e-6);
                ratios.push(other / own);
            }
        }
        let lost = if closed { rays.len() - hits } else { 0 };
        println!("  {} rays: {:.2} M/s, {hits} hits, {lost} lost", rays.len(), median(ours));
        if peer.is_some() {
            println!("    Embree: {:.2} M/s, {peer_hits} hits", median(theirs));
            let verdict = if hits == peer_hits { "equal" } else { "DIFFERENT" };
            println!("    hit counts: {verdict}");
        }
        (peer.map(|_| median(ratios)), lost)
    }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

/// A closed box of side 20 with 23 wrinkled balls of 4n² triangles each: a million for n = 104.
fn room(n: usize) -> Mesh {
    let mut mesh = Mesh { positions: Vec::new(), triangles: Vec::new() };
    let corner = |i: u32| Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32) * 20.0 - 10.0;
    mesh.positions.extend((0..8).map(corner));
    for [a, b, c, d] in [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]] {
        mesh.triangles.extend([[a, b, c], [a, c, d]]);
    }
    let mut u = Sampler::new(1, 0, Domain::Other, 0);
    for _ in 0..23 {
        let center = Vec3::new(u.next_1d(), u.next_1d(), u.next_1d()) * 16.0 - 8.0;
        let (radius, bumps) = (0.5 + 1.5 * u.next_1d(), 3.0 + 12.0 * u.next_1d());
        let base = mesh.positions.len() as u32;
        for i in 0..=n {
            for j in 0..=2 * n {
                let (theta, phi) = (PI * i as f32 / n as f32, PI * j as f32 / n as f32);
                let r = radius * (1.0 + 0.08 * (bumps * theta).sin() * (bumps.floor() * phi).sin());
                mesh.positions.push(center + spherical_direction(theta.cos(), phi) * r);
            }
        }
        let row = 2 * n as u32 + 1;
        for i in 0..n as u32 {
            for j in 0..2 * n as u32 {
                let a = base + i * row + j;
                mesh.triangles.extend([[a, a + 1, a + row], [a + 1, a + row + 1, a + row]]);
            }
        }
    }
    mesh
}

/// An icosahedron, each triangle cut into four `levels` times (1.3 million for 8), displaced in three octaves.
fn displaced(levels: usize) -> Mesh {
    let g = 0.5 * (1.0 + 5f32.sqrt());
    let mut positions: Vec<Vec3> = (0..12)
        .map(|i| {
            let (a, b) = (if i & 1 == 0 { 1.0 } else { -1.0 }, if i & 2 == 0 { g } else { -g });
            [Vec3::new(a, b, 0.0), Vec3::new(0.0, a, b), Vec3::new(b, 0.0, a)][i / 4].normalize()
        })
        .collect();
    // Faces: all triples of corners at the edge's distance.
    let near = |a: usize, b: usize| positions[a].distance(positions[b]) < 1.2;
    let mut triangles = Vec::new();
    for a in 0..12 {
        for b in a + 1..12 {
            triangles
                .extend((b + 1..12).filter(|&c| near(a, b) && near(b, c) && near(c, a)).map(|c| [a, b, c]));
        }
    }
    let mut triangles: Vec<[u32; 3]> = triangles.into_iter().map(|t| t.map(|i| i as u32)).collect();
    for _ in 0..levels {
        let mut middles = std::collections::HashMap::new();
        let mut middle = |a: u32, b: u32| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                positions.push((positions[a as usize] + positions[b as usize]).normalize());
                positions.len() as u32 - 1
            })
        };
        triangles = triangles
            .iter()
            .flat_map(|&[a, b, c]| {
                let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
                [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
            })
            .collect();
    }
    for p in &mut positions {
        let octave = |f: f32| (f * p.x).sin() * (f * p.y + 1.0).sin() * (f * p.z + 2.0).cos() / f;
        *p *= 1.0 + 2.0 * (octave(5.0) + octave(19.0) + octave(71.0));
    }
    Mesh { positions, triangles }
}

/// A pinhole's rays, row by row.
fn camera_rays(eye: Vec3, target: Vec3, side: usize) -> Vec<Ray> {
    let forward = (target - eye).normalize();
    let right = forward.cross(Vec3::Z).normalize();
    let up = right.cross(forward);
    let at = |i: usize| (i as f32 + 0.5) / side as f32 * 2.0 - 1.0;
    (0..side * side)
        .map(|i| Ray::new(eye, forward + 0.45 * (right * at(i % side) - up * at(i / side))))
        .collect()
}

/// Four diffuse bounces one after the other, from where the camera's rays hit; those of a depth lie side by side.
fn bounce_rays(mesh: &Mesh, bvh: &Bvh, camera: &[Ray]) -> Vec<Ray> {
    let mut rays = Vec::new();
    let mut front: Vec<Ray> = camera.iter().step_by(2).copied().collect();
    for depth in 0..4 {
        let bounce = |(i, ray): (usize, &Ray)| {
            let hit = bvh.closest(ray)?;
            let [a, b, c] = mesh.triangles[hit.prim as usize].map(|i| mesh.positions[i as usize]);
            let n = (b - a).cross(c - a).try_normalize()?;
            let n = if n.dot(ray.direction) > 0.0 { -n } else { n };
            let p = a * (1.0 - hit.u - hit.v) + b * hit.u + c * hit.v;
            let mut u = Sampler::new(2, depth, Domain::Other, i as u64);
            let w = Frame::from_z(n).to_world(warp::cosine_hemisphere(u.next_2d()));
            let error = (a.abs() + b.abs() + c.abs()).max_element() * math::gamma(7);
            Some(Ray::new(offset_ray_origin(p, error, n, w), w))
        };
        front = front.iter().enumerate().filter_map(bounce).collect();
        rays.extend_from_slice(&front);
    }
    rays
}
