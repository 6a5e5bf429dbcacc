use math::{DVec2, DVec3};

use super::grid::turn;
use crate::{MeshError, TriangleMesh};

/// A round brilliant by its proportions. Ratios are of the girdle's diameter, angles in radians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Brilliant {
    /// Of the girdle, from corner to corner, > 0.
    pub diameter: f32,
    /// The table's ratio, corner to corner.
    pub table: f32,
    /// Between the girdle's plane and the crown's main facets.
    pub crown_angle: f32,
    /// Between the girdle's plane and the pavilion's main facets.
    pub pavilion_angle: f32,
    /// The girdle's height, as a ratio.
    pub girdle: f32,
    /// How far the star facets reach from the table's edge to the girdle's, seen from above: 0 to 1.
    pub star_length: f32,
    /// How far the lower halves reach from the girdle to the middle, seen from below: 0 to 1.
    pub lower_half_length: f32,
    /// The culet's ratio, corner to corner; 0 for a point.
    pub culet: f32,
}

impl Brilliant {
    /// The cut of Tolkowsky ("Diamond Design", 1919): table 53 %, crown 34.5°, pavilion 40.75°. He leaves girdle, stars
    /// and lower halves open: 2 %, half and three quarters are usual today.
    pub fn tolkowsky(diameter: f32) -> Self {
        Self {
            diameter,
            table: 0.53,
            crown_angle: 34.5f32.to_radians(),
            pavilion_angle: 40.75f32.to_radians(),
            girdle: 0.02,
            star_length: 0.5,
            lower_half_length: 0.75,
            culet: 0.0,
        }
    }
}

/// A round brilliant about the y axis, its table up, the middle of its girdle at the origin: table, 8 stars, 8 bezels, 16 upper
/// halves, 16 lower halves, 8 pavilion mains, a culet if it has a size, and 16 flat facets of the girdle. Closed,
/// convex, with flat normals; uvs are seen from above.
///
/// # Errors
/// Where the proportions give no convex stone.
pub fn round_brilliant(cut: &Brilliant) -> Result<TriangleMesh, MeshError> {
    let faces = faces(cut);
    let scale = 0.5 * f64::from(cut.diameter);
    let flawed = faces.iter().find_map(|(name, face)| {
        let normal = newell(face);
        let height = faces.iter().flat_map(|(_, other)| other).map(|p| normal.dot(*p - face[0]));
        // A NaN is no convex stone either.
        let outside = height.fold(0.0, f64::max);
        (!(normal.length() > 0.5 && outside <= 1e-9 && face.iter().all(|p| p.is_finite()))).then_some(*name)
    });
    if let Some(name) = flawed {
        return Err(MeshError::whole(
            format!("these proportions give no convex stone: other facets stand out over the {name}"),
            "bring table, angles, `star_length`, `lower_half_length` and `culet` nearer to their defaults",
        ));
    }
    let mut mesh = TriangleMesh::default();
    for (_, face) in &faces {
        let start = mesh.positions.len() as u32;
        let normal = newell(face).as_vec3();
        for p in face {
            mesh.positions.push((*p * scale).as_vec3());
            mesh.normals.push(normal);
            mesh.uvs.push((DVec2::new(p.x, -p.z) * 0.5 + 0.5).as_vec2());
        }
        mesh.indices.extend((1..face.len() as u32 - 1).map(|i| [start, start + i, start + i + 1]));
    }
    Ok(mesh)
}

/// The unit normal of a polygon, counter-clockwise seen from outside; zero where it has no area.
fn newell(face: &[DVec3]) -> DVec3 {
    let sum: DVec3 = (1..face.len() - 1).map(|i| (face[i] - face[0]).cross(face[i + 1] - face[0])).sum();
    sum.normalize_or_zero()
}

