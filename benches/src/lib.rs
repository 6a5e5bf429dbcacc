//! Benchmarks against peers.

mod nanoflann;
pub mod search;
