//! `[textures.NAME]`.

use super::Kind::ColorOrTexture;
use super::Preset::{Pair, Required};
use super::{ANY, Form, Key, Kind, NON_NEGATIVE, Preset, Section, Switch, Variant, Word, key, word};

const SPACES: &[Word] = &[
    word("srgb", "Decode the sRGB curve: colours in PNG and JPEG files."),
    word("linear", "Take the values as they are: normal maps, roughness."),
];

const WRAPS: &[Word] = &[
    word("repeat", "Copies."),
    word("clamp", "The border goes on."),
    word("mirror", "Every other copy is mirrored."),
];

const LOOKUPS: &[Word] = &[
    word("trilinear", "Between mip levels, by the size of what a ray sees."),
    word("bilinear", "Between four texels."),
    word("nearest", "The nearest texel."),
];

const SCALE: Key =
    key("scale", Kind::Pair(ANY), "", Preset::Number(1.0), "Copies along u and v; one number for both.");

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
                keys: &[&[
                    key(
                        "file",
                        Kind::File(&["png", "jpg", "jpeg", "hdr", "exr"]),
                        "",
                        Required,
                        "The picture; relative to the scene file.",
                    ),
                    key(
                        "color_space",
                        Kind::Word(SPACES),
                        "",
                        Preset::Word("srgb"),
                        "How texels become linear; HDR and EXR always are.",
                    ),
                    key(
                        "wrap",
                        Kind::Word(WRAPS),
                        "",
                        Preset::Word("repeat"),
                        "What lies outside of 0 to 1.",
                    ),
                    key(
                        "filter",
                        Kind::Word(LOOKUPS),
                        "",
                        Preset::Word("trilinear"),
                        "How texels are interpolated.",
                    ),
                    SCALE,
                    key(
                        "offset",
                        Kind::Pair(ANY),
                        "",
                        Pair([0.0; 2]),
                        "Added to the coordinates after scaling.",
                    ),
                ]],
                example: "[textures.wood]\nkind = \"image\"\nfile = \"wood.png\"\nscale = [4, 2]\n",
            },
            Variant {
                name: "checker",
                doc: "Two colours in alternating squares, two by two in a unit of u and v.",
                keys: &[&[
                    key("a", ColorOrTexture(NON_NEGATIVE), "", Required, "The colour of the first square."),
                    key("b", ColorOrTexture(NON_NEGATIVE), "", Required, "The other colour."),
                    SCALE,
                ]],
                example: "[textures.tiles]\nkind = \"checker\"\na = 0.8\nb = [0.1, 0.1, 0.3]\nscale = 8\n",
            },
        ],
    }),
    keys: &[],
    example: "",
};

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
