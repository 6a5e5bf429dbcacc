//! `[[lights]]`.

use super::Kind::{Color, Direction, Number, Point};
use super::Preset::{Absent, Required};
use super::{
    ANY, Form, Key, Kind, NON_NEGATIVE, POSITIVE, Preset, Range, Section, Switch, Variant, closed, key,
};

const POSITION: Key = key("position", Point, "scene units", Required, "Where it is.");

const POWER: Key =
    key("power", Number(POSITIVE), "W", Absent("intensity counts"), "The total flux, instead of intensity.");

const COLOR: Key = key(
    "color",
    Color(NON_NEGATIVE),
    "",
    Absent("white"),
    "With power: the proportions of the channels; their mean has the given power.",
);

const DIRECTION: Key = key("direction", Direction, "", Required, "The way the light travels.");

/// `[[lights]]`.
pub const LIGHTS: Section = Section {
    name: "lights",
    noun: "light",
    form: Form::List,
    doc: "Lights without a surface; objects with radiance or power are lights too.",
    switch: Some(Switch {
        key: "kind",
        preset: None,
        variants: &[
            Variant {
                name: "point",
                doc: "The same in every direction from a point.",
                keys: &[&[
                    POSITION,
                    key(
                        "intensity",
                        Color(NON_NEGATIVE),
                        "W/sr",
                        Absent("power counts"),
                        "The radiant intensity.",
                    ),
                    POWER,
                    COLOR,
                ]],
                example: "[[lights]]\nkind = \"point\"\nposition = [0, 3, 0]\npower = 100\ncolor = [1, 0.9, 0.7]\n",
            },
            Variant {
                name: "spot",
                doc: "A cone of light from a point.",
                keys: &[&[
                    POSITION,
                    Key { preset: Absent("target counts"), ..DIRECTION },
                    key("target", Point, "scene units", Absent("direction counts"), "What it points at."),
                    key(
                        "cone_angle",
                        Number(Range { max: 180.0, open_max: false, ..POSITIVE }),
                        "degrees",
                        Preset::Number(30.0),
                        "From the middle of the cone to its border.",
                    ),
                    key(
                        "falloff_angle",
                        Number(closed(0.0, 180.0)),
                        "degrees",
                        Preset::Number(5.0),
                        "Within this much of the border the light falls to 0; at most cone_angle.",
                    ),
                    key(
                        "intensity",
                        Color(NON_NEGATIVE),
                        "W/sr",
                        Absent("power counts"),
                        "The radiant intensity inside.",
                    ),
                    POWER,
                    COLOR,
                ]],
                example: "[[lights]]\nkind = \"spot\"\nposition = [0, 3, 0]\ntarget = [0, 0, 0]\ncone_angle = 20\nintensity = 50\n",
            },
            Variant {
                name: "directional",
                doc: "Parallel light from infinity: the sun.",
                keys: &[&[
                    DIRECTION,
                    key(
                        "irradiance",
                        Color(NON_NEGATIVE),
                        "W/m^2",
                        Required,
                        "On a plane that faces the light.",
                    ),
                ]],
                example: "[[lights]]\nkind = \"directional\"\ndirection = [1, -2, 0]\nirradiance = 1000\n",
            },
            Variant {
                name: "environment",
                doc: "Light from all directions at infinity: the same radiance, or a picture of the sky.",
                keys: &[&[
                    key(
                        "radiance",
                        Color(NON_NEGATIVE),
                        "W/(sr m^2)",
                        Absent("file counts"),
                        "Its radiance.",
                    ),
                    key(
                        "file",
                        Kind::File(&["hdr", "exr", "png", "jpg", "jpeg"]),
                        "",
                        Absent("radiance counts"),
                        "A picture in longitude and latitude, +y up; its middle lies toward +z, its left quarter toward +x.",
                    ),
                    key(
                        "scale",
                        Color(NON_NEGATIVE),
                        "W/(sr m^2)",
                        Preset::Number(1.0),
                        "With file: the radiance that 1 stands for.",
                    ),
                    key(
                        "rotation",
                        Number(ANY),
                        "degrees",
                        Preset::Number(0.0),
                        "With file: turns the sky about +y, from +z toward +x.",
                    ),
                    key(
                        "transform",
                        Kind::Transform,
                        "",
                        Absent("none"),
                        "With file: then turns it further; only what turns counts.",
                    ),
                ]],
                example: "[[lights]]\nkind = \"environment\"\nradiance = [0.5, 0.7, 1]\n",
            },
        ],
    }),
    keys: &[
        key(
            "name",
            Kind::Text,
            "",
            Absent("none"),
            "A name for messages and for --set lights.NAME.KEY=VALUE.",
        ),
        key(
            "light_group",
            Kind::Text,
            "",
            Absent("the light's name"),
            "Lights of one group share a layer where film.layers asks for lights.",
        ),
    ],
    example: "",
};
