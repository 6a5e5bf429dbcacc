//! What `shape` of an object may be.

use super::Kind::{Direction, Integer, Number, Pair, Point};
use super::Preset::{Absent, Required, Triple};
use super::{ANY, Key, Kind, NON_NEGATIVE, POSITIVE, Preset, Range, UNIT, Variant, Word, closed, key, word};

/// A ratio that is neither nothing nor all.
const RATIO: Range = Range { open_min: true, open_max: true, ..UNIT };
/// An angle that is neither flat nor upright.
const STEEP: Range = Range { min: 0.0, max: 90.0, open_min: true, open_max: true };
pub(super) const ORIGIN: Preset = Triple([0.0; 3]);
pub(super) const UP: Preset = Triple([0.0, 1.0, 0.0]);
const CENTER: Key = key("center", Point, "scene units", ORIGIN, "Its centre.");
const RADIUS: Key = key("radius", Number(POSITIVE), "scene units", Preset::Number(1.0), "Its radius.");
const AXIS: Key = key("axis", Direction, "", UP, "The way of its axis.");

const fn facets(default: i128) -> Key {
    key("segments", Integer(3, 65536), "facets", Preset::Integer(default), "Facets around.")
}

const SMOOTH: Key =
    key("smooth", Kind::Bool, "", Preset::Bool(true), "Whether the facets are shaded as one smooth surface.");

const NORMALS: &[Word] = &[
    word("given", "Those of the file or vertex_normals; flat where there are none."),
    word("flat", "Every triangle is shaded as flat."),
    word("completed", "As given; where the mesh has none, averaged over the triangles that share a vertex."),
    word("smooth", "Averaged over the triangles that meet at a vertex."),
];

const SHADING: Key =
    key("normals", Kind::Word(NORMALS), "", Preset::Word("given"), "The normals to shade with.");

const CREASE: Key = key(
    "crease_angle",
    Number(closed(0.0, 180.0)),
    "degrees",
    Absent("180"),
    "With normals = \"smooth\": edges that bend more than this stay sharp.",
);

const PARTS: &[Word] = &[
    word("body", "Rim and body."),
    word("handle", "The handle."),
    word("spout", "The spout."),
    word("lid", "The lid with its knob."),
    word("bottom", "The bottom."),
];

