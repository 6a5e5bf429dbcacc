//! A description as TOML that a person can go on with: tables in the order of the reference, defaults left out.

mod material;
mod shape;
mod value;

use std::fmt::Write as _;

use crate::desc::{
    Camera, CameraKind, DirectLight, Displacement, EdgeLength, Emission, EmissionAmount, Exposure,
    FilterKind, FovAxis, Instance, Light, LightKind, MaterialRef, Object, PhotonFilter, PointAmount,
    ProfileAmount, SceneDesc, Shape, SkyMapping, SunSky, TransformStep, VcmTechniques, WhiteBalance,
};
use crate::spec::{self, Section};
use material::{material_fields, texture_fields};
use shape::shape_fields;
use value::{Fields, number, quote, triple};

/// The text of a description: [`parse`](crate::parse) of it gives an equal description, if the base folder is the same
/// and every value is one that a scene file may have. File names are written as they are.
pub fn to_toml(desc: &SceneDesc) -> String {
    let mut out = String::new();
    for (header, fields) in [("[render]", render(desc)), ("[film]", film(desc))] {
        block(&mut out, header, &fields, false);
    }
    if let Some(camera) = &desc.camera {
        block(&mut out, "[camera]", &camera_fields(camera), true);
    }
    for (header, fields) in [("[photon_map]", photon_map(desc)), ("[sppm]", sppm(desc)), ("[vcm]", vcm(desc))]
    {
        block(&mut out, header, &fields, false);
    }
    for (name, texture) in &desc.textures {
        block(&mut out, &format!("[textures.{}]", value::key(name)), &texture_fields(texture), true);
    }
    for (name, material) in &desc.materials {
        block(&mut out, &format!("[materials.{}]", value::key(name)), &material_fields(material), true);
    }
    for object in &desc.objects {
        block(&mut out, "[[objects]]", &object_fields(object), true);
    }
    for light in &desc.lights {
        block(&mut out, "[[lights]]", &light_fields(light), true);
    }
    for (name, group) in &desc.groups {
        let name = value::key(name);
        if group.objects.is_empty() {
            let _ = writeln!(out, "[groups.{name}]\nobjects = []\n");
        }
        for object in &group.objects {
            block(&mut out, &format!("[[groups.{name}.objects]]"), &object_fields(object), true);
        }
    }
    for instance in &desc.instances {
        block(&mut out, "[[instances]]", &instance_fields(instance), true);
    }
    while out.ends_with("\n\n") {
        out.pop();
    }
    out
}

/// A header and its keys; nothing where there are no keys and none are needed.
fn block(out: &mut String, header: &str, fields: &Fields, always: bool) {
    if fields.lines.is_empty() && !always {
        return;
    }
    let _ = writeln!(out, "{header}");
    for (key, value) in &fields.lines {
        let _ = writeln!(out, "{key} = {value}");
    }
    out.push('\n');
}

fn fields(section: &'static Section, kind: Option<&'static str>) -> Fields {
    Fields::new(section, kind)
}

fn render(desc: &SceneDesc) -> Fields {
    let render = &desc.render;
    let mut f = fields(&spec::RENDER, None);
    f.word("integrator", render.integrator.name());
    f.integer("passes", render.passes);
    f.integer("seed", render.seed);
    if let Some(depth) = render.max_depth {
        f.integer("max_depth", depth);
    }
    f.optional_number("noise", render.noise);
    f
}

