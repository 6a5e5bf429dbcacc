//! What photons are worth in a scene: how many paths the default integrator traces each pass. A function of scene and
//! settings alone, so that every worker of a divided render finds the same.

use color::Lanes;
use photons::PhotonMap;
use sampling::{Domain, Strata, Streams};
use scene::Scene;
use transport::{CausticJob, LightLayer, Vertex, Walk};

use crate::auto::{Eye, Merging, RADIUS};
use crate::caustics::trace_caustic_job;
use crate::maps::StoredMap;
use crate::pixels::{Tracer, start};
use crate::radius::{PassRadius, median};
use crate::sink::{Origin, Sink, Source, Sum, Technique};
use crate::{Maps, Settings};

/// Photon paths of the pilot.
const PHOTONS: u64 = 16_384;
/// Pixels of the pilot: so many places of a lattice over the picture, with two eye paths each.
const PIXELS: usize = 2048;
/// Pixels of one task; fixed, so that sums have one shape on any number of threads.
const CHUNK: usize = 128;
/// Blocks of the picture along each side; noise is weighed against the brightness of its block.
const BLOCKS: usize = 8;
/// Part of the picture's mean brightness below which a block counts as no darker.
const DARKEST: f64 = 0.05;
/// Photon paths a pixel that are tried: these powers of √2. With fewer, what the pilot did not see would be left to chance: tracing
/// them costs 1 to 2 % of a pass, looking them up at every D surface 15 to 25 %. More have paid in no trial.
const HALF_POWERS: std::ops::RangeInclusive<i32> = -8..=0;
/// Photons a pixel for which the pilot weights its paths: in the middle of that.
const TYPICAL: f64 = 0.25;
/// Noise of photons over noise of as large a variance that eye paths have in a pilot: it shrinks more slowly with passes, for radii
/// shrink and the numbers of eye paths fill their squares evenly. By trials (docs/book/auto.md).
const LASTING: f64 = 4.0;
/// Most of them: with more, large pictures would only take longer for each pass and more memory.
const MOST: f64 = (1 << 20) as f64;

/// Photon paths of a pass.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plan {
    pub paths: u64,
    /// Median radius of the first pass, in scene units; 0 where nothing is merged.
    pub typical_radius: f32,
}

impl Plan {
    /// As many paths as make noise times time least, up to one a pixel, and none where no photon lands.
    pub fn new(settings: &Settings, scene: &Scene) -> Self {
        let none = Self { paths: 0, typical_radius: 0.0 };
        if scene.targets().is_empty() || settings.max_depth < 2 {
            return none;
        }
        let job = CausticJob {
            count: PHOTONS,
            seed: settings.seed,
            // The eye paths have the numbers of index 0.
            map_index: 1,
            domain: Domain::Pilot,
            max_depth: settings.max_depth,
        };
        let traced = trace_caustic_job(scene, &job);
        if traced.photons.is_empty() {
            return none;
        }
        let (map, order) = PhotonMap::build_ordered(traced.photons);
        let maps = Maps {
            caustic: Some(StoredMap { map, typical_radius: 0.0, max_radius: None }),
            rivals: order.iter().map(|&i| traced.rivals[i as usize]).collect(),
            ..Maps::default()
        };
        let pixels = scene.resolution().map(f64::from).iter().product();
        let seen = look(settings, scene, &maps, pixels);
        Self { paths: paths(pixels, &seen.blocks), typical_radius: median(seen.radii).unwrap_or(0.0) }
    }
}

