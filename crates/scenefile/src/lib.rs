//! Scene descriptions: the TOML reader, its diagnostics and its reference.
//!
//! [`load`] turns a file into a [`SceneDesc`] or into every reason why it cannot be one. The table in [`spec`] says
//! which keys there are; the reader, [`to_toml`] and [`describe`] all follow it. No geometry is built and no file but
//! the scene itself and those that it includes is opened here.

mod check;
mod convert;
pub mod desc;
mod describe;
pub mod diagnostic;
mod document;
mod include;
mod load;
mod nearest;
mod overrides;
mod preset;
mod read;
mod reader;
mod replace;
mod search;
mod snippet;
pub mod source;
pub mod spec;
mod write;

pub use check::check;
pub use desc::SceneDesc;
pub use describe::{UnknownTopic, describe, topics};
pub use diagnostic::{Diagnostic, Label, Severity};
pub use load::{Loaded, MOST_BYTES, load, parse, reread};
pub use nearest::nearest;
pub use preset::{MaterialPreset, presets};
pub use replace::replace;
pub use snippet::{Position, position, render_all};
pub use source::{FileId, Source, Sourced, Sources, Span};
pub use write::{light_kind, shape_kind, to_toml};
