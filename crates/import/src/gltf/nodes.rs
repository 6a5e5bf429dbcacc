//! The scene's nodes (glTF 2.0 §3.5): placements, and what stands there.

use std::collections::BTreeMap;

use scenefile::desc::{Group, Instance, MaterialRef, Object};
use scenefile::{Sourced, Span};

use super::Importer;
use super::fault::{Fault, Known};
use super::json::Value;
use super::mesh::Part;
use super::pose::Pose;
use crate::matrix::{Matrix, length, narrow, wide};
use crate::names::free_name;

/// Nodes within one another, at most.
const DEEPEST: usize = 1 << 16;

/// A mesh somewhere.
struct Use {
    mesh: usize,
    node: usize,
    matrix: Matrix,
    span: Span,
}

/// What the nodes of the scene are found to be.
#[derive(Default)]
struct Found {
    /// The world from each node that the scene has.
    worlds: Vec<Option<Matrix>>,
    uses: Vec<Use>,
}

impl<'t> Importer<'t> {
    /// Makes the scene that the file says to show, or else its first.
    pub(super) fn scene(&mut self) -> Known<()> {
        let root = self.source.root;
        let scenes = self.list("scenes")?;
        let chosen = root.pick("scene", "scene", scenes)?.or(scenes.first().map(|scene| (0, scene)));
        if scenes.len() > 1
            && let Some((i, scene)) = chosen
        {
            let text = format!("the file has {} scenes", scenes.len());
            self.report.note("scene", format!("{text}: scene {i} is rendered"), scene.span());
        }
        let nodes = self.list("nodes")?;
        let roots = match chosen {
            Some((_, scene)) => {
                let named = scene.array("nodes")?.iter();
                named.map(|name| Ok(name.pick_self("nodes", "node", nodes)?.0)).collect::<Known<Vec<_>>>()?
            }
            None => orphans(nodes)?,
        };
        let found = self.walk(nodes, roots)?;
        self.place(nodes, found)
    }

