use math::{DVec2, DVec3};

use super::grid::{Grid, Row, Vertex};
use super::patches::{
    BODY, BOTTOM, HANDLE, LID, SPOUT, Swept, Turned, bernstein, blend, swept_point, turned_point,
};
use crate::TriangleMesh;

/// A part of the teapot. As Newell made them all are open sheets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TeapotPart {
    /// Rim and wall, 12 patches: open at the top (radius 1.4) and at the foot (radius 1.5), which the bottom closes.
    Body,
    /// Lid with its knob, 8 patches: open below (radius 1.3), 0.1 away from the rim.
    Lid,
    /// The bottom, 4 patches: a shallow bowl, open above.
    Bottom,
    /// The handle, 4 patches: open at both roots, which lie within the body.
    Handle,
    /// The spout, 4 patches: open at the root, which lies within the body, and at the mouth.
    Spout,
}

impl TeapotPart {
    /// All parts.
    pub const ALL: [Self; 5] = [Self::Body, Self::Lid, Self::Bottom, Self::Handle, Self::Spout];
}

/// Newell's teapot, all 32 patches cut into `level` × `level` quads (1 to 256; handle and spout at least 2 across).
///
/// In Newell's units with y up: 3.15 high, base at y = 0, the spout towards +x (to 3.43), the handle towards −x
/// (to −3), the body's axis is the y axis. The surface is open (see [`TeapotPart`]): for glass take [`teapot_solid`].
/// Vertices and normals are those of the patches, also where they shrink to a point. Within a part no cracks.
pub fn teapot(level: u32) -> TriangleMesh {
    TeapotPart::ALL.iter().fold(TriangleMesh::default(), |mesh, &part| mesh.merged(&teapot_part(part, level)))
}

/// One part of [`teapot`], as it is in it.
pub fn teapot_part(part: TeapotPart, level: u32) -> TriangleMesh {
    let mut sheet = match part {
        TeapotPart::Handle | TeapotPart::Spout => Sheet::swept(level),
        _ => Sheet::turned(level),
    };
    match part {
        TeapotPart::Body => sheet.turn(&BODY),
        TeapotPart::Lid => sheet.turn(&LID),
        TeapotPart::Bottom => sheet.turn(&BOTTOM),
        TeapotPart::Handle => sheet.sweep(&HANDLE),
        TeapotPart::Spout => sheet.sweep(&SPOUT),
    }
    sheet.grid.finish()
}

/// The teapot as a solid in one mesh: the three shells of [`teapot_shells`].
///
/// Handle and spout overlap the body, as shells of the same mesh: a ray may enter twice before it leaves twice, so
/// that a renderer of glass must count entries, not toggle.
pub fn teapot_solid(level: u32) -> TriangleMesh {
    let [body, handle, spout] = teapot_shells(level);
    body.merged(&handle).merged(&spout)
}

/// Body, handle and spout as three closed shells, each oriented outward, size and place as in [`teapot`].
///
/// The body is one with lid and bottom: a level annulus at y = 2.4 bridges the gap between the lid (radius 1.3) and the
/// rim (1.4). Handle and spout have plane caps at their ends, which lie inside the body but for the spout's mouth.
pub fn teapot_shells(level: u32) -> [TriangleMesh; 3] {
    let mut body = Sheet::turned(level);
    body.turn(&LID);
    // The bridge has rings of its own, since there is a crease at either side of it.
    body.last = None;
    body.level_ring(LID[1][3]);
    body.level_ring(BODY[0][0]);
    body.last = None;
    body.turn(&BODY);
    body.turn(&BOTTOM);
    [body.grid.finish(), capped(&HANDLE, level), capped(&SPOUT, level)]
}

/// Swept sheets with a plane cap at either end.
fn capped(sheets: &[[Swept; 4]; 2], level: u32) -> TriangleMesh {
    let mut sheet = Sheet::swept(level);
    let section = |[x0, z0, x1, z1, _]: Swept| {
        (DVec3::new(x0 + x1, 0.0, z0 + z1) * 0.5, DVec3::new(x1 - x0, 0.0, z1 - z0).cross(DVec3::Y))
    };
    let (middle, normal) = section(sheets[0][0]);
    sheet.centre(middle, -normal);
    sheet.flat_ring(sheets[0][0], -normal);
    sheet.last = None;
    sheet.sweep(sheets);
    let (middle, normal) = section(sheets[1][3]);
    sheet.last = None;
    sheet.flat_ring(sheets[1][3], normal);
    sheet.centre(middle, normal);
    sheet.grid.finish()
}

/// How columns are laid out: in Newell's axes from +x to −y to −x (or on the near side to the far side and back).
#[derive(Clone, Copy)]
struct Columns {
    /// Quads across a patch.
    across: u32,
    /// Patches round.
    patches: u32,
}

impl Columns {
    fn count(self) -> u32 {
        self.patches * self.across
    }

    /// The patch that column `j` lies in, and the parameter in it.
    fn locate(self, j: f64) -> (u32, f64) {
        let place = j / f64::from(self.across);
        (place.floor() as u32, place - place.floor())
    }

