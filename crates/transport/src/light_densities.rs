use math::Vec3;
use scene::light::{LeSample, LiSample, LightHit, Receiver};
use scene::{LightId, Scene};

use crate::{EyeEnd, SubpathMis};

/// With what densities the techniques find one point of a light (one direction of a light at infinity) from one point
/// that it shines on. The probabilities of choosing the light are included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightDensities {
    /// Of light sampling: per area of the light, times d² (so for an area light per steradian of the receiver times the
    /// light's cosine); of lights at infinity per steradian, or 1 where the direction is delta.
    pub direct: f64,
    /// Of a light path that starts there and then: per area and steradian.
    pub emitted: f64,
    /// |cos| at the light; 1 at infinity; 0 where no ray finds the light.
    pub cos: f64,
}

impl LightDensities {
    /// For the first vertex of a light path.
    pub fn of_start(scene: &Scene, id: LightId, le: &LeSample, receiver: &Receiver) -> Self {
        let light = scene.light(id);
        let pmf = f64::from(scene.direct_picker().expected(id.0 as usize, receiver));
        let receiver = receiver.p;
        let emission = f64::from(scene.global_picker().pmf(id.0 as usize));
        let emitted = emission * f64::from(le.pdf_a) * f64::from(le.pdf_w);
        if light.is_delta() {
            let d2 = if light.is_infinite() { 1.0 } else { f64::from(le.p.distance_squared(receiver)) };
            return Self { direct: pmf * d2, emitted, cos: 0.0 };
        }
        let hit = (!light.is_infinite()).then(|| light.hit_of_le(le));
        let cos = f64::from(le.cos);
        let direct = pmf * f64::from(light.pdf_li_w(receiver, -le.w, hit)) * cos;
        Self { direct, emitted, cos }
    }

    /// For a sample of light sampling.
    pub fn of_direct(scene: &Scene, id: LightId, expected: f32, li: &LiSample) -> Self {
        let light = scene.light(id);
        let w = -li.wi;
        let hit = light.hit_of_li(li);
        let (pdf_a, pdf_w) = light.pdf_le(&hit, w);
        let emitted = emission_pmf(scene, id) * f64::from(pdf_a) * f64::from(pdf_w);
        let pmf = f64::from(expected);
        if li.is_delta {
            let d2 = if light.is_infinite() { 1.0 } else { f64::from(li.distance).powi(2) };
            return Self { direct: pmf * d2, emitted, cos: 0.0 };
        }
        let cos = if light.is_infinite() { 1.0 } else { f64::from(hit.ng.dot(w).abs()) };
        Self { direct: pmf * f64::from(li.pdf_w) * cos, emitted, cos }
    }

    /// For an eye path that met the light: at `hit`, or on leaving the scene.
    pub fn of_end(scene: &Scene, id: LightId, end: &EyeEnd, hit: Option<LightHit>) -> Self {
        let light = scene.light(id);
        let wi = end.direction;
        let from = end.from.p;
        let start = hit.unwrap_or(LightHit { p: from, ng: Vec3::ZERO, prim: 0 });
        let (pdf_a, pdf_w) = light.pdf_le(&start, -wi);
        let cos = hit.map_or(1.0, |hit| f64::from(hit.ng.dot(wi).abs()));
        let pmf = f64::from(scene.direct_picker().expected(id.0 as usize, &end.from));
        Self {
            direct: pmf * f64::from(light.pdf_li_w(from, wi, hit)) * cos,
            emitted: emission_pmf(scene, id) * f64::from(pdf_a) * f64::from(pdf_w),
            cos,
        }
    }

    /// The numbers of a light path that is about to meet its first surface; its first edge counts with length 1.
    pub fn start(&self, connections: crate::Connections) -> SubpathMis {
        // Georgiev 2012, eq. 31–33.
        let start = SubpathMis {
            edge: (self.direct / self.emitted) as f32,
            rest: (self.cos / self.emitted) as f32,
            merges: 0.0,
        };
        match connections {
            crate::Connections::Made => start,
            crate::Connections::None => start.without_edge(),
        }
    }
}

fn emission_pmf(scene: &Scene, id: LightId) -> f64 {
    f64::from(scene.global_picker().pmf(id.0 as usize))
}
