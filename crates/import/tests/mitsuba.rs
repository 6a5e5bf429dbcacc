//! Mitsuba scenes: what they come to.
#![allow(clippy::unwrap_used, reason = "helpers of tests, too")]

use std::path::Path;

use nephroid_import::load;
use scenefile::desc::{
    CameraKind, ColorDesc, EmissionAmount, FilterKind, FloatDesc, FovAxis, IntegratorKind, LightKind,
    Mapping, Material, MaterialKind, MaterialRef, Metal, Normals, PointAmount, Roughness, SceneDesc, Shape,
    Texture, TransformStep,
};
use scenefile::{Loaded, Severity};

const SENSOR: &str = r#"<sensor type="perspective"><float name="fov" value="40"/></sensor>"#;
const LAMP: &str = r#"<emitter type="constant"/>"#;
const BALL: &str = r#"<shape type="sphere"/>"#;
const PATH: &str = r#"<integrator type="path"/>"#;

fn read(folder: &Path, text: &str, overrides: &[&str]) -> Loaded {
    let path = folder.join("scene.xml");
    std::fs::write(&path, text).unwrap();
    load(&path, &overrides.iter().map(|o| (*o).to_owned()).collect::<Vec<_>>())
}

fn wrapped(version: &str, body: &str) -> String {
    format!("<scene version=\"{version}\">{PATH}{SENSOR}{LAMP}{body}</scene>")
}

/// The description of a scene without any doubt.
fn clean(text: &str) -> SceneDesc {
    let folder = tempfile::tempdir().unwrap();
    let loaded = read(folder.path(), text, &[]);
    assert!(loaded.diagnostics.is_empty(), "{}", loaded.render());
    loaded.desc.unwrap()
}

/// The same with `body` before a sensor and a light.
fn scene(body: &str) -> SceneDesc {
    clean(&wrapped("3.0.0", body))
}

fn old(body: &str) -> SceneDesc {
    clean(&wrapped("0.6.0", body))
}

/// The material of the first object.
fn material(desc: &SceneDesc) -> &Material {
    let Some(MaterialRef::Named(name)) = &desc.objects[0].material else { panic!("no material") };
    &desc.materials[&name.value]
}

fn bsdf(text: &str) -> Material {
    material(&scene(&format!("<shape type=\"sphere\">{text}</shape>"))).clone()
}

/// What a scene is said to be wrong with, and whether it can be rendered.
fn said(body: &str) -> (Vec<String>, bool) {
    let folder = tempfile::tempdir().unwrap();
    let loaded = read(folder.path(), &wrapped("3.0.0", body), &[]);
    for diagnostic in &loaded.diagnostics {
        assert!(!diagnostic.labels.is_empty(), "{diagnostic:?}");
    }
    let errors = loaded.diagnostics.iter().any(|d| d.severity == Severity::Error);
    assert_eq!(errors, loaded.desc.is_none());
    (loaded.diagnostics.into_iter().map(|d| d.message).collect(), !errors)
}

fn wrong(body: &str, what: &str) {
    let (messages, renders) = said(body);
    assert!(!renders && messages.iter().any(|m| m.contains(what)), "{messages:?}");
}

fn doubtful(body: &str, what: &str) {
    let (messages, renders) = said(&format!("{body}{BALL}"));
    assert!(renders && messages.len() == 1 && messages[0].contains(what), "{messages:?}");
}

