//! Photon searches against nanoflann (C++) and kiddo: points on the walls of a box, one thread, rounds in turn.
#![allow(clippy::print_stdout)] // the table is the output

use std::fmt::Display;
use std::num::NonZero;
use std::path::{Path, PathBuf};
use std::time::Instant;

use kiddo::{ImmutableKdTree, SquaredEuclidean};
use math::Vec3;
use photons::{KdTree, Kernel, Photon, PhotonFlags, PhotonMap, Query, Scratch};
use sampling::{Domain, Sampler};

use crate::nanoflann::Nanoflann;

/// Runs all of it and appends (name, ratio); a ratio above 1 says that we are faster.
///
/// # Errors
/// Where a peer's answers differ from ours, or a thread cannot be started.
pub fn run(results: &mut Vec<(String, f64)>, quick: bool) -> Result<(), String> {
    let one = par::Workers::new(1)?;
    let two = par::Workers::new(2)?;
    let sizes: &[(usize, &str)] =
        if quick { &[(200_000, "search")] } else { &[(1_000_000, "search"), (5_000_000, "search.5m")] };
    for &(count, prefix) in sizes {
        let rounds = if quick { 3 } else { 5 };
        let data = Data::new(count, rounds);
        println!("search: {count} points on the walls of a box, one thread, medians of {rounds} rounds");
        let nanoflann = match Nanoflann::start(&data.points, &data.queries) {
            Ok(peer) => Some(peer),
            Err(why) => {
                println!("  nanoflann skipped: {why}");
                None
            }
        };
        one.run(|| compare(&data, nanoflann, prefix, results))?;
        if prefix == "search" {
            threads(&data, &one, &two, results);
            map(&data, &one, results);
        }
    }
    Ok(())
}

/// Queries of each kind in a round; the slower kinds ask fewer.
const K100: usize = 4000;
const K500: usize = 1000;
const RADIUS: usize = 8000;

struct Data {
    points: Vec<Vec3>,
    queries: Vec<Vec3>,
    rounds: usize,
    /// Radius with about 88 hits.
    radius: f32,
}

impl Data {
    fn new(count: usize, rounds: usize) -> Self {
        let walls = |path, n| {
            let mut s = Sampler::new(1, 0, Domain::Other, path);
            (0..n).map(|_| on_walls(&mut s)).collect::<Vec<_>>()
        };
        let density = count as f32 / 6.0;
        let radius = (88.0 / (std::f32::consts::PI * density)).sqrt();
        Self { points: walls(0, count), queries: walls(1, rounds * RADIUS), rounds, radius }
    }

    fn queries(&self, round: usize, count: usize) -> &[Vec3] {
        &self.queries[round * RADIUS..][..count]
    }
}

/// Uniform on the faces of the unit cube.
fn on_walls(s: &mut Sampler) -> Vec3 {
    let face = s.next_u32() % 6;
    let [u, v] = s.next_2d();
    let w = (face & 1) as f32;
    match face / 2 {
        0 => Vec3::new(w, u, v),
        1 => Vec3::new(u, w, v),
        _ => Vec3::new(u, v, w),
    }
}

/// Seconds of each round, of us and of the peers.
#[derive(Default)]
struct Times {
    ours: Vec<f64>,
    nanoflann: Vec<f64>,
    kiddo: Vec<f64>,
}

fn median(times: &mut [f64]) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

impl Times {
    /// Prints a line and appends the ratios.
    fn report(mut self, name: &str, count: usize, results: &mut Vec<(String, f64)>) {
        let ours = median(&mut self.ours);
        let mut line = format!("  {name:<18} ours {:>9}", rate(count, ours));
        for (peer, times) in [("nanoflann", &mut self.nanoflann), ("kiddo", &mut self.kiddo)] {
            if !times.is_empty() {
                let theirs = median(times);
                line += &format!("   {peer} {:>9} ({:.2}x)", rate(count, theirs), theirs / ours);
                results.push((format!("{name}.vs_{peer}"), theirs / ours));
            }
        }
        println!("{line}");
    }
}

fn rate(count: usize, seconds: f64) -> String {
    if count == 1 { format!("{seconds:.3} s") } else { format!("{:.1} k/s", count as f64 / seconds / 1e3) }
}

/// Seconds of processor time of this thread, which other programs on the machine do not lengthen.
fn clock<R>(f: impl FnOnce() -> R) -> (f64, R) {
    let now = || {
        let t = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
        t.tv_sec as f64 + t.tv_nsec as f64 * 1e-9
    };
    let start = now();
    let result = f();
    (now() - start, result)
}

