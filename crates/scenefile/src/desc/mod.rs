//! What a scene file says: plain data, nothing compiled.
//!
//! Lengths are in scene units (metres where physical units matter), angles in degrees, colours linear RGB (Rec. 709
//! primaries), radiometric quantities in SI units per RGB channel. Names are resolved by whoever compiles the scene;
//! what that stage may reject carries its span ([`Sourced`]). Every type but the named exceptions has a `Default`
//! that equals what the reader takes for absent keys.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use crate::source::Sourced;

mod light;
mod material;
mod shape;
mod texture;

pub use light::{
    Emission, EmissionAmount, Light, LightKind, PointAmount, ProfileAmount, SkyMapping, SunSky,
    WHITE_EFFICACY, channel_power,
};
pub use material::{
    CoatedConductor, CoatedDiffuse, Conductor, Dielectric, Facets, Ior, Material, MaterialKind, Metal,
    Principled, Roughness, ThinDielectric, ThinFilm,
};
pub use shape::{
    Brilliant, HeightField, HeightSource, Normals, Shape, TEAPOT_PARTS, TeapotPart, WaterSurface,
};
pub use texture::{
    Channel, ColorDesc, ColorSpace, EmbeddedImage, FloatDesc, Image, ImageSource, Mapping, Noise, NoiseKind,
    Texture, TextureFilter, Wrap,
};

/// A point, vector or colour.
pub type Triple = [f32; 3];

/// A whole scene and how to render it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SceneDesc {
    /// The folder that relative file names start from; empty for the working directory.
    pub base: PathBuf,
    /// What to compute.
    pub render: Render,
    /// The picture.
    pub film: Film,
    /// The camera; a scene without one does not compile.
    pub camera: Option<Sourced<Camera>>,
    /// Settings of the two-pass photon map.
    pub photon_map: PhotonMap,
    /// Stochastic progressive photon mapping.
    pub sppm: Sppm,
    /// Vertex connection and merging.
    pub vcm: Vcm,
    /// Textures by name.
    pub textures: BTreeMap<String, Sourced<Texture>>,
    /// Materials by name.
    pub materials: BTreeMap<String, Sourced<Material>>,
    /// Surfaces, in the order written.
    pub objects: Vec<Sourced<Object>>,
    /// Lights that are not surfaces, in the order written.
    pub lights: Vec<Sourced<Light>>,
    /// Objects that appear only where an instance places them.
    pub groups: BTreeMap<String, Sourced<Group>>,
    /// Placed copies of groups.
    pub instances: Vec<Sourced<Instance>>,
}

impl SceneDesc {
    /// The path that a file name of this description means: relative ones start from `base`.
    pub fn resolve(&self, file: &Path) -> PathBuf {
        self.base.join(file)
    }
}

/// The algorithm that renders.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum IntegratorKind {
    /// Path tracing, light sampling and merging with photons where that pays.
    #[default]
    Auto,
    /// Unidirectional path tracing with light sampling.
    Path,
    /// Two-pass photon mapping.
    PhotonMap,
    /// Stochastic progressive photon mapping.
    Sppm,
    /// Vertex connection and merging.
    Vcm,
}

impl IntegratorKind {
    /// The name in scene files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Path => "path",
            Self::PhotonMap => "photon_map",
            Self::Sppm => "sppm",
            Self::Vcm => "vcm",
        }
    }
}

/// What to compute: `[render]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Render {
    /// The algorithm.
    pub integrator: IntegratorKind,
    /// Passes, each one camera sample a pixel; at least 1.
    pub passes: u32,
    /// Seed of every random number.
    pub seed: u64,
    /// Scattering events on a path, at most; 1 is direct light only, `None` unlimited.
    pub max_depth: Option<u32>,
    /// Grain of the picture, as a share of a pixel's luminance, below which no more passes are needed.
    pub noise: Option<f32>,
}

impl Default for Render {
    fn default() -> Self {
        Self { integrator: IntegratorKind::Auto, passes: 128, seed: 0, max_depth: None, noise: None }
    }
}

/// Whether noise is taken out of pictures when they are written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Denoise {
    /// Pictures are what was rendered.
    #[default]
    Off,
    /// Where Open Image Denoise is found; else as `Off`.
    Auto,
    /// Where it is not found, nothing is rendered.
    Require,
}