fn film(desc: &SceneDesc) -> Fields {
    let film = &desc.film;
    let mut f = fields(&spec::FILM, None);
    f.pair("size", film.size.map(|x| x.to_string()));
    if let Some(crop) = film.crop {
        f.list("crop", &crop, u32::to_string);
    }
    f.word(
        "filter",
        match film.filter {
            FilterKind::Box => "box",
            FilterKind::Triangle => "triangle",
            FilterKind::Gaussian => "gaussian",
            FilterKind::Mitchell => "mitchell",
            FilterKind::BlackmanHarris => "blackman-harris",
        },
    );
    f.optional_number("filter_radius", film.filter_radius);
    match film.exposure {
        Exposure::Auto => f.word("exposure", "auto"),
        Exposure::Ev(ev) => f.number("exposure", ev),
    }
    match film.white_balance {
        WhiteBalance::None => f.word("white_balance", "none"),
        WhiteBalance::Auto => f.word("white_balance", "auto"),
        WhiteBalance::Kelvin(kelvin) => f.number("white_balance", kelvin),
        WhiteBalance::Illuminant(illuminant) => f.word("white_balance", illuminant.name()),
    }
    f.word("view", film.view.name());
    if let Some(lut) = &film.lut {
        f.text("lut", &lut.to_string_lossy());
    }
    f.word("denoise", film.denoise.name());
    let layers = [("techniques", film.layers.techniques), ("lights", film.layers.lights)];
    let wanted: Vec<_> = layers.into_iter().filter(|(_, wanted)| *wanted).collect();
    if !wanted.is_empty() {
        f.list("layers", &wanted, |(name, _)| quote(name));
    }
    f
}

fn camera_fields(camera: &Camera) -> Fields {
    let (kind, lens) = match camera.kind {
        CameraKind::Pinhole => ("pinhole", None),
        CameraKind::ThinLens { lens_radius, focus_distance } => {
            ("thin-lens", Some((lens_radius, focus_distance)))
        }
        CameraKind::Orthographic { .. } => ("orthographic", None),
        CameraKind::Spherical { .. } => ("spherical", None),
    };
    let mut f = fields(&spec::CAMERA, Some(kind));
    f.triple("position", camera.position);
    f.triple("look_at", camera.look_at);
    f.triple("up", camera.up);
    if matches!(camera.kind, CameraKind::Pinhole | CameraKind::ThinLens { .. }) {
        f.number("fov", camera.fov);
    }
    if !matches!(camera.kind, CameraKind::Spherical { .. }) {
        axis_and_shift(&mut f, camera);
    }
    match camera.kind {
        CameraKind::Orthographic { extent } => f.number("extent", extent),
        CameraKind::Spherical { mapping } => sky_mapping(&mut f, mapping),
        CameraKind::Pinhole | CameraKind::ThinLens { .. } => {}
    }
    if let Some((lens_radius, focus_distance)) = lens {
        f.number("lens_radius", lens_radius);
        f.optional_number("focus_distance", focus_distance);
    }
    f
}

fn sky_mapping(f: &mut Fields, mapping: SkyMapping) {
    f.word(
        "mapping",
        match mapping {
            SkyMapping::LatLong => "lat-long",
            SkyMapping::EqualArea => "equal-area",
        },
    );
}

fn axis_and_shift(f: &mut Fields, camera: &Camera) {
    f.word(
        "fov_axis",
        match camera.fov_axis {
            FovAxis::X => "x",
            FovAxis::Y => "y",
            FovAxis::Smaller => "smaller",
        },
    );
    f.pair("shift", camera.shift.map(number));
}

fn photon_map(desc: &SceneDesc) -> Fields {
    let map = &desc.photon_map;
    let kernel = |filter| match filter {
        PhotonFilter::Constant => "constant",
        PhotonFilter::Cone => "cone",
        PhotonFilter::Epanechnikov => "epanechnikov",
    };
    let mut f = fields(&spec::PHOTON_MAP, None);
    f.integer("photons", map.photons);
    f.integer("caustic_photons", map.caustic_photons);
    f.integer("knn", map.knn);
    f.integer("caustic_knn", map.caustic_knn);
    f.word("filter", kernel(map.filter));
    f.word("caustic_filter", kernel(map.caustic_filter));
    f.optional_number("radius", map.radius);
    f.optional_number("caustic_radius", map.caustic_radius);
    f.integer("final_gather", map.final_gather);
    f.number("caustic_gain", map.caustic_gain);
    f
}

fn sppm(desc: &SceneDesc) -> Fields {
    let sppm = &desc.sppm;
    let mut f = fields(&spec::SPPM, None);
    if let Some(photons) = sppm.photons {
        f.integer("photons", photons);
    }
    f.optional_number("radius", sppm.radius);
    f.number("radius_pixels", sppm.radius_pixels);
    f.number("alpha", sppm.alpha);
    f.word(
        "direct",
        match sppm.direct {
            DirectLight::Sampling => "sampling",
            DirectLight::Photons => "photons",
        },
    );
    f
}

