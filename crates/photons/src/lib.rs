//! Photon records, one kd-tree for every search, and density estimation. Knows no scene.
//!
//! * [`PhotonMap`] stores photons in tree order and estimates L ≈ Σ f·Φ·k(d/r)/r² from those within a fixed radius
//!   ([`PhotonMap::gather`]) or from the k nearest ([`PhotonMap::gather_knn`]).
//! * [`KdTree`] is the same search over bare positions.
//! * [`Kernel`] is the profile k, normalised over the unit disc.
//!
//! Answers are a function of the input alone: the tree does not depend on the number of threads, and the AVX2 and
//! portable leaf scans give the same bits.

mod kdtree;
mod kernel;
mod leaf;
mod map;
mod photon;
mod search;

pub use kdtree::KdTree;
pub use kernel::Kernel;
pub use map::{FLATNESS, MIN_NORMAL_COSINE, Neighbourhood, PhotonMap, PhotonView, Query};
pub use photon::{Photon, PhotonFlags};
pub use search::{Hit, Nearest, Scratch};
