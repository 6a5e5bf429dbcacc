//! Lays the wide tree out in memory.

use math::Vec3;

use super::binary::{BinaryNode, Primitive};
use super::collapse::{self, Choice};
use crate::geometry::Geometry;
use crate::node::{Child, Kind, LANES, Node, Pack, PackBuilder, WIDTH};
use crate::pages::with_huge_pages;

#[derive(Default)]
pub(super) struct Emitted {
    pub root: Option<Child>,
    pub nodes: Vec<Node>,
    pub packs: Vec<Pack>,
    /// (geom, prim) of the packs' triangles.
    pub triangle_ids: Vec<[u32; 2]>,
    /// For each kind but triangles, the order in which its primitives lie in the leaves.
    pub order: [Vec<u32>; 4],
}

/// The tree before its leaves are filled.
struct Skeleton {
    /// Subtrees of the binary tree that are the children of each wide node, one node after the other.
    children: Vec<usize>,
    /// For each wide node, where its children start; one entry more than nodes.
    starts: Vec<usize>,
    /// For each of `children`: its node or its place in `leaves`.
    targets: Vec<Target>,
    /// Leaves of triangles, as nodes of the binary tree.
    leaves: Vec<usize>,
}

#[derive(Clone, Copy)]
enum Target {
    Node(usize),
    Triangles(usize),
    Other(Child),
}

/// The (not empty) binary tree, cut as planned.
pub(super) fn emit(
    geometry: &Geometry,
    tree: &[BinaryNode],
    primitives: &[Primitive],
    plan: &[Choice],
) -> Emitted {
    let mut out = Emitted::default();
    let skeleton = skeleton(tree, primitives, plan, &mut out.order);
    let items = fill_packs(geometry, tree, primitives, &skeleton.leaves, &mut out);
    let child_of = |target: Target| match target {
        Target::Node(i) => Child::node(i),
        Target::Triangles(i) => Child::leaf(Kind::Triangles, items[i].0, items[i].1),
        Target::Other(child) => child,
    };
    let count = skeleton.starts.len() - 1;
    out.nodes = with_huge_pages(count);
    for i in 0..count {
        let mut children = [(math::Bounds3::EMPTY, Child(0)); WIDTH];
        let range = skeleton.starts[i]..skeleton.starts[i + 1];
        let filled = &mut children[..range.len()];
        for (slot, j) in filled.iter_mut().zip(range) {
            *slot = (tree[skeleton.children[j]].bounds(), child_of(skeleton.targets[j]));
        }
        out.nodes.push(Node::new(filled));
    }
    out.root = Some(Child::node(0));
    out
}

/// Nodes in depth-first order, but those of one parent side by side.
fn skeleton(
    tree: &[BinaryNode],
    primitives: &[Primitive],
    plan: &[Choice],
    order: &mut [Vec<u32>; 4],
) -> Skeleton {
    // (wide node, its subtree), and how each wide node was numbered.
    let mut todo = vec![(0, 0)];
    let mut next = 1;
    let mut cuts: Vec<(usize, usize)> = vec![(0, 0)];
    let (mut children, mut targets, mut leaves) = (Vec::new(), Vec::new(), Vec::new());
    while let Some((wide, subtree)) = todo.pop() {
        let start = children.len();
        if subtree == 0 && plan[0].leaf {
            children.push(0);
        } else {
            let (l, r) = super::binary::children(tree, subtree);
            let k = plan[subtree].inner_left();
            collapse::cut(tree, plan, l, k, &mut children);
            collapse::cut(tree, plan, r, WIDTH - k, &mut children);
        }
        cuts[wide] = (start, children.len());
        let first_todo = todo.len();
        for &child in &children[start..] {
            let (node, choice) = (&tree[child], &plan[child]);
            targets.push(match choice.kind {
                Some(Kind::Triangles) if choice.leaf => {
                    leaves.push(child);
                    Target::Triangles(leaves.len() - 1)
                }
                Some(kind) if choice.leaf => {
                    let order = &mut order[kind as usize];
                    let (first, count) = (node.first as usize, node.count as usize);
                    let leaf = Child::leaf(kind, order.len(), count);
                    order.extend(primitives[first..first + count].iter().map(|p| p.index() as u32));
                    Target::Other(leaf)
                }
                _ => {
                    todo.push((next, child));
                    cuts.push((0, 0));
                    next += 1;
                    Target::Node(next - 1)
                }
            });
        }
        todo[first_todo..].reverse();
    }
    reorder(cuts, children, targets, leaves)
}

/// Puts the children, found in the order of the walk, into the order of their nodes' numbers.
fn reorder(cuts: Vec<(usize, usize)>, found: Vec<usize>, at: Vec<Target>, leaves: Vec<usize>) -> Skeleton {
    let mut out = Skeleton { children: Vec::new(), starts: vec![0], targets: Vec::new(), leaves };
    for (start, end) in cuts {
        out.children.extend_from_slice(&found[start..end]);
        out.targets.extend_from_slice(&at[start..end]);
        out.starts.push(out.children.len());
    }
    out
}

/// Fills the packs of all leaves; for each leaf, its first pack and how many it has.
fn fill_packs(
    geometry: &Geometry,
    tree: &[BinaryNode],
    primitives: &[Primitive],
    leaves: &[usize],
    out: &mut Emitted,
) -> Vec<(usize, usize)> {
    let chunks = par::map_chunks(leaves.len(), 4096, |range| {
        let mut packs = Vec::with_capacity(range.len());
        let mut ids = Vec::with_capacity(range.len() * LANES);
        let mut counts = Vec::with_capacity(range.len());
        for &leaf in &leaves[range] {
            let node = &tree[leaf];
            let before = packs.len();
            let mut builder = PackBuilder::new(ids.len() as u32);
            for p in &primitives[node.first as usize..(node.first + node.count) as usize] {
                let corners: [Vec3; 3] =
                    geometry.triangles[p.index()].map(|i| geometry.positions[i as usize]);
                if !builder.push(corners) {
                    packs.push(builder.pack);
                    builder = PackBuilder::new(ids.len() as u32);
                    builder.push(corners);
                }
                ids.push(geometry.triangle_ids[p.index()]);
            }
            packs.push(builder.pack);
            counts.push(packs.len() - before);
        }
        (packs, ids, counts)
    });
    out.packs = with_huge_pages(chunks.iter().map(|c| c.0.len()).sum());
    out.triangle_ids = with_huge_pages(chunks.iter().map(|c| c.1.len()).sum());
    let mut items = Vec::with_capacity(leaves.len());
    for (mut packs, ids, counts) in chunks {
        let mut first = out.packs.len();
        for count in counts {
            items.push((first, count));
            first += count;
        }
        let base = out.triangle_ids.len() as u32;
        packs.iter_mut().for_each(|p| p.first_id += base);
        out.packs.append(&mut packs);
        out.triangle_ids.extend_from_slice(&ids);
    }
    items
}
