use color::Lanes;
use math::{Bounds3, Vec3, octahedral_decode, octahedral_encode};

use crate::kdtree::KdTree;
use crate::kernel::Kernel;
use crate::leaf::{LEAF, Normals, Surface, prefetch, unpack};
use crate::photon::{Payload, Photon, PhotonFlags};
use crate::search::{Scan, Scratch};

/// τ: a photon counts where its height over the surface of the query is at most τ·radius.
///
/// The height is |(x_p − x)·(n_p + n_x)|/2: on a plane the distance from the plane, and 0 on every sphere and circular
/// arc, whose own bulge must not cost photons. A sheet parallel to the surface is cut off while it lies farther than
/// τ·radius.
pub const FLATNESS: f32 = 0.2;

/// A photon counts where n_p·n_x is at least cos 60°; on a sphere of radius R, up to a radius of R.
pub const MIN_NORMAL_COSINE: f32 = 0.5;

/// A radius of fewer than this many parts of the greatest coordinate measures rounding, not density.
const LEAST_RADIUS: f32 = 1.0 / (1 << 20) as f32;

/// Photons whose payloads are asked for before they are shown.
const AHEAD: usize = 8;

/// Where and how density is estimated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Query {
    /// A point on a surface.
    pub position: Vec3,
    /// Unit geometric normal there, on the side whose photons count.
    pub normal: Vec3,
    /// Radius of [`PhotonMap::gather`]; greatest radius of [`PhotonMap::gather_knn`]. Scene units. Nothing is found
    /// where it is not above 1.1·10⁻¹⁹; an infinite one gives the weight 0 unless the k-th photon replaces it.
    pub radius: f32,
    /// Profile.
    pub kernel: Kernel,
}

impl Query {
    /// Whether 1/r² is a number to work with.
    fn has_area(&self) -> bool {
        self.radius > 0.0 && self.radius * self.radius >= f32::MIN_POSITIVE
    }
}

/// A photon as a gather sees it. What a gather may not need is unpacked when asked for.
#[derive(Clone, Copy, Debug)]
pub struct PhotonView<'m> {
    map: &'m PhotonMap,
    /// Normal of the query.
    normal: Vec3,
    /// Flux Φ, W in each lane, as it was deposited.
    pub power: Lanes,
    /// Place in tree order: names the photon within its map.
    pub slot: u32,
}

impl PhotonView<'_> {
    /// wi: unit, toward where the photon came from, within 0.004°; always above the query's horizon. Where the
    /// surface curves so much between photon and query that wi would lie below it, wi is turned along by the rotation
    /// that takes n_p to n_x: on its own side of its own surface it did arrive, and its flux belongs to the estimate.
    #[inline]
    pub fn direction(&self) -> Vec3 {
        let direction = self.map.payloads[self.slot as usize].direction();
        if direction.dot(self.normal) > 0.0 {
            return direction;
        }
        turned(direction, self.map.normal(self.slot), self.normal)
    }

    /// Number of scattering events between the light and this hit.
    #[inline]
    pub fn depth(&self) -> u8 {
        self.map.marks[self.slot as usize][0]
    }

    /// What the path was.
    #[inline]
    pub fn flags(&self) -> PhotonFlags {
        PhotonFlags(self.map.marks[self.slot as usize][1])
    }
}

/// What [`PhotonMap::gather_knn`] looked at.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Neighbourhood {
    /// Radius of the estimate: that of the k-th accepted photon, or the query's where fewer than k were accepted.
    pub radius: f32,
    /// Number of photons in the estimate (the k-th is none of them).
    pub count: usize,
}

/// Photons in tree order, ready for density estimation. Immutable; 38.5 bytes a photon, search tree included
/// (position 12, normal 4, power 16, direction 4, depth and flags 2, tree 0.5).
///
/// Positions and powers are kept exactly; directions and normals within 0.004° (octahedral, 2 × 16 bits), with no
/// bias above 10⁻⁶.
///
/// A photon x_p with normal n_p counts in an estimate of radius r at x with normal n_x where
/// * |x_p − x| ≤ r,
/// * n_p·n_x ≥ [`MIN_NORMAL_COSINE`]. Since n_p lies on the side that the photon came from, this is also the test of
///   the side: photons on the back of a wall, however thin, have the opposite normal;
/// * |(x_p − x)·(n_p + n_x)|/2 ≤ [`FLATNESS`]·r.
#[derive(Clone, Debug)]
pub struct PhotonMap {
    tree: KdTree,
    normals: Vec<Normals>,
    payloads: Vec<Payload>,
    marks: Vec<[u8; 2]>,
    rejected: usize,
    least_radius: f32,
}

impl PhotonMap {
    /// The map of `photons`, whose order decides ties only.
    ///
    /// Photons with a part that is not finite, or without direction or normal, are left out and counted
    /// ([`Self::rejected`]). Built on the threads of the enclosing [`par::Workers::run`]; the result does not depend
    /// on their number.
    pub fn build(photons: Vec<Photon>) -> Self {
        Self::build_ordered(photons).0
    }

