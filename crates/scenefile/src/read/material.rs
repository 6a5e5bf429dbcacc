//! Materials.

use crate::desc::{
    CoatedConductor, CoatedDiffuse, Conductor, Dielectric, Facets, Material, MaterialKind, MaterialRef,
    Metal, Principled, Roughness, ThinDielectric, ThinFilm, Triple,
};
use crate::diagnostic::{Diagnostic, Report};
use crate::document::{Node, Value};
use crate::preset;
use crate::reader::{Reader, as_table};
use crate::source::Sourced;
use crate::spec;

/// A material, or a grey one after a mistake.
pub(super) fn material(report: &mut Report, what: String, node: &Node) -> Material {
    read_material(report, what, node).unwrap_or_else(|| Material::diffuse(0.5))
}

fn read_material(report: &mut Report, what: String, node: &Node) -> Option<Material> {
    let table = as_table(report, &what, node)?;
    let table = preset::resolved(report, &what, table)?;
    let r = Reader::new(report, &spec::MATERIALS, what, &table, node.span);
    let normal_map = r.optional_text(report, "normal_map");
    let opacity = r.float_desc(report, "opacity");
    let opacity_cutoff = r.optional_number(report, "opacity_cutoff");
    let normal_strength = r.number(report, "normal_strength");
    let bump_map = r.optional_text(report, "bump_map");
    let bump_height = r.number(report, "bump_height");
    let rotation = r.float_desc(report, "rotation");
    let kind = kind(report, &r, r.variant()?);
    let sided = r.has("two_sided");
    let two_sided = if sided { r.bool(report, "two_sided") } else { Some(true) };
    Some(Material {
        kind: kind?,
        normal_map: normal_map?,
        opacity: opacity?,
        opacity_cutoff: opacity_cutoff?,
        normal_strength: normal_strength?,
        bump_map: bump_map?,
        bump_height: bump_height?,
        rotation: rotation?,
        two_sided: two_sided?,
    })
}

fn kind(report: &mut Report, r: &Reader<'_>, variant: &str) -> Option<MaterialKind> {
    match variant {
        "diffuse" => r.color_desc(report, "color").map(|color| MaterialKind::Diffuse { color }),
        "phong" => {
            let diffuse = r.color_desc(report, "diffuse");
            let specular = r.color_desc(report, "specular");
            let exponent = r.float_desc(report, "exponent");
            Some(MaterialKind::Phong { diffuse: diffuse?, specular: specular?, exponent: exponent? })
        }
        "mirror" => r.color_desc(report, "color").map(|color| MaterialKind::Mirror { color }),
        "dielectric" => dielectric(report, r).map(MaterialKind::Dielectric),
        "conductor" => conductor(report, r).map(MaterialKind::Conductor),
        "plastic" => {
            let color = r.color_desc(report, "color");
            let ior = r.ior(report, "ior");
            let roughness = roughness(report, r);
            Some(MaterialKind::Plastic { color: color?, ior: ior?, roughness: roughness? })
        }
        "rough-diffuse" => {
            let color = r.color_desc(report, "color");
            let roughness = r.float_desc(report, "roughness");
            Some(MaterialKind::RoughDiffuse { color: color?, roughness: roughness? })
        }
        "diffuse-transmission" => {
            let reflectance = r.color_desc(report, "reflectance");
            let transmittance = r.color_desc(report, "transmittance");
            Some(MaterialKind::DiffuseTransmission {
                reflectance: reflectance?,
                transmittance: transmittance?,
            })
        }
        "sheen" => {
            let color = r.color_desc(report, "color");
            let roughness = r.float_desc(report, "roughness");
            Some(MaterialKind::Sheen { color: color?, roughness: roughness? })
        }
        "thin-dielectric" => {
            let ior = r.ior(report, "ior");
            let color = r.color_desc(report, "color");
            let specular = r.color_desc(report, "specular");
            let roughness = roughness(report, r);
            Some(MaterialKind::ThinDielectric(ThinDielectric {
                ior: ior?,
                color: color?,
                specular: specular?,
                roughness: roughness?,
            }))
        }
        "coated-diffuse" => coated_diffuse(report, r).map(MaterialKind::CoatedDiffuse),
        "coated-conductor" => coated_conductor(report, r).map(MaterialKind::CoatedConductor),
        "mix" => {
            let a = required_reference(report, r, "a");
            let b = required_reference(report, r, "b");
            let amount = r.float_desc(report, "amount");
            Some(MaterialKind::Mix { a: a?, b: b?, amount: amount? })
        }
        _ => principled(report, r).map(|p| MaterialKind::Principled(Box::new(p))),
    }
}