#[test]
fn a_whole_scene() {
    let desc = clean(
        r#"<?xml version="1.0"?>
        <scene version="3.0.0">
            <default name="res" value="320"/>
            <default name="half" value="$res"/>
            <integrator type="path"><integer name="max_depth" value="7"/></integrator>
            <sensor type="thinlens">
                <float name="fov" value="35"/><string name="fov_axis" value="y"/>
                <float name="aperture_radius" value="0.1"/><float name="focus_distance" value="4"/>
                <transform name="to_world"><lookat origin="0, 1, 5" target="0, 1, 0" up="0, 1, 0"/></transform>
                <sampler type="independent"><integer name="sample_count" value="64"/></sampler>
                <film type="hdrfilm">
                    <integer name="width" value="$res"/><integer name="height" value="200"/>
                    <rfilter type="tent"/>
                </film>
            </sensor>
            <bsdf type="twosided" id="wall"><bsdf type="diffuse"><rgb name="reflectance" value="0.1, 0.2, 0.3"/></bsdf></bsdf>
            <shape type="rectangle" id="floor"><ref id="wall"/></shape>
            <shape type="rectangle">
                <transform name="to_world"><scale x="2"/><rotate x="1" angle="90"/><translate z="$half"/></transform>
                <emitter type="area"><rgb name="radiance" value="4 5 6"/></emitter>
            </shape>
        </scene>"#,
    );
    // Seven edges are six events of scattering.
    assert_eq!((desc.render.max_depth, desc.render.passes), (Some(6), 64));
    assert_eq!(desc.render.integrator, IntegratorKind::Auto);
    assert_eq!(desc.film.size, [320, 200]);
    assert_eq!((desc.film.filter, desc.film.filter_radius), (FilterKind::Triangle, Some(1.0)));
    let camera = desc.camera.as_ref().unwrap();
    assert_eq!((camera.position, camera.fov_axis), ([0.0, 1.0, 5.0], FovAxis::X));
    assert!((camera.look_at[2] - (5.0 - 26f32.sqrt())).abs() < 1e-5);
    let tangent = (camera.fov.to_radians() / 2.0).tan() / 1.6;
    assert!((tangent - 17.5f32.to_radians().tan()).abs() < 1e-6);
    assert_eq!(camera.kind, CameraKind::ThinLens { lens_radius: 0.1, focus_distance: Some(4.0) });
    let wall = material(&desc);
    assert!(wall.two_sided && wall.kind == Material::diffuse([0.1, 0.2, 0.3]).kind);
    let lamp = &desc.objects[1];
    assert_eq!(lamp.material, None);
    let radiance = lamp.emission.as_ref().unwrap();
    assert_eq!((radiance.amount, radiance.two_sided), (EmissionAmount::Radiance([4.0, 5.0, 6.0]), false));
    // (1, 1, 0) is doubled in x, turned from +y to +z, and moved.
    let [TransformStep::Matrix(m)] = &lamp.transform[..] else { panic!("one matrix") };
    let at = |p: [f32; 3]| [0, 1, 2].map(|r| (0..3).map(|c| m[4 * r + c] * p[c]).sum::<f32>() + m[4 * r + 3]);
    let moved = at([1.0, 1.0, 0.0]);
    assert!([2.0, 0.0, 321.0].iter().zip(moved).all(|(a, b)| (a - b).abs() < 1e-4), "{moved:?}");
}

#[test]
fn names_of_version_0_6() {
    let desc = clean(
        r#"<scene version="0.6.0">
            <integrator type="path"><integer name="maxDepth" value="-1"/></integrator>
            <sensor type="perspective"><string name="focalLength" value="18mm"/><string name="fovAxis" value="x"/>
                <transform name="toWorld"><lookAt origin="0,0,0" target="0,0,1" up="0,1,0"/></transform>
                <sampler type="ldsampler"><integer name="sampleCount" value="8"/></sampler></sensor>
            <emitter type="point"><spectrum name="intensity" value="3"/></emitter>
            <shape type="sphere"><bsdf type="roughconductor"><float name="alphaU" value="0.2"/><float name="alphaV" value="0.3"/></bsdf></shape>
            <shape type="sphere"><bsdf type="phong"><float name="exponent" value="20"/></bsdf></shape>
        </scene>"#,
    );
    assert_eq!((desc.render.max_depth, desc.render.passes), (None, 8));
    // A lens of 18 mm before a film of 36 × 24 mm, whose diagonal the picture's is.
    let camera = desc.camera.as_ref().unwrap();
    let diagonal = 768f32.hypot(576.0);
    let expected = (36f32.hypot(24.0) / 36.0 * 768.0 / diagonal).atan().to_degrees() * 2.0;
    assert!((camera.fov - expected).abs() < 1e-3, "{} {expected}", camera.fov);
    let LightKind::Point { amount, .. } = desc.lights[0].kind else { panic!("a point") };
    assert_eq!(amount, PointAmount::Intensity([3.0; 3]));
    let MaterialKind::Conductor(metal) = &material(&desc).kind else { panic!("metal") };
    assert_eq!(metal.roughness, Roughness::Alpha { along: 0.2.into(), across: 0.3.into() });
    // Copper, which is the default there.
    let Metal::Index { n, .. } = metal.metal else { panic!("an index") };
    assert!((n[0] - 0.2).abs() < 0.01 && (n[2] - 1.1).abs() < 0.01);
}

