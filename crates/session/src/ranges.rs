//! Ranges of pass indices: ascending, disjoint, none empty.

use std::ops::Range;

/// What of `asked` is not in `present`.
pub(crate) fn missing(asked: &Range<u64>, present: &[Range<u64>]) -> Vec<Range<u64>> {
    let mut at = asked.start;
    let mut gaps = Vec::new();
    for range in present {
        gaps.push(at..range.start.min(asked.end));
        at = at.max(range.end);
    }
    gaps.push(at..asked.end);
    gaps.retain(|gap| gap.start < gap.end);
    gaps
}

/// The passes between the first and the last that are not there.
pub fn gaps(present: &[Range<u64>]) -> Vec<Range<u64>> {
    hull(present).map(|all| missing(&all, present)).unwrap_or_default()
}

/// From the first to the last.
pub(crate) fn hull(ranges: &[Range<u64>]) -> Option<Range<u64>> {
    Some(ranges.first()?.start..ranges.last()?.end)
}

/// What is in both.
pub(crate) fn common(a: &[Range<u64>], b: &[Range<u64>]) -> Vec<Range<u64>> {
    let pairs = a.iter().flat_map(|a| b.iter().map(move |b| a.start.max(b.start)..a.end.min(b.end)));
    pairs.filter(|both| both.start < both.end).collect()
}

/// How many.
pub(crate) fn count(ranges: &[Range<u64>]) -> u64 {
    ranges.iter().map(|r| r.end - r.start).sum()
}

/// The range from `start` of which so many are missing.
pub(crate) fn with_more(start: u64, present: &[Range<u64>], more: u64) -> Range<u64> {
    let (mut at, mut more) = (start, more);
    for range in present.iter().filter(|r| r.end > start) {
        let gap = range.start.saturating_sub(at);
        if gap >= more {
            break;
        }
        more -= gap;
        at = range.end;
    }
    start..at.saturating_add(more)
}

/// In words: "passes 0..4 and 9..12", each without its end; a single one as "pass 7".
pub fn said(ranges: &[Range<u64>]) -> String {
    match ranges {
        [] => "no pass".to_owned(),
        [one] if one.end - one.start == 1 => format!("pass {}", one.start),
        _ => {
            let all: Vec<String> = ranges.iter().map(|r| format!("{}..{}", r.start, r.end)).collect();
            match all.split_last() {
                Some((last, rest)) if !rest.is_empty() => format!("passes {} and {last}", rest.join(", ")),
                _ => format!("passes {}", all.concat()),
            }
        }
    }
}

#[cfg(test)]
#[allow(clippy::single_range_in_vec_init)] // Lists of one range.
mod tests {
    use super::*;

    #[test]
    fn gaps_and_what_is_common() {
        assert_eq!(missing(&(0..10), &[]), [0..10]);
        assert_eq!(missing(&(0..10), &[2..4, 6..7]), [0..2, 4..6, 7..10]);
        assert_eq!(missing(&(3..10), &[0..5, 9..20]), [5..9]);
        assert_eq!(missing(&(0..4), &[0..4]), []);
        assert_eq!(missing(&(0..4), &[8..9]), [0..4]);
        assert_eq!(gaps(&[2..4, 6..7, 9..10]), [4..6, 7..9]);
        assert_eq!(gaps(&[]), []);
        assert_eq!(common(&[0..4, 8..12], &[3..9, 20..21]), [3..4, 8..9]);
        assert_eq!((hull(&[1..2, 5..6]), hull(&[])), (Some(1..6), None));
        assert_eq!(count(&[1..2, 5..8]), 4);
    }

    #[test]
    fn more_passes_fill_gaps_first() {
        assert_eq!(with_more(0, &[], 5), 0..5);
        assert_eq!(with_more(0, &[0..4], 5), 0..9);
        assert_eq!(with_more(64, &[64..70], 2), 64..72);
        assert_eq!(with_more(0, &[0..4, 6..8], 2), 0..6);
        assert_eq!(with_more(0, &[0..4, 6..8], 3), 0..9);
        assert_eq!(with_more(0, &[2..4], 0), 0..0);
    }

    #[test]
    fn words() {
        let all = [vec![], vec![7..8], vec![0..4], vec![0..4, 6..7], vec![0..1, 2..3, 5..9]];
        let expected =
            ["no pass", "pass 7", "passes 0..4", "passes 0..4 and 6..7", "passes 0..1, 2..3 and 5..9"];
        assert_eq!(all.map(|r| said(&r)), expected);
    }
}
