/// Which layer a path from the camera to a light belongs to. D is a surface that stores photons (by kind of
/// material), S one that does not (mirror, glass, metal of any roughness) or a delta lobe of a D surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PathClass {
    diffuse: u32,
    specular_since_diffuse: bool,
}

/// The layer of a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LightLayer {
    /// E S* L and E S* D L.
    Direct,
    /// E S* D S⁺ L.
    Caustic,
    /// All other paths.
    Indirect,
}

impl PathClass {
    /// After one more scattering event.
    #[must_use]
    pub fn scattered(self, specular: bool) -> Self {
        if specular {
            Self { specular_since_diffuse: true, ..self }
        } else {
            Self { diffuse: self.diffuse + 1, specular_since_diffuse: false }
        }
    }

    /// The layer if the path met a light now.
    pub fn layer(self) -> LightLayer {
        match (self.diffuse, self.specular_since_diffuse) {
            (0, _) | (1, false) => LightLayer::Direct,
            (1, true) => LightLayer::Caustic,
            _ => LightLayer::Indirect,
        }
    }

    /// Number of D events so far.
    pub fn diffuse_events(self) -> u32 {
        self.diffuse
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn layers() {
        let class =
            |events: &str| events.chars().fold(PathClass::default(), |c, e| c.scattered(e == 'S')).layer();
        for direct in ["", "S", "SS", "D", "SD"] {
            assert_eq!(class(direct), LightLayer::Direct, "{direct}");
        }
        for caustic in ["DS", "SDS", "SSDSS"] {
            assert_eq!(class(caustic), LightLayer::Caustic, "{caustic}");
        }
        for indirect in ["DD", "DSD", "DDS", "SDDSS"] {
            assert_eq!(class(indirect), LightLayer::Indirect, "{indirect}");
        }
    }
}
