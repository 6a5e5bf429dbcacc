//! `[[objects]]`, `[groups.NAME]`, `[[instances]]` and placements.

use super::Kind::{Color, Direction, Integer, Number, Point};
use super::Preset::{Absent, Required, Triple};
use super::{
    ANY, Form, Key, Kind, NON_NEGATIVE, POSITIVE, Preset, Section, Switch, Variant, Word, closed, key, word,
};

const ORIGIN: Preset = Triple([0.0; 3]);
const UP: Preset = Triple([0.0, 1.0, 0.0]);
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

const SHAPES: &[Variant] = &[
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
        doc: "A mesh file, OBJ or PLY.",
        keys: &[&[
            key(
                "file",
                Kind::File(&["obj", "ply", "ply.gz"]),
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
        doc: "An open tube; normals point outward.",
        keys: &[&[
            key("base", Point, "scene units", ORIGIN, "The centre of the rim that it starts from."),
            AXIS,
            RADIUS,
            key("height", Number(POSITIVE), "scene units", Preset::Number(1.0), "Its length along the axis."),
            key("inward", Kind::Bool, "", Preset::Bool(false), "Whether normals point to the axis."),
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
];

const STEPS: Key =
    key("transform", Kind::Transform, "", Absent("none"), "Steps that place it, the first one first.");

/// `[[objects]]`.
pub const OBJECTS: Section = Section {
    name: "objects",
    noun: "object",
    form: Form::List,
    doc: "Surfaces. One with radiance or power is a light.",
    switch: Some(Switch { key: "shape", preset: None, variants: SHAPES }),
    keys: &[
        key(
            "name",
            Kind::Text,
            "",
            Absent("none"),
            "A name for messages and for --set objects.NAME.KEY=VALUE.",
        ),
        key(
            "material",
            Kind::Material,
            "",
            Absent("black, if it emits light"),
            "The name of a material, or a material in place: { kind = … }.",
        ),
        STEPS,
        key(
            "flip_normals",
            Kind::Bool,
            "",
            Preset::Bool(false),
            "Turns the normals, and so the side that emits.",
        ),
        key(
            "radiance",
            Color(NON_NEGATIVE),
            "W/(sr m^2)",
            Absent("it emits nothing"),
            "The light that it emits, the same in every direction.",
        ),
        key(
            "power",
            Number(POSITIVE),
            "W",
            Absent("radiance counts"),
            "The total flux, instead of radiance.",
        ),
        super::light::LUMENS,
        key(
            "nits",
            Number(POSITIVE),
            "cd/m^2",
            Absent("radiance counts"),
            "The luminance, instead of radiance.",
        ),
        super::light::COLOR,
        super::light::TEMPERATURE,
        key(
            "emission_texture",
            Kind::Texture,
            "",
            Absent("white"),
            "A factor on the radiance over the surface; of a power it is the proportion.",
        ),
        key(
            "two_sided_emission",
            Kind::Bool,
            "",
            Absent("false"),
            "Whether both sides emit and share the power; else the side of the normal.",
        ),
        key(
            "light_group",
            Kind::Text,
            "",
            Absent("the object's name"),
            "Lights of one group share a layer where film.layers asks for lights.",
        ),
    ],
    example: "",
};

/// `[groups.NAME]`.
pub const GROUPS: Section = Section {
    name: "groups",
    noun: "group",
    form: Form::Named,
    doc: "Objects that appear only where an instance places them.",
    switch: None,
    keys: &[key(
        "objects",
        Kind::Objects,
        "",
        Required,
        "Objects, written as [[groups.NAME.objects]] or in place.",
    )],
    example: "[groups.tree]\n[[groups.tree.objects]]\nshape = \"sphere\"\ncenter = [0, 2, 0]\nmaterial = \"white\"\n",
};

/// `[[instances]]`.
pub const INSTANCES: Section = Section {
    name: "instances",
    noun: "instance",
    form: Form::List,
    doc: "Placed copies of groups; they share memory.",
    switch: None,
    keys: &[
        key(
            "name",
            Kind::Text,
            "",
            Absent("none"),
            "A name for messages and for --set instances.NAME.KEY=VALUE.",
        ),
        key("group", Kind::Group, "", Required, "The name of the group."),
        STEPS,
        key(
            "material",
            Kind::Material,
            "",
            Absent("the objects' own"),
            "Replaces the materials of the group.",
        ),
    ],
    example: "[[instances]]\ngroup = \"tree\"\ntransform = [{ scale = 2 }, { translate = [5, 0, 0] }]\n",
};

/// A placement step.
pub const TRANSFORM: Section = Section {
    name: "transform",
    noun: "step of `transform`",
    form: Form::Inline,
    doc: "A list of steps, each with one of these keys, applied one after the other, the first one first.",
    switch: None,
    keys: &[
        key("translate", Point, "scene units", Absent(""), "Moves by a vector."),
        key("rotate", Kind::Section("rotate"), "", Absent(""), "Turns about an axis through the origin."),
        key("scale", Kind::Factors, "", Absent(""), "Multiplies x, y and z; one number for all."),
        key(
            "look_at",
            Kind::Section("look_at"),
            "",
            Absent(""),
            "Puts the origin at a place and turns +z toward another.",
        ),
        key("matrix", Kind::Matrix, "", Absent(""), "An affine matrix, row by row; it multiplies columns."),
    ],
    example: "[[objects]]\nshape = \"teapot\"\nmaterial = \"white\"\ntransform = [\n  { scale = 0.5 },\n  { rotate = { axis = [0, 1, 0], degrees = 30 } },\n  { translate = [0, 1, 0] },\n]\n",
};

/// `rotate = { … }`.
pub const ROTATE: Section = Section {
    name: "rotate",
    noun: "rotation",
    form: Form::Inline,
    doc: "A turn about an axis through the origin.",
    switch: None,
    keys: &[
        key("axis", Direction, "", UP, "The axis."),
        key("degrees", Number(ANY), "degrees", Required, "Counter-clockwise seen from the tip of the axis."),
    ],
    example: "",
};

/// `look_at = { … }`.
pub const LOOK_AT: Section = Section {
    name: "look_at",
    noun: "look_at step",
    form: Form::Inline,
    doc: "Puts the origin at a position and turns +z toward a target, +y as near to up as may be.",
    switch: None,
    keys: &[
        key("position", Point, "scene units", ORIGIN, "Where the origin goes."),
        key("target", Point, "scene units", Required, "Where +z points."),
        key("up", Direction, "", UP, "Where +y points, as near as may be."),
    ],
    example: "",
};
