//! Materials.

use super::*;

#[test]
fn materials_of_version_4() {
    assert_eq!(material("Material \"diffuse\""), MaterialKind::Diffuse { color: 0.5.into() });
    assert_eq!(
        material(
            "MakeNamedMaterial \"m\" \"string type\" \"diffuse\" \"rgb reflectance\" [.1 .2 .3]\nNamedMaterial \"m\""
        ),
        MaterialKind::Diffuse { color: [0.1, 0.2, 0.3].into() }
    );
    let alpha = |r: &Roughness| match r {
        Roughness::Alpha { along, across } => [along.clone(), across.clone()],
        other => panic!("{other:?}"),
    };
    let MaterialKind::Conductor(c) = material(
        "Material \"conductor\" \"float roughness\" .04 \"spectrum eta\" \"metal-Au-eta\" \"spectrum k\" \"metal-Au-k\"",
    ) else {
        panic!()
    };
    assert_eq!(c.metal, Metal::Named("Au".into()));
    assert_eq!(alpha(&c.roughness), [0.2.into(), 0.2.into()], "α = √0.04");
    let text = "Material \"conductor\" \"rgb eta\" [1 2 3] \"rgb k\" [4 5 6] \"float uroughness\" .3 \"float vroughness\" .1 \"bool remaproughness\" false";
    let MaterialKind::Conductor(c) = material(text) else { panic!() };
    assert_eq!(c.metal, Metal::Index { n: [1.0, 2.0, 3.0], k: [4.0, 5.0, 6.0] });
    assert_eq!(alpha(&c.roughness), [0.3.into(), 0.1.into()]);
    let MaterialKind::Conductor(c) = material("Material \"conductor\" \"rgb reflectance\" [.25 .5 .75]")
    else {
        panic!()
    };
    let Metal::Index { n, k } = c.metal else { panic!() };
    // ((n − 1)² + k²)/((n + 1)² + k²) gives the reflectance back.
    close([0, 1, 2].map(|i| k[i] * k[i] / ((n[i] + 1.0).powi(2) + k[i] * k[i])), [0.25, 0.5, 0.75]);
    let MaterialKind::Dielectric(d) = material("Material \"dielectric\" \"spectrum eta\" \"glass-BK7\"")
    else {
        panic!()
    };
    assert!(matches!(d.ior, scenefile::desc::Ior::Value(n) if (n - 1.5168).abs() < 1e-4));
    assert!(matches!(material("Material \"thindielectric\""), MaterialKind::ThinDielectric(_)));
    assert!(matches!(
        material("Material \"coateddiffuse\" \"float thickness\" .02"),
        MaterialKind::CoatedDiffuse(_)
    ));
    assert!(matches!(
        material("Material \"coatedconductor\" \"float conductor.roughness\" .1"),
        MaterialKind::CoatedConductor(_)
    ));
    let MaterialKind::DiffuseTransmission { reflectance, .. } =
        material("Material \"diffusetransmission\" \"rgb reflectance\" [.2 .2 .2] \"float scale\" 2")
    else {
        panic!()
    };
    assert_eq!(reflectance, ColorDesc::Rgb([0.4; 3]));
    let text = "MakeNamedMaterial \"a\" \"string type\" \"diffuse\"\nMakeNamedMaterial \"b\" \"string type\" \"thindielectric\"\n\
                Material \"mix\" \"string materials\" [\"a\" \"b\"] \"float amount\"";
    let MaterialKind::Mix { a, b, amount } = material(&format!("{text} .25")) else { panic!() };
    assert_eq!((a, b, amount), ("a".into(), "b".into(), 0.25.into()));
    assert!(matches!(material(&format!("{text} 1")), MaterialKind::ThinDielectric(_)));
    // A surface that only bounds a medium is not there.
    assert!(
        world(&format!("Material \"interface\"\n{TRIANGLE}Material \"diffuse\"\n{TRIANGLE}")).objects.len()
            == 1
    );
}

#[test]
fn materials_of_version_3() {
    assert_eq!(
        material("Material \"matte\" \"color Kd\" [.1 .2 .3]"),
        MaterialKind::Diffuse { color: [0.1, 0.2, 0.3].into() }
    );
    assert_eq!(material("Material \"mirror\""), MaterialKind::Mirror { color: 0.9.into() });
    let MaterialKind::Dielectric(d) = material("Material \"glass\" \"float index\" 1.33") else { panic!() };
    assert_eq!(d.ior, 1.33.into());
    // With x = ln 0.01 its remapping gives 1.6214 − 3.7760 + 3.6775 − 1.6721 + 0.2882 = 0.1390.
    let MaterialKind::Conductor(c) = material("Material \"metal\" \"float roughness\" .01") else { panic!() };
    let Roughness::Alpha { along: FloatDesc::Value(a), .. } = c.roughness else { panic!() };
    assert!((a - 0.1390).abs() < 2e-4, "{a}");
    let (desc, warnings) = warned(&format!("Material \"substrate\" \"rgb Ks\" [.04 .04 .04]\n{TRIANGLE}"));
    let MaterialKind::CoatedDiffuse(c) = kind(&desc, &desc.objects[0]) else { panic!() };
    assert_eq!(warnings.len(), 1);
    assert!(
        matches!(c.ior, scenefile::desc::Ior::Value(n) if (n - 1.5).abs() < 1e-3),
        "0.04 is the glance of 1.5"
    );
}

