//! Where fuzzing begins: small valid inputs, made here.

use std::io::Cursor;
use std::path::Path;

use film::{Film, SectionReader, SectionWriter};
use image::{DynamicImage, ImageFormat, Rgb32FImage, Rgba, RgbaImage};
use scenefile::SceneDesc;
use session::{CheckpointInfo, write_checkpoint};

/// Writes the first inputs of a target to `corpus/TARGET`, if that is there: a fuzzer calls this before it looks.
pub fn write(target: &str) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus").join(target);
    for (i, seed) in of(target).iter().enumerate().filter(|_| folder.is_dir()) {
        // Without them it finds the same, later.
        let _ = std::fs::write(folder.join(format!("seed-{i:02}")), seed);
    }
}

fn of(target: &str) -> Vec<Vec<u8>> {
    let texts = |texts: &[&str]| texts.iter().map(|t| t.as_bytes().to_vec()).collect();
    match target {
        "toml" => toml(),
        "compile" => compile(),
        "pbrt" => texts(&PBRT),
        "mitsuba" => texts(&[MITSUBA]),
        "serialized" => vec![serialized()],
        "model" => texts(&OBJ),
        "mtl" => texts(&[MTL]),
        "photometry" => texts(&[IES, LDT]),
        "gltf" => vec![GLTF.as_bytes().to_vec()],
        "glb" => vec![glb()],
        "obj" => texts(&OBJ),
        "ply" => ply(),
        "stl" => stl(),
        "image" => images(),
        "spd" => texts(&["400 0.5\n500 1 # nm\n600 0.25\n", "300,1\n800,2\n"]),
        "film" => vec![as_records(&film_bytes())],
        "checkpoint" => checkpoints(),
        other => panic!("no first inputs for {other}"),
    }
}

/// Files that scenes may name.
pub fn neighbours(folder: &Path) {
    let write =
        |name: &str, bytes: &[u8]| std::fs::write(folder.join(name), bytes).expect("a file in the folder");
    write("a.ply", &ply()[0]);
    write("a.obj", OBJ[0].as_bytes());
    write("a.png", &picture(ImageFormat::Png));
    write("a.exr", &picture(ImageFormat::OpenExr));
    write("a.spd", b"400 0.5\n700 1\n");
    write("b.pbrt", b"Shape \"disk\"\nInclude \"b.pbrt\"\n");
    write("a.bin", &[0; 64]);
    write("b.toml", b"include = [\"c.toml\"]\n[materials.red]\nkind = \"diffuse\"\ncolor = [1, 0, 0]\n");
    write("c.toml", b"[textures.bumps]\nkind = \"fbm\"\n[[lights]]\nkind = \"environment\"\nradiance = 1\n");
}

/// A triangle in text and one in binary.
fn stl() -> Vec<Vec<u8>> {
    let text = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n";
    let mut binary = vec![0; 80];
    binary.extend(1u32.to_le_bytes());
    [0.0f32, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].iter().for_each(|x| binary.extend(x.to_le_bytes()));
    binary.extend([0; 2]);
    vec![text.as_bytes().to_vec(), binary]
}

/// Scenes of the repository and one example of every section of the format.
fn toml() -> Vec<Vec<u8>> {
    let scenes = [
        include_str!("../../scenes/coffee-cup.toml"),
        include_str!("../../scenes/furnace.toml"),
        include_str!("../../scenes/metal-ring.toml"),
        include_str!("../../scenes/wine-glass.toml"),
    ];
    let mut seeds: Vec<Vec<u8>> = scenes.iter().map(|s| s.as_bytes().to_vec()).collect();
    let sections = [
        &scenefile::spec::TEXTURES,
        &scenefile::spec::MATERIALS,
        &scenefile::spec::OBJECTS,
        &scenefile::spec::LIGHTS,
    ];
    for section in sections {
        let variants = section.switch.iter().flat_map(|switch| switch.variants);
        for example in variants.map(|v| v.example).chain([section.example]) {
            seeds.push(
                format!("[camera]\nposition = [0, 0, 3]\nlook_at = [0, 0, 0]\n\n{example}").into_bytes(),
            );
        }
    }
    seeds.extend(compile());
    seeds
}

