//! `[render]`, `[film]`, `[camera]`, `[photon_map]`, `[sppm]`, `[vcm]`.

use super::Kind::{Direction, Integer, Number, Point, Size};
use super::Preset::{Absent, Pair, Required, Triple};
use super::{
    Form, Key, Kind, NON_NEGATIVE, POSITIVE, Preset, Range, Section, Switch, Variant, Word, closed, key, word,
};

const INTEGRATORS: &[Word] = &[
    word("auto", "Path tracing, and photons for the caustics; needs no setting."),
    word("path", "Unidirectional path tracing with light sampling."),
    word("photon_map", "Two-pass photon mapping: caustic and global map, final gathering."),
    word("sppm", "Stochastic progressive photon mapping."),
    word("vcm", "Vertex connection and merging; bidirectional path tracing and others as its settings."),
];

/// `[render]`.
pub const RENDER: Section = Section {
    name: "render",
    noun: "table",
    form: Form::Table,
    doc: "What to compute.",
    switch: None,
    keys: &[
        key("integrator", Kind::Word(INTEGRATORS), "", Preset::Word("auto"), "The algorithm."),
        key(
            "passes",
            Integer(1, 1_000_000_000),
            "",
            Preset::Integer(128),
            "Passes, each one camera sample a pixel.",
        ),
        key("seed", Integer(0, u64::MAX as i128), "", Preset::Integer(0), "Seed of every random number."),
        key(
            "max_depth",
            Integer(1, u32::MAX as i128),
            "scattering events",
            Absent("unlimited"),
            "The longest path, counted in scattering events; 1 is direct light only.",
        ),
        key(
            "noise",
            Number(Range { max: 1.0, open_max: false, ..POSITIVE }),
            "",
            Absent("all passes are made"),
            "Ends the render once the grain of a typical pixel is so small: 0.02 is 2 %. `passes` is then the most.",
        ),
    ],
    example: "[render]\nintegrator = \"path\"\npasses = 64\nmax_depth = 8\n",
};

const FILTERS: &[Word] = &[
    word("box", "Constant over a pixel."),
    word("triangle", "Falls linearly to 0; radius 2 unless filter_radius says else."),
    word("gaussian", "Gaussian."),
    word("mitchell", "Mitchell and Netravali, B = C = 1/3."),
    word("blackman-harris", "Blackman-Harris window."),
];

const VIEWS: &[Word] = &[
    word("agx", "AgX: highlights roll off as on film."),
    word("agx-punchy", "AgX with more contrast and saturation."),
    word("aces-like", "The shape of ACES' reference rendering: contrasty, bright colours stay longer."),
    word("srgb", "The plain sRGB curve, clipped."),
    word("false-colour", "Luminance as a colour of a scale in cd/m^2, which is drawn into the picture."),
    word("false-color", "The same."),
];

const EXPOSURES: &[Word] = &[word("auto", "As the picture itself asks for.")];

/// none, auto and the names of illuminants.
const BALANCES: [Word; 2 + color::Illuminant::ALL.len()] = {
    let mut words =
        [word("none", "Colours stay as they are: D65 is white."); 2 + color::Illuminant::ALL.len()];
    words[1] = word("auto", "The light that the picture shows is taken away in part.");
    let mut i = 0;
    while i < color::Illuminant::ALL.len() {
        words[2 + i] = word(color::Illuminant::ALL[i].name(), "A standard illuminant of the CIE.");
        i += 1;
    }
    words
};

const DENOISE: &[Word] = &[
    word("off", "Pictures are what was rendered."),
    word("auto", "By Open Image Denoise where it is found."),
    word("require", "The same; where it is not found, nothing is rendered."),
];

const LAYERS: &[Word] = &[
    word(
        "techniques",
        "One for each way of finding light: technique-emission, -direct, -merge, -connect, -project.",
    ),
    word("lights", "One for each group of lights (light_group): light-NAME."),
];

