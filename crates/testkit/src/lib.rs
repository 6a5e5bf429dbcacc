//! Statistical tests: χ² for samplers of directions and of rectangles, z-tests, furnaces, block tests of images.
//!
//! Every test is deterministic (numbers come from [`sampling::Sampler`] with fixed keys), reports p-values, and is
//! to be judged at a level corrected for the number of tests ([`significance`]). Each check here has a test that
//! plants an error of 2 % and sees it fail.
//!
//! [`markdown`] reads the pages of the documentation for the tests that hold them to what they say.

mod chi2;
mod directions;
mod image;
pub mod markdown;
mod partition;
mod quadrature;
mod stats;

pub use chi2::{Chi2, Rect, Settings, chi2_counts, chi2_rect, chi2_sphere};
pub use directions::{DirectionDraw, DirectionReport, check_directions, reciprocity_error};
pub use image::{BlockReport, block_means, compare_blocks};
pub use quadrature::integrate_rect;
pub use stats::{Moments, chi2_p_value, significance, welch_p_value, z_p_value};
