//! Benchmarks against peers. Each `run` prints what it measures and appends (name, ratio), > 1 where we are faster.

pub mod clock;
mod embree;
mod mitsuba;
mod nanoflann;
pub mod paths;
pub mod rays;
pub mod report;
mod scenes;
pub mod search;
pub mod table;
