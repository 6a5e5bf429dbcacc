//! Which balls there are.

/// A ball and what it is made of.
pub struct Ball {
    /// Of its file, without ending.
    pub name: &'static str,
    /// The keys of its material.
    pub material: &'static str,
    /// Tables that the material needs.
    pub tables: &'static str,
    pub shape: Shape,
}

/// What the studio's ball is.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    Sphere,
    /// Of triangles, with a colour at each vertex.
    Painted,
    /// Something else: the keys of its object.
    Other(&'static str),
}

const fn ball(name: &'static str, material: &'static str) -> Ball {
    Ball { name, material, tables: "", shape: Shape::Sphere }
}

/// A matt ball in the colours of the texture `t`.
const fn textured(name: &'static str, tables: &'static str) -> Ball {
    const MATT: &str = "kind = \"diffuse\"\ncolor = { texture = \"t\" }";
    Ball { name, material: MATT, tables, shape: Shape::Sphere }
}

/// One for every kind, and some that show what a key does.
pub const MATERIALS: &[Ball] = &[
    ball("diffuse", "kind = \"diffuse\"\ncolor = [0.75, 0.25, 0.12]"),
    ball("rough-diffuse", "kind = \"rough-diffuse\"\ncolor = [0.75, 0.25, 0.12]\nroughness = 1"),
    ball("phong", "kind = \"phong\"\ndiffuse = [0.6, 0.2, 0.1]\nspecular = 0.3\nexponent = 60"),
    ball("plastic", "kind = \"plastic\"\ncolor = [0.75, 0.25, 0.12]"),
    ball(
        "coated-diffuse",
        "kind = \"coated-diffuse\"\ncolor = [0.2, 0.45, 0.75]\nspecular = [1, 0.8, 0.4]\nroughness = 0.3",
    ),
    ball("diffuse-transmission", "kind = \"diffuse-transmission\"\nreflectance = 0.35\ntransmittance = [0.5, 0.42, 0.3]"),
    ball("sheen", "kind = \"sheen\"\ncolor = [0.8, 0.2, 0.3]\nroughness = 0.4"),
    ball("mirror", "kind = \"mirror\""),
    ball("conductor", "kind = \"conductor\"\nmetal = \"gold\"\nroughness = 0.25"),
    ball("coated-conductor", "kind = \"coated-conductor\"\nmetal = \"copper\"\nroughness = 0.5"),
    ball("dielectric", "kind = \"dielectric\"\nior = \"glass\""),
    ball("thin-dielectric", "kind = \"thin-dielectric\""),
    ball("principled", "kind = \"principled\"\nbase_color = [0.03, 0.25, 0.3]\nmetallic = 0.6\nroughness = 0.4\nclearcoat = 1"),
    ball(
        "mix",
        "kind = \"mix\"\na = { kind = \"conductor\", metal = \"copper\", roughness = 0.3 }\n\
         b = { kind = \"diffuse\", color = [0.15, 0.45, 0.38] }\namount = { texture = \"t\" }",
    )
    .with("[textures.t]\nkind = \"mix\"\na = 0.5\nb = 2\namount = { texture = \"n\" }\n[textures.n]\nkind = \"fbm\"\ntransform = [{ scale = 0.5 }]"),
    // Roughness.
    ball("metal-0", "kind = \"conductor\"\nmetal = \"silver\""),
    ball("metal-2", "kind = \"conductor\"\nmetal = \"silver\"\nroughness = 0.2"),
    ball("metal-4", "kind = \"conductor\"\nmetal = \"silver\"\nroughness = 0.4"),
    ball("metal-7", "kind = \"conductor\"\nmetal = \"silver\"\nroughness = 0.7"),
    ball("glass-2", "kind = \"dielectric\"\nior = \"glass\"\nroughness = 0.2"),
    ball("glass-4", "kind = \"dielectric\"\nior = \"glass\"\nroughness = 0.4"),
    ball("glass-7", "kind = \"dielectric\"\nior = \"glass\"\nroughness = 0.7"),
    ball("plastic-2", "kind = \"plastic\"\ncolor = [0.75, 0.25, 0.12]\nroughness = 0.2"),
    ball("plastic-4", "kind = \"plastic\"\ncolor = [0.75, 0.25, 0.12]\nroughness = 0.4"),
    ball("plastic-7", "kind = \"plastic\"\ncolor = [0.75, 0.25, 0.12]\nroughness = 0.7"),
    // What else a key does.
    ball("anisotropy", "kind = \"conductor\"\nmetal = \"aluminium\"\nroughness = 0.45\nanisotropy = 0.9"),
    ball("film", "kind = \"conductor\"\nmetal = \"titanium\"\nfilm_thickness = 380\nfilm_ior = 2.3"),
    ball("thin", "kind = \"principled\"\ntransmission = 1\nthin = true\nroughness = 0\nfilm = 1\nfilm_thickness = 350"),
    ball(
        "attenuation",
        "kind = \"dielectric\"\nior = \"glass\"\nattenuation_color = [0.2, 0.55, 0.9]\nattenuation_distance = 1",
    ),
];

