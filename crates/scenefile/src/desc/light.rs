//! Lights: surfaces that emit, and lights that are no surfaces.

use std::path::PathBuf;

use super::{TransformSteps, Triple};
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
    /// Radiance from infinity, as a picture has it. Columns are longitudes, rows are latitudes from +y down; the middle of the
    /// picture lies toward +z, its left quarter toward +x.
    Sky {
        /// The picture; see [`resolve`](super::SceneDesc::resolve).
        file: Sourced<PathBuf>,
        /// Factor on its values, which then are W/(sr·m²).
        scale: Triple,
        /// Turns the sky; what moves or scales it does not count.
        transform: TransformSteps,
    },
}

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
