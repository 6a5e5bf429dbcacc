use std::fs::File;
use std::io::Read;
use std::path::Path;

use color::Lanes;
use math::{Frame, Transform, Vec3};
use photometry::Note;
use scenefile::desc::{
    ImageSource, LightKind, ProfileAmount, SceneDesc, TransformStep, WHITE_EFFICACY, channel_power,
};
use scenefile::{Diagnostic, Span};

use super::{lights, shapes};
use crate::Light;
use crate::light::{GoniometricShape, IntensityShape, ProfileShape, ShapedLight, SlideShape};

/// Greatest photometric file that is read, bytes: such a file has some thousand numbers.
const MOST_BYTES: u64 = 64 << 20;

/// A light, where it is, and what should be told of it.
type Shaped = (Light, Vec3, Vec<Diagnostic>);

/// A point light whose intensity is given by direction. `None`: `kind` is another one.
pub(super) fn light(
    desc: &SceneDesc,
    kind: &LightKind,
    span: Option<Span>,
) -> Option<Result<Shaped, Diagnostic>> {
    let shape = match kind {
        LightKind::Profile { file, transform, amount } => {
            let name = file.display().to_string();
            let path = desc.resolve(file);
            profile(&path, transform, *amount)
                .map(|(placed, shape, notes)| {
                    let tell = |note: &Note| {
                        let message = format!("`{name}`, line {}: {}", note.line, note.text);
                        Diagnostic::warning("photometry", message).at(file.span.or(span))
                    };
                    (placed, IntensityShape::Profile(shape), notes.iter().map(tell).collect())
                })
                .map_err(|reason| bad("bad-photometry", &name, &reason, file.span.or(span)))
        }
        LightKind::Goniometric { source, mapping, intensity, transform } => {
            let build = || {
                let (position, turned, _) = place(transform)?;
                let (size, pixels) = lights::picture_of_sphere(desc, source, *mapping)?;
                let shape = GoniometricShape::new(*mapping, size, pixels, *intensity, turned).ok_or(DARK)?;
                Ok((position, IntensityShape::Goniometric(shape), Vec::new()))
            };
            build().map_err(|reason: String| of_picture(source, &reason, span))
        }
        LightKind::Projector { source, fov, intensity, transform } => {
            let build = || {
                let (position, _, frame) = place(transform)?;
                let (size, pixels) = lights::picture(desc, source)?;
                let pixels = pixels.iter().map(|p| [0, 1, 2].map(|c| p[c] * intensity[c])).collect();
                let shape = SlideShape::new(size, pixels, fov.to_radians(), frame).ok_or(DARK)?;
                Ok((position, IntensityShape::Slide(shape), Vec::new()))
            };
            build().map_err(|reason: String| of_picture(source, &reason, span))
        }
        _ => return None,
    };
    Some(shape.and_then(|(position, shape, notes)| {
        let light = ShapedLight::new(position, shape).ok_or_else(|| {
            let message = "this light gives no light, or a value of it is no number";
            Diagnostic::error("bad-light", message).at(span)
        })?;
        Ok((Light::Shaped(Box::new(light)), position, notes))
    }))
}

const DARK: &str = "it is black, or holds values that are negative or not finite";

fn bad(code: &'static str, name: &str, reason: &str, span: Option<Span>) -> Diagnostic {
    Diagnostic::error(code, format!("cannot light by `{name}`: {reason}")).at(span)
}

fn of_picture(source: &ImageSource, reason: &str, span: Option<Span>) -> Diagnostic {
    let at = source.file().and_then(|file| file.span).or(span);
    bad("bad-image", &source.written(), reason, at)
}

/// Where a transform puts the origin, how it turns, and what it makes of the axes.
fn place(steps: &[TransformStep]) -> Result<(Vec3, Transform, Frame), String> {
    let transform = shapes::transform(steps).ok_or("its transform is singular")?;
    let turned = lights::turn(&transform).ok_or("its transform is singular")?;
    let frame = Frame { x: turned.vector(Vec3::X), y: turned.vector(Vec3::Y), z: turned.vector(Vec3::Z) };
    Ok((transform.point(Vec3::ZERO), turned, frame))
}

fn profile(
    path: &Path,
    steps: &[TransformStep],
    amount: ProfileAmount,
) -> Result<(Vec3, ProfileShape, Vec<Note>), String> {
    let (position, _, frame) = place(steps)?;
    let mut bytes = Vec::new();
    let open = File::open(path).and_then(|file| file.take(MOST_BYTES + 1).read_to_end(&mut bytes));
    open.map_err(|e| e.to_string())?;
    if bytes.len() as u64 > MOST_BYTES {
        return Err(format!("it has more than {MOST_BYTES} bytes"));
    }
    let file = photometry::read(&bytes).map_err(|e| e.to_string())?;
    let lumens = file.web.lumens();
    if !(lumens > 0.0 && lumens.is_finite()) {
        return Err("it gives no light".into());
    }
    let [r, g, b] = match amount {
        ProfileAmount::AsFile { scale, color } => {
            let luminance = color::luminance_f64(color.map(f64::from));
            let per_candela = f64::from(scale) / (f64::from(WHITE_EFFICACY) * luminance);
            color.map(|c| (f64::from(c) * per_candela) as f32)
        }
        ProfileAmount::Power { watts, color } => {
            channel_power(watts, color).map(|w| (f64::from(w) / lumens) as f32)
        }
    };
    Ok((position, ProfileShape::new(file.web, frame, Lanes::rgb(r, g, b)), file.notes))
}