    /// A vertex in the renderer's axes.
    fn vertex(self, j: f64, v: f64, position: DVec3, normal: DVec3) -> Vertex {
        let y_up = |p: DVec3| DVec3::new(p.x, p.z, -p.y);
        Vertex {
            position: y_up(position),
            normal: y_up(normal),
            uv: DVec2::new(j / f64::from(self.count()), v),
        }
    }

    /// Position and derivative along the columns of a swept row. The second half mirrors the first.
    fn swept(self, row: Swept, j: f64) -> (DVec3, DVec3) {
        let far = j > f64::from(self.across);
        let t = if far {
            (f64::from(self.count()) - j) / f64::from(self.across)
        } else {
            j / f64::from(self.across)
        };
        let (b, db) = bernstein(t);
        let (p, d) = (swept_point(row, b), swept_point(row, db));
        if far { (p * DVec3::new(1.0, -1.0, 1.0), d * DVec3::new(-1.0, 1.0, -1.0)) } else { (p, d) }
    }
}

/// Rows of patches put together so that the outside is along (columns) × (rows).
struct Sheet {
    grid: Grid,
    columns: Columns,
    /// Rows of quads in a patch.
    level: u32,
    /// The row that the next one is sewn to; none at a crease or the beginning.
    last: Option<Row>,
    rows: u32,
}

impl Sheet {
    fn turned(level: u32) -> Self {
        let level = level.clamp(1, 256);
        Self::new(level, Columns { across: level, patches: 4 })
    }

    fn swept(level: u32) -> Self {
        let level = level.clamp(1, 256);
        Self::new(level, Columns { across: level.max(2), patches: 2 })
    }

    fn new(level: u32, columns: Columns) -> Self {
        Self { grid: Grid::new(columns.count()), columns, level, last: None, rows: 0 }
    }

    /// The next row's v: 1 for every three patches.
    fn v(&self) -> f64 {
        f64::from(self.rows) / f64::from(3 * self.level)
    }

    fn append(&mut self, row: Row) {
        if let Some(last) = self.last {
            self.grid.sew(last, row);
        }
        self.last = Some(row);
        self.rows += 1;
    }

