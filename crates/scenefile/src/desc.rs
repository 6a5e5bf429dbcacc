//! What a scene file says: plain data, nothing compiled.
//!
//! Lengths are in scene units (metres where physical units matter), angles in degrees, colours linear RGB (Rec. 709
//! primaries), radiometric quantities in SI units per RGB channel. Names are resolved by whoever compiles the scene;
//! what that stage may reject carries its span ([`Sourced`]). Every type but the named exceptions has a `Default`
//! that equals what the reader takes for absent keys.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use crate::source::Sourced;

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
    /// Two-pass photon mapping.
    #[default]
    PhotonMap,
    /// Unidirectional path tracing with light sampling.
    Path,
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
}

impl Default for Render {
    fn default() -> Self {
        Self { integrator: IntegratorKind::PhotonMap, passes: 16, seed: 0, max_depth: None }
    }
}

/// The pixel reconstruction filter's shape.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FilterKind {
    /// Constant.
    Box,
    /// Gaussian, cut at its radius.
    Gaussian,
    /// Mitchell & Netravali 1988, B = C = 1/3.
    Mitchell,
    /// Blackman–Harris window.
    #[default]
    BlackmanHarris,
}

/// The display transform of 8-bit output.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum View {
    /// AgX, filmic.
    #[default]
    Agx,
    /// The plain sRGB curve, clipped.
    Srgb,
}

/// The picture: `[film]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    /// Width and height in pixels, each 1..=65536, 2³⁰ pixels at most.
    pub size: [u32; 2],
    /// The pixel filter.
    pub filter: FilterKind,
    /// The filter's radius in pixels; `None` is the filter's own default.
    pub filter_radius: Option<f32>,
    /// Exposure of 8-bit output in EV: radiance is multiplied by 2^exposure.
    pub exposure: f32,
    /// The display transform of 8-bit output.
    pub view: View,
}

impl Default for Film {
    fn default() -> Self {
        Self {
            size: [512, 512],
            filter: FilterKind::BlackmanHarris,
            filter_radius: None,
            exposure: 0.0,
            view: View::Agx,
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
            caustic_photons: 400_000,
            knn: 100,
            caustic_knn: 60,
            filter: PhotonFilter::Constant,
            caustic_filter: PhotonFilter::Epanechnikov,
            radius: None,
            caustic_radius: None,
            final_gather: 16,
            caustic_gain: 1.0,
        }
    }
}

/// A colour: constant, or looked up in a texture.
#[derive(Clone, Debug, PartialEq)]
pub enum ColorDesc {
    /// Linear RGB.
    Rgb(Triple),
    /// A texture by name.
    Texture(Sourced<String>),
}

impl ColorDesc {
    /// A texture by name.
    pub fn texture(name: impl Into<String>) -> Self {
        Self::Texture(name.into().into())
    }
}

impl From<Triple> for ColorDesc {
    fn from(rgb: Triple) -> Self {
        Self::Rgb(rgb)
    }
}

impl From<f32> for ColorDesc {
    fn from(grey: f32) -> Self {
        Self::Rgb([grey; 3])
    }
}

/// A number: constant, or looked up in a texture (the mean of its channels).
#[derive(Clone, Debug, PartialEq)]
pub enum FloatDesc {
    /// The same everywhere.
    Value(f32),
    /// A texture by name.
    Texture(Sourced<String>),
}

impl FloatDesc {
    /// A texture by name.
    pub fn texture(name: impl Into<String>) -> Self {
        Self::Texture(name.into().into())
    }
}

impl From<f32> for FloatDesc {
    fn from(value: f32) -> Self {
        Self::Value(value)
    }
}

/// How stored texel values become linear.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ColorSpace {
    /// Decode the sRGB curve (8-bit colour images); floating-point images are linear all the same.
    #[default]
    Srgb,
    /// Take values as they are (normal maps, roughness).
    Linear,
}

/// What lies outside the unit square of texture coordinates.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Wrap {
    /// Copies.
    #[default]
    Repeat,
    /// The border texels.
    Clamp,
    /// Mirrored copies.
    Mirror,
}

/// How texels are interpolated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TextureFilter {
    /// Between mip levels by footprint.
    #[default]
    Trilinear,
    /// Between four texels.
    Bilinear,
    /// The nearest texel.
    Nearest,
}

