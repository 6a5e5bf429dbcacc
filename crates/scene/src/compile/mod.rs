//! From a description to a scene: resolves names, reads meshes and images, builds the search structures.

mod displace;
mod lights;
mod materials;
mod shaped;
mod shapes;
mod sun_sky;
mod textures;

use std::collections::BTreeMap;
use std::sync::Arc;

use accel::{Bvh, Geometry};
use math::{Bounds3, Transform, Vec2, Vec3};
use scenefile::desc::{
    Camera as CameraDesc, CameraKind, Emission, FovAxis, LightKind, MaterialRef, Object as ObjectDesc,
    SceneDesc, Shape as ShapeDesc, SunSky,
};
use scenefile::{Diagnostic, Sourced, Span};

use crate::camera::{CameraError, Fov, Lens, Side};
use crate::interaction::TURNED;
use crate::light::{DirectPicker, LightPicker};
use crate::scene::{CameraMedia, Group, LightTexture, Outer, light_factor, media_at};
use crate::{
    Camera, Light, LightId, Material, MaterialId, MaterialKind, MediumStack, Object, Scene, Shape, Survey,
    Target, Targets,
};
use displace::{Displacer, Pixels, Within};
use materials::Library;
use shapes::Solid;

/// Compiles a description. Runs on the threads of the enclosing `par::Workers::run`.
///
/// Returns the scene and what should be told about it (missing lights, shapes that had to be replaced).
///
/// # Errors
/// Everything that is wrong and could not be known from the text alone: files that cannot be read or decoded, names
/// that stand for nothing, shapes and lights without extent.
pub fn compile(desc: &SceneDesc) -> Result<(Scene, Vec<Diagnostic>), Vec<Diagnostic>> {
    Compiler::new(desc).run()
}

/// Looks at what a description makes without making it ready for rays. As [`compile`], but for the tracing structures, of which the size
/// alone is told.
///
/// # Errors
/// As [`compile`].
pub fn survey(desc: &SceneDesc) -> Result<(Survey, Vec<Diagnostic>), Vec<Diagnostic>> {
    let compiler = Compiler { purpose: Purpose::Survey, ..Compiler::new(desc) };
    compiler.run().map(|(scene, told)| (scene.into_survey(), told))
}

/// What a scene is compiled for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Purpose {
    /// To be rendered.
    Render,
    /// To be described.
    Survey,
}

impl Purpose {
    fn bvh(self, geometry: Geometry) -> Bvh {
        match self {
            Self::Render => Bvh::build(geometry),
            Self::Survey => Bvh::outline(&geometry),
        }
    }
}

/// A placed solid, its material and its light.
struct Placed<'d> {
    solid: Solid,
    material: MaterialId,
    emission: Option<&'d Sourced<Emission>>,
    name: String,
    light_group: Option<String>,
    span: Option<Span>,
}

struct Compiler<'d> {
    desc: &'d SceneDesc,
    purpose: Purpose,
    library: Library<'d>,
    diagnostics: Vec<Diagnostic>,
    lights: Vec<Light>,
    light_names: Vec<String>,
    light_groups: Vec<u32>,
    light_textures: Vec<Option<LightTexture>>,
    group_names: Vec<String>,
    /// A point on or at each light, from which the media around it are found.
    light_points: Vec<Option<Vec3>>,
    targets: Vec<Target>,
    /// What lengths in pixels mean.
    pixels: Option<Pixels>,
    geometry: Geometry,
    outer: Vec<Outer>,
    outer_names: Vec<String>,
    triangles: u64,
    mesh_bytes: u64,
    bounds: Bounds3,
}