/// Seconds by the wall clock.
fn wall_clock(f: impl FnOnce() -> f64) -> f64 {
    let start = Instant::now();
    std::hint::black_box(f());
    start.elapsed().as_secs_f64()
}

/// Sums agree to the rounding of distances.
fn agree(what: &str, ours: f64, theirs: f64) -> Result<(), String> {
    if (ours - theirs).abs() <= 1e-5 * ours.abs() {
        return Ok(());
    }
    Err(format!("{what} differs: ours {ours}, theirs {theirs}"))
}

fn compare(
    data: &Data,
    mut nanoflann: Option<Nanoflann>,
    prefix: &str,
    results: &mut Vec<(String, f64)>,
) -> Result<(), String> {
    let mut build = Times::default();
    let arrays: Vec<[f32; 3]> = data.points.iter().map(Vec3::to_array).collect();
    let (mut tree, mut kiddo) = (None, None);
    for _ in 0..data.rounds.min(5) {
        tree = None;
        let (time, built) = clock(|| KdTree::build(&data.points).0);
        (build.ours, tree) = (with(build.ours, time), Some(built).or(tree));
        if let Some(peer) = &mut nanoflann {
            build.nanoflann.push(peer.build()?);
        }
        kiddo = None;
        let (time, built) = clock(|| ImmutableKdTree::<f32, 3>::new_from_slice(&arrays));
        (build.kiddo, kiddo) = (with(build.kiddo, time), Some(built.map_err(display)?).or(kiddo));
    }
    let (Some(tree), Some(kiddo)) = (tree, kiddo) else { return Ok(()) };
    build.report(&format!("{prefix}.build"), 1, results);

    for (k, count, name) in [(100, K100, "k100"), (500, K500, "k500")] {
        if let Some(peer) = &mut nanoflann {
            peer.choose_knn(k, count / 4)?;
        }
        let mut times = Times::default();
        let mut scratch = Scratch::new();
        let Some(peers_k) = NonZero::new(k) else { continue };
        for round in 0..data.rounds {
            let queries = data.queries(round, count);
            let (time, ours) = clock(|| {
                let kth = |&q| tree.nearest(q, k, f32::INFINITY, &mut scratch).kth();
                queries.iter().map(kth).map(|h| h.map_or(0.0, |h| f64::from(h.distance2).sqrt())).sum::<f64>()
            });
            times.ours.push(time);
            if let Some(peer) = &mut nanoflann {
                let (time, theirs) = peer.knn(k, round * RADIUS, count)?;
                times.nanoflann.push(time);
                agree("nanoflann's sum of k-th distances", ours, theirs)?;
            }
            let (time, theirs) = clock(|| {
                let kth = |q: &Vec3| {
                    let query = q.to_array();
                    let found = kiddo.query(&query).nearest_n::<SquaredEuclidean<f32>>(peers_k).execute();
                    found.last().map_or(0.0, |h| f64::from(h.distance).sqrt())
                };
                queries.iter().map(kth).sum::<f64>()
            });
            times.kiddo.push(time);
            agree("kiddo's sum of k-th distances", ours, theirs)?;
        }
        times.report(&format!("{prefix}.{name}"), count, results);
    }

    if let Some(peer) = &mut nanoflann {
        peer.choose_radius(data.radius, RADIUS / 4)?;
    }
    let mut times = Times::default();
    let mut hits = 0;
    for round in 0..data.rounds {
        let queries = data.queries(round, RADIUS);
        let (time, ours) = clock(|| {
            let (mut count, mut sum) = (0u64, 0f64);
            for &q in queries {
                tree.within(q, data.radius, |h| {
                    count += 1;
                    sum += f64::from(h.distance2);
                });
            }
            (count, sum)
        });
        times.ours.push(time);
        hits += ours.0;
        if let Some(peer) = &mut nanoflann {
            let (time, count, sum) = peer.radius(data.radius, round * RADIUS, RADIUS)?;
            times.nanoflann.push(time);
            agree("nanoflann's hits", ours.0 as f64, count)?;
            agree("nanoflann's sum of distances", ours.1, sum)?;
        }
        let (time, theirs) = clock(|| {
            let (mut count, mut sum) = (0u64, 0f64);
            for q in queries {
                let r2 = data.radius * data.radius;
                let query = q.to_array();
                kiddo.query(&query).within::<SquaredEuclidean<f32>>(r2).unsorted().visit(|h| {
                    count += 1;
                    sum += f64::from(h.distance);
                });
            }
            (count, sum)
        });
        times.kiddo.push(time);
        agree("kiddo's hits", ours.0 as f64, theirs.0 as f64)?;
        agree("kiddo's sum of distances", ours.1, theirs.1)?;
    }
    times.report(&format!("{prefix}.radius"), RADIUS, results);
    println!("  (fixed radius: {:.1} hits a query)", hits as f64 / (data.rounds * RADIUS) as f64);
    Ok(())
}

