//! Jobs: which passes run, what is saved, whom to tell.
//!
//! All policy lives here and nothing is printed: a [`Session`] renders a [`Job`] pass by pass, folds the passes in
//! index order into a film, and tells an observer of every step as an [`Event`]; the observer's [`Control`] stops it.
//! The command line is one such observer.

mod compile;
mod event;
mod hash;
mod output;
mod overrides;
mod phase;
mod session;
mod settings;

pub use compile::{CompileError, Compiled, compile};
pub use event::{Control, Event, Warning};
pub use hash::{SceneHash, scene_hash};
pub use output::{Output, OutputKind, PictureError, PictureInfo, check_outputs, overwritten_inputs};
pub use overrides::Overrides;
pub use phase::{Phase, Timings};
pub use session::{Job, Outcome, Session, SessionError, film_bytes};
pub use settings::settings;
