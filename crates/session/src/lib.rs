//! Jobs: which passes run, what is saved, whom to tell.
//!
//! All policy lives here and nothing is printed: a [`Session`] renders a [`Job`] pass by pass, folds the passes in
//! index order into a film, and tells an observer of every step as an [`Event`]; the observer's [`Control`] stops it.
//! The command line is one such observer.
//!
//! A session may be given a time ([`Session::with_time`]) and a file that it saves itself to
//! ([`Session::with_checkpoint`]); [`resume`] goes on with such a file, [`merge`] adds up several that were made of
//! different passes, anywhere. However a render is cut, its film is the same to the bit.

mod blank;
mod checkpoint;
mod compile;
mod denoised;
mod event;
mod grain;
mod hash;
mod job;
mod output;
mod overrides;
mod pace;
mod phase;
mod preview;
mod ranges;
mod replay;
mod resume;
mod run;
mod session;
mod settings;
mod surroundings;

pub use checkpoint::{
    Checkpoint, CheckpointError, CheckpointErrorKind, CheckpointFile, CheckpointInfo, MergeError, ReadScene,
    SceneSource, merge, write_checkpoint,
};
pub use compile::{CompileError, Compiled, compile, survey};
pub use denoise::{DenoiseError, Denoiser, Places};
pub use denoised::Denoised;
pub use event::{Control, Event, Warning};
pub use hash::{SceneHash, scene_hash};
pub use job::{Job, SessionError, film_bytes};
pub use output::{
    LutFileError, Output, OutputKind, PictureError, PictureInfo, check_outputs, is_same_file,
    overwritten_inputs, read_lut,
};
pub use overrides::{Crop, Overrides};
pub use pace::Remaining;
pub use phase::{Phase, Timings};
pub use ranges::{gaps, said};
pub use replay::{ReplayError, ReplayKey, Replayed, replay};
pub use resume::{Extent, Resumed, Wanted, resume};
pub use session::{Outcome, Session};
pub use settings::settings;
