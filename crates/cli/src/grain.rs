//! How grainy a picture is, in words.

use nephroid::Film;

/// Grain that nobody sees on a screen.
const CLEAN: f64 = 0.01;

/// Grain up to which each word holds.
const WORDS: &[(f64, &str)] = &[
    (0.005, "clean, also in print"),
    (CLEAN, "clean on a screen"),
    (0.02, "fine"),
    (0.05, "visible"),
    (0.15, "coarse"),
    (f64::INFINITY, "a first draft"),
];

/// A share in percent, with two figures: 0.42 %, 4.2 %, 42 %.
pub fn percent(share: f64) -> String {
    let percent = 100.0 * share;
    let digits = if percent < 0.995 { 2 } else { usize::from(percent < 9.95) };
    format!("{percent:.digits$} %")
}

/// The grain of a film, what it looks like, and how many passes make it clean; none below two passes.
pub fn line(film: &Film) -> Option<String> {
    film.grain().map(|grain| text(grain, film.passes()))
}

fn text(grain: f64, passes: u64) -> String {
    let word = WORDS.iter().find(|(most, _)| grain <= *most).map_or("", |(_, word)| word);
    let mut text = format!("grain {}: {word}", percent(grain));
    if grain > CLEAN {
        // It falls with the square root of the passes.
        let wanted = passes as f64 * (grain / CLEAN).powi(2);
        text += &format!("; clean ({}) after about {} passes", percent(CLEAN), rounded(wanted));
    }
    text
}

/// Two figures of a number ≥ 1.
fn rounded(number: f64) -> u64 {
    let unit = 10f64.powi((number.log10().floor() as i32 - 1).max(0));
    ((number / unit).round() * unit) as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grain_in_words() {
        let said = [(0.0, 9), (0.003, 500), (0.0099, 99), (0.0123, 128), (0.041, 32), (0.3, 2)];
        let said = said.map(|(grain, passes)| text(grain, passes));
        assert_eq!(
            said,
            [
                "grain 0.00 %: clean, also in print",
                "grain 0.30 %: clean, also in print",
                "grain 0.99 %: clean on a screen",
                "grain 1.2 %: fine; clean (1.0 %) after about 190 passes",
                "grain 4.1 %: visible; clean (1.0 %) after about 540 passes",
                "grain 30 %: a first draft; clean (1.0 %) after about 1800 passes",
            ]
        );
    }
}
