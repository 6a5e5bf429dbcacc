//! `[textures.NAME]` and `[materials.NAME]`.

use super::Kind::{ColorOrTexture, NumberOrTexture};
use super::Preset::{Absent, Pair, Required};
use super::{
    ANY, Form, Key, Kind, NON_NEGATIVE, POSITIVE, Preset, Range, Section, Switch, UNIT, Variant, Word,
    closed, key, word,
};

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

const TWO_SIDED: Key = key(
    "two_sided",
    Kind::Bool,
    "",
    Preset::Bool(true),
    "Whether the back scatters as the front does; else it is black.",
);

const ROUGHNESS: Key = key(
    "roughness",
    NumberOrTexture(UNIT),
    "",
    Preset::Number(0.0),
    "0 is smooth; the GGX alpha is its square.",
);

const ALPHA: Key = key(
    "alpha",
    Kind::Number(UNIT),
    "",
    Absent("roughness counts"),
    "The GGX alpha itself, instead of roughness.",
);

/// Refractive indices: bubbles in glass have less than 1.
const IOR: Kind = Kind::Ior(closed(0.1, 10.0));

/// `[materials.NAME]`.
pub const MATERIALS: Section = Section {
    name: "materials",
    noun: "material",
    form: Form::Named,
    doc: "Materials, to be named by objects.",
    switch: Some(Switch {
        key: "kind",
        preset: None,
        variants: &[
            Variant {
                name: "diffuse",
                doc: "Matt (Lambertian).",
                keys: &[&[
                    key(
                        "color",
                        ColorOrTexture(UNIT),
                        "",
                        Preset::Number(0.5),
                        "The part of the light reflected.",
                    ),
                    TWO_SIDED,
                ]],
                example: "[materials.white]\nkind = \"diffuse\"\ncolor = [0.725, 0.71, 0.68]\n",
            },
            Variant {
                name: "phong",
                doc: "Diffuse plus a glossy lobe: the energy-normalised Phong model of Lafortune and Willems 1994.",
                keys: &[&[
                    key("diffuse", ColorOrTexture(UNIT), "", Preset::Number(0.5), "The diffuse part."),
                    key(
                        "specular",
                        ColorOrTexture(UNIT),
                        "",
                        Preset::Number(0.2),
                        "The glossy part; with the diffuse part at most 1.",
                    ),
                    key(
                        "exponent",
                        NumberOrTexture(Range { max: 1e6, open_max: false, ..NON_NEGATIVE }),
                        "",
                        Preset::Number(50.0),
                        "The higher, the narrower the highlight.",
                    ),
                    TWO_SIDED,
                ]],
                example: "[materials.steel]\nkind = \"phong\"\ndiffuse = 0.1\nspecular = 0.8\nexponent = 500\n",
            },
            Variant {
                name: "mirror",
                doc: "A perfect mirror.",
                keys: &[&[
                    key(
                        "color",
                        ColorOrTexture(UNIT),
                        "",
                        Preset::Number(1.0),
                        "The part of the light reflected.",
                    ),
                    TWO_SIDED,
                ]],
                example: "[materials.mirror]\nkind = \"mirror\"\n",
            },
            Variant {
                name: "dielectric",
                doc: "Clear glass or liquid: reflects and refracts by Fresnel's law.",
                keys: &[&[
                    key(
                        "ior",
                        IOR,
                        "",
                        Preset::Number(1.5),
                        "The refractive index, or \"water\", \"glass\", \"N-BK7\", \"diamond\", …",
                    ),
                    key(
                        "color",
                        ColorOrTexture(UNIT),
                        "",
                        Preset::Number(1.0),
                        "A factor on the light that passes the surface.",
                    ),
                    key(
                        "priority",
                        Kind::Integer(i32::MIN as i128, i32::MAX as i128),
                        "",
                        Preset::Integer(0),
                        "Where solids overlap the highest counts; among equals the last entered.",
                    ),
                ]],
                example: "[materials.glass]\nkind = \"dielectric\"\nior = 1.5\n",
            },
            Variant {
                name: "conductor",
                doc: "Metal, smooth or rough.",
                keys: &[&[
                    key(
                        "metal",
                        Kind::Text,
                        "",
                        Absent("n and k"),
                        "A metal with measured data: \"gold\", \"silver\", \"copper\", \"aluminium\", …",
                    ),
                    key(
                        "n",
                        Kind::Color(POSITIVE),
                        "",
                        Absent("metal"),
                        "Real part of the refractive index.",
                    ),
                    key("k", Kind::Color(NON_NEGATIVE), "", Absent("metal"), "Imaginary part of the index."),
                    ROUGHNESS,
                    ALPHA,
                    TWO_SIDED,
                ]],
                example: "[materials.gold]\nkind = \"conductor\"\nmetal = \"gold\"\nroughness = 0.3\n",
            },
            Variant {
                name: "plastic",
                doc: "A matt base under a clear coat.",
                keys: &[&[
                    key("color", ColorOrTexture(UNIT), "", Preset::Number(0.5), "The colour of the base."),
                    key(
                        "ior",
                        IOR,
                        "",
                        Preset::Number(1.5),
                        "The refractive index of the coat, or its name.",
                    ),
                    ROUGHNESS,
                    ALPHA,
                    TWO_SIDED,
                ]],
                example: "[materials.lacquer]\nkind = \"plastic\"\ncolor = \"#b03020\"\nroughness = 0.2\n",
            },
        ],
    }),
    keys: &[
        key(
            "normal_map",
            Kind::Texture,
            "",
            Absent("none"),
            "A texture of tangent-space normals (color_space = \"linear\", +y up), by name.",
        ),
        key(
            "normal_strength",
            Kind::Number(closed(0.0, 100.0)),
            "",
            Preset::Number(1.0),
            "A factor on the slopes of the normal map.",
        ),
    ],
    example: "",
};
