use film::{FilmError, Filter, FilterKind};
use integrators::{
    DirectLight, IntegratorKind, Kernel, LayerSettings, PhotonMapSettings, RadiusSettings, Settings,
    SppmSettings, StartRadius, VcmSettings, VcmTechniques,
};
use scenefile::desc::{self, SceneDesc};

/// What to compute, as the scene says.
///
/// # Errors
/// Where the pixel filter's radius is not positive and finite.
pub fn settings(desc: &SceneDesc) -> Result<Settings, FilmError> {
    let map = &desc.photon_map;
    Ok(Settings {
        kind: match desc.render.integrator {
            desc::IntegratorKind::Auto => IntegratorKind::Auto,
            desc::IntegratorKind::Path => IntegratorKind::Path,
            desc::IntegratorKind::PhotonMap => IntegratorKind::PhotonMap,
            desc::IntegratorKind::Sppm => IntegratorKind::Sppm,
            desc::IntegratorKind::Vcm => IntegratorKind::Vcm,
        },
        seed: desc.render.seed,
        max_depth: desc.render.max_depth.unwrap_or(u32::MAX),
        crop: desc.film.crop.map(|crop| {
            let [x0, y0, x1, y1] = crop.map(|n| n as usize);
            [x0..x1, y0..y1]
        }),
        filter: Filter::new(filter_kind(desc.film.filter), desc.film.filter_radius)?,
        layers: LayerSettings { techniques: desc.film.layers.techniques, lights: desc.film.layers.lights },
        photon_map: PhotonMapSettings {
            photons: map.photons,
            caustic_photons: map.caustic_photons,
            knn: map.knn,
            caustic_knn: map.caustic_knn,
            kernel: kernel(map.filter),
            caustic_kernel: kernel(map.caustic_filter),
            radius: map.radius,
            caustic_radius: map.caustic_radius,
            final_gather: map.final_gather,
            caustic_gain: map.caustic_gain,
        },
        sppm: SppmSettings {
            photons: desc.sppm.photons,
            radius: radius(desc.sppm.radius, desc.sppm.radius_pixels, desc.sppm.alpha),
            direct: match desc.sppm.direct {
                desc::DirectLight::Sampling => DirectLight::Sampling,
                desc::DirectLight::Photons => DirectLight::Photons,
            },
        },
        vcm: VcmSettings {
            techniques: match desc.vcm.techniques {
                desc::VcmTechniques::Vcm => VcmTechniques::Vcm,
                desc::VcmTechniques::Bdpt => VcmTechniques::Bdpt,
                desc::VcmTechniques::LightTracing => VcmTechniques::LightTracing,
                desc::VcmTechniques::Bpm => VcmTechniques::Bpm,
                desc::VcmTechniques::Ppm => VcmTechniques::Ppm,
            },
            light_paths: desc.vcm.light_paths,
            radius: radius(desc.vcm.radius, desc.vcm.radius_pixels, desc.vcm.alpha),
        },
    })
}

fn radius(world: Option<f32>, pixels: f32, alpha: f32) -> RadiusSettings {
    let start = world.map_or(StartRadius::Pixels(pixels), StartRadius::World);
    RadiusSettings { start, alpha }
}

fn filter_kind(kind: desc::FilterKind) -> FilterKind {
    match kind {
        desc::FilterKind::Box => FilterKind::Box,
        desc::FilterKind::Triangle => FilterKind::Triangle,
        desc::FilterKind::Gaussian => FilterKind::Gaussian,
        desc::FilterKind::Mitchell => FilterKind::Mitchell,
        desc::FilterKind::BlackmanHarris => FilterKind::BlackmanHarris,
    }
}

fn kernel(filter: desc::PhotonFilter) -> Kernel {
    match filter {
        desc::PhotonFilter::Constant => Kernel::Constant,
        desc::PhotonFilter::Cone => Kernel::Cone,
        desc::PhotonFilter::Epanechnikov => Kernel::Epanechnikov,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_setting_arrives() {
        let mut desc = SceneDesc::default();
        desc.render.integrator = desc::IntegratorKind::Path;
        desc.render.seed = 7;
        desc.film.filter = desc::FilterKind::Gaussian;
        desc.film.filter_radius = Some(1.25);
        desc.photon_map = desc::PhotonMap {
            photons: 1,
            caustic_photons: 2,
            knn: 3,
            caustic_knn: 4,
            filter: desc::PhotonFilter::Cone,
            caustic_filter: desc::PhotonFilter::Constant,
            radius: Some(5.0),
            caustic_radius: Some(6.0),
            final_gather: 7,
            caustic_gain: 8.0,
        };
        let settings = settings(&desc).unwrap();
        assert_eq!(settings.kind, IntegratorKind::Path);
        assert_eq!((settings.seed, settings.max_depth), (7, u32::MAX));
        assert_eq!((settings.filter.kind(), settings.filter.radius()), (FilterKind::Gaussian, 1.25));
        let expected = PhotonMapSettings {
            photons: 1,
            caustic_photons: 2,
            knn: 3,
            caustic_knn: 4,
            kernel: Kernel::Cone,
            caustic_kernel: Kernel::Constant,
            radius: Some(5.0),
            caustic_radius: Some(6.0),
            final_gather: 7,
            caustic_gain: 8.0,
        };
        assert_eq!(settings.photon_map, expected);
    }

    #[test]
    fn progressive_settings_arrive() {
        let mut desc = SceneDesc::default();
        let pixels = |desc: &SceneDesc| settings(desc).unwrap();
        let alpha = 2.0 / 3.0;
        let radius = RadiusSettings { start: StartRadius::Pixels(4.0), alpha };
        let expected = SppmSettings { photons: None, radius, direct: DirectLight::Sampling };
        assert_eq!(pixels(&desc).sppm, expected);
        desc.sppm = desc::Sppm {
            photons: Some(1),
            radius: Some(2.0),
            radius_pixels: 3.0,
            alpha: 0.5,
            direct: desc::DirectLight::Photons,
        };
        desc.vcm = desc::Vcm {
            techniques: desc::VcmTechniques::Bpm,
            light_paths: Some(4),
            radius: None,
            radius_pixels: 5.0,
            alpha: 0.75,
        };
        let radius = RadiusSettings { start: StartRadius::World(2.0), alpha: 0.5 };
        let expected = SppmSettings { photons: Some(1), radius, direct: DirectLight::Photons };
        assert_eq!(pixels(&desc).sppm, expected);
        let radius = RadiusSettings { start: StartRadius::Pixels(5.0), alpha: 0.75 };
        let expected = VcmSettings { techniques: VcmTechniques::Bpm, light_paths: Some(4), radius };
        assert_eq!(pixels(&desc).vcm, expected);
    }

    #[test]
    fn the_depth_is_kept() {
        let mut desc = SceneDesc::default();
        desc.render.max_depth = Some(3);
        assert_eq!(settings(&desc).unwrap().max_depth, 3);
    }

    #[test]
    fn a_filter_without_extent_is_refused() {
        let mut desc = SceneDesc::default();
        desc.film.filter_radius = Some(0.0);
        assert!(settings(&desc).is_err());
    }
}
