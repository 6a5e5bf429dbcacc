//! `[textures.NAME]`.

use super::Kind::{ColorOrTexture, NumberOrTexture};
use super::Preset::{Absent, Number, Pair, Required};
use super::{ANY, Form, Key, Kind, Preset, Section, Switch, UNIT, Variant, Word, key, word};

const SPACES: &[Word] = &[
    word("srgb", "Decode the sRGB curve: colours in PNG and JPEG files."),
    word("linear", "Take the values as they are: normal maps, roughness."),
];

const WRAPS: &[Word] = &[
    word("repeat", "Copies."),
    word("clamp", "The border goes on."),
    word("mirror", "Every other copy is mirrored."),
    word("black", "Nothing: 0, before `invert`."),
];

const LOOKUPS: &[Word] = &[
    word("trilinear", "Between mip levels, by the size of what a ray sees."),
    word("bilinear", "Between four texels."),
    word("nearest", "The nearest texel."),
];

const CHANNELS: &[Word] = &[
    word("rgb", "Red, green and blue."),
    word("r", "Red, for all three."),
    word("g", "Green, for all three."),
    word("b", "Blue, for all three."),
    word("a", "Opacity, for all three; 1 where there is none. Never decoded as colour."),
];

const CHANNEL: Key = key("channel", Kind::Word(CHANNELS), "", Preset::Word("rgb"), "What is used of it.");

/// Where a texture lies on a surface.
const MAPPING: &[Key] = &[
    key(
        "uv_set",
        Kind::Integer(0, 1),
        "",
        Preset::Integer(0),
        "Which of the mesh's texture coordinates: `uvs` or `uvs2`; the first where there is no second.",
    ),
    key("scale", Kind::Pair(ANY), "", Number(1.0), "Copies along u and v; one number for both."),
    key(
        "rotation",
        Kind::Number(ANY),
        "degrees",
        Number(0.0),
        "Turns the scaled coordinates from u toward v.",
    ),
    key("offset", Kind::Pair(ANY), "", Pair([0.0; 2]), "Added to the coordinates after scaling and turning."),
    key(
        "planar_u",
        Kind::Point,
        "1 / scene unit",
        Absent("texture coordinates count"),
        "The texture lies in space, not on the surface: u is the dot product of this and the place.",
    ),
    key("planar_v", Kind::Point, "1 / scene unit", Absent("with planar_u"), "The same for v."),
];

/// Of noise that is a sum of octaves.
const OCTAVES: &[Key] = &[
    key("octaves", Kind::Integer(1, 32), "", Preset::Integer(8), "Each of twice the frequency of the last."),
    key("roughness", Kind::Number(UNIT), "", Number(0.5), "Factor on the amplitude from octave to octave."),
];

/// Of noise.
const PLACE: &[Key] = &[key(
    "transform",
    Kind::Transform,
    "",
    Absent("none"),
    "Places the texture in the world; noise varies over about one unit.",
)];

/// A required colour.
const fn part(name: &'static str, doc: &'static str) -> Key {
    key(name, ColorOrTexture(ANY), "", Required, doc)
}