impl Denoise {
    /// The name in scene files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Off => "off",
            Self::Auto => "auto",
            Self::Require => "require",
        }
    }
}

/// The pixel reconstruction filter's shape.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FilterKind {
    /// Constant.
    Box,
    /// Falls linearly to 0 at its radius.
    Triangle,
    /// Gaussian, cut at its radius.
    Gaussian,
    /// Mitchell & Netravali 1988, B = C = 1/3.
    Mitchell,
    /// Blackman–Harris window.
    #[default]
    BlackmanHarris,
}

pub use color::{Exposure, ViewTransform as View, WhiteBalance};

/// The picture: `[film]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    /// Width and height in pixels, each 1..=65536, 2³⁰ pixels at most.
    pub size: [u32; 2],
    /// The part that is rendered, in pixels: columns from the first up to the third, rows from the second up to the fourth;
    /// `None` for all.
    pub crop: Option<[u32; 4]>,
    /// The pixel filter.
    pub filter: FilterKind,
    /// The filter's radius in pixels; `None` is the filter's own default.
    pub filter_radius: Option<f32>,
    /// Exposure of 8-bit output.
    pub exposure: Exposure,
    /// What is white in 8-bit output.
    pub white_balance: WhiteBalance,
    /// The display transform of 8-bit output.
    pub view: View,
    /// A look-up table (.cube) for the display colours of 8-bit output.
    pub lut: Option<Sourced<PathBuf>>,
    /// Whether noise is taken out of pictures when they are written.
    pub denoise: Denoise,
    /// Layers besides those that every picture has.
    pub layers: Layers,
}

/// Layers of a picture that are made on request.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Layers {
    /// One for each technique that finds light.
    pub techniques: bool,
    /// One for each group of lights.
    pub lights: bool,
}

impl Default for Film {
    fn default() -> Self {
        Self {
            size: [512, 512],
            crop: None,
            filter: FilterKind::BlackmanHarris,
            filter_radius: None,
            exposure: Exposure::Auto,
            white_balance: WhiteBalance::None,
            view: View::default(),
            lut: None,
            denoise: Denoise::Off,
            layers: Layers::default(),
        }
    }
}

/// How the camera gathers light.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum CameraKind {
    /// All rays leave one point.
    #[default]
    Pinhole,
    /// A thin lens.
    ThinLens {
        /// Radius of the aperture, scene units, > 0.
        lens_radius: f32,
        /// Distance of the plane in focus along the view direction; `None` is the distance to `look_at`.
        focus_distance: Option<f32>,
    },
    /// Parallel rays; the field of view does not count.
    Orthographic {
        /// Scene units over what the field of view spans otherwise.
        extent: f32,
    },
    /// All directions from one point: the picture is of the whole sphere about it, the direction that +z has in the mapping lies
    /// toward `look_at`, +y (of equal areas: the picture's top) toward `up`.
    Spherical {
        /// Which direction each point of the picture stands for.
        mapping: SkyMapping,
    },
}

/// The side of the picture that the field of view spans.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FovAxis {
    /// The width.
    X,
    /// The height.
    Y,
    /// The shorter of the two.
    #[default]
    Smaller,
}

/// The camera: `[camera]`. In a file `position` and `look_at` have no default.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    /// Pinhole or thin lens.
    pub kind: CameraKind,
    /// The eye.
    pub position: Triple,
    /// A point in the middle of the picture.
    pub look_at: Triple,
    /// A direction that points up in the picture; not parallel to the view.
    pub up: Triple,
    /// Full field of view in degrees, in (0, 180).
    pub fov: f32,
    /// What `fov` spans.
    pub fov_axis: FovAxis,
    /// Moves the picture by this share of its width to the right and of its height up, as a lens that shifts does; what is seen
    /// moves the other way.
    pub shift: [f32; 2],
}

impl Default for Camera {
    fn default() -> Self {
        Self {
            kind: CameraKind::Pinhole,
            position: [0.0, 0.0, 1.0],
            look_at: [0.0; 3],
            up: [0.0, 1.0, 0.0],
            fov: 40.0,
            fov_axis: FovAxis::Smaller,
            shift: [0.0; 2],
        }
    }
}

