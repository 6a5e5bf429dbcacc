use super::*;
use crate::PixelSample;

/// Samples that differ by pass and pixel; sign and size of the weight by pass.
fn pass(index: u64, weights: [f32; 2]) -> PassFilm {
    let pixels = (0..12u64)
        .map(|i| {
            let h = (index * 12 + i + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
            let value = |k: u32| ((h >> (5 * k)) & 0x3ff) as f32 * 0.013 + 1e-4;
            PixelSample {
                direct: [value(0), value(1), value(2)],
                caustic: [value(3) * 100.0, 0.0, value(4)],
                indirect: [value(5), value(6), value(7) * 1e-5],
                albedo: [0.1, 0.2, value(1) * 0.05],
                normal: [0.0, -1.0, value(2) * 0.01],
                depth: if i == 3 { f32::INFINITY } else { value(8) + 1.0 },
                photon_density: value(2) * 1e4,
                weight: weights[(h >> 60) as usize & 1],
            }
        })
        .collect();
    PassFilm::new(4, 3, pixels).unwrap()
}

fn film(order: impl IntoIterator<Item = u64>, weights: [f32; 2]) -> Film {
    let mut film = Film::new(4, 3);
    for i in order {
        film.add(i, &pass(i, weights)).unwrap();
    }
    film
}

#[test]
fn any_order_and_any_split_give_the_same_film() {
    for weights in [[1.0, 1.0], [1.3, -1.3]] {
        let straight = film(0..20, weights);
        assert_eq!(straight, film((0..20).rev(), weights));
        let mut merged = film([7, 3, 19], weights);
        merged.merge(&film((0..20).filter(|i| ![7, 3, 19].contains(i)), weights)).unwrap();
        assert_eq!(straight, merged);
        assert!(matches!(merged.pass_ranges(), [Range { start: 0, end: 20 }]));
        assert_ne!(straight, film(0..19, weights));
    }
    // Passes without and with signed weights, merged both ways.
    let (plain, signed) = (film(0..4, [1.0, 1.0]), film(4..6, [1.3, -1.3]));
    let (mut a, mut b) = (plain.clone(), signed.clone());
    a.merge(&signed).unwrap();
    b.merge(&plain).unwrap();
    assert_eq!(a, b);
    assert_eq!(a.passes(), 6);
}

#[test]
fn layers_are_means_and_depth_the_least() {
    let film = film(0..7, [1.0, 1.0]);
    let passes: Vec<_> = (0..7).map(|i| pass(i, [1.0, 1.0])).collect();
    let beauty = film.layer(Layer::Beauty);
    assert_eq!(beauty, film.beauty().concat());
    for pixel in 0..12 {
        let samples: Vec<_> = passes.iter().map(|p| p.pixels()[pixel]).collect();
        let mean =
            |f: &dyn Fn(&PixelSample) -> f32| samples.iter().map(|s| f64::from(f(s))).sum::<f64>() / 7.0;
        for c in 0..3 {
            let expect = |value: f32, f: &dyn Fn(&PixelSample) -> f32| {
                let m = mean(f);
                assert!((f64::from(value) - m).abs() <= 1e-6 * m.abs() + 1e-11, "{value} {m}");
            };
            let at = |layer| film.layer(layer)[pixel * 3 + c];
            expect(beauty[pixel * 3 + c], &|s| s.beauty()[c]);
            expect(at(Layer::Direct), &|s| s.direct[c]);
            expect(at(Layer::Caustic), &|s| s.caustic[c]);
            expect(at(Layer::Indirect), &|s| s.indirect[c]);
            expect(at(Layer::Albedo), &|s| s.albedo[c]);
            expect(at(Layer::Normal), &|s| s.normal[c]);
        }
        let least = samples.iter().map(|s| s.depth).fold(f32::INFINITY, f32::min);
        assert_eq!(film.layer(Layer::Depth)[pixel], least);
    }
    assert_eq!(film.layer(Layer::Depth)[3], f32::INFINITY);
}

#[test]
fn signed_weights_leave_even_surfaces_even() {
    let mut film = Film::new(1, 1);
    let sample = |weight| PixelSample { indirect: [0.5, 2.0, 0.25], weight, ..PixelSample::default() };
    for (i, weight) in [-1.3, 1.3, 1.3, -1.3].into_iter().enumerate() {
        film.add(i as u64, &PassFilm::new(1, 1, vec![sample(weight)]).unwrap()).unwrap();
        for (v, e) in film.layer(Layer::Beauty).iter().zip([0.5, 2.0, 0.25]) {
            assert!((v - e).abs() < 1e-6);
        }
    }
    assert!(film.noise().unwrap()[0] < 1e-5);
}

#[test]
fn noise_is_the_standard_error() {
    for weights in [[1.0, 1.0], [1.3, -1.3]] {
        let film = film(0..9, weights);
        let noise = film.noise().unwrap();
        for (pixel, &noise) in noise.iter().enumerate() {
            let samples: Vec<_> = (0..9)
                .map(|i| pass(i, weights).pixels()[pixel])
                .map(|s| (f64::from(s.weight), color::luminance_f64(s.beauty().map(f64::from))))
                .collect();
            let average = samples.iter().map(|s| s.1).sum::<f64>() / 9.0;
            let e: Vec<f64> = samples.iter().map(|(w, l)| w * l - average * (w - 1.0)).collect();
            let mean = e.iter().sum::<f64>() / 9.0;
            let variance = e.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / 8.0;
            let expected = (variance / 9.0).sqrt();
            assert!((f64::from(noise) - expected).abs() < 1e-4 * expected, "{noise} {expected}");
        }
    }
    assert_eq!(film(0..1, [1.0, 1.0]).noise(), None);
}

#[test]
fn refusals_leave_the_film_unchanged() {
    let mut film = film(0..3, [1.0, 1.0]);
    let before = film.clone();
    assert_eq!(film.add(1, &pass(1, [1.0, 1.0])), Err(FilmError::DuplicatePass(1)));
    assert_eq!(film.merge(&before), Err(FilmError::DuplicatePass(0)));
    assert!(matches!(film.merge(&Film::new(3, 4)), Err(FilmError::Size { .. })));
    assert_eq!(film.add(u64::MAX, &pass(9, [1.0, 1.0])), Err(FilmError::TooManyPasses));
    assert_eq!(film, before);
}

#[test]
fn values_that_are_not_finite_stay_out_and_are_told() {
    let mut pixels = vec![PixelSample { direct: [1.0; 3], ..PixelSample::default() }; 12];
    pixels[2].direct[1] = f32::NAN;
    pixels[5].caustic[0] = f32::INFINITY;
    pixels[5].photon_density = f32::NAN;
    pixels[7].weight = f32::NAN;
    pixels[8].indirect[2] = 1e30;
    let pass = PassFilm::new(4, 3, pixels).unwrap();
    let found: Vec<_> = pass.nonfinite().iter().map(|n| (n.pixel, n.layer)).collect();
    assert_eq!(
        found,
        [
            (2, Layer::Direct),
            (5, Layer::Caustic),
            (5, Layer::PhotonDensity),
            (7, Layer::Beauty),
            (8, Layer::Indirect)
        ]
    );
    let mut film = Film::new(4, 3);
    film.add(3, &pass).unwrap();
    assert_eq!((film.nonfinite_count(), film.nonfinite()[0].pass), (5, 3));
    let beauty = film.beauty();
    assert!(beauty.iter().flatten().all(|v| v.is_finite()));
    assert_eq!((beauty[2], beauty[5], beauty[7], beauty[8]), ([0.0; 3], [1.0; 3], [0.0; 3], [1.0; 3]));
}

#[test]
fn memory_is_as_documented() {
    assert_eq!((size_of::<Sums>(), size_of::<Unweighted>()), (192, 120));
    assert_eq!(size_of::<PixelSample>(), 72);
}
