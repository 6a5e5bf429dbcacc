/// Index of refraction at the sodium d line (587.6 nm) of common transparent matter, by name.
///
/// Named matter has the value of the publication named beside it, SCHOTT glasses that of their catalogue of 2017;
/// facts from refractiveindex.info (CC0 1.0). Case, spaces, hyphens and underscores do not matter in names.
pub fn named_ior(name: &str) -> Option<f32> {
    let wanted = crate::plain_name(name);
    MATTER.iter().chain(&SCHOTT).find(|(n, _)| crate::plain_name(n) == wanted).map(|&(_, nd)| nd)
}

/// Names that [`named_ior`] knows, matter first, then glasses.
pub fn ior_names() -> impl Iterator<Item = &'static str> {
    MATTER.iter().chain(&SCHOTT).map(|&(name, _)| name)
}

const MATTER: [(&str, f32); 16] = [
    // Sultanova, Kasarova & Nikolov 2009, poly(methyl methacrylate).
    ("acrylic", 1.4906),
    // Ciddor 1996, 15 °C, 101 325 Pa.
    ("air", 1.000277),
    // Peter 1923.
    ("diamond", 2.4175),
    // Rheims, Köser & Wriedt 1997.
    ("ethanol", 1.3617),
    // Malitson 1965.
    ("fused-silica", 1.4585),
    // The round value of the trade.
    ("glass", 1.5),
    // Rheims, Köser & Wriedt 1997.
    ("glycerol", 1.4723),
    // Warren & Brandt 2008.
    ("ice", 1.3098),
    // Sultanova, Kasarova & Nikolov 2009.
    ("polycarbonate", 1.5848),
    // Devore 1951, ordinary ray.
    ("rutile", 2.6143),
    // Li 1976.
    ("salt", 1.5442),
    // Malitson & Dodge 1972, ordinary ray.
    ("sapphire", 1.7682),
    // Rubin 1985, clear.
    ("soda-lime-glass", 1.5234),
    // Nothing.
    ("vacuum", 1.0),
    // Daimon & Masumura 2007, 20 °C.
    ("water", 1.3334),
    // Sultanova, Kasarova & Nikolov 2009: another name of acrylic.
    ("pmma", 1.4906),
];

