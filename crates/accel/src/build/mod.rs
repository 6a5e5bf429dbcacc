//! Builds the tree: a binary one by the surface area heuristic ([`binary`]), the cheapest 8-wide cut of it
//! ([`collapse`]), and that laid out in memory ([`emit`]).

mod binary;
mod collapse;
mod emit;

use math::Bounds3;

use crate::bvh::Bvh;
use crate::geometry::Geometry;
use crate::kernel::Dispatch;
use crate::node::Kind;
use binary::Primitive;

/// Primitives that a task handles at least.
const CHUNK: usize = 16 * 1024;

pub(crate) fn build(mut geometry: Geometry) -> Bvh {
    let mut primitives = primitives_of(&geometry);
    let tree = binary::build(&mut primitives);
    let emitted = if tree.is_empty() {
        emit::Emitted::default()
    } else {
        let plan = collapse::plan(&tree, &primitives);
        emit::emit(&geometry, &tree, &primitives, &plan)
    };
    let order = |kind| emitted.order[kind as usize].iter().map(|&i| i as usize);
    let spheres: Vec<_> = order(Kind::Spheres).map(|i| geometry.spheres[i]).collect();
    let disks: Vec<_> = order(Kind::Disks).map(|i| geometry.disks[i]).collect();
    let mut instances: Vec<_> = geometry.instances.drain(..).map(Some).collect();
    let instances = order(Kind::Instances).filter_map(|i| instances[i].take()).collect();
    let mut ids = emitted.triangle_ids;
    let first_sphere_id = ids.len();
    let first_disk_id = first_sphere_id + spheres.len();
    ids.extend(spheres.iter().map(|s| [s.1, 0]));
    ids.extend(disks.iter().map(|d| [d.1, 0]));
    Bvh {
        root: emitted.root,
        nodes: emitted.nodes,
        packs: emitted.packs,
        spheres: spheres.into_iter().map(|s| s.0).collect(),
        disks: disks.into_iter().map(|d| d.0).collect(),
        instances,
        ids,
        first_sphere_id,
        first_disk_id,
        bounds: tree.first().map_or(Bounds3::EMPTY, |root| root.bounds()),
        dispatch: Dispatch::detect(),
    }
}

/// The bounds alone.
pub(crate) fn outline(geometry: &Geometry) -> Bvh {
    let corner = |i: u32| geometry.positions[i as usize];
    let parts = par::map_chunks(geometry.triangles.len(), CHUNK, |range| {
        Bounds3::of_points(range.flat_map(|i| geometry.triangles[i].map(corner)))
    });
    let others = (geometry.spheres.iter().map(|s| s.0.bounds()))
        .chain(geometry.disks.iter().map(|d| d.0.bounds()))
        .chain(geometry.instances.iter().map(|i| i.bounds()));
    Bvh {
        root: None,
        nodes: Vec::new(),
        packs: Vec::new(),
        spheres: Vec::new(),
        disks: Vec::new(),
        instances: Vec::new(),
        ids: Vec::new(),
        first_sphere_id: 0,
        first_disk_id: 0,
        bounds: parts.into_iter().chain(others).fold(Bounds3::EMPTY, Bounds3::union),
        dispatch: Dispatch::detect(),
    }
}

fn primitives_of(geometry: &Geometry) -> Vec<Primitive> {
    let triangles = par::map_chunks(geometry.triangles.len(), CHUNK, |range| {
        let corner = |i: u32| geometry.positions[i as usize];
        range
            .map(|i| (Bounds3::of_points(geometry.triangles[i].map(corner)), i))
            .map(|(bounds, i)| Primitive::new(&bounds, Kind::Triangles, i))
            .collect::<Vec<_>>()
    });
    let mut all = triangles.concat();
    let mut add = |kind, bounds: &mut dyn Iterator<Item = Bounds3>| {
        all.extend(bounds.enumerate().map(|(i, b)| Primitive::new(&b, kind, i)));
    };
    add(Kind::Spheres, &mut geometry.spheres.iter().map(|s| s.0.bounds()));
    add(Kind::Disks, &mut geometry.disks.iter().map(|d| d.0.bounds()));
    add(Kind::Instances, &mut geometry.instances.iter().map(|i| i.bounds()));
    all
}
