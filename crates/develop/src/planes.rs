use film::{ExrChannels, Film, Layer};

/// What of a picture is developed, row by row from the top.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Planes {
    /// Pixels a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Radiance, linear Rec. 709.
    pub beauty: Vec<[f32; 3]>,
    /// Reflectance of what is seen; empty where it is not known.
    pub albedo: Vec<[f32; 3]>,
    /// Unit normals of what is seen, in the world; empty where they are not known.
    pub normal: Vec<[f32; 3]>,
    /// Distance of what is seen, +∞ where nothing is; empty where it is not known.
    pub depth: Vec<f32>,
    /// Radiance of each group of lights by its name; together they are the beauty. Empty where it was not kept apart.
    pub groups: Vec<(String, Vec<[f32; 3]>)>,
    /// The beauty without its noise, which is shown in its stead; empty where no denoiser saw it.
    pub denoised: Vec<[f32; 3]>,
}

/// What the layers of groups of lights are called, before the group's name.
const GROUP: &str = "light-";

/// Why lights cannot be mixed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum MixError {
    /// The picture keeps no groups apart.
    NoGroups,
    /// No group has that name; the names that there are.
    Unknown(String, Vec<String>),
}

impl Planes {
    /// Of a film.
    pub fn of(film: &Film) -> Self {
        let triples = |layer| film.layer(layer).as_chunks::<3>().0.to_vec();
        Self {
            width: film.width(),
            height: film.height(),
            beauty: film.beauty(),
            albedo: triples(Layer::Albedo),
            normal: triples(Layer::Normal),
            depth: film.layer(Layer::Depth),
            groups: film
                .layer_names()
                .iter()
                .enumerate()
                .filter_map(|(i, name)| Some((name.strip_prefix(GROUP)?.to_owned(), film.named_layer(i)?)))
                .collect(),
            denoised: Vec::new(),
        }
    }

    /// Of an EXR file of any program: its root layer, else the first in alphabetical order with R, G and B. `None` where
    /// there is none.
    pub fn of_exr(exr: &ExrChannels) -> Option<Self> {
        let layers = exr.colour_layers();
        let beauty = exr.colours("").or_else(|| exr.colours(layers.first()?))?;
        let group = |layer: &String| Some((layer.strip_prefix(GROUP)?.to_owned(), exr.colours(layer)?));
        Some(Self {
            width: exr.width(),
            height: exr.height(),
            beauty,
            albedo: exr.colours("albedo").unwrap_or_default(),
            normal: exr.vectors("normal").unwrap_or_default(),
            depth: exr.channel("depth.Z").map(<[f32]>::to_vec).unwrap_or_default(),
            groups: layers.iter().filter_map(group).collect(),
            denoised: exr.colours("denoised").unwrap_or_default(),
        })
    }

    /// Multiplies the light of some groups, channel by channel: beauty becomes Σ factor · group, where groups that are
    /// not named have the factor 1. What a denoiser made of the picture is no longer of it, and goes.
    ///
    /// # Errors
    /// Where a group is not there; nothing is changed then.
    pub fn mix(&mut self, factors: &[(String, [f32; 3])]) -> Result<(), MixError> {
        if factors.is_empty() {
            return Ok(());
        }
        if self.groups.is_empty() {
            return Err(MixError::NoGroups);
        }
        let known = || self.groups.iter().map(|(name, _)| name.clone()).collect();
        if let Some((name, _)) = factors.iter().find(|(name, _)| self.groups.iter().all(|(g, _)| g != name)) {
            return Err(MixError::Unknown(name.clone(), known()));
        }
        for (name, pixels) in &mut self.groups {
            for (_, factor) in factors.iter().filter(|(group, _)| group == name) {
                for pixel in pixels.iter_mut() {
                    *pixel = std::array::from_fn(|c| pixel[c] * factor[c]);
                }
            }
        }
        self.denoised.clear();
        for (i, pixel) in self.beauty.iter_mut().enumerate() {
            let sum = |c: usize| self.groups.iter().map(|(_, pixels)| f64::from(pixels[i][c])).sum::<f64>();
            *pixel = std::array::from_fn(|c| sum(c) as f32);
        }
        Ok(())
    }

