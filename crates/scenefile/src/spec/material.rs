//! `[materials.NAME]`.

use super::Kind::{ColorOrTexture, NumberOrTexture};
use super::Preset::{Absent, Number};
use super::{
    Form, Key, Kind, NON_NEGATIVE, POSITIVE, Preset, Range, Section, Switch, UNIT, Variant, closed, key, word,
};

const TWO_SIDED: Key = key(
    "two_sided",
    Kind::Bool,
    "",
    Preset::Bool(true),
    "Whether the back scatters as the front does; else it is black.",
);

/// Roughness of facets, in either of two measures.
const ROUGH: &[Key] = &[
    key("roughness", NumberOrTexture(UNIT), "", Number(0.0), "0 is smooth; the GGX alpha is its square."),
    key(
        "anisotropy",
        NumberOrTexture(closed(-1.0, 1.0)),
        "",
        Number(0.0),
        "Alpha is r^2/a along growing u and r^2 a across, a = sqrt(1 - 0.9 anisotropy); below 0 the other way round.",
    ),
    key(
        "alpha",
        NumberOrTexture(UNIT),
        "",
        Absent("roughness counts"),
        "The alpha of GGX (or Beckmann) itself, instead of roughness.",
    ),
    key(
        "alpha_across",
        NumberOrTexture(UNIT),
        "",
        Absent("as alpha"),
        "The alpha at right angles to growing u, where alpha is that along it.",
    ),
];

const FACETS: Key = key(
    "facets",
    Kind::Word(&[
        word("conserving", "GGX, with the energy of light that bounces several times among the facets."),
        word("single-bounce", "GGX, one bounce alone, which darkens: as pbrt-v4."),
        word(
            "separable",
            "GGX, one bounce alone, masking of the two directions independent: as Mitsuba with ggx.",
        ),
        word("beckmann", "Beckmann, one bounce alone: as Mitsuba with beckmann."),
    ]),
    "",
    Preset::Word("conserving"),
    "How the facets of a rough surface are modelled.",
);

/// An interference film.
const FILM: &[Key] = &[
    key(
        "film_thickness",
        Kind::Number(closed(0.0, 4000.0)),
        "nm",
        Number(0.0),
        "Of a transparent film on the surface, which colours by interference; 0: none.",
    ),
    key("film_ior", Kind::Number(closed(1.0, 3.75)), "", Number(1.3), "The refractive index of the film."),
];

const METAL: &[Key] = &[
    key(
        "metal",
        Kind::Text,
        "",
        Absent("n and k"),
        "A metal with measured data: \"gold\", \"silver\", \"copper\", \"aluminium\", …",
    ),
    key("n", Kind::Color(POSITIVE), "", Absent("metal"), "Real part of the refractive index."),
    key("k", Kind::Color(NON_NEGATIVE), "", Absent("metal"), "Imaginary part of the index."),
];

const SPECULAR: Key =
    key("specular", ColorOrTexture(UNIT), "", Number(1.0), "A factor on the light that is reflected.");

const COAT_IOR: Key = key("ior", IOR, "", Number(1.5), "The refractive index of the coat, or its name.");

const DEPTH: Key = key(
    "depth",
    Kind::Number(closed(0.0, 100.0)),
    "",
    Number(0.0),
    "Optical depth of the coat along its normal; 0: clear.",
);

const PRIORITY: Key = key(
    "priority",
    Kind::Integer(i32::MIN as i128, i32::MAX as i128),
    "",
    Preset::Integer(0),
    "Where solids overlap the highest counts; among equals the last entered.",
);

/// What the inside of a solid absorbs, in either of two ways to say it.
const ABSORPTION: &[Key] = &[
    key(
        "absorption",
        Kind::Color(NON_NEGATIVE),
        "1/scene unit",
        Number(0.0),
        "What the inside absorbs: of light, e^(-absorption * distance) is left.",
    ),
    key(
        "attenuation_color",
        Kind::Color(Range { max: 1.0, open_max: false, ..POSITIVE }),
        "",
        Absent("absorption counts"),
        "What is left of white light after attenuation_distance.",
    ),
    key(
        "attenuation_distance",
        Kind::Number(POSITIVE),
        "scene units",
        Absent("absorption counts"),
        "The distance after which attenuation_color is left.",
    ),
];

/// A number from 0 to 1, or a texture.
const fn share(name: &'static str, preset: f64, doc: &'static str) -> Key {
    key(name, NumberOrTexture(UNIT), "", Number(preset), doc)
}

/// A factor in each channel, or a texture.
const fn factor(name: &'static str, preset: f64, doc: &'static str) -> Key {
    key(name, ColorOrTexture(UNIT), "", Number(preset), doc)
}

/// Refractive indices: bubbles in glass have less than 1.
const IOR: Kind = Kind::Ior(closed(0.1, 10.0));

/// As [`ROUGH`], with a default of its own.
const ROUGH_PRINCIPLED: &[Key] = &[
    share("roughness", 0.5, "Of metal and dielectric: the GGX alpha is its square."),
    ROUGH[1],
    ROUGH[2],
    ROUGH[3],
];