/// `[film]`.
pub const FILM: Section = Section {
    name: "film",
    noun: "table",
    form: Form::Table,
    doc: "The picture.",
    switch: None,
    keys: &[
        key(
            "size",
            Size(1, 65536),
            "pixels",
            Pair([512.0, 512.0]),
            "Width and height; 2^30 pixels in all at most.",
        ),
        key(
            "crop",
            Kind::Window,
            "pixels",
            Absent("all of it"),
            "Columns x0 up to x1 and rows y0 up to y1, from the top left, are rendered; all else stays black.",
        ),
        key("filter", Kind::Word(FILTERS), "", Preset::Word("blackman-harris"), "The pixel filter."),
        key(
            "filter_radius",
            Number(Range { max: 16.0, open_max: false, ..POSITIVE }),
            "pixels",
            Absent("the filter's own"),
            "Half the width of the filter.",
        ),
        key(
            "exposure",
            Kind::NumberOrWord(closed(-64.0, 64.0), EXPOSURES),
            "EV",
            Preset::Word("auto"),
            "PNG only: radiance is multiplied by 2^exposure.",
        ),
        key(
            "white_balance",
            Kind::NumberOrWord(closed(1000.0, 40000.0), &BALANCES),
            "K",
            Preset::Word("none"),
            "PNG only: light of this temperature or of this illuminant is shown as white.",
        ),
        key(
            "view",
            Kind::Word(VIEWS),
            "",
            Preset::Word("agx-punchy"),
            "PNG only: how radiance becomes display colour.",
        ),
        key(
            "lut",
            Kind::File(&["cube"]),
            "",
            Absent("none"),
            "PNG only: a look-up table of one or three dimensions for display colours, applied after the view.",
        ),
        key(
            "denoise",
            Kind::Word(DENOISE),
            "",
            Preset::Word("off"),
            "Whether noise is taken out of pictures when they are written; EXR gets the layer `denoised`.",
        ),
        key(
            "layers",
            Kind::Words(LAYERS),
            "",
            Absent("none"),
            "EXR only: more layers; those of each word add up to the picture.",
        ),
    ],
    example: "[film]\nsize = [640, 480]\nexposure = 1.5\n",
};

const FOV_AXES: &[Word] =
    &[word("x", "The width."), word("y", "The height."), word("smaller", "The smaller of the two.")];

const FOV: Key = key(
    "fov",
    Number(Range { max: 180.0, ..POSITIVE }),
    "degrees",
    Preset::Number(40.0),
    "The full field of view.",
);
const FOV_AXIS: Key = key(
    "fov_axis",
    Kind::Word(FOV_AXES),
    "",
    Preset::Word("smaller"),
    "The side of the picture that fov spans.",
);
const SHIFT: Key = key(
    "shift",
    Kind::Pair(super::ANY),
    "",
    Pair([0.0; 2]),
    "Shifts the lens by this share of the picture's width to the right and of its height up.",
);

/// `[camera]`.
pub const CAMERA: Section = Section {
    name: "camera",
    noun: "table",
    form: Form::Table,
    doc: "The camera; every scene has one.",
    switch: Some(Switch {
        key: "kind",
        preset: Some("pinhole"),
        variants: &[
            Variant {
                name: "pinhole",
                doc: "All is in focus.",
                keys: &[&[FOV, FOV_AXIS, SHIFT]],
                example: "[camera]\nposition = [0, 1, 5]\nlook_at = [0, 1, 0]\nfov = 40\n",
            },
            Variant {
                name: "thin-lens",
                doc: "A lens that focuses on one plane.",
                keys: &[&[
                    FOV,
                    FOV_AXIS,
                    SHIFT,
                    key("lens_radius", Number(POSITIVE), "scene units", Required, "Radius of the aperture."),
                    key(
                        "focus_distance",
                        Number(POSITIVE),
                        "scene units",
                        Absent("the distance to look_at"),
                        "Distance of the plane in focus, along the view direction.",
                    ),
                ]],
                example: "[camera]\nkind = \"thin-lens\"\nposition = [0, 1, 5]\nlook_at = [0, 1, 0]\nlens_radius = 0.05\n",
            },
            Variant {
                name: "orthographic",
                doc: "Parallel rays: nothing looks smaller for being far away.",
                keys: &[&[
                    key(
                        "extent",
                        Number(POSITIVE),
                        "scene units",
                        Required,
                        "What the picture spans; rays start at position, and what lies behind it is not seen.",
                    ),
                    Key { doc: "The side of the picture that extent spans.", ..FOV_AXIS },
                    SHIFT,
                ]],
                example: "[camera]\nkind = \"orthographic\"\nposition = [5, 5, 5]\nlook_at = [0, 0, 0]\nextent = 3\n",
            },
            Variant {
                name: "spherical",
                doc: "The picture is of all directions from one point.",
                keys: &[&[key(
                    "mapping",
                    Kind::Word(super::light::MAPPINGS),
                    "",
                    Preset::Word("lat-long"),
                    "Which direction each point of the picture stands for; look_at is in its middle.",
                )]],
                example: "[camera]\nkind = \"spherical\"\nposition = [0, 1, 0]\nlook_at = [0, 1, -1]\n",
            },
        ],
    }),
    keys: &[
        key("position", Point, "scene units", Required, "The eye."),
        key("look_at", Point, "scene units", Required, "What is in the middle of the picture."),
        key("up", Direction, "", Triple([0.0, 1.0, 0.0]), "What is up in the picture."),
    ],
    example: "",
};

const KERNELS: &[Word] = &[
    word("constant", "All photons within the radius count the same."),
    word("cone", "Weight falls linearly to 0 at the radius."),
    word("epanechnikov", "Weight 1 - (distance / radius)^2, smooth and with the least variance."),
];

const MOST_PHOTONS: Kind = Integer(0, 1_000_000_000);
const NEIGHBOURS: Kind = Integer(2, 100_000);

