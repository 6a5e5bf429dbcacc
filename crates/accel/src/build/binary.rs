//! A binary tree from the top down, each split by the surface area heuristic over bins (Wald 2007, "On fast
//! construction of SAH-based bounding volume hierarchies"), down to single primitives.

use math::{Bounds3, Vec3, Vec4};

use super::CHUNK;
use crate::node::{Kind, LANES};

/// A primitive's box; what it is lies in the fourth lanes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Primitive {
    min: Vec4,
    max: Vec4,
}

impl Primitive {
    pub fn new(bounds: &Bounds3, kind: Kind, index: usize) -> Self {
        Self {
            min: bounds.min.extend(f32::from_bits(index as u32)),
            max: bounds.max.extend(f32::from_bits(kind as u32)),
        }
    }

    /// Index among its kind.
    pub fn index(&self) -> usize {
        self.min.w.to_bits() as usize
    }

    pub fn kind(&self) -> Kind {
        match self.max.w.to_bits() {
            0 => Kind::Triangles,
            1 => Kind::Spheres,
            2 => Kind::Disks,
            _ => Kind::Instances,
        }
    }

    /// Twice the centre of the box. The fourth lane means nothing.
    #[inline(always)]
    fn center2(&self) -> Vec4 {
        self.min + self.max
    }
}

/// A box whose fourth lanes mean nothing, so that it is handled four lanes at a time.
#[derive(Clone, Copy, Debug)]
struct Box4 {
    min: Vec4,
    max: Vec4,
}

impl Box4 {
    const EMPTY: Self = Self { min: Vec4::INFINITY, max: Vec4::NEG_INFINITY };

    #[inline(always)]
    fn grow(&mut self, min: Vec4, max: Vec4) {
        self.min = self.min.min(min);
        self.max = self.max.max(max);
    }

    /// Half of the surface; ∞ for the empty box.
    #[inline(always)]
    fn half_area(&self) -> f32 {
        let s = self.max - self.min;
        s.x * (s.y + s.z) + s.y * s.z
    }
}

/// A node of the binary tree over `count` primitives from `first`. Its subtree takes the next 2·count − 1 places:
/// the left child follows at once, the right one 2·(count of the left) places after.
#[derive(Clone, Copy, Debug)]
pub(super) struct BinaryNode {
    min: Vec3,
    pub count: u32,
    max: Vec3,
    pub first: u32,
}

impl BinaryNode {
    const NONE: Self = Self { min: Vec3::INFINITY, count: 0, max: Vec3::NEG_INFINITY, first: 0 };

    pub fn bounds(&self) -> Bounds3 {
        Bounds3 { min: self.min, max: self.max }
    }

    pub fn half_area(&self) -> f32 {
        let s = self.max - self.min;
        s.x * s.y + s.y * s.z + s.z * s.x
    }
}

/// The children of `tree[node]`, which holds two primitives or more.
#[inline]
pub(super) fn children(tree: &[BinaryNode], node: usize) -> (usize, usize) {
    (node + 1, node + 2 * tree[node + 1].count as usize)
}

/// Below this depth a node is cut into halves, whatever it costs, so that the depth stays below
/// `MAX_SAH_DEPTH` + 32.
const MAX_SAH_DEPTH: u32 = 44;

/// The tree in preorder; empty where there is nothing. Reorders the primitives.
pub(super) fn build(primitives: &mut [Primitive]) -> Vec<BinaryNode> {
    if primitives.is_empty() {
        return Vec::new();
    }
    let mut nodes = crate::pages::with_huge_pages(2 * primitives.len() - 1);
    nodes.resize(2 * primitives.len() - 1, BinaryNode::NONE);
    let shared = &*primitives;
    let parts = par::map_chunks(shared.len(), CHUNK, |range| Extent::of(&shared[range]));
    let extent = parts.into_iter().fold(Extent::EMPTY, Extent::union);
    subtree(primitives, &mut nodes, 0, extent, 0);
    nodes
}

/// Boxes around a set of primitives and around their (doubled) centres.
#[derive(Clone, Copy, Debug)]
struct Extent {
    bounds: Box4,
    centers: Box4,
}

impl Extent {
    const EMPTY: Self = Self { bounds: Box4::EMPTY, centers: Box4::EMPTY };

