use color::{Exposure, ViewTransform, WhiteBalance};
use scenefile::SceneDesc;
use scenefile::desc::{Denoise, IntegratorKind};

/// A part of a picture: left, top, right, bottom; the last two are no more in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Crop {
    /// In pixels.
    Pixels([u32; 4]),
    /// As shares of width and height, from 0 to 1; pixels that are in it in part are in it.
    Shares([f64; 4]),
}

impl Crop {
    /// In pixels of a picture of this size; at least one, where it lies in the picture at all.
    fn of(self, [width, height]: [u32; 2]) -> [u32; 4] {
        match self {
            Self::Pixels(pixels) => pixels,
            Self::Shares([x0, y0, x1, y1]) => {
                // A share that was made of pixels gives them again.
                let low = |share: f64, n: u32| (share * f64::from(n) + 1e-6).floor() as u32;
                let high = |share: f64, n: u32| (share * f64::from(n) - 1e-6).ceil().max(0.0) as u32;
                [low(x0, width), low(y0, height), high(x1, width), high(y1, height)]
            }
        }
    }

    /// A part of a picture of this size, for another size.
    fn shares([x0, y0, x1, y1]: [u32; 4], size: [u32; 2]) -> Self {
        let [width, height] = size.map(f64::from);
        let share = |n: u32, of: f64| f64::from(n) / of;
        Self::Shares([share(x0, width), share(y0, height), share(x1, width), share(y1, height)])
    }
}

/// Settings of a scene that whoever renders it may replace; `None` keeps what the scene says.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Overrides {
    /// The algorithm.
    pub integrator: Option<IntegratorKind>,
    /// Width and height in pixels.
    pub size: Option<[u32; 2]>,
    /// The part that is rendered. Without, the scene's, which is the same part in another size.
    pub crop: Option<Crop>,
    /// Width in pixels; the height keeps the aspect. `size` wins over it.
    pub width: Option<u32>,
    /// Passes.
    pub passes: Option<u32>,
    /// Seed of every random number.
    pub seed: Option<u64>,
    /// Exposure of 8-bit pictures in EV.
    pub exposure: Option<Exposure>,
    /// White balance of 8-bit pictures.
    pub white_balance: Option<WhiteBalance>,
    /// View of 8-bit pictures.
    pub view: Option<ViewTransform>,
    /// Whether noise is taken out of pictures.
    pub denoise: Option<Denoise>,
    /// Scattering events on a path, at most.
    pub max_depth: Option<u32>,
    /// Grain below which no more passes are needed.
    pub noise: Option<f32>,
}

impl Overrides {
    /// Changes `desc` accordingly.
    pub fn apply(&self, desc: &mut SceneDesc) {
        let replace = |to: &mut u32, by: Option<u32>| *to = by.unwrap_or(*to);
        let film = &mut desc.film;
        let written = film.size;
        if let Some(width) = self.width {
            let [w, h] = film.size.map(u64::from);
            let height = (u64::from(width) * h + w / 2).checked_div(w).unwrap_or(1);
            film.size = [width, u32::try_from(height.max(1)).unwrap_or(u32::MAX)];
        }
        film.size = self.size.unwrap_or(film.size);
        let kept = film.crop.map(|crop| match film.size == written {
            true => Crop::Pixels(crop),
            false => Crop::shares(crop, written),
        });
        film.crop = self.crop.or(kept).map(|crop| crop.of(film.size));
        film.exposure = self.exposure.unwrap_or(film.exposure);
        film.white_balance = self.white_balance.unwrap_or(film.white_balance);
        film.view = self.view.unwrap_or(film.view);
        film.denoise = self.denoise.unwrap_or(film.denoise);
        let render = &mut desc.render;
        render.integrator = self.integrator.unwrap_or(render.integrator);
        render.seed = self.seed.unwrap_or(render.seed);
        replace(&mut render.passes, self.passes);
        render.max_depth = self.max_depth.or(render.max_depth);
        render.noise = self.noise.or(render.noise);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_changes_nothing() {
        let mut desc = SceneDesc::default();
        Overrides::default().apply(&mut desc);
        assert_eq!(desc, SceneDesc::default());
    }

    #[test]
    fn each_replaces_its_own() {
        let mut desc = SceneDesc::default();
        desc.film.size = [640, 360];
        let overrides = Overrides {
            integrator: Some(IntegratorKind::Path),
            width: Some(101),
            passes: Some(3),
            seed: Some(9),
            exposure: Some(Exposure::Ev(-1.5)),
            denoise: Some(Denoise::Require),
            max_depth: Some(2),
            noise: Some(0.02),
            ..Overrides::default()
        };
        overrides.apply(&mut desc);
        assert_eq!(desc.film.size, [101, 57], "101 · 360 / 640 = 56.8");
        assert_eq!((desc.film.exposure, desc.film.denoise), (Exposure::Ev(-1.5), Denoise::Require));
        assert_eq!(desc.render.integrator, IntegratorKind::Path);
        assert_eq!((desc.render.passes, desc.render.seed, desc.render.max_depth), (3, 9, Some(2)));
        assert_eq!(desc.render.noise, Some(0.02));
        Overrides { size: Some([7, 5]), width: Some(100), ..Overrides::default() }.apply(&mut desc);
        assert_eq!(desc.film.size, [7, 5]);
    }

    #[test]
    fn a_crop_is_the_same_part_in_every_size() {
        let mut desc = SceneDesc::default();
        desc.film.size = [640, 480];
        desc.film.crop = Some([320, 0, 480, 120]);
        Overrides { width: Some(160), ..Overrides::default() }.apply(&mut desc);
        assert_eq!(desc.film.crop, Some([80, 0, 120, 30]));
        let shares = Some(Crop::Shares([0.25, 0.0, 0.5, 1.0]));
        Overrides { size: Some([10, 7]), crop: shares, ..Overrides::default() }.apply(&mut desc);
        assert_eq!(desc.film.crop, Some([2, 0, 5, 7]), "pixels that are in it in part");
        Overrides { crop: Some(Crop::Pixels([1, 2, 3, 4])), ..Overrides::default() }.apply(&mut desc);
        assert_eq!(desc.film.crop, Some([1, 2, 3, 4]));
    }

    #[test]
    fn a_thin_picture_keeps_a_row() {
        let mut desc = SceneDesc::default();
        desc.film.size = [1000, 1];
        Overrides { width: Some(10), ..Overrides::default() }.apply(&mut desc);
        assert_eq!(desc.film.size, [10, 1]);
    }
}