    /// The channels of an EXR file that keeps all of this.
    pub fn channels(&self) -> Vec<(String, Vec<f32>)> {
        let mut out = Vec::new();
        let mut colours = |layer: &str, pixels: &[[f32; 3]]| {
            for (c, letter) in ["R", "G", "B"].iter().enumerate() {
                let name = if layer.is_empty() { (*letter).to_owned() } else { format!("{layer}.{letter}") };
                out.push((name, pixels.iter().map(|p| p[c]).collect()));
            }
        };
        colours("", &self.beauty);
        if !self.albedo.is_empty() {
            colours("albedo", &self.albedo);
        }
        if !self.denoised.is_empty() {
            colours("denoised", &self.denoised);
        }
        for (name, pixels) in &self.groups {
            colours(&format!("{GROUP}{name}"), pixels);
        }
        for (c, letter) in ["X", "Y", "Z"].iter().enumerate().take(3 * self.normal.len().min(1)) {
            out.push((format!("normal.{letter}"), self.normal.iter().map(|n| n[c]).collect()));
        }
        if !self.depth.is_empty() {
            out.push(("depth.Z".into(), self.depth.clone()));
        }
        out
    }

    /// The radiance that is shown: denoised, where it is.
    pub fn shown(&self) -> &[[f32; 3]] {
        if self.denoised.is_empty() { &self.beauty } else { &self.denoised }
    }

    /// Whether something is seen at a pixel. Where the depth is not known, what is not black is taken for something.
    fn is_something(&self, pixel: usize) -> bool {
        match self.depth.get(pixel) {
            Some(depth) => depth.is_finite(),
            None => self.beauty[pixel].iter().any(|v| *v > 0.0),
        }
    }

    /// Means over cells of some pixels, by which grain and single bright pixels lose their weight: at most 64 along the
    /// longer side. Pixels of nothing count only where less than a fiftieth of the picture is something: then what
    /// shines there is the picture (a sky).
    pub(crate) fn cells(&self) -> Vec<Cell> {
        let count = self.beauty.len();
        let something = (0..count).filter(|i| self.is_something(*i)).count();
        let sky = something * 50 < count;
        let side = self.width.max(self.height).div_ceil(64).max(1);
        let across = self.width.div_ceil(side);
        let mut cells = vec![Cell::default(); across * self.height.div_ceil(side)];
        for (i, rgb) in self.beauty.iter().enumerate() {
            let finite = rgb.iter().all(|v| v.is_finite());
            let counts = if sky { rgb.iter().any(|v| *v > 0.0) } else { self.is_something(i) };
            if !finite || !counts {
                continue;
            }
            let cell = &mut cells[i / self.width / side * across + i % self.width / side];
            cell.pixels += 1;
            for c in 0..3 {
                cell.radiance[c] += f64::from(rgb[c].max(0.0));
                cell.albedo[c] += self.albedo.get(i).map_or(0.0, |a| f64::from(a[c].clamp(0.0, 1.0)));
            }
        }
        cells.retain(|cell| cell.pixels > 0);
        for cell in &mut cells {
            let n = f64::from(cell.pixels);
            cell.radiance = cell.radiance.map(|v| v / n);
            cell.albedo = cell.albedo.map(|v| v / n);
        }
        cells
    }
}

/// Means over neighbouring pixels.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Cell {
    pub(crate) pixels: u32,
    pub(crate) radiance: [f64; 3],
    /// 0 where it is not known.
    pub(crate) albedo: [f64; 3],
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lit() -> Planes {
        let group = |name: &str, value: f32| (name.to_owned(), vec![[value, 2.0 * value, 0.5]; 2]);
        let groups = vec![group("lamp", 1.0), group("sun", 4.0)];
        let beauty = vec![[5.0, 10.0, 1.0]; 2];
        Planes { width: 2, height: 1, beauty, groups, depth: vec![1.0, f32::INFINITY], ..Planes::default() }
    }

    #[test]
    fn lights_are_mixed() {
        let mut planes = lit();
        planes.mix(&[("sun".into(), [0.5, 0.25, 2.0])]).unwrap();
        assert_eq!(planes.beauty[1], [3.0, 4.0, 1.5]);
        let mut same = lit();
        same.mix(&[("sun".into(), [1.0; 3])]).unwrap();
        assert_eq!(same, lit());
        let unknown = same.mix(&[("moon".into(), [1.0; 3])]).unwrap_err();
        assert_eq!(unknown, MixError::Unknown("moon".into(), vec!["lamp".into(), "sun".into()]));
        same.groups.clear();
        assert_eq!(same.mix(&[("sun".into(), [1.0; 3])]), Err(MixError::NoGroups));
    }

    #[test]
    fn an_exr_file_keeps_all() {
        let planes = lit();
        let bytes = film::encode_exr_channels(2, 1, &planes.channels(), &[]).unwrap();
        assert_eq!(Planes::of_exr(&ExrChannels::decode(&bytes).unwrap()), Some(planes));
    }
}
