use std::sync::Arc;

use math::{Affine3A, Bounds3, Frame, Mat4, PI, Quat, Transform, Vec2, Vec3};
use mesh::{MeshError, Place, TriangleMesh, shapes};
use scenefile::desc::{self, Normals, SceneDesc, Shape as ShapeDesc, TeapotPart, TransformStep};
use scenefile::{Diagnostic, Sourced, Span};

use super::displace::Displacer;
use crate::texture::{Encoding, Picture, TextureError, Wanted};
use crate::{Shape, Target};

/// A shape where it stands, before it becomes an object.
#[derive(Clone, Debug)]
pub(super) enum Solid {
    Mesh(TriangleMesh),
    Sphere { center: Vec3, radius: f32, flipped: bool },
    Disk { center: Vec3, normal: Vec3, radius: f32 },
}

/// Facets around a sphere or disk that has to become a mesh because it is no longer round.
const FACETS: u32 = 256;

/// The placed solid of an object, displaced if it has what displaces it.
pub(super) fn build(
    desc: &SceneDesc,
    object: &Sourced<desc::Object>,
    displacer: Option<Displacer<'_>>,
) -> Result<Solid, Diagnostic> {
    let span = object.shape.span.or(object.span);
    let wrong = |e: MeshError| Diagnostic::error("bad-shape", e.to_string()).at(span);
    let transform = transform(&object.transform).ok_or_else(|| singular(span))?;
    let solid = solid(desc, &object.shape).map_err(wrong)?;
    let solid = solid.transformed(&transform);
    let solid = match displacer {
        Some(displacer) => displacer.apply(solid)?,
        None => solid,
    };
    let solid = if object.flip_normals { solid.flipped() } else { solid };
    if let Solid::Mesh(mesh) = &solid {
        mesh.validate().map_err(wrong)?;
    }
    if solid.area() > 0.0 {
        Ok(solid)
    } else {
        Err(Diagnostic::error("no-area", "this shape has no area").at(span))
    }
}

/// The map of the steps, first step first; `None` where it is singular.
pub(super) fn transform(steps: &[TransformStep]) -> Option<Transform> {
    let mut m = Affine3A::IDENTITY;
    for step in steps {
        let next = match *step {
            TransformStep::Translate(t) => Affine3A::from_translation(Vec3::from(t)),
            TransformStep::Rotate { axis, degrees } => {
                let axis = Vec3::from(axis).try_normalize()?;
                Affine3A::from_quat(Quat::from_axis_angle(axis, degrees.to_radians()))
            }
            TransformStep::Scale(s) => Affine3A::from_scale(Vec3::from(s)),
            TransformStep::LookAt { position, target, up } => {
                let p = Vec3::from(position);
                let z = (Vec3::from(target) - p).try_normalize()?;
                let x = Vec3::from(up).cross(z).try_normalize()?;
                Affine3A::from_mat3_translation(math::Mat3::from_cols(x, z.cross(x), z), p)
            }
            TransformStep::Matrix(rows) => Affine3A::from_mat4(Mat4::from_cols_array(&rows).transpose()),
        };
        m = next * m;
    }
    Transform::new(m)
}

pub(super) fn singular(span: Option<Span>) -> Diagnostic {
    Diagnostic::error("singular-transform", "this transform flattens space, or is not finite").at(span)
}