/// Scenes of generated shapes, of files that are there, and of several files.
fn compile() -> Vec<Vec<u8>> {
    let shapes = [
        "shape = \"height-field\"\nfile = \"a.png\"\nsize = [2, 2]\nheight = 0.3\ndepth = 0.1",
        "shape = \"height-field\"\nheights = [[0, 0.2], [0.1, 0]]\nsize = [1, 2]",
        "shape = \"water-surface\"\nsize = [2, 2]\ndepth = 0.5\nresolution = 64\nwind_speed = 3\nfetch = 50\nwaves = 64",
        "shape = \"round-brilliant\"\ndiameter = 2\ncrown_angle = 34\npavilion_angle = 41\nculet = 0.01",
        "shape = \"rounded-box\"\nmin = [0, 0, 0]\nmax = [1, 1, 1]\nradius = 0.1\nsteps = 3",
        "shape = \"lathe\"\nprofile = [[0, 0], [1, 0], [0, 1]]\nsegments = 12\nsteps = 3",
        "shape = \"mesh\"\nfile = \"a.ply\"\nnormals = \"smooth\"",
        "shape = \"sphere\"\ndisplacement = { texture = \"bumps\", scale = 0.1, midlevel = 0, edge_length = 0.3 }",
        "shape = \"box\"\nmin = [0, 0, 0]\nmax = [1, 1, 1]\ndisplacement = { texture = \"bumps\", scale = 0.1, edge_pixels = 9 }",
    ];
    let scene = |keys: &str| {
        format!(
            "include = [\"b.toml\"]\n[camera]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\n[[objects]]\nmaterial = \"red\"\n{keys}\n"
        )
        .into_bytes()
    };
    shapes.map(scene).to_vec()
}

