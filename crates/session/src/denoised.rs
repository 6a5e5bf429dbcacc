use denoise::{DenoiseError, Denoiser, Images};
use develop::Planes;

/// What a denoiser made of a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Denoised {
    pixels: Vec<[f32; 3]>,
    by: String,
}

impl Denoised {
    /// Takes the noise out of the beauty; albedo and normals, where they are known, tell it where edges are.
    ///
    /// # Errors
    /// Where the picture is empty or the library fails.
    pub fn new(planes: &Planes, denoiser: &Denoiser) -> Result<Self, DenoiseError> {
        let images = Images {
            size: [planes.width, planes.height],
            beauty: &planes.beauty,
            albedo: &planes.albedo,
            normal: &planes.normal,
        };
        Ok(Self { pixels: denoiser.denoise(&images)?, by: denoiser.to_string() })
    }

    /// Linear radiance, row by row.
    pub fn pixels(&self) -> &[[f32; 3]] {
        &self.pixels
    }

    /// The same, given away.
    pub fn into_pixels(self) -> Vec<[f32; 3]> {
        self.pixels
    }

    /// The library and its version.
    pub fn by(&self) -> &str {
        &self.by
    }

    /// What files say of it: name and value.
    pub fn metadata(&self) -> (String, String) {
        ("denoised".to_owned(), self.by.clone())
    }
}
