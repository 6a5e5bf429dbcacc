//! glTF files made here, and what becomes of them.
#![allow(clippy::unwrap_used, reason = "helpers of tests, too")]

use std::path::{Path, PathBuf};

use nephroid_import::{load, strict};
use scenefile::desc::{
    CameraKind, Channel, ColorDesc, EmissionAmount, FloatDesc, ImageSource, Ior, LightKind, Mapping,
    Material, MaterialKind, MaterialRef, Object, PointAmount, Principled, Roughness, SceneDesc, Shape,
    Texture, TransformStep, Wrap,
};
use scenefile::{Loaded, Severity};
use tempfile::TempDir;

/// A folder for the files of a test.
struct Files(TempDir);

impl Files {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn write(&self, name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
        let path = self.0.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        path
    }

    /// Without a ground, so that objects are those of the file.
    fn load(&self, text: &str) -> Loaded {
        load(&self.write("scene.gltf", text), &["stage.ground=false".into()])
    }
}

/// A little-endian buffer and the views and accessors of it.
#[derive(Default)]
struct Bin {
    bytes: Vec<u8>,
    views: Vec<String>,
    accessors: Vec<String>,
}

impl Bin {
    fn view(&mut self, bytes: &[u8], more: &str) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let at = self.bytes.len();
        self.bytes.extend(bytes);
        self.views.push(format!("{{\"buffer\":0,\"byteOffset\":{at},\"byteLength\":{}{more}}}", bytes.len()));
        self.views.len() - 1
    }

    fn add(&mut self, bytes: &[u8], component: u32, kind: &str, count: usize, more: &str) -> usize {
        let view = self.view(bytes, "");
        self.accessors.push(format!(
            "{{\"bufferView\":{view},\"componentType\":{component},\"type\":\"{kind}\",\"count\":{count}{more}}}"
        ));
        self.accessors.len() - 1
    }

    fn floats(&mut self, kind: &str, width: usize, values: &[f32]) -> usize {
        let bytes: Vec<u8> = values.iter().flat_map(|x| x.to_le_bytes()).collect();
        self.add(&bytes, 5126, kind, values.len() / width, "")
    }

    fn vec3(&mut self, values: &[f32]) -> usize {
        self.floats("VEC3", 3, values)
    }

    /// Everything but the nodes, with a triangle as mesh 0 if there is no other.
    fn scene(&self, rest: &str) -> String {
        let data = base64(&self.bytes);
        format!(
            "{{\"asset\":{{\"version\":\"2.0\"}},\"buffers\":[{{\"byteLength\":{},\"uri\":\"data:application/octet-stream;base64,{data}\"}}],\
             \"bufferViews\":[{}],\"accessors\":[{}],{rest}}}",
            self.bytes.len(),
            self.views.join(","),
            self.accessors.join(",")
        )
    }
}

fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut out = String::new();
    for three in bytes.chunks(3) {
        let bits = three.iter().enumerate().fold(0u32, |bits, (i, b)| bits | u32::from(*b) << (16 - 8 * i));
        for i in 0..4 {
            let digit = if i <= three.len() { DIGITS[(bits >> (18 - 6 * i) & 63) as usize] } else { b'=' };
            out.push(char::from(digit));
        }
    }
    out
}

const TRIANGLE: [f32; 9] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];

/// A triangle under one material.
fn with_material(material: &str, rest: &str) -> String {
    let mut bin = Bin::default();
    bin.vec3(&TRIANGLE);
    bin.floats("VEC2", 2, &[0.0, 0.0, 1.0, 0.0, 0.0, 1.0]);
    bin.scene(&format!(
        "\"nodes\":[{{\"mesh\":0}}],\"meshes\":[{{\"primitives\":[{{\"attributes\":{{\"POSITION\":0,\"TEXCOORD_0\":1}},\"material\":0}}]}}],\
         \"materials\":[{material}]{rest}"
    ))
}

const PICTURES: &str = r#","textures":[{"source":0},{"source":0,"sampler":0}],"images":[{"uri":"a%20b.png"}],
    "samplers":[{"wrapS":33071,"wrapT":33648}]"#;

fn good(loaded: Loaded) -> SceneDesc {
    assert!(loaded.diagnostics.iter().all(|d| d.severity == Severity::Note), "{}", loaded.render());
    loaded.desc.unwrap()
}

fn warned(loaded: Loaded, what: &str) -> SceneDesc {
    let said = loaded.render();
    assert!(said.contains(what) && said.contains("scene.gltf:"), "{said}");
    loaded.desc.unwrap_or_else(|| panic!("{said}"))
}

fn refused(loaded: &Loaded, what: &str) {
    assert!(loaded.desc.is_none());
    assert!(loaded.render().contains(what), "{} lacks {what}", loaded.render());
}

type Mesh<'a> = (&'a [[f32; 3]], &'a [[u32; 3]], &'a [[f32; 3]], &'a [[f32; 2]], &'a [[f32; 4]]);

