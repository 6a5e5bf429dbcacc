//! Meshes at rest: morph targets by their weights as given (glTF 2.0 §3.7.2.2), skins by their joints as they stand
//! (§3.7.3).

use super::accessor::Source;
use super::fault::{Fault, Known};
use super::json::Value;
use super::mesh::{Columns, Part};
use crate::matrix::{Matrix, add, narrow, times, unit, wide};

/// How a mesh is changed before it is placed.
#[derive(Debug, Default)]
pub(super) struct Pose {
    /// Weights of the morph targets.
    pub weights: Vec<f64>,
    /// For each joint, the world from the mesh's own space; empty for no skin.
    pub joints: Vec<Matrix>,
}

impl Pose {
    /// The weights that a node gives its mesh.
    pub(super) fn weights(node: &Value<'_>, mesh: &Value<'_>) -> Known<Vec<f64>> {
        let given = node.get("weights").map_or(mesh, |_| node);
        let one = |value: &Value<'_>| value.as_number("weights");
        given.array("weights")?.iter().map(one).collect()
    }

    /// Whether it changes nothing, so that other nodes may share the mesh.
    pub(super) fn is_plain(&self) -> bool {
        self.joints.is_empty() && self.weights.iter().all(|w| *w == 0.0)
    }

    /// Adds weighted differences to positions and normals.
    pub(super) fn morph(
        &self,
        source: &Source<'_>,
        primitive: &Value<'_>,
        columns: &Columns<'_>,
        part: &mut Part,
    ) -> Known<()> {
        let targets = primitive.array("targets")?;
        for (target, weight) in targets.iter().zip(&self.weights).filter(|(_, w)| **w != 0.0) {
            let shift = |name: &str, to: &mut [[f32; 3]]| -> Known<()> {
                let by = columns.check(name, source.accessor(target, name)?)?;
                for (v, d) in to.iter_mut().zip(columns.vectors::<3>(&by)) {
                    *v = narrow(add(wide(*v), times(wide(d), *weight)));
                }
                Ok(())
            };
            shift("POSITION", &mut part.positions)?;
            shift("NORMAL", &mut part.normals)?;
        }
        Ok(())
    }

    /// Moves vertices with their joints, into the world.
    pub(super) fn bend(&self, source: &Source<'_>, columns: &Columns<'_>, part: &mut Part) -> Known<()> {
        if self.joints.is_empty() {
            return Ok(());
        }
        let mut sums = vec![[[0.0; 4]; 3]; part.positions.len()];
        for set in 0..2 {
            let read = |kind: &str| {
                let name = format!("{kind}_{set}");
                columns.check(&name, source.accessor(columns.attributes, &name)?)
            };
            let (Some(joints), weights @ Some(_)) = (read("JOINTS")?, read("WEIGHTS")?) else { continue };
            let all = joints.wholes::<4>();
            let joint = |i: usize| all[columns.some.map_or(i, |some| some[i] as usize)];
            for (i, (sum, weights)) in sums.iter_mut().zip(columns.vectors::<4>(&weights)).enumerate() {
                for (joint, weight) in joint(i).into_iter().zip(weights).filter(|(_, w)| *w != 0.0) {
                    let Some(matrix) = self.joints.get(joint as usize) else {
                        let text = format!("there is no joint {joint}: the skin has {}", self.joints.len());
                        return Err(Fault::new("out-of-range", text, columns.span));
                    };
                    for (row, by) in sum.iter_mut().zip(&matrix.0) {
                        for (cell, x) in row.iter_mut().zip(by) {
                            *cell += f64::from(weight) * x;
                        }
                    }
                }
            }
        }
        for (i, sum) in sums.into_iter().enumerate() {
            // The weights' sum is 1 but for rounding.
            let total: f64 = sum.iter().flatten().map(|x| x.abs()).sum();
            let matrix = match total > 0.0 {
                true => Matrix([sum[0], sum[1], sum[2], [0.0, 0.0, 0.0, 1.0]]),
                false => self.joints[0],
            };
            part.positions[i] = narrow(matrix.point(wide(part.positions[i])));
            if let Some(normal) = part.normals.get_mut(i) {
                *normal = narrow(unit(matrix.normal(wide(*normal))).unwrap_or_default());
            }
        }
        Ok(())
    }
}
