use std::ops::BitOr;

/// What a path carries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TransportMode {
    /// Camera paths: radiance flows from `wi` to `wo` and scales by (η_o/η_i)² where it is refracted
    /// (Veach 1997, §5.2).
    Radiance,
    /// Light paths: importance flows from `wi` to `wo`, the flux of photons from `wo` to `wi`; flux does not scale
    /// at refraction.
    Importance,
}

/// A set of properties of lobes: how narrow (one of diffuse, glossy, specular) and to which side.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Lobes(pub u8);

impl Lobes {
    /// No lobe.
    pub const NONE: Self = Self(0);
    /// Scatters about evenly.
    pub const DIFFUSE: Self = Self(1);
    /// Scatters into a lobe of finite width, however narrow.
    pub const GLOSSY: Self = Self(2);
    /// Scatters into one direction: a delta distribution.
    pub const SPECULAR: Self = Self(4);
    /// To the side of `wo`.
    pub const REFLECTION: Self = Self(8);
    /// To the other side.
    pub const TRANSMISSION: Self = Self(16);
    /// Every lobe.
    pub const ALL: Self = Self(31);
    /// As a restriction: delta lobes only.
    pub const DELTA: Self = Self(4 | 8 | 16);
    /// As a restriction: all but delta lobes.
    pub const NON_DELTA: Self = Self(1 | 2 | 8 | 16);

    /// Whether every property of `other` is in this set. A restriction `allowed` admits a lobe when
    /// `allowed.contains(lobe)`.
    #[inline]
    pub const fn contains(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }

    /// Whether they share a property.
    #[inline]
    pub const fn intersects(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }

    /// All properties of both; usable in constants.
    #[inline]
    pub const fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

impl BitOr for Lobes {
    type Output = Self;
    #[inline]
    fn bitor(self, other: Self) -> Self {
        self.union(other)
    }
}