fn vcm(desc: &SceneDesc) -> Fields {
    let vcm = &desc.vcm;
    let mut f = fields(&spec::VCM, None);
    f.word(
        "techniques",
        match vcm.techniques {
            VcmTechniques::Vcm => "vcm",
            VcmTechniques::Bdpt => "bdpt",
            VcmTechniques::LightTracing => "light-tracing",
            VcmTechniques::Bpm => "bpm",
            VcmTechniques::Ppm => "ppm",
        },
    );
    if let Some(paths) = vcm.light_paths {
        f.integer("light_paths", paths);
    }
    f.optional_number("radius", vcm.radius);
    f.number("radius_pixels", vcm.radius_pixels);
    f.number("alpha", vcm.alpha);
    f
}

fn material_at(f: &mut Fields, key: &'static str, material: &MaterialRef) {
    match material {
        MaterialRef::Named(name) => f.text(key, name),
        MaterialRef::Inline(material) => f.raw(key, material_fields(material).inline()),
    }
}

fn material_ref(f: &mut Fields, material: Option<&MaterialRef>) {
    if let Some(material) = material {
        material_at(f, "material", material);
    }
}

fn transform(f: &mut Fields, steps: &[TransformStep]) {
    let step = |step: &TransformStep| match step {
        TransformStep::Translate(by) => format!("{{ translate = {} }}", triple(*by)),
        TransformStep::Rotate { axis, degrees } => {
            format!("{{ rotate = {{ axis = {}, degrees = {} }} }}", triple(*axis), number(*degrees))
        }
        TransformStep::Scale(by) => format!("{{ scale = {} }}", triple(*by)),
        TransformStep::LookAt { position, target, up } => format!(
            "{{ look_at = {{ position = {}, target = {}, up = {} }} }}",
            triple(*position),
            triple(*target),
            triple(*up)
        ),
        TransformStep::Matrix(m) => format!("{{ matrix = [{}] }}", m.map(number).join(", ")),
    };
    if !steps.is_empty() {
        f.raw("transform", format!("[{}]", steps.iter().map(step).collect::<Vec<_>>().join(", ")));
    }
}

fn object_fields(object: &Object) -> Fields {
    let mut f = shape_fields(&object.shape);
    if let Some(name) = &object.name {
        f.first("name", quote(name));
    }
    material_ref(&mut f, object.material.as_ref());
    transform(&mut f, &object.transform);
    if let Some(displacement) = &object.displacement {
        f.raw("displacement", displacement_text(displacement));
    }
    f.bool("flip_normals", object.flip_normals);
    if let Some(emission) = &object.emission {
        emission_fields(&mut f, emission);
    }
    if let Some(group) = &object.light_group {
        f.text("light_group", group);
    }
    f
}

fn displacement_text(displacement: &Displacement) -> String {
    let Displacement { texture, scale, midlevel, edge } = displacement;
    let edge = match *edge {
        EdgeLength::Units(length) => format!(", edge_length = {}", number(length)),
        EdgeLength::Pixels(pixels) => format!(", edge_pixels = {}", number(pixels)),
    };
    let (scale, midlevel) = (number(*scale), number(*midlevel));
    format!("{{ texture = {}, scale = {scale}, midlevel = {midlevel}{edge} }}", quote(texture))
}

fn emission_fields(f: &mut Fields, emission: &Emission) {
    match emission.amount {
        EmissionAmount::Radiance(radiance) => f.triple("radiance", radiance),
        EmissionAmount::Power { watts, color } => power(f, watts, color),
    }
    if let Some(texture) = &emission.texture {
        f.text("emission_texture", texture);
    }
    if emission.two_sided {
        f.raw("two_sided_emission", "true".into());
    }
}

fn power(f: &mut Fields, watts: f32, color: [f32; 3]) {
    f.number("power", watts);
    if color != [1.0; 3] {
        f.triple("color", color);
    }
}

