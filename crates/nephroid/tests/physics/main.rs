//! Whether the pictures are right: closed forms, conservation laws, another renderer's pictures, and one regression test
//! for each classic mistake of photon mapping (ARCHITECTURE.md). Every comparison also shows that it would have rejected an
//! error of 2 %, or the mistake itself.
#![allow(clippy::unwrap_used, reason = "helpers of tests, too")]

mod agreement;
mod auto;
mod balance;
mod cameras;
mod caustics;
mod closed_forms;
mod determinism;
mod displaced;
mod features;
mod few_lights;
mod furnace;
mod lamps;
mod layers;
#[cfg(feature = "long")]
mod long;
mod many_lights;
mod materials;
mod nephroid_curve;
mod nested;
mod noise;
mod oracle;
mod partition;
mod replay;
mod shaped_lights;
mod sharp_textures;
mod sky;
mod sppm;
mod support;
mod textured_lamps;
mod traps;
mod vcm;
mod window;
