use math::{Bounds3, Vec3};

use crate::kdtree::KdTree;
use crate::leaf::{LEAF, ROOM, prefetch, unpack};

/// A point that a search found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Its place in tree order.
    pub slot: u32,
    /// Its squared distance from the centre.
    pub distance2: f32,
}

/// Memory of k-nearest searches, reused from one to the next: 16 bytes for each of k.
#[derive(Clone, Debug, Default)]
pub struct Scratch {
    candidates: Vec<u64>,
}

impl Scratch {
    /// Empty; grows with the first search.
    pub fn new() -> Self {
        Self::default()
    }
}

/// The answer of [`KdTree::nearest`].
#[derive(Clone, Copy, Debug)]
pub struct Nearest<'a> {
    found: &'a [u64],
    limited: bool,
}

impl<'a> Nearest<'a> {
    /// How many were found: k, or all within the greatest radius where these are fewer.
    pub fn len(&self) -> usize {
        self.found.len()
    }

    /// Whether nothing was found.
    pub fn is_empty(&self) -> bool {
        self.found.is_empty()
    }

    /// The farthest where k were found; `None` where fewer were.
    pub fn kth(&self) -> Option<Hit> {
        self.found.last().filter(|_| self.limited).map(|&c| hit(c))
    }

    /// The points: in no useful order, but the k-th comes last.
    pub fn hits(&self) -> impl Iterator<Item = Hit> + 'a {
        self.found.iter().map(|&c| hit(c))
    }
}

#[inline]
fn hit(candidate: u64) -> Hit {
    let (distance2, slot) = unpack(candidate);
    Hit { slot, distance2 }
}

/// A subtree that is still to be searched.
#[derive(Clone, Copy)]
struct Pending {
    node: u32,
    first_leaf: u32,
    leaves: u32,
    /// Distance from the centre to the cell along each axis.
    offset: [f32; 3],
    distance2: f32,
}

impl Pending {
    /// Both halves, with the distances of the whole.
    #[inline]
    fn children(&self) -> (Self, Self) {
        let half = self.leaves / 2;
        let left = Self { node: self.node + 1, leaves: half, ..*self };
        let right = Self {
            node: self.node + half,
            first_leaf: self.first_leaf + half,
            leaves: self.leaves - half,
            ..*self
        };
        (left, right)
    }
}

/// Subtrees wait at most one a level; 2³² points make 2²⁶ leaves.
const MAX_DEPTH: usize = 32;

/// (x² + y²) + z², rounded as in the leaf scans: since rounding is monotone, the bound of a box computed so never
/// exceeds the computed distance of a point inside, and pruning loses nothing.
#[inline]
fn square(v: [f32; 3]) -> f32 {
    (v[0] * v[0] + v[1] * v[1]) + v[2] * v[2]
}

#[inline]
fn box_distance2(bounds: &Bounds3, c: Vec3) -> f32 {
    let d = (bounds.min - c).max(c - bounds.max).max(Vec3::ZERO);
    square(d.to_array())
}

/// What is asked of each leaf that a search reaches.
pub(crate) trait Scan {
    /// Appends the candidates of a leaf whose key is at most `bound` to `out`, which has [`ROOM`]; returns how many.
    fn scan(&self, leaf: usize, bound: f32, out: &mut [u64]) -> usize;
    /// Called some time before `scan`.
    fn prefetch(&self, leaf: usize);
}

/// Every point is a candidate.
struct Positions<'a> {
    tree: &'a KdTree,
    center: Vec3,
}

impl Scan for Positions<'_> {
    #[inline]
    fn scan(&self, leaf: usize, bound: f32, out: &mut [u64]) -> usize {
        self.tree.isa.scan(&self.tree.blocks[leaf], self.center, bound, (leaf * LEAF) as u32, out)
    }

    #[inline]
    fn prefetch(&self, leaf: usize) {
        prefetch(&self.tree.blocks[leaf]);
    }
}

/// Leaves that a fixed-radius search collects before it scans the first of them.
const AHEAD: usize = 16;
/// Subtrees of so many leaves are not walked by a fixed-radius search: each leaf is tested.
const TESTED: usize = 8;

impl KdTree {
    /// Calls `visit` for each point within `radius` of `center` (boundary included), leaf by leaf.
    #[inline]
    pub fn within(&self, center: Vec3, radius: f32, mut visit: impl FnMut(Hit)) {
        self.search_within(center, radius, &Positions { tree: self, center }, |found| {
            found.iter().for_each(|&c| visit(hit(c)));
        });
    }

