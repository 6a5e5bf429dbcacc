use std::sync::Arc;

use accel::{Bvh, NO_INSTANCE};
use bsdf::Bsdf;
use color::{LaneBasis, Lanes};
use math::{Bounds3, Ray, Transform, Vec3};

use crate::attributes::Owner;
use crate::interaction::TURNED;
use crate::light::{DirectPicker, LeSample, LiSample, LightHit, LightPicker};
use crate::material::{Lookup, Place};
use crate::shape::to_world;
use crate::texture::Picture;
use crate::{
    Boundary, Camera, Light, LightId, Material, MaterialId, Medium, MediumStack, Object, SurfaceInteraction,
    Targets, Texture,
};

/// Objects with a BVH of their own, placed by instances.
#[derive(Debug)]
pub(crate) struct Group {
    pub objects: Vec<Object>,
    pub bvh: Arc<Bvh>,
}

/// What a geometry id of the outer BVH stands for.
#[derive(Debug)]
pub(crate) enum Outer {
    Object(Object),
    Instance {
        group: u32,
        render_from_object: Transform,
        material: Option<MaterialId>,
        /// Number of its first object in hits.
        first: u32,
    },
}

/// The dielectrics that the camera is in.
#[derive(Debug)]
pub(crate) enum CameraMedia {
    /// The same for all rays.
    Everywhere(MediumStack),
    /// Rays start far from one another.
    AskedEachTime,
}

/// What makes the radiance of an area light vary over its surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LightTexture {
    /// Index of a texture: the factor.
    pub texture: u32,
    /// Geometry id of the object that shines.
    pub object: u32,
}

/// A compiled scene.
#[derive(Debug)]
pub struct Scene {
    pub(crate) bvh: Bvh,
    pub(crate) outer: Vec<Outer>,
    /// Of each instance, in order: the number of its first object in hits, and its place in `outer`.
    pub(crate) instance_numbers: Vec<(u32, u32)>,
    /// Of an object or an instance, as in the description; empty where it has none.
    pub(crate) outer_names: Vec<String>,
    pub(crate) material_names: Vec<String>,
    pub(crate) groups: Vec<Group>,
    pub(crate) materials: Vec<Material>,
    pub(crate) textures: Vec<Texture>,
    pub(crate) lights: Vec<Light>,
    /// By light: its texture, if it has one.
    pub(crate) light_textures: Vec<Option<LightTexture>>,
    pub(crate) light_names: Vec<String>,
    /// By light.
    pub(crate) light_groups: Vec<u32>,
    pub(crate) group_names: Vec<String>,
    /// Lights that rays reach by leaving the scene.
    pub(crate) environments: Vec<LightId>,
    pub(crate) light_media: Vec<MediumStack>,
    pub(crate) direct_picker: DirectPicker,
    pub(crate) global_picker: LightPicker,
    pub(crate) caustic_picker: LightPicker,
    pub(crate) targets: Targets,
    /// Whether any surface is there by chance.
    pub(crate) by_chance: bool,
    /// Whether any solid absorbs.
    pub(crate) absorbs: bool,
    pub(crate) camera: Camera,
    pub(crate) camera_media: CameraMedia,
    pub(crate) resolution: [u32; 2],
    pub(crate) bounds: Bounds3,
    pub(crate) triangles: u64,
    pub(crate) mesh_bytes: u64,
}

impl Scene {
    /// The first surface that a ray meets. Where opacity or a mix leaves that to chance, a hash of the place decides.
    #[inline]
    pub fn intersect(&self, ray: &Ray) -> Option<SurfaceInteraction> {
        if self.by_chance { self.intersect_by_chance(ray) } else { self.first(ray) }
    }

    /// The first surface, with the material that the object was given.
    #[inline]
    pub(crate) fn first(&self, ray: &Ray) -> Option<SurfaceInteraction> {
        // A copy, so that the caller's ray need not lie in memory.
        let ray = &{ *ray };
        let hit = self.bvh.closest(ray)?;
        let id = if hit.instance == NO_INSTANCE { hit.geom } else { hit.instance };
        // One result from two places, not two: it need then not lie in memory.
        let surface = match &self.outer[id as usize] {
            Outer::Object(object) => object.interaction(ray, &hit),
            Outer::Instance { group, render_from_object, material, first } => {
                let object = &self.groups[*group as usize].objects[hit.geom as usize];
                let number = first.saturating_add(hit.geom);
                placed(object, ray, &{ hit }, render_from_object, *material, number).unpacked()
            }
        };
        Some(surface)
    }