/// The kernel of a density estimate.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PhotonFilter {
    /// 1/π.
    #[default]
    Constant,
    /// (3/π)(1 − t), t = distance / radius.
    Cone,
    /// (2/π)(1 − t²).
    Epanechnikov,
}

/// Two-pass photon mapping: `[photon_map]`.
#[derive(Clone, Debug, PartialEq)]
pub struct PhotonMap {
    /// Photons emitted for the global map.
    pub photons: u64,
    /// Photons emitted for the caustic map.
    pub caustic_photons: u64,
    /// Neighbours of a lookup in the global map.
    pub knn: u32,
    /// Neighbours of a lookup in the caustic map.
    pub caustic_knn: u32,
    /// Kernel of the global map.
    pub filter: PhotonFilter,
    /// Kernel of the caustic map.
    pub caustic_filter: PhotonFilter,
    /// Greatest lookup radius in the global map, scene units; `None` is automatic.
    pub radius: Option<f32>,
    /// Greatest lookup radius in the caustic map, scene units; `None` is automatic.
    pub caustic_radius: Option<f32>,
    /// Gather rays a camera sample; 0 looks the global map up directly.
    pub final_gather: u32,
    /// Factor on the caustic map's light; 1 is right.
    pub caustic_gain: f32,
}

impl Default for PhotonMap {
    fn default() -> Self {
        Self {
            photons: 200_000,
            caustic_photons: 1_000_000,
            knn: 100,
            caustic_knn: 100,
            filter: PhotonFilter::Constant,
            caustic_filter: PhotonFilter::Epanechnikov,
            radius: None,
            caustic_radius: None,
            final_gather: 16,
            caustic_gain: 1.0,
        }
    }
}

/// Where a progressive estimate gets its light straight from the lights.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DirectLight {
    /// From light sampling.
    #[default]
    Sampling,
    /// From photons, too.
    Photons,
}

/// Stochastic progressive photon mapping: `[sppm]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Sppm {
    /// Photons emitted each pass; `None`: as many as there are pixels.
    pub photons: Option<u64>,
    /// Radius of the first pass in scene units; `None`: `radius_pixels` decides.
    pub radius: Option<f32>,
    /// Radius of the first pass in widths of a pixel where the eye meets the surface.
    pub radius_pixels: f32,
    /// α of Knaus & Zwicker 2011: how slowly the radius shrinks.
    pub alpha: f32,
    /// Where direct light comes from.
    pub direct: DirectLight,
}

impl Default for Sppm {
    fn default() -> Self {
        Self {
            photons: None,
            radius: None,
            radius_pixels: 4.0,
            alpha: 2.0 / 3.0,
            direct: DirectLight::Sampling,
        }
    }
}

/// Which techniques vertex connection and merging combines.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum VcmTechniques {
    /// All of them.
    #[default]
    Vcm,
    /// Connections and light tracing: bidirectional path tracing.
    Bdpt,
    /// Light paths alone, each vertex connected to the camera.
    LightTracing,
    /// Merging at every vertex of the camera path, and light sampling.
    Bpm,
    /// Merging at the first vertex that is not specular.
    Ppm,
}

/// Vertex connection and merging: `[vcm]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Vcm {
    /// What it combines.
    pub techniques: VcmTechniques,
    /// Light paths each pass; `None`: as many as there are pixels.
    pub light_paths: Option<u64>,
    /// Radius of the first pass in scene units; `None`: `radius_pixels` decides.
    pub radius: Option<f32>,
    /// Radius of the first pass in widths of a pixel where the eye meets the surface.
    pub radius_pixels: f32,
    /// α of Knaus & Zwicker 2011: how slowly the radius shrinks.
    pub alpha: f32,
}

impl Default for Vcm {
    fn default() -> Self {
        Self {
            techniques: VcmTechniques::Vcm,
            light_paths: None,
            radius: None,
            radius_pixels: 2.0,
            alpha: 2.0 / 3.0,
        }
    }
}