fn solid(desc: &SceneDesc, shape: &ShapeDesc) -> Result<Solid, MeshError> {
    let v = Vec3::from;
    let mesh = match shape {
        ShapeDesc::Sphere { center, radius } => {
            return Ok(Solid::Sphere { center: v(*center), radius: *radius, flipped: false });
        }
        ShapeDesc::Disk { center, normal, radius } => {
            let normal = v(*normal).as_dvec3().normalize_or_zero().as_vec3();
            return Ok(Solid::Disk { center: v(*center), normal, radius: *radius });
        }
        ShapeDesc::Quad { origin, edge_u, edge_v } => shapes::quad(v(*origin), v(*edge_u), v(*edge_v)),
        ShapeDesc::Corners { corners } => four_corners(corners.map(v)),
        ShapeDesc::Mesh { file, normals } => with_normals(mesh::read(desc.resolve(file))?, *normals),
        ShapeDesc::Triangles { positions, indices, vertex_normals, uvs, uvs2, colors, normals } => {
            let mesh = TriangleMesh {
                positions: positions.iter().copied().map(v).collect(),
                normals: vertex_normals.iter().map(|n| v(*n).normalize_or_zero()).collect(),
                uvs: uvs.iter().copied().map(Vec2::from).collect(),
                uvs2: uvs2.iter().copied().map(Vec2::from).collect(),
                colors: colors.clone(),
                indices: indices.clone(),
            };
            mesh.validate()?;
            with_normals(mesh, *normals)
        }
        ShapeDesc::Box { min, max } => shapes::box_(v(*min), v(*max)),
        ShapeDesc::Teapot { level, solid: true, .. } => shapes::teapot_solid(*level),
        ShapeDesc::Teapot { level, parts, solid: false } => teapot(*level, parts),
        ShapeDesc::Lathe { profile, segments, smooth, closed, steps, crease_degrees } => {
            let points = profile.iter().copied().map(Vec2::from).collect();
            let crease = crease_degrees.to_radians();
            let outline = shapes::Profile { points, closed: *closed, steps: *steps, crease };
            let mesh = shapes::lathe(&outline, *segments)?;
            if *smooth { mesh } else { TriangleMesh { normals: Vec::new(), ..mesh } }
        }
        ShapeDesc::Cylinder { base, axis, radius, height, inward, closed, segments } => {
            let tube = if *closed {
                shapes::solid_cylinder(*radius, *height, *segments)
            } else {
                shapes::cylinder(*radius, *height, *segments)
            };
            let tube = if *inward { tube.flipped() } else { tube };
            tube.transformed(&upright(v(*base), v(*axis)))
        }
        ShapeDesc::Cone { base, axis, radius, top_radius, height, closed, segments } => {
            let make = if *closed { shapes::frustum } else { shapes::open_frustum };
            make(*radius, *top_radius, *height, *segments).transformed(&upright(v(*base), v(*axis)))
        }
        ShapeDesc::Capsule { base, axis, radius, height, segments } => {
            shapes::capsule(*radius, *height, *segments).transformed(&upright(v(*base), v(*axis)))
        }
        ShapeDesc::RoundedBox { min, max, radius, steps } => {
            shapes::rounded_box(v(*min), v(*max), *radius, *steps)
        }
        ShapeDesc::RoundBrilliant(gem) => brilliant(gem)?,
        ShapeDesc::WaterSurface(water) => water_surface(water)?,
        ShapeDesc::HeightField(field) => height_field(desc, field)?,
        ShapeDesc::Torus { center, axis, major_radius, minor_radius, segments, tube_segments } => {
            shapes::torus(*major_radius, *minor_radius, *segments, *tube_segments)
                .transformed(&upright(v(*center), v(*axis)))
        }
        ShapeDesc::Icosphere { center, radius, level, smooth } => {
            let mut ball = shapes::icosphere(*radius, *level);
            if !smooth {
                ball.normals.clear();
            }
            place(ball, Affine3A::from_translation(v(*center)))
        }
        ShapeDesc::Band { inner_radius, outer_radius, height, fillet, segments } => {
            shapes::band(*inner_radius, *outer_radius, *height, *fillet, *segments)
        }
        ShapeDesc::Ring { segments } => shapes::ring(*segments),
        ShapeDesc::CoffeeCup { segments } => shapes::coffee_cup(*segments),
        ShapeDesc::WineGlass { segments } => shapes::wine_glass(*segments),
        ShapeDesc::Wine { segments } => shapes::wine(*segments),
    };
    Ok(Solid::Mesh(mesh))
}

fn brilliant(gem: &desc::Brilliant) -> Result<TriangleMesh, MeshError> {
    let mesh = shapes::round_brilliant(&shapes::Brilliant {
        diameter: gem.diameter,
        table: gem.table,
        crown_angle: gem.crown_degrees.to_radians(),
        pavilion_angle: gem.pavilion_degrees.to_radians(),
        girdle: gem.girdle,
        star_length: gem.star_length,
        lower_half_length: gem.lower_half_length,
        culet: gem.culet,
    })?;
    Ok(mesh.transformed(&upright(gem.center.into(), gem.axis.into())))
}