    /// The `k` points nearest to `center` among those within `max_radius` (boundary included). Among points at
    /// equal distance the lower slot is nearer. O(k + log n) for points on a surface.
    pub fn nearest<'s>(
        &self,
        center: Vec3,
        k: usize,
        max_radius: f32,
        scratch: &'s mut Scratch,
    ) -> Nearest<'s> {
        let found = self.search_nearest(center, k, max_radius, scratch, &Positions { tree: self, center });
        Nearest { found, limited: found.len() == k }
    }

    /// Calls `visit` with the candidates of each leaf that comes within `radius`.
    #[inline]
    pub(crate) fn search_within(
        &self,
        center: Vec3,
        radius: f32,
        scan: &impl Scan,
        mut visit: impl FnMut(&[u64]),
    ) {
        if radius.is_nan() || radius < 0.0 {
            return;
        }
        let bound = radius * radius;
        let mut found = [0; ROOM];
        // The radius never changes, so the leaves can be found first and fetched together.
        self.leaves_within(center, bound, |leaves| {
            for &leaf in leaves {
                scan.prefetch(leaf as usize);
            }
            for &leaf in leaves {
                let count = scan.scan(leaf as usize, bound, &mut found);
                visit(&found[..count.min(ROOM)]);
            }
        });
    }

    /// Calls `visit` with a few leaves at a time, all of those whose squared distance from `center` is at most
    /// `bound`. The order is that of the tree: nothing is gained from near ones first.
    #[inline]
    fn leaves_within(&self, center: Vec3, bound: f32, mut visit: impl FnMut(&[u32])) {
        if self.blocks.is_empty() {
            return;
        }
        let c = center.to_array();
        let mut leaves = [0; AHEAD + TESTED];
        let mut waiting = 0;
        let mut stack = [self.root(); MAX_DEPTH];
        let mut depth = 0;
        let mut at = self.root();
        loop {
            while at.leaves as usize > TESTED {
                let node = &self.nodes[at.node as usize];
                let axis = (node.axis % 3) as usize;
                let (mut left, mut right) = at.children();
                left.offset[axis] = at.offset[axis].max(c[axis] - node.left_max);
                right.offset[axis] = at.offset[axis].max(node.right_min - c[axis]);
                let (in_left, in_right) = (square(left.offset) <= bound, square(right.offset) <= bound);
                at = left;
                if !in_left {
                    if !in_right {
                        at.leaves = 0;
                        break;
                    }
                    at = right;
                } else if in_right {
                    stack[depth % MAX_DEPTH] = right;
                    depth += 1;
                }
            }
            // A few boxes are tested faster than nodes are walked, and without a branch.
            for leaf in at.first_leaf..at.first_leaf + at.leaves {
                leaves[waiting] = leaf;
                waiting += usize::from(box_distance2(&self.leaf_bounds[leaf as usize], center) <= bound);
            }
            if waiting >= AHEAD {
                visit(&leaves[..waiting]);
                waiting = 0;
            }
            if depth == 0 {
                break;
            }
            depth -= 1;
            at = stack[depth % MAX_DEPTH];
        }
        visit(&leaves[..waiting]);
    }

    /// The k least candidates, the k-th in the last place; fewer where there are fewer.
    ///
    /// Candidates are gathered unsorted in a buffer of about 2k; when it is full, quickselect keeps the k least,
    /// which shrinks the radius: only the k-th distance is ever needed.
    #[inline]
    pub(crate) fn search_nearest<'s>(
        &self,
        center: Vec3,
        k: usize,
        max_radius: f32,
        scratch: &'s mut Scratch,
        scan: &impl Scan,
    ) -> &'s [u64] {
        let k = k.min(self.len);
        if k == 0 || max_radius.is_nan() || max_radius < 0.0 {
            return &[];
        }
        let full = 2 * k;
        let room = full + ROOM;
        if scratch.candidates.len() < room {
            scratch.candidates.resize(room, 0);
        }
        let buffer = &mut scratch.candidates[..];
        let mut count = 0;
        self.traverse(center, max_radius * max_radius, |leaf, bound| {
            count += scan.scan(leaf, bound, &mut buffer[count..]);
            if count < full {
                return bound;
            }
            let (_, kth, _) = buffer[..count].select_nth_unstable(k - 1);
            count = k;
            unpack(*kth).0
        });
        if count >= k {
            buffer[..count].select_nth_unstable(k - 1);
            count = k;
        }
        &scratch.candidates[..count]
    }

    #[inline]
    fn root(&self) -> Pending {
        let leaves = self.blocks.len() as u32;
        Pending { node: 0, first_leaf: 0, leaves, offset: [0.0; 3], distance2: 0.0 }
    }

    /// Calls `visit(leaf, bound)` for the leaves whose squared distance from `center` is at most `bound`, near ones
    /// first as far as the tree knows; `visit` returns the next bound, no greater than the last.
    #[inline]
    fn traverse(&self, center: Vec3, mut bound: f32, mut visit: impl FnMut(usize, f32) -> f32) {
        if self.blocks.is_empty() {
            return;
        }
        let c = center.to_array();
        let mut stack = [self.root(); MAX_DEPTH];
        let mut depth = 0;
        let mut at = self.root();
        loop {
            while at.leaves > 1 {
                let node = &self.nodes[at.node as usize];
                let axis = (node.axis % 3) as usize;
                let (past_left, before_right) = (c[axis] - node.left_max, node.right_min - c[axis]);
                let (mut near, mut far) = at.children();
                near.offset[axis] = at.offset[axis].max(past_left);
                far.offset[axis] = at.offset[axis].max(before_right);
                if past_left > before_right {
                    std::mem::swap(&mut near, &mut far);
                }
                far.distance2 = square(far.offset);
                near.distance2 = square(near.offset);
                if far.distance2 <= bound {
                    stack[depth % MAX_DEPTH] = far;
                    depth += 1;
                }
                at = near;
            }
            let leaf = at.first_leaf as usize;
            if at.distance2 <= bound && box_distance2(&self.leaf_bounds[leaf], center) <= bound {
                bound = visit(leaf, bound);
            }
            loop {
                if depth == 0 {
                    return;
                }
                depth -= 1;
                at = stack[depth % MAX_DEPTH];
                if at.distance2 <= bound {
                    break;
                }
            }
        }
    }
}

const _: () = assert!(size_of::<Pending>() == 28);
