use color::Lanes;
use math::{Vec3, octahedral_decode, octahedral_encode};

/// A photon as it was deposited on a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Photon {
    /// Where it hit.
    pub position: Vec3,
    /// wi: unit, points away from the surface, toward where the photon came from.
    pub direction: Vec3,
    /// Unit geometric normal on the side of wi.
    pub normal: Vec3,
    /// Flux Φ, W in each lane.
    pub power: Lanes,
    /// Number of scattering events between the light and this hit.
    pub depth: u8,
    /// What the path was.
    pub flags: PhotonFlags,
}

/// Eight marks of a photon.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PhotonFlags(
    /// The bits.
    pub u8,
);

impl PhotonFlags {
    /// None set.
    pub const NONE: Self = Self(0);
    /// Every scattering event before this hit was specular, and there was at least one (L S⁺ D).
    pub const CAUSTIC: Self = Self(1);

    /// Groups of lights that can be told apart.
    pub const MOST_GROUPS: u32 = 127;

    /// Marks a photon of a light of that group; none from [`Self::MOST_GROUPS`] on.
    #[inline]
    pub const fn of_group(group: u32) -> Self {
        if group < Self::MOST_GROUPS { Self((group as u8 + 1) << 1) } else { Self::NONE }
    }

    /// The group of the light, where it is known.
    #[inline]
    pub const fn group(self) -> Option<u8> {
        (self.0 >> 1).checked_sub(1)
    }

    /// Whether all bits of `other` are set.
    #[inline]
    pub const fn contains(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }

    /// These and those of `other`.
    #[inline]
    pub const fn with(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

impl Photon {
    /// Whether it can be stored: everything finite, direction and normal not zero.
    pub(crate) fn is_sound(&self) -> bool {
        let unit = |v: Vec3| v.is_finite() && v.length_squared() > 0.0;
        self.position.is_finite() && self.power.is_finite() && unit(self.direction) && unit(self.normal)
    }
}

/// What a gather reads of each photon: 20 bytes. The power is kept as it came; the direction is within 0.004°.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Payload {
    power: [f32; 4],
    direction: u32,
}

impl Payload {
    pub(crate) fn new(photon: &Photon) -> Self {
        Self { power: photon.power.0.to_array(), direction: octahedral_encode(photon.direction) }
    }

    #[inline]
    pub(crate) fn power(&self) -> Lanes {
        Lanes(self.power.into())
    }

    #[inline]
    pub(crate) fn direction(&self) -> Vec3 {
        octahedral_decode(self.direction)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use math::DVec3;
    use sampling::{Domain, Sampler, warp};

    fn photon(direction: Vec3, power: Lanes) -> Photon {
        let flags = PhotonFlags::NONE;
        Photon { position: Vec3::ZERO, direction, normal: Vec3::Z, power, depth: 0, flags }
    }

    #[test]
    fn packing_keeps_power_and_does_not_bias_directions() {
        assert_eq!(size_of::<Payload>(), 20);
        let mut s = Sampler::new(1, 0, Domain::Other, 0);
        let n = 100_000;
        let (mut bias, mut cosine_bias, mut worst) = (DVec3::ZERO, 0f64, 0f32);
        for _ in 0..n {
            let w = warp::cosine_hemisphere(s.next_2d());
            let power = Lanes::rgb(s.next_1d() * 1e-20, s.next_1d() * 1e20, s.next_1d());
            let p = Payload::new(&photon(w, power));
            assert_eq!(p.power(), power);
            let e = p.direction() - w;
            worst = worst.max(e.length());
            bias += e.as_dvec3();
            cosine_bias += f64::from(e.z);
        }
        assert!(worst < 7e-5, "0.004° {worst}");
        assert!((bias / f64::from(n)).length() < 1e-6, "{bias}");
        assert!((cosine_bias / f64::from(n)).abs() < 1e-6, "{cosine_bias}");
    }

    #[test]
    fn groups_are_kept_beside_the_other_marks() {
        for group in 0..PhotonFlags::MOST_GROUPS {
            let flags = PhotonFlags::of_group(group);
            assert_eq!(flags.group().map(u32::from), Some(group));
            assert!(!flags.contains(PhotonFlags::CAUSTIC));
            assert_eq!(flags.with(PhotonFlags::CAUSTIC).group(), flags.group());
        }
        assert_eq!(PhotonFlags::of_group(PhotonFlags::MOST_GROUPS).group(), None);
        assert_eq!(PhotonFlags::CAUSTIC.group(), None);
    }

    #[test]
    fn what_is_not_finite_is_not_sound() {
        let good = photon(Vec3::Z, Lanes::ONE);
        assert!(good.is_sound());
        assert!(!Photon { position: Vec3::new(f32::NAN, 0.0, 0.0), ..good }.is_sound());
        assert!(!Photon { position: Vec3::new(0.0, f32::INFINITY, 0.0), ..good }.is_sound());
        assert!(!Photon { power: Lanes::splat(f32::NAN), ..good }.is_sound());
        assert!(!Photon { normal: Vec3::ZERO, ..good }.is_sound());
        assert!(!Photon { direction: Vec3::NAN, ..good }.is_sound());
    }
}
