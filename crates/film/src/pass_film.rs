use crate::fixed::MAX_VALUE;
use crate::{FilmError, Layer};

/// What the camera path of one pass gives for its pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelSample {
    /// [`Layer::Direct`], linear Rec. 709, before the filter's weight.
    pub direct: [f32; 3],
    /// [`Layer::Caustic`], likewise.
    pub caustic: [f32; 3],
    /// [`Layer::Indirect`], likewise.
    pub indirect: [f32; 3],
    /// [`Layer::Albedo`].
    pub albedo: [f32; 3],
    /// [`Layer::Normal`]; 0 where nothing was hit.
    pub normal: [f32; 3],
    /// [`Layer::Depth`]; 0 or +∞ where nothing was hit.
    pub depth: f32,
    /// [`Layer::PhotonDensity`].
    pub photon_density: f32,
    /// [`crate::FilterSample::weight`].
    pub weight: f32,
}

impl Default for PixelSample {
    /// Black, nothing hit, weight 1.
    fn default() -> Self {
        Self {
            direct: [0.0; 3],
            caustic: [0.0; 3],
            indirect: [0.0; 3],
            albedo: [0.0; 3],
            normal: [0.0; 3],
            depth: 0.0,
            photon_density: 0.0,
            weight: 1.0,
        }
    }
}

impl PixelSample {
    /// Radiance of all parts, before the weight.
    pub fn beauty(&self) -> [f32; 3] {
        std::array::from_fn(|i| self.direct[i] + self.caustic[i] + self.indirect[i])
    }

    /// Whether all values are such as a film holds, seen at a glance; else [`Self::clean`] decides.
    #[inline]
    fn is_ordinary(&self) -> bool {
        let colours = [self.direct, self.caustic, self.indirect, self.albedo, self.normal];
        let small = colours.as_flattened().iter().fold(true, |ok, v| ok & (v.abs() <= SMALL));
        small & (self.weight.abs() <= SMALL) & (self.depth >= 0.0) & holds(self.photon_density)
    }

    /// Sets to 0 every layer with a value that is no number a film can hold; the layers that were wrong.
    fn clean(&mut self) -> impl Iterator<Item = Layer> + use<> {
        let mut wrong = [None; 8];
        if !holds(self.weight) {
            // Without its weight the radiance is worth nothing.
            *self = Self { weight: 1.0, ..Self::default() };
            wrong[0] = Some(Layer::Beauty);
            return wrong.into_iter().flatten();
        }
        let limit = MAX_VALUE / self.weight.abs().max(1.0);
        let colours = [
            (Layer::Direct, &mut self.direct, limit),
            (Layer::Caustic, &mut self.caustic, limit),
            (Layer::Indirect, &mut self.indirect, limit),
            (Layer::Albedo, &mut self.albedo, SMALL),
            (Layer::Normal, &mut self.normal, SMALL),
        ];
        for (i, (layer, value, limit)) in colours.into_iter().enumerate() {
            if !value.iter().all(|v| v.abs() <= limit) {
                *value = [0.0; 3];
                wrong[i] = Some(layer);
            }
        }
        if self.depth.is_nan() || self.depth < 0.0 {
            self.depth = 0.0;
            wrong[5] = Some(Layer::Depth);
        }
        if !holds(self.photon_density) {
            self.photon_density = 0.0;
            wrong[6] = Some(Layer::PhotonDensity);
        }
        wrong.into_iter().flatten()
    }
}

/// Greatest component of an albedo or normal that a film holds.
pub(crate) const SMALL: f32 = 4.0;

/// Also refuses NaN.
fn holds(value: f32) -> bool {
    value.abs() <= MAX_VALUE
}

/// A value that was kept out of a pass: not finite, beyond ±8.6·10⁹ (radiance after its weight, photon density),
/// beyond ±4 (albedo, normal) or a negative depth.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct NonFinite {
    /// Index of the pixel: row · width + column; with seed and pass it is the key to replay the path.
    pub pixel: u32,
    /// The layer that was wrong and became 0 (beauty: the weight was, and all of them did).
    pub layer: Layer,
}

/// One pass's contribution: one sample a pixel, 72 bytes each, and 12 for each named layer.
#[derive(Clone, Debug, PartialEq)]
pub struct PassFilm {
    width: usize,
    height: usize,
    pixels: Vec<PixelSample>,
    nonfinite: Vec<NonFinite>,
    nonfinite_count: u64,
    layers: Vec<[f32; 3]>,
}

impl PassFilm {
    /// Length of the list that [`nonfinite`](Self::nonfinite) gives.
    pub const NONFINITE_LISTED: usize = 16;

    /// From the samples of all pixels, row by row from the top, left to right.
    ///
    /// # Errors
    /// [`FilmError::Size`] where there are not width × height samples, or more than 2³² − 1.
    pub fn new(width: usize, height: usize, mut pixels: Vec<PixelSample>) -> Result<Self, FilmError> {
        if width.checked_mul(height) != Some(pixels.len()) || u32::try_from(pixels.len()).is_err() {
            return Err(FilmError::Size { expected: [width, height], found: [pixels.len(), 1] });
        }
        let (mut nonfinite, mut nonfinite_count) = (Vec::new(), 0);
        for (i, pixel) in pixels.iter_mut().enumerate() {
            if pixel.is_ordinary() {
                continue;
            }
            for layer in pixel.clean() {
                nonfinite_count += 1;
                if nonfinite.len() < Self::NONFINITE_LISTED {
                    nonfinite.push(NonFinite { pixel: i as u32, layer });
                }
            }
        }
        Ok(Self { width, height, pixels, nonfinite, nonfinite_count, layers: Vec::new() })
    }

    /// Adds named layers: linear Rec. 709 before the filter's weight, layer by layer, each row by row. Values that a
    /// film cannot hold become 0 and count as kept out of beauty.
    ///
    /// # Errors
    /// [`FilmError::Size`] where there is no whole number of layers.
    pub fn with_layers(mut self, mut layers: Vec<[f32; 3]>) -> Result<Self, FilmError> {
        let pixels = self.pixels.len();
        if pixels == 0 || !layers.len().is_multiple_of(pixels) {
            return Err(FilmError::Size { expected: [self.width, self.height], found: [layers.len(), 1] });
        }
        let mut wrong = Vec::new();
        for (i, value) in layers.iter_mut().enumerate() {
            let limit = MAX_VALUE / self.pixels[i % pixels].weight.abs().max(1.0);
            if !value.iter().all(|v| v.abs() <= limit) {
                *value = [0.0; 3];
                wrong.push(NonFinite { pixel: (i % pixels) as u32, layer: Layer::Beauty });
            }
        }
        self.nonfinite_count += wrong.len() as u64;
        self.nonfinite.extend(wrong);
        self.nonfinite.sort();
        self.nonfinite.truncate(Self::NONFINITE_LISTED);
        self.layers = layers;
        Ok(self)
    }

    /// Values of the named layers, layer by layer, each row by row; empty without.
    pub fn layers(&self) -> &[[f32; 3]] {
        &self.layers
    }

    /// Pixels a row.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> usize {
        self.height
    }

    /// The samples, row by row, cleaned of values that were not finite.
    pub fn pixels(&self) -> &[PixelSample] {
        &self.pixels
    }

    /// The first values that were kept out, in pixel order.
    pub fn nonfinite(&self) -> &[NonFinite] {
        &self.nonfinite
    }

    /// How many values were kept out.
    pub fn nonfinite_count(&self) -> u64 {
        self.nonfinite_count
    }
}
