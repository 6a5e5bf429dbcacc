//! Lights to test, and a view of their geometry apart from the crate.

// Cases are fixed: one that fails to build is a failing test.
#![allow(clippy::unwrap_used)]

use color::Lanes;
use math::{Affine3A, Bounds3, DVec3, Frame, Transform, Vec3};
use nephroid_scene::light::{
    DirectionalLight, DiskLight, EnvironmentLight, GoniometricShape, IntensityShape, LeSample, Light,
    LightHit, PointLight, ProfileShape, ShapedLight, Sides, SkyLight, SlideShape, SphereLight, SpotLight,
    SunLight, TriangleLight,
};
use nephroid_scene::target::{Target, Targets};
use sampling::{Domain, Sampler};
use scenefile::desc::SkyMapping;
use testkit::significance;

/// Level of one of the file's tests, of which there are fewer than 200.
pub fn level() -> f64 {
    significance(0.01, 200)
}

/// What a ray finds of a light, computed apart from the crate.
pub enum Geometry {
    Nothing,
    Sphere(DVec3, f64),
    Disk(DVec3, DVec3, f64),
    Triangles(Vec<[Vec3; 3]>),
}

pub struct Case {
    pub name: &'static str,
    pub light: Light,
    pub geometry: Geometry,
}

impl Case {
    /// Geometric normal of the front at the start of a path. Two-sided lights are disks here.
    pub fn front_normal(&self, l: &LeSample) -> Vec3 {
        match self.geometry {
            Geometry::Disk(_, n, _) => n.as_vec3(),
            _ => l.n,
        }
    }

    /// What its pattern makes of the radiance at the start of a path.
    pub fn factor(&self, l: &LeSample) -> f64 {
        if self.light.is_textured() { f64::from(stain(l.p)) } else { 1.0 }
    }
}

impl Geometry {
    pub fn hit(&self, p: Vec3, w: Vec3) -> Option<LightHit> {
        let (o, d) = (p.as_dvec3(), w.as_dvec3());
        let hit = |t: f64, ng: DVec3, prim: usize| LightHit {
            p: (o + d * t).as_vec3(),
            ng: ng.as_vec3(),
            prim: prim as u32,
        };
        match self {
            Self::Nothing => None,
            Self::Sphere(c, r) => {
                let (b, gap) = (d.dot(o - c), (o - c).length_squared() - r * r);
                let root = (b * b - d.length_squared() * gap).max(-1.0);
                let t = [-b - root.sqrt(), -b + root.sqrt()].map(|t| t / d.length_squared());
                let t = t.into_iter().find(|t| *t > 1e-6)?;
                Some(hit(t, (o + d * t - c).normalize(), 0))
            }
            Self::Disk(c, n, r) => {
                let t = (c - o).dot(*n) / d.dot(*n);
                (t > 0.0 && (o + d * t).distance(*c) < *r).then(|| hit(t, *n, 0))
            }
            Self::Triangles(triangles) => triangles.iter().enumerate().find_map(|(i, t)| {
                let v = t.map(|v| v.as_dvec3());
                let n = (v[1] - v[0]).cross(v[2] - v[0]);
                let t = (v[0] - o).dot(n) / d.dot(n);
                let q = o + d * t;
                let side = |a: DVec3, b: DVec3| (b - a).cross(q - a).dot(n) > 0.0;
                let inside = t > 0.0 && side(v[0], v[1]) && side(v[1], v[2]) && side(v[2], v[0]);
                inside.then(|| hit(t, n.normalize(), i))
            }),
        }
    }
}

pub fn scene_bounds() -> Bounds3 {
    Bounds3 { min: Vec3::splat(-2.0), max: Vec3::splat(2.0) }
}

pub fn lanes(x: f32) -> Lanes {
    Lanes::rgb(x, 0.5 * x, 2.0 * x)
}

pub fn sphere(center: Vec3, radius: f32, sides: Sides) -> Case {
    let light = Light::Sphere(SphereLight::new(center, radius, lanes(2.0), sides).unwrap());
    Case { name: "sphere", light, geometry: Geometry::Sphere(center.as_dvec3(), f64::from(radius)) }
}

pub fn disk(sides: Sides) -> Case {
    let (c, n, r) = (Vec3::new(-0.2, 1.5, 0.1), Vec3::new(0.36, -0.8, 0.48), 0.5);
    let light = Light::Disk(DiskLight::new(c, n, r, lanes(1.5), sides).unwrap());
    Case { name: "disk", light, geometry: Geometry::Disk(c.as_dvec3(), n.as_dvec3(), f64::from(r)) }
}

