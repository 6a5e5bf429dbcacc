//! What light paths leave on the film.

use color::Lanes;
use film::{Filter, PixelSample};
use math::Vec2;
use scene::{LightId, Scene};
use transport::LightLayer;

use crate::Settings;
use crate::layers::Layers;
use crate::sink::{Origin, Sink, Source, Technique};

/// A vertex of a light path seen by the camera.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Splat {
    pub film_position: Vec2,
    /// Of a pixel there, before the filter.
    pub radiance: Lanes,
    pub layer: LightLayer,
    pub light: LightId,
}

impl Splat {
    fn origin(&self) -> Origin {
        Origin { layer: self.layer, technique: Technique::Project, source: Source::Light(self.light) }
    }
}

/// Rows that are filled at once. Part of no result: each pixel adds its splats in index order.
const BAND: usize = 16;

/// Adds the splats to the samples of a film, each to all pixels that are rendered and whose filter reaches it. Samples are multiplied by their
/// weight later (±c where the filter is negative somewhere), splats have theirs already.
pub(super) fn add(splats: &[Splat], settings: &Settings, size: [usize; 2], samples: &mut [PixelSample]) {
    if splats.is_empty() {
        return;
    }
    let filter = &settings.filter;
    let reach = filter.radius() + 0.5;
    par::fill_chunks(samples, size[0] * BAND, |band, samples| {
        let rows = band * BAND..band * BAND + samples.len() / size[0];
        let (first, last) = (rows.start as f32 - reach, rows.end as f32 + reach);
        for splat in splats.iter().filter(|s| (first..=last).contains(&s.film_position.y)) {
            let origin = splat.origin();
            filter.spread(splat.film_position, size, |x, y, weight| {
                if rows.contains(&y) && settings.shows(x, y) {
                    let sample = &mut samples[(y - rows.start) * size[0] + x];
                    sample.add(origin, splat.radiance * (weight / sample.weight));
                }
            });
        }
    });
}

/// What [`add`] adds to one pixel, for replays; `weight`: of its sample.
pub(super) fn add_to_pixel(
    splats: &[Splat],
    filter: &Filter,
    size: [usize; 2],
    pixel: [usize; 2],
    weight: f32,
    sink: &mut impl Sink,
) {
    let reach = filter.radius() + 0.5;
    let (first, last) = (pixel[1] as f32 - reach, (pixel[1] + 1) as f32 + reach);
    for splat in splats.iter().filter(|s| (first..=last).contains(&s.film_position.y)) {
        filter.spread(splat.film_position, size, |x, y, share| {
            if [x, y] == pixel {
                sink.add(splat.origin(), splat.radiance * (share / weight));
            }
        });
    }
}

/// The same as [`add`] to the layers of their technique and of their lights.
pub(super) fn add_to_layers(
    splats: &[Splat],
    settings: &Settings,
    samples: &[PixelSample],
    layers: &mut Layers,
    scene: &Scene,
) {
    let slots = &layers.slots;
    let size = scene.resolution().map(|n| n as usize);
    par::fill_chunks(&mut layers.values, samples.len(), |layer, values| {
        for splat in splats {
            let origin = splat.origin();
            if !slots.of(&origin, scene).any(|slot| slot == layer) {
                continue;
            }
            settings.filter.spread(splat.film_position, size, |x, y, weight| {
                if !settings.shows(x, y) {
                    return;
                }
                let pixel = y * size[0] + x;
                let share = splat.radiance * (weight / samples[pixel].weight);
                values[pixel].iter_mut().zip(share.to_rgb()).for_each(|(v, s)| *v += s);
            });
        }
    });
}
