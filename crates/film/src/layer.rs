/// One quantity that a film holds for every pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Layer {
    /// Radiance: direct + caustic + indirect.
    Beauty,
    /// Radiance emitted toward the camera or scattered once, on a non-delta surface, from a light, specular chains
    /// before the camera included.
    Direct,
    /// Radiance that came through specular surfaces onto a non-delta one (L S⁺ D).
    Caustic,
    /// All other radiance.
    Indirect,
    /// Reflectance of the first non-delta surface, in [0, 1].
    Albedo,
    /// Shading normal of that surface, in render space; a mean, so shorter than 1 on edges.
    Normal,
    /// Distance from the camera, in scene units: the nearest of all passes, +∞ where nothing was hit.
    Depth,
    /// Photons per unit area that the estimates at this pixel found.
    PhotonDensity,
    /// Standard error of the luminance of beauty ([`crate::Film::noise`]).
    Noise,
}

impl Layer {
    /// All layers, in the order of files.
    pub const ALL: [Self; 9] = [
        Self::Beauty,
        Self::Direct,
        Self::Caustic,
        Self::Indirect,
        Self::Albedo,
        Self::Normal,
        Self::Depth,
        Self::PhotonDensity,
        Self::Noise,
    ];

    /// The name in files and on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Beauty => "beauty",
            Self::Direct => "direct",
            Self::Caustic => "caustic",
            Self::Indirect => "indirect",
            Self::Albedo => "albedo",
            Self::Normal => "normal",
            Self::Depth => "depth",
            Self::PhotonDensity => "photonDensity",
            Self::Noise => "noise",
        }
    }

    /// The layer of that [`name`](Self::name).
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|l| l.name() == name)
    }

    /// Channel names in EXR files, in the order of the values; beauty is the root layer.
    pub const fn channel_names(self) -> &'static [&'static str] {
        match self {
            Self::Beauty => &["R", "G", "B"],
            Self::Direct => &["direct.R", "direct.G", "direct.B"],
            Self::Caustic => &["caustic.R", "caustic.G", "caustic.B"],
            Self::Indirect => &["indirect.R", "indirect.G", "indirect.B"],
            Self::Albedo => &["albedo.R", "albedo.G", "albedo.B"],
            Self::Normal => &["normal.X", "normal.Y", "normal.Z"],
            Self::Depth => &["depth.Z"],
            Self::PhotonDensity => &["photonDensity.Y"],
            Self::Noise => &["noise.Y"],
        }
    }

    /// Values a pixel.
    pub const fn channels(self) -> usize {
        self.channel_names().len()
    }

    /// Whether the layer is the mean over passes. Depth is the least value instead, since a mean over an edge lies
    /// on no surface; noise is of the film as a whole.
    pub const fn is_averaged(self) -> bool {
        !matches!(self, Self::Depth | Self::Noise)
    }

    /// Whether the signed weights of the pixel filter apply (radiance), or every pass counts alike (the others).
    pub const fn is_weighted(self) -> bool {
        matches!(self, Self::Beauty | Self::Direct | Self::Caustic | Self::Indirect)
    }
}