    /// The parameters along each sheet, without those of rows that are there already.
    fn parameters<'a, S>(&self, sheets: &'a [S]) -> impl Iterator<Item = (&'a S, f64)> + use<'a, S> {
        let (level, joined) = (self.level, self.last.is_some());
        sheets.iter().enumerate().flat_map(move |(k, sheet)| {
            let first = u32::from(k > 0 || joined);
            (first..=level).map(move |i| (sheet, f64::from(i) / f64::from(level)))
        })
    }

    fn turn(&mut self, sheets: &[[Turned; 4]]) {
        for (sheet, t) in self.parameters(sheets) {
            let (b, db) = bernstein(t);
            let (row, along) = (blend(sheet, b), blend(sheet, db));
            // Where a row shrinks to a point, the next control row tells the direction of the columns: the limit of
            // the derivative on the way there.
            let pole = row[0] == 0.0;
            let across = match (pole, t < 0.5) {
                (false, _) => row,
                (true, true) => sheet[1],
                (true, false) => sheet[2],
            };
            let (columns, v) = (self.columns, self.v());
            let vertex = |j: f64| {
                let (quadrant, u) = columns.locate(j);
                let (b, db) = bernstein(u);
                let slope = DVec3::Z * along[2];
                let normal = turned_point(across, quadrant, db)
                    .cross(turned_point(along, quadrant, b).with_z(0.0) + slope);
                columns.vertex(j, v, turned_point(row, quadrant, b), normal)
            };
            let row = if pole { self.grid.pole(vertex) } else { self.grid.ring(|j| vertex(f64::from(j))) };
            self.append(row);
        }
    }

    fn sweep(&mut self, sheets: &[[Swept; 4]]) {
        for (sheet, t) in self.parameters(sheets) {
            let (b, db) = bernstein(t);
            let (row, along) = (blend(sheet, b), blend(sheet, db));
            let (columns, v) = (self.columns, self.v());
            let row = self.grid.ring(|j| {
                let (position, across) = columns.swept(row, f64::from(j));
                let (along, _) = columns.swept(along, f64::from(j));
                columns.vertex(f64::from(j), v, position, across.cross(along))
            });
            self.append(row);
        }
    }

    /// A turned row with normals straight up.
    fn level_ring(&mut self, row: Turned) {
        let (columns, v) = (self.columns, self.v());
        let row = self.grid.ring(|j| {
            let (quadrant, u) = columns.locate(f64::from(j));
            columns.vertex(f64::from(j), v, turned_point(row, quadrant, bernstein(u).0), DVec3::Z)
        });
        self.append(row);
    }

    /// A swept row with one normal.
    fn flat_ring(&mut self, row: Swept, normal: DVec3) {
        let (columns, v) = (self.columns, self.v());
        let row =
            self.grid.ring(|j| columns.vertex(f64::from(j), v, columns.swept(row, f64::from(j)).0, normal));
        self.append(row);
    }

    fn centre(&mut self, position: DVec3, normal: DVec3) {
        let (columns, v) = (self.columns, self.v());
        let row = self.grid.pole(|j| columns.vertex(j, v, position, normal));
        self.append(row);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use math::Vec3;

    const LEVELS: std::ops::RangeInclusive<u32> = 1..=16;

    #[test]
    fn every_shell_of_the_solid_is_watertight_and_outward() {
        for level in LEVELS {
            let shells = teapot_shells(level);
            for (i, shell) in shells.iter().enumerate() {
                shell.validate().unwrap();
                assert!(shell.is_closed(), "shell {i}, level {level}");
                assert!(shell.signed_volume() > 0.05, "shell {i}, level {level}: {}", shell.signed_volume());
            }
            assert!(teapot_solid(level).is_closed());
        }
        let [body, handle, spout] = teapot_shells(16).map(|s| s.signed_volume());
        // The body without its lid is about 2.4 high and 3.8 wide.
        assert!((25.0..28.0).contains(&body), "{body}");
        assert!(handle < 0.8 && spout < 2.0, "{handle} {spout}");
    }

    #[test]
    fn normals_agree_with_the_triangles() {
        // The spout's lip is so sharp that coarse triangles there turn away from their corners' normals; they converge.
        for (level, least) in [(6, 0.1), (7, 0.1), (11, 0.4), (16, 0.65), (64, 0.97)] {
            for mesh in [teapot(level), teapot_solid(level)] {
                mesh.validate().unwrap();
                for (i, t) in mesh.indices.iter().enumerate() {
                    let [a, b, c] = mesh.corners(i).map(|p| p.as_dvec3());
                    let n = (b - a).cross(c - a);
                    assert!(n.length() > 1e-9, "level {level}: triangle {i} has no area: {a} {b} {c}");
                    for &v in t {
                        let cosine = mesh.normals[v as usize].as_dvec3().dot(n.normalize());
                        assert!(cosine > least, "level {level}: {cosine} at {a} {b} {c}");
                    }
                }
            }
        }
    }

    #[test]
    fn poles_have_vertical_normals() {
        for level in LEVELS {
            for (part, y, normal) in
                [(TeapotPart::Lid, 3.15, Vec3::Y), (TeapotPart::Bottom, 0.0, Vec3::NEG_Y)]
            {
                let mesh = teapot_part(part, level);
                let pole = Vec3::new(0.0, y, 0.0);
                let at: Vec<_> = (0..mesh.positions.len()).filter(|&i| mesh.positions[i] == pole).collect();
                assert_eq!(at.len(), 4 * level as usize);
                assert!(at.iter().all(|&i| mesh.normals[i].distance(normal) < 1e-6));
            }
        }
    }

    #[test]
    fn it_has_the_documented_size_and_faces() {
        let mesh = teapot(16);
        let bounds = mesh.bounds();
        assert_eq!((bounds.min.x, bounds.min.y, bounds.max.y), (-3.0, 0.0, 3.15));
        assert!((bounds.max.x - 3.434).abs() < 0.005, "{bounds:?}");
        assert!((bounds.max.z - 2.0).abs() < 0.01 && bounds.max.z == -bounds.min.z);
        // Two triangles a quad, one where a side of it is a point.
        assert_eq!(mesh.indices.len(), 32 * 16 * 16 * 2 - 2 * 4 * 16);
    }

    #[test]
    fn body_and_bottom_share_their_edge_exactly() {
        for level in LEVELS {
            let both = teapot_part(TeapotPart::Body, level).merged(&teapot_part(TeapotPart::Bottom, level));
            // Only the opening is left: fill it.
            let rim = (0..4 * level).map(|j| both.positions[j as usize]).collect::<Vec<_>>();
            let mut lid = TriangleMesh { positions: rim, ..Default::default() };
            lid.indices = (1..4 * level - 1).map(|j| [0, j + 1, j]).collect();
            let bare = TriangleMesh { normals: Vec::new(), uvs: Vec::new(), ..both };
            assert!(bare.merged(&lid).is_closed(), "level {level}");
        }
    }

    #[test]
    fn capped_roots_lie_inside_the_body() {
        let [body, handle, spout] = teapot_shells(8);
        // The body's least radius between the heights of its roots, lip and foot left out.
        let wall = body.positions.iter().filter(|p| p.y > 0.5 && p.y < 2.3);
        let least = wall.map(|p| p.x.hypot(p.z)).fold(f32::INFINITY, f32::min);
        let spout_root = spout.positions.iter().filter(|p| p.x == 1.7);
        assert!(spout_root.clone().count() > 16);
        assert!(least > 1.5);
        for p in spout_root {
            assert!(p.x.hypot(p.z) < 1.8 && p.y > 0.59 && p.y < 1.43, "{p}");
        }
        let upper = handle.positions.iter().filter(|p| p.x > -1.61 && p.y > 2.0);
        assert!(upper.clone().count() > 16);
        for p in upper {
            // There the wall's radius is 1.5 and more: its control points recede downwards from the rim.
            assert!(p.x.hypot(p.z) < 1.72 && p.y < 2.26, "{p}");
        }
        assert!(handle.positions.iter().all(|p| p.y > 0.59));
    }
}
