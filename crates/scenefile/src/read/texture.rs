//! Textures.

use crate::desc::{
    Channel, ColorSpace, Image, ImageSource, Mapping, Noise, NoiseKind, Texture, TextureFilter, Wrap,
};
use crate::diagnostic::{Diagnostic, Report};
use crate::document::Node;
use crate::reader::{Reader, as_table};
use crate::spec;

/// A texture, or a grey one after a mistake.
pub(super) fn texture(report: &mut Report, what: String, node: &Node) -> Texture {
    read_texture(report, what, node).unwrap_or_else(|| Texture::checker(0.5, 0.5, [1.0; 2]))
}

fn read_texture(report: &mut Report, what: String, node: &Node) -> Option<Texture> {
    let table = as_table(report, &what, node)?;
    let r = &Reader::new(report, &spec::TEXTURES, what, table, node.span);
    match r.variant()? {
        "image" => image(report, r).map(Texture::Image),
        "checker" => {
            let (a, b) = (r.color_desc(report, "a"), r.color_desc(report, "b"));
            let mapping = mapping(report, r);
            Some(Texture::Checker { a: a?, b: b?, mapping: mapping? })
        }
        "dots" => {
            let (inside, outside) = (r.color_desc(report, "inside"), r.color_desc(report, "outside"));
            let mapping = mapping(report, r);
            Some(Texture::Dots { inside: inside?, outside: outside?, mapping: mapping? })
        }
        "product" => {
            let (a, b) = (r.color_desc(report, "a"), r.color_desc(report, "b"));
            Some(Texture::Product { a: a?, b: b? })
        }
        "mix" => {
            let (a, b) = (r.color_desc(report, "a"), r.color_desc(report, "b"));
            let amount = r.float_desc(report, "amount");
            Some(Texture::Mix { a: a?, b: b?, amount: amount? })
        }
        "fbm" => noise(report, r, Some(NoiseKind::Fbm)),
        "wrinkled" => noise(report, r, Some(NoiseKind::Wrinkled)),
        "windy" => noise(report, r, Some(NoiseKind::Windy)),
        "marble" => {
            let (scale, variation) = (r.number(report, "scale"), r.number(report, "variation"));
            let kind = scale.zip(variation).map(|(scale, variation)| NoiseKind::Marble { scale, variation });
            noise(report, r, kind)
        }
        _ => channel(report, r).map(|channel| Texture::VertexColor { channel }),
    }
}

fn image(report: &mut Report, r: &Reader<'_>) -> Option<Image> {
    let file = r.file(report, "file");
    let color_space = r.word(report, "color_space").map(|word| match word {
        "linear" => ColorSpace::Linear,
        _ => ColorSpace::Srgb,
    });
    let wrap = r.word(report, "wrap").map(wrap_of);
    let wrap_v = r.optional_word(report, "wrap_v").map(|word| word.map(wrap_of));
    let filter = r.word(report, "filter").map(|word| match word {
        "bilinear" => TextureFilter::Bilinear,
        "nearest" => TextureFilter::Nearest,
        _ => TextureFilter::Trilinear,
    });
    let mapping = mapping(report, r);
    let channel = channel(report, r);
    let invert = r.bool(report, "invert");
    let factor = r.color(report, "factor");
    Some(Image {
        source: ImageSource::File(file?),
        color_space: color_space?,
        wrap: [wrap?, wrap_v?.unwrap_or(wrap?)],
        filter: filter?,
        mapping: mapping?,
        channel: channel?,
        invert: invert?,
        factor: factor?,
    })
}

fn wrap_of(word: &str) -> Wrap {
    match word {
        "clamp" => Wrap::Clamp,
        "mirror" => Wrap::Mirror,
        "black" => Wrap::Black,
        _ => Wrap::Repeat,
    }
}

fn channel(report: &mut Report, r: &Reader<'_>) -> Option<Channel> {
    r.word(report, "channel").map(|word| match word {
        "r" => Channel::Red,
        "g" => Channel::Green,
        "b" => Channel::Blue,
        "a" => Channel::Alpha,
        _ => Channel::Rgb,
    })
}

fn noise(report: &mut Report, r: &Reader<'_>, kind: Option<NoiseKind>) -> Option<Texture> {
    // Windy has its own.
    let octaves = if r.has("octaves") { r.integer(report, "octaves") } else { Some(8) };
    let roughness = if r.has("roughness") { r.number(report, "roughness") } else { Some(0.5) };
    let transform = super::object::transform(report, r);
    Some(Texture::Noise(Noise { kind: kind?, octaves: octaves?, roughness: roughness?, transform }))
}

/// Either by texture coordinates or by the place in the world.
fn mapping(report: &mut Report, r: &Reader<'_>) -> Option<Mapping> {
    let set = r.integer(report, "uv_set");
    let scale = r.pair(report, "scale");
    let rotation = r.number(report, "rotation");
    let offset = r.pair(report, "offset");
    let u = r.optional_point(report, "planar_u");
    let v = r.optional_point(report, "planar_v");
    let by_uv = ["uv_set", "scale", "rotation"].iter().find_map(|name| r.given(name));
    let planar = r.given("planar_u").or(r.given("planar_v"));
    if let (Some(a), Some(b)) = (by_uv, planar) {
        r.conflict(report, a, b);
        return None;
    }
    match (u?, v?) {
        (None, None) => Some(Mapping::Uv { set: set?, scale: scale?, rotation: rotation?, offset: offset? }),
        (Some(u), Some(v)) => Some(Mapping::Planar { u, v, offset: offset? }),
        (u, _) => {
            let (given, other) =
                if u.is_some() { ("planar_u", "planar_v") } else { ("planar_v", "planar_u") };
            let message = format!("`{given}` without `{other}` in {}", r.what);
            report.push(Diagnostic::error("conflict", message).at(planar?.key_span));
            None
        }
    }
}
