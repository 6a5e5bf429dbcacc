//! A tree of lights: Conty Estévez & Kulla 2018, "Importance sampling of many lights with adaptive tree splitting"; one light is
//! picked, without splitting, from the root down by the importance of the two halves at the receiver.

use math::{Bounds3, PI, Vec3};

use super::cone::Cone;
use super::{Light, Receiver};

const NONE: u32 = u32::MAX;
/// Places at which a group may be parted, along each axis.
const BINS: usize = 12;
/// Least share of a group's intensity that it keeps however it is turned: so that no rounding loses light along a horizon.
const LEAST_COSINE: f32 = 0.01;
/// By how much cosines may be off before a group counts as turned away.
const SLACK: f32 = 2e-3;

/// The lights of a scene that lie at finite places and shine.
#[derive(Clone, Debug, Default)]
pub(super) struct LightTree {
    nodes: Vec<Node>,
    /// The leaf of each light; [`NONE`]: it has none.
    leaves: Vec<u32>,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    center: Vec3,
    /// Half the diagonal of the bounds, squared.
    radius2: f32,
    axis: Vec3,
    cos_spread: f32,
    sin_spread: f32,
    /// Of the angle beyond which nothing leaves.
    cos_reach: f32,
    /// W/sr.
    intensity: f32,
    parent: u32,
    /// The first child, the second follows; [`NONE`]: a leaf.
    child: u32,
    /// Of a leaf.
    light: u32,
}

/// What a group's bounds are made of.
#[derive(Clone, Copy)]
struct Group {
    bounds: Bounds3,
    cone: Cone,
    intensity: f64,
}

impl Group {
    fn of(light: &Light) -> Self {
        let cone = Cone::of(light);
        // Flux over the solid angle that a light of this kind fills at its greatest intensity.
        let solid_angle = match light {
            Light::Spot(l) => l.solid_angle() as f32,
            Light::Disk(_) | Light::Triangles(_) if cone.spread < 0.5 * PI => PI,
            Light::Disk(_) => 2.0 * PI,
            _ => 4.0 * PI,
        };
        Self { bounds: light.bounds(), cone, intensity: f64::from(light.power().mean() / solid_angle) }
    }

    fn union(self, other: Self) -> Self {
        Self {
            bounds: self.bounds.union(other.bounds),
            cone: self.cone.union(other.cone),
            intensity: self.intensity + other.intensity,
        }
    }

    fn node(&self, parent: u32, light: u32) -> Node {
        let (sin_spread, cos_spread) = self.cone.spread.sin_cos();
        Node {
            center: self.bounds.center(),
            radius2: 0.25 * self.bounds.size().length_squared(),
            axis: self.cone.axis,
            cos_spread,
            sin_spread: sin_spread.max(0.0),
            cos_reach: self.cone.reach.cos() - SLACK,
            intensity: self.intensity as f32,
            parent,
            child: NONE,
            light,
        }
    }
}

impl Node {
    /// A bound of what the group may send to the receiver, up to a factor (§5.2): intensity · cos θ′ · cos θᵢ′/d².
    fn importance(&self, at: &Receiver) -> f32 {
        let to_center = self.center - at.p;
        let d2 = to_center.length_squared();
        let w = to_center / d2.max(f32::MIN_POSITIVE).sqrt();
        // Angle that the bounds fill at the receiver; within them they are all around.
        let (sin_u, cos_u) = if d2 > self.radius2 {
            let s2 = self.radius2 / d2;
            (s2.sqrt(), (1.0 - s2).max(0.0).sqrt())
        } else {
            (0.0, -1.0)
        };
        let cos = (-self.axis.dot(w)).clamp(-1.0, 1.0);
        let sin = (1.0 - cos * cos).max(0.0).sqrt();
        let (cos_x, sin_x) = less((cos, sin), (self.cos_spread, self.sin_spread));
        let (cos_out, _) = less((cos_x, sin_x), (cos_u, sin_u));
        if cos_out < self.cos_reach {
            return 0.0;
        }
        let mut importance = self.intensity * cos_out.max(LEAST_COSINE) / d2.max(self.radius2).max(1e-20);
        if at.n != Vec3::ZERO {
            let cos = at.n.dot(w).clamp(-1.0, 1.0);
            let (cos_in, _) = less((cos, (1.0 - cos * cos).max(0.0).sqrt()), (cos_u, sin_u));
            if cos_in < -SLACK {
                return 0.0;
            }
            // Half the bound, half what the middle has: the bound alone makes much of groups along the horizon.
            importance *= (0.5 * (cos_in + cos.max(0.0))).max(LEAST_COSINE);
        }
        importance
    }
}

