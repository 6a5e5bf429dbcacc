use std::sync::Arc;

use math::{Affine3A, Ray, Transform, Vec3};
use proptest::prelude::*;
use sampling::{Domain, Sampler};

use crate::kernel::Dispatch;
use crate::shapes::{Disk, Sphere};
use crate::{Bvh, Geometry, Hit, NO_INSTANCE, NestedInstance};

mod brute;
mod degenerate;
mod room;

/// Numbers in 0…1 for a test.
struct Numbers(Sampler);

impl Numbers {
    fn new(seed: u64) -> Self {
        Self(Sampler::new(seed, 0, Domain::Other, 0))
    }

    fn next(&mut self) -> f32 {
        self.0.next_1d()
    }

    /// In −1…1.
    fn point(&mut self) -> Vec3 {
        Vec3::new(self.next(), self.next(), self.next()) * 2.0 - 1.0
    }
}

/// The same tree, searched by the portable path.
fn portable(mut bvh: Bvh) -> Bvh {
    bvh.dispatch = Dispatch::Portable;
    bvh
}
