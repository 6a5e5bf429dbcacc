//! Textures as they are asked for. Pictures are decoded together, in parallel, and shared.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

use math::{Vec2, Vec3};
use scenefile::desc::{self, ColorDesc, FloatDesc, ImageSource, SceneDesc};
use scenefile::{Diagnostic, Sourced, Span};

use super::shapes;
use crate::Texture;
use crate::texture::{
    Channel, Checker, Dots, Encoding, Filter, ImageTexture, Mapping, Noise, NoiseKind, Picture, Source,
    TextureError, Wanted, Wrap,
};

/// Textures within textures, at most.
const DEEPEST: usize = 64;
/// Lookups that one lookup may become: textures may be parts of several others, which are parts of several others.
const MOST_LOOKUPS: u64 = 4096;

/// What a texture is read as.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Reading {
    /// As it says.
    Plain,
    /// As normals: never decoded as colour.
    Normals,
}

/// Bytes that hold a picture; those in memory are told by their address.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum File {
    Path(PathBuf),
    Embedded(usize),
}

/// A picture that some textures wait for.
struct Waiting<'d> {
    source: &'d ImageSource,
    file: File,
    encoding: Encoding,
    wanted: Wanted,
    textures: Vec<u32>,
    span: Option<Span>,
}

/// A picture that has been decoded.
struct Known {
    file: File,
    encoding: Encoding,
    wanted: Wanted,
    picture: Arc<Picture>,
}

