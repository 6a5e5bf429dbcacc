//! Which subtrees of the binary tree become nodes and leaves of the wide one: the cheapest choice, by dynamic
//! programming (Ylitie, Karras & Laine 2017, "Efficient incoherent ray traversal on GPUs through compressed wide
//! BVHs", §3.1).

use super::binary::{BinaryNode, Primitive, children};
use crate::node::{Kind, LANES, WIDTH};

/// Cost of a node's test over that of a pack of triangles.
const NODE_COST: f32 = 1.0;

/// What is cheapest for one subtree of the binary tree.
#[derive(Clone, Copy)]
pub(super) struct Choice {
    /// Expected cost where the subtree is represented by at most 1, 2, … 7 children of a node.
    cost: [f32; WIDTH - 1],
    /// For 2, 3, … 8 children: how many of them go to the left, or 0: one fewer is cheaper.
    left: [u8; WIDTH - 1],
    /// The kind of all primitives, where there is but one.
    pub kind: Option<Kind>,
    /// Represented by one child, that is a leaf.
    pub leaf: bool,
}

impl Choice {
    const NONE: Self =
        Self { cost: [f32::INFINITY; WIDTH - 1], left: [0; WIDTH - 1], kind: None, leaf: false };

    /// How many of the eight children of a wide node go to the left.
    pub fn inner_left(&self) -> usize {
        self.left[WIDTH - 2] as usize
    }
}

/// Cost of a leaf, over that of a pack of triangles; `None` where there can be no such leaf.
fn leaf_cost(kind: Kind, count: u32) -> Option<f32> {
    match kind {
        Kind::Triangles => (count <= LANES as u32).then_some(1.0),
        Kind::Spheres | Kind::Disks => (count <= 2).then_some(0.7 * count as f32),
        Kind::Instances => (count == 1).then_some(8.0),
    }
}

/// The cheapest choice for every node of the (not empty) binary tree.
pub(super) fn plan(tree: &[BinaryNode], primitives: &[Primitive]) -> Vec<Choice> {
    let mut plan = crate::pages::with_huge_pages(tree.len());
    plan.resize(tree.len(), Choice::NONE);
    // Children come after their parents.
    for i in (0..tree.len()).rev() {
        plan[i] = choose(tree, primitives, &plan, i);
    }
    plan
}

fn choose(tree: &[BinaryNode], primitives: &[Primitive], plan: &[Choice], i: usize) -> Choice {
    let node = &tree[i];
    let area = node.half_area();
    let mut choice = Choice::NONE;
    if node.count == 1 {
        let kind = primitives[node.first as usize].kind();
        choice.kind = Some(kind);
        choice.leaf = true;
        choice.cost = [area * leaf_cost(kind, 1).unwrap_or(1.0); WIDTH - 1];
        return choice;
    }
    let (l, r) = children(tree, i);
    let (left, right) = (&plan[l], &plan[r]);
    choice.kind = left.kind.filter(|_| left.kind == right.kind);
    // Eq. 2: the cheapest way to give n children to the two sides.
    let distribute = |n: usize| {
        let mut best = (left.cost[0] + right.cost[n - 2], 1);
        for k in 2..n {
            let cost = left.cost[k - 1] + right.cost[n - k - 1];
            if cost < best.0 {
                best = (cost, k);
            }
        }
        best
    };
    let inner = distribute(WIDTH);
    choice.left[WIDTH - 2] = inner.1 as u8;
    let inner = inner.0 + area * NODE_COST;
    let leaf = choice.kind.and_then(|kind| leaf_cost(kind, node.count)).map(|c| c * area);
    // Costs of giants are infinite or NaN; what cannot be a leaf must not become one.
    choice.leaf = leaf.is_some_and(|leaf| leaf <= inner);
    choice.cost[0] = if choice.leaf { leaf.unwrap_or(inner) } else { inner };
    for n in 2..WIDTH {
        let (cost, k) = distribute(n);
        let fewer = choice.cost[n - 2];
        (choice.cost[n - 1], choice.left[n - 2]) = if cost < fewer { (cost, k as u8) } else { (fewer, 0) };
    }
    choice
}

/// Appends the subtrees that stand for `node` as (up to) `n` children of a wide node.
pub(super) fn cut(tree: &[BinaryNode], plan: &[Choice], node: usize, mut n: usize, out: &mut Vec<usize>) {
    while n > 1 && plan[node].left[n - 2] == 0 {
        n -= 1;
    }
    if n == 1 {
        out.push(node);
        return;
    }
    let k = plan[node].left[n - 2] as usize;
    let (l, r) = children(tree, node);
    cut(tree, plan, l, k, out);
    cut(tree, plan, r, n - k, out);
}
