//! OBJ and PLY files made here, and what becomes of them.
#![allow(clippy::unwrap_used, reason = "helpers of tests, too")]

use std::path::PathBuf;

use nephroid_import::load;
use scenefile::desc::{
    Channel, ColorDesc, EmissionAmount, FloatDesc, Ior, LightKind, Mapping, Material, MaterialKind,
    MaterialRef, Normals, Object, Principled, Roughness, SceneDesc, Shape, Texture,
};
use scenefile::{Loaded, Severity};
use tempfile::TempDir;

struct Files(TempDir);

impl Files {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn write(&self, name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
        let path = self.0.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(&path, bytes).unwrap();
        path
    }

    /// A model of one material, of which the library says this.
    fn material(&self, mtl: &str) -> Loaded {
        self.write("m.mtl", format!("newmtl paint\n{mtl}"));
        load(&self.write("m.obj", format!("mtllib m.mtl\n{QUAD}usemtl paint\nf 1 2 3 4\n")), &[])
    }
}

const QUAD: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

fn good(loaded: Loaded) -> SceneDesc {
    assert!(loaded.diagnostics.iter().all(|d| d.severity == Severity::Note), "{}", loaded.render());
    loaded.desc.unwrap()
}

fn kind<'d>(desc: &'d SceneDesc, object: &Object) -> &'d Material {
    match &object.material {
        Some(MaterialRef::Named(name)) => &desc.materials[&name.value],
        other => panic!("{other:?}"),
    }
}

