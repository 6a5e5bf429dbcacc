//! What the tree is made of, as it lies in memory.

use math::{Bounds3, Vec3};

/// Children of a node.
pub(crate) const WIDTH: usize = 8;
/// Triangles of a pack.
pub(crate) const LANES: usize = 4;
/// Vertices of a pack: four triangles of a mesh share most of theirs.
pub(crate) const PACK_VERTICES: usize = 8;

/// What hangs below a node: an index of a node, or of the first item of a leaf, its kind and number of items.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Child(pub u32);

/// What a leaf holds; one kind each.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u32)]
pub(crate) enum Kind {
    Triangles = 0,
    Spheres = 1,
    Disks = 2,
    Instances = 3,
}

const LEAF: u32 = 1 << 31;
const KIND_SHIFT: u32 = 29;
const COUNT_SHIFT: u32 = 27;
const INDEX: u32 = (1 << COUNT_SHIFT) - 1;
/// Most items (packs, spheres, …) of a leaf.
pub(crate) const MAX_ITEMS: usize = 4;

impl Child {
    pub fn node(index: usize) -> Self {
        assert!(index < LEAF as usize, "2³¹ nodes at most");
        Self(index as u32)
    }

    pub fn leaf(kind: Kind, first: usize, items: usize) -> Self {
        assert!(first <= INDEX as usize, "2²⁷ leaf items at most");
        debug_assert!((1..=MAX_ITEMS).contains(&items));
        Self(LEAF | (kind as u32) << KIND_SHIFT | (items as u32 - 1) << COUNT_SHIFT | first as u32)
    }

    #[inline(always)]
    pub fn is_leaf(self) -> bool {
        self.0 & LEAF != 0
    }

    #[inline(always)]
    pub fn kind(self) -> Kind {
        match self.0 >> KIND_SHIFT & 3 {
            0 => Kind::Triangles,
            1 => Kind::Spheres,
            2 => Kind::Disks,
            _ => Kind::Instances,
        }
    }

    #[inline(always)]
    pub fn items(self) -> std::ops::Range<usize> {
        let first = (self.0 & INDEX) as usize;
        first..first + (self.0 >> COUNT_SHIFT & 3) as usize + 1
    }
}

/// Eight boxes side by side, four cache lines.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(crate) struct Node {
    /// Rows min x, max x, min y, max y, min z, max z. A child that is not there has min = +∞, max = −∞.
    pub rows: [[f32; WIDTH]; 6],
    pub children: [Child; WIDTH],
}

impl Node {
    pub fn new(children: &[(Bounds3, Child)]) -> Self {
        let mut node = Self { rows: [[f32::INFINITY; WIDTH]; 6], children: [Child(0); WIDTH] };
        for axis in 0..3 {
            node.rows[2 * axis + 1] = [f32::NEG_INFINITY; WIDTH];
        }
        for (i, (bounds, child)) in children.iter().enumerate() {
            for axis in 0..3 {
                node.rows[2 * axis][i] = bounds.min[axis];
                node.rows[2 * axis + 1][i] = bounds.max[axis];
            }
            node.children[i] = *child;
        }
        node
    }
}

/// Up to four triangles over up to eight vertices, two cache lines.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(crate) struct Pack {
    /// Coordinates x, y, z of the vertices.
    pub rows: [[f32; PACK_VERTICES]; 3],
    /// For each corner 0, 1, 2: the vertex of each triangle.
    pub corners: [[u8; LANES]; 3],
    /// Bit i is set where triangle i is there.
    pub valid: u32,
    /// Index of the first triangle's ids; the others' follow.
    pub first_id: u32,
}

impl Pack {
    const EMPTY: Self =
        Self { rows: [[0.0; PACK_VERTICES]; 3], corners: [[0; LANES]; 3], valid: 0, first_id: 0 };
}

/// A pack while it is filled.
pub(crate) struct PackBuilder {
    pub pack: Pack,
    vertices: usize,
    triangles: usize,
}

impl PackBuilder {
    /// An empty one, whose first triangle has the ids of index `first_id`.
    pub fn new(first_id: u32) -> Self {
        Self { pack: Pack { first_id, ..Pack::EMPTY }, vertices: 0, triangles: 0 }
    }

    /// Adds a triangle where there is room for it and its vertices, and says whether there was.
    pub fn push(&mut self, triangle: [Vec3; 3]) -> bool {
        if self.triangles == LANES {
            return false;
        }
        let before = self.vertices;
        let mut slots = [0u8; 3];
        for (slot, p) in slots.iter_mut().zip(triangle) {
            let key = p.to_array().map(f32::to_bits);
            let known = (0..self.vertices).find(|&v| self.pack.rows.map(|row| row[v].to_bits()) == key);
            if known.is_none() && self.vertices == PACK_VERTICES {
                self.vertices = before;
                return false;
            }
            let v = known.unwrap_or(self.vertices);
            if known.is_none() {
                for axis in 0..3 {
                    self.pack.rows[axis][v] = p[axis];
                }
                self.vertices += 1;
            }
            *slot = v as u8;
        }
        for (corner, slot) in self.pack.corners.iter_mut().zip(slots) {
            corner[self.triangles] = slot;
        }
        self.pack.valid |= 1 << self.triangles;
        self.triangles += 1;
        true
    }
}
