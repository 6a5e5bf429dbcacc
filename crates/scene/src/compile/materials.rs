use std::collections::BTreeMap;

use bsdf::{Facets, Film, Interior};
use color::Lanes;
use mesh::TriangleMesh;
use scenefile::desc::{self, ColorDesc, FloatDesc, Ior, MaterialRef, Metal, SceneDesc};
use scenefile::{Diagnostic, Sourced};

use super::textures::{Reading, TextureLibrary};
use crate::{
    CoatedConductorMaterial, CoatedDiffuseMaterial, ColorSource, ConductorMaterial, DielectricMaterial,
    FloatSource, Material, MaterialId, MaterialKind, Opacity, PrincipledMaterial, RoughnessSource, Texture,
};

/// Mixes within mixes, at most: a cycle ends here.
const DEEPEST_MIX: u32 = 6;

/// What a mesh must have besides positions and normals.
pub(super) struct Needs {
    uvs: bool,
    uvs2: bool,
    colors: bool,
}

impl Needs {
    /// Takes away the rest.
    pub fn strip(&self, mesh: &mut TriangleMesh) {
        if !self.uvs {
            mesh.uvs = Vec::new();
        }
        if !self.uvs2 {
            mesh.uvs2 = Vec::new();
        }
        if !self.colors {
            mesh.colors = Vec::new();
        }
    }
}

/// Materials and textures as they are asked for.
pub(super) struct Library<'d> {
    desc: &'d SceneDesc,
    materials: Vec<Material>,
    named: BTreeMap<&'d str, MaterialId>,
    /// Those in place, by their address in the description.
    inline: BTreeMap<usize, MaterialId>,
    textures: TextureLibrary<'d>,
    black: Option<MaterialId>,
    pub diagnostics: Vec<Diagnostic>,
}

impl<'d> Library<'d> {
    pub fn new(desc: &'d SceneDesc) -> Self {
        let mut library = Self {
            desc,
            materials: Vec::new(),
            named: BTreeMap::new(),
            inline: BTreeMap::new(),
            textures: TextureLibrary::new(desc),
            black: None,
            diagnostics: Vec::new(),
        };
        // All of them, used or not: a mistake in an unused material is a mistake.
        for (name, material) in &desc.materials {
            let id = library.add(&material.value, 0);
            library.named.insert(name, id);
        }
        // The pictures of all, so that they are decoded together.
        let groups = desc.groups.values().flat_map(|group| &group.objects);
        for object in desc.objects.iter().chain(groups) {
            if let Some(reference) = &object.material {
                library.resolve(reference);
            }
            if let Some(displacement) = &object.displacement {
                library.textures.get(&displacement.texture, Reading::Plain);
            }
            if let Some(name) = object.emission.as_ref().and_then(|emission| emission.texture.as_ref()) {
                library.textures.get(name, Reading::Plain);
            }
        }
        for material in desc.instances.iter().filter_map(|instance| instance.material.as_ref()) {
            library.resolve(material);
        }
        library.textures.decode();
        library
    }

    /// What has been found wrong since the last time.
    pub fn take_diagnostics(&mut self) -> Vec<Diagnostic> {
        let mut all = std::mem::take(&mut self.diagnostics);
        all.append(&mut self.textures.diagnostics);
        all
    }

    /// The id of a material, or of black where it is not known (which is reported).
    pub fn resolve(&mut self, reference: &'d MaterialRef) -> MaterialId {
        match reference {
            // Equal ones are one: the boundaries of a solid must agree on what they bound.
            MaterialRef::Inline(material) => {
                let address = std::ptr::from_ref(&**material) as usize;
                if let Some(&id) = self.inline.get(&address) {
                    return id;
                }
                let id = self.add(material, 0);
                let added = &self.materials[id.0 as usize];
                let first = self.materials.iter().position(|m| m == added).unwrap_or(id.0 as usize);
                if first < id.0 as usize {
                    self.materials.pop();
                }
                let id = MaterialId(first as u32);
                self.inline.insert(address, id);
                id
            }
            MaterialRef::Named(name) => match self.named.get(name.as_str()) {
                Some(&id) => id,
                None => {
                    self.diagnostics.push(
                        Diagnostic::error(
                            "unknown-material",
                            format!("there is no material `{}`", name.value),
                        )
                        .at(name.span),
                    );
                    self.black()
                }
            },
        }
    }