fn mesh(object: &Object) -> Mesh<'_> {
    match &object.shape.value {
        Shape::Triangles { positions, indices, vertex_normals, uvs, colors, .. } => {
            (positions, indices, vertex_normals, uvs, colors)
        }
        other => panic!("{other:?}"),
    }
}

fn material<'d>(desc: &'d SceneDesc, object: &Object) -> &'d Material {
    match &object.material {
        Some(MaterialRef::Named(name)) => &desc.materials[&name.value],
        other => panic!("{other:?}"),
    }
}

fn principled(desc: &SceneDesc) -> &Principled {
    match &material(desc, &desc.objects[0]).kind {
        MaterialKind::Principled(p) => p,
        other => panic!("{other:?}"),
    }
}

fn texture<'d>(desc: &'d SceneDesc, color: &ColorDesc) -> &'d Texture {
    &desc.textures[&color.named().unwrap().value]
}

fn number<'d>(desc: &'d SceneDesc, float: &FloatDesc) -> &'d Texture {
    &desc.textures[&float.named().unwrap().value]
}

#[test]
fn a_triangle_framed_and_lit() {
    let mut bin = Bin::default();
    bin.vec3(&TRIANGLE);
    let files = Files::new();
    let path = files.write(
        "scene.gltf",
        bin.scene("\"nodes\":[{\"mesh\":0,\"name\":\"leaf\"}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}]"),
    );
    // Notes are no doubts.
    let desc = good(strict(load(&path, &[])));
    let object = &desc.objects[0];
    assert_eq!(object.name.as_deref(), Some("leaf"));
    assert_eq!(mesh(object).0, [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    assert_eq!(mesh(object).1, [[0, 1, 2]]);
    assert!(object.span.is_some());
    assert!(desc.camera.is_some());
    assert!(matches!(desc.lights[0].kind, LightKind::Sky { .. }));
    let p = principled(&desc);
    assert_eq!((&p.metallic, &p.roughness), (&FloatDesc::Value(1.0), &Roughness::from(1.0)));
}

#[test]
fn a_camera_of_its_own_shows_no_ground() {
    let mut bin = Bin::default();
    bin.vec3(&TRIANGLE);
    let rest = r#""nodes":[{"mesh":0},{"camera":0,"translation":[0,0,5]}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
        "cameras":[{"type":"perspective","perspective":{"yfov":1,"znear":0.1}}]"#;
    let files = Files::new();
    let path = files.write("scene.gltf", bin.scene(rest));
    let desc = good(load(&path, &[]));
    assert_eq!((desc.objects.len(), desc.lights.len()), (1, 3));
    assert_eq!(good(load(&path, &["stage.ground=true".into()])).objects.len(), 2);
    assert_eq!(desc.camera.unwrap().position, [0.0, 0.0, 5.0]);
}

#[test]
fn binary_files() {
    let json = r#"{"asset":{"version":"2.0"},"buffers":[{"byteLength":36}],"bufferViews":[{"buffer":0,"byteLength":36}],
        "accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":3}],
        "nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}]}"#;
    let mut json = json.as_bytes().to_vec();
    json.resize(json.len().next_multiple_of(4), b' ');
    let data: Vec<u8> = TRIANGLE.iter().flat_map(|x| x.to_le_bytes()).collect();
    let glb = |json: &[u8], data: &[u8]| {
        let chunk =
            |kind: &[u8; 4], bytes: &[u8]| [&(bytes.len() as u32).to_le_bytes()[..], kind, bytes].concat();
        let body = [chunk(b"JSON", json), chunk(b"BIN\0", data)].concat();
        [&b"glTF\x02\0\0\0"[..], &(body.len() as u32 + 12).to_le_bytes(), &body].concat()
    };
    let files = Files::new();
    let read = |bytes: &[u8]| load(&files.write("a.GLB", bytes), &[]);
    let whole = glb(&json, &data);
    assert_eq!(mesh(&good(read(&whole)).objects[0]).0.len(), 3);
    refused(&read(&glb(&json, &data[..32])), "cut off: it has 32 of its 36 bytes");
    refused(&read(&glb(&json[..80], &data)), "syntax");
    let mut old = whole.clone();
    old[4] = 1;
    refused(&read(&old), "version 1");
    // Whatever is changed, there is a scene or a diagnostic, and no panic.
    let mut number = 1u64;
    for _ in 0..600 {
        let mut bytes = whole.clone();
        for _ in 0..=number % 3 {
            number = number.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let at = (number >> 33) as usize % bytes.len();
            let by = b"0129-,.\"{}[]\x00\xff5e";
            bytes[at] = by[(number >> 20) as usize % by.len()];
        }
        let loaded = read(&bytes);
        assert!(loaded.desc.is_some() || !loaded.diagnostics.is_empty());
    }
    // Whatever is cut off, there is an error and no more.
    for end in 0..whole.len() {
        assert!(read(&whole[..end]).desc.is_none(), "{end}");
    }
}