/// The word for a shape in scene files: "quad".
pub fn shape_kind(shape: &Shape) -> &'static str {
    match shape {
        // Not written out: they may be many.
        Shape::Triangles { .. } => "triangles",
        shape => shape_fields(shape).kind.unwrap_or_default(),
    }
}

/// The word for a light in scene files: "point".
pub fn light_kind(light: &Light) -> &'static str {
    light_fields(light).kind.unwrap_or_default()
}

fn light_fields(light: &Light) -> Fields {
    let amount = |f: &mut Fields, amount: &PointAmount| match amount {
        PointAmount::Intensity(intensity) => f.triple("intensity", *intensity),
        PointAmount::Power { watts, color } => power(f, *watts, *color),
    };
    let mut f;
    match &light.kind {
        LightKind::Point { position, amount: much } => {
            f = fields(&spec::LIGHTS, Some("point"));
            f.triple("position", *position);
            amount(&mut f, much);
        }
        LightKind::Spot { position, direction, cone_angle, falloff_angle, amount: much } => {
            f = fields(&spec::LIGHTS, Some("spot"));
            f.triple("position", *position);
            f.triple("direction", *direction);
            f.number("cone_angle", *cone_angle);
            // Always: the default gives way to narrow cones.
            f.raw("falloff_angle", number(*falloff_angle));
            amount(&mut f, much);
        }
        LightKind::Directional { direction, irradiance } => {
            f = fields(&spec::LIGHTS, Some("directional"));
            f.triple("direction", *direction);
            f.triple("irradiance", *irradiance);
        }
        LightKind::Environment { radiance } => {
            f = fields(&spec::LIGHTS, Some("environment"));
            f.triple("radiance", *radiance);
        }
        LightKind::Sky { source, mapping, scale, transform: steps } => {
            f = fields(&spec::LIGHTS, Some("environment"));
            f.text("file", &source.written());
            sky_mapping(&mut f, *mapping);
            f.color("scale", &(*scale).into());
            transform(&mut f, steps);
        }
        LightKind::SunSky(sky) => f = sun_sky_fields(sky),
        LightKind::Profile { file, transform: steps, amount } => {
            f = fields(&spec::LIGHTS, Some("profile"));
            f.text("file", &file.to_string_lossy());
            match amount {
                ProfileAmount::AsFile { scale, color } => {
                    f.number("scale", *scale);
                    f.color("color", &(*color).into());
                }
                ProfileAmount::Power { watts, color } => power(&mut f, *watts, *color),
            }
            transform(&mut f, steps);
        }
        LightKind::Goniometric { source, mapping, intensity, transform: steps } => {
            f = fields(&spec::LIGHTS, Some("goniometric"));
            f.text("file", &source.written());
            sky_mapping(&mut f, *mapping);
            f.triple("intensity", *intensity);
            transform(&mut f, steps);
        }
        LightKind::Projector { source, fov, intensity, transform: steps } => {
            f = fields(&spec::LIGHTS, Some("projector"));
            f.text("file", &source.written());
            f.number("fov", *fov);
            f.triple("intensity", *intensity);
            transform(&mut f, steps);
        }
    }
    if let Some(name) = &light.name {
        f.first("name", quote(name));
    }
    if let Some(group) = &light.light_group {
        f.text("light_group", group);
    }
    f
}

fn sun_sky_fields(sky: &SunSky) -> Fields {
    let mut f = fields(&spec::LIGHTS, Some("sun-sky"));
    f.triple("sun_direction", sky.sun_direction);
    f.number("turbidity", sky.turbidity);
    f.color("ground_albedo", &sky.ground_albedo.into());
    f.number("sun_scale", sky.sun_scale);
    f.number("sun_angle", sky.sun_angle);
    f.number("sky_scale", sky.sky_scale);
    transform(&mut f, &sky.transform);
    f
}

fn instance_fields(instance: &Instance) -> Fields {
    let mut f = fields(&spec::INSTANCES, None);
    if let Some(name) = &instance.name {
        f.text("name", name);
    }
    f.text("group", &instance.group);
    material_ref(&mut f, instance.material.as_ref());
    transform(&mut f, &instance.transform);
    f
}