fn with(mut times: Vec<f64>, time: f64) -> Vec<f64> {
    times.push(time);
    times
}

fn display(e: impl Display) -> String {
    e.to_string()
}

/// k = 100 on two threads over one.
fn threads(data: &Data, one: &par::Workers, two: &par::Workers, results: &mut Vec<(String, f64)>) {
    let (tree, _) = two.run(|| KdTree::build(&data.points));
    let sum = || -> f64 {
        let chunks = par::map_chunks(data.queries.len(), 256, |range| {
            let mut scratch = Scratch::new();
            let kth = |&q| tree.nearest(q, 100, f32::INFINITY, &mut scratch).kth();
            data.queries[range]
                .iter()
                .map(kth)
                .map(|h| h.map_or(0.0, |h| f64::from(h.distance2)))
                .sum::<f64>()
        });
        chunks.iter().sum()
    };
    let (mut single, mut double) = (Vec::new(), Vec::new());
    for _ in 0..7 {
        single.push(wall_clock(|| one.run(sum)));
        double.push(wall_clock(|| two.run(sum)));
    }
    let ratio = median(&mut single) / median(&mut double);
    println!("  two threads over one: {ratio:.2}x");
    results.push(("threads.search".into(), ratio));
}

/// The photon map itself: memory, and rates with the test of side, normal and flatness in the search.
fn map(data: &Data, one: &par::Workers, results: &mut Vec<(String, f64)>) {
    let inward = |p: Vec3| {
        let d = Vec3::splat(0.5) - p;
        let a = d.abs();
        if a.x >= a.y && a.x >= a.z {
            Vec3::X * d.x.signum()
        } else if a.y >= a.z {
            Vec3::Y * d.y.signum()
        } else {
            Vec3::Z * d.z.signum()
        }
    };
    let photon = |&position: &Vec3| {
        let normal = inward(position);
        Photon {
            position,
            direction: normal,
            normal,
            power: color::Lanes::ONE,
            depth: 0,
            flags: PhotonFlags::NONE,
        }
    };
    let photons: Vec<Photon> = data.points.iter().map(photon).collect();
    let (time, map) = one.run(|| clock(|| PhotonMap::build(photons)));
    println!("  photon map: built in {time:.3} s, {:.2} bytes a photon", map.bytes_per_photon());
    results.push(("search.memory.vs_40_bytes".into(), 40.0 / map.bytes_per_photon()));
    let mut scratch = Scratch::new();
    let mut sum = 0.0;
    for (name, k, count) in [("knn 100", 100, K100), ("knn 500", 500, K500), ("radius", 0, RADIUS)] {
        let mut times = Vec::new();
        for round in 0..data.rounds {
            let (time, ()) = clock(|| {
                for &position in data.queries(round, count) {
                    let (normal, kernel) = (inward(position), Kernel::Epanechnikov);
                    if k == 0 {
                        let query = Query { position, normal, radius: data.radius, kernel };
                        map.gather(&query, |p, w| sum += p.power.max() * w * p.direction().z);
                    } else {
                        let query = Query { position, normal, radius: 1.0, kernel };
                        map.gather_knn(&query, k, &mut scratch, |p, w| {
                            sum += p.power.max() * w * p.direction().z
                        });
                    }
                }
            });
            times.push(time);
        }
        println!("  photon map, {name}: {}", rate(count, median(&mut times)));
    }
    std::hint::black_box(sum);
}

/// Files and program of a peer, in a folder of the system's that is removed at the end.
pub(crate) fn scratch_dir(name: &str) -> std::io::Result<PathBuf> {
    let dir = std::env::temp_dir().join(format!("nephroid-{name}-{}", std::process::id()));
    std::fs::create_dir_all(&dir)?;
    Ok(dir)
}

/// Writes points as native floats.
pub(crate) fn write_points(path: &Path, points: &[Vec3]) -> std::io::Result<()> {
    let bytes: Vec<u8> = points.iter().flat_map(|p| p.to_array()).flat_map(f32::to_ne_bytes).collect();
    std::fs::write(path, bytes)
}