/// The facets of a stone whose girdle has radius 1.
fn faces(cut: &Brilliant) -> Vec<(&'static str, Vec<DVec3>)> {
    let [table, crown, pavilion, girdle, star, lower, culet] = [
        cut.table,
        cut.crown_angle,
        cut.pavilion_angle,
        cut.girdle,
        cut.star_length,
        cut.lower_half_length,
        cut.culet,
    ]
    .map(f64::from);
    let (crown, pavilion) = (crown.tan(), pavilion.tan());
    // A point at a sixteenth of a turn, at a radius and a height.
    let at = |sixteenth: u32, radius: f64, y: f64| {
        let (cos, sin) = turn(f64::from(sixteenth % 16), 16);
        DVec3::new(radius * cos, y, -radius * sin)
    };
    let (narrow, _) = turn(1.0, 16);
    // The ratio of diameters is that of radii; a ratio of the diameter is two radii.
    let (top, bottom) = (girdle, -girdle);
    // Where star, bezels and upper halves meet: between two bezels, in the planes of both.
    let meet = table * narrow + star * (1.0 - table * narrow);
    let meet_y = top + (1.0 - meet * narrow) * crown;
    let table_y = top + (1.0 - table) * crown;
    // Where lower halves and mains meet.
    let keel = 1.0 - lower;
    let keel_y = bottom - (1.0 - keel * narrow) * pavilion;
    let culet_y = bottom - (1.0 - culet * narrow) * pavilion;

    let mut faces = vec![("table", (0..8).map(|i| at(2 * i, table, table_y)).collect())];
    for i in (0..16).step_by(2) {
        let (before, after, next) = (i + 15, i + 1, i + 2);
        let corner = at(i, table, table_y);
        let [meet_before, meet_after] = [before, after].map(|j| at(j, meet, meet_y));
        let [keel_before, keel_after] = [before, after].map(|j| at(j, keel, keel_y));
        let [rim, rim_after, rim_next] = [i, after, next].map(|j| at(j, 1.0, top));
        let [low, low_after, low_next] = [i, after, next].map(|j| at(j, 1.0, bottom));
        faces.push(("bezel", vec![corner, meet_before, rim, meet_after]));
        faces.push(("star", vec![corner, meet_after, at(next, table, table_y)]));
        faces.push(("upper half", vec![meet_after, rim, rim_after]));
        faces.push(("upper half", vec![meet_after, rim_after, rim_next]));
        faces.push(("girdle", vec![low, low_after, rim_after, rim]));
        faces.push(("girdle", vec![low_after, low_next, rim_next, rim_after]));
        faces.push(("lower half", vec![keel_after, low_after, low]));
        faces.push(("lower half", vec![keel_after, low_next, low_after]));
        let mut main = vec![low, keel_before];
        if culet > 0.0 {
            main.extend([before, after].map(|j| at(j, culet, culet_y)));
        } else {
            main.push(DVec3::new(0.0, bottom - pavilion, 0.0));
        }
        main.push(keel_after);
        faces.push(("pavilion main", main));
    }
    if culet > 0.0 {
        faces.push(("culet", (0..8).rev().map(|i| at(2 * i + 1, culet, culet_y)).collect()));
    }
    faces
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_brilliant_is_closed_convex_and_has_its_facets() {
        for culet in [0.0, 0.01] {
            let cut = Brilliant { culet, ..Brilliant::tolkowsky(2.0) };
            let count = faces(&cut).len();
            assert_eq!(count, 57 + 16 + usize::from(culet > 0.0));
            let mesh = round_brilliant(&cut).unwrap();
            mesh.validate().unwrap();
            assert!(mesh.is_closed());
            for (i, t) in mesh.indices.iter().enumerate() {
                let [a, b, c] = mesh.corners(i).map(|p| p.as_dvec3());
                let n = (b - a).cross(c - a).normalize();
                assert!(t.iter().all(|&v| mesh.normals[v as usize].as_dvec3().dot(n) > 1.0 - 1e-6));
                assert!(mesh.positions.iter().all(|p| n.dot(p.as_dvec3() - a) < 1e-6));
            }
        }
    }

    #[test]
    fn it_has_tolkowskys_heights_and_faces_bend_no_facet() {
        let cut = Brilliant::tolkowsky(2.0);
        let bounds = round_brilliant(&cut).unwrap().bounds();
        // Crown 16.2 %, pavilion 43.1 % of the diameter (Tolkowsky 1919), and half a girdle each.
        assert!((bounds.max.y / 2.0 - (0.1615 + 0.01)).abs() < 1e-4, "{}", bounds.max.y);
        assert!((-bounds.min.y / 2.0 - (0.4308 + 0.01)).abs() < 1e-4, "{}", bounds.min.y);
        assert!((bounds.max.x - 1.0).abs() < 1e-6);
        for (name, face) in faces(&cut) {
            let n = newell(&face);
            assert!(face.iter().all(|p| n.dot(*p - face[0]).abs() < 1e-12), "{name}");
        }
    }

    #[test]
    fn a_stone_that_is_none_is_refused() {
        let cut = Brilliant::tolkowsky(1.0);
        let flawed = [
            Brilliant { table: 1.2, ..cut },
            Brilliant { star_length: 0.0, ..cut },
            Brilliant { lower_half_length: 1.0, ..cut },
            Brilliant { culet: 0.6, ..cut },
            Brilliant { crown_angle: f32::NAN, ..cut },
        ];
        for cut in flawed {
            assert!(round_brilliant(&cut).is_err_and(|e| e.to_string().contains("convex")), "{cut:?}");
        }
        for table in [0.5, 0.56, 0.65] {
            for lower_half_length in [0.6, 0.77, 0.9] {
                round_brilliant(&Brilliant { table, lower_half_length, ..cut }).unwrap();
            }
        }
    }
}
