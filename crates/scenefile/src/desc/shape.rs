//! Shapes.

use std::path::PathBuf;

use super::Triple;
use crate::source::Sourced;

/// The shading normals of a mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Normals {
    /// As given with the mesh; flat where none are.
    #[default]
    Given,
    /// The faces' own.
    Flat,
    /// As given with the mesh; where none are, averaged over the faces that share a vertex (not those that only meet at its
    /// place, in a vertex of their own).
    Completed,
    /// Averaged over the faces at a vertex.
    Smooth {
        /// Edges that bend more than this stay sharp; 180 smooths all.
        crease_degrees: f32,
    },
}

/// Which parts of the teapot to make.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TeapotPart {
    /// The body (rim, upper and lower body).
    Body,
    /// The handle.
    Handle,
    /// The spout.
    Spout,
    /// The lid and its knob.
    Lid,
    /// The bottom.
    Bottom,
}

/// Every part of the teapot, in order.
pub const TEAPOT_PARTS: [TeapotPart; 5] =
    [TeapotPart::Body, TeapotPart::Handle, TeapotPart::Spout, TeapotPart::Lid, TeapotPart::Bottom];

/// A surface. Normals point as stated; [`flip_normals`](super::Object::flip_normals) turns them.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A sphere, normals outward.
    Sphere {
        /// Its centre.
        center: Triple,
        /// Its radius, > 0.
        radius: f32,
    },
    /// A flat disk.
    Disk {
        /// Its centre.
        center: Triple,
        /// Its normal, of any length but zero.
        normal: Triple,
        /// Its radius, > 0.
        radius: f32,
    },
    /// A parallelogram, normal along `edge_u` × `edge_v`.
    Quad {
        /// A corner; uv (0, 0).
        origin: Triple,
        /// From the corner to uv (1, 0).
        edge_u: Triple,
        /// From the corner to uv (0, 1).
        edge_v: Triple,
    },
    /// Four corners, need not be planar: triangles (0, 1, 2) and (0, 2, 3), normals by the right-hand rule,
    /// uv (0,0), (1,0), (1,1), (0,1).
    Corners {
        /// In order around the border.
        corners: [Triple; 4],
    },
    /// A mesh file.
    Mesh {
        /// OBJ, PLY or STL; see [`resolve`](super::SceneDesc::resolve).
        file: Sourced<PathBuf>,
        /// Shading normals.
        normals: Normals,
    },
    /// A mesh in place.
    Triangles {
        /// Vertices.
        positions: Vec<Triple>,
        /// Three vertices a triangle, counter-clockwise seen from the side of the normal.
        indices: Vec<[u32; 3]>,
        /// A shading normal a vertex; empty for none.
        vertex_normals: Vec<Triple>,
        /// Texture coordinates of each vertex; empty for none.
        uvs: Vec<[f32; 2]>,
        /// A second set of texture coordinates; empty for none.
        uvs2: Vec<[f32; 2]>,
        /// Linear RGB and opacity of each vertex; empty for none.
        colors: Vec<[f32; 4]>,
        /// Which shading normals to use.
        normals: Normals,
    },
    /// An axis-aligned box, normals outward.
    Box {
        /// Its least corner.
        min: Triple,
        /// Its greatest corner.
        max: Triple,
    },
    /// Newell's teapot: the bottom's centre at the origin, +y up, the spout toward +x.
    Teapot {
        /// Each of the 32 patches (with their mirror images) is cut into `level`² quadrilaterals; 1..=256.
        level: u32,
        /// The parts to make; [`TEAPOT_PARTS`] is all. Not used where `solid`.
        parts: Vec<TeapotPart>,
        /// Closed shells throughout, as glass needs, instead of Newell's open sheets.
        solid: bool,
    },
    /// A profile turned about the y axis; normals to the right of the way along the profile (up the outside:
    /// outward).
    Lathe {
        /// Points (r, y), r ≥ 0.
        profile: Vec<[f32; 2]>,
        /// Facets around, ≥ 3.
        segments: u32,
        /// Smooth or faceted shading normals.
        smooth: bool,
        /// Whether the last point joins the first.
        closed: bool,
        /// Parts between two points: 1 for straight lines, more for a curve through the points; 1..=1024.
        steps: u32,
        /// Where the profile turns by more than this it has a corner; 0..=180.
        crease_degrees: f32,
    },
    /// A tube or, closed, a solid.
    Cylinder {
        /// Centre of its lower rim.
        base: Triple,
        /// Direction from the base, of any length but zero.
        axis: Triple,
        /// Its radius, > 0.
        radius: f32,
        /// Its length, > 0.
        height: f32,
        /// Whether normals point to the axis instead of away.
        inward: bool,
        /// Whether disks close both ends.
        closed: bool,
        /// Facets around, ≥ 3.
        segments: u32,
    },
    /// A ring, normals outward.
    Torus {
        /// Its centre.
        center: Triple,
        /// Its axis of rotation, of any length but zero.
        axis: Triple,
        /// Radius of the ring's middle line, > 0.
        major_radius: f32,
        /// Radius of the tube, > 0.
        minor_radius: f32,
        /// Facets around the ring, ≥ 3.
        segments: u32,
        /// Facets around the tube, ≥ 3.
        tube_segments: u32,
    },
    /// A subdivided icosahedron with vertices on a sphere.
    Icosphere {
        /// Its centre.
        center: Triple,
        /// Its radius, > 0.
        radius: f32,
        /// Subdivisions: 20·4^level triangles; 0..=9.
        level: u32,
        /// The sphere's shading normals or the facets' own.
        smooth: bool,
    },
    /// A ring with rounded edges about the y axis, from y = 0 up.
    Band {
        /// Radius of the hole, > 0.
        inner_radius: f32,
        /// Radius outside, > `inner_radius`.
        outer_radius: f32,
        /// Its height, > 0.
        height: f32,
        /// Radius of the edges, ≥ 0; brought below half of width and of height.
        fillet: f32,
        /// Facets around, ≥ 3.
        segments: u32,
    },
    /// A ring for a finger, in metres: a [`Band`](Self::Band) of 18 mm inner and 21 mm outer diameter, 6 mm high.
    Ring {
        /// Facets around, ≥ 3.
        segments: u32,
    },
    /// A cup of solid china, in metres: 86.75 mm high, inner radius 40 mm. It stands on the origin, its handle
    /// toward +x.
    CoffeeCup {
        /// Facets around, ≥ 3.
        segments: u32,
    },
    /// A wine glass, in metres: 210 mm high, standing on the origin.
    WineGlass {
        /// Facets around, ≥ 3.
        segments: u32,
    },
    /// The wine in a [`WineGlass`](Self::WineGlass), up to y = 0.14; it reaches half-way into the glass's wall. The
    /// dielectric of higher priority fills the overlap.
    Wine {
        /// Facets around, ≥ 3.
        segments: u32,
    },
    /// A cone, normals outward.
    Cone {
        /// Centre of its base.
        base: Triple,
        /// Direction from the base, of any length but zero.
        axis: Triple,
        /// Its radius at the base, > 0.
        radius: f32,
        /// Its radius at the other end, ≥ 0.
        top_radius: f32,
        /// Its length, > 0.
        height: f32,
        /// Whether disks close the ends.
        closed: bool,
        /// Facets around, ≥ 3.
        segments: u32,
    },
    /// A cylinder between two half balls, normals outward.
    Capsule {
        /// Centre of the first half ball.
        base: Triple,
        /// Direction from the base, of any length but zero.
        axis: Triple,
        /// Its radius, > 0.
        radius: f32,
        /// Between the half balls' centres, > 0.
        height: f32,
        /// Facets around, ≥ 3.
        segments: u32,
    },
    /// A [`Box`](Self::Box) with round edges.
    RoundedBox {
        /// Its least corner.
        min: Triple,
        /// Its greatest corner.
        max: Triple,
        /// Radius of the edges, > 0 and less than half the least side.
        radius: f32,
        /// Facets round each edge, ≥ 1.
        steps: u32,
    },
    /// A cut gem.
    RoundBrilliant(Brilliant),
    /// Water under wind.
    WaterSurface(WaterSurface),
    /// Heights over a rectangle.
    HeightField(HeightField),
}

