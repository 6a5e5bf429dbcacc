use math::FRAC_1_PI;

/// Profile of a density estimate over t = d/r ∈ [0, 1]: ∫ k over the unit disc = 1, and 0 beyond it.
///
/// A cone of another slope than 1 is not offered: with the radius of the k-th photon it is inconsistent
/// (García, Ureña & Sbert 2012).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Kernel {
    /// 1/π.
    Constant,
    /// (3/π)(1 − t).
    Cone,
    /// (2/π)(1 − t²).
    #[default]
    Epanechnikov,
    /// (3/π)(1 − t²)².
    Silverman,
}

impl Kernel {
    /// All kernels.
    pub const ALL: [Self; 4] = [Self::Constant, Self::Cone, Self::Epanechnikov, Self::Silverman];

    /// k(t).
    #[inline]
    pub fn value(self, t: f32) -> f32 {
        self.value_of_square(t * t)
    }

    /// k(√`t2`); saves the root where the kernel is a polynomial in t².
    #[inline]
    pub fn value_of_square(self, t2: f32) -> f32 {
        if t2 > 1.0 {
            return 0.0;
        }
        let s = 1.0 - t2;
        match self {
            Self::Constant => FRAC_1_PI,
            Self::Cone => 3.0 * FRAC_1_PI * (1.0 - t2.sqrt()),
            Self::Epanechnikov => 2.0 * FRAC_1_PI * s,
            Self::Silverman => 3.0 * FRAC_1_PI * s * s,
        }
    }

    /// Name in scene files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Constant => "constant",
            Self::Cone => "cone",
            Self::Epanechnikov => "epanechnikov",
            Self::Silverman => "silverman",
        }
    }

    /// The kernel of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|k| k.name() == name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kernels_integrate_to_one_over_the_unit_disc() {
        for kernel in Kernel::ALL {
            let n = 20_000;
            let sum: f64 = (0..n)
                .map(|i| (f64::from(i) + 0.5) / f64::from(n))
                .map(|t| f64::from(kernel.value(t as f32)) * std::f64::consts::TAU * t / f64::from(n))
                .sum();
            assert!((sum - 1.0).abs() < 1e-6, "{kernel:?} {sum}");
            assert_eq!(kernel.value(1.0001), 0.0);
            assert!((kernel.value(0.3) - kernel.value_of_square(0.09)).abs() < 1e-6);
        }
    }

    #[test]
    fn names_round_trip() {
        for kernel in Kernel::ALL {
            assert_eq!(Kernel::from_name(kernel.name()), Some(kernel));
        }
        assert_eq!(Kernel::from_name("gauss"), None);
    }
}
