use bsdf::Lobes;
use color::Lanes;
use sampling::Sampler;
use scene::{LightId, Scene};

use crate::emit::emit_with_start;
use crate::subpath::{PathVertex, Subpath};
use crate::{Connections, LightLayer, Observer, PathClass, PathEnd};

/// Which events a light path has had, as far as the layers of whole paths depend on it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LightClass {
    /// D events, at most 2.
    diffuse: u8,
    /// Whether an S event lies before the first D event.
    specular_first: bool,
}

impl LightClass {
    /// After one more scattering event.
    #[must_use]
    pub fn scattered(self, specular: bool) -> Self {
        match (specular, self.diffuse) {
            (true, 0) => Self { specular_first: true, ..self },
            (true, _) => self,
            (false, n) => Self { diffuse: (n + 1).min(2), ..self },
        }
    }

    /// The layers of whole paths whose `eye` part ends where light paths of each class do, by [`Self::index`].
    pub fn layers_after(eye: PathClass) -> [LightLayer; 6] {
        std::array::from_fn(|i| Self { diffuse: i as u8 / 2, specular_first: i % 2 == 1 }.after(eye).layer())
    }

    /// From 0 to 5.
    #[inline]
    pub fn index(self) -> usize {
        usize::from(2 * self.diffuse) + usize::from(self.specular_first)
    }

    /// The class of a whole path of which `eye` holds the events from the camera on, up to this light path.
    pub fn after(self, eye: PathClass) -> PathClass {
        let class = (0..self.diffuse).fold(eye, |class, _| class.scattered(false));
        if self.specular_first { class.scattered(true) } else { class }
    }
}

/// A vertex of a light path that something can be joined to.
#[derive(Clone, Copy, Debug)]
pub struct LightVertex {
    /// The vertex.
    pub at: PathVertex,
    /// Flux in W that the path brings there, as if it were the only one.
    pub flux: Lanes,
    /// Scattering events before.
    pub depth: u32,
    /// Those events.
    pub class: LightClass,
    /// Where the path came from.
    pub light: LightId,
    /// Numbers for a point of the lens.
    pub u_lens: [f32; 2],
}

/// Traces a light path of at most `max_depth` scattering events, the one at its end included, and calls `f` with each
/// vertex that scatters by more than delta lobes. Lights are drawn by power.
pub fn trace_light_path(
    scene: &Scene,
    max_depth: u32,
    connections: Connections,
    sampler: &mut Sampler,
    f: impl FnMut(&LightVertex),
) {
    observe_light_path(scene, max_depth, connections, sampler, &mut (), f);
}

/// [`trace_light_path`], shown to an observer.
#[inline]
pub fn observe_light_path(
    scene: &Scene,
    max_depth: u32,
    connections: Connections,
    sampler: &mut Sampler,
    observer: &mut impl Observer,
    f: impl FnMut(&LightVertex),
) {
    let Some((light, path)) = start(scene, connections, sampler) else { return };
    observer.started(&path.walk, light);
    let end = follow(light, path, max_depth, sampler, observer, f);
    observer.ended(end);
}

#[inline]
fn follow(
    light: LightId,
    mut path: Subpath<'_>,
    max_depth: u32,
    sampler: &mut Sampler,
    observer: &mut impl Observer,
    mut f: impl FnMut(&LightVertex),
) -> PathEnd {
    let mut class = LightClass::default();
    while let Some(at) = path.next_vertex() {
        observer.reached(&path.walk, &at.vertex);
        let bsdf = &at.vertex.bsdf;
        if bsdf.lobes() == Lobes::NONE {
            return PathEnd::Absorbed;
        }
        let (flux, depth) = (path.walk.throughput, path.walk.depth);
        if !bsdf.is_delta_only() {
            f(&LightVertex { at, flux, depth, class, light, u_lens: sampler.next_2d() });
        }
        if depth + 1 >= max_depth {
            return PathEnd::Depth;
        }
        let Some(scattered) = path.scatter(&at, Lobes::ALL, sampler) else {
            return PathEnd::Lost;
        };
        class = class.scattered(!bsdf.has_diffuse() || scattered.lobes.contains(Lobes::SPECULAR));
    }
    PathEnd::Escaped
}

fn start<'s>(
    scene: &'s Scene,
    connections: Connections,
    sampler: &mut Sampler,
) -> Option<(LightId, Subpath<'s>)> {
    let (emitted, start) = emit_with_start(scene, sampler)?;
    Some((start.light, Subpath::from_light(emitted.walk, start.light, start.le, connections)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn classes_of_joined_paths_are_those_of_whole_paths() {
        for bits in 0..1u32 << 6 {
            for split in 0..=6 {
                let specular = |i: u32| bits >> i & 1 == 1;
                let whole = (0..6).fold(PathClass::default(), |c, i| c.scattered(specular(i)));
                let eye = (0..split).fold(PathClass::default(), |c, i| c.scattered(specular(i)));
                let light = (split..6).rev().fold(LightClass::default(), |c, i| c.scattered(specular(i)));
                assert_eq!(light.after(eye).layer(), whole.layer(), "{bits:06b} at {split}");
                assert_eq!(LightClass::layers_after(eye)[light.index()], whole.layer());
            }
        }
    }
}
