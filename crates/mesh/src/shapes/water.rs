use math::{DVec2, DVec3};
use sampling::philox4x32_10;

use super::field::Field;
use crate::{MeshError, TriangleMesh};

/// Water under wind, in metres and seconds: a rectangle about the origin whose level is y = 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Water {
    /// Sides along x and z, > 0.
    pub size: [f32; 2],
    /// Cells along the longer side, 8 to 4096. No wave is shorter than four cells.
    pub resolution: u32,
    /// From the level to the flat bottom of a closed body; `None` for an open sheet over deep water.
    pub depth: Option<f32>,
    /// The wind's speed 10 m above the water, in m/s; 0 leaves it flat.
    pub wind_speed: f32,
    /// Whither the wind blows: the angle from +x toward −z, in radians.
    pub wind_direction: f32,
    /// How far the wind has blown over water, > 0.
    pub fetch: f32,
    /// Four times the standard deviation of the height, whatever the wind alone would give.
    pub wave_height: Option<f32>,
    /// How many waves are added up.
    pub waves: u32,
    /// Which of all the waters of this kind.
    pub seed: u64,
    /// Seconds from a moment that the seed fixes.
    pub time: f32,
}

/// Standard gravity, m/s².
const GRAVITY: f64 = 9.806_65;
/// Surface tension over density of clean water at 20 °C, m³/s² (0.0728 N/m, 998.2 kg/m³).
const TENSION: f64 = 7.29e-5;
/// Cells to the shortest wave.
const CELLS_PER_WAVE: f64 = 4.0;

/// One travelling wave: height = amplitude · cos(vector · (x, z) + phase).
struct Wave {
    vector: DVec2,
    phase: f64,
    amplitude: f64,
}

/// Waves of wind over a limited fetch, with the normals of the waves themselves.
///
/// A sum of `waves` sinusoids. Their frequencies are drawn in equal parts of the logarithm of the wave number, their
/// amplitudes from the JONSWAP spectrum (Hasselmann et al. 1973) with the directions cos² about the wind (Longuet-Higgins
/// et al. 1963), phases evenly; they travel by ω² = (g k + τ k³) tanh(k d) (Lamb 1932, §§ 229, 267). Waves longer than the longer side
/// or shorter than four cells are left out.
///
/// # Errors
/// Where the waves of this wind are too short for the cells, or a trough reaches the bottom.
pub fn water_surface(water: &Water) -> Result<TriangleMesh, MeshError> {
    let field = Field::new(water.size, water.resolution);
    let mut waves = if water.wind_speed > 0.0 { spectrum(water, &field)? } else { Vec::new() };
    let variance: f64 = waves.iter().map(|w| 0.5 * w.amplitude * w.amplitude).sum();
    if let Some(height) = water.wave_height
        && variance > 0.0
    {
        let factor = f64::from(height) / (4.0 * variance.sqrt());
        waves.iter_mut().for_each(|w| w.amplitude *= factor);
    }
    let mesh = field.sheet(&summed(&waves, &field));
    match water.depth {
        Some(depth) => field.body(mesh, -depth),
        None => Ok(mesh),
    }
}

fn spectrum(water: &Water, field: &Field) -> Result<Vec<Wave>, MeshError> {
    let jonswap = Jonswap::new(water.wind_speed.into(), water.fetch.into());
    let depth = water.depth.map_or(f64::INFINITY, f64::from);
    let [columns, rows] = field.cells.map(f64::from);
    let cell = (field.size.x / columns).max(field.size.y / rows);
    let longest = field.size.max_element();
    let k_low = std::f64::consts::TAU / longest;
    let k_high = std::f64::consts::TAU / (CELLS_PER_WAVE * cell);
    let (omega_high, _) = dispersion(k_high, depth);
    if omega_high < jonswap.peak {
        // In deep water; near enough for advice.
        let peak = std::f64::consts::TAU * GRAVITY / (jonswap.peak * jonswap.peak);
        return Err(MeshError::whole(
            format!(
                "the waves of this wind are about {peak:.2e} m long, too short for cells of {cell:.2e} m"
            ),
            format!(
                "give `resolution` {:.0} or more, a smaller `size`, more wind or a longer `fetch`",
                (longest / peak * CELLS_PER_WAVE * 2.0).ceil()
            ),
        ));
    }
    let count = water.waves.max(1);
    let strip = (k_high / k_low).ln() / f64::from(count);
    let key = [water.seed as u32, (water.seed >> 32) as u32];
    let blows = f64::from(water.wind_direction);
    let mut waves = Vec::with_capacity(count as usize);
    for i in 0..count {
        let [a, b, c, _] = philox4x32_10([i, 0, 0, 0], key).map(|x| (f64::from(x) + 0.5) / 4_294_967_296.0);
        let k = k_low * ((f64::from(i) + a) * strip).exp();
        let (omega, slope) = dispersion(k, depth);
        // The energy of the strip is S(ω) dω = S(ω) dω/dk k d(ln k).
        let energy = jonswap.density(omega) * slope * k * strip;
        let direction = blows + spread(b);
        let vector = DVec2::new(direction.cos(), -direction.sin()) * k;
        let phase =
            c * std::f64::consts::TAU - (omega * f64::from(water.time)).rem_euclid(std::f64::consts::TAU);
        waves.push(Wave { vector, phase, amplitude: (2.0 * energy).sqrt() });
    }
    Ok(waves)
}

