//! What materials are called: indices of glasses and liquids, and of metals.

/// The index at the sodium line of a substance by Mitsuba's name for it.
pub(super) fn ior(name: &str) -> Option<f64> {
    let name = name.to_ascii_lowercase();
    IORS.iter().find(|(n, _)| *n == name).map(|(_, n)| *n)
}

/// Names that [`ior`] knows.
pub(super) fn ior_names() -> impl Iterator<Item = &'static str> {
    IORS.iter().map(|(name, _)| *name)
}

/// n and k in RGB of a material by Mitsuba's name for it, which may end in `_palik`. "none" reflects all.
pub(super) fn metal(name: &str) -> Option<([f64; 3], [f64; 3])> {
    if name == "none" {
        // n = 0, which ours may not be, has a reflectance of 1.
        return Some(([1e-6; 3], [1.0; 3]));
    }
    let name = name.strip_suffix("_palik").unwrap_or(name);
    METALS.iter().find(|(n, ..)| n.eq_ignore_ascii_case(name)).map(|(_, n, k)| (*n, *k))
}

/// Names that [`metal`] knows.
pub(super) fn metal_names() -> impl Iterator<Item = &'static str> {
    METALS.iter().map(|(name, ..)| *name).chain(["none"])
}

/// Facts of Mitsuba's documentation (the plugin `dielectric`), measured values of textbooks.
const IORS: [(&str, f64); 24] = [
    ("vacuum", 1.0),
    ("helium", 1.000036),
    ("hydrogen", 1.000132),
    ("air", 1.000277),
    ("carbon dioxide", 1.00045),
    ("water", 1.333),
    ("acetone", 1.36),
    ("ethanol", 1.361),
    ("carbon tetrachloride", 1.461),
    ("glycerol", 1.4729),
    ("benzene", 1.501),
    ("silicone oil", 1.52045),
    ("bromine", 1.661),
    ("water ice", 1.31),
    ("fused quartz", 1.458),
    ("pyrex", 1.47),
    ("acrylic glass", 1.49),
    ("polypropylene", 1.49),
    ("bk7", 1.5046),
    ("sodium chloride", 1.544),
    ("amber", 1.55),
    ("pet", 1.575),
    ("diamond", 2.419),
    ("glass", 1.5),
];

/// Measured n and k (Palik, *Handbook of Optical Constants of Solids*, 1998, and the SOPRA tables) as linear Rec. 709 of
/// the curves taken for light, which is what Mitsuba's RGB mode renders with: (n, k) by symbol.
const METALS: [(&str, [f64; 3], [f64; 3]); 39] = [
    ("Ag", [0.1553, 0.1167, 0.1384], [4.828, 3.122, 2.147]),
    ("Al", [1.658, 0.8804, 0.5212], [9.224, 6.27, 4.837]),
    ("AlAs", [3.605, 3.233, 2.216], [0.0006794, 0.0, 0.007513]),
    ("Au", [0.143, 0.3753, 1.442], [3.983, 2.386, 1.603]),
    ("Be", [4.185, 3.185, 2.784], [3.835, 3.01, 2.869]),
    ("Cr", [4.37, 2.917, 1.655], [5.207, 4.231, 3.755]),
    ("CsI", [2.145, 1.702, 1.662], [0.0, 0.0, 0.0]),
    ("Cu", [0.201, 0.9237, 1.102], [3.913, 2.453, 2.142]),
    ("Cu2O", [3.552, 2.95, 2.752], [0.1142, 0.1939, 0.6061]),
    ("CuO", [3.248, 2.448, 2.21], [0.5211, 0.57, 0.7222]),
    ("Hg", [2.399, 1.44, 0.9096], [6.328, 4.372, 3.422]),
    ("HgTe", [4.779, 3.231, 2.66], [1.632, 1.581, 1.729]),
    ("Ir", [3.086, 2.082, 1.618], [5.592, 4.067, 3.267]),
    ("K", [0.06404, 0.04641, 0.03818], [2.104, 1.349, 0.9131]),
    ("Li", [0.2658, 0.1956, 0.2209], [3.54, 2.311, 1.669]),
    ("MgO", [2.09, 1.651, 1.595], [0.0, 0.0, 0.0]),
    ("Mo", [4.484, 3.525, 2.776], [4.111, 3.421, 3.151]),
    ("Na", [0.06027, 0.05614, 0.06199], [3.179, 2.112, 1.579]),
    ("Nb", [3.42, 2.79, 2.396], [3.441, 2.738, 2.58]),
    ("Ni", [2.367, 1.663, 1.467], [4.499, 3.05, 2.345]),
    ("Rh", [2.586, 1.86, 1.554], [6.782, 4.703, 3.976]),
    ("Se-e", [5.723, 4.166, 4.081], [0.8711, 1.105, 1.565]),
    ("Se", [4.058, 2.843, 2.821], [0.754, 0.6384, 0.5218]),
    ("SiC", [3.172, 2.526, 2.479], [0.0, 0.0, 1.019e-05]),
    ("SnTe", [4.524, 1.982, 1.282], [0.0, 0.0, 0.0]),
    ("Ta", [2.063, 2.393, 2.628], [2.408, 1.741, 1.947]),
    ("Te-e", [7.509, 4.296, 2.37], [5.584, 4.947, 3.998]),
    ("Te", [7.39, 4.482, 2.637], [3.256, 3.527, 3.292]),
    ("ThF4", [1.831, 1.442, 1.388], [0.0, 0.0, 0.0]),
    ("TiC", [3.701, 2.837, 2.582], [3.266, 2.352, 2.173]),
    ("TiN", [1.648, 1.151, 1.38], [3.368, 1.943, 1.102]),
    ("TiO2-e", [3.107, 2.513, 2.582], [2.975e-05, 0.0, 0.0001827]),
    ("TiO2", [3.457, 2.802, 2.905], [0.0001053, 0.0, 0.0006529]),
    ("VC", [3.658, 2.753, 2.533], [3.068, 2.199, 1.963]),
    ("VN", [2.866, 2.119, 1.94], [3.032, 2.056, 1.616]),
    ("V", [4.278, 3.513, 2.761], [3.491, 2.889, 3.112]),
    ("W", [4.371, 3.3, 2.998], [3.501, 2.605, 2.273]),
    ("a-C", [2.944, 2.227, 1.968], [0.8875, 0.7993, 0.8153]),
    ("d-C", [2.709, 2.319, 2.229], [0.0, 0.0, 0.0]),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names() {
        assert_eq!(ior("BK7"), Some(1.5046));
        assert_eq!(ior("gold"), None);
        assert_eq!(metal("Cu"), metal("cu_palik"));
        assert!(metal("none").is_some_and(|(n, k)| {
            let [n, k] = [n[0], k[0]];
            (((n - 1.0).powi(2) + k * k) / ((n + 1.0).powi(2) + k * k) - 1.0).abs() < 1e-5
        }));
        assert!(metal_names().all(|name| metal(name).is_some_and(|(n, _)| n.iter().all(|n| *n > 0.0))));
        // Copper's reflectance at normal incidence falls from red to blue.
        let (n, k) = metal("Cu").unwrap();
        let r = [0, 1, 2].map(|c| color::normal_reflectance(n[c], k[c]));
        assert!(r[0] > 0.9 && r[0] > r[1] && r[1] > r[2]);
    }
}