fn height_field(desc: &SceneDesc, field: &desc::HeightField) -> Result<TriangleMesh, MeshError> {
    let (columns, mut heights) = match &field.source {
        desc::HeightSource::Rows(rows) => (rows.first().map_or(0, Vec::len), rows.concat()),
        desc::HeightSource::Picture(file) => {
            let path = desc.resolve(file);
            let picture = Picture::from_path(&path, Encoding::Linear, Wanted::Color).map_err(|e| {
                let message = match e {
                    TextureError::Unreadable(_, error) => format!("cannot be read: {error}"),
                    error => error.to_string(),
                };
                let help = "heights are PNG, TIFF, OpenEXR, PFM or another picture".to_owned();
                MeshError { path: Some(path.clone()), place: Place::Whole, message, help }
            })?;
            let [columns, rows] = picture.size();
            let mean = |i: usize| picture.pixel(i).map(f64::from).iter().sum::<f64>() / 3.0;
            (columns, (0..columns * rows).map(|i| mean(i) as f32).collect())
        }
    };
    heights.iter_mut().for_each(|h| *h *= field.height);
    let (size, depth) = (field.size, field.depth);
    let mesh = shapes::height_field(&shapes::HeightField { size, columns, heights: &heights, depth })?;
    Ok(place(mesh, Affine3A::from_translation(field.center.into())))
}

fn water_surface(water: &desc::WaterSurface) -> Result<TriangleMesh, MeshError> {
    let mesh = shapes::water_surface(&shapes::Water {
        size: water.size,
        resolution: water.resolution,
        depth: water.depth,
        wind_speed: water.wind_speed,
        wind_direction: water.wind_degrees.to_radians(),
        fetch: water.fetch,
        wave_height: water.wave_height,
        waves: water.waves,
        seed: water.seed.into(),
        time: water.time,
    })?;
    Ok(place(mesh, Affine3A::from_translation(water.center.into())))
}