const PRINCIPLED: &[Key] = &[
    factor("base_color", 0.5, "Of the matt base and of the metal; tint of what is transmitted."),
    share("metallic", 0.0, "The share of metal."),
    key("ior", IOR, "", Number(1.5), "The refractive index of the dielectric, or its name."),
    share("specular", 1.0, "A factor on the dielectric's reflection."),
    factor("specular_color", 1.0, "Its colour."),
    share("transmission", 0.0, "The share of the dielectric that light passes, as glass."),
    key(
        "thin",
        Kind::Bool,
        "",
        Preset::Bool(false),
        "Whether the surface is a thin sheet, which light crosses straight on; else it bounds a solid.",
    ),
    share("diffuse_transmission", 0.0, "The share of the matt base's light that goes to the other side."),
    factor("sheen_color", 0.0, "The colour of a sheen on top; black: none."),
    share("sheen_roughness", 0.3, "The alpha of the sheen is its square, 0.07 at least."),
    share("clearcoat", 0.0, "The share under a clear coat of index 1.5."),
    share("clearcoat_roughness", 0.03, "The GGX alpha of the coat is its square."),
    share("film", 0.0, "The share under a thin film, which colours by interference."),
    key(
        "film_thickness",
        NumberOrTexture(closed(0.0, 4000.0)),
        "nm",
        Number(400.0),
        "The thickness of the film.",
    ),
    FILM[1],
    PRIORITY,
];

