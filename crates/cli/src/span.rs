//! Spans of time as people type them.

use std::time::Duration;

/// Longest span: a year.
const MOST: f64 = 366.0 * 86_400.0;

/// 90, 90s, 5m, 1h30m, 1.5h: numbers with h, m, s, in this order, each once at most; a bare number is of seconds.
///
/// # Errors
/// What is wrong, for people. A span of no time is wrong.
pub fn parse(text: &str) -> Result<Duration, String> {
    let wrong = || "a time is as 90 or 90s (seconds), 5m, 1h30m".to_owned();
    let mut seconds = 0.0;
    let mut rest = text.trim();
    let mut units = [('h', 3600.0), ('m', 60.0), ('s', 1.0)].into_iter();
    if rest.is_empty() {
        return Err(wrong());
    }
    while !rest.is_empty() {
        let end = rest.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(rest.len());
        let number: f64 = rest[..end].parse().map_err(|_| wrong())?;
        let unit = rest[end..].chars().next();
        let (_, factor) = match unit {
            Some(letter) => units.find(|(u, _)| *u == letter).ok_or_else(wrong)?,
            // A bare number stands alone.
            None if end == text.trim().len() => ('s', 1.0),
            None => return Err(wrong()),
        };
        seconds += number * factor;
        rest = rest[end + unit.map_or(0, char::len_utf8)..].trim_start();
    }
    match Duration::try_from_secs_f64(seconds) {
        Ok(span) if span.is_zero() => Err("no time at all: it must be more than 0".to_owned()),
        Ok(span) if seconds <= MOST => Ok(span),
        _ => Err("a time is a year at most".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spans() {
        let texts = ["90", "90s", "5m", "1h30m", "1h 30m 5s", "1.5h", "0.25", "1h5s", " 2m "];
        let seconds = texts.map(|t| parse(t).unwrap().as_secs_f64());
        assert_eq!(seconds, [90.0, 90.0, 300.0, 5400.0, 5405.0, 5400.0, 0.25, 3605.0, 120.0]);
    }

    #[test]
    fn what_is_no_span() {
        for wrong in
            ["", "m", "5x", "-5", "5m3h", "5m5m", "1h30", "1.2.3", "inf", "nan", "1e3", "5 5", "99999h"]
        {
            assert!(parse(wrong).is_err(), "{wrong}");
        }
        for zero in ["0", "0s", "0h0m", "0.0"] {
            assert!(parse(zero).unwrap_err().contains("more than 0"), "{zero}");
        }
    }
}
