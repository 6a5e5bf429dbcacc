//! Benchmarks against peers. Each `run` prints what it measures and appends (name, ratio), > 1 where we are faster.

pub mod checkpoint;
pub mod clock;
mod embree;
pub mod memory;
mod mitsuba;
mod nanoflann;
pub mod pairs;
pub mod paths;
pub mod rays;
pub mod report;
mod scenes;
pub mod search;
pub mod table;
pub mod threads;