/// What is said where glass or a liquid fills a surface that has holes. Sheets that are made to be open are left out: water and
/// height fields, whose other side is the ground.
fn open_solid(object: &Sourced<ObjectDesc>, solid: &Solid) -> Option<Diagnostic> {
    let is_open = match (solid, &object.shape.value) {
        (_, ShapeDesc::WaterSurface(_) | ShapeDesc::HeightField(_)) => false,
        (Solid::Mesh(mesh), _) => !mesh.is_closed(),
        (Solid::Disk { .. }, _) => true,
        (Solid::Sphere { .. }, _) => false,
    };
    let message = "this glass or liquid has an open surface: light that enters does not leave it again";
    let help =
        "close it, or take `thin-dielectric` for a pane; a level of water within a basin is right as it is";
    is_open.then(|| Diagnostic::warning("open-solid", message).at(object.span).help(help))
}

impl<'d> Compiler<'d> {
    fn new(desc: &'d SceneDesc) -> Self {
        Self {
            desc,
            purpose: Purpose::Render,
            library: Library::new(desc),
            diagnostics: Vec::new(),
            lights: Vec::new(),
            light_names: Vec::new(),
            light_groups: Vec::new(),
            light_textures: Vec::new(),
            group_names: Vec::new(),
            light_points: Vec::new(),
            targets: Vec::new(),
            pixels: None,
            geometry: Geometry::default(),
            outer: Vec::new(),
            outer_names: Vec::new(),
            triangles: 0,
            mesh_bytes: 0,
            bounds: Bounds3::EMPTY,
        }
    }

    fn run(mut self) -> Result<(Scene, Vec<Diagnostic>), Vec<Diagnostic>> {
        let camera = self.camera();
        self.pixels = camera.as_ref().map(Pixels::of);
        let objects: Vec<_> = self.desc.objects.iter().collect();
        for placed in self.place(&objects, None, Within::World) {
            self.add_object(placed);
        }
        let groups = self.instances();
        for light in &self.desc.lights {
            self.add_light(light);
        }
        self.diagnostics.append(&mut self.library.take_diagnostics());
        if self.lights.is_empty() {
            self.diagnostics.push(
                Diagnostic::warning("no-light", "the scene has no light: the picture will be black")
                    .help("add a [[lights]] entry, or `radiance` or `power` to an object"),
            );
        }
        let errors = self.diagnostics.iter().any(Diagnostic::is_error);
        match camera {
            Some(camera) if !errors => Ok(self.finish(camera, groups)),
            _ => Err(self.diagnostics),
        }
    }

    /// Builds the solids of a list of objects, in parallel; what cannot be built is reported.
    fn place(
        &mut self,
        objects: &[&'d Sourced<ObjectDesc>],
        instance: Option<&Transform>,
        within: Within<'_>,
    ) -> Vec<Placed<'d>> {
        let materials: Vec<MaterialId> = objects.iter().map(|o| self.material_of(o)).collect();
        // Without a camera nothing is rendered: that is said already.
        let pixels = self.pixels;
        let displaced: Vec<Option<u32>> = objects
            .iter()
            .map(|o| o.displacement.as_ref().and_then(|d| self.library.texture(&d.texture)))
            .collect();
        // Surfaces of one material may close one another. Placed again for an instance, objects have been looked at.
        let mut uses: BTreeMap<u32, u32> = BTreeMap::new();
        materials.iter().for_each(|id| *uses.entry(id.0).or_default() += 1);
        let fills_alone = |id: MaterialId| uses.get(&id.0) == Some(&1) && self.library.is_filling(id);
        let must_close: Vec<bool> =
            materials.iter().map(|&id| instance.is_none() && fills_alone(id)).collect();
        let (desc, textures) = (self.desc, self.library.textures());
        let solids = par::map(objects.len(), |i| {
            let displacer = displaced[i].zip(objects[i].displacement.as_ref()).zip(pixels);
            let displacer = displacer.map(|((texture, desc), pixels)| Displacer {
                desc,
                textures,
                texture,
                pixels,
                within,
            });
            let solid = shapes::build(desc, objects[i], displacer)?;
            let told = if must_close[i] { open_solid(objects[i], &solid) } else { None };
            match instance {
                None => Ok((solid, told)),
                Some(t) => Ok((solid.transformed(t), told)),
            }
        });
        let mut placed = Vec::new();
        for ((solid, object), material) in solids.into_iter().zip(objects.iter().copied()).zip(materials) {
            match solid {
                Ok((solid, told)) => {
                    self.diagnostics.extend(told);
                    placed.push(Placed {
                        solid,
                        material,
                        emission: object.emission.as_ref(),
                        name: object.name.clone().unwrap_or_default(),
                        light_group: object.light_group.clone().or_else(|| object.name.clone()),
                        span: object.span,
                    });
                }
                Err(diagnostic) => self.diagnostics.push(diagnostic),
            }
        }
        placed
    }