const PBRT: [&str; 6] = [
    "Integrator \"path\" \"integer maxdepth\" 7\nSampler \"halton\" \"integer pixelsamples\" 4\nPixelFilter \"gaussian\"\n\
     Film \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 9 \"float iso\" 200 \"float cropwindow\" [0 .5 0 1]\n\
     LookAt 1 2 3 0 0 0 0 1 0\nCamera \"perspective\" \"float fov\" 40 \"float lensradius\" .1\nWorldBegin\n\
     AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [1 2 3] Translate 0 1 0 Rotate 90 1 0 0 Scale 1 2 3\n\
     Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"integer indices\" [0 1 2] \"point2 uv\" [0 0 1 0 1 1] AttributeEnd\n\
     Material \"dielectric\" \"float eta\" 1.5 \"float roughness\" .1\nShape \"sphere\" \"float radius\" 2\n",
    "Camera \"orthographic\" \"float screenwindow\" [-1 1 -1 1]\nWorldBegin\n\
     LightSource \"infinite\" \"string filename\" \"a.exr\" \"float scale\" 2\nLightSource \"point\" \"blackbody I\" 3000\n\
     LightSource \"spot\" \"float coneangle\" 30\nLightSource \"distant\" \"rgb L\" [1 1 1]\n\
     Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"a.png\" \"float uscale\" 2\n\
     Texture \"c\" \"spectrum\" \"checkerboard\" \"texture tex1\" \"t\" \"rgb tex2\" [1 0 0]\n\
     Texture \"f\" \"float\" \"fbm\" \"integer octaves\" 3\nTexture \"m\" \"spectrum\" \"mix\" \"texture tex1\" \"c\" \"texture amount\" \"f\"\n\
     MakeNamedMaterial \"a\" \"string type\" \"diffuse\" \"texture reflectance\" \"m\"\n\
     MakeNamedMaterial \"b\" \"string type\" \"conductor\" \"spectrum eta\" \"metal-Au-eta\" \"spectrum k\" \"metal-Au-k\"\n\
     Material \"mix\" \"string materials\" [\"a\" \"b\"] \"float amount\" .25\nShape \"plymesh\" \"string filename\" \"a.ply\" \"texture alpha\" \"f\"\n",
    "Camera \"spherical\"\nWorldBegin\nObjectBegin \"o\" Shape \"cylinder\" \"float zmax\" 2 Shape \"disk\" ObjectEnd\n\
     ObjectInstance \"o\" Translate 1 0 0 ObjectInstance \"o\"\nAttribute \"shape\" \"float radius\" 2\nShape \"sphere\" \"float zmax\" 0\n\
     Shape \"loopsubdiv\" \"integer levels\" 1 \"point3 P\" [0 0 0 1 0 0 0 1 0] \"integer indices\" [0 1 2]\n\
     Shape \"curve\" \"point3 P\" [0 0 0 0 0 1 0 1 2 0 0 3] \"float width\" .1\n\
     Shape \"bilinearmesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 1]\n",
    "Camera \"perspective\"\nWorldBegin\nLightSource \"infinite\"\nMaterial \"coateddiffuse\" \"rgb reflectance\" [.1 .2 .3]\n\
     MakeNamedMedium \"w\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [1 2 3] \"rgb sigma_s\" 0\nMediumInterface \"w\" \"\"\n\
     Material \"coatedconductor\"\nInclude \"b.pbrt\"\nMaterial \"hair\"\nShape \"sphere\"\nMaterial \"subsurface\"\nShape \"sphere\"\n\
     Material \"disney\"\nShape \"sphere\"\nMaterial \"uber\" \"rgb opacity\" .5\nShape \"sphere\"\nWorldEnd\n",
    "Camera \"perspective\"\nWorldBegin\nLightSource \"projection\" \"string filename\" \"a.png\"\n\
     LightSource \"goniometric\" \"string filename\" \"a.png\"\nColorSpace \"rec2020\"\nCoordinateSystem \"c\" CoordSysTransform \"c\"\n\
     Transform [1 0 0 0 0 1 0 0 0 0 1 0 1 2 3 1] ConcatTransform [1 0 0 0 0 1 0 0 0 0 1 0 1 2 3 1] ReverseOrientation\n\
     Material \"diffuse\" \"spectrum reflectance\" [400 .5 700 .25] \"texture displacement\" \"none\"\nShape \"disk\"\n",
    "Option \"integer seed\" 3\nFilm \"image\" \"float whitebalance\" 3000\nCamera \"realistic\"\nWorldBegin\n\
     Texture \"p\" \"float\" \"dots\" \"string mapping\" \"planar\"\nTexture \"q\" \"spectrum\" \"marble\"\nTexture \"s\" \"float\" \"scale\" \"texture tex\" \"p\" \"float scale\" 2\n\
     Material \"diffuse\" \"texture reflectance\" \"q\" \"texture displacement\" \"s\"\nShape \"sphere\" \"float alpha\" .5\n",
];

const MITSUBA: &str = "<scene version=\"3.0.0\"><default name=\"d\" value=\"5\"/><integrator type=\"path\"><integer name=\"max_depth\" value=\"$d\"/></integrator>\n\
     <sensor type=\"perspective\"><float name=\"fov\" value=\"40\"/><transform name=\"to_world\"><lookat origin=\"0,1,5\" target=\"0 0 0\" up=\"0 1 0\"/></transform>\n\
     <film type=\"hdrfilm\"><integer name=\"width\" value=\"16\"/><integer name=\"height\" value=\"9\"/><rfilter type=\"tent\"/></film></sensor>\n\
     <bsdf type=\"twosided\" id=\"a\"><bsdf type=\"roughconductor\"><string name=\"material\" value=\"Au\"/><float name=\"alpha\" value=\".1\"/></bsdf></bsdf>\n\
     <bsdf type=\"mask\" id=\"b\"><float name=\"opacity\" value=\".5\"/><bsdf type=\"diffuse\"><texture type=\"bitmap\" name=\"reflectance\"><string name=\"filename\" value=\"a.png\"/></texture></bsdf></bsdf>\n\
     <shape type=\"sphere\"><ref id=\"a\"/><emitter type=\"area\"><rgb name=\"radiance\" value=\"1 2 3\"/></emitter></shape>\n\
     <shape type=\"ply\"><string name=\"filename\" value=\"a.ply\"/><transform name=\"to_world\"><scale value=\"2\"/><rotate x=\"1\" angle=\"30\"/></transform><ref id=\"b\"/></shape>\n\
     <emitter type=\"envmap\"><string name=\"filename\" value=\"a.exr\"/></emitter><emitter type=\"spot\"/></scene>";