#[test]
fn nodes_place_meshes() {
    let mut bin = Bin::default();
    bin.vec3(&TRIANGLE);
    let nodes = r#"[{"children":[1],"translation":[1,2,3],"rotation":[0,0,0.7071067811865476,0.7071067811865476]},
        {"mesh":0,"scale":[2,2,2]}, {"mesh":1,"matrix":[1,0,0,0, 0,1,0,0, 0,0,-1,0, 4,5,6,1]}, {"mesh":2}]"#;
    let prim = "{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}";
    let rest = format!(
        "\"scene\":1,\"scenes\":[{{\"nodes\":[3]}},{{\"nodes\":[0,2]}}],\"nodes\":{nodes},\"meshes\":[{prim},{prim},{prim}]"
    );
    let desc = good(Files::new().load(&bin.scene(&rest)));
    assert_eq!(desc.objects.len(), 2);
    let steps = |i: usize| match desc.objects[i].transform[..] {
        [TransformStep::Matrix(m)] => m,
        ref other => panic!("{other:?}"),
    };
    let close = |m: [f32; 16], wanted: [f32; 16]| m.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-6);
    assert!(
        close(steps(0), [0., -2., 0., 1., 2., 0., 0., 2., 0., 0., 2., 3., 0., 0., 0., 1.]),
        "{:?}",
        steps(0)
    );
    assert!(close(steps(1), [1., 0., 0., 4., 0., 1., 0., 5., 0., 0., -1., 6., 0., 0., 0., 1.]));
}

#[test]
fn points_beyond_all_numbers_are_refused() {
    let mut bin = Bin::default();
    let far = bin.vec3(&[0.0, 0.0, 0.0, 1e30, 0.0, 0.0, 0.0, 1e30, 0.0]);
    let text = bin.scene(&format!(
        "\"scenes\":[{{\"nodes\":[0]}}],\"nodes\":[{{\"mesh\":0,\"scale\":[1e20,1e20,0]}}],\
         \"meshes\":[{{\"primitives\":[{{\"attributes\":{{\"POSITION\":{far}}}}}]}}]"
    ));
    refused(&Files::new().load(&text), "not placed at finite points");
}

#[test]
fn shared_meshes_are_instances() {
    let mut bin = Bin::default();
    bin.vec3(&TRIANGLE);
    bin.vec3(&[0.0, 0.0, 0.0, 0.0, 5.0, 0.0]);
    bin.add(&[0, 0, 0, 127, 0, 127, 0, 0], 5120, "VEC4", 2, ",\"normalized\":true");
    let rest = r#""extensionsRequired":["EXT_mesh_gpu_instancing"],"extensionsUsed":["EXT_mesh_gpu_instancing"],"nodes":[{"mesh":0},{"mesh":0,"scale":[1,1,0]},
        {"mesh":0,"translation":[1,0,0],"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":1,"ROTATION":2}}}}],
        "meshes":[{"name":"m","primitives":[{"attributes":{"POSITION":0}}]}]"#;
    let desc = good(Files::new().load(&bin.scene(rest)));
    assert_eq!(desc.groups["m"].objects.len(), 1);
    let moves: Vec<Option<[f32; 3]>> = desc
        .instances
        .iter()
        .map(|i| match i.transform[..] {
            [TransformStep::Matrix(m)] => Some([m[3], m[7], m[11]]),
            _ => None,
        })
        .collect();
    assert_eq!(moves, [None, Some([1.0, 0.0, 0.0]), Some([1.0, 5.0, 0.0])]);
    // Half a turn about y.
    assert!(
        matches!(desc.instances[2].transform[..], [TransformStep::Matrix(m)] if (m[0] + 1.0).abs() < 1e-6 && (m[10] + 1.0).abs() < 1e-6)
    );
    // A flat placement has no volume, but its triangles stay.
    assert_eq!(desc.objects.len(), 1);
    assert!(desc.objects[0].transform.is_empty());
}