/// ω and dω/dk of waves of wave number `k` on water of a depth.
fn dispersion(k: f64, depth: f64) -> (f64, f64) {
    let deep = GRAVITY * k + TENSION * k.powi(3);
    let tanh = (k * depth).tanh();
    let omega = (deep * tanh).sqrt();
    // d tanh(k d)/dk = d (1 − tanh²), which is nothing in deep water.
    let shallow = if tanh < 1.0 { deep * depth * (1.0 - tanh * tanh) } else { 0.0 };
    (omega, ((GRAVITY + 3.0 * TENSION * k * k) * tanh + shallow) / (2.0 * omega))
}

/// An angle from the wind with the density 2/π cos² on ±π/2: the root of its distribution ½ + (θ + sin θ cos θ)/π.
fn spread(u: f64) -> f64 {
    let (mut low, mut high) = (-std::f64::consts::FRAC_PI_2, std::f64::consts::FRAC_PI_2);
    for _ in 0..52 {
        let middle = 0.5 * (low + high);
        let below = 0.5 + (middle + middle.sin() * middle.cos()) / std::f64::consts::PI < u;
        if below { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// The spectrum of growing waves (Hasselmann et al. 1973).
struct Jonswap {
    alpha: f64,
    /// ω of the peak.
    peak: f64,
}

impl Jonswap {
    fn new(wind: f64, fetch: f64) -> Self {
        let alpha = 0.076 * (wind * wind / (fetch * GRAVITY)).powf(0.22);
        let peak = 22.0 * (GRAVITY * GRAVITY / (wind * fetch)).cbrt();
        // No younger than a fully developed sea (Pierson & Moskowitz 1964): ω_p = 0.855 g/U.
        Self { alpha: alpha.max(8.1e-3), peak: peak.max(0.855 * GRAVITY / wind) }
    }

    /// S(ω), m² s.
    fn density(&self, omega: f64) -> f64 {
        let ratio = omega / self.peak;
        let width = if ratio <= 1.0 { 0.07 } else { 0.09 };
        let bump = (-0.5 * ((ratio - 1.0) / width).powi(2)).exp();
        let base = self.alpha * GRAVITY * GRAVITY / omega.powi(5) * (-1.25 / ratio.powi(4)).exp();
        base * 3.3f64.powf(bump)
    }
}

/// Height and normal at each vertex of the field.
fn summed(waves: &[Wave], field: &Field) -> Vec<(f64, DVec3)> {
    let [columns, rows] = field.cells;
    let mut out = Vec::with_capacity((columns as usize + 1) * (rows as usize + 1));
    // e^(i k_x x) for every column and wave, once; a row then needs one more factor for each wave.
    let turned = |angle: f64| DVec2::new(angle.cos(), angle.sin());
    let mut row: Vec<[f64; 3]> = Vec::new();
    for j in 0..=rows {
        row.clear();
        row.resize(columns as usize + 1, [0.0; 3]);
        for wave in waves {
            let start = field.at(0, j);
            let mut at = turned(wave.vector.dot(start) + wave.phase) * wave.amplitude;
            let step = turned(wave.vector.x * field.size.x / f64::from(columns));
            for sums in &mut row {
                sums[0] += at.x;
                sums[1] -= at.y * wave.vector.x;
                sums[2] -= at.y * wave.vector.y;
                at = step.rotate(at);
            }
        }
        out.extend(row.iter().map(|&[height, x, z]| (height, DVec3::new(-x, 1.0, -z))));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{PI, TAU};

    fn pond() -> Water {
        Water {
            size: [3.0, 2.0],
            resolution: 96,
            depth: Some(1.5),
            wind_speed: 3.0,
            wind_direction: 0.5,
            fetch: 50.0,
            wave_height: None,
            waves: 200,
            seed: 7,
            time: 0.0,
        }
    }

    #[test]
    fn a_body_of_water_is_closed_and_holds_its_water() {
        let mesh = water_surface(&pond()).unwrap();
        mesh.validate().unwrap();
        assert!(mesh.is_closed());
        assert!((mesh.signed_volume() / 9.0 - 1.0).abs() < 2e-3, "{}", mesh.signed_volume());
        let still = water_surface(&Water { wind_speed: 0.0, ..pond() }).unwrap();
        assert!(still.is_closed());
        assert!((still.signed_volume() - 9.0).abs() < 1e-5);
        assert!((still.area() - (6.0 + 6.0 + 15.0)).abs() < 1e-4);
        let sheet = water_surface(&Water { depth: None, ..pond() }).unwrap();
        assert!(!sheet.is_closed());
        assert_eq!(sheet.indices.len(), 2 * 96 * 64);
        assert!(sheet.normals.iter().all(|n| n.y > 0.5));
        // Each triangle faces as its normals do.
        for (i, t) in mesh.indices.iter().enumerate() {
            let [a, b, c] = mesh.corners(i).map(|p| p.as_dvec3());
            let n = (b - a).cross(c - a).normalize();
            assert!(t.iter().all(|&v| mesh.normals[v as usize].as_dvec3().dot(n) > 0.8), "{i}");
        }
    }

    #[test]
    fn waves_are_the_same_again_and_differ_by_seed_and_time() {
        let first = water_surface(&pond()).unwrap();
        assert_eq!(first, water_surface(&pond()).unwrap());
        assert_ne!(first, water_surface(&Water { seed: 8, ..pond() }).unwrap());
        assert_ne!(first, water_surface(&Water { seed: 7 + (1 << 32), ..pond() }).unwrap());
        assert_ne!(first, water_surface(&Water { time: 0.1, ..pond() }).unwrap());
        let bent = Water { resolution: 8, wave_height: Some(40.0), ..pond() };
        assert!(water_surface(&bent).unwrap_err().to_string().contains("resolution"));
        let deep = Water { wave_height: Some(40.0), ..pond() };
        assert!(water_surface(&deep).unwrap_err().to_string().contains("bottom"));
    }

    #[test]
    fn the_height_is_what_is_asked_for_or_what_the_wind_gives() {
        let asked = Water { size: [5.0, 5.0], resolution: 400, depth: None, ..pond() };
        let mesh = water_surface(&Water { wave_height: Some(0.04), ..asked.clone() }).unwrap();
        let sum: f64 = mesh.positions.iter().map(|p| f64::from(p.y).powi(2)).sum();
        let rms = (sum / mesh.positions.len() as f64).sqrt();
        assert!((rms / 0.01 - 1.0).abs() < 0.1, "{rms}");
        // Hasselmann et al. 1973: σ² = 1.6·10⁻⁷ U² F/g.
        let sea = 1.6e-7 * 9.0 * 50.0 / GRAVITY;
        let field = Field::new(asked.size, asked.resolution);
        let waves = spectrum(&Water { waves: 1000, ..asked }, &field).unwrap();
        let wind: f64 = waves.iter().map(|w| 0.5 * w.amplitude * w.amplitude).sum();
        assert!((wind / sea - 1.0).abs() < 0.3, "{wind} {sea}");
    }

    #[test]
    fn normals_are_those_of_the_surface_and_waves_travel_by_their_speed() {
        let field = Field::new([4.0, 2.0], 256);
        let wave = |phase| Wave { vector: DVec2::new(TAU / 2.0, 0.0), phase, amplitude: 0.1 };
        let points = summed(&[wave(0.3)], &field);
        for j in [0, 128] {
            for i in 1..256u32 {
                let at = |i: u32| points[(j * 257 + i) as usize];
                let slope = (at(i + 1).0 - at(i - 1).0) / (2.0 * 4.0 / 256.0);
                let normal = at(i).1;
                assert!((slope + normal.x / normal.y).abs() < 1e-3);
                assert!((at(i).0 - 0.1 * (PI * field.at(i, j).x + 0.3).cos()).abs() < 1e-12);
            }
        }
        // Deep, shallow and capillary water: ω/k is √(g/k), √(g d) and √(τ k).
        let phase_speed = |k: f64, depth: f64| dispersion(k, depth).0 / k;
        assert!((phase_speed(1.0, f64::INFINITY) - GRAVITY.sqrt()).abs() < 1e-4);
        assert!((phase_speed(1e-3, 2.0) - (2.0 * GRAVITY).sqrt()).abs() < 1e-4);
        assert!((phase_speed(1e5, 1.0) / (TENSION * 1e5).sqrt() - 1.0).abs() < 1e-4);
        for (k, depth) in [(1.0, 0.5), (30.0, f64::INFINITY), (700.0, 0.1)] {
            let slope = (dispersion(k * 1.0001, depth).0 - dispersion(k * 0.9999, depth).0) / (2e-4 * k);
            assert!((slope / dispersion(k, depth).1 - 1.0).abs() < 1e-6);
        }
    }

    #[test]
    fn directions_are_spread_about_the_wind() {
        assert!(spread(0.5).abs() < 1e-9);
        for u in [0.01, 0.2, 0.7, 0.99] {
            let t = spread(u);
            assert!((0.5 + (t + t.sin() * t.cos()) / PI - u).abs() < 1e-12);
        }
    }
}
