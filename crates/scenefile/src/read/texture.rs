//! Textures.

use crate::desc::{ColorSpace, Image, ImageSource, Mapping, Texture, TextureFilter, Wrap};
use crate::diagnostic::Report;
use crate::document::Node;
use crate::reader::{Reader, as_table};
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
            Some(Texture::Image(Image {
                color_space: color_space?,
                wrap: [wrap?; 2],
                filter: filter?,
                mapping: Mapping::Uv { set: 0, scale: scale?, rotation: 0.0, offset: offset? },
                ..Image::new(ImageSource::File(file?))
            }))
        }
        _ => {
            let a = r.color_desc(report, "a");
            let b = r.color_desc(report, "b");
            let scale = r.pair(report, "scale");
            Some(Texture::Checker { a: a?, b: b?, mapping: Mapping::scaled(scale?) })
        }
    }
}
