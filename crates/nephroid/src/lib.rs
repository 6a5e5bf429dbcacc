//! Nephroid as a library: global illumination and caustics with photon maps.
//!
//! A [`SceneDesc`] says what is in the scene and how to render it; it is read from a file by [`load`] or built in
//! code. [`compile`] makes a [`Scene`] of it, a [`Session`] renders a [`Job`] pass by pass into a [`Film`], and an
//! [`Output`] writes that as EXR or PNG.
//!
//! What happens in a session is told as [`Event`]s, whose observer may stop it; it goes on where it stopped. A session may
//! have a time limit and a checkpoint file; [`resume`] makes a session of such a file, and [`merge`] adds up several that
//! hold different passes. [`replay`] traces one path of a render again and writes it down.
//!
//! The film depends on description and seed alone: any number of threads, and any split into sessions, gives the same
//! bytes.
//!
//! ```
//! use nephroid::desc::{Camera, Emission, Material, Object, Shape};
//! use nephroid::{Control, Job, SceneDesc, Session, compile};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let mut desc = SceneDesc::default();
//! desc.film.size = [8, 8];
//! desc.render.passes = 16;
//! desc.camera = Some(Camera { position: [0.0, 0.0, 4.0], ..Camera::default() }.into());
//! // Inside a sphere that emits 1 W/(sr·m²) and reflects half of what arrives: radiance 1/(1 − 1/2) everywhere.
//! let shape = Shape::Sphere { center: [0.0; 3], radius: 5.0 };
//! let emission = Some(Emission::radiance([1.0; 3]).into());
//! let wall = Object { emission, flip_normals: true, ..Object::new(shape, Material::diffuse(0.5)) };
//! desc.objects.push(wall.into());
//!
//! let scene = compile(&desc, 0)?.scene;
//! let mut session = Session::new(Job::new(&desc, scene)?, 0)?;
//! session.run(&mut |_event| Control::Continue)?;
//! let beauty = session.film().beauty();
//! let mean: f32 = beauty.iter().map(|[r, g, b]| r + g + b).sum::<f32>() / (3 * beauty.len()) as f32;
//! assert!((mean - 2.0).abs() < 0.1);
//! # Ok(())
//! # }
//! ```

pub use color::{Exposure, Lanes, ViewTransform, WhiteBalance, blackbody_rgb, srgb8_to_linear};
pub use develop::{Display, MixError, Planes};
pub use film::{
    CompareError, Comparison, ExrChannels, Film, Layer, OutputError, ReadError, RgbImage, check_writable,
    compare, difference, discard_unfinished, encode_png_bytes, write_atomically,
};
pub use import::{Format, OutsourceError, load, outsource, strict};
pub use integrators::{
    IntegratorKind, LayerSettings, MapReport, PathEnd, PathEvent, PathRecord, PhotonKind, PhotonMapSettings,
    Settings, Technique, VertexRecord,
};
pub use math::Vec3;
pub use scene::{Light, LightId, Scene, Survey};
pub use scenefile::{
    Diagnostic, Loaded, SceneDesc, Severity, Sources, UnknownTopic, desc, describe, light_kind, nearest,
    parse, render_all, shape_kind, to_toml, topics,
};
pub use session::{
    Checkpoint, CheckpointError, CheckpointErrorKind, CheckpointFile, CheckpointInfo, CompileError, Compiled,
    Control, Crop, DenoiseError, Denoised, Denoiser, Event, Extent, Job, LutFileError, MergeError, Outcome,
    Output, OutputKind, Overrides, Phase, PictureError, PictureInfo, Places, Remaining, ReplayError,
    ReplayKey, Replayed, Resumed, SceneHash, Session, SessionError, Timings, Wanted, Warning, check_outputs,
    compile, film_bytes, gaps, is_same_file, merge, overwritten_inputs, read_lut, replay, resume, said,
    scene_hash, settings, survey, write_checkpoint,
};
