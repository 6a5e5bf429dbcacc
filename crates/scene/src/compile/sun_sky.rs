//! Sun and sky of a clear day: Hošek & Wilkie 2012, "An analytic model for full spectral sky-dome radiance", and their sun of 2013.

use color::Lanes;
use hw_skymodel::rgb::{Channel, SkyParams, SkyState};
use math::{PI, Transform, Vec3};
use scenefile::desc::{SkyMapping, SunSky, WHITE_EFFICACY};

use super::{lights, shapes};
use crate::Light;
use crate::light::{SkyLight, SunLight, sun_irradiance};
use crate::sphere_map;

/// Pixels of the sky's picture, whose lower half is black: 0.35° each.
const SIZE: [usize; 2] = [1024, 512];

/// Lumens in a watt at 555 nm: the model's colours are per watt of luminous radiance.
const PEAK_EFFICACY: f32 = 683.0;

/// What the sun and the sky are, in this order. None of them where the sun is below the horizon; neither where its scale is 0.
pub(super) fn build(desc: &SunSky) -> Result<Vec<Light>, &'static str> {
    let turned = shapes::transform(&desc.transform).and_then(|t| lights::turn(&t));
    let turned = turned.ok_or("its transform is singular")?;
    let to_sun = Vec3::from(desc.sun_direction).try_normalize().ok_or("its direction has no length")?;
    let elevation = to_sun.y.clamp(-1.0, 1.0).asin();
    if elevation < 0.0 {
        return Ok(Vec::new());
    }
    let mut built = Vec::new();
    if desc.sun_scale > 0.0 {
        let [r, g, b] = sun_irradiance(elevation, desc.turbidity).map(|x| x * desc.sun_scale);
        let sun = SunLight::new(turned.vector(to_sun), desc.sun_angle.to_radians(), Lanes::rgb(r, g, b));
        built.push(Light::Sun(sun.ok_or("its sun has an angle or a scale that is out of range")?));
    }
    if desc.sky_scale > 0.0 {
        let sky = sky(desc, to_sun, elevation, turned).ok_or("its sky has a scale that is out of range")?;
        built.push(Light::Sky(Box::new(sky)));
    }
    Ok(built)
}

fn sky(desc: &SunSky, to_sun: Vec3, elevation: f32, turned: Transform) -> Option<SkyLight> {
    let state = SkyState::new(&SkyParams {
        elevation: elevation.min(0.5 * PI),
        turbidity: desc.turbidity.clamp(1.0, 10.0),
        albedo: desc.ground_albedo.map(|a| a.clamp(0.0, 1.0)),
    })
    .ok()?;
    let scale = desc.sky_scale * PEAK_EFFICACY / WHITE_EFFICACY;
    let [width, height] = SIZE;
    let rows = par::map(height, |j| {
        (0..width)
            .map(|i| {
                let uv = [(i as f64 + 0.5) / width as f64, (j as f64 + 0.5) / height as f64];
                let w = sphere_map::direction(SkyMapping::LatLong, uv);
                if w.y <= 0.0 {
                    return [0.0; 3];
                }
                let (theta, gamma) = (w.y.min(1.0).acos(), w.cross(to_sun).length().atan2(w.dot(to_sun)));
                [Channel::R, Channel::G, Channel::B].map(|c| scale * state.radiance(theta, gamma, c).max(0.0))
            })
            .collect::<Vec<_>>()
    });
    SkyLight::new(SkyMapping::LatLong, SIZE, rows.into_iter().flatten().collect(), turned)
}