const MTL: &str = "newmtl b\nKd 1 0.5 0.25\nKs 0.1 0.1 0.1\nNs 50\nNi 1.5\nd 0.5\nillum 2\nmap_Kd -s 2 2 1 a.png\nKe 1 1 1\nPr 0.25\nPm 1\n";

const IES: &str = "IESNA:LM-63-1995\n[TEST] a\nTILT=NONE\n1 1000 1 3 2 1 1 0 0 0\n1 1 50\n0 45 90\n0 90\n100 50 0\n90 40 0\n";

const LDT: &str = "maker\n1\n0\n2\n90\n3\n45\nreport\nname\nnumber\nfile\ndate\n100\n100\n50\n50\n50\n0\n0\n0\n0\n100\n80\n1\n0\n1\n\
     1\nlamp\n1000\n3000\n1B\n20\n1\n1\n1\n1\n1\n1\n1\n1\n1\n1\n0\n90\n0\n45\n90\n100\n50\n0\n90\n40\n0\n";

/// One triangle (Mitsuba 0.6, documentation of `serialized`): head, deflated flags, name and numbers, and the place of each mesh.
fn serialized() -> Vec<u8> {
    let mut plain = 0x1000u32.to_le_bytes().to_vec();
    plain.extend(b"a\0");
    plain.extend(3u64.to_le_bytes());
    plain.extend(1u64.to_le_bytes());
    [0f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].iter().for_each(|x| plain.extend(x.to_le_bytes()));
    (0u32..3).for_each(|i| plain.extend(i.to_le_bytes()));
    let mut file = [0x1c, 0x04, 4, 0].to_vec();
    // One stored block of deflate in a zlib wrapper.
    let length = plain.len() as u16;
    file.extend([0x78, 0x01, 0x01]);
    file.extend(length.to_le_bytes());
    file.extend((!length).to_le_bytes());
    file.extend(&plain);
    let (a, b) = plain.iter().fold((1u32, 0u32), |(a, b), x| {
        let a = (a + u32::from(*x)) % 65521;
        (a, (b + a) % 65521)
    });
    file.extend((b << 16 | a).to_be_bytes());
    file.extend(0u64.to_le_bytes());
    file.extend(1u32.to_le_bytes());
    file
}

/// One triangle, its buffer within.
const GLTF: &str = "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0,\"translation\":[1,2,3]}],\
     \"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"material\":0}]}],\
     \"materials\":[{\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,0.5,0.25,1],\"metallicFactor\":0},\"alphaMode\":\"MASK\",\
     \"extensions\":{\"KHR_materials_transmission\":{\"transmissionFactor\":1},\"KHR_materials_ior\":{\"ior\":1.4}}}],\
     \"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[1,1,0]}],\
     \"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\
     \"buffers\":[{\"byteLength\":36,\"uri\":\"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}]}";