fn dielectric(report: &mut Report, r: &Reader<'_>) -> Option<Dielectric> {
    let ior = r.ior(report, "ior");
    let outside_ior = r.optional_number(report, "outside_ior");
    let color = r.color_desc(report, "color");
    let specular = r.color_desc(report, "specular");
    let roughness = roughness(report, r);
    let facets = facets(report, r);
    let film = film(report, r);
    let absorption = absorption(report, r);
    let priority = r.integer(report, "priority");
    Some(Dielectric {
        ior: ior?,
        outside_ior: outside_ior?,
        color: color?,
        specular: specular?,
        roughness: roughness?,
        facets: facets?,
        film: film?,
        absorption: absorption?,
        priority: priority?,
    })
}

fn conductor(report: &mut Report, r: &Reader<'_>) -> Option<Conductor> {
    let metal = metal(report, r);
    let specular = r.color_desc(report, "specular");
    let roughness = roughness(report, r);
    let facets = facets(report, r);
    let film = film(report, r);
    Some(Conductor {
        metal: metal?,
        specular: specular?,
        roughness: roughness?,
        facets: facets?,
        film: film?,
    })
}

fn coated_diffuse(report: &mut Report, r: &Reader<'_>) -> Option<CoatedDiffuse> {
    let color = r.color_desc(report, "color");
    let specular = r.color_desc(report, "specular");
    let ior = r.ior(report, "ior");
    let roughness = roughness(report, r);
    let facets = facets(report, r);
    let nonlinear = r.bool(report, "nonlinear");
    let depth = r.number(report, "depth");
    Some(CoatedDiffuse {
        color: color?,
        specular: specular?,
        ior: ior?,
        roughness: roughness?,
        facets: facets?,
        nonlinear: nonlinear?,
        depth: depth?,
    })
}

fn coated_conductor(report: &mut Report, r: &Reader<'_>) -> Option<CoatedConductor> {
    let metal = metal(report, r);
    let roughness = roughness(report, r);
    let ior = r.ior(report, "ior");
    let coat_roughness = r.float_desc(report, "coat_roughness");
    let depth = r.number(report, "depth");
    let facets = facets(report, r);
    Some(CoatedConductor {
        metal: metal?,
        roughness: roughness?,
        ior: ior?,
        coat_roughness: coat_roughness?,
        depth: depth?,
        facets: facets?,
    })
}

fn principled(report: &mut Report, r: &Reader<'_>) -> Option<Principled> {
    let base_color = r.color_desc(report, "base_color");
    let metallic = r.float_desc(report, "metallic");
    let roughness = roughness(report, r);
    let ior = r.ior(report, "ior");
    let specular = r.float_desc(report, "specular");
    let specular_color = r.color_desc(report, "specular_color");
    let transmission = r.float_desc(report, "transmission");
    let thin = r.bool(report, "thin");
    let diffuse_transmission = r.float_desc(report, "diffuse_transmission");
    let sheen_color = r.color_desc(report, "sheen_color");
    let sheen_roughness = r.float_desc(report, "sheen_roughness");
    let clearcoat = r.float_desc(report, "clearcoat");
    let clearcoat_roughness = r.float_desc(report, "clearcoat_roughness");
    let film = r.float_desc(report, "film");
    let film_thickness_nm = r.float_desc(report, "film_thickness");
    let film_ior = r.number(report, "film_ior");
    let absorption = absorption(report, r);
    let priority = r.integer(report, "priority");
    Some(Principled {
        base_color: base_color?,
        metallic: metallic?,
        roughness: roughness?,
        ior: ior?,
        specular: specular?,
        specular_color: specular_color?,
        transmission: transmission?,
        thin: thin?,
        diffuse_transmission: diffuse_transmission?,
        sheen_color: sheen_color?,
        sheen_roughness: sheen_roughness?,
        clearcoat: clearcoat?,
        clearcoat_roughness: clearcoat_roughness?,
        film: film?,
        film_thickness_nm: film_thickness_nm?,
        film_ior: film_ior?,
        absorption: absorption?,
        priority: priority?,
    })
}

fn facets(report: &mut Report, r: &Reader<'_>) -> Option<Facets> {
    r.word(report, "facets").map(|word| match word {
        "single-bounce" => Facets::SingleBounce,
        "separable" => Facets::Separable,
        "beckmann" => Facets::Beckmann,
        _ => Facets::Conserving,
    })
}

fn film(report: &mut Report, r: &Reader<'_>) -> Option<ThinFilm> {
    let thickness_nm = r.number(report, "film_thickness");
    let ior = r.number(report, "film_ior");
    Some(ThinFilm { thickness_nm: thickness_nm?, ior: ior? })
}