    fn material_of(&mut self, object: &'d Sourced<ObjectDesc>) -> MaterialId {
        match &object.material {
            Some(reference) => self.library.resolve(reference),
            None => self.library.black(),
        }
    }

    fn add_object(&mut self, placed: Placed<'d>) {
        self.bounds = self.bounds.union(placed.solid.bounds());
        let light = placed.emission.and_then(|emission| self.lamp(&placed, emission));
        self.aim_at(placed.material, &placed.solid, None);
        let mut solid = placed.solid;
        let textured = light.is_some_and(|id| self.light_textures[id.0 as usize].is_some());
        if let Solid::Mesh(mesh) = &mut solid {
            self.library.needs(placed.material, textured).strip(mesh);
        }
        let object = self.object(solid, placed.material, light, true);
        self.outer.push(Outer::Object(object));
        self.outer_names.push(placed.name);
    }

    /// The light of an object that is about to be added to the outer geometry; what is wrong with it is reported.
    fn lamp(&mut self, placed: &Placed<'d>, emission: &'d Sourced<Emission>) -> Option<LightId> {
        let built = match &emission.texture {
            None => lights::area_light(&placed.solid, emission)
                .map(|light| Some((light, None)))
                .ok_or("this object shines but has no area"),
            Some(name) => {
                let texture = self.library.texture(name)?;
                let shape = placed.solid.shape();
                let object = Object { shape, material: placed.material, light: None };
                let textures = self.library.textures();
                let factor = |p, prim, width| light_factor(textures, texture, &object, p, prim, width);
                let texture = LightTexture { texture, object: self.outer.len() as u32 };
                lights::textured_light(&placed.solid, emission, factor)
                    .map(|light| light.map(|light| (light, Some(texture))))
            }
        };
        match built {
            Ok(light) => {
                let (light, texture) = light?;
                let group = placed.light_group.as_deref();
                let id = self.push_light(light, placed.name.clone(), group, Some(placed.solid.a_point()));
                self.light_textures[id.0 as usize] = texture;
                Some(id)
            }
            Err(reason) => {
                let error = Diagnostic::error("no-area", reason).at(emission.span.or(placed.span));
                self.diagnostics.push(error);
                None
            }
        }
    }

    /// Makes caustic photons aim at a solid, if it is specular.
    fn aim_at(&mut self, material: MaterialId, solid: &Solid, instance: Option<&Transform>) {
        let weight = self.library.specular_weight(material);
        if weight > 0.0 {
            let target = match (solid, instance) {
                (solid, None) => solid.target(weight),
                (solid, Some(t)) => Target::from_bounds(t.bounds(&solid.bounds()), weight),
            };
            self.targets.push(target);
        }
    }

    /// Adds a solid to the outer geometry (`outer`) or leaves that to the caller, and keeps what hits need.
    fn object(&mut self, solid: Solid, material: MaterialId, light: Option<LightId>, outer: bool) -> Object {
        let shape = match solid {
            Solid::Mesh(mesh) => {
                self.triangles += mesh.indices.len() as u64;
                self.mesh_bytes += mesh.memory_bytes() as u64;
                if outer {
                    self.geometry.add_triangles(&mesh.positions, &mesh.indices);
                }
                Shape::Mesh(Arc::new(mesh))
            }
            Solid::Sphere { center, radius, flipped } => {
                if outer {
                    self.geometry.add_sphere(center, radius);
                }
                Shape::Sphere { center, radius, flipped }
            }
            Solid::Disk { center, normal, radius } => {
                if outer {
                    self.geometry.add_disk(center, normal, radius);
                }
                Shape::Disk { center, normal, radius }
            }
        };
        Object { shape, material, light }
    }

