//! `[[lights]]`.

use super::Kind::{Color, Direction, Number, Point};
use super::Preset::{Absent, Required};
use super::{
    ANY, Form, Key, Kind, NON_NEGATIVE, POSITIVE, Preset, Range, Section, Switch, UNIT, Variant, Word,
    closed, key, word,
};

const POSITION: Key = key("position", Point, "scene units", Required, "Where it is.");

const POWER: Key =
    key("power", Number(POSITIVE), "W", Absent("intensity counts"), "The total flux, instead of intensity.");

pub(super) const LUMENS: Key =
    key("lumens", Number(POSITIVE), "lm", Absent("power counts"), "The luminous flux, instead of power.");

const CANDELA: Key = key(
    "candela",
    Number(POSITIVE),
    "cd",
    Absent("intensity counts"),
    "The luminous intensity, instead of intensity.",
);

pub(super) const COLOR: Key = key(
    "color",
    Color(NON_NEGATIVE),
    "",
    Absent("white"),
    "With one number as amount: the proportions of the channels. Their mean has the power, their luminance the rest.",
);

pub(super) const TEMPERATURE: Key = key(
    "temperature",
    Number(closed(1000.0, 40000.0)),
    "K",
    Absent("color counts"),
    "Instead of color: that of a black body.",
);

const PICTURE_INTENSITY: &[Key] = &[
    key(
        "intensity",
        Color(NON_NEGATIVE),
        "W/sr",
        Absent("candela counts"),
        "The radiant intensity where the picture is 1.",
    ),
    CANDELA,
    COLOR,
    TEMPERATURE,
];

const PICTURE: Kind = Kind::File(super::PICTURES);

const PLACED: Key = key(
    "transform",
    Kind::Transform,
    "",
    Absent("at the origin"),
    "Places and turns it; scaling does not count.",
);

const DIRECTION: Key = key("direction", Direction, "", Required, "The way the light travels.");

/// Names of `desc::SkyMapping`.
pub(super) const MAPPINGS: &[Word] = &[
    word(
        "lat-long",
        "Columns are longitudes, rows latitudes from +y down; the middle is +z, its left quarter +x.",
    ),
    word(
        "equal-area",
        "A square of equal areas (Clarberg 2008) as pbrt-v4 has it: the middle is +z, right +x, bottom +y, the corners -z.",
    ),
];