/// Of `nephroid describe presets`.
pub const PRESETS: &[Ball] = &[
    ball("gold", "preset = \"gold\""),
    ball("copper", "preset = \"copper\""),
    ball("brass", "preset = \"brass\""),
    ball("brushed-steel", "preset = \"brushed-steel\""),
    ball("cast-iron", "preset = \"cast-iron\""),
    ball("flint-glass", "preset = \"flint-glass\""),
    ball("frosted-glass", "preset = \"frosted-glass\""),
    ball("green-bottle", "preset = \"green-bottle\"\nmetres_per_unit = 0.02"),
    ball("cobalt-glass", "preset = \"cobalt-glass\"\nmetres_per_unit = 0.005"),
    ball("water", "preset = \"water\"\nmetres_per_unit = 0.03"),
    ball("amber", "preset = \"amber\"\nmetres_per_unit = 0.02"),
    ball("ruby", "preset = \"ruby\"\nmetres_per_unit = 0.005"),
    ball("whisky", "preset = \"whisky\"\nmetres_per_unit = 0.03"),
    ball("porcelain", "preset = \"porcelain\""),
    ball("car-paint", "preset = \"car-paint\""),
    ball("piano-lacquer", "preset = \"piano-lacquer\""),
    ball("terracotta", "preset = \"terracotta\""),
    ball("polished-granite", "preset = \"polished-granite\""),
    ball("velvet", "preset = \"velvet\""),
];

/// One for every kind of texture, and for what textures do other than colour.
pub const TEXTURES: &[Ball] = &[
    textured("image", "[textures.t]\nkind = \"image\"\nfile = \"map.png\""),
    textured("checker", "[textures.t]\nkind = \"checker\"\na = 0.8\nb = [0.1, 0.15, 0.4]\nscale = [8, 4]"),
    textured("dots", "[textures.t]\nkind = \"dots\"\ninside = [0.75, 0.1, 0.08]\noutside = 0.8\nscale = [16, 8]"),
    textured(
        "product",
        "[textures.t]\nkind = \"product\"\na = { texture = \"c\" }\nb = [1, 0.5, 0.2]\n\
         [textures.c]\nkind = \"image\"\nfile = \"map.png\"",
    ),
    textured(
        "mix-of-textures",
        "[textures.t]\nkind = \"mix\"\na = [0.1, 0.3, 0.6]\nb = [0.9, 0.75, 0.3]\namount = { texture = \"s\" }\n\
         [textures.s]\nkind = \"checker\"\na = 0\nb = 1\nscale = [6, 3]\nrotation = 45",
    ),
    textured(
        "fbm",
        "[textures.t]\nkind = \"mix\"\na = 0.45\nb = 1.2\namount = { texture = \"n\" }\n\
         [textures.n]\nkind = \"fbm\"\ntransform = [{ scale = 0.4 }]",
    ),
    textured(
        "wrinkled",
        "[textures.t]\nkind = \"mix\"\na = [0.1, 0.05, 0.03]\nb = [0.9, 0.6, 0.4]\namount = { texture = \"n\" }\n\
         [textures.n]\nkind = \"wrinkled\"\ntransform = [{ scale = 0.5 }]",
    ),
    textured(
        "windy",
        "[textures.t]\nkind = \"mix\"\na = [0.12, 0.3, 0.4]\nb = 6\namount = { texture = \"n\" }\n\
         [textures.n]\nkind = \"windy\"\ntransform = [{ scale = 0.3 }]",
    ),
    textured("marble", "[textures.t]\nkind = \"marble\"\nscale = 2\nvariation = 0.4"),
    Ball { shape: Shape::Painted, ..textured("vertex-color", "[textures.t]\nkind = \"vertex-color\"") },
    ball("bump-map", "kind = \"plastic\"\ncolor = [0.3, 0.5, 0.25]\nroughness = 0.25\nbump_map = \"t\"\nbump_height = 0.12")
        .with("[textures.t]\nkind = \"wrinkled\"\ntransform = [{ scale = 0.4 }]"),
    Ball {
        shape: Shape::Other(
            "shape = \"sphere\"\ncenter = [0, 0.95, 0]\nradius = 0.95\ndisplacement = { texture = \"t\", scale = 0.12 }",
        ),
        ..ball("displacement", "kind = \"plastic\"\ncolor = [0.3, 0.5, 0.25]\nroughness = 0.25")
            .with("[textures.t]\nkind = \"wrinkled\"\ntransform = [{ scale = 0.4 }]")
    },
    ball("normal-map", "kind = \"conductor\"\nmetal = \"silver\"\nroughness = 0.3\nnormal_map = \"t\"")
        .with("[textures.t]\nkind = \"image\"\nfile = \"quilt.png\"\ncolor_space = \"linear\""),
    ball("opacity", "kind = \"diffuse\"\ncolor = [0.8, 0.65, 0.2]\nopacity = { texture = \"t\" }")
        .with("[textures.t]\nkind = \"checker\"\na = 0\nb = 1\nscale = [8, 4]"),
    ball("roughness", "kind = \"conductor\"\nmetal = \"copper\"\nroughness = { texture = \"t\" }")
        .with("[textures.t]\nkind = \"checker\"\na = 0.1\nb = 0.6\nscale = [6, 3]"),
];