pub(super) struct TextureLibrary<'d> {
    desc: &'d SceneDesc,
    pub textures: Vec<Texture>,
    /// Lookups that one lookup of each becomes.
    lookups: Vec<u64>,
    ids: BTreeMap<(&'d str, Reading), Option<u32>>,
    /// Those that are being built, outermost first.
    open: Vec<(&'d str, Reading)>,
    waiting: Vec<Waiting<'d>>,
    known: Vec<Known>,
    pub diagnostics: Vec<Diagnostic>,
}

impl<'d> TextureLibrary<'d> {
    pub fn new(desc: &'d SceneDesc) -> Self {
        Self {
            desc,
            textures: Vec::new(),
            lookups: Vec::new(),
            ids: BTreeMap::new(),
            open: Vec::new(),
            waiting: Vec::new(),
            known: Vec::new(),
            diagnostics: Vec::new(),
        }
    }

    /// The texture of a name; `None` where there is none or it is wrong, which is reported. Its pictures are there after
    /// [`Self::decode`].
    pub fn get(&mut self, name: &'d Sourced<String>, reading: Reading) -> Option<u32> {
        let key = (name.as_str(), reading);
        if let Some(&known) = self.ids.get(&key) {
            return known;
        }
        let Some(texture) = self.desc.textures.get(name.as_str()) else {
            let message = format!("there is no texture named `{}`", name.value);
            self.diagnostics.push(Diagnostic::error("unknown-texture", message).at(name.span));
            return None;
        };
        if self.open.contains(&key) || self.open.len() >= DEEPEST {
            let message = format!("texture `{}` is made of itself, or nested too deeply", name.value);
            self.diagnostics.push(Diagnostic::error("texture-cycle", message).at(name.span));
            return None;
        }
        self.open.push(key);
        let id = self.build(texture, reading);
        self.open.pop();
        self.ids.insert(key, id);
        id
    }

    fn build(&mut self, texture: &'d Sourced<desc::Texture>, reading: Reading) -> Option<u32> {
        let built = match &texture.value {
            desc::Texture::Image(image) => return Some(self.image(image, reading, texture.span)),
            desc::Texture::Checker { a, b, mapping: m } => {
                let (even, odd) = (self.color(a, reading)?, self.color(b, reading)?);
                // A square of the description is half a unit wide, one of the texture a whole one.
                Texture::Checker(Checker { even, odd, map: mapping(m).times(2.0) })
            }
            desc::Texture::Dots { inside, outside, mapping: m } => {
                let (inside, outside) = (self.color(inside, reading)?, self.color(outside, reading)?);
                Texture::Dots(Dots { inside, outside, map: mapping(m) })
            }
            desc::Texture::Product { a, b } => {
                Texture::Product(self.color(a, reading)?, self.color(b, reading)?)
            }
            desc::Texture::Mix { a, b, amount } => {
                let (a, b) = (self.color(a, reading)?, self.color(b, reading)?);
                let amount = match amount {
                    FloatDesc::Value(x) => Source::Constant([*x; 3]),
                    FloatDesc::Texture(name) => Source::Texture(self.get(name, Reading::Plain)?),
                };
                Texture::Mix(a, b, amount)
            }
            desc::Texture::Noise(noise) => Texture::Noise(self.noise(noise, texture.span)?),
            desc::Texture::VertexColor { channel: c } => Texture::VertexColor(channel(*c)),
        };
        let lookups = built
            .parts()
            .fold(1u64, |sum, id| sum.saturating_add(self.lookups.get(id as usize).copied().unwrap_or(1)));
        if lookups > MOST_LOOKUPS {
            let message = "this texture is made of too many others";
            let error = Diagnostic::error("too-large", message).at(texture.span);
            self.diagnostics.push(error.help(format!("one lookup may need at most {MOST_LOOKUPS}")));
            return None;
        }
        Some(self.push(built, lookups))
    }

    fn push(&mut self, texture: Texture, lookups: u64) -> u32 {
        self.textures.push(texture);
        self.lookups.push(lookups);
        (self.textures.len() - 1) as u32
    }

    fn color(&mut self, color: &'d ColorDesc, reading: Reading) -> Option<Source> {
        match color {
            ColorDesc::Rgb(rgb) => Some(Source::Constant(*rgb)),
            ColorDesc::Texture(name) => self.get(name, reading).map(Source::Texture),
        }
    }

    fn noise(&mut self, noise: &desc::Noise, span: Option<Span>) -> Option<Noise> {
        let kind = match noise.kind {
            desc::NoiseKind::Fbm => NoiseKind::Fbm,
            desc::NoiseKind::Wrinkled => NoiseKind::Wrinkled,
            desc::NoiseKind::Windy => NoiseKind::Windy,
            desc::NoiseKind::Marble { scale, variation } => NoiseKind::Marble { scale, variation },
        };
        let Some(transform) = shapes::transform(&noise.transform) else {
            self.diagnostics.push(shapes::singular(span));
            return None;
        };
        Some(Noise::new(kind, noise.octaves.min(32), noise.roughness, &transform))
    }

    /// A texture whose picture is yet to come.
    fn image(&mut self, image: &'d desc::Image, reading: Reading, span: Option<Span>) -> u32 {
        let mut texture = ImageTexture::new(Arc::new(Picture::one([0.0; 3])));
        texture.wrap = image.wrap.map(|wrap| match wrap {
            desc::Wrap::Repeat => Wrap::Repeat,
            desc::Wrap::Black => Wrap::Black,
            desc::Wrap::Clamp => Wrap::Clamp,
            desc::Wrap::Mirror => Wrap::Mirror,
        });
        texture.filter = match image.filter {
            desc::TextureFilter::Trilinear => Filter::Trilinear,
            desc::TextureFilter::Bilinear => Filter::Bilinear,
            desc::TextureFilter::Nearest => Filter::Nearest,
        };
        texture.map = mapping(&image.mapping);
        texture.channel = channel(image.channel);
        texture.invert = image.invert;
        texture.factor = image.factor;
        let wanted = texture.channel.wanted();
        let encoding = match image.color_space {
            desc::ColorSpace::Srgb if reading == Reading::Plain => Encoding::Srgb,
            _ => Encoding::Linear,
        };
        let id = self.push(Texture::Image(texture), 1);
        let (file, span) = match &image.source {
            ImageSource::File(file) => (File::Path(self.desc.resolve(file)), file.span),
            ImageSource::Embedded(embedded) => (File::Embedded(embedded.bytes.as_ptr() as usize), span),
        };
        let same = |w: &&mut Waiting<'_>| w.file == file && w.encoding == encoding;
        match self.waiting.iter_mut().find(same) {
            Some(waiting) => {
                if waiting.wanted != wanted {
                    waiting.wanted = Wanted::Both;
                }
                waiting.textures.push(id);
            }
            None => {
                let (source, textures) = (&image.source, vec![id]);
                self.waiting.push(Waiting { source, file, encoding, wanted, textures, span });
            }
        }
        id
    }

    /// Decodes the pictures that textures wait for, in parallel, each once.
    pub fn decode(&mut self) {
        let waiting = join_opacity(std::mem::take(&mut self.waiting));
        let (fresh, old): (Vec<_>, Vec<_>) =
            waiting.into_iter().partition(|waiting| self.find(waiting).is_none());
        for waiting in old {
            if let Some(picture) = self.find(&waiting) {
                self.hand_out(&waiting.textures, &picture);
            }
        }
        let desc = self.desc;
        let decoded = par::map(fresh.len(), |i| read(desc, &fresh[i]));
        for (waiting, decoded) in fresh.into_iter().zip(decoded) {
            match decoded {
                Ok(picture) => {
                    let picture = Arc::new(picture);
                    self.hand_out(&waiting.textures, &picture);
                    let Waiting { file, encoding, wanted, .. } = waiting;
                    self.known.push(Known { file, encoding, wanted, picture });
                }
                Err(error) => {
                    let message = format!("cannot read `{}`: {error}", waiting.source.written());
                    self.diagnostics.push(Diagnostic::error("bad-image", message).at(waiting.span));
                }
            }
        }
    }

    fn find(&self, waiting: &Waiting<'_>) -> Option<Arc<Picture>> {
        let fits = |known: &&Known| {
            known.file == waiting.file
                && (known.encoding == waiting.encoding || waiting.wanted == Wanted::Alpha)
                && (known.wanted == Wanted::Both || known.wanted == waiting.wanted)
        };
        self.known.iter().find(fits).map(|known| known.picture.clone())
    }

    fn hand_out(&mut self, textures: &[u32], picture: &Arc<Picture>) {
        for id in textures {
            if let Some(Texture::Image(image)) = self.textures.get_mut(*id as usize) {
                image.set_picture(picture.clone());
            }
        }
    }
}

/// Opacity is not encoded: who asks for nothing else shares the picture of who asks for colours.
fn join_opacity(waiting: Vec<Waiting<'_>>) -> Vec<Waiting<'_>> {
    let (alone, mut joined): (Vec<_>, Vec<_>) =
        waiting.into_iter().partition(|waiting| waiting.wanted == Wanted::Alpha);
    for waiting in alone {
        match joined.iter_mut().find(|other| other.file == waiting.file) {
            Some(other) => {
                other.textures.extend(waiting.textures);
                if other.wanted == Wanted::Color {
                    other.wanted = Wanted::Both;
                }
            }
            None => joined.push(waiting),
        }
    }
    joined
}

fn read(desc: &SceneDesc, waiting: &Waiting<'_>) -> Result<Picture, TextureError> {
    let (encoding, wanted) = (waiting.encoding, waiting.wanted);
    let picture = match waiting.source {
        ImageSource::File(file) => Picture::from_path(&desc.resolve(file), encoding, wanted),
        ImageSource::Embedded(image) => Picture::from_bytes(&image.bytes, &image.name, encoding, wanted),
    };
    picture.map(Picture::with_pyramid)
}

fn mapping(mapping: &desc::Mapping) -> Mapping {
    match mapping {
        desc::Mapping::Uv { set, scale, rotation, offset } => {
            Mapping::uv(*set, Vec2::from(*scale), *rotation, Vec2::from(*offset))
        }
        desc::Mapping::Planar { u, v, offset } => {
            Mapping::Planar { rows: [Vec3::from(*u), Vec3::from(*v)], offset: Vec2::from(*offset) }
        }
    }
}

fn channel(channel: desc::Channel) -> Channel {
    match channel {
        desc::Channel::Rgb => Channel::Rgb,
        desc::Channel::Red => Channel::One(0),
        desc::Channel::Green => Channel::One(1),
        desc::Channel::Blue => Channel::One(2),
        desc::Channel::Alpha => Channel::Alpha,
    }
}