/// `[textures.NAME]`.
pub const TEXTURES: Section = Section {
    name: "textures",
    noun: "texture",
    form: Form::Named,
    doc: "Textures, to be used wherever a colour or a \"number or texture\" is asked for: { texture = \"NAME\" }.",
    switch: Some(Switch {
        key: "kind",
        preset: None,
        variants: &[
            Variant {
                name: "image",
                doc: "A picture file.",
                keys: &[
                    &[
                        key(
                            "file",
                            Kind::File(PICTURES),
                            "",
                            Required,
                            "The picture; relative to the scene file.",
                        ),
                        key(
                            "color_space",
                            Kind::Word(SPACES),
                            "",
                            Preset::Word("srgb"),
                            "How texels become linear; HDR, EXR and PFM always are.",
                        ),
                        key(
                            "wrap",
                            Kind::Word(WRAPS),
                            "",
                            Preset::Word("repeat"),
                            "What lies outside of 0 to 1.",
                        ),
                        key(
                            "wrap_v",
                            Kind::Word(WRAPS),
                            "",
                            Absent("as wrap"),
                            "The same along v, where `wrap` is along u.",
                        ),
                        key(
                            "filter",
                            Kind::Word(LOOKUPS),
                            "",
                            Preset::Word("trilinear"),
                            "How texels are interpolated.",
                        ),
                        CHANNEL,
                        key("invert", Kind::Bool, "", Preset::Bool(false), "1 - x for each linear value x."),
                        key(
                            "factor",
                            Kind::Color(ANY),
                            "",
                            Number(1.0),
                            "Factor on the linear values, after `invert`.",
                        ),
                    ],
                    MAPPING,
                ],
                example: "[textures.wood]\nkind = \"image\"\nfile = \"wood.png\"\nscale = [4, 2]\n",
            },
            Variant {
                name: "checker",
                doc: "Two colours in alternating squares, two by two in a unit of u and v.",
                keys: &[
                    &[part("a", "The colour of the first square."), part("b", "The other colour.")],
                    MAPPING,
                ],
                example: "[textures.tiles]\nkind = \"checker\"\na = 0.8\nb = [0.1, 0.1, 0.3]\nscale = 8\n",
            },
            Variant {
                name: "dots",
                doc: "Round dots scattered over the surface, one in every second unit square of u and v.",
                keys: &[
                    &[part("inside", "The colour of a dot."), part("outside", "The colour around it.")],
                    MAPPING,
                ],
                example: "[textures.spots]\nkind = \"dots\"\ninside = [0.7, 0.1, 0.1]\noutside = 0.8\nscale = 20\n",
            },
            Variant {
                name: "product",
                doc: "The product of two colours or textures.",
                keys: &[&[part("a", "The one."), part("b", "The other.")]],
                example: "[textures.dyed]\nkind = \"product\"\na = { texture = \"wood\" }\nb = [1, 0.6, 0.4]\n",
            },
            Variant {
                name: "mix",
                doc: "Between two colours or textures.",
                keys: &[&[
                    part("a", "The colour where `amount` is 0."),
                    part("b", "The colour where it is 1."),
                    key("amount", NumberOrTexture(ANY), "", Number(0.5), "Share of `b`."),
                ]],
                example: "[textures.worn]\nkind = \"mix\"\na = { texture = \"wood\" }\nb = 0.3\namount = { texture = \"spots\" }\n",
            },
            Variant {
                name: "fbm",
                doc: "Noise in space: a sum of octaves about 0.",
                keys: &[OCTAVES, PLACE],
                example: "[textures.bumps]\nkind = \"fbm\"\noctaves = 6\ntransform = [{ scale = 0.1 }]\n",
            },
            Variant {
                name: "wrinkled",
                doc: "Noise in space: a sum of the octaves' absolute values.",
                keys: &[OCTAVES, PLACE],
                example: "[textures.creases]\nkind = \"wrinkled\"\n",
            },
            Variant {
                name: "windy",
                doc: "Noise in space, about 0: waves on water in changing wind.",
                keys: &[PLACE],
                example: "[textures.waves]\nkind = \"windy\"\n",
            },
            Variant {
                name: "marble",
                doc: "The colours of marble in layers along y, shaken by noise.",
                keys: &[
                    OCTAVES,
                    &[
                        key("scale", Kind::Number(ANY), "", Number(1.0), "Factor on the place."),
                        key("variation", Kind::Number(ANY), "", Number(0.2), "Strength of the shaking."),
                    ],
                    PLACE,
                ],
                example: "[textures.stone]\nkind = \"marble\"\nscale = 3\n",
            },
            Variant {
                name: "vertex-color",
                doc: "The colours of a mesh's vertices, interpolated; white where it has none.",
                keys: &[&[CHANNEL]],
                example: "[textures.painted]\nkind = \"vertex-color\"\n",
            },
        ],
    }),
    keys: &[],
    example: "",
};

/// Extensions of picture files that can be read.
pub const PICTURES: &[&str] =
    &["png", "jpg", "jpeg", "tif", "tiff", "webp", "bmp", "tga", "ppm", "pgm", "hdr", "exr", "pfm"];

/// `{ texture = "NAME" }`, wherever a colour is asked for.
pub const TEXTURE_REF: Section = Section {
    name: "texture",
    noun: "texture reference",
    form: Form::Inline,
    doc: "A texture where a colour or a number stands otherwise.",
    switch: None,
    keys: &[key("texture", Kind::Texture, "", Required, "The name of a texture.")],
    example: "[materials.floor]\nkind = \"diffuse\"\ncolor = { texture = \"tiles\" }\n",
};
