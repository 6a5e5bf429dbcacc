//! The walk down the tree, nearest child first.
#![allow(unsafe_code)]

use std::mem::MaybeUninit;

use math::Ray;

use super::{Kernel, NodeHits};
use crate::NO_INSTANCE;
use crate::bvh::{Bvh, Hit};
use crate::node::{Child, Kind, Node, WIDTH};

/// The nearest hit so far.
pub(crate) struct Best {
    /// Its t, or the end of the ray.
    t: f32,
    u: f32,
    v: f32,
    /// (instance, geom, prim).
    key: (u32, u32, u32),
    pub(super) found: bool,
}

impl Best {
    #[inline]
    pub fn new(t_max: f32) -> Self {
        Self { t: t_max, u: 0.0, v: 0.0, key: (0, 0, 0), found: false }
    }

    #[inline]
    pub fn into_hit(self) -> Option<Hit> {
        let (instance, geom, prim) = self.key;
        self.found.then_some(Hit { t: self.t, u: self.u, v: self.v, geom, prim, instance })
    }
}

/// A hit of this tree whose ids have not been looked up yet.
const NO_SLOT: usize = usize::MAX;

/// One tree's search. Ids are looked up at the end: most hits are replaced by nearer ones.
struct Local<'a> {
    bvh: &'a Bvh,
    best: &'a mut Best,
    slot: usize,
    instance: u32,
}

impl Local<'_> {
    #[inline(always)]
    fn key(&self, slot: usize) -> (u32, u32, u32) {
        let [geom, prim] = self.bvh.ids[slot];
        (self.instance, geom, prim)
    }

    /// Takes a hit of 0 < t where it comes before the best.
    #[inline(always)]
    fn offer(&mut self, t: f32, u: f32, v: f32, slot: usize) {
        let wins = t < self.best.t || (t == self.best.t && self.wins_tie(slot));
        if wins {
            (self.best.t, self.best.u, self.best.v) = (t, u, v);
            self.best.found = true;
            self.slot = slot;
        }
    }

    #[cold]
    fn wins_tie(&self, slot: usize) -> bool {
        let best = if self.slot == NO_SLOT { self.best.key } else { self.key(self.slot) };
        self.best.found && self.key(slot) < best
    }

    /// How far boxes matter: boxes that start where the best hit lies may hold one at the same t; rounding of t is
    /// allowed for.
    #[inline(always)]
    fn end(&self) -> f32 {
        self.best.t * (1.0 + 1e-6)
    }

    fn finish(&mut self) {
        if self.slot != NO_SLOT {
            self.best.key = self.key(self.slot);
        }
    }
}

/// The wide tree is no deeper than the binary one (44 + 32 levels), and each level leaves 7 children at most.
const STACK: usize = 80 * (WIDTH - 1);

/// Room for a stack; on its own, lest it be cleared for every ray.
type Room = [MaybeUninit<u64>; STACK];

/// An entry is a child and where the ray enters its box, as bits, which are in the order of the numbers since these
/// are not negative.
struct Stack<'a> {
    entries: &'a mut Room,
    len: usize,
}

impl Stack<'_> {
    #[inline(always)]
    fn push(&mut self, entry: u64) {
        self.entries[self.len] = MaybeUninit::new(entry);
        self.len += 1;
    }

    /// The entry at `i` < `len`.
    #[inline(always)]
    fn at(&self, i: usize) -> u64 {
        debug_assert!(i < self.len);
        // SAFETY: entries below `len` were written by `push`, the only one to raise it.
        unsafe { self.entries[i].assume_init() }
    }

    /// The next child that the ray enters before `end`.
    #[inline(always)]
    fn pop(&mut self, end: f32) -> Option<Child> {
        while self.len > 0 {
            let entry = self.at(self.len - 1);
            self.len -= 1;
            if f32::from_bits((entry >> 32) as u32) <= end {
                return Some(Child(entry as u32));
            }
        }
        None
    }

    /// Sorts the entries from `start`, the nearest last.
    #[inline(always)]
    fn sort_from(&mut self, start: usize) {
        for i in start + 1..self.len {
            let moving = self.at(i);
            let mut j = i;
            while j > start && self.at(j - 1) < moving {
                self.entries[j] = MaybeUninit::new(self.at(j - 1));
                j -= 1;
            }
            self.entries[j] = MaybeUninit::new(moving);
        }
    }
}

/// A child's entry; its memory is on the way from now on.
#[inline(always)]
fn entry<K: Kernel>(kernel: &K, bvh: &Bvh, node: &Node, hits: &NodeHits, i: usize) -> u64 {
    let child = node.children[i];
    // Of the rare kinds of leaves, something else is fetched in vain.
    let address = if child.is_leaf() {
        bvh.packs.as_ptr().wrapping_add(child.items().start).cast::<u8>()
    } else {
        bvh.nodes.as_ptr().wrapping_add(child.0 as usize).cast::<u8>()
    };
    kernel.prefetch(address);
    u64::from(hits.near.0[i].to_bits()) << 32 | u64::from(child.0)
}

