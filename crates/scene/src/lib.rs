//! The compiled scene.