    /// The material of lamps that reflect nothing.
    pub fn black(&mut self) -> MaterialId {
        match self.black {
            Some(id) => id,
            None => {
                let id = self.push(Material::new(MaterialKind::Black, None, true));
                self.black = Some(id);
                id
            }
        }
    }

    pub fn specular_weight(&self, id: MaterialId) -> f32 {
        let material = &self.materials[id.0 as usize];
        let weight = match material.kind {
            MaterialKind::Mix { a, b, amount } => {
                let t = amount.mean(&self.textures.textures).clamp(0.0, 1.0);
                (1.0 - t) * self.specular_weight(a) + t * self.specular_weight(b)
            }
            ref kind => kind.specular_weight(&self.textures.textures),
        };
        let opacity = material.opacity.map_or(1.0, |o| o.share.mean(&self.textures.textures).clamp(0.0, 1.0));
        weight * opacity
    }

    /// Whether a material bounds a solid that light enters, and not a level between two fillings.
    pub fn is_filling(&self, id: MaterialId) -> bool {
        self.materials[id.0 as usize].medium(id).is_some_and(|medium| medium.outside == 0.0)
    }

    /// What a mesh of a material must have.
    pub fn needs(&self, id: MaterialId, textured_lamp: bool) -> Needs {
        let uvs = textured_lamp || !self.needs_no_uv(id);
        let any = |wanted: fn(&Texture) -> bool| uvs && self.textures.textures.iter().any(wanted);
        Needs {
            uvs,
            uvs2: any(Texture::uses_second_coordinates),
            colors: any(|texture| matches!(texture, Texture::VertexColor(_))),
        }
    }

    fn needs_no_uv(&self, id: MaterialId) -> bool {
        let material = &self.materials[id.0 as usize];
        let parts = match material.kind {
            MaterialKind::Mix { a, b, .. } => self.needs_no_uv(a) && self.needs_no_uv(b),
            _ => true,
        };
        parts && material.needs_no_uv()
    }

    /// Names by id; empty for materials without one.
    pub fn names(&self) -> Vec<String> {
        let mut names = vec![String::new(); self.materials.len()];
        for (name, id) in &self.named {
            names[id.0 as usize] = (*name).to_owned();
        }
        names
    }

    pub fn finish(self) -> (Vec<Material>, Vec<Texture>) {
        (self.materials, self.textures.textures)
    }

    fn push(&mut self, material: Material) -> MaterialId {
        self.materials.push(material);
        MaterialId((self.materials.len() - 1) as u32)
    }

    /// `depth`: mixes around it.
    fn add(&mut self, material: &'d desc::Material, depth: u32) -> MaterialId {
        let kind = match &material.kind {
            desc::MaterialKind::Mix { a, b, amount } => MaterialKind::Mix {
                a: self.part(a, depth),
                b: self.part(b, depth),
                amount: self.float(amount),
            },
            kind => self.kind(kind),
        };
        let normal_map = material
            .normal_map
            .as_ref()
            .and_then(|name| self.textures.get(name, Reading::Normals))
            .map(|id| (id, material.normal_strength));
        let bump_map = material
            .bump_map
            .as_ref()
            .and_then(|name| self.textures.get(name, Reading::Plain))
            .map(|id| (id, material.bump_height));
        let rotation = self.float(&material.rotation);
        let parts = match kind {
            MaterialKind::Mix { a, b, .. } => vec![a, b],
            _ => Vec::new(),
        };
        let mut compiled = Material::new(kind, normal_map, material.two_sided);
        compiled.bump_map = bump_map;
        compiled.rotation = rotation;
        if material.opacity != FloatDesc::Value(1.0) {
            let share = self.float(&material.opacity);
            compiled.opacity = Some(Opacity { share, cutoff: material.opacity_cutoff });
        }
        let id = self.push(compiled);
        for part in parts {
            self.materials[part.0 as usize].part_of = Some(id);
        }
        id
    }

