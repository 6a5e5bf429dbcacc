//! The compiled scene: immutable, `Send + Sync`, addressed by ids. World space throughout.

mod attributes;
pub mod camera;
mod chance;
mod compile;
mod idle;
mod interaction;
pub mod light;
mod material;
mod medium;
mod scene;
mod shape;
mod sphere_map;
pub mod target;
pub mod texture;

pub use camera::Camera;
pub use compile::{compile, survey};
pub use interaction::{LightId, SurfaceInteraction};
pub use light::Light;
pub use material::{
    CoatedConductorMaterial, CoatedDiffuseMaterial, ColorSource, ConductorMaterial, DielectricMaterial,
    FloatSource, Material, MaterialId, MaterialKind, Opacity, PrincipledMaterial, RoughnessSource,
};
pub use medium::{Boundary, Medium, MediumStack};
pub use scene::{Scene, Summary, Survey};
pub use shape::{Object, Shape};
pub use target::{Target, Targets};
pub use texture::Texture;
