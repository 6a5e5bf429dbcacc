//! The control points of Newell's teapot (Martin Newell, University of Utah, 1975; public domain by common account):
//! 32 bicubic Bézier patches, z up, 3.15 high. Written as the rows that are left when the symmetries are taken out:
//! five sheets turned through four quadrants, and two pairs of sheets mirrored in the plane y = 0.

use math::DVec3;

/// A row of a turned patch: radius r, inner control coordinate c, height z.
/// A quadrant's control points are (r, 0), (r, −c), (c, −r), (0, −r).
pub(super) type Turned = [f64; 3];
/// A row of a mirrored patch: x and z on the near side, x and z on the far side, half width w.
/// One half's control points are (x₀, 0, z₀), (x₀, −w, z₀), (x₁, −w, z₁), (x₁, 0, z₁).
pub(super) type Swept = [f64; 5];

/// Rim and two sheets of the body, from the opening down. Neighbours share a row.
pub(super) const BODY: [[Turned; 4]; 3] = [
    [[1.4, 0.784, 2.4], [1.3375, 0.749, 2.53125], [1.4375, 0.805, 2.53125], [1.5, 0.84, 2.4]],
    [[1.5, 0.84, 2.4], [1.75, 0.98, 1.875], [2.0, 1.12, 1.35], [2.0, 1.12, 0.9]],
    [[2.0, 1.12, 0.9], [2.0, 1.12, 0.45], [1.5, 0.84, 0.225], [1.5, 0.84, 0.15]],
];
/// From the tip of the knob, where the patches shrink to a point, to the edge.
pub(super) const LID: [[Turned; 4]; 2] = [
    [[0.0, 0.0, 3.15], [0.8, 0.45, 3.15], [0.0, 0.0, 2.85], [0.2, 0.112, 2.7]],
    [[0.2, 0.112, 2.7], [0.4, 0.224, 2.55], [1.3, 0.728, 2.55], [1.3, 0.728, 2.4]],
];
/// From the edge to the centre, where the patches shrink to a point.
pub(super) const BOTTOM: [[Turned; 4]; 1] =
    [[[1.5, 0.84, 0.15], [1.5, 0.84, 0.075], [1.425, 0.798, 0.0], [0.0, 0.0, 0.0]]];
/// From the upper root to the lower one.
pub(super) const HANDLE: [[Swept; 4]; 2] = [
    [
        [-1.6, 2.025, -1.5, 2.25, 0.3],
        [-2.3, 2.025, -2.5, 2.25, 0.3],
        [-2.7, 2.025, -3.0, 2.25, 0.3],
        [-2.7, 1.8, -3.0, 1.8, 0.3],
    ],
    [
        [-2.7, 1.8, -3.0, 1.8, 0.3],
        [-2.7, 1.575, -3.0, 1.35, 0.3],
        [-2.5, 1.125, -2.65, 0.9375, 0.3],
        [-2.0, 0.9, -1.9, 0.6, 0.3],
    ],
];
/// From the root to the mouth, round the lip.
pub(super) const SPOUT: [[Swept; 4]; 2] = [
    [
        [1.7, 1.425, 1.7, 0.6, 0.66],
        [2.6, 1.425, 3.1, 0.825, 0.66],
        [2.3, 2.1, 2.4, 2.025, 0.25],
        [2.7, 2.4, 3.3, 2.4, 0.25],
    ],
    [
        [2.7, 2.4, 3.3, 2.4, 0.25],
        [2.8, 2.475, 3.525, 2.49375, 0.25],
        [2.9, 2.475, 3.45, 2.5125, 0.15],
        [2.8, 2.4, 3.2, 2.4, 0.15],
    ],
];

/// Bernstein weights of degree 3 and their derivatives.
pub(super) fn bernstein(t: f64) -> ([f64; 4], [f64; 4]) {
    let s = 1.0 - t;
    (
        [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t],
        [-3.0 * s * s, 3.0 * s * (s - 2.0 * t), 3.0 * t * (2.0 * s - t), 3.0 * t * t],
    )
}

/// The sum of rows by weights.
pub(super) fn blend<const K: usize>(rows: &[[f64; K]; 4], weights: [f64; 4]) -> [f64; K] {
    std::array::from_fn(|k| (0..4).map(|i| rows[i][k] * weights[i]).sum())
}

