use color::Lanes;
use math::{Affine3A, Mat3, PI, Transform, Vec3};
use scenefile::desc::{
    Emission, EmissionAmount, ImageSource, LightKind, PointAmount, SceneDesc, SkyMapping, TransformStep,
    channel_power,
};

use super::shapes::{self, Solid};
use crate::Light;
use crate::light::{
    DirectionalLight, DiskLight, EnvironmentLight, IntensityShape, PointLight, Sides, SkyLight, SphereLight,
    SpotLight, TriangleLight,
};
use crate::texture::{Encoding, Picture, Wanted};

fn lanes([r, g, b]: [f32; 3]) -> Lanes {
    Lanes::rgb(r, g, b)
}

/// The light that a solid with a texture is; `factor`: of (point, triangle), averaged over about a width. `Ok(None)`: it is black.
pub(super) fn textured_light(
    solid: &Solid,
    emission: &Emission,
    factor: impl Fn(Vec3, u32, f32) -> Lanes,
) -> Result<Option<Light>, &'static str> {
    let light = area_light(solid, emission).ok_or("this object shines but has no area")?;
    let light = light.textured(factor);
    match (light, emission.amount) {
        (light, EmissionAmount::Radiance(_)) => Ok(light),
        (None, EmissionAmount::Power { .. }) => Err("this object has a power, but a black texture"),
        (Some(mut light), EmissionAmount::Power { watts, .. }) => {
            light.scale_radiance(watts / light.power().mean());
            if light.power().is_finite() { Ok(Some(light)) } else { Err("this object's power is too great") }
        }
    }
}

/// The light that a solid is. `None`: it has no area.
pub(super) fn area_light(solid: &Solid, emission: &Emission) -> Option<Light> {
    let sides = if emission.two_sided { Sides::Both } else { Sides::Front };
    let radiance = match emission.amount {
        EmissionAmount::Radiance(rgb) => lanes(rgb),
        // A Lambertian emitter of area A sends out π·A·L from each side.
        EmissionAmount::Power { watts, color } => {
            let area = solid.area() * if emission.two_sided { 2.0 } else { 1.0 };
            lanes(channel_power(watts, color)) * (1.0 / (f64::from(PI) * area)) as f32
        }
    };
    if !radiance.is_finite() {
        return None;
    }
    match solid {
        Solid::Sphere { center, radius, flipped } => {
            let sides = if *flipped && sides == Sides::Front { Sides::Back } else { sides };
            SphereLight::new(*center, *radius, radiance, sides).map(Light::Sphere)
        }
        Solid::Disk { center, normal, radius } => {
            DiskLight::new(*center, *normal, *radius, radiance, sides).map(Light::Disk)
        }
        Solid::Mesh(mesh) => {
            let triangles = (0..mesh.indices.len()).map(|i| mesh.corners(i)).collect();
            TriangleLight::new(triangles, radiance, sides).map(Light::Triangles)
        }
    }
}

/// A light that is no surface, and where it is.
pub(super) fn light(kind: &LightKind) -> Option<(Light, Option<Vec3>)> {
    match *kind {
        LightKind::Point { position, amount } => {
            let intensity = match amount {
                PointAmount::Intensity(rgb) => lanes(rgb),
                PointAmount::Power { watts, color } => lanes(channel_power(watts, color)) / (4.0 * PI),
            };
            let p = Vec3::from(position);
            Some((Light::Point(PointLight::new(p, intensity)?), Some(p)))
        }
        LightKind::Spot { position, direction, cone_angle, falloff_angle, amount } => {
            let (p, axis) = (Vec3::from(position), Vec3::from(direction));
            let radians = |degrees: f32| degrees.to_radians().min(PI);
            let (inner, outer) = (radians(cone_angle - falloff_angle), radians(cone_angle));
            let spot = |intensity| SpotLight::new(p, axis, intensity, inner, outer);
            let light = match amount {
                PointAmount::Intensity(rgb) => spot(lanes(rgb))?,
                PointAmount::Power { watts, color } => {
                    let unit = spot(Lanes::rgb(1.0, 1.0, 1.0))?.power().mean();
                    spot(lanes(channel_power(watts, color)) / unit)?
                }
            };
            Some((Light::Spot(light), Some(p)))
        }
        LightKind::Directional { direction, irradiance } => {
            Some((Light::Directional(DirectionalLight::new(Vec3::from(direction), lanes(irradiance))?), None))
        }
        LightKind::Environment { radiance } => {
            Some((Light::Environment(EnvironmentLight::new(lanes(radiance))?), None))
        }
        LightKind::Sky { .. }
        | LightKind::SunSky(_)
        | LightKind::Profile { .. }
        | LightKind::Goniometric { .. }
        | LightKind::Projector { .. } => None,
    }
}