/// The material of the last object, and the description.
fn last(text: &str) -> (SceneDesc, scenefile::desc::Material) {
    let (desc, _) = warned(&format!("{text}\n{TRIANGLE}"));
    let Some(MaterialRef::Named(name)) = &desc.objects.last().unwrap().material else { panic!() };
    let material = desc.materials[&name.value].value.clone();
    (desc, material)
}

#[test]
fn surfaces_that_are_there_in_part() {
    let text = "Texture \"holes\" \"float\" \"fbm\"\nMaterial \"diffuse\" \"rgb reflectance\" [.1 .2 .3]\n\
                Shape \"sphere\"\nShape \"sphere\" \"float alpha\" .25\nShape \"disk\" \"float alpha\" .25\n\
                Shape \"sphere\" \"texture alpha\" \"holes\"\nShape \"sphere\" \"float alpha\" 1\n";
    let desc = world(text);
    let opacity: Vec<FloatDesc> = desc
        .objects
        .iter()
        .map(|o| match &o.material {
            Some(MaterialRef::Named(name)) => desc.materials[&name.value].opacity.clone(),
            other => panic!("{other:?}"),
        })
        .collect();
    assert_eq!(opacity, [1.0.into(), 0.25.into(), 0.25.into(), FloatDesc::texture("holes"), 1.0.into()]);
    // One copy for each opacity.
    assert_eq!(desc.materials.len(), 3);
    assert!(
        desc.materials.values().all(|m| m.kind == MaterialKind::Diffuse { color: [0.1, 0.2, 0.3].into() })
    );
    // A mix with nothing; version 3's own.
    let mix = "MakeNamedMaterial \"a\" \"string type\" \"diffuse\"\nMakeNamedMaterial \"none\" \"string type\" \"interface\"\n\
               Material \"mix\" \"string materials\" [\"a\" \"none\"] \"float amount\" .25";
    assert_eq!(last(mix).1.opacity, 0.75.into());
    assert_eq!(last(&mix.replace("[\"a\" \"none\"]", "[\"none\" \"a\"]")).1.opacity, 0.25.into());
    assert_eq!(last("Material \"uber\" \"rgb opacity\" [.5 .25 0]").1.opacity, 0.25.into());
}

#[test]
fn bumps_and_what_fills_glass() {
    let (desc, material) = last(
        "Texture \"waves\" \"float\" \"windy\"\nTexture \"low\" \"float\" \"scale\" \"texture tex\" \"waves\" \"float scale\" 2\n\
         Material \"diffuse\" \"texture displacement\" \"low\"",
    );
    assert_eq!((material.bump_map.unwrap().value.as_str(), material.bump_height), ("low", 1.0));
    let Texture::Product { a, b } = &desc.textures["low"].value else { panic!() };
    assert_eq!((a, b), (&ColorDesc::texture("waves"), &ColorDesc::Rgb([2.0; 3])));
    let red = "MakeNamedMedium \"red\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [0 1 2] \"rgb sigma_s\" [0 0 0] \"float scale\" 3\n\
               MediumInterface \"red\" \"\"\nMaterial \"dielectric\"";
    let (_, material) = last(red);
    let MaterialKind::Dielectric(glass) = material.kind else { panic!() };
    assert_eq!(glass.absorption, [0.0, 3.0, 6.0]);
    let (_, warnings) = warned(&format!("{red}\nMaterial \"diffuse\"\n{TRIANGLE}"));
    assert!(warnings.len() == 1 && warnings[0].starts_with("a medium outside of glass"), "{warnings:?}");
}

#[test]
fn metals_and_coats_by_texture_and_medium() {
    let (_, material) =
        last("Texture \"m\" \"spectrum\" \"marble\"\nMaterial \"conductor\" \"texture reflectance\" \"m\"");
    let MaterialKind::Conductor(metal) = material.kind else { panic!() };
    assert_eq!(metal.specular, ColorDesc::texture("m"));
    let Metal::Index { n, k } = metal.metal else { panic!() };
    assert!(k[0] * k[0] / ((n[0] + 1.0).powi(2) + k[0] * k[0]) > 0.9998, "it reflects everything else");
    let (_, material) = last("Material \"coateddiffuse\" \"float thickness\" 2 \"rgb albedo\" [.75 .75 .75]");
    let MaterialKind::CoatedDiffuse(coated) = material.kind else { panic!() };
    close([coated.depth], [0.5]);
    let (_, material) =
        last("Material \"disney\" \"float metallic\" .5 \"float roughness\" .2 \"float spectrans\" 1");
    let MaterialKind::Principled(m) = material.kind else { panic!() };
    assert_eq!((m.metallic, m.transmission, m.thin), (0.5.into(), 1.0.into(), false));
}
