use scenefile::SceneDesc;
use scenefile::desc::IntegratorKind;

/// Settings of a scene that whoever renders it may replace; `None` keeps what the scene says.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Overrides {
    /// The algorithm.
    pub integrator: Option<IntegratorKind>,
    /// Width and height in pixels.
    pub size: Option<[u32; 2]>,
    /// Width in pixels; the height keeps the aspect. `size` wins over it.
    pub width: Option<u32>,
    /// Passes.
    pub passes: Option<u32>,
    /// Seed of every random number.
    pub seed: Option<u64>,
    /// Exposure of 8-bit pictures in EV.
    pub exposure: Option<f32>,
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
        if let Some(width) = self.width {
            let [w, h] = film.size.map(u64::from);
            let height = (u64::from(width) * h + w / 2).checked_div(w).unwrap_or(1);
            film.size = [width, u32::try_from(height.max(1)).unwrap_or(u32::MAX)];
        }
        film.size = self.size.unwrap_or(film.size);
        film.exposure = self.exposure.unwrap_or(film.exposure);
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
            exposure: Some(-1.5),
            max_depth: Some(2),
            noise: Some(0.02),
            ..Overrides::default()
        };
        overrides.apply(&mut desc);
        assert_eq!(desc.film.size, [101, 57], "101 · 360 / 640 = 56.8");
        assert_eq!(desc.film.exposure, -1.5);
        assert_eq!(desc.render.integrator, IntegratorKind::Path);
        assert_eq!((desc.render.passes, desc.render.seed, desc.render.max_depth), (3, 9, Some(2)));
        assert_eq!(desc.render.noise, Some(0.02));
        Overrides { size: Some([7, 5]), width: Some(100), ..Overrides::default() }.apply(&mut desc);
        assert_eq!(desc.film.size, [7, 5]);
    }

    #[test]
    fn a_thin_picture_keeps_a_row() {
        let mut desc = SceneDesc::default();
        desc.film.size = [1000, 1];
        Overrides { width: Some(10), ..Overrides::default() }.apply(&mut desc);
        assert_eq!(desc.film.size, [10, 1]);
    }
}