    /// Whether anything lies on the ray.
    #[inline]
    pub fn occluded(&self, ray: &Ray) -> bool {
        if self.by_chance { self.intersect_by_chance(ray).is_some() } else { self.bvh.occluded(ray) }
    }

    /// The BSDF at `hit`, seen from `wo`. `eta`: relative index (inside over outside) of a dielectric boundary, from
    /// [`Scene::boundary`]; `footprint`: width of the ray there, in units of length.
    #[inline]
    pub fn bsdf(&self, hit: &SurfaceInteraction, wo: Vec3, eta: f32, footprint: f32) -> Bsdf {
        let lookup = self.lookup(footprint);
        self.materials[hit.material.0 as usize].bsdf(hit, wo, eta, &lookup)
    }

    /// What evaluating materials needs, for rays of a width.
    #[inline]
    pub(crate) fn lookup(&self, footprint: f32) -> Lookup<'_> {
        Lookup { textures: &self.textures, of: Owner::Scene(self), footprint }
    }

    /// The dielectric that the surface at `hit` bounds.
    #[inline]
    pub fn medium(&self, hit: &SurfaceInteraction) -> Option<Medium> {
        self.materials[hit.material.0 as usize].medium(hit.material)
    }

    /// What the boundary at `hit` separates for a ray along `w` inside `media`; `None` where it is no dielectric.
    #[inline]
    pub fn boundary(&self, hit: &SurfaceInteraction, media: &MediumStack, w: Vec3) -> Option<Boundary> {
        let medium = self.medium(hit)?;
        Some(MediumStack::boundary(&{ *media }, medium, w.dot(hit.ng) < 0.0))
    }

    /// Whether any solid of the scene absorbs light on its way.
    #[inline]
    pub fn absorbs(&self) -> bool {
        self.absorbs
    }

    /// What is left of light after `distance` (may be infinite) in the dielectric that `medium` bounds (`None`: in
    /// vacuum): e^(−σ·d) (Beer–Lambert).
    #[inline(never)]
    pub fn transmittance(&self, medium: Option<MaterialId>, distance: f32) -> Lanes {
        let Some(id) = medium else { return Lanes::ONE };
        let absorption = self.materials[id.0 as usize].absorption();
        absorption.map(|sigma| if sigma > 0.0 { (-sigma * distance).exp() } else { 1.0 })
    }

    /// Materials by id.
    pub fn materials(&self) -> &[Material] {
        &self.materials
    }

    /// What a material is called in the description; `None` where it has no name there.
    pub fn material_name(&self, id: MaterialId) -> Option<&str> {
        self.material_names.get(id.0 as usize).map(String::as_str).filter(|name| !name.is_empty())
    }

    /// The name of the object, or of the instance or its group, that a ray meets first; `None` where it has no name or
    /// there is none. For messages: the ray is traced anew.
    pub fn object_name(&self, ray: &Ray) -> Option<&str> {
        let hit = self.bvh.closest(ray)?;
        let id = if hit.instance == NO_INSTANCE { hit.geom } else { hit.instance };
        self.outer_names.get(id as usize).map(String::as_str).filter(|name| !name.is_empty())
    }

    /// Lights by id.
    pub fn lights(&self) -> &[Light] {
        &self.lights
    }

    /// A light.
    #[inline]
    pub fn light(&self, id: LightId) -> &Light {
        &self.lights[id.0 as usize]
    }

    /// [`Light::sample_li`], with the light's texture.
    #[inline]
    pub fn sample_li(&self, id: LightId, p: Vec3, n: Vec3, u_pick: f32, u: [f32; 2]) -> Option<LiSample> {
        let light = self.light(id);
        let mut li = light.sample_li(p, n, u_pick, u)?;
        if light.is_textured() {
            li.radiance *= self.light_texture(id, li.p, li.prim);
        }
        Some(li)
    }

    /// [`Light::sample_le`], with the light's texture.
    pub fn sample_le(&self, id: LightId, u_pick: f32, u_pos: [f32; 2], u_dir: [f32; 2]) -> Option<LeSample> {
        self.light(id).sample_le(u_pick, u_pos, u_dir).map(|le| self.textured(id, le))
    }

    /// [`Light::sample_le_toward`] the scene's targets, with the light's texture.
    pub fn sample_le_toward(
        &self,
        id: LightId,
        u_pick: f32,
        u_pos: [f32; 2],
        u_dir: [f32; 2],
    ) -> Option<LeSample> {
        let le = self.light(id).sample_le_toward(&self.targets, u_pick, u_pos, u_dir);
        le.map(|le| self.textured(id, le))
    }

    fn textured(&self, id: LightId, le: LeSample) -> LeSample {
        match self.light(id).is_textured() {
            true => LeSample { radiance: le.radiance * self.light_texture(id, le.p, le.prim), ..le },
            false => le,
        }
    }

    /// Radiance of an area light that leaves along `w` (unit) at a point of it. Zero for lights without a surface.
    #[inline]
    pub fn emitted(&self, id: LightId, hit: &LightHit, w: Vec3) -> Lanes {
        let light = self.light(id);
        let radiance = light.emitted(hit.ng, w);
        if light.is_textured() { radiance * self.light_texture(id, hit.p, hit.prim) } else { radiance }
    }

    /// What a light's texture makes of its radiance at a point: all who ask get the same.
    #[inline(never)]
    fn light_texture(&self, id: LightId, p: Vec3, prim: u32) -> Lanes {
        let texture = self.light_textures.get(id.0 as usize).copied().flatten();
        match texture.and_then(|t| Some((t.texture, self.outer.get(t.object as usize)?))) {
            Some((texture, Outer::Object(object))) => {
                light_factor(&self.textures, texture, object, p, prim, 0.0)
            }
            _ => Lanes::ONE,
        }
    }

    /// The lights, in order.
    pub fn light_ids(&self) -> impl Iterator<Item = LightId> + use<> {
        (0..self.lights.len() as u32).map(LightId)
    }

    /// What a light is called in messages.
    pub fn light_name(&self, id: LightId) -> &str {
        self.light_names.get(id.0 as usize).map_or("", String::as_str)
    }

    /// The group of a light, an index of [`Self::light_groups`].
    #[inline]
    pub fn light_group(&self, id: LightId) -> u32 {
        self.light_groups.get(id.0 as usize).copied().unwrap_or(0)
    }

    /// Names of the groups of lights, as the description has them: lights without a group are one by themselves, named
    /// like the light.
    pub fn light_groups(&self) -> &[String] {
        &self.group_names
    }

    /// The dielectrics that a light lies in.
    pub fn light_medium(&self, id: LightId) -> MediumStack {
        self.light_media.get(id.0 as usize).copied().unwrap_or_default()
    }

    /// Radiance that comes along a ray that leaves the scene in direction `w`, light by light.
    pub fn environments(&self) -> &[LightId] {
        &self.environments
    }

    /// How lights are chosen for direct light.
    pub fn direct_picker(&self) -> &DirectPicker {
        &self.direct_picker
    }

    /// How lights are chosen for photons of the global map.
    pub fn global_picker(&self) -> &LightPicker {
        &self.global_picker
    }

    /// How lights are chosen for photons aimed at specular objects.
    pub fn caustic_picker(&self) -> &LightPicker {
        &self.caustic_picker
    }

    /// The specular objects, at which caustic photons are aimed.
    pub fn targets(&self) -> &Targets {
        &self.targets
    }

    /// The camera.
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// The dielectrics that the camera is in where a ray of it starts. Cost: for parallel rays in a scene with dielectrics, a
    /// walk through the scene.
    #[inline]
    pub fn camera_medium(&self, origin: Vec3) -> MediumStack {
        match self.camera_media {
            CameraMedia::Everywhere(media) => media,
            CameraMedia::AskedEachTime => self.media_of_parallel_ray(origin),
        }
    }

    #[inline(never)]
    fn media_of_parallel_ray(&self, origin: Vec3) -> MediumStack {
        if self.bounds.contains(origin) { media_at(self, origin) } else { MediumStack::default() }
    }

    /// Width and height of the film, in pixels.
    pub fn resolution(&self) -> [u32; 2] {
        self.resolution
    }

    /// Bounds of all geometry.
    pub fn bounds(&self) -> Bounds3 {
        self.bounds
    }

    /// Meaning of the lanes.
    pub fn basis(&self) -> LaneBasis {
        LaneBasis::LinearRgb
    }

    /// Flux of all lights, W per lane.
    pub fn power(&self) -> Lanes {
        self.lights.iter().fold(Lanes::ZERO, |sum, l| sum + l.power())
    }

    /// Counts and sizes, for reports.
    pub fn summary(&self) -> Summary {
        Summary {
            objects: self.outer.iter().filter(|o| matches!(o, Outer::Object(_))).count(),
            instances: self.outer.iter().filter(|o| matches!(o, Outer::Instance { .. })).count(),
            groups: self.groups.len(),
            triangles: self.triangles,
            materials: self.materials.len(),
            textures: self.textures.len(),
            mesh_bytes: self.mesh_bytes,
            bvh_bytes: (self.bvh.memory_bytes()
                + self.groups.iter().map(|g| g.bvh.memory_bytes()).sum::<usize>())
                as u64,
            texture_bytes: texture_bytes(&self.textures),
        }
    }

    /// What is told of it; the tracing structures' size is what they would take.
    pub(crate) fn into_survey(self) -> Survey {
        let instances = self.outer.iter().filter(|o| matches!(o, Outer::Instance { .. })).count() as u64;
        let bvh_bytes =
            Bvh::BYTES_PER_TRIANGLE * self.triangles + size_of::<Transform>() as u64 * 2 * instances;
        Survey {
            summary: Summary { bvh_bytes, ..self.summary() },
            bounds: self.bounds,
            resolution: self.resolution,
            lights: self.light_names.into_iter().zip(self.lights).collect(),
        }
    }
}