/// The point of a turned row in quadrant `quadrant` by the weights `b` of its control points.
pub(super) fn turned_point([r, c, z]: Turned, quadrant: u32, b: [f64; 4]) -> DVec3 {
    let x = r * (b[0] + b[1]) + c * b[2];
    let y = -(c * b[1] + r * (b[2] + b[3]));
    // Weights of a derivative sum to 0 and let z drop out; those of a point sum to 1, here exactly.
    let height = if b.iter().sum::<f64>() > 0.5 { z } else { 0.0 };
    match quadrant % 4 {
        0 => DVec3::new(x, y, height),
        1 => DVec3::new(y, -x, height),
        2 => DVec3::new(-x, -y, height),
        _ => DVec3::new(-y, x, height),
    }
}

/// The point of a swept row's first half by the weights `b` of its control points.
pub(super) fn swept_point([x0, z0, x1, z1, w]: Swept, b: [f64; 4]) -> DVec3 {
    let (near, far) = (b[0] + b[1], b[2] + b[3]);
    DVec3::new(x0 * near + x1 * far, -w * (b[1] + b[2]), z0 * near + z1 * far)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All 32 patches in Newell's order and orientation, 16 control points each.
    fn control_points() -> Vec<DVec3> {
        let unit = |i: usize| std::array::from_fn(|k| f64::from(u8::from(i == k)));
        let mut points = Vec::new();
        let turned = |points: &mut Vec<DVec3>, sheet: &[Turned; 4]| {
            for quadrant in 0..4 {
                for row in sheet {
                    points.extend((0..4).map(|i| turned_point(*row, quadrant, unit(i))));
                }
            }
        };
        let swept = |points: &mut Vec<DVec3>, sheet: &[Swept; 4]| {
            for row in sheet {
                points.extend((0..4).map(|i| swept_point(*row, unit(i))));
            }
            for row in sheet {
                points.extend((0..4).rev().map(|i| swept_point(*row, unit(i)) * DVec3::new(1.0, -1.0, 1.0)));
            }
        };
        BODY.iter().for_each(|s| turned(&mut points, s));
        HANDLE.iter().for_each(|s| swept(&mut points, s));
        SPOUT.iter().for_each(|s| swept(&mut points, s));
        LID.iter().for_each(|s| turned(&mut points, s));
        // The bottom's patches run from the centre and turn the other way.
        let mut rows = BOTTOM[0];
        rows.reverse();
        let start = points.len();
        turned(&mut points, &rows);
        points[start..].iter_mut().for_each(|p| p.y = -p.y);
        points
    }

    #[test]
    fn these_are_newells_patches() {
        let points = control_points();
        assert_eq!(points.len(), 32 * 16);
        // FNV-1a over the coordinates in hundred-thousandths, as computed from the published file.
        let mut hash = 0xcbf2_9ce4_8422_2325u64;
        for p in &points {
            for x in p.to_array() {
                let n = (x * 1e5).round() as i64;
                assert!((x * 1e5 - n as f64).abs() < 1e-6);
                for byte in n.to_le_bytes() {
                    hash = (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
                }
            }
        }
        assert_eq!(hash, FINGERPRINT);
    }

    const FINGERPRINT: u64 = 0xdf78_49b9_6a40_dfa5;

    #[test]
    fn sheets_join_smoothly() {
        fn joins<const K: usize>(sheets: &[[[f64; K]; 4]]) {
            for pair in sheets.windows(2) {
                assert_eq!(pair[0][3], pair[1][0]);
                // The control polygons arrive and leave in the same direction, in the plane of x (or r) and z alike.
                let d = |a: [f64; K], b: [f64; K]| -> [f64; K] { std::array::from_fn(|k| b[k] - a[k]) };
                let (arrives, leaves) = (d(pair[0][2], pair[0][3]), d(pair[1][0], pair[1][1]));
                let z = K - 2 + usize::from(K == 3);
                let x = z - 1 - usize::from(K == 3);
                assert!((arrives[x] * leaves[z] - arrives[z] * leaves[x]).abs() < 1e-12);
            }
        }
        joins(&BODY);
        joins(&LID);
        joins(&HANDLE);
        joins(&SPOUT);
        joins(&[BODY[2], BOTTOM[0]]);
    }
}