    /// Follows the nodes down from some.
    fn walk(&mut self, nodes: &'t [Value<'t>], roots: Vec<usize>) -> Known<Found> {
        let mut found = Found { worlds: vec![None; nodes.len()], uses: Vec::new() };
        let mut stack: Vec<(usize, Matrix, usize)> =
            roots.into_iter().rev().map(|root| (root, Matrix::IDENTITY, 0)).collect();
        while let Some((index, parent, depth)) = stack.pop() {
            let node = &nodes[index];
            if found.worlds[index].is_some() {
                // A tree has one way to each node (§3.5.2), so this ends cycles too.
                let text = format!("node {index} is reached twice: nodes must be a tree");
                return Err(Fault::new("node-cycle", text, node.span()));
            }
            if depth > DEEPEST {
                return Err(Fault::new("node-cycle", "nodes are nested too deeply", node.span()));
            }
            let local = placement(node);
            let world = parent.after(&self.told(local).unwrap_or(Matrix::IDENTITY));
            found.worlds[index] = Some(world);
            if let Some(visibility) = node.extension("KHR_node_visibility")
                && !visibility.truth("visible", true)?
            {
                continue;
            }
            for child in node.array("children")?.iter().rev() {
                stack.push((child.pick_self("children", "node", nodes)?.0, world, depth + 1));
            }
            if let Some((mesh, _)) = node.pick("mesh", "mesh", self.list("meshes")?)? {
                let copies = self.copies(node);
                let copies = self.told(copies).unwrap_or_default();
                let span = node.span();
                found.uses.extend(copies.into_iter().map(|copy| Use {
                    mesh,
                    node: index,
                    matrix: world.after(&copy),
                    span,
                }));
            }
            if !world.0.iter().flatten().all(|x| (*x as f32).is_finite()) {
                return Err(Fault::new(
                    "degenerate",
                    format!("node {index} is not placed at finite points"),
                    node.span(),
                ));
            }
            let camera = self.camera(node, &world);
            self.told(camera);
            let light = self.light(node, &world);
            self.told(light);
        }
        Ok(found)
    }

    /// The placements of a node's mesh within the node: one, or those of `EXT_mesh_gpu_instancing`.
    fn copies(&mut self, node: &'t Value<'t>) -> Known<Vec<Matrix>> {
        let Some(instancing) = node.extension("EXT_mesh_gpu_instancing") else {
            return Ok(vec![Matrix::IDENTITY]);
        };
        let Some(attributes) = instancing.get("attributes") else { return Ok(Vec::new()) };
        let source = self.source;
        let wrong = |text: &str| Fault::new("conflict", text, instancing.span());
        let mut columns = Vec::new();
        for (key, width) in [("TRANSLATION", 3), ("ROTATION", 4), ("SCALE", 3)] {
            let column = source.accessor(attributes, key)?;
            if column.as_ref().is_some_and(|column| column.width != width) {
                return Err(wrong("a placement has not the numbers that it needs"));
            }
            columns.push(column);
        }
        let count = columns.iter().flatten().map(|column| column.count).next().unwrap_or(0);
        if columns.iter().flatten().any(|column| column.count != count) {
            return Err(wrong("the placements have different counts"));
        }
        self.spend(count.saturating_mul(256), instancing.span())?;
        let [moves, turns, scales] = [&columns[0], &columns[1], &columns[2]];
        let moves = moves.as_ref().map(|c| c.floats::<3>()).unwrap_or_default();
        let turns = turns.as_ref().map(|c| c.floats::<4>()).unwrap_or_default();
        let scales = scales.as_ref().map(|c| c.floats::<3>()).unwrap_or_default();
        let one = |i: usize| {
            let by = Matrix::translate(moves.get(i).map_or([0.0; 3], |v| wide(*v)));
            let turn = turns.get(i).map_or(Some(Matrix::IDENTITY), |q| Matrix::quaternion(q.map(f64::from)));
            let scale = Matrix::scale(scales.get(i).map_or([1.0; 3], |v| wide(*v)));
            turn.map(|turn| by.after(&turn).after(&scale)).ok_or_else(|| wrong("a rotation is no quaternion"))
        };
        (0..count).map(one).collect()
    }

    /// Puts meshes in their places: objects where there is one of a mesh, groups and instances where there are more.
    fn place(&mut self, nodes: &'t [Value<'t>], found: Found) -> Known<()> {
        let meshes = self.list("meshes")?;
        let mut shared: BTreeMap<usize, Vec<Use>> = BTreeMap::new();
        let mut alone = Vec::new();
        for used in found.uses {
            let (node, mesh) = (&nodes[used.node], &meshes[used.mesh]);
            let weights = Pose::weights(node, mesh);
            let joints = self.joints(node, nodes, &found.worlds);
            let (Some(weights), Some(joints)) = (self.told(weights), self.told(joints)) else { continue };
            let pose = Pose { weights, joints };
            if pose.is_plain() && is_solid(&used.matrix) {
                shared.entry(used.mesh).or_default().push(used);
            } else {
                alone.push((used, pose));
            }
        }
        for (used, pose) in alone {
            // A skin's joints alone say where it is.
            let matrix = if pose.joints.is_empty() { used.matrix } else { Matrix::IDENTITY };
            for part in self.parts(&meshes[used.mesh], &pose) {
                self.add_flat_or_solid(part, &matrix, nodes[used.node].name());
            }
        }
        for (mesh, uses) in shared {
            let parts = self.parts(&meshes[mesh], &Pose::default());
            match &uses[..] {
                [once] => {
                    let names = [nodes[once.node].name(), meshes[mesh].name()];
                    let name = names.into_iter().find(|name| !name.is_empty()).unwrap_or_default();
                    for part in parts {
                        let object = self.object(part, name);
                        self.add_object(object, &once.matrix);
                    }
                }
                _ => self.add_group(parts, meshes[mesh].name(), &uses),
            }
        }
        Ok(())
    }

    fn add_group(&mut self, parts: Vec<Part>, name: &str, uses: &[Use]) {
        let objects: Vec<Sourced<Object>> = parts.into_iter().map(|part| self.object(part, name)).collect();
        if objects.is_empty() {
            return;
        }
        let key = free_name(&self.desc.groups, if name.is_empty() { "mesh" } else { name });
        self.desc.groups.insert(key.clone(), Group { objects }.into());
        for used in uses {
            let group = Sourced::at(key.clone(), used.span);
            let transform = used.matrix.steps();
            self.desc
                .instances
                .push(Sourced::at(Instance { name: None, group, transform, material: None }, used.span));
        }
    }

    /// Adds a part under any placement: one that flattens space is applied to the points.
    fn add_flat_or_solid(&mut self, mut part: Part, matrix: &Matrix, name: &str) {
        if is_solid(matrix) {
            let object = self.object(part, name);
            return self.add_object(object, matrix);
        }
        for p in &mut part.positions {
            *p = narrow(matrix.point(wide(*p)));
        }
        part.normals = Vec::new();
        if !part.positions.iter().flatten().all(|x| x.is_finite()) {
            let text = "a primitive is not placed at finite points";
            return self.fault(Fault::new("degenerate", text, part.span));
        }
        // What has no extent at all is how files hide things.
        if part.has_area() {
            let object = self.object(part, name);
            self.add_object(object, &Matrix::IDENTITY);
        }
    }

    fn add_object(&mut self, mut object: Sourced<Object>, matrix: &Matrix) {
        object.value.transform = matrix.steps();
        self.desc.objects.push(object);
    }

    fn object(&mut self, part: Part, name: &str) -> Sourced<Object> {
        let span = part.span;
        let surface = self.surface(part.material, !part.colors.is_empty());
        let name = self.free_name(name);
        let material = surface.material.map(|key| MaterialRef::Named(Sourced::at(key, span)));
        let object = Object {
            name,
            material,
            emission: surface.emission.map(|emission| Sourced::at(emission, span)),
            ..Object::bare(part.shape())
        };
        Sourced::at(object, span)
    }

    /// The world from the space of a node's mesh for each joint of its skin.
    fn joints(
        &mut self,
        node: &'t Value<'t>,
        nodes: &'t [Value<'t>],
        worlds: &[Option<Matrix>],
    ) -> Known<Vec<Matrix>> {
        let Some((_, skin)) = node.pick("skin", "skin", self.list("skins")?)? else { return Ok(Vec::new()) };
        let joints = skin.array("joints")?;
        let source = self.source;
        let inverse = source.accessor(skin, "inverseBindMatrices")?;
        if inverse.as_ref().is_some_and(|m| m.width != 16 || m.count < joints.len()) {
            let text = "the skin has not a matrix for each joint";
            return Err(Fault::new("conflict", text, skin.span()));
        }
        let inverse = inverse.map(|m| m.floats::<16>()).unwrap_or_default();
        self.spend(joints.len().saturating_mul(128), skin.span())?;
        let one = |(i, joint): (usize, &'t Value<'t>)| {
            let (index, _) = joint.pick_self("joints", "node", nodes)?;
            let world = worlds[index].unwrap_or(Matrix::IDENTITY);
            let bind = inverse.get(i).map_or(Matrix::IDENTITY, |m| Matrix::columns(&m.map(f64::from)));
            Ok(world.after(&bind))
        };
        joints.iter().enumerate().map(one).collect()
    }
}