fn principled(desc: &SceneDesc) -> &Principled {
    match &kind(desc, &desc.objects[0]).kind {
        MaterialKind::Principled(p) => p,
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_model_alone_is_grey_framed_and_lit() {
    let files = Files::new();
    let desc = good(load(&files.write("a.OBJ", format!("{QUAD}f 1 2 3 4\n")), &[]));
    assert_eq!(desc.objects.len(), 2);
    assert!(
        matches!(&desc.objects[0].shape.value, Shape::Triangles { indices, normals: Normals::Smooth { .. }, .. } if indices.len() == 2)
    );
    assert!(desc.camera.is_some() && matches!(desc.lights[0].kind, LightKind::Sky { .. }));
    assert_eq!(principled(&desc).base_color, ColorDesc::Rgb([0.6; 3]));
}

/// What lies under a model, if anything does.
fn ground(desc: &SceneDesc) -> Option<&Object> {
    desc.objects.iter().map(|object| &object.value).find(|object| object.name.as_deref() == Some("ground"))
}

#[test]
fn a_bare_model_stands_on_a_ground() {
    let files = Files::new();
    let text = "v 10 2 0\nv 14 2 0\nv 14 3 3\nusemtl ground\nf 1 2 3\n";
    let path = files.write("a.obj", text);
    let loaded = load(&path, &[]);
    let said = loaded.render();
    assert!(said.contains("a ground is laid under the model: --no-ground leaves it out"), "{said}");
    // The object is called after its material: the ground has another name, and another material.
    let desc = loaded.desc.unwrap();
    let names: Vec<_> = desc.objects.iter().filter_map(|o| o.name.as_deref()).collect();
    assert_eq!(names, ["ground", "ground-2"]);
    let Shape::Triangles { positions, colors, indices, .. } = &desc.objects[1].shape.value else { panic!() };
    // Just below the lowest point, level, around the middle, far out: there it is clear.
    assert!(positions.iter().all(|p| p[1] < 2.0 && p[1] > 2.0 - 1e-3 * 5.0));
    assert_eq!([positions[0][0], positions[0][2]], [12.0, 1.5]);
    let far = |p: &[f32; 3]| (p[0] - 12.0).hypot(p[2] - 1.5);
    for (p, color) in positions.iter().zip(colors) {
        assert_eq!(color[3], if far(p) > 10.0 { 0.0 } else { 1.0 });
    }
    assert!(positions.iter().any(|p| far(p) > 10.0));
    // Every triangle faces up.
    for t in indices {
        let [a, b, c] = t.map(|i| positions[i as usize]);
        let up = (b[2] - a[2]) * (c[0] - a[0]) - (b[0] - a[0]) * (c[2] - a[2]);
        assert!(up > 0.0, "{t:?}");
    }
    let asked = |value: &str| load(&path, &[format!("stage.ground={value}")]);
    let without = asked("false");
    assert!(!without.render().contains("note[ground]"), "{}", without.render());
    assert_eq!(without.desc.unwrap().objects.len(), 1);
    assert!(asked("perhaps").desc.is_none() && asked("perhaps").render().contains("stage.ground=true"));
}

#[test]
fn what_brings_its_light_gets_a_ground_on_request() {
    let files = Files::new();
    files.write("m.mtl", "newmtl lamp\nKe 3 2 1\n");
    let path = files.write("m.obj", format!("mtllib m.mtl\n{QUAD}usemtl lamp\nf 1 2 3 4\n"));
    let plain = good(load(&path, &[]));
    assert!(ground(&plain).is_none() && plain.lights.is_empty());
    let asked = good(load(&path, &["stage.ground = true".into()]));
    assert!(ground(&asked).is_some() && asked.lights.is_empty());
    // Not under whole scenes.
    for (name, text) in
        [("s.toml", "[camera]\n"), ("s.pbrt", "WorldBegin\n"), ("s.xml", "<scene version=\"3.0.0\"/>")]
    {
        let path = files.write(name, text);
        let refused = load(&path, &["stage.ground=true".into()]);
        assert!(
            refused.desc.is_none() && refused.render().contains("a whole scene, not a model"),
            "{}",
            refused.render()
        );
        let told = load(&path, &["stage.ground=false".into()]);
        assert!(told.render().contains("note[ground]"), "{}", told.render());
    }
}

#[test]
fn an_object_for_each_material() {
    let files = Files::new();
    files.write("lib a.mtl", "newmtl red\nKd 1 0 0\nnewmtl lamp\nKd 0 0 0\nKe 3 2 1\n");
    let text = format!(
        "mtllib lib a.mtl\n{QUAD}v 5 5 5\nusemtl red\nf 1 2 3\nusemtl lamp\nf 1 3 4\nusemtl red\nf 5 1 2\n"
    );
    let desc = good(load(&files.write("m.obj", text), &[]));
    let sizes: Vec<(usize, usize)> = desc
        .objects
        .iter()
        .map(|o| match &o.shape.value {
            Shape::Triangles { positions, indices, .. } => (positions.len(), indices.len()),
            other => panic!("{other:?}"),
        })
        .collect();
    assert_eq!(sizes, [(4, 2), (3, 1)]);
    assert_eq!(principled(&desc).base_color, ColorDesc::Rgb([1.0, 0.0, 0.0]));
    assert_eq!(desc.objects[1].emission.as_ref().unwrap().amount, EmissionAmount::Radiance([3.0, 2.0, 1.0]));
    assert!(desc.lights.is_empty());
    let Shape::Triangles { positions, indices, .. } = &desc.objects[0].shape.value else { panic!() };
    assert_eq!(indices[1].map(|v| positions[v as usize][0]), [5.0, 0.0, 1.0]);
}

#[test]
fn kinds_of_materials() {
    let files = Files::new();
    let desc = good(files.material("illum 7\nNi 1.33\nTf 1 0.5 0.5\n"));
    let MaterialKind::Dielectric(glass) = &kind(&desc, &desc.objects[0]).kind else { panic!() };
    assert_eq!((&glass.ior, &glass.color), (&Ior::Value(1.33), &ColorDesc::Rgb([1.0, 0.5, 0.5])));

    let desc = good(files.material("illum 5\nKd 0 0 0\nKs 0.9 0.8 0.7\nNs 1000\n"));
    let p = principled(&desc);
    assert_eq!((&p.metallic, &p.base_color), (&FloatDesc::Value(1.0), &ColorDesc::Rgb([0.9, 0.8, 0.7])));
    assert_eq!(p.roughness, Roughness::from(0.0));

    let desc = good(files.material("illum 2\nKd 0.2 0.2 0.2\nKs 0.25 0.25 0.25\nNs 30\nd 0.5\n"));
    let p = principled(&desc);
    assert_eq!((&p.metallic, &p.specular), (&FloatDesc::Value(0.0), &FloatDesc::Value(0.5)));
    // α² = 2/(n + 2) = 1/16, α = 1/4, its root.
    assert_eq!(p.roughness, Roughness::from(0.5));
    assert_eq!(kind(&desc, &desc.objects[0]).opacity, FloatDesc::Value(0.5));

    let desc = good(files.material("Kd 1 1 1\nPr 0.3\nPm 1\nPc 0.5\n"));
    let p = principled(&desc);
    assert_eq!((&p.metallic, &p.clearcoat), (&FloatDesc::Value(1.0), &FloatDesc::Value(0.5)));
}

#[test]
fn textures_are_looked_for() {
    let files = Files::new();
    files.write("tex/wood.png", b"\x89PNG");
    let desc = good(files.material("Kd 0.5 1 1\nmap_Kd -s 2 3 -o 0.5 tex\\wood.png\nmap_d tex/wood.png\n"));
    let p = principled(&desc);
    let Texture::Image(image) = &desc.textures[&p.base_color.named().unwrap().value].value else { panic!() };
    assert_eq!(image.factor, [0.5, 1.0, 1.0]);
    assert_eq!(image.mapping, Mapping::Uv { set: 0, scale: [2.0, 3.0], rotation: 0.0, offset: [0.5, 0.0] });
    assert_eq!(image.source.written(), "tex/wood.png");
    assert!(kind(&desc, &desc.objects[0]).opacity.named().is_some());

    let loaded = files.material("map_Kd gone.png\nKd 0.5 0.5 0.5\n");
    assert!(loaded.render().contains("m.mtl:2"), "{}", loaded.render());
    assert_eq!(principled(&loaded.desc.unwrap()).base_color, ColorDesc::Rgb([0.5; 3]));
}

#[test]
fn what_is_missing_is_said() {
    let files = Files::new();
    let loaded = load(&files.write("m.obj", format!("mtllib gone.mtl\n{QUAD}usemtl paint\nf 1 2 3\n")), &[]);
    let said = loaded.render();
    assert!(said.contains("m.obj:1:1") && said.contains("`gone.mtl` is not there"), "{said}");
    assert!(said.contains("m.obj:6:1") && said.contains("no material file has `paint`"), "{said}");
    assert!(loaded.desc.is_some());
    let loaded = load(&files.write("n.obj", format!("{QUAD}f 1 2 9\n")), &[]);
    assert!(loaded.desc.is_none() && loaded.render().contains("n.obj:5"), "{}", loaded.render());
    assert!(load(&files.0.path().join("none.obj"), &[]).render().contains("is not there"));
    assert!(load(&files.write("e.obj", ""), &[]).desc.is_none());
}

#[test]
fn a_ply_shows_its_colours() {
    let files = Files::new();
    let text = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\n\
        property uchar green\nproperty uchar blue\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n\
        0 0 0 255 0 0\n1 0 0 0 255 0\n0 1 0 0 0 255\n3 0 1 2\n";
    let desc = good(load(&files.write("a.ply", text), &[]));
    let p = principled(&desc);
    let texture = &desc.textures[&p.base_color.named().unwrap().value];
    assert_eq!(texture.value, Texture::VertexColor { channel: Channel::Rgb });
    assert_eq!(desc.objects[0].name.as_deref(), Some("a"));
    let cut = load(&files.write("b.ply", &text[..text.len() - 9]), &[]);
    assert!(cut.desc.is_none() && cut.render().contains("b.ply"), "{}", cut.render());
}

#[test]
fn an_stl_stands_up() {
    let files = Files::new();
    // 2 wide, 3 deep, 5 high, where +z is up.
    let facet = |p: [&str; 3]| {
        format!(
            "facet normal 0 0 0\nouter loop\nvertex {}\nvertex {}\nvertex {}\nendloop\nendfacet\n",
            p[0], p[1], p[2]
        )
    };
    let text = format!(
        "solid\n{}{}endsolid\n",
        facet(["0 0 0", "2 0 0", "0 0 5"]),
        facet(["0 0 0", "0 0 5", "0 -3 0"])
    );
    let path = files.write("part.STL", text);
    let desc = good(load(&path, &[]));
    assert_eq!(desc.objects[0].name.as_deref(), Some("part"));
    let Shape::Triangles { positions, normals: Normals::Smooth { .. }, .. } = &desc.objects[0].shape.value
    else {
        panic!()
    };
    assert_eq!(positions.len(), 4);
    let Shape::Triangles { positions, .. } = &ground(&desc).unwrap().shape.value else { panic!() };
    // Under z = 0 of the file; its −y is our +z, the front.
    assert!(positions[0][1] < 0.0 && positions[0][1] > -1e-2);
    assert_eq!([positions[0][0], positions[0][2]], [1.0, 1.5]);
    let cut = load(&files.write("b.stl", "solid\nfacet\n"), &[]);
    assert!(cut.desc.is_none() && cut.render().contains("`normal` is expected"), "{}", cut.render());
}