    /// The map, and for each slot the index that its photon had in `photons`: for what else is known of it.
    pub fn build_ordered(photons: Vec<Photon>) -> (Self, Vec<u32>) {
        let rejected = |p: &Photon| if p.is_sound() { p.position } else { Vec3::NAN };
        let positions: Vec<Vec3> = photons.iter().map(rejected).collect();
        let (tree, order) = KdTree::build(&positions);
        drop(positions);
        let leaves = par::map_chunks(order.len(), LEAF * 256, |slots| {
            let mut normals = vec![[0; LEAF]; slots.len().div_ceil(LEAF)];
            let mut payloads = Vec::with_capacity(slots.len());
            let mut marks = Vec::with_capacity(slots.len());
            for (i, &index) in order[slots].iter().enumerate() {
                let photon = &photons[index as usize];
                normals[i / LEAF][i % LEAF] = octahedral_encode(photon.normal);
                payloads.push(Payload::new(photon));
                marks.push([photon.depth, photon.flags.0]);
            }
            (normals, payloads, marks)
        });
        let mut map = Self {
            rejected: photons.len() - order.len(),
            least_radius: least_radius(tree.bounds()),
            normals: Vec::with_capacity(tree.blocks.len()),
            payloads: Vec::with_capacity(order.len()),
            marks: Vec::with_capacity(order.len()),
            tree,
        };
        drop(photons);
        for (normals, payloads, marks) in leaves {
            map.normals.extend(normals);
            map.payloads.extend(payloads);
            map.marks.extend(marks);
        }
        (map, order)
    }

    /// Number of photons.
    pub fn len(&self) -> usize {
        self.tree.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.tree.is_empty()
    }

    /// Number of photons that [`Self::build`] left out because a part of them was not finite.
    pub fn rejected(&self) -> usize {
        self.rejected
    }

    /// Smallest box that holds the photons.
    pub fn bounds(&self) -> Bounds3 {
        self.tree.bounds()
    }

    /// The search tree over the positions.
    pub fn tree(&self) -> &KdTree {
        &self.tree
    }

    /// Position and normal of the photon in `slot`, the normal as it was packed.
    ///
    /// # Panics
    /// Where there is no such slot.
    #[inline]
    pub fn place(&self, slot: u32) -> (Vec3, Vec3) {
        (self.tree.position(slot), self.normal(slot))
    }

    /// The photon in `slot`, with direction and normal as they were packed.
    ///
    /// # Panics
    /// Where there is no such slot.
    pub fn photon(&self, slot: u32) -> Photon {
        let i = slot as usize;
        let [depth, flags] = self.marks[i];
        Photon {
            position: self.tree.position(slot),
            direction: self.payloads[i].direction(),
            normal: self.normal(slot),
            power: self.payloads[i].power(),
            depth,
            flags: PhotonFlags(flags),
        }
    }

    /// Size on the heap, in bytes.
    pub fn memory_bytes(&self) -> usize {
        self.tree.memory_bytes()
            + size_of_val(&self.normals[..])
            + size_of_val(&self.payloads[..])
            + size_of_val(&self.marks[..])
    }

    /// [`Self::memory_bytes`] for each photon; 0 for the empty map.
    pub fn bytes_per_photon(&self) -> f64 {
        self.memory_bytes() as f64 / self.len().max(1) as f64
    }

    /// The same map, searched without SIMD instructions. Answers are the same to the bit.
    pub fn portable(mut self) -> Self {
        self.tree = self.tree.portable();
        self
    }

