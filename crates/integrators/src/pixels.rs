//! From pixels to camera walks: what all integrators share.

use bsdf::TransportMode;
use color::Lanes;
use film::{FilmError, PassFilm, PixelSample};
use math::Vec2;
use sampling::{Domain, Sampler, Streams, shifted_r2};
use scene::Scene;
use transport::{LightLayer, Vertex, Walk};

use crate::Settings;

/// Rows that are handed to a thread at once, and columns of them that are gone through together, so that neighbouring
/// paths use the same memory. Part of no result: pixels share nothing.
const BAND: usize = 4;
const COLUMNS: usize = 16;

/// A camera path about to start.
pub(crate) struct CameraPath<'s> {
    pub walk: Walk<'s>,
    pub sampler: Sampler,
}

/// One pass: `f` over all pixels.
pub(crate) fn render_pixels<'s>(
    scene: &'s Scene,
    settings: &Settings,
    pass: u64,
    f: impl Fn(CameraPath<'s>, &mut PixelSample) + Sync,
) -> Result<PassFilm, FilmError> {
    let [width, height] = scene.resolution().map(|n| n as usize);
    let streams = Streams::new(settings.seed, pass, Domain::Camera);
    let mut samples = vec![PixelSample::default(); width * height];
    par::fill_chunks(&mut samples, width * BAND, |band, samples| {
        for first in (0..width).step_by(COLUMNS) {
            for (y, row) in samples.chunks_mut(width).enumerate() {
                for (x, sample) in row.iter_mut().enumerate().skip(first).take(COLUMNS) {
                    let path = start(scene, settings, &streams, pass, [x, band * BAND + y], sample);
                    f(path, sample);
                }
            }
        }
    });
    PassFilm::new(width, height, samples)
}

#[inline]
fn start<'s>(
    scene: &'s Scene,
    settings: &Settings,
    streams: &Streams,
    pass: u64,
    [x, y]: [usize; 2],
    sample: &mut PixelSample,
) -> CameraPath<'s> {
    let pixel = y as u64 * u64::from(scene.resolution()[0]) + x as u64;
    let mut sampler = streams.path(pixel);
    // Evenly over the passes, so that edges need few of them.
    let filter = settings.filter.sample(shifted_r2(settings.seed.rotate_left(32) ^ pixel, pass));
    let film_position = Vec2::new(x as f32 + 0.5, y as f32 + 0.5) + filter.offset;
    let camera = scene.camera().sample_we(film_position, sampler.next_2d());
    sample.weight = filter.weight * camera.weight;
    let walk = Walk::new(scene, TransportMode::Radiance, camera.ray, Lanes::ONE, scene.camera_medium())
        .with_footprint(camera.width, camera.spread);
    CameraPath { walk, sampler }
}

/// Adds radiance to a layer of a sample.
#[inline]
pub(crate) fn add(sample: &mut PixelSample, layer: LightLayer, radiance: Lanes) {
    let target = match layer {
        LightLayer::Direct => &mut sample.direct,
        LightLayer::Caustic => &mut sample.caustic,
        LightLayer::Indirect => &mut sample.indirect,
    };
    for (t, r) in target.iter_mut().zip(radiance.to_rgb()) {
        *t += r;
    }
}

/// Writes what the first surface of a path is like.
#[inline]
pub(crate) fn add_features(sample: &mut PixelSample, vertex: &Vertex) {
    let ns = vertex.bsdf.ns();
    let facing = if ns.dot(vertex.wo) < 0.0 { -ns } else { ns };
    sample.albedo = vertex.bsdf.albedo(vertex.wo).to_rgb();
    sample.normal = facing.to_array();
    sample.depth = vertex.hit.t;
}