fn metal(report: &mut Report, r: &Reader<'_>) -> Option<Metal> {
    let name = r.optional_text(report, "metal");
    let n = r.optional_color(report, "n");
    let k = r.optional_color(report, "k");
    if let (Some(a), Some(b)) = (r.given("metal"), r.given("n").or(r.given("k"))) {
        r.conflict(report, a, b);
        return None;
    }
    match (name?, n?, k?) {
        (Some(name), ..) => Some(Metal::Named(name)),
        (None, Some(n), Some(k)) => Some(Metal::Index { n, k }),
        (None, None, None) => {
            let message = format!("missing `metal` in {}", r.what);
            report.push(
                Diagnostic::error("missing-key", message)
                    .at(r.span)
                    .help("give `metal`, or `n` and `k` for another"),
            );
            None
        }
        (None, n, _) => {
            r.missing(report, if n.is_none() { "n" } else { "k" });
            None
        }
    }
}

/// Either `absorption`, or `attenuation_color` and `attenuation_distance`.
fn absorption(report: &mut Report, r: &Reader<'_>) -> Option<Triple> {
    let absorption = r.color(report, "absorption");
    let left = r.optional_color(report, "attenuation_color");
    let distance = r.optional_number(report, "attenuation_distance");
    let pair = ["attenuation_color", "attenuation_distance"].map(|name| r.given(name));
    if let (Some(a), Some(b)) = (r.given("absorption"), pair[0].or(pair[1])) {
        r.conflict(report, a, b);
        return None;
    }
    let (color, distance) = match (left?, distance?) {
        (None, None) => return absorption,
        (Some(color), Some(distance)) => (color, distance),
        (color, _) => {
            let (given, other) = match color {
                Some(_) => ("attenuation_color", "attenuation_distance"),
                None => ("attenuation_distance", "attenuation_color"),
            };
            let message = format!("`{given}` without `{other}` in {}", r.what);
            report.push(Diagnostic::error("conflict", message).at(r.given(given)?.key_span));
            return None;
        }
    };
    let absorption = color.map(|c| (-f64::from(c).ln() / f64::from(distance)).max(0.0) as f32);
    if !absorption.iter().all(|x| x.is_finite()) {
        let message = format!("{} is too short: nothing passes", r.label("attenuation_distance"));
        report
            .push(Diagnostic::error("out-of-range", message).at(r.given("attenuation_distance")?.node.span));
        return None;
    }
    Some(absorption)
}

/// Either `roughness` and `anisotropy`, or `alpha` and `alpha_across`.
fn roughness(report: &mut Report, r: &Reader<'_>) -> Option<Roughness> {
    let roughness = r.float_desc(report, "roughness");
    let anisotropy = r.float_desc(report, "anisotropy");
    let along = r.optional_float_desc(report, "alpha");
    let across = r.optional_float_desc(report, "alpha_across");
    let perceived = r.given("roughness").or(r.given("anisotropy"));
    if let (Some(a), Some(b)) = (perceived, r.given("alpha").or(r.given("alpha_across"))) {
        r.conflict(report, a, b);
        return None;
    }
    if let (None, Some(entry)) = (r.given("alpha"), r.given("alpha_across")) {
        let message = format!("`alpha_across` without `alpha` in {}", r.what);
        report.push(Diagnostic::error("conflict", message).at(entry.key_span));
        return None;
    }
    match (along?, across?) {
        (Some(along), across) => {
            Some(Roughness::Alpha { across: across.unwrap_or_else(|| along.clone()), along })
        }
        (None, _) => Some(Roughness::Perceived { roughness: roughness?, anisotropy: anisotropy? }),
    }
}

/// The material of an object: a name, or a material in place.
pub(super) fn reference(report: &mut Report, r: &Reader<'_>) -> Option<MaterialRef> {
    reference_at(report, r, "material")
}

fn required_reference(report: &mut Report, r: &Reader<'_>, name: &str) -> Option<MaterialRef> {
    if r.given(name).is_none() {
        r.missing(report, name);
    }
    reference_at(report, r, name)
}

fn reference_at(report: &mut Report, r: &Reader<'_>, name: &str) -> Option<MaterialRef> {
    let node = &r.given(name)?.node;
    match &node.value {
        Value::Text(name) => Some(MaterialRef::Named(Sourced::at(name.clone(), node.span))),
        Value::Table(_) => {
            let what = match name {
                "material" => format!("the material of {}", r.what),
                part => format!("material `{part}` of {}", r.what),
            };
            Some(MaterialRef::Inline(Box::new(material(report, what, node))))
        }
        _ => {
            crate::convert::wrong_type(
                report,
                &r.label(name),
                "the name of a material, { kind = … } or { preset = \"NAME\" }",
                node,
            );
            Some(Material::diffuse(0.5).into())
        }
    }
}