    #[inline(always)]
    fn add(&mut self, p: &Primitive) {
        self.bounds.grow(p.min, p.max);
        let c = p.center2();
        self.centers.grow(c, c);
    }

    fn of(primitives: &[Primitive]) -> Self {
        let mut extent = Self::EMPTY;
        primitives.iter().for_each(|p| extent.add(p));
        extent
    }

    fn union(mut self, other: Self) -> Self {
        self.bounds.grow(other.bounds.min, other.bounds.max);
        self.centers.grow(other.centers.min, other.centers.max);
        self
    }
}

fn subtree(primitives: &mut [Primitive], nodes: &mut [BinaryNode], first: u32, extent: Extent, depth: u32) {
    let count = primitives.len();
    let b = extent.bounds;
    nodes[0] = BinaryNode { min: b.min.truncate(), count: count as u32, max: b.max.truncate(), first };
    if count == 1 {
        return;
    }
    if count == 2 {
        for (i, p) in primitives.iter().enumerate() {
            let (min, max) = (p.min.truncate(), p.max.truncate());
            nodes[1 + i] = BinaryNode { min, count: 1, max, first: first + i as u32 };
        }
        return;
    }
    let split = if depth >= MAX_SAH_DEPTH {
        None
    } else if count <= SWEEP {
        sweep_split(primitives, &extent)
    } else {
        match count {
            0..=256 => binned_split::<16>(primitives, &extent),
            _ => binned_split::<32>(primitives, &extent),
        }
    };
    let (middle, left, right) = split.unwrap_or_else(|| {
        let (l, r) = primitives.split_at(count / 2);
        (count / 2, Extent::of(l), Extent::of(r))
    });
    let (p_left, p_right) = primitives.split_at_mut(middle);
    let (n_left, n_right) = nodes[1..].split_at_mut(2 * middle - 1);
    let mut go_left = || subtree(p_left, n_left, first, left, depth + 1);
    let mut go_right = || subtree(p_right, n_right, first + middle as u32, right, depth + 1);
    if count > CHUNK {
        par::join(go_left, go_right);
    } else {
        go_left();
        go_right();
    }
}

/// The cost of a set in units of one pack's test; what the leaves will be is not known yet, so that a small set
/// counts its packs rather than its primitives.
#[inline(always)]
fn cost_of(count: u32) -> f32 {
    count.div_ceil(4) as f32
}

/// Greatest count for which every order along every axis is tried.
const SWEEP: usize = 16;

/// The best of all cuts of the primitives sorted along one axis; along the longest only, where all of them fit one
/// pack anyway.
fn sweep_split(primitives: &mut [Primitive], extent: &Extent) -> Option<(usize, Extent, Extent)> {
    let count = primitives.len();
    let mut axes = 0..3;
    if count <= LANES {
        let size = extent.centers.max - extent.centers.min;
        let longest =
            if size.x >= size.y && size.x >= size.z { 0 } else { 2 - usize::from(size.y >= size.z) };
        axes = longest..longest + 1;
    }
    let mut best = (f32::INFINITY, [0; SWEEP], 0);
    for axis in axes {
        let mut keys = [f32::INFINITY; SWEEP];
        for (key, p) in keys.iter_mut().zip(primitives.iter()) {
            *key = p.center2()[axis];
        }
        let order = order_of(&keys);
        let mut right_areas = [0f32; SWEEP];
        let mut right = Box4::EMPTY;
        for i in (1..count).rev() {
            let p = &primitives[order[i]];
            right.grow(p.min, p.max);
            right_areas[i] = right.half_area();
        }
        let mut left = Box4::EMPTY;
        for i in 1..count {
            let p = &primitives[order[i - 1]];
            left.grow(p.min, p.max);
            // Packs first, then single primitives, so that equal numbers of packs are told apart.
            let (l, r) = (i as u32, (count - i) as u32);
            let cost = left.half_area() * (cost_of(l) + 0.1 * l as f32)
                + right_areas[i] * (cost_of(r) + 0.1 * r as f32);
            if cost < best.0 {
                best = (cost, order, i);
            }
        }
    }
    let (_, order, cut) = best;
    if cut == 0 {
        return None;
    }
    let mut copy = [primitives[0]; SWEEP];
    copy[..count].copy_from_slice(primitives);
    for (p, &i) in primitives.iter_mut().zip(&order) {
        *p = copy[i];
    }
    Some((cut, Extent::of(&primitives[..cut]), Extent::of(&primitives[cut..])))
}