/// The light of a picture of the sky.
pub(super) fn sky(
    desc: &SceneDesc,
    source: &ImageSource,
    mapping: SkyMapping,
    scale: [f32; 3],
    steps: &[TransformStep],
) -> Result<Light, String> {
    let turned = shapes::transform(steps).and_then(|t| turn(&t)).ok_or("its transform is singular")?;
    let (size, pixels) = picture_of_sphere(desc, source, mapping)?;
    let pixels = pixels.iter().map(|p| [0, 1, 2].map(|c| p[c] * scale[c])).collect();
    SkyLight::new(mapping, size, pixels, turned)
        .map(|sky| Light::Sky(Box::new(sky)))
        .ok_or_else(|| "it is black, or holds values that are negative or not finite".into())
}

/// A picture's size and its pixels, linear RGB, rows from the top.
pub(super) type Pixels = ([usize; 2], Vec<[f32; 3]>);

/// A picture that lights shine by.
pub(super) fn picture(desc: &SceneDesc, source: &ImageSource) -> Result<Pixels, String> {
    let image = match source {
        ImageSource::File(file) => Picture::from_path(&desc.resolve(file), Encoding::Srgb, Wanted::Color),
        ImageSource::Embedded(image) => {
            Picture::from_bytes(&image.bytes, &image.name, Encoding::Srgb, Wanted::Color)
        }
    };
    let image = image.map_err(|e| e.to_string())?;
    let [width, height] = image.size();
    Ok(([width, height], (0..width * height).map(|i| image.pixel(i)).collect()))
}

/// The same of the whole sphere.
pub(super) fn picture_of_sphere(
    desc: &SceneDesc,
    source: &ImageSource,
    mapping: SkyMapping,
) -> Result<Pixels, String> {
    let picture = picture(desc, source)?;
    match (mapping, picture.0) {
        (SkyMapping::EqualArea, [width, height]) if width != height => {
            Err(format!("a picture of equal areas is square, this one has {width} × {height} pixels"))
        }
        _ => Ok(picture),
    }
}

/// The part of a transform that turns (and mirrors): what it makes of the axes, made a right-angled frame of unit length.
pub(super) fn turn(t: &Transform) -> Option<Transform> {
    let y = t.vector(Vec3::Y).try_normalize()?;
    let z = t.vector(Vec3::Z);
    let z = (z - y * y.dot(z)).try_normalize()?;
    let x = y.cross(z);
    let x = if x.dot(t.vector(Vec3::X)) < 0.0 { -x } else { x };
    Transform::new(Affine3A::from_mat3(Mat3::from_cols(x, y, z)))
}

/// What to call a light that has no name.
pub(super) fn kind_name(light: &Light) -> &'static str {
    match light {
        Light::Point(_) => "point light",
        Light::Spot(_) => "spot light",
        Light::Shaped(light) => match light.shape() {
            IntensityShape::Profile(_) => "profile light",
            IntensityShape::Goniometric(_) => "goniometric light",
            IntensityShape::Slide(_) => "projector",
        },
        Light::Directional(_) => "directional light",
        Light::Environment(_) | Light::Sky(_) => "environment",
        Light::Sun(_) => "sun",
        Light::Sphere(_) | Light::Disk(_) | Light::Triangles(_) => "lamp",
    }
}