#[test]
fn materials() {
    let plain = bsdf(r#"<bsdf type="diffuse"/>"#);
    assert!(!plain.two_sided && plain.kind == Material::diffuse(0.5).kind);
    let MaterialKind::Dielectric(glass) = bsdf(r#"<bsdf type="dielectric"/>"#).kind else { panic!() };
    assert_eq!((glass.ior, glass.outside_ior), (1.5046.into(), Some(1.000277)));
    let mirror = bsdf(r#"<bsdf type="conductor"/>"#);
    assert_eq!(mirror.kind, Material::mirror(1.0).kind);
    let plastic = r#"<bsdf type="roughplastic"><boolean name="nonlinear" value="true"/><string name="distribution" value="ggx"/>
        <string name="int_ior" value="water"/><float name="ext_ior" value="1"/></bsdf>"#;
    let MaterialKind::CoatedDiffuse(plastic) = bsdf(plastic).kind else { panic!() };
    assert!(plastic.nonlinear && plastic.ior == 1.333.into());
    assert_eq!(plastic.roughness, Roughness::alpha(0.1));
    let masked = r#"<bsdf type="mask"><float name="opacity" value="0.25"/><bsdf type="twosided"><bsdf type="diffuse"/></bsdf></bsdf>"#;
    let masked = bsdf(masked);
    assert_eq!((masked.opacity, masked.two_sided), (FloatDesc::Value(0.25), true));
    let blend = r#"<bsdf type="blendbsdf"><float name="weight" value="0.3"/><bsdf type="diffuse"/><bsdf type="null"/></bsdf>"#;
    assert_eq!(bsdf(blend).opacity, FloatDesc::Value(0.7));
    let blend = blend.replace("null", "conductor");
    let MaterialKind::Mix { amount, b: MaterialRef::Inline(b), .. } = bsdf(&blend).kind else { panic!() };
    assert!(amount == FloatDesc::Value(0.3) && b.kind == mirror.kind);
    // What is null is not there.
    let gone = scene(r#"<shape type="sphere"><bsdf type="null"/></shape><shape type="sphere"/>"#);
    assert_eq!(gone.objects.len(), 1);
    let mixture = old(
        r##"<shape type="sphere"><bsdf type="mixturebsdf"><string name="weights" value="0.2, 0.3, 0.5"/>
        <bsdf type="diffuse"><rgb name="reflectance" value="#ff0000"/></bsdf><bsdf type="diffuse"/><bsdf type="diffuse"/></bsdf></shape>"##,
    );
    // Half of the last, and of the rest three fifths of the second.
    let MaterialKind::Mix { a: MaterialRef::Inline(a), amount: outer, .. } = &material(&mixture).kind else {
        panic!()
    };
    let MaterialKind::Mix { a: MaterialRef::Inline(red), amount: inner, .. } = &a.kind else { panic!() };
    assert_eq!((outer, inner), (&FloatDesc::Value(0.5), &FloatDesc::Value(0.6)));
    assert_eq!(red.kind, Material::diffuse([1.0, 0.0, 0.0]).kind);
}

#[test]
fn one_bsdf_is_one_material() {
    let shapes = r#"<bsdf type="diffuse" id="a"/><alias id="a" as="b"/>
        <shape type="rectangle"><ref id="a"/></shape><shape type="sphere"><ref id="b"/></shape>
        <shape type="cube"><ref name="bsdf" id="a"/></shape>"#;
    let desc = scene(shapes);
    assert_eq!(desc.objects.len(), 3);
    // v grows up on a sphere and down on the others, which are one material but for that.
    assert_eq!(desc.materials.len(), 2);
}

#[test]
fn textures() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("a.png"), "").unwrap();
    std::fs::write(folder.path().join("a.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    let text = wrapped(
        "3.0.0",
        r#"<texture type="bitmap" id="t"><string name="filename" value="a.png"/><boolean name="raw" value="true"/>
            <transform name="to_uv"><scale x="2" y="3"/><translate x="0.25" y="0.5"/></transform></texture>
        <bsdf type="diffuse" id="d"><ref name="reflectance" id="t"/></bsdf>
        <shape type="rectangle"><ref id="d"/></shape>
        <shape type="obj"><string name="filename" value="a.obj"/><ref id="d"/></shape>
        <shape type="cube"><bsdf type="diffuse"><texture type="checkerboard" name="reflectance">
            <transform name="to_uv"><scale value="4"/></transform></texture></bsdf></shape>"#,
    );
    let loaded = read(folder.path(), &text, &[]);
    assert!(loaded.diagnostics.is_empty(), "{}", loaded.render());
    let desc = loaded.desc.unwrap();
    let mapping = |object: usize| {
        let Some(MaterialRef::Named(name)) = &desc.objects[object].material else { panic!() };
        let MaterialKind::Diffuse { color: ColorDesc::Texture(name) } = &desc.materials[&name.value].kind
        else {
            panic!()
        };
        match &desc.textures[&name.value].value {
            Texture::Image(image) => image.mapping.clone(),
            Texture::Checker { mapping, .. } => mapping.clone(),
            _ => panic!(),
        }
    };
    let uv = |scale, offset| Mapping::Uv { set: 0, scale, rotation: 0.0, offset };
    // Mitsuba's v = 0 is a picture's top, ours its bottom: 1 − (3v + ½), and with v turned 1 − (3(1 − v) + ½).
    assert_eq!(mapping(0), uv([2.0, -3.0], [0.25, 0.5]));
    assert_eq!(mapping(1), uv([2.0, 3.0], [0.25, -2.5]));
    assert_eq!(mapping(2), uv([4.0, 4.0], [0.0, 0.0]));
}

#[test]
fn shapes() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("a.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 -1\nf 1//1 2//1 3//1\n")
        .unwrap();
    let file = r#"<string name="filename" value="a.obj"/>"#;
    let text = wrapped(
        "3.0.0",
        &format!(
            r#"<shape type="obj">{file}</shape>
            <shape type="obj">{file}<boolean name="face_normals" value="true"/></shape>
            <shape type="obj">{file}<boolean name="face_normals" value="true"/><transform name="to_world"><scale x="-1"/></transform></shape>
            <shape type="sphere"><point name="center" x="1" y="2" z="3"/><float name="radius" value="2"/><boolean name="flip_normals" value="true"/></shape>
            <shape type="cylinder"><point name="p1" x="0" y="2" z="0"/></shape>
            <shape type="shapegroup" id="g"><shape type="cube"/><shape type="disk"/></shape>
            <shape type="instance"><ref id="g"/></shape>
            <shape type="instance"><ref id="g"/><transform name="to_world"><translate x="2"/></transform></shape>"#
        ),
    );
    let loaded = read(folder.path(), &text, &[]);
    assert!(loaded.diagnostics.is_empty(), "{}", loaded.render());
    let desc = loaded.desc.unwrap();
    assert_eq!((desc.objects.len(), desc.instances.len()), (5, 2));
    // A one-sided face whose vertices say that its front is the other side is turned.
    let Shape::Triangles { indices, .. } = &desc.objects[0].shape.value else { panic!() };
    assert_eq!(indices, &[[0, 2, 1]]);
    for (object, flipped) in [(1, false), (2, true)] {
        let Shape::Mesh { normals, .. } = &desc.objects[object].shape.value else { panic!() };
        assert_eq!((*normals, desc.objects[object].flip_normals), (Normals::Flat, flipped));
    }
    assert!(desc.objects[3].flip_normals);
    let group = &desc.groups[&desc.instances[0].group.value];
    assert_eq!((group.objects.len(), desc.groups.len()), (2, 1));
    let Shape::Triangles { positions, .. } = &desc.objects[4].shape.value else { panic!() };
    // About z in its own space, from 0 to the distance of its ends.
    assert!(positions.iter().all(|p| (p[0].hypot(p[1]) - 1.0).abs() < 1e-5 && (p[2] == 0.0 || p[2] == 2.0)));
}

#[test]
fn includes_and_overrides() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("parts")).unwrap();
    std::fs::write(
        folder.path().join("parts/lamp.xml"),
        "<scene version='3.0.0'><emitter type='constant'/></scene>",
    )
    .unwrap();
    let text = format!(
        "<scene version='3.0.0'><default name='n' value='3'/><default name='name' value='5'/>
        <integrator type='path'><integer name='max_depth' value='$n'/></integrator>{SENSOR}
        <include filename='parts/lamp.xml'/></scene>"
    );
    let depth = |overrides: &[&str]| {
        let loaded = read(folder.path(), &text, overrides);
        loaded.desc.map(|d| (d.render.max_depth, d.lights.len())).ok_or(loaded.diagnostics)
    };
    assert_eq!(depth(&[]), Ok((Some(2), 1)));
    assert_eq!(depth(&["n=9"]), Ok((Some(8), 1)));
    assert!(depth(&["m=9"]).unwrap_err()[0].message.contains("`m`"));
    assert!(depth(&["n"]).is_err());
    std::fs::write(
        folder.path().join("parts/lamp.xml"),
        "<scene version='3.0.0'><include filename='scene.xml'/></scene>",
    )
    .unwrap();
    assert!(depth(&[]).unwrap_err()[0].message.contains("includes itself"));
}