#[test]
fn columns_of_every_kind() {
    let mut bin = Bin::default();
    // Four vertices, of which the last is replaced; indices in bytes; colours and coordinates as normalised integers.
    let mut points = TRIANGLE.to_vec();
    points.extend([9.0, 9.0, 9.0]);
    let at = bin.vec3(&points);
    let view = bin.view(&[3], "");
    let values: Vec<u8> = [1.0f32, 1.0, 0.0].iter().flat_map(|x| x.to_le_bytes()).collect();
    let values = bin.view(&values, "");
    let last = bin.accessors[at].trim_end_matches('}').to_owned();
    bin.accessors[at] = format!(
        "{last},\"sparse\":{{\"count\":1,\"indices\":{{\"bufferView\":{view},\"componentType\":5121}},\"values\":{{\"bufferView\":{values}}}}}}}"
    );
    let uvs = bin.add(
        &[0, 0, 0, 0, 255, 0, 0, 0, 0, 255, 0, 0, 255, 255, 0, 0],
        5121,
        "VEC2",
        4,
        ",\"normalized\":true",
    );
    bin.views[uvs + 2] = bin.views[uvs + 2].replace('}', ",\"byteStride\":4}");
    bin.add(
        &[0, 0, 255, 255, 255, 255, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0],
        5123,
        "VEC3",
        4,
        ",\"normalized\":true",
    );
    bin.add(&[0, 1, 2, 3], 5121, "SCALAR", 4, "");
    bin.add(
        &[0, 0, 127, 0, 0, 0, 127, 0, 0, 0, 127, 0, 0, 0, 127, 0],
        5120,
        "VEC3",
        4,
        ",\"normalized\":true",
    );
    bin.views[6] = bin.views[6].replace('}', ",\"byteStride\":4}");
    let rest = r#""nodes":[{"mesh":0}],"meshes":[{"primitives":[{"mode":5,"indices":3,
        "attributes":{"POSITION":0,"TEXCOORD_0":1,"COLOR_0":2,"NORMAL":4}}]}]"#;
    let desc = good(Files::new().load(&bin.scene(rest)));
    let (positions, indices, normals, uvs, colors) = mesh(&desc.objects[0]);
    assert_eq!(positions[3], [1.0, 1.0, 0.0]);
    assert_eq!(indices, [[0, 1, 2], [2, 1, 3]]);
    assert_eq!(normals[2], [0.0, 0.0, 1.0]);
    // v points up here.
    assert_eq!(uvs, [[0.0, 1.0], [1.0, 1.0], [0.0, 0.0], [1.0, 0.0]]);
    assert_eq!(colors[0], [0.0, 1.0, 1.0, 1.0]);
    // Vertex colours are a factor.
    assert_eq!(
        texture(&desc, &principled(&desc).base_color),
        &Texture::VertexColor { channel: Channel::Rgb }
    );
}

#[test]
fn materials_in_full() {
    let json = r#"{"name":"all","doubleSided":true,
        "pbrMetallicRoughness":{"baseColorFactor":[0.5,0.25,1,0.75],"baseColorTexture":{"index":0,"texCoord":0},
            "metallicFactor":0.5,"roughnessFactor":0.25,"metallicRoughnessTexture":{"index":1}},
        "normalTexture":{"index":0,"scale":2},"emissiveFactor":[1,0.5,0],"emissiveTexture":{"index":0},"alphaMode":"MASK","alphaCutoff":0.25,
        "extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":4}}}"#;
    let files = Files::new();
    files.write("a b.png", b"\x89PNG");
    let loaded = files.load(&with_material(json, PICTURES));
    let desc = warned(loaded, "the transparency of a surface that shines");
    let p = principled(&desc);
    let Texture::Image(base) = texture(&desc, &p.base_color) else { panic!() };
    assert_eq!((base.factor, base.channel), ([0.5, 0.25, 1.0], Channel::Rgb));
    assert!(matches!(&base.source, ImageSource::File(file) if file.value == Path::new("a b.png")));
    let Roughness::Perceived { roughness, .. } = &p.roughness else { panic!() };
    let Texture::Image(roughness) = number(&desc, roughness) else { panic!() };
    assert_eq!((roughness.factor[0], roughness.channel), (0.25, Channel::Green));
    assert_eq!(roughness.wrap, [Wrap::Clamp, Wrap::Mirror]);
    let Texture::Image(metal) = number(&desc, &p.metallic) else { panic!() };
    assert_eq!((metal.factor[0], metal.channel), (0.5, Channel::Blue));
    let made = material(&desc, &desc.objects[0]);
    let Texture::Image(alpha) = number(&desc, &made.opacity) else { panic!() };
    assert_eq!((alpha.factor[0], alpha.channel, made.opacity_cutoff), (0.75, Channel::Alpha, Some(0.25)));
    assert_eq!(made.normal_strength, 2.0);
    assert!(made.normal_map.is_some());
    let emission = desc.objects[0].emission.as_ref().unwrap();
    assert_eq!(emission.amount, EmissionAmount::Radiance([4.0, 2.0, 0.0]));
    assert!(emission.two_sided && emission.texture.is_some());
    // What shines brighter than white is light enough.
    assert!(desc.lights.is_empty());
}