    /// Groups that are placed somewhere, with their instances. Objects that shine are placed one by one: each copy
    /// is a light of its own.
    fn instances(&mut self) -> Vec<Group> {
        let mut groups: Vec<Group> = Vec::new();
        let mut solids: Vec<Vec<Solid>> = Vec::new();
        let mut ids: BTreeMap<&str, u32> = BTreeMap::new();
        for instance in &self.desc.instances {
            let Some(group) = self.desc.groups.get(instance.group.as_str()) else {
                self.diagnostics.push(
                    Diagnostic::error(
                        "unknown-group",
                        format!("there is no group `{}`", instance.group.value),
                    )
                    .at(instance.group.span),
                );
                continue;
            };
            let transform = match shapes::transform(&instance.transform) {
                Some(t) => t,
                None => {
                    self.diagnostics.push(shapes::singular(instance.span));
                    continue;
                }
            };
            let id = *ids.entry(instance.group.as_str()).or_insert_with(|| {
                let objects: Vec<_> = group.objects.iter().collect();
                let placements = self.placements(&instance.group);
                let placed = self.place(&objects, None, Within::Group(&placements));
                let still: Vec<Placed<'_>> = placed.into_iter().filter(|p| p.emission.is_none()).collect();
                solids.push(still.iter().map(|p| p.solid.clone()).collect());
                groups.push(self.group(still));
                (groups.len() - 1) as u32
            });
            let material = instance.material.as_ref().map(|m: &'d MaterialRef| self.library.resolve(m));
            let used = &groups[id as usize];
            if !used.objects.is_empty() {
                for (object, solid) in used.objects.iter().zip(&solids[id as usize]) {
                    self.aim_at(material.unwrap_or(object.material), solid, Some(&transform));
                }
                let bvh = used.bvh.clone();
                self.bounds = self.bounds.union(transform.bounds(&bvh.bounds()));
                // A group holds no instances, so this one cannot be refused.
                if self.geometry.add_instance(bvh, transform).is_ok() {
                    self.outer.push(Outer::Instance {
                        group: id,
                        render_from_object: transform,
                        material,
                        first: 0,
                    });
                    self.outer_names.push(instance.name.as_ref().unwrap_or(&instance.group).clone());
                }
            }
            let shining: Vec<_> = group.objects.iter().filter(|o| o.emission.is_some()).collect();
            let placements = if shining.is_empty() { Vec::new() } else { self.placements(&instance.group) };
            for mut placed in self.place(&shining, Some(&transform), Within::Group(&placements)) {
                placed.material = material.unwrap_or(placed.material);
                self.add_object(placed);
            }
        }
        groups
    }

    /// Where all instances of a group stand.
    fn placements(&self, group: &str) -> Vec<Transform> {
        let of_group = self.desc.instances.iter().filter(|instance| instance.group.as_str() == group);
        of_group.filter_map(|instance| shapes::transform(&instance.transform)).collect()
    }

    fn group(&mut self, placed: Vec<Placed<'_>>) -> Group {
        let mut geometry = Geometry::default();
        let objects = placed
            .into_iter()
            .map(|p| {
                match &p.solid {
                    Solid::Mesh(mesh) => geometry.add_triangles(&mesh.positions, &mesh.indices),
                    Solid::Sphere { center, radius, .. } => geometry.add_sphere(*center, *radius),
                    Solid::Disk { center, normal, radius } => geometry.add_disk(*center, *normal, *radius),
                };
                self.object(p.solid, p.material, None, false)
            })
            .collect();
        Group { objects, bvh: Arc::new(self.purpose.bvh(geometry)) }
    }

    fn add_light(&mut self, light: &Sourced<scenefile::desc::Light>) {
        if let LightKind::SunSky(desc) = &light.kind {
            return self.add_sun_sky(light, desc);
        }
        let built = match &light.kind {
            LightKind::Sky { source, mapping, scale, transform } => {
                lights::sky(self.desc, source, *mapping, *scale, transform).map(|sky| (sky, None)).map_err(
                    |reason| {
                        let message = format!("cannot light by `{}`: {reason}", source.written());
                        let span = source.file().and_then(|file| file.span).or(light.span);
                        Diagnostic::error("bad-image", message).at(span)
                    },
                )
            }
            kind if let Some(built) = shaped::light(self.desc, kind, light.span) => {
                built.map(|(light, point, mut notes)| {
                    self.diagnostics.append(&mut notes);
                    (light, Some(point))
                })
            }
            kind => lights::light(kind).ok_or_else(|| {
                let message = "this light has a direction of length zero or a value that is no number";
                Diagnostic::error("bad-light", message).at(light.span)
            }),
        };
        match built {
            Ok((compiled, point)) => {
                let name = light.name.clone().unwrap_or_else(|| lights::kind_name(&compiled).to_owned());
                let group = light.light_group.as_deref().or(light.name.as_deref());
                self.push_light(compiled, name, group, point);
            }
            Err(diagnostic) => self.diagnostics.push(diagnostic),
        }
    }

    fn add_sun_sky(&mut self, light: &Sourced<scenefile::desc::Light>, desc: &SunSky) {
        let built = match sun_sky::build(desc) {
            Ok(built) => built,
            Err(reason) => {
                let message = format!("this sun and sky cannot be: {reason}");
                self.diagnostics.push(Diagnostic::error("bad-light", message).at(light.span));
                return;
            }
        };
        if built.is_empty() && (desc.sun_scale > 0.0 || desc.sky_scale > 0.0) {
            let message = "the sun is below the horizon: neither it nor the sky gives light";
            self.diagnostics.push(Diagnostic::warning("no-light", message).at(light.span));
        }
        let group = light.light_group.clone().or_else(|| light.name.clone());
        for part in built {
            let what = if matches!(part, Light::Sun(_)) { "sun" } else { "sky" };
            let name = light.name.as_ref().map_or_else(|| what.to_owned(), |name| format!("{name} ({what})"));
            self.push_light(part, name, group.as_deref(), None);
        }
    }

    fn push_light(
        &mut self,
        light: Light,
        name: String,
        group: Option<&str>,
        point: Option<Vec3>,
    ) -> LightId {
        let number = self.lights.len() + 1;
        let kind = lights::kind_name(&light);
        let group = group.map_or_else(|| format!("{kind} {number}"), str::to_owned);
        let name = if name.is_empty() { format!("lamp {number}") } else { name };
        let group = self.group_names.iter().position(|n| *n == group).unwrap_or_else(|| {
            self.group_names.push(group);
            self.group_names.len() - 1
        });
        self.light_groups.push(group as u32);
        self.lights.push(light);
        self.light_names.push(name);
        self.light_points.push(point);
        self.light_textures.push(None);
        LightId((self.lights.len() - 1) as u32)
    }

    fn camera(&mut self) -> Option<Camera> {
        let Some(camera) = &self.desc.camera else {
            self.diagnostics.push(
                Diagnostic::error("no-camera", "the scene has no camera")
                    .help("add a [camera] table with `position` and `look_at`"),
            );
            return None;
        };
        match built_camera(camera, self.desc.film.size) {
            Ok(camera) => Some(camera),
            Err(e) => {
                self.diagnostics.push(Diagnostic::error("bad-camera", e.to_string()).at(camera.span));
                None
            }
        }
    }

    fn finish(mut self, camera: Camera, groups: Vec<Group>) -> (Scene, Vec<Diagnostic>) {
        let bvh = self.purpose.bvh(std::mem::take(&mut self.geometry));
        for light in &mut self.lights {
            light.preprocess(self.bounds);
        }
        let targets = Targets::new(self.targets);
        let environments = (0..self.lights.len() as u32)
            .map(LightId)
            .filter(|id| {
                matches!(self.lights[id.0 as usize], Light::Environment(_) | Light::Sky(_) | Light::Sun(_))
            })
            .collect();
        let material_names = self.library.names();
        let (materials, textures) = self.library.finish();
        let absorbs = materials.iter().any(|m| !m.absorption().is_zero());
        let by_chance =
            materials.iter().any(|m| m.opacity.is_some() || matches!(m.kind, MaterialKind::Mix { .. }));
        let instance_numbers = number_instances(&mut self.outer, &groups);
        let mut scene = Scene {
            by_chance,
            instance_numbers,
            bvh,
            outer: self.outer,
            outer_names: self.outer_names,
            material_names,
            groups,
            materials,
            textures,
            environments,
            light_media: vec![MediumStack::default(); self.lights.len()],
            direct_picker: DirectPicker::new(&self.lights),
            global_picker: LightPicker::photons(&self.lights),
            caustic_picker: LightPicker::caustics(&self.lights, &targets),
            lights: self.lights,
            light_names: self.light_names,
            light_groups: self.light_groups,
            light_textures: self.light_textures,
            group_names: self.group_names,
            targets,
            camera,
            absorbs,
            camera_media: CameraMedia::Everywhere(MediumStack::default()),
            resolution: self.desc.film.size,
            bounds: self.bounds,
            triangles: self.triangles,
            mesh_bytes: self.mesh_bytes,
        };
        if scene.materials.iter().any(|m: &Material| m.medium(MaterialId(0)).is_some()) {
            scene.camera_media = match scene.camera.is_parallel() {
                true => CameraMedia::AskedEachTime,
                false => CameraMedia::Everywhere(media_at(&scene, scene.camera.position())),
            };
            scene.light_media = self
                .light_points
                .iter()
                .map(|p| p.map_or(MediumStack::default(), |p| media_at(&scene, p)))
                .collect();
        }
        (scene, self.diagnostics)
    }
}

fn built_camera(camera: &CameraDesc, size: [u32; 2]) -> Result<Camera, CameraError> {
    let (position, look_at, up) =
        (Vec3::from(camera.position), Vec3::from(camera.look_at), Vec3::from(camera.up));
    let (fov, side) = match camera.fov_axis {
        FovAxis::X => (Fov::Horizontal(camera.fov), Side::Width),
        FovAxis::Y => (Fov::Vertical(camera.fov), Side::Height),
        FovAxis::Smaller => (Fov::Smaller(camera.fov), Side::Smaller),
    };
    let built = match camera.kind {
        CameraKind::Pinhole => Camera::perspective(position, look_at, up, fov, size, None),
        CameraKind::ThinLens { lens_radius, focus_distance } => {
            let focus_distance = focus_distance.unwrap_or(position.distance(look_at));
            let lens = Lens { radius: lens_radius, focus_distance };
            Camera::perspective(position, look_at, up, fov, size, Some(lens))
        }
        CameraKind::Orthographic { extent } => {
            Camera::orthographic(position, look_at, up, side, extent, size)
        }
        CameraKind::Spherical { mapping } => Camera::spherical(position, look_at, up, mapping, size),
    };
    built?.shifted(Vec2::from(camera.shift))
}

/// Numbers the objects of instances on from those outside of groups; returns the first number and the place of each.
fn number_instances(outer: &mut [Outer], groups: &[Group]) -> Vec<(u32, u32)> {
    let mut next = outer.len() as u32;
    let mut numbers = Vec::new();
    for (place, item) in outer.iter_mut().enumerate() {
        if let Outer::Instance { group, first, .. } = item {
            *first = next;
            numbers.push((next, place as u32));
            // More than can be numbered share the last numbers: their second coordinates are then lost.
            next = next.saturating_add(groups[*group as usize].objects.len() as u32).min(TURNED - 1);
        }
    }
    numbers
}