pub fn mesh() -> Case {
    // Three unequal triangles whose shadows on any receiver below do not overlap.
    let v = |x, y, z| Vec3::new(x, y, z);
    let triangles = vec![
        [v(-0.8, 1.5, -0.5), v(0.4, 1.5, -0.5), v(-0.8, 1.4, 0.9)],
        [v(0.5, 1.6, -0.5), v(1.1, 1.7, -0.5), v(0.8, 1.6, 0.2)],
        [v(0.3, 1.5, 0.6), v(0.6, 1.5, 0.6), v(0.3, 1.5, 0.9)],
    ];
    let light = TriangleLight::new(triangles.clone(), lanes(3.0), Sides::Front).unwrap();
    Case { name: "mesh", light: Light::Triangles(light), geometry: Geometry::Triangles(triangles) }
}

pub fn quad() -> Case {
    let (o, u, w) = (Vec3::new(-0.4, 1.7, -0.6), Vec3::new(0.9, 0.1, 0.0), Vec3::new(0.2, 0.0, 0.8));
    let light = TriangleLight::quad(o, u, w, lanes(1.0), Sides::Front).unwrap();
    let triangles = vec![[o, o + u, o + u + w], [o, o + u + w, o + w]];
    Case { name: "quad", light: Light::Triangles(light), geometry: Geometry::Triangles(triangles) }
}

pub fn spot(inner: f32, outer: f32) -> Case {
    let axis = Vec3::new(0.5, -1.5, 0.2);
    let light = SpotLight::new(Vec3::new(0.1, 1.7, 0.2), axis, lanes(4.0), inner, outer).unwrap();
    Case { name: "spot", light: Light::Spot(light), geometry: Geometry::Nothing }
}

/// Six by four pixels, one of them bright and some black, turned askew.
pub fn sky() -> SkyLight {
    sky_of(SkyMapping::LatLong, [6, 4])
}

/// A few pixels, one of them bright and some black, turned askew.
pub fn sky_of(mapping: SkyMapping, size: [usize; 2]) -> SkyLight {
    let pixel = |i: usize| match i {
        9 => [3.0, 2.5, 2.0],
        3 | 4 | 10 | 16 | 22 => [0.0; 3],
        _ => [0.3 + 0.1 * (i % 5) as f32, 0.5, 0.2 * (i % 3) as f32],
    };
    let turn = Affine3A::from_axis_angle(Vec3::new(0.6, 0.0, 0.8), 0.7);
    let pixels = (0..size[0] * size[1]).map(pixel).collect();
    SkyLight::new(mapping, size, pixels, Transform::new(turn).unwrap()).unwrap()
}

/// A dark surface with a bright stain.
pub fn stain(p: Vec3) -> f32 {
    let d2 = p.distance_squared(Vec3::new(-0.1, 1.6, 0.0));
    0.1 + 20.0 * (-30.0 * d2).exp()
}

/// The same with [`stain`] over it.
pub fn patterned(case: Case, name: &'static str) -> Case {
    let light = case.light.textured(|p, _, _| Lanes::splat(stain(p))).unwrap();
    Case { name, light, geometry: case.geometry }
}

/// What a light at `position` turns its axes to.
fn askew() -> Affine3A {
    Affine3A::from_axis_angle(Vec3::new(0.6, 0.0, 0.8), 0.7)
}

fn shaped(name: &'static str, shape: IntensityShape) -> Case {
    let light = ShapedLight::new(Vec3::new(0.1, 1.5, 0.0), shape).unwrap();
    Case { name, light: Light::Shaped(Box::new(light)), geometry: Geometry::Nothing }
}

fn frame() -> Frame {
    let [x, y, z] = [Vec3::X, Vec3::Y, Vec3::Z].map(|v| askew().transform_vector3(v));
    Frame { x, y, z }
}

/// A luminaire by a file of the type (1: C, 2: B) and with these angles and intensities.
fn profile(name: &'static str, kind: u32, frame: Frame, angles: &str, candela: &str) -> Case {
    let text = format!("IESNA91\nTILT=NONE\n1 -1 1 4 3 {kind} 1 0 0 0 1 1 1\n{angles}\n{candela}");
    let web = photometry::read(text.as_bytes()).unwrap().web;
    shaped(name, IntensityShape::Profile(ProfileShape::new(web, frame, Lanes::rgb(0.3, 0.2, 0.1))))
}

