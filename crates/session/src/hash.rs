use std::collections::BTreeSet;
use std::fmt;
use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use scenefile::Sourced;
use scenefile::desc::{
    Film, Group, ImageSource, Light, LightKind, Object, Render, SceneDesc, Shape, Texture,
};

/// What a scene is known by: equal for equal descriptions and equal files, on every machine.
///
/// It covers all that decides the radiance of a pass but the seed: neither the number of passes nor the exposure and
/// view of pictures, and no layout or comment of the scene file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct SceneHash(pub u128);

impl fmt::Display for SceneHash {
    /// 32 hexadecimal digits.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:032x}", self.0)
    }
}

/// The hash of a description and of the files that it names: FNV-1a with 128 bits (Fowler, Noll & Vo 1991). Not
/// proof against forgery.
///
/// Cost: reads every file once, about 0.3 GB/s.
///
/// # Errors
/// Where a file cannot be read; the message has its path.
pub fn scene_hash(desc: &SceneDesc) -> Result<SceneHash, String> {
    let mut hash = Fnv::new();
    hash.update(scenefile::to_toml(&without_arrays(desc)).as_bytes());
    for object in all_objects(desc) {
        hash_arrays(&mut hash, &object.shape);
    }
    for image in desc.textures.values().filter_map(picture).chain(desc.lights.iter().filter_map(slide)) {
        if let ImageSource::Embedded(image) = image {
            hash.update(&image.bytes);
        }
    }
    for file in files(desc) {
        let path = desc.resolve(file);
        hash.update(&[0]);
        hash_file(&mut hash, &path).map_err(|e| format!("{} cannot be read: {e}", path.display()))?;
    }
    Ok(SceneHash(hash.0))
}

/// The description without what does not decide the radiance of a pass.
pub(crate) fn canonical(desc: &SceneDesc) -> SceneDesc {
    with_plain_settings(desc.clone())
}

fn with_plain_settings(desc: SceneDesc) -> SceneDesc {
    let (film, render) = (Film::default(), Render::default());
    SceneDesc {
        base: PathBuf::new(),
        render: Render { passes: render.passes, seed: render.seed, noise: render.noise, ..desc.render },
        film: Film {
            exposure: film.exposure,
            white_balance: film.white_balance,
            view: film.view,
            lut: film.lut,
            denoise: film.denoise,
            ..desc.film
        },
        ..desc
    }
}

/// [`canonical`] without the vertices and triangles of meshes in place, which may be many.
fn without_arrays(desc: &SceneDesc) -> SceneDesc {
    let plain = |object: &Sourced<Object>| {
        let shape = match &object.shape.value {
            Shape::Triangles { normals, .. } => Shape::Triangles {
                positions: Vec::new(),
                indices: Vec::new(),
                vertex_normals: Vec::new(),
                uvs: Vec::new(),
                uvs2: Vec::new(),
                colors: Vec::new(),
                normals: *normals,
            },
            shape => shape.clone(),
        };
        Object {
            name: object.name.clone(),
            shape: shape.into(),
            material: object.material.clone(),
            transform: object.transform.clone(),
            displacement: object.displacement.clone(),
            flip_normals: object.flip_normals,
            emission: object.emission.clone(),
            light_group: object.light_group.clone(),
        }
        .into()
    };
    let group = |group: &Group| Group { objects: group.objects.iter().map(plain).collect() };
    with_plain_settings(SceneDesc {
        base: PathBuf::new(),
        render: desc.render.clone(),
        film: desc.film.clone(),
        camera: desc.camera.clone(),
        photon_map: desc.photon_map.clone(),
        sppm: desc.sppm.clone(),
        vcm: desc.vcm.clone(),
        textures: desc.textures.clone(),
        materials: desc.materials.clone(),
        objects: desc.objects.iter().map(plain).collect(),
        lights: desc.lights.clone(),
        groups: desc.groups.iter().map(|(name, g)| (name.clone(), group(g).into())).collect(),
        instances: desc.instances.clone(),
    })
}

/// The numbers of a mesh in place, each list after its length.
fn hash_arrays(hash: &mut Fnv, shape: &Shape) {
    let Shape::Triangles { positions, indices, vertex_normals, uvs, uvs2, colors, .. } = shape else {
        return;
    };
    hash.numbers(positions.as_flattened(), f32::to_bits);
    hash.numbers(indices.as_flattened(), |i| i);
    hash.numbers(vertex_normals.as_flattened(), f32::to_bits);
    for uvs in [uvs, uvs2] {
        hash.numbers(uvs.as_flattened(), f32::to_bits);
    }
    hash.numbers(colors.as_flattened(), f32::to_bits);
}

fn all_objects(desc: &SceneDesc) -> impl Iterator<Item = &Sourced<Object>> {
    desc.objects.iter().chain(desc.groups.values().flat_map(|group| &group.objects))
}

fn picture(texture: &Sourced<Texture>) -> Option<&ImageSource> {
    match &texture.value {
        Texture::Image(image) => Some(&image.source),
        _ => None,
    }
}