#[test]
fn extensions_of_materials() {
    let json = r#"{"extensions":{
        "KHR_materials_transmission":{"transmissionFactor":0.5},
        "KHR_materials_volume":{"thicknessFactor":1,"attenuationColor":[0.5,1,0],"attenuationDistance":2},
        "KHR_materials_ior":{"ior":1.33},
        "KHR_materials_specular":{"specularFactor":0.5,"specularColorFactor":[1,0.5,0.25]},
        "KHR_materials_clearcoat":{"clearcoatFactor":0.75,"clearcoatRoughnessFactor":0.1},
        "KHR_materials_sheen":{"sheenColorFactor":[0.1,0.2,0.3],"sheenRoughnessFactor":0.4},
        "KHR_materials_iridescence":{"iridescenceFactor":1,"iridescenceIor":1.8,"iridescenceThicknessMaximum":500},
        "KHR_materials_anisotropy":{"anisotropyStrength":0.5,"anisotropyRotation":1.5707963267948966}},
        "pbrMetallicRoughness":{"metallicFactor":0,"roughnessFactor":0.5}}"#;
    let desc = good(Files::new().load(&with_material(json, "")));
    let p = principled(&desc);
    assert!(!p.thin && p.transmission == FloatDesc::Value(0.5));
    assert!(
        (p.absorption[0] - 0.5 * 2f32.ln()).abs() < 1e-6
            && p.absorption[1] == 0.0
            && p.absorption[2].is_finite()
    );
    assert_eq!(p.ior, Ior::Value(1.33));
    assert_eq!((&p.specular, &p.specular_color), (&FloatDesc::Value(0.5), &ColorDesc::Rgb([1.0, 0.5, 0.25])));
    assert_eq!((&p.clearcoat, &p.clearcoat_roughness), (&FloatDesc::Value(0.75), &FloatDesc::Value(0.1)));
    assert_eq!(
        (&p.sheen_color, &p.sheen_roughness),
        (&ColorDesc::Rgb([0.1, 0.2, 0.3]), &FloatDesc::Value(0.4))
    );
    assert_eq!(
        (&p.film, p.film_ior, &p.film_thickness_nm),
        (&FloatDesc::Value(1.0), 1.8, &FloatDesc::Value(500.0))
    );
    // α across the grain is 1/4, along it a quarter of the way from there to 1.
    let Roughness::Alpha { along: FloatDesc::Value(along), across: FloatDesc::Value(across) } = p.roughness
    else {
        panic!()
    };
    assert!((along - 0.4375).abs() < 1e-6 && (across - 0.25).abs() < 1e-6, "{along} {across}");
    let FloatDesc::Value(turn) = material(&desc, &desc.objects[0]).rotation else { panic!() };
    assert!((turn - 90.0).abs() < 1e-4);

    let thin = with_material(r#"{"extensions":{"KHR_materials_transmission":{"transmissionFactor":1}}}"#, "");
    assert!(principled(&good(Files::new().load(&thin))).thin);
    let rainbow = with_material(r#"{"extensions":{"KHR_materials_dispersion":{"dispersion":0.1}}}"#, "");
    warned(Files::new().load(&rainbow), "dispersion is not rendered");
    let unlit = with_material(
        r#"{"extensions":{"KHR_materials_unlit":{}},"pbrMetallicRoughness":{"baseColorFactor":[0.1,0.2,0.3,1]}}"#,
        "",
    );
    let desc = good(Files::new().load(&unlit));
    let emission = desc.objects[0].emission.as_ref().unwrap();
    assert_eq!(emission.amount, EmissionAmount::Radiance([0.1, 0.2, 0.3]));
}

/// Where a texture with a change of coordinates puts a point, by the formula of the extension, v down.
fn transformed([u, v]: [f64; 2], scale: [f64; 2], angle: f64, offset: [f64; 2]) -> [f64; 2] {
    let (s, c) = angle.sin_cos();
    let (u, v) = (u * scale[0], v * scale[1]);
    [c * u + s * v + offset[0], -s * u + c * v + offset[1]]
}

#[test]
fn texture_coordinates_change_as_the_extension_says() {
    let files = Files::new();
    files.write("a b.png", b"\x89PNG");
    let (scale, angle, offset) = ([2.0, -0.5], 0.7, [0.25, 0.125]);
    let json = format!(
        r#"{{"pbrMetallicRoughness":{{"baseColorTexture":{{"index":0,"texCoord":1,"extensions":{{"KHR_texture_transform":
        {{"offset":[{},{}],"scale":[{},{}],"rotation":{angle},"texCoord":0}}}}}}}}}}"#,
        offset[0], offset[1], scale[0], scale[1]
    );
    let desc = good(files.load(&with_material(&json, PICTURES)));
    let Texture::Image(image) = texture(&desc, &principled(&desc).base_color) else { panic!() };
    let Mapping::Uv { set: 0, scale: s, rotation, offset: o } = image.mapping else { panic!() };
    for point in [[0.0, 0.0], [1.0, 0.0], [0.3, 0.8]] {
        let wanted = transformed(point, scale, angle, offset);
        // Ours: scaled, turned from u toward v, moved; v up on both sides.
        let (u, v) = (point[0] * f64::from(s[0]), (1.0 - point[1]) * f64::from(s[1]));
        let (sine, cosine) = f64::from(rotation).to_radians().sin_cos();
        let ours = [cosine * u - sine * v + f64::from(o[0]), sine * u + cosine * v + f64::from(o[1])];
        assert!(
            (ours[0] - wanted[0]).abs() < 1e-6 && (1.0 - ours[1] - wanted[1]).abs() < 1e-6,
            "{ours:?} {wanted:?}"
        );
    }
}

