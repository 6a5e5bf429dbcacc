use color::luminance_f64;

use crate::Planes;

/// How much of the light's colour an automatic white balance takes away, as a share of the logarithm: an eye that has
/// been in a room for a while adapts to some such part (as the degree of adaptation D of CIECAM02), and a picture
/// lit by candles stays warm.
pub const AUTO_DEGREE: f64 = 0.65;

/// The colour of the light in a picture, with luminance 1; `None` where too little is lit to tell.
///
/// Radiance over albedo is the colour of the light that a matt surface receives, so a red room is not taken for red
/// light; where the albedo is not known, the world is taken for grey. Of the cells within 3 stops of the median
/// luminance the medians of log r/g and log b/g count.
pub fn light_of(planes: &Planes) -> Option<[f64; 3]> {
    let cells = planes.cells();
    let mut lit: Vec<(f64, [f64; 2])> = cells
        .iter()
        .filter_map(|cell| {
            let known = cell.albedo.iter().all(|a| *a > 0.02);
            let light: [f64; 3] =
                std::array::from_fn(|c| cell.radiance[c] / if known { cell.albedo[c] } else { 1.0 });
            let luminance = luminance_f64(cell.radiance);
            let [r, g, b] = light;
            (r > 0.0 && g > 0.0 && b > 0.0).then(|| (luminance.log2(), [(r / g).ln(), (b / g).ln()]))
        })
        .collect();
    if lit.len() * 20 < cells.len() || lit.is_empty() {
        return None;
    }
    lit.sort_by(|a, b| a.0.total_cmp(&b.0));
    let middle = lit[lit.len() / 2].0;
    let near: Vec<[f64; 2]> =
        lit.iter().filter(|(key, _)| (key - middle).abs() <= 3.0).map(|(_, ratio)| *ratio).collect();
    let median = |which: usize| {
        let mut values: Vec<f64> = near.iter().map(|ratio| ratio[which]).collect();
        values.sort_by(f64::total_cmp);
        values[values.len() / 2].exp()
    };
    let white = [median(0), 1.0, median(1)];
    let luminance = luminance_f64(white);
    Some(white.map(|v| v / luminance))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lamp_is_told_from_the_wall() {
        let lamp = color::blackbody_rgb(3000.0);
        let wall = [0.7, 0.2, 0.1];
        let beauty = vec![std::array::from_fn(|c| lamp[c] * wall[c]); 64 * 48];
        let mut planes = Planes { width: 64, height: 48, beauty, ..Planes::default() };
        planes.albedo = vec![wall; 64 * 48];
        let found = light_of(&planes).unwrap();
        assert!((0..3).all(|c| (found[c] - f64::from(lamp[c])).abs() < 1e-4), "{found:?} {lamp:?}");
        // A firefly and a blue lamp in a corner change nothing.
        planes.beauty[5] = [0.0, 0.0, 1e6];
        for y in 0..10 {
            planes.beauty[y * 64] = [0.1, 0.1, 9.0];
        }
        assert!((light_of(&planes).unwrap()[0] - found[0]).abs() < 1e-4);
        planes.beauty.fill([0.0; 3]);
        assert_eq!(light_of(&planes), None);
    }
}