/// Cosine and sine of max(0, a − b), both angles given by (cosine, sine).
fn less((cos_a, sin_a): (f32, f32), (cos_b, sin_b): (f32, f32)) -> (f32, f32) {
    if cos_a > cos_b { (1.0, 0.0) } else { (cos_a * cos_b + sin_a * sin_b, sin_a * cos_b - cos_a * sin_b) }
}

impl LightTree {
    /// Over those lights of the list that lie at finite places and shine.
    pub fn new(lights: &[Light]) -> Self {
        let mut groups: Vec<(u32, Group)> = lights
            .iter()
            .enumerate()
            .filter(|(_, light)| is_local(light))
            .map(|(i, light)| (i as u32, Group::of(light)))
            .collect();
        let mut tree = Self { nodes: Vec::new(), leaves: vec![NONE; lights.len()] };
        if groups.is_empty() {
            return tree;
        }
        tree.nodes.reserve(2 * groups.len());
        tree.nodes.push(union(&groups).node(NONE, NONE));
        // Ranges of `groups` whose node stands but has no children yet.
        let mut open = vec![(0usize, 0..groups.len())];
        while let Some((node, range)) = open.pop() {
            let part = &mut groups[range.clone()];
            if let [(light, _)] = part {
                tree.nodes[node].light = *light;
                tree.leaves[*light as usize] = node as u32;
                continue;
            }
            let middle = range.start + split(part);
            let child = tree.nodes.len();
            tree.nodes[node].child = child as u32;
            for range in [range.start..middle, middle..range.end] {
                tree.nodes.push(union(&groups[range.clone()]).node(node as u32, NONE));
                open.push((tree.nodes.len() - 1, range));
            }
        }
        tree
    }

    /// Whether it has any light.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// A light, its probability and `u` mapped back to [0, 1). `None`: none of them shines there.
    pub fn sample(&self, at: &Receiver, mut u: f32) -> Option<(usize, f32, f32)> {
        let mut node = self.nodes.first()?;
        let mut pmf = 1.0;
        while node.child != NONE {
            let [a, b] = [0, 1].map(|i| &self.nodes[node.child as usize + i]);
            let p = share(a, b, at)?;
            if u < p {
                (node, pmf, u) = (a, pmf * p, u / p);
            } else {
                (node, pmf, u) = (b, pmf * (1.0 - p), (u - p) / (1.0 - p));
            }
            u = u.clamp(0.0, math::ONE_MINUS_EPSILON);
        }
        // A tree of one light has asked nothing yet.
        Some((node.light as usize, pmf, u))
    }

    /// Probability of a light: [`Self::sample`] from the leaf up.
    pub fn pmf(&self, light: usize, at: &Receiver) -> f32 {
        let mut node = self.leaves.get(light).copied().unwrap_or(NONE);
        if node == NONE {
            return 0.0;
        }
        let mut pmf = 1.0;
        loop {
            let parent = self.nodes[node as usize].parent;
            if parent == NONE {
                return pmf;
            }
            let child = self.nodes[parent as usize].child;
            let [a, b] = [0, 1].map(|i| &self.nodes[child as usize + i]);
            let Some(p) = share(a, b, at) else { return 0.0 };
            pmf *= if node == child { p } else { 1.0 - p };
            node = parent;
        }
    }
}

/// Chance of the first of two siblings; `None`: neither shines there.
#[inline]
fn share(a: &Node, b: &Node, at: &Receiver) -> Option<f32> {
    let (a, b) = (a.importance(at), b.importance(at));
    let sum = a + b;
    (sum > 0.0 && sum.is_finite()).then(|| a / sum)
}

/// Whether a light is one of a tree's.
pub(super) fn is_local(light: &Light) -> bool {
    let power = light.power().mean();
    !light.is_infinite() && power > 0.0 && power.is_finite()
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
