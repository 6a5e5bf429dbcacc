//! `[[objects]]`, `[groups.NAME]`, `[[instances]]` and placements.

use super::Kind::{Color, Direction, Number, Point};
use super::Preset::{Absent, Required};
use super::shape::{ORIGIN, SHAPES, UP};
use super::{ANY, Form, Key, Kind, NON_NEGATIVE, POSITIVE, Preset, Section, Switch, key};

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
            "displacement",
            Kind::Section("displacement"),
            "",
            Absent("none"),
            "A texture that moves the surface along its normals, after `transform`.",
        ),
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

/// `displacement = { … }`.
pub const DISPLACEMENT: Section = Section {
    name: "displacement",
    noun: "displacement",
    form: Form::Inline,
    doc: "Moves a surface along its normals by the heights of a texture. Any shape is cut into triangles that are fine enough; what is closed stays closed.",
    switch: None,
    keys: &[
        key("texture", Kind::Texture, "", Required, "The heights: the mean of its channels."),
        key(
            "scale",
            Number(ANY),
            "scene units",
            Required,
            "How far the surface moves where the texture is 1 above `midlevel`; less than 0 turns hills into dales.",
        ),
        key("midlevel", Number(ANY), "", Preset::Number(0.5), "The height that stays where it is."),
        key(
            "edge_length",
            Number(POSITIVE),
            "scene units",
            Absent("edge_pixels counts"),
            "The longest edge of a triangle.",
        ),
        key(
            "edge_pixels",
            Number(POSITIVE),
            "pixels",
            Absent("2"),
            "The longest edge of a triangle as the camera sees it, instead of edge_length.",
        ),
    ],
    example: "[[objects]]\nshape = \"sphere\"\nmaterial = \"gold\"\ndisplacement = { texture = \"bumps\", scale = 0.02, midlevel = 0 }\n",
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