/// Heights over a rectangle of the plane y = 0 about `center`.
#[derive(Clone, Debug, PartialEq)]
pub struct HeightField {
    /// The middle of where the heights are 0.
    pub center: Triple,
    /// Sides along x and z, > 0.
    pub size: [f32; 2],
    /// The heights.
    pub source: HeightSource,
    /// How high a height of 1 is; below 0 it is a depth.
    pub height: f32,
    /// From height 0 to the bottom of a closed body, > 0; `None` for an open sheet.
    pub depth: Option<f32>,
}

/// Where the heights of a [`HeightField`] come from.
#[derive(Clone, Debug, PartialEq)]
pub enum HeightSource {
    /// The means of the channels of a picture, as numbers without a transfer curve; its top lies toward −z.
    Picture(Sourced<PathBuf>),
    /// Rows from −z to +z, each from −x to +x; two or more of two or more numbers.
    Rows(Vec<Vec<f32>>),
}

impl Shape {
    /// The file that it is read from, if any.
    pub fn file(&self) -> Option<&Sourced<PathBuf>> {
        match self {
            Self::Mesh { file, .. } => Some(file),
            Self::HeightField(HeightField { source: HeightSource::Picture(file), .. }) => Some(file),
            _ => None,
        }
    }

    /// [`Self::file`], to be changed.
    pub fn file_mut(&mut self) -> Option<&mut Sourced<PathBuf>> {
        match self {
            Self::Mesh { file, .. } => Some(file),
            Self::HeightField(HeightField { source: HeightSource::Picture(file), .. }) => Some(file),
            _ => None,
        }
    }
}

