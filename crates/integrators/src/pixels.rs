//! From pixels to camera walks: what all integrators share.

use bsdf::TransportMode;
use color::Lanes;
use film::{FilmError, PassFilm, PixelSample};
use math::Vec2;
use sampling::{Domain, Sampler, Strata, Streams, shifted_r2};
use scene::Scene;
use transport::Walk;

use crate::Settings;
use crate::layers::{Layers, Slots, trace_layers};
use crate::sink::Sink;

/// Rows that are handed to a thread at once, and columns of them that are gone through together, so that neighbouring
/// paths use the same memory. Part of no result: pixels share nothing.
const BAND: usize = 4;
const COLUMNS: usize = 16;

/// A camera path about to start.
pub(crate) struct CameraPath<'s> {
    pub walk: Walk<'s>,
    /// In pixels; may lie beyond the border.
    pub film_position: Vec2,
    pub sampler: Sampler,
    /// Numbers that fill their squares evenly over the passes of the pixel.
    pub strata: Strata,
    /// Of the whole sample in its pixel.
    pub weight: f32,
}

/// What an integrator does with one eye path.
pub(crate) trait Tracer: Sync {
    fn trace<S: Sink>(&self, path: CameraPath<'_>, sink: &mut S);
}

/// One pass: the tracer over all pixels.
pub(crate) fn render_pixels(
    scene: &Scene,
    settings: &Settings,
    pass: u64,
    tracer: &impl Tracer,
) -> Result<PassFilm, FilmError> {
    trace_pixels(scene, settings, pass, tracer).finish(scene)
}

/// What a pass gave.
pub(crate) struct Traced {
    pub samples: Vec<PixelSample>,
    /// Where layers are asked for.
    pub layers: Option<Layers>,
}

impl Traced {
    pub fn finish(self, scene: &Scene) -> Result<PassFilm, FilmError> {
        let [width, height] = scene.resolution().map(|n| n as usize);
        let film = PassFilm::new(width, height, self.samples)?;
        match self.layers {
            Some(layers) => film.with_layers(layers.values),
            None => Ok(film),
        }
    }
}

/// The samples of one pass, row by row.
pub(crate) fn trace_pixels(scene: &Scene, settings: &Settings, pass: u64, tracer: &impl Tracer) -> Traced {
    if let Some(slots) = Slots::new(settings, scene) {
        return trace_layers(scene, settings, pass, tracer, slots);
    }
    let [width, height] = scene.resolution().map(|n| n as usize);
    let streams = Streams::new(settings.seed, pass, Domain::Camera);
    let mut samples = vec![PixelSample::default(); width * height];
    par::fill_chunks(&mut samples, width * BAND, |band, samples| {
        for first in (0..width).step_by(COLUMNS) {
            for (y, row) in samples.chunks_mut(width).enumerate() {
                for (x, sample) in row.iter_mut().enumerate().skip(first).take(COLUMNS) {
                    if !settings.shows(x, band * BAND + y) {
                        continue;
                    }
                    let path = start(scene, settings, &streams, pass, [x, band * BAND + y]);
                    sample.weight = path.weight;
                    tracer.trace(path, sample);
                }
            }
        }
    });
    Traced { samples, layers: None }
}

/// Passes after which textures are averaged over half of a pixel's width.
const SHARPENING: f64 = 6.0;

/// What of a pixel's width textures are averaged over in a pass: all of it at first, so that few passes show no grain, and less and
/// less, for many passes average by themselves, and over the pixel as the filter has it. Of a width w, N passes leave
/// w·(6/N)·ln(1 + N/6).
fn texture_share(pass: u64) -> f32 {
    (SHARPENING / (SHARPENING + pass as f64)) as f32
}

/// The eye path of a pass through a pixel.
#[inline]
pub(crate) fn start<'s>(
    scene: &'s Scene,
    settings: &Settings,
    streams: &Streams,
    pass: u64,
    [x, y]: [usize; 2],
) -> CameraPath<'s> {
    let pixel = y as u64 * u64::from(scene.resolution()[0]) + x as u64;
    let mut sampler = streams.path(pixel);
    // Evenly over the passes, so that edges need few of them.
    let filter = settings.filter.sample(shifted_r2(settings.seed.rotate_left(32) ^ pixel, pass));
    let film_position = Vec2::new(x as f32 + 0.5, y as f32 + 0.5) + filter.offset;
    let camera = scene.camera().sample_we(film_position, sampler.next_2d());
    let media = scene.camera_medium(camera.ray.origin);
    let walk = Walk::new(scene, TransportMode::Radiance, camera.ray, Lanes::ONE, media)
        .with_footprint(camera.width, camera.spread)
        .with_texture_share(texture_share(pass));
    let strata = Strata::new(settings.seed.rotate_left(32) ^ pixel, pass);
    CameraPath { walk, film_position, sampler, strata, weight: filter.weight * camera.weight }
}