/// `[photon_map]`.
pub const PHOTON_MAP: Section = Section {
    name: "photon_map",
    noun: "table",
    form: Form::Table,
    doc: "Two-pass photon mapping (render.integrator = \"photon_map\").",
    switch: None,
    keys: &[
        key(
            "photons",
            MOST_PHOTONS,
            "photons",
            Preset::Integer(200_000),
            "Photons emitted for the global map.",
        ),
        key(
            "caustic_photons",
            MOST_PHOTONS,
            "photons",
            Preset::Integer(1_000_000),
            "Photons emitted for the caustic map, aimed at mirrors, metal and glass.",
        ),
        key("knn", NEIGHBOURS, "photons", Preset::Integer(100), "Neighbours of a lookup in the global map."),
        key(
            "caustic_knn",
            NEIGHBOURS,
            "photons",
            Preset::Integer(100),
            "Neighbours of a lookup in the caustic map.",
        ),
        key("filter", Kind::Word(KERNELS), "", Preset::Word("constant"), "The kernel of the global map."),
        key(
            "caustic_filter",
            Kind::Word(KERNELS),
            "",
            Preset::Word("epanechnikov"),
            "The kernel of the caustic map.",
        ),
        key(
            "radius",
            Number(POSITIVE),
            "scene units",
            Absent("automatic"),
            "The greatest distance of a neighbour in the global map.",
        ),
        key(
            "caustic_radius",
            Number(POSITIVE),
            "scene units",
            Absent("automatic"),
            "The greatest distance of a neighbour in the caustic map.",
        ),
        key(
            "final_gather",
            Integer(0, 65536),
            "rays",
            Preset::Integer(16),
            "Gather rays a camera sample; 0 looks the global map up directly.",
        ),
        key(
            "caustic_gain",
            Number(NON_NEGATIVE),
            "",
            Preset::Number(1.0),
            "A factor on caustics for artists; 1 is physically right.",
        ),
    ],
    example: "[photon_map]\nphotons = 300_000\nknn = 500\ncaustic_photons = 600_000\ncaustic_knn = 80\n",
};

const LEAST_ALPHA: Range = Range { open_max: false, max: 1.0, ..POSITIVE };
const RADIUS: Key = key(
    "radius",
    Number(POSITIVE),
    "scene units",
    Absent("as radius_pixels says"),
    "Radius of the first pass; later ones are smaller.",
);
/// Radius of the first pass in pixels, with its preset.
const fn radius_pixels(preset: f64) -> Key {
    key(
        "radius_pixels",
        Number(POSITIVE),
        "pixels",
        Preset::Number(preset),
        "Radius of the first pass in widths of a pixel at the surface, through mirrors and glass.",
    )
}
const ALPHA: Key = key(
    "alpha",
    Number(LEAST_ALPHA),
    "",
    Preset::Number(2.0 / 3.0),
    "How slowly radii shrink: their squares as passes^(alpha - 1); 1 keeps them (Knaus & Zwicker 2011).",
);

const DIRECT: &[Word] =
    &[word("sampling", "From light sampling."), word("photons", "From photons like all other light.")];

/// `[sppm]`.
pub const SPPM: Section = Section {
    name: "sppm",
    noun: "table",
    form: Form::Table,
    doc: "Stochastic progressive photon mapping (render.integrator = \"sppm\"); nothing here need be given.",
    switch: None,
    keys: &[
        key(
            "photons",
            Integer(1, 1_000_000_000),
            "photons",
            Absent("as many as pixels"),
            "Photons emitted each pass.",
        ),
        RADIUS,
        radius_pixels(4.0),
        ALPHA,
        key(
            "direct",
            Kind::Word(DIRECT),
            "",
            Preset::Word("sampling"),
            "Where light that comes straight from a light is found.",
        ),
    ],
    example: "[sppm]\nphotons = 300_000\nradius_pixels = 3\n",
};

const TECHNIQUES: &[Word] = &[
    word("vcm", "All: light sampling, connections, merging, light tracing."),
    word("bdpt", "Bidirectional path tracing: all but merging."),
    word("light-tracing", "Light paths whose vertices are connected to the camera; nothing else."),
    word("bpm", "Bidirectional photon mapping: merging at every vertex of the camera path."),
    word("ppm", "Photon mapping: merging at the first vertex that is not specular."),
];

/// `[vcm]`.
pub const VCM: Section = Section {
    name: "vcm",
    noun: "table",
    form: Form::Table,
    doc: "Vertex connection and merging (render.integrator = \"vcm\"); nothing here need be given.",
    switch: None,
    keys: &[
        key("techniques", Kind::Word(TECHNIQUES), "", Preset::Word("vcm"), "What is combined."),
        key(
            "light_paths",
            Integer(1, 1_000_000_000),
            "paths",
            Absent("as many as pixels"),
            "Light paths each pass.",
        ),
        RADIUS,
        radius_pixels(2.0),
        ALPHA,
    ],
    example: "[vcm]\ntechniques = \"bdpt\"\n",
};
