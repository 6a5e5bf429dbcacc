//! Textures and materials.

use crate::desc::{
    ColorSpace, FloatDesc, Material, MaterialKind, MaterialRef, Metal, Texture, TextureFilter, Wrap,
};
use crate::diagnostic::{Diagnostic, Report};
use crate::document::{Node, Value};
use crate::reader::{Reader, as_table};
use crate::source::Sourced;
use crate::spec;

/// A texture, or a grey one after a mistake.
pub(super) fn texture(report: &mut Report, what: String, node: &Node) -> Texture {
    read_texture(report, what, node).unwrap_or_else(|| Texture::checker(0.5, 0.5, [1.0; 2]))
}

fn read_texture(report: &mut Report, what: String, node: &Node) -> Option<Texture> {
    let table = as_table(report, &what, node)?;
    let r = Reader::new(report, &spec::TEXTURES, what, table, node.span);
    match r.variant()? {
        "image" => {
            let file = r.file(report, "file");
            let color_space = r.word(report, "color_space").map(|word| match word {
                "linear" => ColorSpace::Linear,
                _ => ColorSpace::Srgb,
            });
            let wrap = r.word(report, "wrap").map(|word| match word {
                "clamp" => Wrap::Clamp,
                "mirror" => Wrap::Mirror,
                _ => Wrap::Repeat,
            });
            let filter = r.word(report, "filter").map(|word| match word {
                "bilinear" => TextureFilter::Bilinear,
                "nearest" => TextureFilter::Nearest,
                _ => TextureFilter::Trilinear,
            });
            let scale = r.pair(report, "scale");
            let offset = r.pair(report, "offset");
            Some(Texture::Image {
                file: file?,
                color_space: color_space?,
                wrap: wrap?,
                filter: filter?,
                scale: scale?,
                offset: offset?,
            })
        }
        _ => {
            let a = r.color_desc(report, "a");
            let b = r.color_desc(report, "b");
            let scale = r.pair(report, "scale");
            Some(Texture::Checker { a: a?, b: b?, scale: scale? })
        }
    }
}

/// A material, or a grey one after a mistake.
pub(super) fn material(report: &mut Report, what: String, node: &Node) -> Material {
    read_material(report, what, node).unwrap_or_else(|| Material::diffuse(0.5))
}

fn read_material(report: &mut Report, what: String, node: &Node) -> Option<Material> {
    let table = as_table(report, &what, node)?;
    let r = Reader::new(report, &spec::MATERIALS, what, table, node.span);
    let normal_map = r.optional_text(report, "normal_map");
    let normal_strength = r.number(report, "normal_strength");
    let variant = r.variant()?;
    let two_sided = if variant == "dielectric" { Some(true) } else { r.bool(report, "two_sided") };
    let kind = match variant {
        "diffuse" => r.color_desc(report, "color").map(|color| MaterialKind::Diffuse { color }),
        "phong" => phong(report, &r),
        "mirror" => r.color_desc(report, "color").map(|color| MaterialKind::Mirror { color }),
        "dielectric" => {
            let ior = r.ior(report, "ior");
            let color = r.color_desc(report, "color");
            let priority = r.integer(report, "priority");
            ior.zip(color).zip(priority).map(|((ior, color), priority)| MaterialKind::Dielectric {
                ior,
                color,
                priority,
            })
        }
        "conductor" => {
            let metal = metal(report, &r);
            let roughness = roughness(report, &r);
            metal.zip(roughness).map(|(metal, roughness)| MaterialKind::Conductor { metal, roughness })
        }
        _ => {
            let color = r.color_desc(report, "color");
            let ior = r.ior(report, "ior");
            let roughness = roughness(report, &r);
            color.zip(ior).zip(roughness).map(|((color, ior), roughness)| MaterialKind::Plastic {
                color,
                ior,
                roughness,
            })
        }
    };
    Some(Material {
        kind: kind?,
        normal_map: normal_map?,
        normal_strength: normal_strength?,
        two_sided: two_sided?,
    })
}

fn phong(report: &mut Report, r: &Reader<'_>) -> Option<MaterialKind> {
    let diffuse = r.color_desc(report, "diffuse");
    let specular = r.color_desc(report, "specular");
    let exponent = r.float_desc(report, "exponent");
    Some(MaterialKind::Phong { diffuse: diffuse?, specular: specular?, exponent: exponent? })
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

fn roughness(report: &mut Report, r: &Reader<'_>) -> Option<FloatDesc> {
    let roughness = r.float_desc(report, "roughness");
    let alpha = r.optional_number(report, "alpha");
    if let (Some(a), Some(b)) = (r.given("roughness"), r.given("alpha")) {
        r.conflict(report, a, b);
        return None;
    }
    match alpha? {
        Some(alpha) => Some(FloatDesc::Value((alpha as f64).sqrt() as f32)),
        None => roughness,
    }
}

/// The material of an object: a name, or a material in place.
pub(super) fn reference(report: &mut Report, r: &Reader<'_>) -> Option<MaterialRef> {
    let node = &r.given("material")?.node;
    match &node.value {
        Value::Text(name) => Some(MaterialRef::Named(Sourced::at(name.clone(), node.span))),
        Value::Table(_) => {
            let what = format!("the material of {}", r.what);
            Some(MaterialRef::Inline(Box::new(material(report, what, node))))
        }
        _ => {
            crate::convert::wrong_type(
                report,
                &r.label("material"),
                "the name of a material or { kind = … }",
                node,
            );
            Some(Material::diffuse(0.5).into())
        }
    }
}