    /// A part of a mix: a material of its own, so that a hit tells what it is a part of.
    fn part(&mut self, reference: &'d MaterialRef, depth: u32) -> MaterialId {
        let (part, span) = match reference {
            MaterialRef::Inline(material) => (Some(&**material), None),
            MaterialRef::Named(name) => {
                let desc = self.desc;
                let found = desc.materials.get(name.as_str()).map(|m| &m.value);
                if found.is_none() {
                    self.unknown("unknown-material", "material", name);
                }
                (found, name.span)
            }
        };
        match part {
            Some(material) if depth < DEEPEST_MIX => self.add(material, depth + 1),
            Some(_) => {
                let message = "mixes of materials are nested too deeply";
                let error = Diagnostic::error("material-cycle", message).at(span);
                self.diagnostics.push(error.help("a mix must not contain itself"));
                self.push(Material::new(MaterialKind::Black, None, true))
            }
            None => self.push(Material::new(MaterialKind::Black, None, true)),
        }
    }

    fn kind(&mut self, kind: &'d desc::MaterialKind) -> MaterialKind {
        match kind {
            desc::MaterialKind::Diffuse { color } => MaterialKind::Diffuse { color: self.color(color) },
            desc::MaterialKind::Phong { diffuse, specular, exponent } => MaterialKind::Phong {
                diffuse: self.color(diffuse),
                specular: self.color(specular),
                exponent: self.float(exponent),
            },
            desc::MaterialKind::Mirror { color } => MaterialKind::Mirror { color: self.color(color) },
            desc::MaterialKind::Dielectric(m) => MaterialKind::Dielectric(DielectricMaterial {
                ior: self.ior(&m.ior),
                outside: m.outside_ior.unwrap_or(0.0),
                color: self.color(&m.color),
                specular: self.color(&m.specular),
                roughness: self.roughness(&m.roughness),
                facets: facets(m.facets),
                film: [m.film.thickness_nm, m.film.ior],
                absorption: rgb(m.absorption),
                priority: m.priority,
            }),
            desc::MaterialKind::Conductor(m) => {
                let (n, k) = self.metal(&m.metal);
                MaterialKind::Conductor(ConductorMaterial {
                    n,
                    k,
                    specular: self.color(&m.specular),
                    roughness: self.roughness(&m.roughness),
                    facets: facets(m.facets),
                    film: Film::new(m.film.thickness_nm, m.film.ior),
                })
            }
            desc::MaterialKind::Plastic { color, ior, roughness } => MaterialKind::Plastic {
                color: self.color(color),
                ior: self.ior(ior),
                roughness: self.roughness(roughness),
            },
            desc::MaterialKind::RoughDiffuse { color, roughness } => {
                MaterialKind::RoughDiffuse { color: self.color(color), roughness: self.float(roughness) }
            }
            desc::MaterialKind::DiffuseTransmission { reflectance, transmittance } => {
                MaterialKind::DiffuseTransmission {
                    reflectance: self.color(reflectance),
                    transmittance: self.color(transmittance),
                }
            }
            desc::MaterialKind::Sheen { color, roughness } => {
                MaterialKind::Sheen { color: self.color(color), roughness: self.float(roughness) }
            }
            desc::MaterialKind::ThinDielectric(m) => MaterialKind::ThinDielectric {
                ior: self.ior(&m.ior),
                color: self.color(&m.color),
                specular: self.color(&m.specular),
                roughness: self.roughness(&m.roughness),
            },
            desc::MaterialKind::CoatedDiffuse(m) => {
                MaterialKind::CoatedDiffuse(Box::new(CoatedDiffuseMaterial::new(
                    self.color(&m.color),
                    self.color(&m.specular),
                    self.ior(&m.ior),
                    self.roughness(&m.roughness),
                    facets(m.facets),
                    m.nonlinear,
                    m.depth,
                )))
            }
            desc::MaterialKind::CoatedConductor(m) => {
                let (n, k) = self.metal(&m.metal);
                MaterialKind::CoatedConductor(CoatedConductorMaterial {
                    n,
                    k,
                    roughness: self.roughness(&m.roughness),
                    ior: self.ior(&m.ior),
                    coat_roughness: self.float(&m.coat_roughness),
                    depth: m.depth,
                    facets: facets(m.facets),
                })
            }
            desc::MaterialKind::Principled(m) => MaterialKind::Principled(Box::new(self.principled(m))),
            // Whoever calls has seen to mixes.
            desc::MaterialKind::Mix { .. } => MaterialKind::Black,
        }
    }