/// The factor on the radiance of an object at a point of it, averaged over about `width`, in units of length.
pub(crate) fn light_factor(
    textures: &[Texture],
    texture: u32,
    object: &Object,
    p: Vec3,
    prim: u32,
    width: f32,
) -> Lanes {
    let hit = object.at(p, prim);
    let lookup = Lookup { textures, of: Owner::Object(object), footprint: width };
    Place { hit: Some(&hit), lookup: &lookup }.emission(texture)
}

/// The surface of an object of a group at a hit of a ray of the world.
#[inline(never)]
fn placed(
    object: &Object,
    ray: &Ray,
    hit: &accel::Hit,
    render_from_object: &Transform,
    material: Option<MaterialId>,
    number: u32,
) -> SurfaceInteraction {
    let inverse = render_from_object.inverse();
    let local =
        Ray { origin: inverse.point(ray.origin), direction: inverse.vector(ray.direction), t_max: ray.t_max };
    let surface = to_world(object.interaction(&local, hit), render_from_object);
    let object = number | (surface.object & TURNED);
    SurfaceInteraction { material: material.unwrap_or(surface.material), object, ..surface }
}

/// Bytes of the pictures, each counted once.
fn texture_bytes(textures: &[Texture]) -> u64 {
    let mut seen: Vec<*const Picture> = Vec::new();
    let mut sum = 0;
    for texture in textures {
        if let Texture::Image(image) = texture
            && !seen.contains(&Arc::as_ptr(image.picture()))
        {
            seen.push(Arc::as_ptr(image.picture()));
            sum += image.memory_bytes() as u64;
        }
    }
    sum
}