/// Searches the whole tree; `ANY`: until the first hit, whichever it is.
#[inline(always)]
pub(super) fn traverse<K: Kernel, const ANY: bool>(
    kernel: &K,
    bvh: &Bvh,
    ray: &Ray,
    best: &mut Best,
    instance: u32,
) {
    let Some(mut at) = bvh.root else { return };
    let mut room: Room = [const { MaybeUninit::uninit() }; STACK];
    let mut stack = Stack { entries: &mut room, len: 0 };
    let mut local = Local { bvh, best, slot: NO_SLOT, instance };
    let mut end = local.end();
    'walk: loop {
        while !at.is_leaf() {
            let node = &bvh.nodes[at.0 as usize];
            let hits = kernel.node(node, end);
            let mut mask = hits.mask;
            let mut take = || {
                let i = mask.trailing_zeros() as usize;
                mask &= mask.wrapping_sub(1);
                i & (WIDTH - 1)
            };
            match hits.mask.count_ones() {
                0 => match stack.pop(end) {
                    Some(next) => at = next,
                    None => break 'walk,
                },
                1 => at = node.children[take()],
                2 => {
                    let a = entry(kernel, bvh, node, &hits, take());
                    let b = entry(kernel, bvh, node, &hits, take());
                    stack.push(a.max(b));
                    at = Child(a.min(b) as u32);
                }
                // Sorted without a branch that could be mispredicted; more than three are rare.
                3 if !ANY => {
                    let a = entry(kernel, bvh, node, &hits, take());
                    let b = entry(kernel, bvh, node, &hits, take());
                    let c = entry(kernel, bvh, node, &hits, take());
                    let (low, high) = (a.min(b), a.max(b));
                    let rest = high.min(c);
                    stack.push(high.max(c));
                    stack.push(low.max(rest));
                    at = Child(low.min(rest) as u32);
                }
                n => {
                    let start = stack.len;
                    for _ in 0..n {
                        stack.push(entry(kernel, bvh, node, &hits, take()));
                    }
                    if !ANY {
                        stack.sort_from(start);
                    }
                    match stack.pop(end) {
                        Some(next) => at = next,
                        None => break 'walk,
                    }
                }
            }
        }
        match at.kind() {
            Kind::Triangles => {
                for pack in &bvh.packs[at.items()] {
                    let hits = kernel.pack(pack, local.best.t);
                    let mut mask = hits.mask;
                    while mask != 0 {
                        let i = mask.trailing_zeros() as usize & 3;
                        mask &= mask - 1;
                        local.offer(hits.t.0[i], hits.u.0[i], hits.v.0[i], pack.first_id as usize + i);
                    }
                }
            }
            kind => {
                // An instance's search goes on from the best hit of this one, ids and all.
                local.finish();
                local.slot = NO_SLOT;
                others::<K, ANY>(kernel, &mut local, ray, at, kind);
            }
        }
        if ANY && local.best.found {
            break;
        }
        end = local.end();
        match stack.pop(end) {
            Some(next) => at = next,
            None => break,
        }
    }
    local.finish();
}

/// Leaves of anything but triangles.
#[inline(never)]
fn others<K: Kernel, const ANY: bool>(kernel: &K, local: &mut Local<'_>, ray: &Ray, leaf: Child, kind: Kind) {
    let bvh = local.bvh;
    match kind {
        Kind::Triangles => {}
        Kind::Spheres => {
            for i in leaf.items() {
                if let Some(t) = bvh.spheres[i].intersect(ray) {
                    local.offer(t, 0.0, 0.0, bvh.first_sphere_id + i);
                }
            }
        }
        Kind::Disks => {
            for i in leaf.items() {
                if let Some(t) = bvh.disks[i].intersect(ray) {
                    local.offer(t, 0.0, 0.0, bvh.first_disk_id + i);
                }
            }
        }
        Kind::Instances => {
            for instance in &bvh.instances[leaf.items()] {
                // t stays what it is, since the direction is not normalised.
                let inner = Ray {
                    origin: instance.transform.inverse_matrix().transform_point3(ray.origin),
                    direction: instance.transform.inverse_matrix().transform_vector3(ray.direction),
                    t_max: ray.t_max,
                };
                if super::is_sound(&inner) {
                    debug_assert!(local.instance == NO_INSTANCE && !instance.bvh.holds_instances());
                    kernel.search::<ANY>(&instance.bvh, &inner, local.best, instance.geom);
                }
            }
        }
    }
}