/// Whether a placement keeps volumes well enough for an object's.
fn is_solid(matrix: &Matrix) -> bool {
    let rows = [0, 1, 2].map(|r| length([matrix.0[r][0], matrix.0[r][1], matrix.0[r][2]]));
    matrix.is_usable() && matrix.determinant().abs() > 1e-9 * rows[0] * rows[1] * rows[2]
}

/// The nodes that are nobody's children.
fn orphans(nodes: &[Value<'_>]) -> Known<Vec<usize>> {
    let mut child = vec![false; nodes.len()];
    for node in nodes {
        for name in node.array("children")? {
            child[name.pick_self("children", "node", nodes)?.0] = true;
        }
    }
    Ok((0..nodes.len()).filter(|i| !child[*i]).collect())
}

/// A node's own placement: a matrix, or scale, then turn, then move (§3.5.3).
fn placement(node: &Value<'_>) -> Known<Matrix> {
    if node.get("matrix").is_some() {
        let mut matrix = Matrix::columns(&node.numbers::<16>("matrix", [0.0; 16])?);
        // The last row says nothing in an affine map.
        matrix.0[3] = [0.0, 0.0, 0.0, 1.0];
        return Ok(matrix);
    }
    let by = Matrix::translate(node.numbers("translation", [0.0; 3])?);
    let turn = Matrix::quaternion(node.numbers("rotation", [0.0, 0.0, 0.0, 1.0])?).ok_or_else(|| {
        let span = node.get("rotation").map_or(node.span(), Value::span);
        Fault::new("degenerate", "the rotation is no quaternion: it has no length", span)
    })?;
    let scale = Matrix::scale(node.numbers("scale", [1.0; 3])?);
    Ok(by.after(&turn).after(&scale))
}