/// A texture: `[textures.NAME]`.
#[derive(Clone, Debug, PartialEq)]
pub enum Texture {
    /// A picture file.
    Image {
        /// PNG, JPEG, HDR or EXR; see [`SceneDesc::resolve`].
        file: Sourced<PathBuf>,
        /// How texels become linear.
        color_space: ColorSpace,
        /// What lies outside.
        wrap: Wrap,
        /// Interpolation.
        filter: TextureFilter,
        /// Texture coordinates are multiplied by this: copies per unit of u and v.
        scale: [f32; 2],
        /// Then this is added.
        offset: [f32; 2],
    },
    /// Two colours in alternating squares of side 1/2 in scaled coordinates: one period per unit.
    Checker {
        /// Where the whole parts of 2u and 2v add up to an even number.
        a: ColorDesc,
        /// Elsewhere.
        b: ColorDesc,
        /// Texture coordinates are multiplied by this.
        scale: [f32; 2],
    },
}

impl Texture {
    /// An sRGB picture, repeated, trilinear.
    pub fn image(file: impl Into<PathBuf>) -> Self {
        Self::Image {
            file: file.into().into(),
            color_space: ColorSpace::Srgb,
            wrap: Wrap::Repeat,
            filter: TextureFilter::Trilinear,
            scale: [1.0; 2],
            offset: [0.0; 2],
        }
    }

    /// A checker of two colours.
    pub fn checker(a: impl Into<ColorDesc>, b: impl Into<ColorDesc>, scale: [f32; 2]) -> Self {
        Self::Checker { a: a.into(), b: b.into(), scale }
    }
}

/// A refractive index.
#[derive(Clone, Debug, PartialEq)]
pub enum Ior {
    /// The index itself, relative to vacuum.
    Value(f32),
    /// A named substance: "water", "glass", "N-BK7", "diamond", …
    Glass(Sourced<String>),
}

impl From<f32> for Ior {
    fn from(ior: f32) -> Self {
        Self::Value(ior)
    }
}

impl From<&str> for Ior {
    fn from(name: &str) -> Self {
        Self::Glass(name.into())
    }
}

/// What a metal is made of.
#[derive(Clone, Debug, PartialEq)]
pub enum Metal {
    /// A named metal with measured data: "gold", "copper", …
    Named(Sourced<String>),
    /// The complex index n + ik per RGB channel.
    Index {
        /// Real part, > 0.
        n: Triple,
        /// Imaginary part, ≥ 0.
        k: Triple,
    },
}

impl From<&str> for Metal {
    fn from(name: &str) -> Self {
        Self::Named(name.into())
    }
}

/// How a surface scatters.
#[derive(Clone, Debug, PartialEq)]
pub enum MaterialKind {
    /// Lambertian reflection.
    Diffuse {
        /// Albedo, 0..=1.
        color: ColorDesc,
    },
    /// Diffuse plus the modified Phong lobe of Lafortune & Willems 1994.
    Phong {
        /// Diffuse albedo; its sum with `specular` is at most 1 in each channel.
        diffuse: ColorDesc,
        /// Specular albedo at normal incidence.
        specular: ColorDesc,
        /// Exponent of the cosine lobe, ≥ 0.
        exponent: FloatDesc,
    },
    /// Perfect reflection.
    Mirror {
        /// Reflectance, 0..=1.
        color: ColorDesc,
    },
    /// Smooth glass or liquid: reflects and refracts.
    Dielectric {
        /// Refractive index.
        ior: Ior,
        /// Factor on what is transmitted at each crossing, 0..=1.
        color: ColorDesc,
        /// Where solids overlap the highest counts; among equals the last entered.
        priority: i32,
    },
    /// Metal.
    Conductor {
        /// Its complex index.
        metal: Metal,
        /// GGX α is the square of this; 0 is smooth.
        roughness: FloatDesc,
    },
    /// A diffuse base under a dielectric coat.
    Plastic {
        /// Albedo of the base.
        color: ColorDesc,
        /// Index of the coat.
        ior: Ior,
        /// GGX α of the coat is the square of this; 0 is smooth.
        roughness: FloatDesc,
    },
}

/// A material: `[materials.NAME]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// How it scatters.
    pub kind: MaterialKind,
    /// A texture of tangent-space normals (OpenGL convention, +y up), by name.
    pub normal_map: Option<Sourced<String>>,
    /// Factor on the map's slopes; 1 as stored.
    pub normal_strength: f32,
    /// Whether the back side scatters as the front does; else the back is black. Dielectrics ignore it.
    pub two_sided: bool,
}

impl From<MaterialKind> for Material {
    fn from(kind: MaterialKind) -> Self {
        Self { kind, normal_map: None, normal_strength: 1.0, two_sided: true }
    }
}

impl Material {
    /// Lambertian.
    pub fn diffuse(color: impl Into<ColorDesc>) -> Self {
        MaterialKind::Diffuse { color: color.into() }.into()
    }

