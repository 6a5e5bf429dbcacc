use math::Vec2;

use super::perlin::noise;
use super::{Mapping, Source, Texture, TexturePoint, lerp};

/// Radius of a dot; a cell is 1×1.
const RADIUS: f32 = 0.35;
/// How far a dot's centre may lie from that of its cell along an axis.
const SHIFT: f32 = 0.5 - RADIUS;
/// Share of the plane that is inside, for half of all cells have a dot.
const SHARE: f32 = 0.5 * math::PI * RADIUS * RADIUS;

/// Round dots of one texture on another: in every second cell, by noise, one that noise has moved.
/// Cells, chances and places as in pbrt (Pharr, Jakob & Humphreys 2016, §10.6.2).
#[derive(Clone, Debug)]
pub struct Dots {
    /// What fills a dot; looked up by the coordinates before mapping.
    pub inside: Source,
    /// What fills the rest.
    pub outside: Source,
    /// Mapping of texture coordinates; a scale of 10 gives 10 cells per unit.
    pub map: Mapping,
}

impl Dots {
    pub(super) fn evaluate(&self, textures: &[Texture], at: &TexturePoint<'_>) -> [f32; 3] {
        let (p, width) = self.map.apply(at);
        let t = coverage(p, width.max_element());
        match t {
            0.0 => self.outside.evaluate(textures, at),
            1.0 => self.inside.evaluate(textures, at),
            _ => lerp(self.outside.evaluate(textures, at), self.inside.evaluate(textures, at), t),
        }
    }

    pub(super) fn mean(&self, textures: &[Texture]) -> [f32; 3] {
        lerp(self.outside.mean(textures), self.inside.mean(textures), SHARE)
    }
}

/// Share of the footprint about `p` that lies in dots: exact for points, a linear edge for footprints less than half a
/// cell wide, and the mean from one cell on.
fn coverage(p: Vec2, width: f32) -> f32 {
    if !(width < 1.0 && p.is_finite()) {
        return SHARE;
    }
    let cell = (p + 0.5).floor();
    let random = |x: f32, y: f32| noise([cell.x + x, cell.y + y, 0.5]);
    let sharp = if random(0.5, 0.5) > 0.0 {
        let center = cell + SHIFT * Vec2::new(random(1.5, 2.8), random(4.5, 9.8));
        let inside = RADIUS - p.distance(center);
        if width > 0.0 { (0.5 + inside / width).clamp(0.0, 1.0) } else { f32::from(u8::from(inside > 0.0)) }
    } else {
        0.0
    };
    let far = (2.0 * width - 1.0).clamp(0.0, 1.0);
    sharp + (SHARE - sharp) * far
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dots_are_round_lie_in_their_cells_and_fill_their_share() {
        let n = 1600;
        let (mut inside, mut edge) = (0, 0);
        for i in 0..n * n {
            let p = Vec2::new((i % n) as f32, (i / n) as f32) * (40.0 / n as f32) - 20.0;
            let c = coverage(p, 0.0);
            assert!(c == 0.0 || c == 1.0);
            inside += i32::from(c == 1.0);
            let from_edge = (p + 0.5 - (p + 0.5).floor() - 0.5).abs().max_element();
            edge += i32::from(c == 1.0 && from_edge > 0.4999);
        }
        let share = f64::from(inside) / f64::from(n * n);
        assert!((share - f64::from(SHARE)).abs() < 0.04, "{share}");
        assert_eq!(edge, 0, "no dot is cut off");
        // A soft edge holds what a sharp one does.
        let (mut soft, mut sharp) = (0.0, 0.0);
        for i in 0..n * n {
            let p = Vec2::new((i % n) as f32, (i / n) as f32) * (10.0 / n as f32);
            soft += f64::from(coverage(p, 0.1));
            sharp += f64::from(coverage(p, 0.0));
        }
        assert!((soft / sharp - 1.0).abs() < 0.03, "{soft} {sharp}");
        assert_eq!(coverage(Vec2::splat(0.1), 7.0), SHARE);
        assert_eq!(coverage(Vec2::splat(f32::NAN), 0.0), SHARE);
    }
}
