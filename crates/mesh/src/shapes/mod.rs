//! Generated shapes. All have unit normals; all but [`icosphere`] have uvs. y is up.
//!
//! Counts outside the documented range are brought into it: a mesh always comes out.

mod field;
mod flat;
mod gem;
mod grid;
mod height;
mod lathe;
mod outline;
mod patches;
mod round;
mod solids;
mod teapot;
mod vessels;
mod water;

pub use flat::{annulus, box_, disk, quad};
pub use gem::{Brilliant, round_brilliant};
pub use height::{HeightField, height_field};
pub use lathe::lathe;
pub use outline::Profile;
pub use round::{cone, cylinder, icosphere, torus, uv_sphere};
pub use solids::{capsule, frustum, open_frustum, rounded_box, solid_cylinder};
pub use teapot::{TeapotPart, teapot, teapot_part, teapot_shells, teapot_solid};
pub use vessels::{COFFEE_LEVEL, WINE_LEVEL, band, coffee_cup, ring, wine, wine_glass};
pub use water::{Water, water_surface};

/// Segments as they are used: 3 to 65 536.
fn clamped(segments: u32) -> u32 {
    segments.clamp(3, 1 << 16)
}