    /// Calls `f(photon, k(d/r)/r²)` for each photon that counts within the query's radius r, and returns their
    /// number. Σ f·Φ·weight estimates reflected radiance: no further cosine, for the flux has it already (Jensen
    /// 1996, eq. 7).
    #[inline]
    pub fn gather(&self, query: &Query, mut f: impl FnMut(&PhotonView<'_>, f32)) -> usize {
        if !query.has_area() {
            return 0;
        }
        let (scan, per_radius2) = (Compatible::new(self, query), (query.radius * query.radius).recip());
        let mut count = 0;
        self.tree.search_within(query.position, query.radius, &scan, |found| {
            count += found.len();
            self.show_all(found, query, per_radius2, &mut f);
        });
        count
    }

    /// Like [`Self::gather`], with the radius of the `k`-th nearest of the photons that count, and without that
    /// photon (García, Ureña & Sbert 2012: with it the estimate is k/(k − 1) of the truth). Where fewer than k count
    /// within the query's radius, that is the radius, and all of them are used. This mixture is unbiased: at density
    /// λ the first case contributes λ·P(at least k − 1 found), the second λ·P(at most k − 2).
    ///
    /// The radius of a photon is the least with which [`Self::gather`] would accept it, so that both searches see the
    /// same photons. Equal radii are ordered by place in the tree. `k` is at least 2; less is taken as 2. Where so
    /// many photons lie in one point that the radius would fall below the rounding of coordinates (2⁻²⁰ of the
    /// greatest), it is held there, and all photons within it are used.
    #[inline]
    pub fn gather_knn(
        &self,
        query: &Query,
        k: usize,
        scratch: &mut Scratch,
        mut f: impl FnMut(&PhotonView<'_>, f32),
    ) -> Neighbourhood {
        if !query.has_area() {
            return Neighbourhood::default();
        }
        let k = k.max(2);
        let scan = Compatible::new(self, query);
        let found = self.tree.search_nearest(query.position, k, query.radius, scratch, &scan);
        let (kth, rest) = match found.split_last() {
            Some((&kth, rest)) if found.len() == k => (unpack(kth).0, rest),
            // All that count are here already.
            _ => (query.radius * query.radius, found),
        };
        let least = self.least_radius.min(query.radius);
        if kth < least * least {
            let count = self.gather(&Query { radius: least, ..*query }, f);
            return Neighbourhood { radius: least, count };
        }
        self.show_all(rest, query, kth.recip(), &mut f);
        let radius = if found.len() == k { kth.sqrt() } else { query.radius };
        Neighbourhood { radius, count: rest.len() }
    }

    /// Calls `f` for each of the candidates.
    #[inline]
    fn show_all(
        &self,
        found: &[u64],
        query: &Query,
        per_radius2: f32,
        f: &mut impl FnMut(&PhotonView<'_>, f32),
    ) {
        for (i, &candidate) in found.iter().enumerate() {
            if let Some(payload) = found.get(i + AHEAD).and_then(|&c| self.payloads.get(unpack(c).1 as usize))
            {
                prefetch(payload);
            }
            self.show(unpack(candidate).1, query, per_radius2, f);
        }
    }

    /// Calls `f` for one photon.
    #[inline]
    fn show(&self, slot: u32, query: &Query, per_radius2: f32, f: &mut impl FnMut(&PhotonView<'_>, f32)) {
        let t2 = (self.tree.position(slot) - query.position).length_squared() * per_radius2;
        let weight = query.kernel.value_of_square(t2.min(1.0)) * per_radius2;
        let payload = &self.payloads[slot as usize];
        f(&PhotonView { map: self, normal: query.normal, power: payload.power(), slot }, weight);
    }

    #[inline]
    fn normal(&self, slot: u32) -> Vec3 {
        octahedral_decode(self.normals[slot as usize / LEAF][slot as usize % LEAF])
    }
}

/// The leaf scan with the test of the surface.
struct Compatible<'a> {
    map: &'a PhotonMap,
    center: Vec3,
    surface: Surface,
}

impl<'a> Compatible<'a> {
    fn new(map: &'a PhotonMap, query: &Query) -> Self {
        let surface = Surface { normal: query.normal, min_cosine: MIN_NORMAL_COSINE, reach: 0.5 / FLATNESS };
        Self { map, center: query.position, surface }
    }
}

impl Scan for Compatible<'_> {
    #[inline]
    fn scan(&self, leaf: usize, bound: f32, out: &mut [u64]) -> usize {
        let (tree, normals) = (&self.map.tree, &self.map.normals[leaf]);
        let first = (leaf * LEAF) as u32;
        tree.isa.scan_photons(&tree.blocks[leaf], normals, &self.surface, self.center, bound, first, out)
    }

    #[inline]
    fn prefetch(&self, leaf: usize) {
        prefetch(&self.map.tree.blocks[leaf]);
        prefetch(&self.map.normals[leaf]);
    }
}

/// `w` turned by the least rotation that takes the unit vector `from` to `to`; they must not be opposite.
fn turned(w: Vec3, from: Vec3, to: Vec3) -> Vec3 {
    // Rodrigues' formula with v = from × to, |v| = sin: w·cos + v × w + v (v·w)/(1 + cos).
    let v = from.cross(to);
    let cosine = from.dot(to);
    w * cosine + v.cross(w) + v * (v.dot(w) / (1.0 + cosine))
}

fn least_radius(bounds: Bounds3) -> f32 {
    let greatest = if bounds.is_empty() { 0.0 } else { bounds.min.abs().max(bounds.max.abs()).max_element() };
    // 1/r² stays finite.
    (greatest * LEAST_RADIUS).max(1e-18)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turning_takes_one_normal_to_the_other() {
        let from = Vec3::new(0.6, 0.0, 0.8);
        let to = Vec3::new(0.0, 0.6, 0.8);
        assert!((turned(from, from, to) - to).length() < 1e-6);
        let w = Vec3::new(0.48, -0.6, 0.64);
        let t = turned(w, from, to);
        assert!((t.length() - 1.0).abs() < 1e-6 && (t.dot(to) - w.dot(from)).abs() < 1e-6);
    }
}