#[test]
fn embedded_images() {
    let files = Files::new();
    let png = base64(b"\x89PNG and so on");
    let rest = format!(
        r#","textures":[{{"source":0}},{{"source":1}}],"images":[{{"name":"x/../y","uri":"data:image/png;base64,{png}"}},
        {{"name":"x/../y","mimeType":"image/jpeg","bufferView":0}}]"#
    );
    let json =
        r#"{"pbrMetallicRoughness":{"baseColorTexture":{"index":0},"metallicRoughnessTexture":{"index":1}}}"#;
    let desc = warned(files.load(&with_material(json, &rest)), "an image of no known format");
    let Texture::Image(image) = texture(&desc, &principled(&desc).base_color) else { panic!() };
    let ImageSource::Embedded(image) = &image.source else { panic!() };
    assert_eq!((image.name.as_str(), &image.bytes[..]), ("x____y.png", &b"\x89PNG and so on"[..]));
}

#[test]
fn cameras_and_lights() {
    let mut bin = Bin::default();
    bin.vec3(&TRIANGLE);
    let rest = r#""nodes":[{"mesh":0},{"camera":0,"translation":[0,0,5]},{"camera":1},
        {"extensions":{"KHR_lights_punctual":{"light":0}},"translation":[1,2,3],"rotation":[-0.7071067811865476,0,0,0.7071067811865476]},
        {"extensions":{"KHR_lights_punctual":{"light":1}}},{"extensions":{"KHR_lights_punctual":{"light":2}}}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
        "cameras":[{"type":"perspective","perspective":{"yfov":1,"aspectRatio":2,"znear":0.1}},
            {"type":"orthographic","orthographic":{"xmag":2,"ymag":1,"zfar":9,"znear":0}}],
        "extensions":{"KHR_lights_punctual":{"lights":[
            {"type":"spot","intensity":10,"color":[1,0.5,0],"spot":{"innerConeAngle":0.5,"outerConeAngle":1}},
            {"type":"directional","intensity":3},{"type":"point","range":7}]}}"#;
    let desc = warned(Files::new().load(&bin.scene(rest)), "a light's range");
    let camera = desc.camera.as_ref().unwrap();
    assert_eq!((camera.position, camera.look_at), ([0.0, 0.0, 5.0], [0.0, 0.0, 4.0]));
    assert!((camera.fov - 1f32.to_degrees()).abs() < 1e-4);
    assert_eq!(desc.film.size, [1200, 600]);
    let LightKind::Spot { position, direction, cone_angle, falloff_angle, amount } = desc.lights[0].kind
    else {
        panic!()
    };
    let amount_at = |cd: f64| (cd / 683.0) as f32;
    let expected = PointAmount::Intensity([amount_at(10.0), amount_at(5.0), 0.0]);
    assert_eq!((position, amount), ([1.0, 2.0, 3.0], expected));
    assert!(
        (direction[1] + 1.0).abs() < 1e-6
            && (cone_angle - 57.29578).abs() < 1e-4
            && (falloff_angle - 28.64789).abs() < 1e-4
    );
    assert!(
        matches!(desc.lights[1].kind, LightKind::Directional { direction, irradiance } if direction == [0.0, 0.0, -1.0] && irradiance == [amount_at(3.0); 3])
    );
    assert!(matches!(desc.lights[2].kind, LightKind::Point { .. }));
    let flat = rest.replace("\"camera\":0", "\"camera\":1");
    let desc = warned(Files::new().load(&bin.scene(&flat)), "a light's range");
    assert_eq!(desc.camera.as_ref().unwrap().kind, CameraKind::Orthographic { extent: 2.0 });
}