/// A shape in its place of the ball, of glazed clay.
const fn shaped(name: &'static str, keys: &'static str) -> Ball {
    const CLAY: &str = "kind = \"plastic\"\ncolor = [0.5, 0.62, 0.7]\nroughness = 0.15";
    Ball { name, material: CLAY, tables: "", shape: Shape::Other(keys) }
}

/// One for every shape that has a volume of its own.
pub const SHAPES: &[Ball] = &[
    shaped(
        "box",
        "shape = \"box\"\nmin = [-0.75, 0, -0.75]\nmax = [0.75, 1.5, 0.75]\ntransform = { rotate = { axis = [0, 1, 0], degrees = 30 } }",
    ),
    shaped(
        "rounded-box",
        "shape = \"rounded-box\"\nmin = [-0.75, 0, -0.75]\nmax = [0.75, 1.5, 0.75]\nradius = 0.2\ntransform = { rotate = { axis = [0, 1, 0], degrees = 30 } }",
    ),
    shaped("capsule", "shape = \"capsule\"\nbase = [0, 0.55, 0]\nradius = 0.55\nheight = 0.9"),
    shaped("cylinder", "shape = \"cylinder\"\nradius = 0.8\nheight = 1.5\nclosed = true"),
    shaped("cone", "shape = \"cone\"\nradius = 0.9\nheight = 1.8"),
    shaped(
        "icosphere",
        "shape = \"icosphere\"\ncenter = [0, 0.95, 0]\nradius = 0.95\nlevel = 1\nsmooth = false",
    ),
    shaped("torus", "shape = \"torus\"\ncenter = [0, 0.34, 0]\nmajor_radius = 0.75\nminor_radius = 0.34"),
    shaped("band", "shape = \"band\"\ninner_radius = 0.85\nouter_radius = 1.05\nheight = 0.7\nfillet = 0.08"),
    shaped(
        "lathe",
        "shape = \"lathe\"\nprofile = [[0, 0], [0.45, 0], [0.75, 0.55], [0.4, 1.2], [0.32, 1.6], [0.5, 1.9], [0.44, 1.88], [0.26, 1.6], [0.34, 1.2], [0.68, 0.55], [0.4, 0.08], [0, 0.08]]\nsteps = 8",
    ),
    shaped(
        "teapot",
        "shape = \"teapot\"\nsolid = true\ntransform = [{ scale = 0.43 }, { rotate = { axis = [0, 1, 0], degrees = 25 } }]",
    ),
    shaped(
        "coffee-cup",
        "shape = \"coffee-cup\"\ntransform = [{ scale = 18 }, { rotate = { axis = [0, 1, 0], degrees = -30 } }]",
    ),
    Ball { material: "preset = \"gold\"", ..shaped("ring", "shape = \"ring\"\ntransform = { scale = 95 }") },
    Ball {
        material: "kind = \"dielectric\"\nior = \"glass\"",
        ..shaped("wine-glass", "shape = \"wine-glass\"\ntransform = { scale = 9 }")
    },
    Ball {
        material: "preset = \"diamond\"",
        ..shaped(
            "round-brilliant",
            "shape = \"round-brilliant\"\ncenter = [0, 0.9, 0]\ndiameter = 2\ntransform = { rotate = { axis = [1, 0, 0], degrees = 12 } }",
        )
    },
    Ball {
        material: "preset = \"water\"",
        ..shaped(
            "water-surface",
            "shape = \"water-surface\"\ncenter = [0, 0.7, 0]\nsize = [1.8, 1.8]\ndepth = 0.7\nwind_speed = 4\nfetch = 400\nwave_height = 0.09\nseed = 4\ntransform = { rotate = { axis = [0, 1, 0], degrees = 30 } }",
        )
    },
    shaped(
        "height-field",
        "shape = \"height-field\"\nfile = \"hills.png\"\ncenter = [0, 0.2, 0]\nsize = [1.8, 1.8]\nheight = 0.9\ndepth = 0.2\ntransform = { rotate = { axis = [0, 1, 0], degrees = 30 } }",
    ),
];

impl Ball {
    const fn with(self, tables: &'static str) -> Self {
        Self { tables, ..self }
    }
}