/// Photon paths for a picture of so many pixels.
fn paths(pixels: f64, blocks: &[Block]) -> u64 {
    let brightness = |block: &Block| block.luminance / f64::from(block.pixels.max(1));
    let seen = blocks.iter().filter(|block| block.pixels > 0);
    let mean = seen.clone().map(brightness).sum::<f64>() / seen.clone().count().max(1) as f64;
    // Means over blocks of the relative error, times the root of what a pass costs: a photon costs as much as an eye path.
    let cost = |per_pixel: f64| {
        let error = |block: &Block| {
            let variance = (block.found + LASTING * block.merged / per_pixel) / f64::from(block.pixels);
            variance.sqrt() / brightness(block).hypot(DARKEST * mean)
        };
        seen.clone().map(error).sum::<f64>() * (1.0 + per_pixel).sqrt()
    };
    let mut best = (2f64.powf(0.5 * f64::from(*HALF_POWERS.start())), f64::INFINITY);
    for half_power in HALF_POWERS {
        let per_pixel = 2f64.powf(0.5 * f64::from(half_power));
        let cost = cost(per_pixel);
        if cost < best.1 {
            best = (per_pixel, cost);
        }
    }
    (pixels * best.0).ceil().min(MOST) as u64
}

/// What the pilot's eye paths found.
struct Seen {
    blocks: Vec<Block>,
    /// Radii at the first surfaces.
    radii: Vec<f32>,
}

impl Seen {
    fn nothing() -> Self {
        Self { blocks: vec![Block::default(); BLOCKS * BLOCKS], radii: Vec::new() }
    }
}

/// What they found in a block of the picture, summed over its pixels.
#[derive(Clone, Copy, Debug, Default)]
struct Block {
    pixels: u32,
    /// Of both paths' mean.
    luminance: f64,
    /// Variance of a path, without what was merged.
    found: f64,
    /// Variance of what a path merges, with one photon path a pixel.
    merged: f64,
}

impl Block {
    fn plus(&self, other: &Self) -> Self {
        Self {
            pixels: self.pixels + other.pixels,
            luminance: self.luminance + other.luminance,
            found: self.found + other.found,
            merged: self.merged + other.merged,
        }
    }
}

/// Pairs of eye paths through a lattice of the picture.
fn look(settings: &Settings, scene: &Scene, maps: &Maps, pixels: f64) -> Seen {
    let radius = RADIUS.of_pass(0, scene.bounds().size().length());
    let photons = Merging::new(maps, radius, (TYPICAL * pixels).ceil() as u64);
    let eye = Eye { photons, max_depth: settings.max_depth };
    // Paths of one pixel are independent.
    let others = Settings { seed: !settings.seed, ..settings.clone() };
    let [width, height] = scene.resolution().map(|n| n as usize);
    let batches = par::map_chunks(PIXELS, CHUNK, |range| {
        let mut seen = Seen::nothing();
        for i in range {
            // Pixels fill the picture evenly, whatever its shape.
            let [u, v] = Strata::new(settings.seed, i as u64).point(0);
            let pixel = [(u * width as f32) as usize, (v * height as f32) as usize];
            let [a, b] = [settings, &others].map(|settings| {
                let streams = Streams::new(settings.seed, 0, Domain::Pilot);
                let mut tally = Tally { radius, found: 0.0, merged: 0.0, squares: 0.0, first: None };
                eye.trace(start(scene, settings, &streams, i as u64, pixel), &mut tally);
                tally
            });
            let block = [u, v].map(|x| (x * BLOCKS as f32) as usize);
            let block = &mut seen.blocks[block[1] * BLOCKS + block[0]];
            *block = block.plus(&Block {
                pixels: 1,
                luminance: 0.5 * (a.found + a.merged + b.found + b.merged),
                found: 0.5 * (a.found - b.found).powi(2),
                // Photons are independent: the variance of a sum is that of its parts, and in the mean the sum of their squares.
                merged: 0.5 * (a.squares + b.squares) * PHOTONS as f64 / pixels,
            });
            seen.radii.extend(a.first);
        }
        seen
    });
    batches.into_iter().fold(Seen::nothing(), |mut sum, seen| {
        sum.blocks.iter_mut().zip(&seen.blocks).for_each(|(sum, block)| *sum = sum.plus(block));
        sum.radii.extend(seen.radii);
        sum
    })
}

