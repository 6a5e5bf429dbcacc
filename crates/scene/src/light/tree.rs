//! A tree of lights (Conty Estévez & Kulla 2018, "Importance sampling of many lights with adaptive tree splitting"): one light is
//! picked, without splitting, from the root down by the importance of the two halves at the receiver.

use std::ops::Range;

use math::{Bounds3, ONE_MINUS_EPSILON};

use super::cone::Cone;
use super::group::{Bounds4, Group, is_local};
use super::{Light, Receiver};

/// Places at which a group may be parted, along each axis.
const BINS: usize = 12;
/// Share of a choice that falls alike on all that may shine at the receiver: bounds know of no walls, and what is seen may be the
/// faintest.
const ALIKE: f32 = 0.05;

/// The lights of a scene that lie at finite places and shine, in groups of up to four.
#[derive(Clone, Debug, Default)]
pub(super) struct LightTree {
    nodes: Vec<Node>,
    /// Where each light is; `None`: nowhere.
    leaves: Vec<Option<Place>>,
}

/// A group in parts.
#[derive(Clone, Debug)]
struct Node {
    bounds: Bounds4,
    parts: [Part; 4],
    /// `None`: the root.
    parent: Option<Place>,
}

#[derive(Clone, Copy, Debug)]
enum Part {
    None,
    Light(u32),
    Node(u32),
}

/// A part of a node.
#[derive(Clone, Copy, Debug)]
struct Place {
    node: u32,
    lane: u32,
}

impl LightTree {
    /// Over those lights of the list that lie at finite places and shine.
    pub fn new(lights: &[Light]) -> Self {
        let mut groups: Vec<(u32, Group)> = (0u32..)
            .zip(lights)
            .filter(|(_, light)| is_local(light))
            .map(|(i, light)| (i, Group::of(light)))
            .collect();
        let mut tree = Self { nodes: Vec::new(), leaves: vec![None; lights.len()] };
        // Ranges of `groups` that are to become nodes.
        let mut open = Vec::new();
        if !groups.is_empty() {
            open.push((None, 0..groups.len()));
        }
        while let Some((parent, range)) = open.pop() {
            let node = tree.nodes.len() as u32;
            if let Some(Place { node: above, lane }) = parent {
                tree.nodes[above as usize].parts[lane as usize] = Part::Node(node);
            }
            let ranges = quarters(&mut groups, range);
            let bounds = Bounds4::new(ranges.iter().map(|range| union(&groups[range.clone()])));
            let mut parts = [Part::None; 4];
            for ((lane, part), range) in (0u32..).zip(&mut parts).zip(ranges) {
                let place = Some(Place { node, lane });
                if let [(light, _)] = groups[range.clone()] {
                    *part = Part::Light(light);
                    tree.leaves[light as usize] = place;
                } else {
                    open.push((place, range));
                }
            }
            tree.nodes.push(Node { bounds, parts, parent });
        }
        tree
    }

    /// A light, its probability and `u` mapped back to [0, 1). `None`: none of them shines there.
    #[inline(never)]
    pub fn sample(&self, at: &Receiver, mut u: f32) -> Option<(usize, f32, f32)> {
        let mut node = self.nodes.first()?;
        let mut pmf = 1.0;
        loop {
            let mut picked = None;
            let mut before = 0.0;
            for (part, share) in node.parts.iter().zip(node.shares(at)) {
                if share > 0.0 && (picked.is_none() || u >= before) {
                    picked = Some((part, share, before));
                }
                before += share;
            }
            let (part, share, before) = picked?;
            pmf *= share;
            u = ((u - before) / share).clamp(0.0, ONE_MINUS_EPSILON);
            match *part {
                Part::Light(light) => return Some((light as usize, pmf, u)),
                Part::Node(next) => node = self.nodes.get(next as usize)?,
                Part::None => return None,
            }
        }
    }

