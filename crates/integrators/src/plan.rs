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
use crate::sink::{Origin, Sink, Source, Technique};
use crate::{Maps, Settings};

/// Photon paths of the pilot.
const PHOTONS: u64 = 16_384;
/// Eye paths of the pilot: so many places of a lattice over the picture.
const EYES: u64 = 4096;
/// Paths of one task; fixed, so that sums have one shape on any number of threads.
const CHUNK: usize = 256;
/// Least share of the pixels that is traced as photons, where there are caustics at all: what the pilot did not see is
/// not left to chance. Tracing them costs 1 to 2 % of a pass, looking them up at every D surface 15 to 25 %.
const LEAST_SHARE: f64 = 1.0 / 16.0;
/// Photons a pixel for each unit of that share; by trials (docs/book/auto.md).
const FULL_AT: f64 = 3.0;
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
    /// As many paths as pixels where a third of the picture's light is merged, fewer where less is, and none where no
    /// photon lands.
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
        let seen = look(settings, scene, &maps);
        let [width, height] = scene.resolution().map(f64::from);
        let share = if seen.all > 0.0 { seen.merged / seen.all } else { 0.0 };
        Self { paths: paths(width * height, share), typical_radius: median(seen.radii).unwrap_or(0.0) }
    }
}

/// Photon paths for a picture of so many pixels, of whose light that share is merged.
fn paths(pixels: f64, share: f64) -> u64 {
    (pixels * (FULL_AT * share).clamp(LEAST_SHARE, 1.0)).ceil().min(MOST) as u64
}

/// What the pilot's eye paths found.
#[derive(Default)]
struct Seen {
    /// Luminance, summed.
    all: f64,
    /// By merging.
    merged: f64,
    /// Radii at the first surfaces.
    radii: Vec<f32>,
}

/// Eye paths through a lattice of the picture.
fn look(settings: &Settings, scene: &Scene, maps: &Maps) -> Seen {
    let radius = RADIUS.of_pass(0, scene.bounds().size().length());
    let eye = Eye { photons: Merging::new(maps, radius, PHOTONS), max_depth: settings.max_depth };
    let streams = Streams::new(settings.seed, 0, Domain::Pilot);
    let [width, height] = scene.resolution().map(|n| n as usize);
    let batches = par::map_chunks(EYES as usize, CHUNK, |range| {
        let mut seen = Seen::default();
        for i in range {
            // Pixels fill the picture evenly, whatever its shape.
            let [u, v] = Strata::new(settings.seed, i as u64).point(0);
            let pixel = [(u * width as f32) as usize, (v * height as f32) as usize];
            let mut tally = Tally { radius, all: 0.0, merged: 0.0, first: None };
            eye.trace(start(scene, settings, &streams, i as u64, pixel), &mut tally);
            seen.all += tally.all;
            seen.merged += tally.merged;
            seen.radii.extend(tally.first);
        }
        seen
    });
    batches.into_iter().fold(Seen::default(), |mut sum, seen| {
        sum.all += seen.all;
        sum.merged += seen.merged;
        sum.radii.extend(seen.radii);
        sum
    })
}

/// Takes the light of one eye path.
struct Tally {
    radius: PassRadius,
    all: f64,
    merged: f64,
    /// Radius at the first D surface.
    first: Option<f32>,
}

impl Sink for Tally {
    type Sum = Lanes;

    fn add(&mut self, origin: Origin, radiance: Lanes) {
        let luminance = f64::from(color::luminance(radiance.to_rgb()));
        if !luminance.is_finite() {
            return;
        }
        self.all += luminance;
        if origin.technique == Technique::Merge {
            self.merged += luminance;
        }
    }

    fn add_sum(&mut self, layer: LightLayer, technique: Technique, sum: Lanes) {
        self.add(Origin { layer, technique, source: Source::Unknown }, sum);
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

    #[test]
    fn photons_follow_the_share_of_merged_light() {
        let picture = 256.0 * 256.0;
        assert_eq!(paths(picture, 0.0), 4096, "a few where the pilot saw none");
        assert_eq!(paths(picture, 1.0 / 12.0), 16_384);
        assert_eq!(paths(picture, 0.4), 65_536, "no more than pixels");
        assert_eq!(paths(7680.0 * 4320.0, 1.0), 1 << 20, "a large picture");
        assert_eq!(paths(1.0, 0.0), 1);
    }
}
