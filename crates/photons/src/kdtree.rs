use math::{Bounds3, Vec3};

use crate::leaf::{Block, Isa, LEAF};

/// A kd-tree over points: leaves of 64 points as structure of arrays, all full but the last, and a balanced tree
/// of inner nodes in preorder above them, whose shape follows from the number of leaves alone.
///
/// Points are addressed by *slot*, their place in tree order. 12.5 bytes a point.
#[derive(Clone, Debug)]
pub struct KdTree {
    pub(crate) len: usize,
    pub(crate) bounds: Bounds3,
    pub(crate) nodes: Vec<Node>,
    pub(crate) leaf_bounds: Vec<Bounds3>,
    pub(crate) blocks: Vec<Block>,
    pub(crate) isa: Isa,
}

/// An inner node over c leaves: the first c/2 hold the points up to `left_max` on `axis`, the others those from
/// `right_min` on. The left child is the next node, the right child the (c/2)th after this one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Node {
    pub(crate) left_max: f32,
    pub(crate) right_min: f32,
    pub(crate) axis: u32,
}

/// A point and its index in the input, while the tree is built.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
struct Record {
    position: [f32; 3],
    index: u32,
}

/// Subtrees of fewer leaves are built by one thread.
const PARALLEL_LEAVES: usize = 64;

impl KdTree {
    /// The tree over those of `points` that are finite, and for each slot the index of its point in `points`.
    ///
    /// Built on the threads of the enclosing [`par::Workers::run`]; the result does not depend on their number.
    /// Order along an axis is by coordinate, then by index, so that equal points are no special case. Points after
    /// the first 2³² − 1 are left out like those that are not finite. O(n log n).
    pub fn build(points: &[Vec3]) -> (Self, Vec<u32>) {
        let finite = |(i, p): (usize, &Vec3)| {
            let index = u32::try_from(i).ok().filter(|&i| i < u32::MAX && p.is_finite())?;
            Some(Record { position: p.to_array(), index })
        };
        let mut records: Vec<Record> = points.iter().enumerate().filter_map(finite).collect();
        let leaves = records.len().div_ceil(LEAF);
        let mut tree = Self {
            len: records.len(),
            bounds: bounds_of(&records),
            nodes: vec![Node { left_max: 0.0, right_min: 0.0, axis: 0 }; leaves.saturating_sub(1)],
            leaf_bounds: vec![Bounds3::EMPTY; leaves],
            blocks: vec![Block::EMPTY; leaves],
            isa: Isa::detect(),
        };
        if leaves > 0 {
            let part = Part {
                records: &mut records,
                nodes: &mut tree.nodes,
                leaf_bounds: &mut tree.leaf_bounds,
                blocks: &mut tree.blocks,
            };
            part.build(tree.bounds);
        }
        (tree, records.iter().map(|r| r.index).collect())
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Smallest box that holds the points.
    pub fn bounds(&self) -> Bounds3 {
        self.bounds
    }

    /// The point in `slot`.
    ///
    /// # Panics
    /// Where `slot` lies beyond the last leaf.
    #[inline]
    pub fn position(&self, slot: u32) -> Vec3 {
        self.blocks[slot as usize / LEAF].position(slot as usize % LEAF)
    }

    /// Size on the heap, in bytes.
    pub fn memory_bytes(&self) -> usize {
        size_of_val(&self.nodes[..]) + size_of_val(&self.leaf_bounds[..]) + size_of_val(&self.blocks[..])
    }

    /// The same tree, searched without SIMD instructions. Answers are the same to the bit.
    pub fn portable(mut self) -> Self {
        self.isa = Isa::Portable;
        self
    }
}

fn bounds_of(records: &[Record]) -> Bounds3 {
    Bounds3::of_points(records.iter().map(|r| Vec3::from_array(r.position)))
}

/// Ascending by coordinate, then by index: no two records are equal.
#[inline]
fn order(r: &Record, axis: usize) -> u64 {
    let bits = r.position[axis].to_bits();
    let flip = ((bits as i32 >> 31) as u32) | 0x8000_0000;
    u64::from(bits ^ flip) << 32 | u64::from(r.index)
}

/// What one subtree is built from and into.
struct Part<'a> {
    records: &'a mut [Record],
    nodes: &'a mut [Node],
    leaf_bounds: &'a mut [Bounds3],
    blocks: &'a mut [Block],
}

impl Part<'_> {
    fn build(self, bounds: Bounds3) {
        let leaves = self.blocks.len();
        if leaves == 1 {
            self.leaf_bounds[0] = bounds;
            for (i, r) in self.records.iter().enumerate() {
                [self.blocks[0].x[i], self.blocks[0].y[i], self.blocks[0].z[i]] = r.position;
            }
            return;
        }
        let size = bounds.size();
        let axis = if size.x >= size.y && size.x >= size.z {
            0
        } else if size.y >= size.z {
            1
        } else {
            2
        };
        let middle = leaves / 2;
        self.records.select_nth_unstable_by_key(middle * LEAF, |r| order(r, axis));
        let (left_records, right_records) = self.records.split_at_mut(middle * LEAF);
        let (left_bounds, right_bounds) = (bounds_of(left_records), bounds_of(right_records));
        let Some((node, nodes)) = self.nodes.split_first_mut() else { return };
        *node =
            Node { left_max: left_bounds.max[axis], right_min: right_bounds.min[axis], axis: axis as u32 };
        let (left_nodes, right_nodes) = nodes.split_at_mut(middle - 1);
        let (left_leaf_bounds, right_leaf_bounds) = self.leaf_bounds.split_at_mut(middle);
        let (left_blocks, right_blocks) = self.blocks.split_at_mut(middle);
        let left = Part {
            records: left_records,
            nodes: left_nodes,
            leaf_bounds: left_leaf_bounds,
            blocks: left_blocks,
        };
        let right = Part {
            records: right_records,
            nodes: right_nodes,
            leaf_bounds: right_leaf_bounds,
            blocks: right_blocks,
        };
        if leaves < PARALLEL_LEAVES {
            left.build(left_bounds);
            right.build(right_bounds);
        } else {
            par::join(|| left.build(left_bounds), || right.build(right_bounds));
        }
    }
}