const MAPPING: Key = key(
    "mapping",
    Kind::Word(MAPPINGS),
    "",
    Preset::Word("lat-long"),
    "With file: which directions its points stand for.",
);

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
                    LUMENS,
                    CANDELA,
                    COLOR,
                    TEMPERATURE,
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
                    LUMENS,
                    CANDELA,
                    COLOR,
                    TEMPERATURE,
                ]],
                example: "[[lights]]\nkind = \"spot\"\nposition = [0, 3, 0]\ntarget = [0, 0, 0]\ncone_angle = 20\nintensity = 50\n",
            },
            Variant {
                name: "profile",
                doc: "A point that shines as a photometric file of a luminaire says: down along -y, C = 0 toward +x, C = 90 toward +z.",
                keys: &[&[
                    key("file", Kind::File(&["ies", "ldt"]), "", Required, "IES LM-63 or EULUMDAT."),
                    key(
                        "scale",
                        Number(POSITIVE),
                        "",
                        Preset::Number(1.0),
                        "Factor on the intensities of the file.",
                    ),
                    Key {
                        preset: Absent("the file counts"),
                        doc: "The total flux, instead of what the file says.",
                        ..POWER
                    },
                    Key {
                        preset: Absent("the file counts"),
                        doc: "The luminous flux, instead of what the file says.",
                        ..LUMENS
                    },
                    Key { doc: "The proportions of the channels.", ..COLOR },
                    TEMPERATURE,
                    PLACED,
                ]],
                example: "[[lights]]\nkind = \"profile\"\nfile = \"lamp.ies\"\ntemperature = 3000\ntransform = [{ translate = [0, 2.5, 0] }]\n",
            },
            Variant {
                name: "goniometric",
                doc: "A point that shines by direction as a picture of the whole sphere has it; its luminance counts.",
                keys: &[
                    &[
                        key("file", PICTURE, "", Required, "The picture."),
                        Key { doc: "Which directions its points stand for.", ..MAPPING },
                        PLACED,
                    ],
                    PICTURE_INTENSITY,
                ],
                example: "[[lights]]\nkind = \"goniometric\"\nfile = \"wood.png\"\ncandela = 200\n",
            },
            Variant {
                name: "projector",
                doc: "A point that throws a picture along +z, its top at +y, its right at -x.",
                keys: &[
                    &[
                        key("file", PICTURE, "", Required, "The picture."),
                        key(
                            "fov",
                            Number(Range { max: 180.0, ..POSITIVE }),
                            "degrees",
                            Preset::Number(40.0),
                            "The full angle over the picture's smaller side.",
                        ),
                        PLACED,
                    ],
                    PICTURE_INTENSITY,
                ],
                example: "[[lights]]\nkind = \"projector\"\nfile = \"wood.png\"\nfov = 30\nintensity = 5\n",
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
                        Absent("lux counts"),
                        "On a plane that faces the light.",
                    ),
                    key(
                        "lux",
                        Number(POSITIVE),
                        "lx",
                        Absent("irradiance counts"),
                        "The illuminance, instead of irradiance.",
                    ),
                    COLOR,
                    TEMPERATURE,
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
                        "nits",
                        Number(POSITIVE),
                        "cd/m^2",
                        Absent("radiance counts"),
                        "Its luminance, instead of radiance.",
                    ),
                    key(
                        "lux",
                        Number(POSITIVE),
                        "lx",
                        Absent("radiance counts"),
                        "What it gives a plane that sees half of it, instead of radiance.",
                    ),
                    COLOR,
                    TEMPERATURE,
                    key(
                        "file",
                        PICTURE,
                        "",
                        Absent("radiance counts"),
                        "A picture of the whole sphere, as mapping has it.",
                    ),
                    MAPPING,
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
            Variant {
                name: "sun-sky",
                doc: "A clear sky by Hosek and Wilkie's model (2012), and the sun as a disc in it.",
                keys: &[&[
                    key(
                        "sun_direction",
                        Direction,
                        "",
                        Required,
                        "Toward the sun; +y is up. Below the horizon there is no light.",
                    ),
                    key(
                        "turbidity",
                        Number(closed(1.0, 10.0)),
                        "",
                        Preset::Number(3.0),
                        "Haze: 2 is an arctic sky, 3 a clear one, 6 a warm moist day, 10 a hazy one.",
                    ),
                    key(
                        "ground_albedo",
                        Color(UNIT),
                        "",
                        Preset::Number(0.3),
                        "Of a ground whose light the sky scatters; the ground itself is not there.",
                    ),
                    key(
                        "sun_scale",
                        Number(NON_NEGATIVE),
                        "",
                        Preset::Number(1.0),
                        "Factor on the sun; 0: none.",
                    ),
                    key(
                        "sun_angle",
                        Number(Range { max: 90.0, open_max: false, ..POSITIVE }),
                        "degrees",
                        Preset::Number(0.2665),
                        "Half the angle across the sun's disc; the light that it gives stays the same.",
                    ),
                    key(
                        "sky_scale",
                        Number(NON_NEGATIVE),
                        "",
                        Preset::Number(1.0),
                        "Factor on the sky; 0: none.",
                    ),
                    key(
                        "transform",
                        Kind::Transform,
                        "",
                        Absent("none"),
                        "Turns both; only what turns counts.",
                    ),
                ]],
                example: "[[lights]]\nkind = \"sun-sky\"\nsun_direction = [1, 1, 0.5]\nturbidity = 3\n",
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
