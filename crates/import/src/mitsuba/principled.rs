//! The principled BSDFs: Disney's of 2012 and 2015 (Burley).

use std::rc::Rc;

use scenefile::desc::{ColorDesc, FloatDesc, Material, Principled, Roughness};

use super::Importer;
use super::bsdf::Uv;
use super::plugin::Plugin;

/// `principled`, around a solid.
pub(super) fn solid(importer: &mut Importer, plugin: &Rc<Plugin>, uv: Uv) -> Material {
    plugin.ignore(&[
        "main_specular_sampling_rate",
        "clearcoat_sampling_rate",
        "diffuse_reflectance_sampling_rate",
    ]);
    let specular = plugin.number_or(&mut importer.report, "specular", 0.5).clamp(0.0, 1.0);
    // `specular` is the reflectance at normal incidence over 0.08 (Burley 2012).
    let root = (0.08 * specular).sqrt();
    let ior = match plugin.number(&mut importer.report, "eta") {
        Some(eta) => eta.clamp(1.0, 10.0),
        None => (1.0 + root) / (1.0 - root),
    };
    let mut base = shared(importer, plugin, uv, ior);
    let clearcoat = importer.float(plugin, "clearcoat", 0.0, uv);
    let gloss = importer.float(plugin, "clearcoat_gloss", 0.0, uv);
    // The coat's α goes from 0.1 to 0.001; ours is the square of the roughness.
    let alpha = match gloss {
        FloatDesc::Value(g) => 0.1 + (0.001 - 0.1) * g.clamp(0.0, 1.0),
        FloatDesc::Texture(_) => 0.05,
    };
    // Burley's coat has a quarter of the strength of one of index 1.5.
    base.clearcoat = match clearcoat {
        FloatDesc::Value(c) => FloatDesc::Value((0.25 * c).clamp(0.0, 1.0)),
        texture => {
            let text = "a texture of clear coat is stronger than in the principled model";
            importer.report.instead(text, "it is taken as it is", plugin.span);
            texture
        }
    };
    base.clearcoat_roughness = alpha.sqrt().into();
    base.into()
}

/// `principledthin`, a sheet.
pub(super) fn thin(importer: &mut Importer, plugin: &Rc<Plugin>, uv: Uv) -> Material {
    let names = [
        "spec_refl_sampling_rate",
        "spec_trans_sampling_rate",
        "diff_trans_sampling_rate",
        "diff_refl_sampling_rate",
    ];
    plugin.ignore(&names);
    let ior = plugin.number_or(&mut importer.report, "eta", 1.5).clamp(1.0, 10.0);
    let mut base = shared(importer, plugin, uv, ior);
    base.thin = true;
    // 0..=2, of which 1 is half of the light.
    base.diffuse_transmission = match importer.float(plugin, "diff_trans", 0.0, uv) {
        FloatDesc::Value(x) => FloatDesc::Value((x / 2.0).clamp(0.0, 1.0)),
        texture => texture,
    };
    base.into()
}

fn shared(importer: &mut Importer, plugin: &Rc<Plugin>, uv: Uv, ior: f64) -> Principled {
    let base_color = importer.color(plugin, &["base_color"], 0.5, uv);
    let roughness = importer.float(plugin, "roughness", 0.5, uv);
    let anisotropy = importer.float(plugin, "anisotropic", 0.0, uv);
    let sheen = importer.float(plugin, "sheen", 0.0, uv);
    let tint = importer.float(plugin, "sheen_tint", 0.0, uv);
    let specular_tint = importer.float(plugin, "spec_tint", 0.0, uv);
    if importer.float(plugin, "flatness", 0.0, uv) != FloatDesc::Value(0.0) {
        let text = "the flatness of a principled BSDF is not rendered";
        importer.report.instead(text, "its base is diffuse", plugin.span);
    }
    Principled {
        metallic: importer.float(plugin, "metallic", 0.0, uv),
        roughness: Roughness::Perceived { roughness, anisotropy },
        ior: (ior as f32).into(),
        specular_color: tinted(&base_color, &specular_tint, 1.0),
        transmission: importer.float(plugin, "spec_trans", 0.0, uv),
        sheen_color: match sheen {
            FloatDesc::Value(s) => tinted(&base_color, &tint, s.clamp(0.0, 1.0)),
            FloatDesc::Texture(name) => ColorDesc::Texture(name),
        },
        base_color,
        ..Principled::default()
    }
}

/// White made the base's hue by a share of `tint`, times `strength`.
fn tinted(base: &ColorDesc, tint: &FloatDesc, strength: f32) -> ColorDesc {
    let (ColorDesc::Rgb(rgb), FloatDesc::Value(t)) = (base, tint) else { return strength.into() };
    let luminance = color::luminance(*rgb);
    if luminance <= 0.0 {
        return strength.into();
    }
    let t = t.clamp(0.0, 1.0);
    ColorDesc::Rgb(rgb.map(|c| (strength * (1.0 - t + t * c / luminance)).clamp(0.0, 1.0)))
}
