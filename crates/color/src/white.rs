use crate::spectrum::{blackbody_xyz, xyz_to_rgb};

/// The white that a picture is balanced for: what had this colour is shown as grey.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum WhiteBalance {
    /// Colours stay as they are: D65 is white.
    #[default]
    None,
    /// The light of the picture itself, found in it and taken away in part.
    Auto,
    /// The light of a black body of this temperature in kelvin.
    Kelvin(f32),
    /// A standard illuminant.
    Illuminant(Illuminant),
}

/// A standard illuminant: its name and its chromaticity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Illuminant {
    name: &'static str,
    xy: [f64; 2],
}

const fn illuminant(name: &'static str, x: f64, y: f64) -> Illuminant {
    Illuminant { name, xy: [x, y] }
}

/// CIE 15:2018, tables of the 2° observer.
const ILLUMINANTS: [Illuminant; 31] = [
    illuminant("A", 0.44758, 0.40745),
    illuminant("C", 0.31006, 0.31616),
    illuminant("D50", 0.34567, 0.35851),
    illuminant("D55", 0.33243, 0.34744),
    illuminant("D65", 0.31272, 0.32903),
    illuminant("D75", 0.29903, 0.31488),
    illuminant("E", 1.0 / 3.0, 1.0 / 3.0),
    illuminant("F1", 0.3131, 0.3371),
    illuminant("F2", 0.3721, 0.3751),
    illuminant("F3", 0.4091, 0.3941),
    illuminant("F4", 0.4402, 0.4031),
    illuminant("F5", 0.3138, 0.3452),
    illuminant("F6", 0.3779, 0.3882),
    illuminant("F7", 0.3129, 0.3292),
    illuminant("F8", 0.3458, 0.3586),
    illuminant("F9", 0.3741, 0.3727),
    illuminant("F10", 0.3458, 0.3588),
    illuminant("F11", 0.3805, 0.3769),
    illuminant("F12", 0.4370, 0.4042),
    illuminant("LED-B1", 0.4560, 0.4078),
    illuminant("LED-B2", 0.4357, 0.4012),
    illuminant("LED-B3", 0.3756, 0.3723),
    illuminant("LED-B4", 0.3422, 0.3502),
    illuminant("LED-B5", 0.3118, 0.3236),
    illuminant("LED-BH1", 0.4474, 0.4066),
    illuminant("LED-RGB1", 0.4557, 0.4211),
    illuminant("LED-V1", 0.4560, 0.4548),
    illuminant("LED-V2", 0.3781, 0.3775),
    illuminant("HP1", 0.5330, 0.4150),
    illuminant("HP2", 0.4778, 0.4158),
    illuminant("HP3", 0.4302, 0.4075),
];

impl Illuminant {
    /// All of them.
    pub const ALL: &'static [Self] = &ILLUMINANTS;

    /// Its name, as D50.
    pub const fn name(self) -> &'static str {
        self.name
    }

    /// The illuminant of a name, in upper or lower case.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.iter().find(|i| i.name.eq_ignore_ascii_case(name)).copied()
    }
}

impl WhiteBalance {
    /// Temperatures that may be balanced for, in kelvin.
    pub const KELVIN: [f32; 2] = [1000.0, 40000.0];

    /// The value as it is written: none, auto, a temperature, a name.
    pub fn text(self) -> String {
        match self {
            Self::None => "none".into(),
            Self::Auto => "auto".into(),
            Self::Kelvin(kelvin) => kelvin.to_string(),
            Self::Illuminant(illuminant) => illuminant.name.into(),
        }
    }