/// The indices of the keys (none is NaN) in ascending order, equal ones as they stand. Counts for each key those
/// before it, without a branch.
#[inline(always)]
fn order_of(keys: &[f32; SWEEP]) -> [usize; SWEEP] {
    let mut ranks = [0u32; SWEEP];
    for (j, &other) in keys.iter().enumerate() {
        for i in 0..SWEEP {
            ranks[i] += u32::from(if j < i { other <= keys[i] } else { other < keys[i] });
        }
    }
    let mut order = [0; SWEEP];
    for (i, &rank) in ranks.iter().enumerate() {
        order[rank as usize & (SWEEP - 1)] = i;
    }
    order
}

/// Maps centres to bins, the same way wherever it is asked.
#[derive(Clone, Copy)]
struct Binning {
    origin: Vec4,
    scale: Vec4,
}

impl Binning {
    fn new(centers: &Box4, bins: usize) -> Self {
        let size = centers.max - centers.min;
        let scale = |s: f32| {
            let k = bins as f32 * 0.99999 / s;
            if s > 0.0 && k.is_finite() { k } else { 0.0 }
        };
        Self { origin: centers.min, scale: Vec4::new(scale(size.x), scale(size.y), scale(size.z), 0.0) }
    }

    /// A bin for each axis, below `BINS`, a power of two.
    #[inline(always)]
    fn bins<const BINS: usize>(&self, center2: Vec4) -> [usize; 3] {
        // Around 1.5·2²³ the lowest bits count in ones: quicker than a conversion, which saturates.
        let b = (center2 - self.origin) * self.scale - 0.5 + 12_582_912.0;
        [b.x, b.y, b.z].map(|b| b.to_bits() as usize & (BINS - 1))
    }
}

fn binned_split<const BINS: usize>(
    primitives: &mut [Primitive],
    extent: &Extent,
) -> Option<(usize, Extent, Extent)> {
    let binning = Binning::new(&extent.centers, BINS);
    let mut bins = [[Bin::EMPTY; BINS]; 3];
    for p in primitives.iter() {
        for (bins, at) in bins.iter_mut().zip(binning.bins::<BINS>(p.center2())) {
            let bin = &mut bins[at];
            bin.bounds.grow(p.min, p.max);
            bin.count += 1;
        }
    }
    let (axis, cut) = best_cut(&bins, &binning)?;
    let (mut i, mut end) = (0, primitives.len());
    let (mut left, mut right) = (Extent::EMPTY, Extent::EMPTY);
    while i < end {
        if binning.bins::<BINS>(primitives[i].center2())[axis] < cut {
            left.add(&primitives[i]);
            i += 1;
        } else {
            right.add(&primitives[i]);
            end -= 1;
            primitives.swap(i, end);
        }
    }
    (i > 0 && i < primitives.len()).then_some((i, left, right))
}

#[derive(Clone, Copy)]
struct Bin {
    bounds: Box4,
    count: u32,
}

impl Bin {
    const EMPTY: Self = Self { bounds: Box4::EMPTY, count: 0 };
}

/// Axis and first bin of the right side of the cheapest cut.
fn best_cut<const BINS: usize>(bins: &[[Bin; BINS]; 3], binning: &Binning) -> Option<(usize, usize)> {
    let mut best = (f32::INFINITY, 0, 0);
    for (axis, bins) in bins.iter().enumerate() {
        if binning.scale[axis] == 0.0 {
            continue;
        }
        // An empty side costs ∞·0, a NaN, and never wins.
        let mut costs = [0f32; BINS];
        let (mut right, mut n) = (Box4::EMPTY, 0);
        for i in (1..BINS).rev() {
            right.grow(bins[i].bounds.min, bins[i].bounds.max);
            n += bins[i].count;
            costs[i] = right.half_area() * cost_of(n);
        }
        let (mut left, mut n) = (Box4::EMPTY, 0);
        for i in 1..BINS {
            left.grow(bins[i - 1].bounds.min, bins[i - 1].bounds.max);
            n += bins[i - 1].count;
            costs[i] += left.half_area() * cost_of(n);
        }
        for (i, &cost) in costs.iter().enumerate().skip(1) {
            if cost < best.0 {
                best = (cost, axis, i);
            }
        }
    }
    (best.2 > 0).then_some((best.1, best.2))
}
