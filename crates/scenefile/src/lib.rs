//! Scene descriptions: the TOML reader, its diagnostics and its reference.

pub mod desc;
pub mod source;

pub use desc::SceneDesc;
pub use source::{FileId, Source, Sourced, Sources, Span};
