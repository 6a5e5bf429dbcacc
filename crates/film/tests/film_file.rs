//! Films as bytes come back whole, or not at all.
#![allow(clippy::unwrap_used)] // Helpers of tests are not seen as tests.

use nephroid_film::{
    Film, FilmError, PassFilm, PixelSample, SectionError, SectionReader, SectionWriter, encode_exr,
};
use proptest::prelude::*;

/// More pixels than one section holds.
const SIZE: [usize; 2] = [37, 41];

fn pass(index: u64, weights: [f32; 2], layers: usize) -> PassFilm {
    let [width, height] = SIZE;
    let value = |i: usize, k: u64| {
        let h = (index * 1_000_003 + i as u64 * 97 + k + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        (h >> 40) as f32 / (1u64 << 22) as f32
    };
    let sample = |i: usize| PixelSample {
        direct: [value(i, 0), value(i, 1), -value(i, 2)],
        caustic: [value(i, 3) * 1e6, 0.0, if i == 5 && index == 2 { f32::NAN } else { 0.0 }],
        indirect: [value(i, 4), value(i, 5) * 1e-9, 1.0],
        albedo: [0.25, 0.5, 0.75],
        normal: [value(i, 6), -value(i, 7), 0.0],
        depth: if i.is_multiple_of(7) { f32::INFINITY } else { value(i, 8) + 1.0 },
        photon_density: value(i, 9) * 1e8,
        weight: weights[(value(i, 10) < 2.0) as usize],
    };
    let pixels: Vec<_> = (0..width * height).map(sample).collect();
    let named = (0..layers * pixels.len()).map(|i| [value(i, 11), -value(i, 12), 0.5]).collect();
    PassFilm::new(width, height, pixels).unwrap().with_layers(named).unwrap()
}

fn film(passes: impl IntoIterator<Item = u64>, weights: [f32; 2], layers: usize) -> Film {
    let names = (0..layers).map(|i| format!("light-{i}")).collect();
    let mut film = Film::with_layers(SIZE[0], SIZE[1], names).unwrap();
    for index in passes {
        film.add(index, &pass(index, weights, layers)).unwrap();
    }
    film
}

fn bytes(film: &Film) -> Vec<u8> {
    let mut out = SectionWriter::new(Vec::new());
    film.write(&mut out).unwrap();
    out.finish().unwrap()
}

fn read(bytes: &[u8]) -> Result<Film, SectionError> {
    let mut input = SectionReader::new(bytes);
    let film = Film::read(&mut input)?;
    input.finish()?;
    Ok(film)
}

#[test]
fn every_film_comes_back() {
    for weights in [[1.0, 1.0], [1.3, -1.3]] {
        for layers in [0, 1, 3] {
            for passes in [vec![], vec![3], vec![0, 1, 2, 9, 10]] {
                let film = film(passes, weights, layers);
                let bytes = bytes(&film);
                assert_eq!(read(&bytes).unwrap(), film);
            }
        }
    }
    assert_eq!(read(&bytes(&Film::new(0, 0))).unwrap(), Film::new(0, 0));
}

#[test]
fn parts_that_were_stored_add_up_to_the_whole() {
    for weights in [[1.0, 1.0], [1.3, -1.3]] {
        let whole = film(0..6, weights, 2);
        let parts = [vec![5], vec![0, 3], vec![1, 2, 4]].map(|p| bytes(&film(p, weights, 2)));
        for order in [[0, 1, 2], [2, 0, 1], [1, 2, 0]] {
            let mut sum = read(&parts[order[0]]).unwrap();
            sum.merge(&read(&parts[order[1]]).unwrap()).unwrap();
            sum.merge(&read(&parts[order[2]]).unwrap()).unwrap();
            assert_eq!(sum, whole);
            assert!(encode_exr(&sum, &Default::default()) == encode_exr(&whole, &Default::default()));
        }
    }
}

#[test]
fn named_layers_are_means_and_in_the_exr() {
    let film = film(0..4, [1.0, 1.0], 2);
    let passes: Vec<_> = (0..4).map(|i| pass(i, [1.0, 1.0], 2)).collect();
    let count = SIZE[0] * SIZE[1];
    for layer in 0..2 {
        let found = film.named_layer(layer).unwrap();
        for i in [0, 7, count - 1] {
            for (c, found) in found[i].iter().enumerate() {
                let values = passes.iter().map(|p| f64::from(p.layers()[layer * count + i][c]));
                let mean = values.sum::<f64>() / 4.0;
                assert!((f64::from(*found) - mean).abs() < 1e-6, "{found} {mean}");
            }
        }
    }
    assert!(film.named_layer(2).is_none());
    let exr = encode_exr(&film, &Default::default()).unwrap();
    for name in ["light-0.R", "light-1.B", "noise.Y"] {
        assert!(exr.windows(name.len()).any(|w| w == name.as_bytes()), "{name}");
    }
}

#[test]
fn layers_that_do_not_fit_are_refused() {
    for name in ["", "a.b", "beauty", "a b", "é"] {
        assert!(matches!(Film::with_layers(1, 1, vec![name.into()]), Err(FilmError::LayerName(_))), "{name}");
    }
    assert!(Film::with_layers(1, 1, vec!["a".into(), "a".into()]).is_err());
    let mut two = film(0..1, [1.0, 1.0], 2);
    let before = two.clone();
    assert!(matches!(two.add(1, &pass(1, [1.0, 1.0], 1)), Err(FilmError::Layers { .. })));
    assert!(matches!(two.merge(&film(3..4, [1.0, 1.0], 3)), Err(FilmError::Layers { .. })));
    assert_eq!(two, before);
}

#[test]
fn noise_of_one_pass_is_unknown() {
    let one = film(0..1, [1.0, 1.0], 0);
    let exr = encode_exr(&one, &Default::default()).unwrap();
    assert!(!exr.windows(7).any(|w| w == b"noise.Y"));
    assert_eq!(one.grain(), None);
    let two = film(0..2, [1.0, 1.0], 0);
    assert!(two.grain().unwrap() > 0.0);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn one_flipped_bit_is_noticed(at in 0.0f64..1.0, bit in 0u8..8, weighted: bool) {
        let film = film(0..3, if weighted { [1.3, -1.3] } else { [1.0, 1.0] }, 1);
        let mut bytes = bytes(&film);
        let at = (at * bytes.len() as f64) as usize;
        bytes[at] ^= 1 << bit;
        prop_assert!(read(&bytes).is_err());
    }

    #[test]
    fn a_lost_end_is_noticed(at in 0.0f64..1.0) {
        let bytes = bytes(&film(0..2, [1.0, 1.0], 0));
        let at = (at * bytes.len() as f64) as usize;
        prop_assert!(matches!(read(&bytes[..at]), Err(SectionError::Truncated)));
    }

    #[test]
    fn nonsense_is_refused_in_peace(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        prop_assert!(read(&bytes).is_err());
    }
}

#[test]
fn more_after_the_end_is_noticed() {
    let mut bytes = bytes(&film(0..1, [1.0, 1.0], 0));
    bytes.push(0);
    assert!(matches!(read(&bytes), Err(SectionError::Damaged(_))));
}