    fn principled(&mut self, m: &'d desc::Principled) -> PrincipledMaterial {
        PrincipledMaterial {
            base_color: self.color(&m.base_color),
            metallic: self.float(&m.metallic),
            roughness: self.roughness(&m.roughness),
            ior: self.ior(&m.ior),
            specular: self.float(&m.specular),
            specular_color: self.color(&m.specular_color),
            transmission: self.float(&m.transmission),
            interior: if m.thin { Interior::Thin } else { Interior::Solid },
            diffuse_transmission: self.float(&m.diffuse_transmission),
            sheen_color: self.color(&m.sheen_color),
            sheen_roughness: self.float(&m.sheen_roughness),
            clearcoat: self.float(&m.clearcoat),
            clearcoat_roughness: self.float(&m.clearcoat_roughness),
            film: self.float(&m.film),
            film_thickness_nm: self.float(&m.film_thickness_nm),
            film_ior: m.film_ior,
            absorption: rgb(m.absorption),
            priority: m.priority,
            is_solid: m.is_solid(),
        }
    }

    fn roughness(&mut self, roughness: &'d desc::Roughness) -> RoughnessSource {
        match roughness {
            desc::Roughness::Perceived { roughness, anisotropy } => RoughnessSource::Perceived {
                roughness: self.float(roughness),
                anisotropy: self.float(anisotropy),
            },
            desc::Roughness::Alpha { along, across } => {
                RoughnessSource::Alpha { along: self.float(along), across: self.float(across) }
            }
        }
    }

    fn ior(&mut self, ior: &Ior) -> f32 {
        match ior {
            Ior::Value(n) => *n,
            Ior::Glass(name) => color::named_ior(name).unwrap_or_else(|| {
                self.unknown("unknown-ior", "index of refraction", name);
                1.5
            }),
        }
    }

    fn metal(&mut self, metal: &Metal) -> (Lanes, Lanes) {
        let (n, k) = match metal {
            Metal::Index { n, k } => (*n, *k),
            Metal::Named(name) => color::named_metal(name).unwrap_or_else(|| {
                self.unknown("unknown-metal", "metal", name);
                ([1.0; 3], [1.0; 3])
            }),
        };
        // The unused fourth lane is given the last index, so that nothing is divided by zero there.
        let lanes = |v: [f32; 3]| Lanes(math::Vec4::new(v[0], v[1], v[2], v[2]));
        (lanes(n), lanes(k))
    }

    fn unknown(&mut self, code: &'static str, what: &str, name: &Sourced<String>) {
        self.diagnostics.push(
            Diagnostic::error(code, format!("there is no {what} named `{}`", name.value)).at(name.span),
        );
    }

    fn color(&mut self, color: &'d ColorDesc) -> ColorSource {
        match color {
            ColorDesc::Rgb([r, g, b]) => ColorSource::Constant(Lanes::rgb(*r, *g, *b)),
            ColorDesc::Texture(name) => match self.textures.get(name, Reading::Plain) {
                Some(id) => ColorSource::Texture(id),
                None => ColorSource::Constant(Lanes::ZERO),
            },
        }
    }

    fn float(&mut self, float: &'d FloatDesc) -> FloatSource {
        match float {
            FloatDesc::Value(x) => FloatSource::Constant(*x),
            FloatDesc::Texture(name) => match self.textures.get(name, Reading::Plain) {
                Some(id) => FloatSource::Texture(id),
                None => FloatSource::Constant(0.0),
            },
        }
    }

    /// A texture whose numbers count as they are: a factor on emission, heights.
    pub fn texture(&mut self, name: &'d Sourced<String>) -> Option<u32> {
        self.textures.get(name, Reading::Plain)
    }

    /// Those that were read up to now.
    pub fn textures(&self) -> &[Texture] {
        &self.textures.textures
    }
}

fn rgb([r, g, b]: desc::Triple) -> Lanes {
    Lanes::rgb(r, g, b)
}

fn facets(facets: desc::Facets) -> Facets {
    match facets {
        desc::Facets::Conserving => Facets::Conserving,
        desc::Facets::SingleBounce => Facets::SingleBounce,
        desc::Facets::Separable => Facets::Separable,
        desc::Facets::Beckmann => Facets::Beckmann,
    }
}
