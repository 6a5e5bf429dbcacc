//! When a picture is looked at that is to be rendered until its grain is fine enough.

use std::time::Duration;

/// Passes below which their spread says too little.
const FEWEST: u64 = 8;

/// Whether the grain is looked at after so many passes: with each pass from 8 on, each second from 16 on, each fourth
/// from 32 on, and so on. A function of their number alone, so that a render ends with the same pass wherever it was
/// interrupted.
pub(crate) fn is_looked_at(passes: u64) -> bool {
    passes >= FEWEST && passes.is_multiple_of((1 << passes.ilog2()) / FEWEST)
}

/// The grain that is wanted, and what was found last.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Goal {
    /// Wanted, as of [`film::Film::grain`].
    pub wanted: f64,
    /// After so many passes, so much.
    pub found: Option<(u64, f64)>,
}

impl Goal {
    pub(crate) fn new(wanted: f64) -> Self {
        Self { wanted, found: None }
    }

    pub(crate) fn is_reached(&self) -> bool {
        self.found.is_some_and(|(_, grain)| grain <= self.wanted)
    }

    /// Passes after which it will be reached, as grain falls with their square root.
    pub(crate) fn passes(&self) -> Option<u64> {
        let (passes, grain) = self.found?;
        Some((passes as f64 * (grain / self.wanted).powi(2)).ceil() as u64)
    }

    /// Until then, after `done` passes of which each takes `pace(1)`.
    pub(crate) fn left(&self, done: u64, pace: impl FnOnce(u64) -> Duration) -> Option<Duration> {
        self.passes().map(|passes| pace(passes.saturating_sub(done)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn looks_come_with_each_eighth_of_the_passes() {
        let looks: Vec<u64> = (0..70).filter(|n| is_looked_at(*n)).collect();
        assert_eq!(looks[..12], [8, 9, 10, 11, 12, 13, 14, 15, 16, 18, 20, 22]);
        assert_eq!(looks[looks.len() - 3..], [56, 60, 64]);
        assert!(is_looked_at(1 << 22));
    }

    #[test]
    fn four_times_the_passes_halve_the_grain() {
        let mut goal = Goal::new(0.02);
        assert_eq!((goal.is_reached(), goal.passes()), (false, None));
        goal.found = Some((16, 0.04));
        assert_eq!((goal.is_reached(), goal.passes()), (false, Some(64)));
        assert_eq!(goal.left(24, Duration::from_secs), Some(Duration::from_secs(40)));
        goal.found = Some((80, 0.0199));
        assert!(goal.is_reached());
        assert_eq!(goal.left(80, Duration::from_secs), Some(Duration::ZERO));
    }
}