/// Counts and sizes of a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Summary {
    /// Objects outside groups.
    pub objects: usize,
    /// Placed groups.
    pub instances: usize,
    /// Groups.
    pub groups: usize,
    /// Triangles, those of a group once.
    pub triangles: u64,
    /// Materials.
    pub materials: usize,
    /// Textures.
    pub textures: usize,
    /// Bytes of vertices and indices.
    pub mesh_bytes: u64,
    /// Bytes of the ray tracing structures.
    pub bvh_bytes: u64,
    /// Bytes of images.
    pub texture_bytes: u64,
}

/// What is in a scene, without the means to trace it.
#[derive(Clone, Debug)]
pub struct Survey {
    /// Counts and sizes; that of the ray tracing structures is an estimate.
    pub summary: Summary,
    /// A box around all surfaces; empty where there is none.
    pub bounds: Bounds3,
    /// Width and height of the picture.
    pub resolution: [u32; 2],
    /// Lights with their names.
    pub lights: Vec<(String, Light)>,
}

/// The dielectrics that `p` is inside of: those whose boundaries a ray from `p` leaves more often than it enters.
/// Boundaries are taken as closed.
pub(crate) fn media_at(scene: &Scene, p: Vec3) -> MediumStack {
    // An odd direction, so that it runs along no wall of a scene laid out on axes.
    let w = Vec3::new(0.532_1, 0.618_9, 0.577_7).normalize();
    let mut ray = Ray::new(p, w);
    let mut crossings: Vec<(Medium, i32)> = Vec::new();
    for _ in 0..10_000 {
        let Some(hit) = scene.intersect(&ray) else { break };
        if let Some(medium) = scene.medium(&hit) {
            let leaving = if w.dot(hit.ng) > 0.0 { 1 } else { -1 };
            match crossings.iter_mut().find(|(m, _)| m.material == medium.material) {
                Some((_, n)) => *n += leaving,
                None => crossings.push((medium, leaving)),
            }
        }
        ray = hit.spawn_ray(w);
    }
    // The solid that is left last lies outermost.
    crossings.iter().rev().filter(|(_, n)| *n > 0).fold(MediumStack::default(), |stack, (medium, n)| {
        (0..*n).fold(stack, |stack, _| stack.crossed(*medium, true))
    })
}