#[test]
fn what_shines_keeps_to_the_lamps_of_its_exporter() {
    let mut bin = Bin::default();
    bin.vec3(&TRIANGLE);
    let scene = |generator: &str, lamps: &str| {
        let rest = format!(
            r#""nodes":[{{"mesh":0}}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"material":0}}]}}],
            "materials":[{{"emissiveFactor":[1,0.5,0],"extensions":{{"KHR_materials_emissive_strength":
            {{"emissiveStrength":20}}}}}}],"extensions":{{"KHR_lights_punctual":{{"lights":[{lamps}]}}}}"#
        );
        let text = bin
            .scene(&rest)
            .replace(r#""version":"2.0""#, &format!(r#""version":"2.0","generator":"{generator}""#));
        assert!(text.contains("generator"));
        let loaded = Files::new().load(&text);
        let desc = loaded.desc.unwrap();
        let emission = desc.objects[0].emission.as_ref().unwrap();
        emission.amount
    };
    let radiance = |x: f64| EmissionAmount::Radiance([x, x / 2.0, 0.0].map(|x| x as f32));
    let lamp = r#"{"type":"point","intensity":54351.413}"#;
    assert_eq!(scene("Khronos glTF Blender I/O v4.5.51", lamp), radiance(20.0));
    assert_eq!(scene("by hand", lamp), radiance(20.0 / 683.0));
    assert_eq!(scene("by hand", ""), radiance(20.0));
}

#[test]
fn spots_of_blender_have_its_edge() {
    // A cone of 60° with a blend of 0.3 as Blender 4.5 writes it: light rises from cos 30° = 0.866 over 0.3 · (1 − 0.866).
    let mut bin = Bin::default();
    bin.vec3(&TRIANGLE);
    let rest = r#""nodes":[{"mesh":0},{"extensions":{"KHR_lights_punctual":{"light":0}}}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"extensions":{"KHR_lights_punctual":{"lights":[{"type":"spot",
        "intensity":54351.413,"spot":{"innerConeAngle":0.36651914687634957,"outerConeAngle":0.5235987901687622}}]}}"#;
    let falloff = |generator: &str| {
        let asset = format!(r#""version":"2.0","generator":"{generator}""#);
        let desc = Files::new().load(&bin.scene(rest).replace(r#""version":"2.0""#, &asset)).desc.unwrap();
        let LightKind::Spot { falloff_angle, .. } = desc.lights[0].kind else { panic!() };
        falloff_angle
    };
    let inner = (0.866_025_4f32 + 0.3 * (1.0 - 0.866_025_4)).acos().to_degrees();
    assert!((falloff("Khronos glTF Blender I/O v4.5.51") - (30.0 - inner)).abs() < 1e-3);
    assert!((falloff("by hand") - 9.0).abs() < 1e-3);
}

#[test]
fn skins_and_morphs_stand_as_they_are() {
    let mut bin = Bin::default();
    bin.vec3(&TRIANGLE);
    bin.vec3(&[0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    bin.add(&[0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0], 5121, "VEC4", 3, "");
    bin.floats("VEC4", 4, &[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.5, 0.5, 0.0, 0.0]);
    let rest = r#""nodes":[{"mesh":0,"skin":0,"translation":[100,0,0]},{"translation":[0,0,1]},{"translation":[0,0,3]}],
        "skins":[{"joints":[1,2]}],"meshes":[{"weights":[0.5],"primitives":[{"attributes":
        {"POSITION":0,"JOINTS_0":2,"WEIGHTS_0":3},"targets":[{"POSITION":1}]}]}]"#;
    let desc = good(Files::new().load(&bin.scene(rest)));
    // Half the target, then the joints; the node's own place does not count.
    assert_eq!(mesh(&desc.objects[0]).0, [[0.0, 0.0, 2.0], [1.0, 0.0, 3.0], [0.0, 1.0, 2.0]]);
    assert!(desc.objects[0].transform.is_empty());
}

#[test]
fn hostile_files_are_refused() {
    let mut bin = Bin::default();
    bin.vec3(&TRIANGLE);
    let triangle = "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}]";
    let scene = bin.scene(&format!("\"nodes\":[{{\"mesh\":0}}],{triangle}"));
    let cases: Vec<(String, &str)> = vec![
        ("{}".into(), "no glTF file"),
        ("{\"asset\":{\"version\":\"1.0\"}}".into(), "version 2 can be read"),
        ("[".repeat(1000), "nested too deeply"),
        (bin.scene(&format!("\"nodes\":[{{\"children\":[0],\"mesh\":0}}],\"scenes\":[{{\"nodes\":[0]}}],{triangle}")), "reached twice"),
        (bin.scene(&format!("\"nodes\":[{{\"children\":[1]}},{{\"children\":[0]}}],\"scenes\":[{{\"nodes\":[0]}}],{triangle}")), "reached twice"),
        (bin.scene(&format!("\"nodes\":[{{\"mesh\":7}}],{triangle}")), "there is no mesh 7"),
        (bin.scene("\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":4}}]}]"), "there is no accessor 4"),
        (scene.replace("\"count\":3", "\"count\":4000000000"), "beyond the 36"),
        (scene.replace("\"count\":3", "\"count\":18446744073709551615"), "whole number"),
        (scene.replace("\"count\":3", "\"count\":-1"), "whole number"),
        (scene.replace("\"bufferView\":0,\"component", "\"component").replace("\"count\":3", "\"count\":4000000000"), "plausible"),
        (scene.replace("\"byteOffset\":0", "\"byteOffset\":9007199254740991"), "beyond the 36"),
        (scene.replace("\"byteLength\":36,\"uri\"", "\"byteLength\":99,\"uri\""), "cut off"),
        (scene.replace("base64,", "base64,*"), "no base64"),
        (scene.replace("data:application", "http://a/application"), "only files beside the scene"),
        (scene.replace("data:application/octet-stream;base64,", "../../"), "out of the scene's folder"),
        (scene.replace("data:application/octet-stream;base64,", "/dev/zero?"), "out of the scene's folder"),
        (scene.replace("5126", "5130"), "no type of numbers"),
        (scene.replace("\"POSITION\":0", "\"POSITION\":\"0\""), "where a number is due"),
        (scene.replace("[{\"mesh\":0}]", "[{\"mesh\":0,\"rotation\":[0,0,0,0]}]"), "no quaternion"),
        (scene.replace("[{\"mesh\":0}]", "[{\"mesh\":0,\"translation\":[1e300,0,0]}]"), "finite"),
        (scene.replace("\"POSITION\":0}", "\"POSITION\":0},\"material\":3"), "there is no material 3"),
    ];
    for (text, what) in cases {
        refused(&Files::new().load(&text), what);
    }
    // A long chain of nodes takes no stack.
    let chain: Vec<String> = (1..50_000).map(|i| format!("{{\"children\":[{i}]}}")).collect();
    let text = bin.scene(&format!(
        "\"nodes\":[{},{{\"mesh\":0}}],\"scenes\":[{{\"nodes\":[0]}}],{triangle}",
        chain.join(",")
    ));
    assert_eq!(good(Files::new().load(&text)).objects.len(), 1);
}

#[test]
fn few_bytes_make_no_large_meshes() {
    // A thousand primitives each of the same 90 000 corners: more than 64 times the file.
    let mut bin = Bin::default();
    bin.vec3(&TRIANGLE);
    bin.add(&[0, 1, 2].repeat(300_000), 5121, "SCALAR", 900_000, "");
    let primitive = "{\"attributes\":{\"POSITION\":0},\"indices\":1}";
    let all = vec![primitive; 1000].join(",");
    let text = bin.scene(&format!("\"nodes\":[{{\"mesh\":0}}],\"meshes\":[{{\"primitives\":[{all}]}}]"));
    refused(&Files::new().load(&text), "larger than the file makes plausible");
}

#[test]
fn what_is_not_rendered_is_said() {
    let mut bin = Bin::default();
    bin.vec3(&TRIANGLE);
    let scene = |more: &str, primitive: &str| {
        bin.scene(&format!(
            "\"nodes\":[{{\"mesh\":0}}],\"meshes\":[{{\"primitives\":[{{\"attributes\":{{\"POSITION\":0}}}}{primitive}]}}]{more}"
        ))
    };
    for (more, primitive, what) in [
        (
            ",\"extensionsRequired\":[\"ACME_x\"],\"extensionsUsed\":[\"ACME_x\"]",
            "",
            "requires the extension `ACME_x`",
        ),
        (",\"extensionsUsed\":[\"ACME_x\"]", "", "the extension `ACME_x` is not known"),
        (",\"animations\":[{}]", "", "animations are not played"),
        ("", ",{\"mode\":0,\"attributes\":{\"POSITION\":0}}", "points are not rendered"),
        ("", ",{\"mode\":3,\"attributes\":{\"POSITION\":0}}", "lines are not rendered"),
    ] {
        let loaded = Files::new().load(&scene(more, primitive));
        assert_eq!(loaded.diagnostics.iter().filter(|d| d.severity == Severity::Warning).count(), 1);
        let desc = warned(loaded, what);
        assert_eq!(desc.objects.len(), 1);
        let loaded = strict(Files::new().load(&scene(more, primitive)));
        assert!(loaded.desc.is_none(), "{what}");
    }
    let draco = r#","extensionsUsed":["KHR_draco_mesh_compression"]"#;
    let text = scene(draco, "")
        .replace(
            "{\"attributes\":{\"POSITION\":0}}",
            "{\"attributes\":{\"POSITION\":1},\"extensions\":{\"KHR_draco_mesh_compression\":{}}}",
        )
        .replace("\"count\":3}]", "\"count\":3},{\"componentType\":5126,\"type\":\"VEC3\",\"count\":3}]");
    refused(&Files::new().load(&text), "compressed by Draco");
}

#[test]
fn a_description_survives_toml() {
    let files = Files::new();
    files.write("a b.png", b"\x89PNG");
    let json = r#"{"pbrMetallicRoughness":{"baseColorTexture":{"index":1,"extensions":{"KHR_texture_transform":{"scale":[2,3],"rotation":0.5}}}},
        "alphaMode":"BLEND"}"#;
    let desc = good(files.load(&with_material(json, PICTURES)));
    let mut plain = desc.clone();
    plain.lights.clear();
    plain.lights.push(scenefile::desc::Light::from(LightKind::Environment { radiance: [1.0; 3] }).into());
    let text = scenefile::to_toml(&plain);
    let read = scenefile::parse(&text, &files.0.path().join("x.toml"), &[]);
    let read = read.desc.as_ref().unwrap_or_else(|| panic!("{}\n{text}", read.render()));
    assert_eq!((&read.objects, &read.materials), (&plain.objects, &plain.materials));
    assert_eq!(read.textures.keys().collect::<Vec<_>>(), plain.textures.keys().collect::<Vec<_>>());
}