/// Lights with an intensity by direction.
pub fn shaped_lights() -> Vec<Case> {
    let pixel = |i: usize| match i {
        9 => [3.0, 2.5, 2.0],
        // Alone: where all neighbours are black, draws are, and they count as none.
        5 => [0.0; 3],
        _ => [0.3 + 0.1 * (i % 5) as f32, 0.5, 0.2 * (i % 3) as f32],
    };
    let goniometric = |mapping, size: [usize; 2]| {
        let pixels = (0..size[0] * size[1]).map(pixel);
        let turned = Transform::new(askew()).unwrap();
        let shape = GoniometricShape::new(mapping, size, pixels, [1.0, 2.0, 0.5], turned).unwrap();
        IntensityShape::Goniometric(shape)
    };
    let down = Frame { x: Vec3::Z, y: Vec3::new(0.6, 0.8, 0.0), z: Vec3::new(0.8, -0.6, 0.0) };
    let fallen = Frame { x: -Vec3::Y, y: Vec3::X, z: Vec3::Z };
    // Without a bright spot, for such a light is best aimed as it shines.
    let even = |i: usize| if i == 5 { [0.0; 3] } else { [0.8 + 0.1 * (i % 3) as f32, 1.0, 0.3] };
    let slide = SlideShape::new([4, 3], (0..12).map(even).collect(), 1.3, down).unwrap();
    vec![
        profile("street lamp", 1, frame(), "0 40 80 120\n0 60 180", "10 30 60 0\n10 60 20 0\n10 5 5 0"),
        profile("flood light", 2, fallen, "-60 0 20 90\n-90 0 70", "0 3 9 0\n0 30 60 0\n0 0 8 0"),
        shaped("goniometric", goniometric(SkyMapping::LatLong, [6, 4])),
        shaped("square goniometric", goniometric(SkyMapping::EqualArea, [5, 5])),
        shaped("projector", IntensityShape::Slide(slide)),
    ]
}

/// One of each, above the targets.
pub fn cases() -> Vec<Case> {
    let nothing = |name, light| Case { name, light, geometry: Geometry::Nothing };
    let mut cases = vec![
        nothing("point", Light::Point(PointLight::new(Vec3::new(0.3, 1.4, -0.2), lanes(2.0)).unwrap())),
        spot(0.35, 0.8),
        nothing(
            "directional",
            Light::Directional(DirectionalLight::new(Vec3::new(0.3, -1.0, 0.2), lanes(3.0)).unwrap()),
        ),
        nothing("environment", Light::Environment(EnvironmentLight::new(lanes(0.7)).unwrap())),
        nothing("sky", Light::Sky(Box::new(sky()))),
        nothing("square sky", Light::Sky(Box::new(sky_of(SkyMapping::EqualArea, [5, 5])))),
        nothing("sun", Light::Sun(SunLight::new(Vec3::new(0.3, 1.0, -0.2), 0.4, lanes(2.0)).unwrap())),
        sphere(Vec3::new(0.0, 1.4, 0.0), 0.4, Sides::Front),
        disk(Sides::Front),
        disk(Sides::Both),
        quad(),
        mesh(),
        patterned(sphere(Vec3::new(0.0, 1.4, 0.0), 0.4, Sides::Front), "patterned sphere"),
        patterned(disk(Sides::Both), "patterned disk"),
        patterned(quad(), "patterned quad"),
        patterned(mesh(), "patterned mesh"),
    ];
    cases.extend(shaped_lights());
    cases.iter_mut().for_each(|c| c.light.preprocess(scene_bounds()));
    cases
}

/// Two overlapping spheres and a flat box.
pub fn targets() -> Targets {
    let ball = |c: Vec3, r: f32, weight| Target {
        bounds: Bounds3 { min: c - Vec3::splat(r), max: c + Vec3::splat(r) },
        center: c,
        radius: r,
        weight,
    };
    let slab = Bounds3 { min: Vec3::new(-1.9, -1.9, -1.5), max: Vec3::new(-0.9, -1.9, 0.5) };
    Targets::new(vec![
        ball(Vec3::new(0.6, -0.7, 0.3), 1.1, 1.0),
        ball(Vec3::new(-0.4, -1.0, 0.9), 0.8, 0.3),
        Target::from_bounds(slab, 0.05),
    ])
}

pub fn samples(key: u64, n: u64) -> impl Iterator<Item = Sampler> {
    (0..n).map(move |i| Sampler::new(11, key, Domain::Other, i))
}

pub fn flux(s: &LeSample) -> f64 {
    f64::from(s.radiance.0.x * s.cos) / (f64::from(s.pdf_a) * f64::from(s.pdf_w))
}

#[track_caller]
pub fn assert_close(a: f64, b: f64, relative: f64) {
    assert!((a - b).abs() <= relative * b.abs(), "{a} {b}");
}
