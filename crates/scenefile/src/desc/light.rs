//! Lights: surfaces that emit, and lights that are no surfaces.

use std::path::PathBuf;

use super::{ImageSource, TransformSteps, Triple};
use crate::source::Sourced;

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
#[derive(Clone, Debug, PartialEq)]
pub struct Emission {
    /// How much.
    pub amount: EmissionAmount,
    /// A texture by name, a factor ≥ 0 on the radiance; of a total flux it is the proportion.
    pub texture: Option<Sourced<String>>,
    /// Whether both sides emit (and share the power); else the side of the normal.
    pub two_sided: bool,
}

impl Emission {
    /// Radiance from the side of the normal.
    pub fn radiance(rgb: Triple) -> Self {
        Self { amount: EmissionAmount::Radiance(rgb), texture: None, two_sided: false }
    }

    /// White light of a total flux in W from the side of the normal.
    pub fn power(watts: f32) -> Self {
        Self { amount: EmissionAmount::Power { watts, color: [1.0; 3] }, texture: None, two_sided: false }
    }
}

/// The flux of each channel in W: `watts` times `color` over the mean of `color`; 0 for a black colour.
pub fn channel_power(watts: f32, color: Triple) -> Triple {
    let mean = (color[0] as f64 + color[1] as f64 + color[2] as f64) / 3.0;
    if mean > 0.0 { color.map(|c| (watts as f64 * c as f64 / mean) as f32) } else { [0.0; 3] }
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
#[derive(Clone, Debug, PartialEq)]
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
    /// Radiance from infinity, as a picture has it.
    Sky {
        /// The picture.
        source: ImageSource,
        /// Which direction each of its points stands for.
        mapping: SkyMapping,
        /// Factor on its values, which then are W/(sr·m²).
        scale: Triple,
        /// Turns the sky; what moves or scales it does not count.
        transform: TransformSteps,
    },
    /// A clear sky with the sun, by a published model.
    SunSky(SunSky),
    /// A point that shines as a measured photometric file tells.
    Profile {
        /// IES LM-63 (.ies) or EULUMDAT (.ldt); see [`resolve`](super::SceneDesc::resolve).
        file: Sourced<PathBuf>,
        /// Places and turns it: at first at the origin, its vertical axis (γ = 0) toward −y, C = 0 toward +x, C = 90 toward +z.
        transform: TransformSteps,
        /// How much.
        amount: ProfileAmount,
    },
    /// A point that shines with an intensity by direction, as a picture has it.
    Goniometric {
        /// The picture; its luminance alone counts.
        source: ImageSource,
        /// Which direction each of its points stands for.
        mapping: SkyMapping,
        /// Intensity in W/sr where the picture is 1.
        intensity: Triple,
        /// Places and turns it: at first at the origin.
        transform: TransformSteps,
    },
    /// A point that throws a picture, as a slide projector does.
    Projector {
        /// The picture.
        source: ImageSource,
        /// Full angle over the picture's smaller side, degrees, in (0, 180).
        fov: f32,
        /// Intensity in W/sr on the axis where the picture is 1; it does not fall toward the border.
        intensity: Triple,
        /// Places and turns it: at first at the origin, it throws along +z, the picture's top at +y and its right at −x.
        transform: TransformSteps,
    },
}

/// Which directions the points of a picture of the whole sphere stand for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SkyMapping {
    /// Columns are longitudes, rows are latitudes from +y down; the middle of the picture lies toward +z, its left quarter toward +x.
    #[default]
    LatLong,
    /// A square of equal areas (Clarberg 2008) as pbrt-v4 has it: the middle is +z, the edges' middles are +x (right), −x, +y (bottom), −y
    /// in the picture's rows from the top, the corners −z.
    EqualArea,
}

/// Sun and clear sky: Hošek & Wilkie 2012 and 2013. Black below the horizon; none where the sun is below it.
#[derive(Clone, Debug, PartialEq)]
pub struct SunSky {
    /// Toward the sun, of any length but zero; +y is up before `transform`.
    pub sun_direction: Triple,
    /// Haze: 1 (clear) to 10.
    pub turbidity: f32,
    /// Albedo of the ground, 0..=1: its share in the sky's light. The ground itself is not there.
    pub ground_albedo: Triple,
    /// Factor on the sun; 0: none.
    pub sun_scale: f32,
    /// Half the angle over the sun's disc, degrees; its irradiance does not depend on it.
    pub sun_angle: f32,
    /// Factor on the sky; 0: none.
    pub sky_scale: f32,
    /// Turns both.
    pub transform: TransformSteps,
}

impl SunSky {
    /// Radiance in W/(sr·m²) where Mitsuba 3's `sunsky` has 1: its tables are the published model's over ∫ȳ dλ = 106.75 nm, ours count
    /// [`WHITE_EFFICACY`] instead of 683 lm in a watt.
    pub const OVER_MITSUBA: f32 = 683.0 * 106.750_26 / WHITE_EFFICACY;
}

impl Default for SunSky {
    /// A clear afternoon.
    fn default() -> Self {
        Self {
            sun_direction: [0.5, 0.7, 0.5],
            turbidity: 3.0,
            ground_albedo: [0.3; 3],
            sun_scale: 1.0,
            sun_angle: 0.2665,
            sky_scale: 1.0,
            transform: Vec::new(),
        }
    }
}

/// How much a light of a measured file emits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ProfileAmount {
    /// As the file says in candela, at [`WHITE_EFFICACY`] lumens a watt of this colour (its luminance is made 1), times `scale`.
    AsFile {
        /// Factor.
        scale: f32,
        /// Proportions of the channels.
        color: Triple,
    },
    /// A total flux; see [`channel_power`].
    Power {
        /// In W: the mean over the channels.
        watts: f32,
        /// Proportions of the channels.
        color: Triple,
    },
}

/// Lumens in a watt of white light: of equal energy over 380–780 nm, as Ward's Radiance counts it. Photometric amounts stand for
/// radiometric ones of this many times less, channel weights being those of Rec. 709 luminance.
pub const WHITE_EFFICACY: f32 = 179.0;

/// A light that is no surface: `[[lights]]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    /// A name for messages and overrides; unique among lights.
    pub name: Option<String>,
    /// The group that it is counted to in layers; `None`: its name.
    pub light_group: Option<String>,
    /// What it is.
    pub kind: LightKind,
}

impl From<LightKind> for Light {
    fn from(kind: LightKind) -> Self {
        Self { name: None, light_group: None, kind }
    }
}