    /// Diffuse plus a modified Phong lobe.
    pub fn phong(diffuse: impl Into<ColorDesc>, specular: impl Into<ColorDesc>, exponent: f32) -> Self {
        let (diffuse, specular) = (diffuse.into(), specular.into());
        MaterialKind::Phong { diffuse, specular, exponent: exponent.into() }.into()
    }

    /// A perfect mirror.
    pub fn mirror(color: impl Into<ColorDesc>) -> Self {
        MaterialKind::Mirror { color: color.into() }.into()
    }

    /// Clear glass of an index or name.
    pub fn dielectric(ior: impl Into<Ior>) -> Self {
        MaterialKind::Dielectric { ior: ior.into(), color: 1.0.into(), priority: 0 }.into()
    }

    /// A metal by name.
    pub fn conductor(metal: impl Into<Metal>, roughness: f32) -> Self {
        MaterialKind::Conductor { metal: metal.into(), roughness: roughness.into() }.into()
    }

    /// A diffuse base under a coat of index 1.5.
    pub fn plastic(color: impl Into<ColorDesc>, roughness: f32) -> Self {
        MaterialKind::Plastic { color: color.into(), ior: 1.5.into(), roughness: roughness.into() }.into()
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

/// The shading normals of a mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Normals {
    /// As given with the mesh; flat where none are.
    #[default]
    Given,
    /// The faces' own.
    Flat,
    /// Averaged over the faces at a vertex.
    Smooth {
        /// Edges that bend more than this stay sharp; 180 smooths all.
        crease_degrees: f32,
    },
}

/// Which parts of the teapot to make.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TeapotPart {
    /// The body (rim, upper and lower body).
    Body,
    /// The handle.
    Handle,
    /// The spout.
    Spout,
    /// The lid and its knob.
    Lid,
    /// The bottom.
    Bottom,
}

/// Every part of the teapot, in order.
pub const TEAPOT_PARTS: [TeapotPart; 5] =
    [TeapotPart::Body, TeapotPart::Handle, TeapotPart::Spout, TeapotPart::Lid, TeapotPart::Bottom];

/// A surface. Normals point as stated; [`Object::flip_normals`] turns them.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A sphere, normals outward.
    Sphere {
        /// Its centre.
        center: Triple,
        /// Its radius, > 0.
        radius: f32,
    },
    /// A flat disk.
    Disk {
        /// Its centre.
        center: Triple,
        /// Its normal, of any length but zero.
        normal: Triple,
        /// Its radius, > 0.
        radius: f32,
    },
    /// A parallelogram, normal along `edge_u` × `edge_v`.
    Quad {
        /// A corner; uv (0, 0).
        origin: Triple,
        /// From the corner to uv (1, 0).
        edge_u: Triple,
        /// From the corner to uv (0, 1).
        edge_v: Triple,
    },
    /// Four corners, need not be planar: triangles (0, 1, 2) and (0, 2, 3), normals by the right-hand rule,
    /// uv (0,0), (1,0), (1,1), (0,1).
    Corners {
        /// In order around the border.
        corners: [Triple; 4],
    },
    /// A mesh file.
    Mesh {
        /// OBJ or PLY; see [`SceneDesc::resolve`].
        file: Sourced<PathBuf>,
        /// Shading normals.
        normals: Normals,
    },
    /// A mesh in place.
    Triangles {
        /// Vertices.
        positions: Vec<Triple>,
        /// Three vertices a triangle, counter-clockwise seen from the side of the normal.
        indices: Vec<[u32; 3]>,
        /// A shading normal a vertex; empty for none.
        vertex_normals: Vec<Triple>,
        /// Texture coordinates of each vertex; empty for none.
        uvs: Vec<[f32; 2]>,
        /// Which shading normals to use.
        normals: Normals,
    },
    /// An axis-aligned box, normals outward.
    Box {
        /// Its least corner.
        min: Triple,
        /// Its greatest corner.
        max: Triple,
    },
    /// Newell's teapot: the bottom's centre at the origin, +y up, the spout toward +x.
    Teapot {
        /// Each of the 32 patches (with their mirror images) is cut into `level`² quadrilaterals; 1..=256.
        level: u32,
        /// The parts to make; [`TEAPOT_PARTS`] is all.
        parts: Vec<TeapotPart>,
    },
    /// A profile turned about the y axis; normals to the right of the way along the profile (up the outside:
    /// outward).
    Lathe {
        /// Points (r, y), r ≥ 0.
        profile: Vec<[f32; 2]>,
        /// Facets around, ≥ 3.
        segments: u32,
        /// Smooth or faceted shading normals.
        smooth: bool,
        /// Whether the last point joins the first.
        closed: bool,
    },
    /// An open tube.
    Cylinder {
        /// Centre of its lower rim.
        base: Triple,
        /// Direction from the base, of any length but zero.
        axis: Triple,
        /// Its radius, > 0.
        radius: f32,
        /// Its length, > 0.
        height: f32,
        /// Whether normals point to the axis instead of away.
        inward: bool,
        /// Facets around, ≥ 3.
        segments: u32,
    },
    /// A ring, normals outward.
    Torus {
        /// Its centre.
        center: Triple,
        /// Its axis of rotation, of any length but zero.
        axis: Triple,
        /// Radius of the ring's middle line, > 0.
        major_radius: f32,
        /// Radius of the tube, > 0.
        minor_radius: f32,
        /// Facets around the ring, ≥ 3.
        segments: u32,
        /// Facets around the tube, ≥ 3.
        tube_segments: u32,
    },
    /// A subdivided icosahedron with vertices on a sphere.
    Icosphere {
        /// Its centre.
        center: Triple,
        /// Its radius, > 0.
        radius: f32,
        /// Subdivisions: 20·4^level triangles; 0..=9.
        level: u32,
        /// The sphere's shading normals or the facets' own.
        smooth: bool,
    },
}

