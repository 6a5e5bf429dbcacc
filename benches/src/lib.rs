//! Benchmarks against peers.

mod embree;
mod nanoflann;
pub mod rays;
pub mod search;
