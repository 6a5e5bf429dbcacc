//! Numbers in text.

/// Splits off the next word at white space.
pub(crate) fn word<'a>(rest: &mut &'a [u8]) -> Option<&'a [u8]> {
    let start = rest.iter().position(|b| !b.is_ascii_whitespace())?;
    let tail = &rest[start..];
    let end = tail.iter().position(u8::is_ascii_whitespace).unwrap_or(tail.len());
    let (word, tail) = tail.split_at(end);
    *rest = tail;
    Some(word)
}

/// The number that a word spells, rounded to nearest; infinities and NaNs are let through to be reported by index.
pub(crate) fn float(word: &[u8]) -> Option<f32> {
    short_decimal(word).or_else(|| std::str::from_utf8(word).ok()?.parse().ok())
}

/// Numbers of at most 7 digits after the leading zeros and at most 10 decimals, in the form `-12.345`: both the digits
/// and the power of ten are exact in `f32`, hence the quotient is rounded correctly (Clinger 1990).
fn short_decimal(word: &[u8]) -> Option<f32> {
    const POWERS: [f32; 11] = [1.0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10];
    let (negative, digits) = match word {
        [b'-', digits @ ..] => (true, digits),
        digits => (false, digits),
    };
    let mut value = 0u32;
    let mut point = None;
    for (i, &b) in digits.iter().enumerate() {
        match b {
            b'0'..=b'9' if value < 1_677_720 => value = 10 * value + u32::from(b - b'0'),
            b'.' if point.is_none() => point = Some(i),
            _ => return None,
        }
    }
    let decimals = point.map_or(0, |i| digits.len() - i - 1);
    if digits.len() - usize::from(point.is_some()) == 0 {
        return None;
    }
    let magnitude = value as f32 / POWERS.get(decimals)?;
    Some(if negative { -magnitude } else { magnitude })
}

/// The integer that a word spells.
pub(crate) fn integer(word: &[u8]) -> Option<i64> {
    let (negative, digits) = match word {
        [b'-', digits @ ..] => (true, digits),
        [b'+', digits @ ..] => (false, digits),
        digits => (false, digits),
    };
    if digits.is_empty() || digits.len() > 18 {
        return None;
    }
    let mut value = 0i64;
    for &b in digits {
        if !b.is_ascii_digit() {
            return None;
        }
        value = 10 * value + i64::from(b - b'0');
    }
    Some(if negative { -value } else { value })
}

/// A word as it may be shown in a message.
pub(crate) fn shown(word: &[u8]) -> String {
    String::from_utf8_lossy(&word[..word.len().min(40)]).escape_debug().to_string()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn numbers_in_every_spelling() {
        for (text, value) in [
            ("1", 1.0),
            ("-2.5", -2.5),
            ("+3", 3.0),
            (".5", 0.5),
            ("5.", 5.0),
            ("1e-3", 1e-3),
            ("-1.5E+2", -150.0),
        ] {
            assert_eq!(float(text.as_bytes()), Some(value), "{text}");
        }
        for text in ["", "-", ".", "1,5", "0x10", "1.2.3", "--1", "1e"] {
            assert_eq!(float(text.as_bytes()), None, "{text}");
        }
        assert_eq!(integer(b"-12"), Some(-12));
        for text in ["", "-", "1.0", "12345678901234567890"] {
            assert_eq!(integer(text.as_bytes()), None, "{text}");
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig {
            rng_seed: proptest::test_runner::RngSeed::Fixed(7),
            failure_persistence: None,
            ..ProptestConfig::default()
        })]

        #[test]
        fn floats_are_rounded_as_the_standard_library_does(digits in 0u64..100_000_000, decimals in 0usize..12) {
            let digits = format!("{digits:0width$}", width = decimals + 1);
            let (whole, fraction) = digits.split_at(digits.len() - decimals);
            let text = format!("-{whole}.{fraction}");
            prop_assert_eq!(float(text.as_bytes()).unwrap().to_bits(), text.parse::<f32>().unwrap().to_bits());
        }

        #[test]
        fn floats_round_trip(bits: u32) {
            let value = f32::from_bits(bits);
            prop_assume!(value.is_finite());
            prop_assert_eq!(float(format!("{value}").as_bytes()), Some(value));
            prop_assert_eq!(float(format!("{value:e}").as_bytes()), Some(value));
        }
    }
}
