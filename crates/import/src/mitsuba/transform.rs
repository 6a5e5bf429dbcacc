//! Transforms: steps applied one after the other.

use super::Importer;
use super::build::numbers;
use super::xml::Node;
use crate::matrix::{Matrix, cross, dot, narrow, sub, unit};

impl Importer {
    /// All steps of a <transform> in one; `None` where one is no transform, which is reported.
    pub(super) fn transform(&mut self, node: &Node) -> Option<Matrix> {
        self.known_attributes(node, &["name", "id", "time"]);
        let mut all = Matrix::IDENTITY;
        for child in &node.children {
            all = self.transform_step(child)?.after(&all);
        }
        if all.is_usable() {
            return Some(all);
        }
        self.report.error("singular-transform", "this transform is flat, or not affine", node.span);
        None
    }

    fn transform_step(&mut self, node: &Node) -> Option<Matrix> {
        match node.tag.as_str() {
            "translate" => {
                self.known_attributes(node, &["value", "x", "y", "z"]);
                Some(Matrix::translate(self.triple(node, 0.0)?))
            }
            "scale" => {
                self.known_attributes(node, &["value", "x", "y", "z"]);
                Some(Matrix::scale(self.triple(node, 1.0)?))
            }
            "rotate" => {
                self.known_attributes(node, &["value", "x", "y", "z", "angle"]);
                let axis = self.triple(node, 0.0)?;
                let angle = self.required(node, "angle")?;
                let Some([degrees]) = numbers(&angle).as_deref().and_then(|n| <[f64; 1]>::try_from(n).ok())
                else {
                    return self.malformed(&angle, "number", node.span);
                };
                let turned = Matrix::rotate(degrees, axis);
                if turned.is_none() {
                    self.report.error("degenerate", "the axis of this rotation has no length", node.span);
                }
                turned
            }
            "lookat" | "lookAt" | "look_at" => {
                self.known_attributes(node, &["origin", "target", "up"]);
                let origin = self.named_triple(node, "origin")?;
                let target = self.named_triple(node, "target")?;
                let up = match node.attribute("up") {
                    Some(_) => self.named_triple(node, "up")?,
                    None => any_up(sub(target, origin)),
                };
                let up = if up == [0.0; 3] { any_up(sub(target, origin)) } else { up };
                // A camera's space from the world's; placed, it is the other way about.
                let placed = Matrix::look_at(origin, target, up).and_then(|m| m.inverse());
                if placed.is_none() {
                    let text = "the directions of this <lookat> make no frame";
                    self.report.error("degenerate", text, node.span);
                }
                placed
            }
            "matrix" => {
                self.known_attributes(node, &["value"]);
                let value = self.required(node, "value")?;
                let m = numbers(&value);
                let rows = |m: &[f64], n: usize| {
                    let mut out = Matrix::IDENTITY;
                    for (r, row) in out.0.iter_mut().take(n).enumerate() {
                        row[..n].copy_from_slice(&m[r * n..][..n]);
                    }
                    out
                };
                match m.as_deref() {
                    Some(m) if m.len() == 16 => Some(rows(m, 4)),
                    Some(m) if m.len() == 9 => Some(rows(m, 3)),
                    _ => self.malformed(&value, "matrix of 9 or 16 numbers", node.span),
                }
            }
            _ => {
                self.unknown_element(node);
                None
            }
        }
    }

    fn named_triple(&mut self, node: &Node, name: &str) -> Option<[f64; 3]> {
        let value = self.required(node, name)?;
        match numbers(&value).as_deref() {
            Some([x, y, z]) => Some([*x, *y, *z]),
            _ => self.malformed(&value, "triple of numbers", node.span),
        }
    }
}

/// A direction that is not parallel to another.
fn any_up(ahead: [f64; 3]) -> [f64; 3] {
    let ahead = unit(ahead).unwrap_or([0.0, 0.0, 1.0]);
    if ahead[0].abs() > ahead[1].abs() { [0.0, 1.0, 0.0] } else { [1.0, 0.0, 0.0] }
}

/// An affine map of texture coordinates: u′ = `m[0]`·(u, v, 1), v′ = `m[1]`·(u, v, 1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct UvMap(pub [[f64; 3]; 2]);

impl UvMap {
    /// v counted from the other end.
    pub(super) const FLIP: Self = Self([[1.0, 0.0, 0.0], [0.0, -1.0, 1.0]]);

    pub(super) fn scaled([u, v]: [f64; 2], [x, y]: [f64; 2]) -> Self {
        Self([[u, 0.0, x], [0.0, v, y]])
    }

    /// The part of a transform of space that concerns the first two coordinates.
    pub(super) fn of(m: &Matrix) -> Self {
        Self([0, 1].map(|r| [m.0[r][0], m.0[r][1], m.0[r][3]]))
    }

    /// First `first`, then this.
    pub(super) fn after(&self, first: &Self) -> Self {
        let f = &first.0;
        Self(self.0.map(|[a, b, c]| {
            [a * f[0][0] + b * f[1][0], a * f[0][1] + b * f[1][1], a * f[0][2] + b * f[1][2] + c]
        }))
    }

    /// As scale, then a turn in degrees, then a movement; `None` where it shears.
    pub(super) fn parts(&self) -> Option<([f32; 2], f32, [f32; 2])> {
        let [[a, b, x], [c, d, y]] = self.0;
        let (u, v) = ([a, c, 0.0], [b, d, 0.0]);
        let angle = if c == 0.0 && a < 0.0 { 0.0 } else { c.atan2(a) };
        let (sin, cos) = angle.sin_cos();
        let (along, across) = ([cos, sin, 0.0], [-sin, cos, 0.0]);
        let size = dot(v, v).sqrt();
        if dot(v, along).abs() > 1e-6 * size || cross(u, v)[2] == 0.0 {
            return None;
        }
        let [su, sv, _] = narrow([dot(u, along), dot(v, across), 0.0]);
        Some(([su, sv], angle.to_degrees() as f32, [x as f32, y as f32]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_of_uv_maps() {
        let near = |m: UvMap, scale: [f32; 2], turn: f32, offset: [f32; 2]| {
            let (s, t, o) = m.parts().unwrap();
            let all = [s[0] - scale[0], s[1] - scale[1], t - turn, o[0] - offset[0], o[1] - offset[1]];
            assert!(all.iter().all(|x| x.abs() < 1e-5), "{:?}", m.parts());
        };
        near(UvMap::scaled([1.0; 2], [0.0; 2]), [1.0; 2], 0.0, [0.0; 2]);
        near(UvMap::FLIP, [1.0, -1.0], 0.0, [0.0, 1.0]);
        let m = UvMap::scaled([2.0, 3.0], [0.25, 0.5]);
        near(UvMap::FLIP.after(&m), [2.0, -3.0], 0.0, [0.25, 0.5]);
        near(m.after(&UvMap::FLIP), [2.0, -3.0], 0.0, [0.25, 3.5]);
        near(UvMap::scaled([-1.0, 1.0], [0.0; 2]), [-1.0, 1.0], 0.0, [0.0; 2]);
        let quarter = UvMap::of(&Matrix::rotate(90.0, [0.0, 0.0, 1.0]).unwrap());
        near(quarter.after(&m), [2.0, 3.0], 90.0, [-0.5, 0.25]);
        assert!(UvMap([[1.0, 0.5, 0.0], [0.0, 1.0, 0.0]]).parts().is_none());
    }
}