/// The same in one file.
fn glb() -> Vec<u8> {
    let start = GLTF.find(",\"uri\"").expect("a buffer");
    let mut json = format!("{}}}]}}", &GLTF[..start]).into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let numbers = [0f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    let binary: Vec<u8> = numbers.iter().flat_map(|x| x.to_le_bytes()).collect();
    let mut bytes = b"glTF\x02\0\0\0".to_vec();
    bytes.extend((12 + 8 + json.len() as u32 + 8 + 36).to_le_bytes());
    for (kind, chunk) in [(b"JSON", &json), (b"BIN\0", &binary)] {
        bytes.extend((chunk.len() as u32).to_le_bytes());
        bytes.extend(kind);
        bytes.extend(chunk);
    }
    bytes
}

const OBJ: [&str; 2] = [
    "# box\nmtllib a.mtl\nv 0 0 0\nv 1 0 0 1\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 1\nvn 0 0 1\ng a\nusemtl b\nf 1/1/1 2/2/1 3/2/1 4/1/1\nf -4 -3 -2\n",
    "v 0 0 0\nv 2 0 0\nv 0 2 0\ns 1\nf 1//1 2//1 3//1\nvn 0 0 1\n",
];

fn ply() -> Vec<Vec<u8>> {
    let head = |format: &str| {
        format!(
            "ply\nformat {format} 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty float u\n\
             property float v\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
        )
        .into_bytes()
    };
    let numbers = [0f32, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0];
    let mut text = head("ascii");
    text.extend(b"0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n3 0 1 2\n");
    let (mut little, mut big) = (head("binary_little_endian"), head("binary_big_endian"));
    numbers.iter().for_each(|x| little.extend(x.to_le_bytes()));
    numbers.iter().for_each(|x| big.extend(x.to_be_bytes()));
    for (bytes, index) in
        [(&mut little, i32::to_le_bytes as fn(i32) -> [u8; 4]), (&mut big, i32::to_be_bytes)]
    {
        bytes.push(3);
        (0..3).for_each(|i| bytes.extend(index(i)));
    }
    vec![text, little, big]
}

fn picture(format: ImageFormat) -> Vec<u8> {
    let small = RgbaImage::from_fn(4, 4, |x, y| Rgba([60 * x as u8, 60 * y as u8, 7, 255 - x as u8]));
    let image = match format {
        ImageFormat::Hdr | ImageFormat::OpenExr => {
            DynamicImage::from(Rgb32FImage::from_fn(4, 4, |x, y| image::Rgb([x as f32, y as f32, 0.5])))
        }
        ImageFormat::Bmp | ImageFormat::Tga => DynamicImage::from(DynamicImage::from(small).into_rgb8()),
        _ => DynamicImage::from(small),
    };
    let mut bytes = Cursor::new(Vec::new());
    image.write_to(&mut bytes, format).expect("a picture in memory");
    bytes.into_inner()
}

fn images() -> Vec<Vec<u8>> {
    use ImageFormat::{Bmp, Hdr, OpenExr, Png, Tga, Tiff};
    let mut all: Vec<Vec<u8>> = [Png, Hdr, OpenExr, Tiff, Bmp, Tga].into_iter().map(picture).collect();
    all.push([&b"PF\n1 1\n-1.0\n"[..], &[0; 12]].concat());
    all
}

fn film_bytes() -> Vec<u8> {
    let mut out = SectionWriter::new(Vec::new());
    Film::new(3, 2).write(&mut out).expect("a film in memory");
    out.finish().expect("a film in memory")
}

fn checkpoints() -> Vec<Vec<u8>> {
    let info = CheckpointInfo::new(&SceneDesc::default()).expect("a description of nothing");
    let mut file = Vec::new();
    write_checkpoint(&mut file, &info, &Film::new(3, 2)).expect("a checkpoint in memory");
    let (head, sections) = file.split_at(12);
    let records = as_records(sections);
    vec![[&[0][..], head, &records].concat(), [&[1][..], &file].concat()]
}

/// Sections as the targets `film` and `checkpoint` take them.
fn as_records(sections: &[u8]) -> Vec<u8> {
    let mut input = SectionReader::new(sections);
    let (mut at, mut out) = (0, Vec::new());
    while let Some(head) = sections.get(at..at + 12) {
        let tag: [u8; 4] = std::array::from_fn(|i| head[i]);
        if tag == *b"END " {
            break;
        }
        let bytes = input.read(tag).expect("a section as it was written");
        out.extend(tag);
        out.extend((bytes.len() as u32).to_le_bytes());
        out.extend(bytes);
        at += 12 + u32::from_le_bytes(std::array::from_fn(|i| head[4 + i])) as usize + 4;
    }
    out
}