#[test]
fn lights() {
    let kinds = |body: &str| {
        let desc = scene(&format!("{body}{BALL}"));
        desc.lights.into_iter().skip(1).map(|l| l.value.kind).collect::<Vec<_>>()
    };
    let spot = r#"<emitter type="spot"><float name="cutoff_angle" value="40"/><float name="intensity" value="2"/>
        <transform name="to_world"><lookat origin="0,3,0" target="0,0,0" up="1,0,0"/></transform></emitter>"#;
    let [LightKind::Spot { position, direction, cone_angle, falloff_angle, .. }] = kinds(spot)[..] else {
        panic!()
    };
    assert_eq!((position, cone_angle, falloff_angle), ([0.0, 3.0, 0.0], 40.0, 10.0));
    assert!((direction[1] + 1.0).abs() < 1e-6);
    let sun = r#"<emitter type="directional"><vector name="direction" value="1, -2, 3"/><rgb name="irradiance" value="2"/></emitter>"#;
    assert_eq!(kinds(sun), [LightKind::Directional { direction: [1.0, -2.0, 3.0], irradiance: [2.0; 3] }]);
    // Black lights are none.
    assert!(kinds(r#"<emitter type="point"><rgb name="intensity" value="0"/></emitter>"#).is_empty());
    let [LightKind::SunSky(sky)] =
        &kinds(r#"<emitter type="sunsky"><vector name="sun_direction" x="0" y="-1" z="1"/></emitter>"#)[..]
    else {
        panic!()
    };
    // Up is +z there and +y here.
    assert!(
        (sky.sun_direction[1] - 0.5f32.sqrt()).abs() < 1e-6
            && (sky.sun_direction[2] - 0.5f32.sqrt()).abs() < 1e-6
    );
}

#[test]
fn windows_of_films() {
    let film = |film: &str, extra: &str| {
        let text = format!(
            "<scene version='3.0.0'>{PATH}{LAMP}{BALL}<sensor type='perspective'><float name='fov' value='90'/>{extra}
            <film type='hdrfilm'><integer name='width' value='200'/><integer name='height' value='100'/>{film}</film></sensor></scene>"
        );
        clean(&text)
    };
    let part = film(
        "<integer name='crop_offset_x' value='50'/><integer name='crop_offset_y' value='10'/>
        <integer name='crop_width' value='40'/><integer name='crop_height' value='30'/>",
        "",
    );
    let camera = part.camera.as_ref().unwrap();
    assert_eq!(part.film.size, [40, 30]);
    assert!(((camera.fov.to_radians() / 2.0).tan() - 0.2).abs() < 1e-6);
    // Its middle is at (70, 25) of (200, 100).
    assert!((camera.shift[0] + 30.0 / 40.0).abs() < 1e-6 && (camera.shift[1] - 25.0 / 30.0).abs() < 1e-6);
    let moved = film(
        "",
        "<float name='principal_point_offset_x' value='0.1'/><float name='principal_point_offset_y' value='0.2'/>",
    );
    assert_eq!(moved.camera.as_ref().unwrap().shift, [0.1, -0.2]);
}

#[test]
fn absorbing_media() {
    let medium = r#"<medium type="homogeneous" name="interior"><rgb name="sigma_t" value="1 2 3"/><float name="scale" value="2"/>
        <rgb name="albedo" value="0"/><phase type="hg"/></medium>"#;
    let inside =
        |bsdf: &str| scene(&format!(r#"<shape type="sphere"><bsdf type="{bsdf}"/>{medium}</shape>"#));
    for bsdf in ["dielectric", "null"] {
        let desc = inside(bsdf);
        let MaterialKind::Dielectric(glass) = &material(&desc).kind else { panic!() };
        assert_eq!(glass.absorption, [2.0, 4.0, 6.0]);
    }
    let scattering = medium.replace("value=\"0\"", "value=\"0.5\"");
    doubtful(
        &format!(r#"<shape type="sphere">{scattering}</shape>"#),
        "medium `homogeneous` is not rendered",
    );
}

#[test]
fn what_is_not_rendered_is_said() {
    doubtful(r#"<shape type="sphere"><bsdf type="hair"/></shape>"#, "a grey diffuse one takes its place");
    doubtful(
        r#"<shape type="sphere"><bsdf type="diffuse"><rgb name="reflectanse" value="1"/></bsdf></shape>"#,
        "no parameter `reflectanse`",
    );
    doubtful(
        r#"<shape type="sphere"><transform name="to_world"><translate X="1"/></transform></shape>"#,
        "no attribute `X`",
    );
    doubtful(r#"<shape type="sdfgrid"><string name="filename" value="a.vol"/></shape>"#, "it is left out");
    doubtful(r#"<emitter type="collimated"/>"#, "it is dark");
    doubtful(
        r#"<shape type="sphere"><bsdf type="twosided"><bsdf type="diffuse"/><bsdf type="conductor"/></bsdf></shape>"#,
        "the first one is on both",
    );
}

#[test]
fn mistakes() {
    wrong(r#"<shape type="spere"/>"#, "no shape `spere`");
    wrong(r#"<shape type="sphere"><bsdf type="difuse"/></shape>"#, "no BSDF `difuse`");
    wrong(r#"<shape type="sphere"><ref id="nobody"/></shape>"#, "nothing has the id `nobody`");
    wrong(r#"<shape type="sphere"><float name="radius" value="-1"/></shape>"#, "greater than 0");
    wrong(r#"<shape type="sphere"><float name="radius" value="x"/></shape>"#, "does not read as a number");
    wrong(r#"<shape type="sphere"><float name="radius" value="$r"/></shape>"#, "`$r` stands for");
    wrong(
        r#"<shape type="sphere"><transform name="to_world"><matrix value="1 2 3"/></transform></shape>"#,
        "9 or 16",
    );
    wrong(r#"<shape type="sphere"><transform name="to_world"><scale x="0"/></transform></shape>"#, "flat");
    wrong(
        r#"<shape type="sphere"><transform name="to_world"><rotate angle="9"/></transform></shape>"#,
        "no length",
    );
    wrong(r#"<bsdf type="diffuse" id="a"/><bsdf type="diffuse" id="a"/>"#, "given twice");
    wrong(r#"<shape type="obj"/>"#, "no `filename`");
    wrong(
        r#"<shape type="serialized"><string name="filename" value="none.serialized"/></shape>"#,
        "is not there",
    );
    wrong(r#"<include filename="none.xml"/>"#, "is not there");
    wrong(r#"<shap type="sphere"/>"#, "no element <shap>");
    wrong(r#"<shape/>"#, "has no `type`");
    wrong("<shape type='sphere'>text</shape>", "there is text within <shape>");
    wrong(
        r#"<shape type="sphere"><bsdf type="conductor"><string name="material" value="Unobtainium"/></bsdf></shape>"#,
        "no material is named",
    );
    // Each of these is itself a part of the other.
    wrong(
        r#"<bsdf type="twosided" id="a"><ref id="b"/></bsdf><bsdf type="twosided" id="b"><ref id="a"/></bsdf>
        <shape type="sphere"><ref id="a"/></shape>"#,
        "nested more than",
    );
}

#[test]
fn hostile_files() {
    let folder = tempfile::tempdir().unwrap();
    let refused = |text: &str, what: &str| {
        let loaded = read(folder.path(), text, &[]);
        assert!(loaded.desc.is_none());
        let said = loaded.render();
        assert!(said.contains(what), "{said}");
    };
    // Entities that grow, by a document type that is refused as a whole.
    let bomb = "<!DOCTYPE s [<!ENTITY a 'aaaa'><!ENTITY b '&a;&a;&a;'>]><scene version='&b;'/>";
    refused(bomb, "DTD");
    // Defaults that grow: 2⁴⁰ bytes.
    let mut text = "<scene version='3.0.0'><default name='x0' value='aa'/>".to_owned();
    for i in 1..40 {
        text += &format!(
            "<default name='x{i}q' value='$x{0}{1}$x{0}{1}'/>",
            i - 1,
            if i == 1 { "" } else { "q" }
        );
    }
    refused(&(text + "</scene>"), "grow beyond");
    refused(&("<scene>".repeat(100_000) + &"</scene>".repeat(100_000)), "deep");
    refused(&"<scene>".repeat(3_000), "no XML");
    refused("", "no XML");
    refused("<mesh/>", "its root is <mesh>");
    refused("<scene version='3.0.0'></scene>", "no sensor");
    // Any part of a scene is a scene or an error.
    let whole = wrapped(
        "3.0.0",
        r##"<shape type="sphere"><bsdf type="diffuse"><rgb name="reflectance" value="#ffffff"/></bsdf></shape>"##,
    );
    for n in 0..whole.len() {
        assert!(read(folder.path(), &whole[..n], &[]).desc.is_none(), "{n}");
    }
    std::fs::write(folder.path().join("scene.xml"), [0xff, 0xfe, 0x00]).unwrap();
    assert!(load(&folder.path().join("scene.xml"), &[]).render().contains("UTF-8"));
}