/// How much an area light emits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EmissionAmount {
    /// Radiance in W/(sr·m²) per channel, the same in every direction.
    Radiance(Triple),
    /// Total flux of the object as placed; see [`channel_power`].
    Power {
        /// In W: the mean over the channels.
        watts: f32,
        /// Proportions of the channels.
        color: Triple,
    },
}

/// The light that a surface gives off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Emission {
    /// How much.
    pub amount: EmissionAmount,
    /// Whether both sides emit (and share the power); else the side of the normal.
    pub two_sided: bool,
}

impl Emission {
    /// Radiance from the side of the normal.
    pub fn radiance(rgb: Triple) -> Self {
        Self { amount: EmissionAmount::Radiance(rgb), two_sided: false }
    }

    /// White light of a total flux in W from the side of the normal.
    pub fn power(watts: f32) -> Self {
        Self { amount: EmissionAmount::Power { watts, color: [1.0; 3] }, two_sided: false }
    }
}

/// The flux of each channel in W: `watts` times `color` over the mean of `color`; 0 for a black colour.
pub fn channel_power(watts: f32, color: Triple) -> Triple {
    let mean = (color[0] as f64 + color[1] as f64 + color[2] as f64) / 3.0;
    if mean > 0.0 { color.map(|c| (watts as f64 * c as f64 / mean) as f32) } else { [0.0; 3] }
}

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
    /// Turns the normals to the other side (and with them emission).
    pub flip_normals: bool,
    /// The light it gives off.
    pub emission: Option<Sourced<Emission>>,
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
            flip_normals: false,
            emission: None,
        }
    }
}

/// How much a point or spot light emits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PointAmount {
    /// Radiant intensity in W/sr per channel (of a spot: in the inner cone).
    Intensity(Triple),
    /// Total flux; see [`channel_power`].
    Power {
        /// In W: the mean over the channels.
        watts: f32,
        /// Proportions of the channels.
        color: Triple,
    },
}

/// What kind of light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightKind {
    /// The same in every direction from a point.
    Point {
        /// The point.
        position: Triple,
        /// How much.
        amount: PointAmount,
    },
    /// A cone from a point.
    Spot {
        /// The apex.
        position: Triple,
        /// The cone's axis, of any length but zero.
        direction: Triple,
        /// Half angle of the cone in degrees, in (0, 180].
        cone_angle: f32,
        /// Within this many degrees of the cone's border the light falls smoothly to 0; 0..=`cone_angle`.
        falloff_angle: f32,
        /// How much.
        amount: PointAmount,
    },
    /// Parallel light from infinity.
    Directional {
        /// The way the light travels, of any length but zero.
        direction: Triple,
        /// On a plane at right angles, W/m² per channel.
        irradiance: Triple,
    },
    /// The same radiance from every direction at infinity.
    Environment {
        /// W/(sr·m²) per channel.
        radiance: Triple,
    },
}

/// A light that is no surface: `[[lights]]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    /// A name for messages and overrides; unique among lights.
    pub name: Option<String>,
    /// What it is.
    pub kind: LightKind,
}

impl From<LightKind> for Light {
    fn from(kind: LightKind) -> Self {
        Self { name: None, kind }
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