    /// Probability of a light: [`Self::sample`] from the leaf up.
    #[inline(never)]
    pub fn pmf(&self, light: usize, at: &Receiver) -> f32 {
        let mut place = self.leaves.get(light).copied().flatten();
        let mut pmf = if place.is_some() { 1.0 } else { 0.0 };
        while let Some(Place { node, lane }) = place {
            let node = &self.nodes[node as usize];
            pmf *= node.shares(at)[lane as usize];
            place = node.parent;
        }
        pmf
    }
}

impl Node {
    /// Chances of its parts; all 0: none shines there.
    #[inline]
    fn shares(&self, at: &Receiver) -> [f32; 4] {
        let importance = self.bounds.importance(at).to_array();
        let sum: f32 = importance.iter().sum();
        if !(sum > 0.0 && sum.is_finite()) {
            return [0.0; 4];
        }
        let count: f32 = importance.map(|x| if x > 0.0 { 1.0 } else { 0.0 }).iter().sum();
        let (scale, alike) = ((1.0 - ALIKE) / sum, ALIKE / count);
        importance.map(|x| if x > 0.0 { x * scale + alike } else { 0.0 })
    }
}

/// Parts a range of groups into four, fewer where there are fewer.
fn quarters(groups: &mut [(u32, Group)], all: Range<usize>) -> Vec<Range<usize>> {
    let mut halves = |range: Range<usize>| {
        if range.len() < 2 {
            return vec![range];
        }
        let middle = range.start + split(&mut groups[range.clone()]);
        vec![range.start..middle, middle..range.end]
    };
    halves(all).into_iter().flat_map(halves).collect()
}

fn union(groups: &[(u32, Group)]) -> Group {
    let all = groups.iter().map(|(_, g)| *g).reduce(Group::union);
    all.unwrap_or(Group { bounds: Bounds3::EMPTY, cone: Cone::ALL, intensity: 0.0 })
}

/// Puts the groups of one part first and gives their number, from 1 to all but one: the split of least cost
/// (surface area orientation heuristic, §4.4), or the median where no plane parts them.
fn split(groups: &mut [(u32, Group)]) -> usize {
    let middles = Bounds3::of_points(groups.iter().map(|(_, g)| g.bounds.center()));
    let size = middles.size();
    let longest = size.max_element();
    let bin = |g: &Group, axis: usize| {
        let x = (g.bounds.center()[axis] - middles.min[axis]) / size[axis];
        ((x * BINS as f32) as usize).min(BINS - 1)
    };
    let mut best: Option<(f64, usize, usize)> = None;
    for axis in (0..3).filter(|&axis| size[axis] > 0.0) {
        let mut bins: [Option<Group>; BINS] = [None; BINS];
        for (_, g) in groups.iter() {
            let bin = &mut bins[bin(g, axis)];
            *bin = Some(bin.map_or(*g, |b| b.union(*g)));
        }
        // Long thin groups are to be parted across.
        let regular = f64::from(longest / size[axis]);
        for at in 1..BINS {
            let [low, high] =
                [&bins[..at], &bins[at..]].map(|b| b.iter().flatten().copied().reduce(Group::union));
            if let (Some(low), Some(high)) = (low, high) {
                let cost = regular * (cost(&low) + cost(&high));
                if best.is_none_or(|(least, ..)| cost < least) {
                    best = Some((cost, axis, at));
                }
            }
        }
    }
    match best {
        Some((_, axis, at)) => {
            // Stable, so that equal scenes have equal trees.
            groups.sort_by_key(|(_, g)| bin(g, axis) >= at);
            groups.iter().filter(|(_, g)| bin(g, axis) < at).count()
        }
        None => groups.len() / 2,
    }
}

/// Intensity · area of the bounds · measure of the directions. Bounds that are points or segments count by their diagonal.
fn cost(g: &Group) -> f64 {
    let s = g.bounds.size().as_dvec3();
    let area = 2.0 * (s.x * s.y + s.y * s.z + s.z * s.x) + 1e-3 * s.length_squared();
    g.intensity * area * g.cone.measure()
}