fn slide(light: &Sourced<Light>) -> Option<&ImageSource> {
    match &light.kind {
        LightKind::Sky { source, .. }
        | LightKind::Goniometric { source, .. }
        | LightKind::Projector { source, .. } => Some(source),
        _ => None,
    }
}

/// The files that a description names, each once, in order of their names.
pub(crate) fn files(desc: &SceneDesc) -> BTreeSet<&Path> {
    let pictures = desc.textures.values().filter_map(picture).chain(desc.lights.iter().filter_map(slide));
    let pictures = pictures.filter_map(ImageSource::file).map(|file| file.value.as_path());
    let meshes = all_objects(desc).filter_map(|object| object.shape.file()).map(|file| file.value.as_path());
    let lamps = desc.lights.iter().filter_map(|light| match &light.kind {
        LightKind::Profile { file, .. } => Some(file.value.as_path()),
        _ => None,
    });
    pictures.chain(meshes).chain(lamps).collect()
}

/// The hash of what is in a file, as of a scene.
pub(crate) fn file_hash(path: &Path) -> io::Result<SceneHash> {
    let mut hash = Fnv::new();
    hash_file(&mut hash, path)?;
    Ok(SceneHash(hash.0))
}

fn hash_file(hash: &mut Fnv, path: &Path) -> io::Result<()> {
    let mut file = File::open(path)?;
    let mut buffer = vec![0; 1 << 16];
    loop {
        match file.read(&mut buffer) {
            Ok(0) => return Ok(()),
            Ok(n) => hash.update(&buffer[..n]),
            Err(e) if e.kind() == io::ErrorKind::Interrupted => {}
            Err(e) => return Err(e),
        }
    }
}

/// FNV-1a, 128 bits.
struct Fnv(u128);

impl Fnv {
    const BASIS: u128 = 0x6c62_272e_07bb_0142_62b8_2175_6295_c58d;
    const PRIME: u128 = (1 << 88) + 0x13b;

    fn new() -> Self {
        Self(Self::BASIS)
    }

    fn numbers<T: Copy>(&mut self, list: &[T], bits: impl Fn(T) -> u32) {
        self.update(&(list.len() as u64).to_le_bytes());
        list.iter().for_each(|x| self.update(&bits(*x).to_le_bytes()));
    }

    fn update(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.0 = (self.0 ^ u128::from(byte)).wrapping_mul(Self::PRIME);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use scenefile::desc::{Material, Object, Triple};

    fn fnv(text: &str) -> u128 {
        let mut hash = Fnv::new();
        hash.update(text.as_bytes());
        hash.0
    }

    #[test]
    fn published_values() {
        assert_eq!(fnv(""), 0x6c62_272e_07bb_0142_62b8_2175_6295_c58d);
        assert_eq!(fnv("a"), 0xd228_cb69_6f1a_8caf_7891_2b70_4e4a_8964);
        assert_eq!(fnv("foobar"), 0x343e_1662_793c_64bf_6f0d_3597_ba44_6f18);
    }

    #[test]
    fn the_hash_follows_what_decides_the_radiance() {
        let center: Triple = [0.0; 3];
        let mut desc = SceneDesc::default();
        desc.objects.push(Object::new(Shape::Sphere { center, radius: 1.0 }, Material::diffuse(0.5)).into());
        let hash = scene_hash(&desc).unwrap();
        assert_eq!(hash.to_string().len(), 32);

        let mut same = desc.clone();
        same.base = PathBuf::from("elsewhere");
        same.render.passes += 1;
        same.render.seed += 1;
        same.render.noise = Some(0.01);
        same.film.exposure = color::Exposure::Ev(3.0);
        same.film.view = color::ViewTransform::FalseColour;
        same.film.lut = Some(PathBuf::from("a.cube").into());
        assert_eq!(scene_hash(&same).unwrap(), hash);

        let mut brighter = desc.clone();
        brighter.objects[0].material = Some(Material::diffuse(0.6).into());
        let mut larger = desc.clone();
        larger.film.size[0] += 1;
        let mut more = desc.clone();
        more.photon_map.photons += 1;
        let mut hashes = vec![hash];
        for other in [&brighter, &larger, &more] {
            let other = scene_hash(other).unwrap();
            assert!(!hashes.contains(&other));
            hashes.push(other);
        }
    }

    #[test]
    fn files_count_by_what_is_in_them() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a.obj");
        let mut desc = SceneDesc { base: folder.path().to_owned(), ..SceneDesc::default() };
        let mesh = Shape::Mesh { file: "a.obj".into(), normals: Default::default() };
        desc.objects.push(Object::new(mesh, Material::diffuse(0.5)).into());
        let missing = scene_hash(&desc).unwrap_err();
        assert!(missing.contains("a.obj"), "{missing}");
        std::fs::write(&file, "v 0 0 0\n").unwrap();
        let hash = scene_hash(&desc).unwrap();
        std::fs::write(&file, "v 0 0 1\n").unwrap();
        assert_ne!(scene_hash(&desc).unwrap(), hash);
    }
}