    /// What [`text`](Self::text) writes, and temperatures as 3200K; `None` for anything else.
    pub fn from_text(text: &str) -> Option<Self> {
        let text = text.trim();
        let number = text.strip_suffix(['K', 'k']).unwrap_or(text).trim_end();
        match (text, number.parse::<f32>()) {
            ("none", _) => Some(Self::None),
            ("auto", _) => Some(Self::Auto),
            (_, Ok(kelvin)) => {
                (Self::KELVIN[0]..=Self::KELVIN[1]).contains(&kelvin).then_some(Self::Kelvin(kelvin))
            }
            (_, Err(_)) => Illuminant::from_name(text).map(Self::Illuminant),
        }
    }
}

/// Linear Rec. 709 to CIE XYZ, the inverse of [`xyz_to_rgb`].
const XYZ_FROM_RGB: [[f64; 3]; 3] = [
    [0.412_390_799_265_96, 0.357_584_339_383_88, 0.180_480_788_401_83],
    [0.212_639_005_871_51, 0.715_168_678_767_76, 0.072_192_315_360_73],
    [0.019_330_818_715_59, 0.119_194_779_794_63, 0.950_532_152_249_66],
];

/// The sharpened cone responses of Bradford (Lam 1985; as in ICC.1:2010, annex E).
const BRADFORD: [[f64; 3]; 3] =
    [[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]];

/// The inverse of [`BRADFORD`].
const BRADFORD_INVERSE: [[f64; 3]; 3] = [
    [0.986_992_905_466_71, -0.147_054_256_420_99, 0.159_962_651_663_73],
    [0.432_305_269_723_39, 0.518_360_271_536_78, 0.049_291_228_212_86],
    [-0.008_528_664_575_18, 0.040_042_821_654_08, 0.968_486_695_788_75],
];

/// A linear change of linear Rec. 709 colours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Adaptation([[f64; 3]; 3]);