/// Two triangles, split from the first corner to the third; the four need not be planar.
fn four_corners(corners: [Vec3; 4]) -> TriangleMesh {
    TriangleMesh {
        positions: corners.to_vec(),
        normals: Vec::new(),
        uvs: [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(Vec2::from).to_vec(),
        indices: vec![[0, 1, 2], [0, 2, 3]],
        ..TriangleMesh::default()
    }
}

fn teapot(level: u32, parts: &[TeapotPart]) -> TriangleMesh {
    parts.iter().fold(TriangleMesh::default(), |mesh, part| {
        let part = match part {
            TeapotPart::Body => shapes::TeapotPart::Body,
            TeapotPart::Handle => shapes::TeapotPart::Handle,
            TeapotPart::Spout => shapes::TeapotPart::Spout,
            TeapotPart::Lid => shapes::TeapotPart::Lid,
            TeapotPart::Bottom => shapes::TeapotPart::Bottom,
        };
        mesh.merged(&shapes::teapot_part(part, level))
    })
}

fn with_normals(mesh: TriangleMesh, normals: Normals) -> TriangleMesh {
    match normals {
        Normals::Given => mesh,
        Normals::Completed if !mesh.normals.is_empty() => mesh,
        Normals::Completed => mesh.with_vertex_normals(),
        Normals::Flat => TriangleMesh { normals: Vec::new(), ..mesh },
        Normals::Smooth { crease_degrees } => mesh.with_crease(crease_degrees.to_radians()),
    }
}

/// Takes the y axis to `axis` and the origin to `base`.
fn upright(base: Vec3, axis: Vec3) -> Transform {
    let y = axis.normalize_or(Vec3::Y);
    let frame = Frame::from_z(y);
    // x, y, z = frame.y, axis, frame.x keeps handedness: y × z = x.
    let m = Affine3A::from_mat3_translation(math::Mat3::from_cols(frame.y, y, frame.x), base);
    Transform::new(m).unwrap_or_default()
}

fn place(mesh: TriangleMesh, m: Affine3A) -> TriangleMesh {
    mesh.transformed(&Transform::new(m).unwrap_or_default())
}

impl Solid {
    pub fn bounds(&self) -> Bounds3 {
        match self {
            Self::Mesh(mesh) => mesh.bounds(),
            Self::Sphere { center, radius, .. } => {
                Bounds3 { min: *center - Vec3::splat(*radius), max: *center + Vec3::splat(*radius) }
            }
            Self::Disk { center, normal, radius } => {
                // Half extent along an axis: r·√(1 − n²).
                let half = (Vec3::ONE - *normal * *normal).max(Vec3::ZERO).map(f32::sqrt) * *radius;
                Bounds3 { min: *center - half, max: *center + half }
            }
        }
    }

    /// A copy as the shape of an object.
    pub fn shape(&self) -> Shape {
        match *self {
            Self::Mesh(ref mesh) => Shape::Mesh(Arc::new(mesh.clone())),
            Self::Sphere { center, radius, flipped } => Shape::Sphere { center, radius, flipped },
            Self::Disk { center, normal, radius } => Shape::Disk { center, normal, radius },
        }
    }

    /// Area of one side.
    pub fn area(&self) -> f64 {
        let pi = f64::from(PI);
        match self {
            Self::Mesh(mesh) => mesh.area(),
            Self::Sphere { radius, .. } => 4.0 * pi * f64::from(*radius).powi(2),
            Self::Disk { radius, .. } => pi * f64::from(*radius).powi(2),
        }
    }

    /// A point from which the surface itself is not in the way of finding out what surrounds it: just off the front.
    pub fn a_point(&self) -> Vec3 {
        let lift = 1e-4 * self.bounds().size().length();
        match self {
            Self::Mesh(mesh) => {
                // The largest triangle, so that its middle lies well inside the surface.
                let area = |i: usize| {
                    let [a, b, c] = mesh.corners(i);
                    (b - a).cross(c - a).length()
                };
                let widest =
                    (0..mesh.indices.len()).max_by(|&i, &j| area(i).total_cmp(&area(j))).unwrap_or(0);
                let [a, b, c] = mesh.corners(widest);
                (a + b + c) / 3.0 + (b - a).cross(c - a).normalize_or_zero() * lift
            }
            Self::Sphere { center, radius, flipped: false } => *center + Vec3::X * (*radius + lift),
            Self::Sphere { center, .. } => *center,
            Self::Disk { center, normal, .. } => *center + *normal * lift,
        }
    }

    /// What caustic photons are aimed at.
    pub fn target(&self, weight: f32) -> Target {
        let bounds = self.bounds();
        match self {
            Self::Sphere { center, radius, .. } | Self::Disk { center, radius, .. } => {
                Target { bounds, center: *center, radius: *radius, weight }
            }
            Self::Mesh(mesh) => {
                let center = bounds.center();
                let radius2 = mesh.positions.iter().map(|p| p.distance_squared(center)).fold(0.0, f32::max);
                Target { bounds, center, radius: radius2.sqrt(), weight }
            }
        }
    }

    pub fn flipped(self) -> Self {
        match self {
            Self::Mesh(mesh) => Self::Mesh(mesh.flipped()),
            Self::Sphere { center, radius, flipped } => Self::Sphere { center, radius, flipped: !flipped },
            Self::Disk { center, normal, radius } => Self::Disk { center, normal: -normal, radius },
        }
    }

    /// Spheres and disks stay what they are under turns, moves and even scaling; else they become meshes.
    pub fn transformed(self, t: &Transform) -> Self {
        if *t == Transform::IDENTITY {
            return self;
        }
        let scale = even_scale(t);
        match (self, scale) {
            (Self::Mesh(mesh), _) => Self::Mesh(mesh.transformed(t)),
            (Self::Sphere { center, radius, flipped }, Some(s)) => {
                Self::Sphere { center: t.point(center), radius: radius * s, flipped }
            }
            (Self::Disk { center, normal, radius }, Some(s)) => Self::Disk {
                center: t.point(center),
                normal: t.normal(normal).normalize(),
                radius: radius * s,
            },
            (round, None) => Self::Mesh(round.into_mesh().transformed(t)),
        }
    }

    /// The triangles; of spheres and disks so many that they look round.
    pub fn into_mesh(self) -> TriangleMesh {
        match self {
            Self::Mesh(mesh) => mesh,
            Self::Sphere { center, radius, flipped } => {
                let ball = shapes::uv_sphere(radius, FACETS, FACETS / 2);
                let ball = place(ball, Affine3A::from_translation(center));
                if flipped { ball.flipped() } else { ball }
            }
            Self::Disk { center, normal, radius } => {
                shapes::disk(radius, FACETS).transformed(&upright(center, normal))
            }
        }
    }
}

/// The factor by which all lengths grow, if it is the same in every direction (to 10⁻⁵).
fn even_scale(t: &Transform) -> Option<f32> {
    let m = t.matrix().matrix3;
    let [a, b, c] = [m.x_axis, m.y_axis, m.z_axis].map(Vec3::from);
    let s = a.length();
    let tolerance = 1e-5 * s;
    let equal = (b.length() - s).abs() < tolerance && (c.length() - s).abs() < tolerance;
    let square = [a.dot(b), b.dot(c), c.dot(a)].iter().all(|d| d.abs() < tolerance * s);
    (equal && square).then_some(s)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn made(shape: ShapeDesc) -> TriangleMesh {
        match solid(&SceneDesc::default(), &shape).unwrap() {
            Solid::Mesh(mesh) => mesh,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn vessels_are_what_their_names_say() {
        let n = 24;
        assert_eq!(made(ShapeDesc::CoffeeCup { segments: n }), shapes::coffee_cup(n));
        assert_eq!(made(ShapeDesc::WineGlass { segments: n }), shapes::wine_glass(n));
        assert_eq!(made(ShapeDesc::Wine { segments: n }), shapes::wine(n));
        assert_eq!(made(ShapeDesc::Ring { segments: n }), shapes::ring(n));
        let band =
            ShapeDesc::Band { inner_radius: 1.0, outer_radius: 1.5, height: 0.7, fillet: 0.1, segments: n };
        assert_eq!(made(band), shapes::band(1.0, 1.5, 0.7, 0.1, n));
    }

    #[test]
    fn a_solid_teapot_is_closed_and_a_plain_one_is_not() {
        let teapot = |solid| made(ShapeDesc::Teapot { level: 4, parts: desc::TEAPOT_PARTS.to_vec(), solid });
        assert!(teapot(true).is_closed());
        assert!(!teapot(false).is_closed());
    }

    #[test]
    fn solids_stand_on_their_base_along_their_axis() {
        let (base, axis, segments) = ([1.0, 2.0, 3.0], [0.0, 0.0, 2.0], 64);
        let tube = |closed| ShapeDesc::Cylinder {
            base,
            axis,
            radius: 0.5,
            height: 2.0,
            inward: false,
            closed,
            segments,
        };
        assert!(made(tube(true)).is_closed() && !made(tube(false)).is_closed());
        let cone = |closed| ShapeDesc::Cone {
            base,
            axis,
            radius: 0.5,
            top_radius: 0.0,
            height: 2.0,
            closed,
            segments,
        };
        assert!(made(cone(true)).is_closed() && !made(cone(false)).is_closed());
        let capsule = made(ShapeDesc::Capsule { base, axis, radius: 0.5, height: 2.0, segments });
        assert!(capsule.is_closed());
        let ends = |mesh: TriangleMesh| [mesh.bounds().min.z, mesh.bounds().max.z];
        for (mesh, [low, high]) in
            [(made(tube(true)), [3.0, 5.0]), (made(cone(true)), [3.0, 5.0]), (capsule, [2.5, 5.5])]
        {
            assert!(mesh.signed_volume() > 0.0);
            let [a, b] = ends(mesh);
            assert!((a - low).abs() < 1e-6 && (b - high).abs() < 1e-6, "{a} {b}");
        }
    }

    #[test]
    fn gems_and_water_lie_where_they_are_put() {
        let gem = desc::Brilliant {
            center: [0.0, 1.0, 0.0],
            axis: [1.0, 0.0, 0.0],
            diameter: 2.0,
            table: 0.53,
            crown_degrees: 34.5,
            pavilion_degrees: 40.75,
            girdle: 0.02,
            star_length: 0.5,
            lower_half_length: 0.75,
            culet: 0.0,
        };
        let stone = made(ShapeDesc::RoundBrilliant(gem.clone()));
        assert!(stone.is_closed() && stone.signed_volume() > 0.0);
        // The table faces along the axis.
        assert!((stone.bounds().max.x - 0.343).abs() < 1e-3, "{:?}", stone.bounds());
        let hollow = desc::Brilliant { star_length: 0.01, ..gem };
        assert!(solid(&SceneDesc::default(), &ShapeDesc::RoundBrilliant(hollow)).is_err());
        let water = desc::WaterSurface {
            center: [5.0, 2.0, 0.0],
            size: [2.0, 4.0],
            depth: Some(1.0),
            resolution: 64,
            wind_speed: 3.0,
            wind_degrees: 0.0,
            fetch: 500.0,
            wave_height: Some(0.01),
            waves: 64,
            seed: 1,
            time: 0.0,
        };
        let body = made(ShapeDesc::WaterSurface(water.clone()));
        assert!(body.is_closed());
        assert!((body.signed_volume() - 8.0).abs() < 0.02, "{}", body.signed_volume());
        assert_eq!((body.bounds().min, body.bounds().max.x), (Vec3::new(4.0, 1.0, -2.0), 6.0));
        let coarse = desc::WaterSurface { resolution: 8, ..water };
        assert!(solid(&SceneDesc::default(), &ShapeDesc::WaterSurface(coarse)).is_err());
    }

    #[test]
    fn heights_are_the_numbers_of_a_picture() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("h.png");
        let dark = image::ImageBuffer::from_fn(3, 2, |x, y| image::Luma([(x * 16384 + y * 8192) as u16]));
        image::DynamicImage::ImageLuma16(dark).save(&file).unwrap();
        let desc = SceneDesc { base: folder.path().to_owned(), ..SceneDesc::default() };
        let of = |name: &str| desc::HeightField {
            center: [0.0, 5.0, 0.0],
            size: [2.0, 1.0],
            source: desc::HeightSource::Picture(std::path::PathBuf::from(name).into()),
            height: 2.0,
            depth: Some(0.5),
        };
        let Ok(Solid::Mesh(body)) = solid(&desc, &ShapeDesc::HeightField(of("h.png"))) else { panic!() };
        assert!(body.is_closed() && body.signed_volume() > 0.0);
        // 16 bits without a curve: the middle of the back and of the front.
        for (at, height) in
            [(Vec3::new(0.0, 0.0, -0.5), 16384.0), (Vec3::new(0.0, 0.0, 0.5), 16384.0 + 8192.0)]
        {
            let wanted = at + Vec3::Y * (5.0 + 2.0 * height / 65535.0);
            assert!(body.positions.iter().any(|p| p.distance(wanted) < 1e-5), "{wanted}");
        }
        std::fs::write(folder.path().join("broken.png"), "no picture").unwrap();
        for name in ["broken.png", "none.png"] {
            let error = solid(&desc, &ShapeDesc::HeightField(of(name))).unwrap_err().to_string();
            assert!(error.contains(name), "{error}");
        }
    }

    #[test]
    fn a_lathe_follows_its_steps_and_its_creases() {
        let lathe = |steps, crease_degrees| {
            made(ShapeDesc::Lathe {
                profile: vec![[1.0, 0.0], [2.0, 1.0], [1.0, 2.0]],
                segments: 8,
                smooth: true,
                closed: false,
                steps,
                crease_degrees,
            })
        };
        // The profile turns by a right angle: one more ring where it breaks there.
        let rings = |mesh: &TriangleMesh| mesh.positions.len() / 9;
        assert_eq!([rings(&lathe(1, 100.0)), rings(&lathe(1, 80.0))], [3, 4]);
        assert_eq!([rings(&lathe(5, 100.0)), rings(&lathe(5, 80.0))], [11, 12]);
    }
}
