//! Ray tracing: an 8-wide BVH.
