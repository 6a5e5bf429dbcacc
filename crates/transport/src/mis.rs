//! Weights of vertex connection and merging: the balance heuristic over all techniques that could have made a path
//! (Georgiev, Křivánek, Davidovič & Slusallek 2012), from three numbers a vertex (Georgiev 2012, "Implementing Vertex
//! Connection and Merging").
//!
//! η = π·r²·n, with n light paths and the radius r of merging, is known only once the eye path is; so the recursion is
//! kept linear in it: dVC = rest + η·merges, and dVM = dVC/η.

/// What competes along a path apart from emission.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Connections {
    /// Light sampling, connections and light tracing.
    Made,
    /// None of them.
    None,
}

/// Sums, at a vertex of a subpath, of the densities of the techniques that would have ended the other subpath nearer to
/// this one's start, over the density of this subpath.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SubpathMis {
    /// dVCM: a connection across the last edge.
    pub edge: f32,
    /// dVC less what merging adds: emission and connections across the edges before.
    pub rest: f32,
    /// dVC's part that goes with η: merging at the vertices before.
    pub merges: f32,
}

/// A scattering event that is no delta lobe's, as the recursion sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scattering {
    /// |cos| to the geometric normal of the direction that was drawn.
    pub cos: f64,
    /// Density of that direction per steradian, survival included.
    pub forward: f64,
    /// Density with which the other subpath, coming from there, would have gone to where this one came from.
    pub reverse: f64,
    /// 1 where photons are merged at this vertex, else 0.
    pub merging: f64,
}

/// Greatest number kept: beyond it a technique has no share anyway.
const GREATEST: f64 = 1e30;

fn kept(x: f64) -> f32 {
    // A NaN (∞·0) comes of a density that is no number: such techniques count as certain.
    x.min(GREATEST) as f32
}

impl SubpathMis {
    fn new(edge: f64, rest: f64, merges: f64) -> Self {
        Self { edge: kept(edge), rest: kept(rest), merges: kept(merges) }
    }

    /// At the camera; `density`: camera paths over light paths, per steradian of the first ray or, of parallel rays, per area
    /// across them (its edge then counts with length 1). 0: light paths cannot be connected to it.
    pub fn of_camera(density: f64) -> Self {
        // Georgiev 2012, eq. 31 and 32.
        Self::new(if density > 0.0 { 1.0 / density } else { 0.0 }, 0.0, 0.0)
    }

    /// The same where nothing could have been connected across the last edge.
    #[must_use]
    pub fn without_edge(self) -> Self {
        Self { edge: 0.0, ..self }
    }

    /// After an edge of that squared length (1 for the first edge of a light path, whose densities hold it already, and for that
    /// of a parallel ray)
    /// that meets a surface under that |cos|.
    #[must_use]
    pub fn arrived(self, distance2: f64, cos: f64) -> Self {
        let over = |x: f32, y: f64| if x == 0.0 { 0.0 } else { f64::from(x) * y / cos };
        Self::new(over(self.edge, distance2), over(self.rest, 1.0), over(self.merges, 1.0))
    }

    /// After a scattering event (Georgiev 2012, eq. 34–36).
    #[must_use]
    pub fn scattered(self, event: &Scattering, connections: Connections) -> Self {
        let Scattering { cos, forward, reverse, merging } = *event;
        let edge = if connections == Connections::Made { 1.0 / forward } else { 0.0 };
        let rest = cos / forward * (f64::from(self.rest) * reverse + f64::from(self.edge));
        let merges = cos / forward * (f64::from(self.merges) * reverse + merging);
        Self::new(edge, rest, merges)
    }

    /// After a delta lobe (eq. 53–55): nothing joins there. `ratio`: |cos| of the new direction times the reverse over
    /// the forward density.
    #[must_use]
    pub fn passed(self, ratio: f64) -> Self {
        Self::new(0.0, ratio * f64::from(self.rest), ratio * f64::from(self.merges))
    }

    /// All that competes on this side of a vertex but merging at the vertex itself; `reverse`: density per steradian with
    /// which the other subpath would go on along this one.
    #[inline]
    pub(crate) fn before(&self, eta: f64, reverse: f64) -> f64 {
        f64::from(self.edge) + (f64::from(self.rest) + eta * f64::from(self.merges)) * reverse
    }

    /// All that competes on this side of an edge that ends here, `merging` at this vertex included.
    fn beyond(&self, eta: f64, merging: f64, reverse: f64) -> f64 {
        eta * merging + self.before(eta, reverse)
    }
}

/// One end of a connection.
#[derive(Clone, Copy, Debug)]
pub struct End {
    /// Of the subpath that ends there.
    pub mis: SubpathMis,
    /// 1 where photons are merged at this vertex, else 0.
    pub merging: f64,
    /// Density per steradian with which the other subpath would go on along this one.
    pub reverse: f64,
    /// Density per area with which the other subpath would have come here.
    pub reached: f64,
}

impl End {
    fn share(&self, eta: f64) -> f64 {
        self.reached * self.mis.beyond(eta, self.merging, self.reverse)
    }
}

/// Weight of a connection of two vertices (eq. 40, 41).
pub fn connection_weight(eta: f64, light: &End, eye: &End) -> f32 {
    weight(light.share(eta) + eye.share(eta))
}

/// Weight of light tracing (eq. 46, 47): the end of the light path, reached from the camera with `reached` camera paths
/// per area for each light path.
pub fn projection_weight(eta: f64, light: &End) -> f32 {
    weight(light.share(eta))
}

/// Weight of light sampling (eq. 44, 45): `hit` is the density of finding the light by the eye path's own direction over
/// that of light sampling; `eye.reached` that of a light path over that of light sampling.
pub fn direct_weight(eta: f64, hit: f64, eye: &End) -> f32 {
    weight(hit + eye.share(eta))
}

/// Weight of emission met by the eye path (eq. 42, 43), with its numbers as they left its last vertex. `direct`: density
/// of light sampling there, per steradian; `emitted`: density of a light path that starts along the last edge, per area
/// and steradian, over the cosine at the light.
pub fn emission_weight(eta: f64, leaving: &SubpathMis, direct: f64, emitted: f64) -> f32 {
    let rest = f64::from(leaving.rest) + eta * f64::from(leaving.merges);
    weight(direct * f64::from(leaving.edge) + emitted * rest)
}

fn weight(others: f64) -> f32 {
    (1.0 / (1.0 + others)) as f32
}