/// The material of an object: named or its own.
#[derive(Clone, Debug, PartialEq)]
pub enum MaterialRef {
    /// A key of [`SceneDesc::materials`].
    Named(Sourced<String>),
    /// Written at the object.
    Inline(Box<Material>),
}

impl From<&str> for MaterialRef {
    fn from(name: &str) -> Self {
        Self::Named(name.into())
    }
}

impl From<Material> for MaterialRef {
    fn from(material: Material) -> Self {
        Self::Inline(Box::new(material))
    }
}

/// One step of a placement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TransformStep {
    /// Moves by a vector.
    Translate(Triple),
    /// Turns about an axis through the origin, counter-clockwise seen from the axis's tip.
    Rotate {
        /// The axis, of any length but zero.
        axis: Triple,
        /// The angle.
        degrees: f32,
    },
    /// Multiplies each coordinate; none is zero.
    Scale(Triple),
    /// Puts the origin at `position` and turns +z toward `target`, +y as near to `up` as may be.
    LookAt {
        /// Where the origin goes.
        position: Triple,
        /// Where +z points.
        target: Triple,
        /// Not parallel to the direction from `position` to `target`.
        up: Triple,
    },
    /// An affine matrix, row by row, that multiplies column vectors: the translation is at 3, 7 and 11, and the
    /// last row is 0 0 0 1.
    Matrix([f32; 16]),
}

/// Steps applied to the object one after the other, the first one first; empty is the identity.
pub type TransformSteps = Vec<TransformStep>;

/// A surface in the scene: `[[objects]]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Object {
    /// A name for messages and overrides; unique among objects.
    pub name: Option<String>,
    /// Its surface.
    pub shape: Sourced<Shape>,
    /// Its material; `None` is black, for emitters only.
    pub material: Option<MaterialRef>,
    /// Its placement.
    pub transform: TransformSteps,
    /// What moves its surface, once it is placed.
    pub displacement: Option<Sourced<Displacement>>,
    /// Turns the normals to the other side (and with them emission).
    pub flip_normals: bool,
    /// The light it gives off.
    pub emission: Option<Sourced<Emission>>,
    /// The group that its light is counted to in layers; `None`: its name.
    pub light_group: Option<String>,
}

/// A surface that is moved along its normals by the heights of a texture, cut fine enough to show them.
#[derive(Clone, Debug, PartialEq)]
pub struct Displacement {
    /// The name of a texture; the mean of its channels is the height.
    pub texture: Sourced<String>,
    /// Scene units that the surface moves out where the texture is 1 above `midlevel`.
    pub scale: f32,
    /// The height that stays where it is.
    pub midlevel: f32,
    /// How long edges may be.
    pub edge: EdgeLength,
}

/// The greatest length of a triangle's edges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EdgeLength {
    /// In scene units, > 0.
    Units(f32),
    /// In pixels of the picture, as far away as the edge is from the camera, > 0.
    Pixels(f32),
}

impl EdgeLength {
    /// What holds where nothing is said.
    pub const DEFAULT: Self = Self::Pixels(2.0);
}

impl Object {
    /// An object of a material, where its shape says.
    pub fn new(shape: Shape, material: impl Into<MaterialRef>) -> Self {
        Self { material: Some(material.into()), ..Self::bare(shape) }
    }

    /// A black lamp.
    pub fn lamp(shape: Shape, emission: Emission) -> Self {
        Self { emission: Some(emission.into()), ..Self::bare(shape) }
    }

    /// A shape alone, without material or light.
    pub fn bare(shape: Shape) -> Self {
        Self {
            name: None,
            shape: shape.into(),
            material: None,
            transform: Vec::new(),
            displacement: None,
            flip_normals: false,
            emission: None,
            light_group: None,
        }
    }
}

/// Objects that are placed together: `[groups.NAME]`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Group {
    /// Its objects.
    pub objects: Vec<Sourced<Object>>,
}

/// A placed copy of a group: `[[instances]]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Instance {
    /// A name for messages and overrides; unique among instances.
    pub name: Option<String>,
    /// A key of [`SceneDesc::groups`].
    pub group: Sourced<String>,
    /// Its placement, after the objects' own.
    pub transform: TransformSteps,
    /// Replaces the material of every object of the group.
    pub material: Option<MaterialRef>,
}