/// What `shape` may be.
pub(super) const SHAPES: &[Variant] = &[
    Variant {
        name: "sphere",
        doc: "A sphere; normals point outward.",
        keys: &[&[CENTER, RADIUS]],
        example: "[[objects]]\nshape = \"sphere\"\ncenter = [0, 1, 0]\nradius = 1\nmaterial = \"glass\"\n",
    },
    Variant {
        name: "disk",
        doc: "A flat disk.",
        keys: &[&[CENTER, key("normal", Direction, "", UP, "The side that it faces."), RADIUS]],
        example: "[[objects]]\nshape = \"disk\"\ncenter = [0, 3, 0]\nnormal = [0, -1, 0]\nradius = 0.5\nradiance = 20\n",
    },
    Variant {
        name: "quad",
        doc: "A parallelogram (origin, edge_u, edge_v; its normal is edge_u x edge_v), or four corners.",
        keys: &[&[
            key("origin", Point, "scene units", Absent("corners count"), "A corner."),
            key(
                "edge_u",
                Direction,
                "scene units",
                Absent("corners count"),
                "From the origin to the next corner.",
            ),
            key(
                "edge_v",
                Direction,
                "scene units",
                Absent("corners count"),
                "From the origin to the corner before.",
            ),
            key(
                "corners",
                Kind::Points(4, 4),
                "scene units",
                Absent("origin, edge_u, edge_v count"),
                "Four corners in order around the border, counter-clockwise seen from the front; they need not lie in a plane: two triangles, split from the first to the third.",
            ),
        ]],
        example: "[[objects]]\nshape = \"quad\"\norigin = [-1, 0, 1]\nedge_u = [2, 0, 0]\nedge_v = [0, 0, -2]\nmaterial = \"white\"\n",
    },
    Variant {
        name: "mesh",
        doc: "A mesh file: OBJ, PLY or STL.",
        keys: &[&[
            key(
                "file",
                Kind::File(&["obj", "ply", "ply.gz", "stl"]),
                "",
                Required,
                "The mesh; relative to the scene file.",
            ),
            SHADING,
            CREASE,
        ]],
        example: "[[objects]]\nshape = \"mesh\"\nfile = \"bunny.ply\"\nnormals = \"smooth\"\nmaterial = \"gold\"\n",
    },
    Variant {
        name: "triangles",
        doc: "A mesh written in place.",
        keys: &[&[
            key("positions", Kind::Points(3, usize::MAX), "scene units", Required, "The vertices."),
            key(
                "indices",
                Kind::Indices,
                "",
                Required,
                "Three vertices a triangle, from 0, counter-clockwise seen from the front.",
            ),
            key(
                "vertex_normals",
                Kind::Points(0, usize::MAX),
                "",
                Absent("none"),
                "A normal for each vertex.",
            ),
            key("uvs", Kind::Pairs, "", Absent("none"), "Texture coordinates for each vertex."),
            key("uvs2", Kind::Pairs, "", Absent("none"), "A second set of them."),
            key(
                "colors",
                Kind::VertexColors,
                "",
                Absent("none"),
                "A linear colour for each vertex, for textures of kind \"vertex-color\".",
            ),
            SHADING,
            CREASE,
        ]],
        example: "[[objects]]\nshape = \"triangles\"\npositions = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\nindices = [[0, 1, 2]]\nmaterial = \"white\"\n",
    },
    Variant {
        name: "box",
        doc: "A box along the axes; normals point outward.",
        keys: &[&[
            key("min", Point, "scene units", Required, "Its least corner."),
            key("max", Point, "scene units", Required, "Its greatest corner."),
        ]],
        example: "[[objects]]\nshape = \"box\"\nmin = [-1, 0, -1]\nmax = [1, 2, 1]\nmaterial = \"white\"\n",
    },
    Variant {
        name: "teapot",
        doc: "Newell's teapot: it stands on the origin, +y up, its spout toward +x.",
        keys: &[&[
            key(
                "level",
                Integer(1, 256),
                "",
                Preset::Integer(16),
                "Each patch is cut into level x level quadrilaterals.",
            ),
            key("parts", Kind::Words(PARTS), "", Absent("all"), "The parts to make."),
            key(
                "solid",
                Kind::Bool,
                "",
                Preset::Bool(false),
                "Closed shells throughout, all parts: what glass needs. Newell's own surface is open sheets.",
            ),
        ]],
        example: "[[objects]]\nshape = \"teapot\"\nlevel = 32\nsolid = true\nmaterial = \"glass\"\n",
    },
    Variant {
        name: "lathe",
        doc: "A profile turned about the y axis; normals point to the right of the way along it (bottom to top: outward).",
        keys: &[&[
            key("profile", Kind::Pairs, "scene units", Required, "Points [radius, y]."),
            facets(128),
            SMOOTH,
            key("closed", Kind::Bool, "", Preset::Bool(false), "Whether the last point joins the first."),
            key(
                "steps",
                Integer(1, 1024),
                "",
                Preset::Integer(1),
                "Parts between two points: 1 joins them by straight lines, more by a curve through all of them.",
            ),
            key(
                "crease_angle",
                Number(closed(0.0, 180.0)),
                "degrees",
                Absent("30, or 75 with steps > 1"),
                "Where the profile turns by more than this it has a corner; so it has where a point is given twice.",
            ),
        ]],
        example: "[[objects]]\nshape = \"lathe\"\nprofile = [[0, 0], [0.5, 0], [0.8, 1]]\nmaterial = \"glass\"\n",
    },
    Variant {
        name: "cylinder",
        doc: "A tube, open unless closed is said; normals point outward.",
        keys: &[&[
            key("base", Point, "scene units", ORIGIN, "The centre of the rim that it starts from."),
            AXIS,
            RADIUS,
            key("height", Number(POSITIVE), "scene units", Preset::Number(1.0), "Its length along the axis."),
            key("inward", Kind::Bool, "", Preset::Bool(false), "Whether normals point to the axis."),
            key(
                "closed",
                Kind::Bool,
                "",
                Preset::Bool(false),
                "Whether disks close both ends: a solid, as glass needs.",
            ),
            facets(256),
        ]],
        example: "[[objects]]\nshape = \"cylinder\"\nradius = 1\nheight = 0.5\ninward = true\nmaterial = \"mirror\"\n",
    },
    Variant {
        name: "torus",
        doc: "A ring; normals point outward.",
        keys: &[&[
            CENTER,
            AXIS,
            key(
                "major_radius",
                Number(POSITIVE),
                "scene units",
                Preset::Number(1.0),
                "From the centre to the middle of the tube.",
            ),
            key("minor_radius", Number(POSITIVE), "scene units", Preset::Number(0.25), "Radius of the tube."),
            facets(128),
            key("tube_segments", Integer(3, 65536), "facets", Preset::Integer(64), "Facets around the tube."),
        ]],
        example: "[[objects]]\nshape = \"torus\"\nmajor_radius = 1\nminor_radius = 0.2\nmaterial = \"gold\"\n",
    },
    Variant {
        name: "icosphere",
        doc: "A sphere of triangles: a subdivided icosahedron.",
        keys: &[&[
            CENTER,
            RADIUS,
            key("level", Integer(0, 9), "", Preset::Integer(4), "Subdivisions; 20 x 4^level triangles."),
            SMOOTH,
        ]],
        example: "[[objects]]\nshape = \"icosphere\"\nradius = 1\nlevel = 2\nsmooth = false\nmaterial = \"white\"\n",
    },
    Variant {
        name: "band",
        doc: "A ring with rounded edges about the y axis, from y = 0 up; normals point outward.",
        keys: &[&[
            key("inner_radius", Number(POSITIVE), "scene units", Preset::Number(0.8), "Radius of the hole."),
            key(
                "outer_radius",
                Number(POSITIVE),
                "scene units",
                Preset::Number(1.0),
                "Radius outside, more than inner_radius.",
            ),
            key("height", Number(POSITIVE), "scene units", Preset::Number(0.5), "Its height."),
            key(
                "fillet",
                Number(NON_NEGATIVE),
                "scene units",
                Preset::Number(0.05),
                "Radius of its edges; less than half of width and height is used.",
            ),
            facets(256),
        ]],
        example: "[[objects]]\nshape = \"band\"\ninner_radius = 0.9\nouter_radius = 1\nheight = 0.4\nmaterial = \"gold\"\n",
    },
    Variant {
        name: "ring",
        doc: "A finger ring in metres: 18 mm inner and 21 mm outer diameter, 6 mm high, on the origin about the y axis.",
        keys: &[&[facets(256)]],
        example: "[[objects]]\nshape = \"ring\"\nmaterial = \"gold\"\n",
    },
    Variant {
        name: "coffee-cup",
        doc: "A china cup in metres: it stands on the origin, 87 mm high, 40 mm inner radius, its handle toward +x. A disk of radius 0.041 at y = 0.06 is the coffee.",
        keys: &[&[facets(256)]],
        example: "[[objects]]\nshape = \"coffee-cup\"\nmaterial = \"white\"\n",
    },
    Variant {
        name: "wine-glass",
        doc: "A wine glass in metres: it stands on the origin, 210 mm high, its bowl's inner radius 40 mm at y = 0.14.",
        keys: &[&[facets(256)]],
        example: "[[objects]]\nshape = \"wine-glass\"\nmaterial = { kind = \"dielectric\", priority = 1 }\n",
    },
    Variant {
        name: "wine",
        doc: "The wine in the wine-glass, filled to y = 0.14. It reaches half-way into the glass, so that no air lies between; the higher priority fills the overlap: the wine's, if its color is to tint what leaves through the glass.",
        keys: &[&[facets(256)]],
        example: "[[objects]]\nshape = \"wine\"\nmaterial = { kind = \"dielectric\", ior = 1.34, color = [0.7, 0.1, 0.1], priority = 2 }\n",
    },
    Variant {
        name: "cone",
        doc: "A cone or, with top_radius, a truncated one; closed, normals point outward.",
        keys: &[&[
            key("base", Point, "scene units", ORIGIN, "The centre of its base."),
            AXIS,
            key("radius", Number(POSITIVE), "scene units", Preset::Number(1.0), "Radius at the base."),
            key(
                "top_radius",
                Number(NON_NEGATIVE),
                "scene units",
                Preset::Number(0.0),
                "Radius at the other end; 0 is a tip.",
            ),
            key("height", Number(POSITIVE), "scene units", Preset::Number(1.0), "Its length along the axis."),
            key("closed", Kind::Bool, "", Preset::Bool(true), "Whether disks close the ends."),
            facets(256),
        ]],
        example: "[[objects]]\nshape = \"cone\"\nradius = 0.5\nheight = 1.2\nmaterial = \"white\"\n",
    },
    Variant {
        name: "capsule",
        doc: "A cylinder with a half ball on each end; closed, normals point outward.",
        keys: &[&[
            key("base", Point, "scene units", ORIGIN, "The centre of the first half ball."),
            AXIS,
            RADIUS,
            key(
                "height",
                Number(POSITIVE),
                "scene units",
                Preset::Number(1.0),
                "Between the centres of the half balls.",
            ),
            facets(128),
        ]],
        example: "[[objects]]\nshape = \"capsule\"\nbase = [0, 0.3, 0]\nradius = 0.3\nheight = 0.8\nmaterial = \"glass\"\n",
    },
    Variant {
        name: "rounded-box",
        doc: "A box along the axes with rounded edges and corners; closed, normals point outward.",
        keys: &[&[
            key("min", Point, "scene units", Required, "Its least corner."),
            key("max", Point, "scene units", Required, "Its greatest corner."),
            key(
                "radius",
                Number(POSITIVE),
                "scene units",
                Preset::Number(0.05),
                "Radius of its edges, less than half the least side.",
            ),
            key("steps", Integer(1, 1024), "facets", Preset::Integer(8), "Facets round each edge."),
        ]],
        example: "[[objects]]\nshape = \"rounded-box\"\nmin = [-1, 0, -1]\nmax = [1, 2, 1]\nradius = 0.1\nmaterial = \"glass\"\n",
    },
    Variant {
        name: "round-brilliant",
        doc: "A cut gem by its proportions, Tolkowsky's by default: table, 8 stars, 8 bezels, 16 upper halves, 16 lower halves, 8 mains, and a girdle of 16 flat facets. Closed and convex, flat facets.",
        keys: &[&[
            key("center", Point, "scene units", ORIGIN, "The middle of its girdle."),
            key("axis", Direction, "", UP, "Where its table faces."),
            key(
                "diameter",
                Number(POSITIVE),
                "scene units",
                Preset::Number(1.0),
                "Of the girdle, corner to corner; a diamond of one carat has 6.5 mm.",
            ),
            key(
                "table",
                Number(RATIO),
                "of the diameter",
                Preset::Number(0.53),
                "The table, corner to corner.",
            ),
            key("crown_angle", Number(STEEP), "degrees", Preset::Number(34.5), "Between girdle and bezels."),
            key(
                "pavilion_angle",
                Number(STEEP),
                "degrees",
                Preset::Number(40.75),
                "Between girdle and pavilion mains.",
            ),
            key("girdle", Number(RATIO), "of the diameter", Preset::Number(0.02), "Height of the girdle."),
            key(
                "star_length",
                Number(RATIO),
                "",
                Preset::Number(0.5),
                "How far the stars reach from the table to the girdle, seen from above.",
            ),
            key(
                "lower_half_length",
                Number(RATIO),
                "",
                Preset::Number(0.75),
                "How far the lower halves reach from the girdle to the middle, seen from below.",
            ),
            key(
                "culet",
                Number(Range { open_max: true, ..UNIT }),
                "of the diameter",
                Preset::Number(0.0),
                "The facet at the bottom, corner to corner; 0 is a point.",
            ),
        ]],
        example: "[[objects]]\nshape = \"round-brilliant\"\ndiameter = 0.0065\ncenter = [0, 0.01, 0]\nmaterial = { kind = \"dielectric\", ior = \"diamond\" }\n",
    },
    Variant {
        name: "water-surface",
        doc: "Water under wind, in metres and seconds: a sum of waves by the JONSWAP spectrum, with the normals of the waves. With depth it is a closed body that fills a basin; make it a little wider than the basin, so that its sides lie within the walls.",
        keys: &[&[
            key("center", Point, "m", ORIGIN, "The middle of its level."),
            key("size", Pair(POSITIVE), "m", Preset::Pair([10.0, 10.0]), "Sides along x and z."),
            key(
                "depth",
                Number(POSITIVE),
                "m",
                Absent("an open sheet over deep water"),
                "From the level to the flat bottom of a closed body.",
            ),
            key(
                "resolution",
                Integer(8, 4096),
                "cells",
                Preset::Integer(512),
                "Cells along the longer side; no wave is shorter than four of them.",
            ),
            key(
                "wind_speed",
                Number(closed(0.0, 100.0)),
                "m/s",
                Preset::Number(3.0),
                "Wind 10 m above the water; 0 leaves it flat.",
            ),
            key(
                "wind_direction",
                Number(ANY),
                "degrees",
                Preset::Number(0.0),
                "Whither it blows: 0 is +x, 90 is -z.",
            ),
            key(
                "fetch",
                Number(POSITIVE),
                "m",
                Preset::Number(200.0),
                "How far it has blown over water: short makes ripples, long makes swell.",
            ),
            key(
                "wave_height",
                Number(NON_NEGATIVE),
                "m",
                Absent("by wind and fetch"),
                "Significant height, crest to trough: four standard deviations.",
            ),
            key("waves", Integer(1, 4096), "", Preset::Integer(256), "How many waves are added up."),
            key("seed", Integer(0, 4_294_967_295), "", Preset::Integer(0), "Which of all such waters."),
            key("time", Number(ANY), "s", Preset::Number(0.0), "The moment; the waves travel."),
        ]],
        example: "[[objects]]\nshape = \"water-surface\"\nsize = [4.1, 8.1]\ndepth = 1.5\nwind_speed = 2.5\nfetch = 50\nmaterial = { kind = \"dielectric\", ior = \"water\" }\n",
    },
    Variant {
        name: "height-field",
        doc: "Heights over a rectangle, of a picture or a list, with smooth normals. A vertex stands for each pixel or number: the outermost lie on the border. With depth it is a closed body.",
        keys: &[&[
            key("center", Point, "scene units", ORIGIN, "The middle of where the heights are 0."),
            key("size", Pair(POSITIVE), "scene units", Preset::Pair([1.0, 1.0]), "Sides along x and z."),
            key(
                "file",
                Kind::File(super::PICTURES),
                "",
                Absent("heights"),
                "A picture: its numbers are the heights, from 0 to 1 or as a float file has them, with no curve; the mean of the channels. Its top lies toward -z.",
            ),
            key(
                "heights",
                Kind::Rows,
                "",
                Absent("file"),
                "Rows from -z to +z, each of as many numbers from -x to +x; two at least.",
            ),
            key("height", Number(ANY), "scene units", Preset::Number(1.0), "How high a height of 1 is."),
            key(
                "depth",
                Number(POSITIVE),
                "scene units",
                Absent("an open sheet"),
                "From height 0 to the flat bottom of a closed body.",
            ),
        ]],
        example: "[[objects]]\nshape = \"height-field\"\nsize = [2, 2]\nheights = [[0, 0, 0], [0, 0.25, 0], [0, 0, 0]]\nmaterial = \"white\"\n",
    },
];