/// `[materials.NAME]`.
pub const MATERIALS: Section = Section {
    name: "materials",
    noun: "material",
    form: Form::Named,
    doc: "Materials, to be named by objects. `preset = \"NAME\"` stands for the keys of a known one: see presets.",
    switch: Some(Switch {
        key: "kind",
        preset: None,
        variants: &[
            Variant {
                name: "diffuse",
                doc: "Matt (Lambertian).",
                keys: &[&[
                    key("color", ColorOrTexture(UNIT), "", Number(0.5), "The part of the light reflected."),
                    TWO_SIDED,
                ]],
                example: "[materials.white]\nkind = \"diffuse\"\ncolor = [0.725, 0.71, 0.68]\n",
            },
            Variant {
                name: "phong",
                doc: "Diffuse plus a glossy lobe: the energy-normalised Phong model of Lafortune and Willems 1994.",
                keys: &[&[
                    key("diffuse", ColorOrTexture(UNIT), "", Number(0.5), "The diffuse part."),
                    key(
                        "specular",
                        ColorOrTexture(UNIT),
                        "",
                        Number(0.2),
                        "The glossy part; with the diffuse part at most 1.",
                    ),
                    key(
                        "exponent",
                        NumberOrTexture(Range { max: 1e6, open_max: false, ..NON_NEGATIVE }),
                        "",
                        Number(50.0),
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
                    key("color", ColorOrTexture(UNIT), "", Number(1.0), "The part of the light reflected."),
                    TWO_SIDED,
                ]],
                example: "[materials.mirror]\nkind = \"mirror\"\n",
            },
            Variant {
                name: "dielectric",
                doc: "Clear glass or liquid, smooth or frosted: reflects and refracts by Fresnel's law.",
                keys: &[
                    &[
                        key(
                            "ior",
                            IOR,
                            "",
                            Number(1.5),
                            "The refractive index, or \"water\", \"glass\", \"N-BK7\", \"diamond\", …",
                        ),
                        key(
                            "outside_ior",
                            Kind::Number(closed(0.1, 10.0)),
                            "",
                            Absent("that of the solid which it lies in"),
                            "The index before the surface, whatever it lies in: for surfaces that are interfaces by themselves.",
                        ),
                        factor("color", 1.0, "A factor on the light that passes the surface."),
                        SPECULAR,
                        FACETS,
                        PRIORITY,
                    ],
                    ROUGH,
                    FILM,
                    ABSORPTION,
                ],
                example: "[materials.glass]\nkind = \"dielectric\"\nior = 1.5\n",
            },
            Variant {
                name: "conductor",
                doc: "Metal, smooth or rough.",
                keys: &[METAL, ROUGH, &[SPECULAR, FACETS, TWO_SIDED], FILM],
                example: "[materials.gold]\nkind = \"conductor\"\nmetal = \"gold\"\nroughness = 0.3\n",
            },
            Variant {
                name: "plastic",
                doc: "A matt base under a clear coat.",
                keys: &[&[factor("color", 0.5, "The colour of the base."), COAT_IOR, TWO_SIDED], ROUGH],
                example: "[materials.lacquer]\nkind = \"plastic\"\ncolor = \"#b03020\"\nroughness = 0.2\n",
            },
            Variant {
                name: "rough-diffuse",
                doc: "Matt and rough, as plaster or clay: energy-preserving Oren-Nayar (Portsmouth, Kutz & Hill 2025).",
                keys: &[&[
                    factor("color", 0.5, "The part of the light reflected."),
                    share("roughness", 0.5, "0 is Lambertian; r = B/A of Oren and Nayar's."),
                    TWO_SIDED,
                ]],
                example: "[materials.clay]\nkind = \"rough-diffuse\"\ncolor = [0.6, 0.4, 0.3]\nroughness = 0.8\n",
            },
            Variant {
                name: "diffuse-transmission",
                doc: "Paper, leaves, lampshades: scatters evenly to both sides.",
                keys: &[&[
                    factor("reflectance", 0.25, "The part of the light reflected."),
                    factor("transmittance", 0.25, "The part that passes; with the other at most 1."),
                ]],
                example: "[materials.paper]\nkind = \"diffuse-transmission\"\nreflectance = 0.5\ntransmittance = 0.3\n",
            },
            Variant {
                name: "sheen",
                doc: "Velvet: upright fibres over black (Estevez & Kulla 2017).",
                keys: &[&[
                    factor("color", 0.5, "The colour of the fibres."),
                    share("roughness", 0.5, "The alpha of the lobe is its square, 0.07 at least."),
                    TWO_SIDED,
                ]],
                example: "[materials.velvet]\nkind = \"sheen\"\ncolor = [0.5, 0.05, 0.1]\n",
            },
            Variant {
                name: "thin-dielectric",
                doc: "A thin pane, as of a window, modelled by one surface: light crosses it straight on.",
                keys: &[
                    &[
                        key("ior", IOR, "", Number(1.5), "The refractive index of the pane, or its name."),
                        factor("color", 1.0, "A factor on the light that passes."),
                        SPECULAR,
                    ],
                    ROUGH,
                ],
                example: "[materials.pane]\nkind = \"thin-dielectric\"\n",
            },
            Variant {
                name: "coated-diffuse",
                doc: "As plastic, with all that it may have.",
                keys: &[
                    &[
                        factor("color", 0.5, "The colour of the base."),
                        SPECULAR,
                        COAT_IOR,
                        FACETS,
                        key(
                            "nonlinear",
                            Kind::Bool,
                            "",
                            Preset::Bool(true),
                            "Whether light thrown back onto the base takes its colour each time; not in Mitsuba's default.",
                        ),
                        DEPTH,
                        TWO_SIDED,
                    ],
                    ROUGH,
                ],
                example: "[materials.enamel]\nkind = \"coated-diffuse\"\ncolor = [0.1, 0.3, 0.6]\nalpha = 0.05\n",
            },
            Variant {
                name: "coated-conductor",
                doc: "Varnished metal.",
                keys: &[
                    METAL,
                    ROUGH,
                    &[
                        COAT_IOR,
                        share(
                            "coat_roughness",
                            0.0,
                            "Of the coat: 0 is smooth; its GGX alpha is the square.",
                        ),
                        DEPTH,
                        FACETS,
                        TWO_SIDED,
                    ],
                ],
                example: "[materials.brass]\nkind = \"coated-conductor\"\nmetal = \"brass\"\nroughness = 0.4\n",
            },
            Variant {
                name: "principled",
                doc: "Disney's and OpenPBR's slab: sheen over clear coat over metal or dielectric, which transmits or has a matt base.",
                keys: &[PRINCIPLED, ROUGH_PRINCIPLED, ABSORPTION],
                example: "[materials.car]\nkind = \"principled\"\nbase_color = [0.6, 0.02, 0.02]\nmetallic = 0.5\nclearcoat = 1\n",
            },
            Variant {
                name: "mix",
                doc: "Two materials, side by side in grains finer than can be seen.",
                keys: &[&[
                    key("a", Kind::Material, "", Preset::Required, "The one."),
                    key("b", Kind::Material, "", Preset::Required, "The other."),
                    share("amount", 0.5, "The share of b."),
                ]],
                example: "[materials.rust]\nkind = \"mix\"\na = { kind = \"conductor\", metal = \"iron\" }\nb = { kind = \"diffuse\", color = [0.4, 0.1, 0.05] }\namount = 0.3\n",
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
            "opacity",
            NumberOrTexture(UNIT),
            "",
            Number(1.0),
            "How much of the surface is there; rays of all kinds pass the rest. Lamps are opaque.",
        ),
        key(
            "opacity_cutoff",
            Kind::Number(UNIT),
            "",
            Absent("opacity is a chance"),
            "Where opacity is at least this the surface is opaque, elsewhere there is none.",
        ),
        key(
            "normal_strength",
            Kind::Number(closed(0.0, 100.0)),
            "",
            Number(1.0),
            "A factor on the slopes of the normal map.",
        ),
        key(
            "bump_map",
            Kind::Texture,
            "",
            Absent("none"),
            "A texture of heights: the mean of its channels bends the normals.",
        ),
        key(
            "bump_height",
            Kind::Number(super::ANY),
            "scene units",
            Number(1.0),
            "The height of the bump map where its texture is 1.",
        ),
        key(
            "rotation",
            NumberOrTexture(super::ANY),
            "degrees",
            Number(0.0),
            "Turns the tangent, along which anisotropy lies, from growing u toward growing v.",
        ),
    ],
    example: "",
};