impl Adaptation {
    /// Changes nothing.
    pub const NONE: Self = Self([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);

    /// Makes light of a fixed kind the white of the display; none for [`WhiteBalance::None`], and for
    /// [`WhiteBalance::Auto`], which must look at the picture.
    pub fn of(balance: WhiteBalance) -> Self {
        match balance {
            WhiteBalance::None | WhiteBalance::Auto => Self::NONE,
            WhiteBalance::Kelvin(kelvin) => Self::from_xyz(blackbody_xyz(kelvin), 1.0),
            WhiteBalance::Illuminant(Illuminant { xy: [x, y], .. }) => {
                Self::from_xyz([x / y, 1.0, (1.0 - x - y) / y], 1.0)
            }
        }
    }

    /// Makes what has the linear Rec. 709 colour `white` nearer to grey: by the share `degree` in the logarithm of
    /// each cone's response, 0 nothing, 1 wholly. Colours that cones cannot see change nothing.
    pub fn from_rgb(white: [f64; 3], degree: f64) -> Self {
        Self::from_xyz(times(&XYZ_FROM_RGB, white), degree)
    }

    /// Von Kries' scaling of Bradford's cones; luminance 1 in `white` stays luminance 1.
    fn from_xyz(white: [f64; 3], degree: f64) -> Self {
        let target = times(&BRADFORD, times(&XYZ_FROM_RGB, [1.0; 3]));
        let source = times(&BRADFORD, white.map(|v| v / white[1]));
        if !source.iter().all(|v| v.is_finite() && *v > 1e-6) {
            return Self::NONE;
        }
        let gains: [f64; 3] = std::array::from_fn(|c| (target[c] / source[c]).powf(degree));
        let column = |c: usize| {
            let mut unit = [0.0; 3];
            unit[c] = 1.0;
            let cones = times(&BRADFORD, times(&XYZ_FROM_RGB, unit));
            xyz_to_rgb(times(&BRADFORD_INVERSE, std::array::from_fn(|i| gains[i] * cones[i])))
        };
        let columns = [column(0), column(1), column(2)];
        Self(std::array::from_fn(|row| std::array::from_fn(|c| columns[c][row])))
    }

    /// A colour, adapted.
    pub fn apply(&self, rgb: [f32; 3]) -> [f32; 3] {
        if *self == Self::NONE { rgb } else { times(&self.0, rgb.map(f64::from)).map(|v| v as f32) }
    }
}

fn times(matrix: &[[f64; 3]; 3], v: [f64; 3]) -> [f64; 3] {
    matrix.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

/// Correlated colour temperature of a linear Rec. 709 colour in kelvin (McCamy 1992): within some 2 % from 2800 to 6500 K.
pub fn correlated_temperature(rgb: [f64; 3]) -> f64 {
    let [x, y, z] = times(&XYZ_FROM_RGB, rgb);
    let sum = x + y + z;
    let n = (x / sum - 0.3320) / (0.1858 - y / sum);
    ((449.0 * n + 3525.0) * n + 6823.3) * n + 5520.33
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_white_of_a_lamp_becomes_grey() {
        for kelvin in [2200.0, 2856.0, 3200.0, 5000.0, 9000.0, 20000.0] {
            let lamp = crate::blackbody_rgb(kelvin);
            let shown = Adaptation::of(WhiteBalance::Kelvin(kelvin)).apply(lamp);
            assert!(shown.iter().all(|v| (v - 1.0).abs() < 2e-4), "{kelvin}: {shown:?}");
        }
        let d65 = Adaptation::of(WhiteBalance::Illuminant(Illuminant::from_name("d65").unwrap()));
        assert!(d65.apply([0.3, 0.5, 0.7]).iter().zip([0.3, 0.5, 0.7]).all(|(a, b)| (a - b).abs() < 1e-3));
        // A black body of 2856 K is illuminant A.
        let a = Adaptation::of(WhiteBalance::Illuminant(Illuminant::from_name("A").unwrap()));
        let shown = a.apply(crate::blackbody_rgb(2856.0));
        assert!(shown.iter().all(|v| (v - 1.0).abs() < 2e-3), "{shown:?}");
    }

    #[test]
    fn d50_to_d65_is_the_published_matrix() {
        // Bradford from D50 to D65 in XYZ, as widely published: its first row.
        let adaptation = Adaptation::from_xyz([0.96422, 1.0, 0.82521], 1.0);
        let rgb = xyz_to_rgb([0.3, 0.4, 0.2]);
        let back = times(&XYZ_FROM_RGB, times(&adaptation.0, rgb));
        let x = 0.9555766 * 0.3 - 0.0230393 * 0.4 + 0.0631636 * 0.2;
        assert!((back[0] - x).abs() < 1e-3, "{back:?} {x}");
    }

    #[test]
    fn half_an_adaptation_lies_between() {
        let lamp = crate::blackbody_rgb(3000.0);
        let shown = Adaptation::from_rgb(lamp.map(f64::from), 0.5).apply(lamp);
        assert!(shown[0] > 1.1 && shown[0] < lamp[0] && shown[2] < 0.95 && shown[2] > lamp[2], "{shown:?}");
        assert_eq!(Adaptation::from_rgb([0.0; 3], 1.0), Adaptation::NONE);
        assert_eq!(Adaptation::from_rgb([f64::NAN; 3], 1.0), Adaptation::NONE);
    }

    #[test]
    fn words_come_back() {
        for text in ["none", "auto", "3200", "D65", "F11", "LED-V2"] {
            assert_eq!(WhiteBalance::from_text(text).unwrap().text(), text);
        }
        assert_eq!(WhiteBalance::from_text("3200K"), Some(WhiteBalance::Kelvin(3200.0)));
        for wrong in ["", "D66", "999", "nan", "1e9", "K", "-5"] {
            assert_eq!(WhiteBalance::from_text(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn temperatures_are_found() {
        for kelvin in [2800.0, 4000.0, 6500.0] {
            let found = correlated_temperature(crate::blackbody_rgb(kelvin).map(f64::from));
            assert!((found / f64::from(kelvin) - 1.0).abs() < 0.02, "{kelvin}: {found}");
        }
    }
}
