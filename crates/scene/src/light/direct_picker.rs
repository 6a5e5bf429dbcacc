//! Which lights are sampled for direct light at a receiver.

use super::group::is_local;
use super::picker::LightPicker;
use super::tree::LightTree;
use super::{Light, Receiver};

/// Lights at infinity up to which each is sampled everywhere. They light all that they see alike, so none can be left out: one
/// ray more costs less than the noise of a choice between sun and sky.
const EACH: usize = 3;

/// Chooses lights for direct light at a receiver: one of those at finite places, by what they may send there, and each of those
/// at infinity; of many at infinity, one by power. How often each is sampled in the mean is known: that is what weights ask for.
#[derive(Clone, Debug)]
pub struct DirectPicker {
    near: Near,
    far: Far,
    /// By light.
    places: Vec<Place>,
}

/// Lights at finite places.
#[derive(Clone, Debug)]
enum Near {
    None,
    /// Its index.
    One(u32),
    Many(LightTree),
}

/// Lights at infinity, by index.
#[derive(Clone, Debug)]
enum Far {
    Few(Vec<u32>),
    Many(LightPicker),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Place {
    /// It does not shine.
    Dark,
    Near,
    Far,
}

/// A light that is to be sampled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drawn {
    /// Its index.
    pub light: usize,
    /// Expected number of samples of it at the receiver, which its light is to be divided by; 0: there is none.
    pub expected: f32,
    /// A number in [0, 1) for the choice of a part of it.
    pub u: f32,
}

impl Drawn {
    const NONE: Self = Self { light: 0, expected: 0.0, u: 0.0 };
}

impl DirectPicker {
    /// For these lights.
    pub fn new(lights: &[Light]) -> Self {
        let place = |light: &Light| {
            if is_local(light) {
                Place::Near
            } else if light.is_infinite() && light.power().mean() > 0.0 {
                Place::Far
            } else {
                Place::Dark
            }
        };
        let places: Vec<Place> = lights.iter().map(place).collect();
        let at = |wanted: Place| (0u32..).zip(&places).filter(move |(_, p)| **p == wanted).map(|(i, _)| i);
        let mut near = at(Place::Near);
        let near = match (near.next(), near.next()) {
            (None, _) => Near::None,
            (Some(only), None) => Near::One(only),
            _ => Near::Many(LightTree::new(lights)),
        };
        let far: Vec<u32> = at(Place::Far).collect();
        let far = if far.len() <= EACH { Far::Few(far) } else { Far::Many(LightPicker::far(lights)) };
        Self { near, far, places }
    }

    /// Number of lights that are sampled at any receiver.
    #[inline]
    pub fn draws(&self) -> u32 {
        let near = match self.near {
            Near::None => 0,
            Near::One(_) | Near::Many(_) => 1,
        };
        match &self.far {
            Far::Few(lights) => near + lights.len() as u32,
            Far::Many(_) => near + 1,
        }
    }

    /// The `nth` of [`Self::draws`], for `u` in [0, 1).
    #[inline]
    pub fn draw(&self, at: &Receiver, nth: u32, u: f32) -> Drawn {
        match &self.near {
            Near::One(light) if nth == 0 => Drawn { light: *light as usize, expected: 1.0, u },
            // A copy, so that the caller's need not lie in memory.
            Near::Many(tree) if nth == 0 => tree
                .sample(&{ *at }, u)
                .map_or(Drawn::NONE, |(light, expected, u)| Drawn { light, expected, u }),
            Near::One(_) | Near::Many(_) => self.draw_far(nth - 1, u),
            Near::None => self.draw_far(nth, u),
        }
    }

    fn draw_far(&self, nth: u32, u: f32) -> Drawn {
        match &self.far {
            Far::Few(lights) => lights.get(nth as usize).map_or(Drawn::NONE, |&i| Drawn {
                light: i as usize,
                expected: 1.0,
                u,
            }),
            Far::Many(picker) => {
                let (light, expected, u) = picker.sample(u);
                Drawn { light, expected, u }
            }
        }
    }

    /// Expected number of samples of a light at the receiver.
    #[inline]
    pub fn expected(&self, light: usize, at: &Receiver) -> f32 {
        match (self.places.get(light), &self.near, &self.far) {
            (Some(Place::Near), Near::One(_), _) => 1.0,
            (Some(Place::Near), Near::Many(tree), _) => tree.pmf(light, &{ *at }),
            (Some(Place::Far), _, Far::Few(_)) => 1.0,
            (Some(Place::Far), _, Far::Many(picker)) => picker.pmf(light),
            (Some(Place::Near), Near::None, _) | (Some(Place::Dark) | None, ..) => 0.0,
        }
    }
}