/// Glasses whose index differs from that of another only in transmittance (HT, HTi, HTultra) are left out.
#[rustfmt::skip]
const SCHOTT: [(&str, f32); 142] = [
    ("BAFN6", 1.589), ("BK7G18", 1.51975), ("F2", 1.62004), ("F2G12", 1.62072), ("F5", 1.60342),
    ("FK3", 1.4645), ("FK5HTi", 1.48748), ("K10", 1.50137), ("K5G20", 1.52344), ("K7", 1.51112),
    ("KZFS12", 1.696), ("KZFSN4", 1.6134), ("LAFN7", 1.7495), ("LAK9G15", 1.69064), ("LAKL12", 1.6779),
    ("LASF35", 2.02204), ("LASFN9", 1.85025), ("LF5", 1.58144), ("LF5G15", 1.58397), ("LF5G19", 1.59655),
    ("LLF1", 1.54814), ("LLF1HTi", 1.54815), ("N-BAF10", 1.67003), ("N-BAF3", 1.58272), ("N-BAF4", 1.60568),
    ("N-BAF51", 1.65224), ("N-BAF52", 1.60863), ("N-BAK1", 1.5725), ("N-BAK2", 1.53996),
    ("N-BAK4", 1.56883), ("N-BALF4", 1.57956), ("N-BALF5", 1.54739), ("N-BASF2", 1.66446),
    ("N-BASF64", 1.704), ("N-BK10", 1.49782), ("N-BK7", 1.5168), ("N-F2", 1.62005), ("N-FK5", 1.48749),
    ("N-FK51", 1.48656), ("N-FK51A", 1.48656), ("N-FK58", 1.456), ("N-K5", 1.52249), ("N-KF9", 1.52346),
    ("N-KZFS11", 1.63775), ("N-KZFS2", 1.55836), ("N-KZFS4", 1.61336), ("N-KZFS5", 1.65412),
    ("N-KZFS8", 1.72047), ("N-LAF2", 1.74397), ("N-LAF21", 1.788), ("N-LAF3", 1.717), ("N-LAF32", 1.79457),
    ("N-LAF33", 1.78582), ("N-LAF34", 1.7725), ("N-LAF35", 1.7433), ("N-LAF36", 1.79952),
    ("N-LAF7", 1.7495), ("N-LAK10", 1.72003), ("N-LAK12", 1.6779), ("N-LAK14", 1.6968),
    ("N-LAK21", 1.64049), ("N-LAK22", 1.65113), ("N-LAK33A", 1.75393), ("N-LAK33B", 1.755),
    ("N-LAK34", 1.72916), ("N-LAK7", 1.6516), ("N-LAK8", 1.713), ("N-LAK9", 1.691), ("N-LASF31", 1.88067),
    ("N-LASF31A", 1.883), ("N-LASF40", 1.83404), ("N-LASF41", 1.83501), ("N-LASF43", 1.8061),
    ("N-LASF44", 1.8042), ("N-LASF45", 1.80107), ("N-LASF46", 1.90138), ("N-LASF46A", 1.90366),
    ("N-LASF46B", 1.90366), ("N-LASF9", 1.85025), ("N-PK51", 1.52855), ("N-PK52A", 1.497),
    ("N-PSK3", 1.55232), ("N-PSK53", 1.62014), ("N-PSK53A", 1.618), ("N-SF1", 1.71736), ("N-SF10", 1.72828),
    ("N-SF11", 1.78472), ("N-SF14", 1.76182), ("N-SF15", 1.69892), ("N-SF19", 1.66679), ("N-SF2", 1.64769),
    ("N-SF4", 1.75513), ("N-SF5", 1.67271), ("N-SF56", 1.7847), ("N-SF57", 1.84666), ("N-SF6", 1.80518),
    ("N-SF64", 1.70591), ("N-SF66", 1.92286), ("N-SF8", 1.68894), ("N-SK10", 1.62278), ("N-SK11", 1.56384),
    ("N-SK14", 1.60311), ("N-SK15", 1.62296), ("N-SK16", 1.62041), ("N-SK2", 1.60738), ("N-SK4", 1.61272),
    ("N-SK5", 1.58913), ("N-SSK2", 1.62229), ("N-SSK5", 1.65844), ("N-SSK8", 1.61773), ("N-ZK7", 1.50847),
    ("N-ZK7A", 1.508054), ("P-BK7", 1.5164), ("P-LAF37", 1.7555), ("P-LAK35", 1.6935), ("P-LASF47", 1.8061),
    ("P-LASF50", 1.8086), ("P-LASF51", 1.81), ("P-PK53", 1.5269), ("P-SF67", 1.9068), ("P-SF68", 2.0052),
    ("P-SF69", 1.7225), ("P-SF8", 1.68893), ("P-SK57", 1.587), ("P-SK57Q1", 1.586), ("P-SK58A", 1.58913),
    ("P-SK60", 1.61035), ("SF1", 1.71736), ("SF10", 1.72825), ("SF11", 1.78472), ("SF14", 1.76182),
    ("SF15", 1.69895), ("SF2", 1.64769), ("SF4", 1.7552), ("SF5", 1.6727), ("SF56A", 1.7847),
    ("SF57", 1.84666), ("SF6", 1.80518), ("SF66", 1.92286), ("SF6G05", 1.80906), ("SFL57", 1.84666),
    ("SFL6", 1.80518),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_found_however_they_are_spelt() {
        assert_eq!(named_ior("N-BK7"), Some(1.5168));
        assert_eq!(named_ior("n bk7"), named_ior("NBK7"));
        assert_eq!(named_ior("Fused Silica"), Some(1.4585));
        assert_eq!(named_ior("unobtainium"), None);
    }

    #[test]
    fn names_are_unique_and_values_plausible() {
        let mut names: Vec<_> = ior_names().map(crate::plain_name).collect();
        let count = names.len();
        names.sort();
        names.dedup();
        assert_eq!(names.len(), count);
        assert!(ior_names().filter_map(named_ior).all(|n| (1.0..2.7).contains(&n)));
    }

    #[test]
    fn sellmeier_equations_give_the_indices() {
        // n² = 1 + Σ B λ²/(λ² − C), λ = 0.5875618 µm; coefficients of SCHOTT's data sheets and of Malitson 1965.
        let n = |terms: [(f64, f64); 3]| {
            let l2 = 0.5875618f64 * 0.5875618;
            (1.0 + terms.iter().map(|(b, c)| b * l2 / (l2 - c)).sum::<f64>()).sqrt() as f32
        };
        let bk7 = n([(1.03961212, 0.00600069867), (0.231792344, 0.0200179144), (1.01046945, 103.560653)]);
        let silica = n([
            (0.6961663, 0.0684043f64.powi(2)),
            (0.4079426, 0.1162414f64.powi(2)),
            (0.8974794, 9.896161f64.powi(2)),
        ]);
        assert!((named_ior("N-BK7").unwrap() - bk7).abs() < 2e-5);
        assert!((named_ior("fused-silica").unwrap() - silica).abs() < 1e-4);
    }
}