/// A round brilliant; ratios are of its diameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Brilliant {
    /// The middle of its girdle.
    pub center: Triple,
    /// Where its table faces; of any length but zero.
    pub axis: Triple,
    /// Of the girdle, corner to corner, > 0.
    pub diameter: f32,
    /// Ratio of the table, corner to corner.
    pub table: f32,
    /// Between girdle and bezels.
    pub crown_degrees: f32,
    /// Between girdle and pavilion mains.
    pub pavilion_degrees: f32,
    /// Ratio of the girdle's height.
    pub girdle: f32,
    /// How far stars reach from table to girdle; 0 to 1.
    pub star_length: f32,
    /// How far lower halves reach from the girdle to the middle; 0 to 1.
    pub lower_half_length: f32,
    /// Ratio of the culet; 0 for a point.
    pub culet: f32,
}

/// Water under wind, in metres and seconds.
#[derive(Clone, Debug, PartialEq)]
pub struct WaterSurface {
    /// The middle of its level.
    pub center: Triple,
    /// Sides along x and z, > 0.
    pub size: [f32; 2],
    /// From the level to the bottom of a closed body, > 0; `None` for an open sheet.
    pub depth: Option<f32>,
    /// Cells along the longer side; 8..=4096.
    pub resolution: u32,
    /// The wind's speed in m/s, ≥ 0.
    pub wind_speed: f32,
    /// Whither it blows, from +x toward −z.
    pub wind_degrees: f32,
    /// How far it has blown over water, > 0.
    pub fetch: f32,
    /// The significant height of the waves, ≥ 0; `None` for what the wind gives.
    pub wave_height: Option<f32>,
    /// How many waves are added up; 1..=4096.
    pub waves: u32,
    /// Which of all such waters.
    pub seed: u32,
    /// The moment in seconds.
    pub time: f32,
}