/// Takes the light of one eye path, as luminance.
struct Tally {
    radius: PassRadius,
    /// By all techniques but merging.
    found: f64,
    merged: f64,
    /// Of what each photon gave.
    squares: f64,
    /// Radius at the first D surface.
    first: Option<f32>,
}

/// Each part of a sum.
#[derive(Default)]
struct Each(Vec<Lanes>);

impl Sum for Each {
    fn add(&mut self, _source: Source, radiance: Lanes) {
        self.0.push(radiance);
    }

    fn add_split(&mut self, total: Lanes, _each: impl FnOnce(&mut dyn FnMut(Source, Lanes))) {
        self.0.push(total);
    }

    fn plus(mut self, other: Self) -> Self {
        self.0.extend(other.0);
        self
    }

    fn map(mut self, f: impl Fn(Lanes) -> Lanes) -> Self {
        self.0.iter_mut().for_each(|part| *part = f(*part));
        self
    }
}

/// 0 where it is no number: films count those, plans must not.
fn luminance(radiance: Lanes) -> f64 {
    let luminance = f64::from(color::luminance(radiance.to_rgb()));
    if luminance.is_finite() { luminance } else { 0.0 }
}

impl Sink for Tally {
    type Sum = Each;

    fn add(&mut self, _origin: Origin, radiance: Lanes) {
        self.found += luminance(radiance);
    }

    fn add_sum(&mut self, _layer: LightLayer, technique: Technique, sum: Each) {
        for part in sum.0 {
            let luminance = luminance(part);
            match technique {
                Technique::Merge => {
                    self.merged += luminance;
                    self.squares += luminance * luminance;
                }
                Technique::Emission | Technique::Direct | Technique::Connect | Technique::Project => {
                    self.found += luminance;
                }
            }
        }
    }

    fn features(&mut self, _walk: &Walk<'_>, _vertex: &Vertex) {}

    fn density(&mut self, _photons_per_area: f32) {}

    fn reached(&mut self, _walk: &Walk<'_>, vertex: &Vertex) {
        if self.first.is_none() && vertex.bsdf.has_diffuse() {
            self.first = Some(self.radius.at(vertex.footprint));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A picture of one brightness in all blocks, with as much variance.
    fn grey(found: f64, merged: f64) -> Vec<Block> {
        vec![Block { pixels: 32, luminance: 32.0, found: 32.0 * found, merged: 32.0 * merged }; 64]
    }

    #[test]
    fn photons_follow_the_noise_that_they_make() {
        let picture = 256.0 * 256.0;
        assert_eq!(paths(picture, &grey(1.0, 0.0)), 4096, "a few where the pilot saw none");
        // √(LASTING·merged/found) of the pixels.
        assert_eq!(paths(picture, &grey(1.0, 0.125 * 0.125 / LASTING)), 8192);
        assert_eq!(paths(picture, &grey(0.01, 0.01 * 0.25 / LASTING)), 32_768, "of dark noise the same");
        assert_eq!(paths(picture, &grey(0.0, 1.0)), 65_536, "no more than pixels");
        assert_eq!(paths(7680.0 * 4320.0, &grey(0.0, 1.0)), 1 << 20, "a large picture");
        assert_eq!(paths(1.0, &grey(0.0, 0.0)), 1, "black");
        assert_eq!(paths(1.0, &[]), 1);
    }

    /// A lamp in view, or one bright dot, does not hide what photons do to the rest.
    #[test]
    fn bright_blocks_count_as_much_as_others() {
        let mut blocks = grey(0.01, 0.01);
        let even = paths(1e4, &blocks);
        blocks[5] = Block { pixels: 32, luminance: 3.2e5, found: 32e8, merged: 0.0 };
        assert!(paths(1e4, &blocks) > even / 2);
    }
}
