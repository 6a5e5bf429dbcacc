use std::time::Duration;

/// What passes and maps took so far in a run, hence what the rest will take.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Pace {
    passes: Spent,
    maps: Spent,
}

#[derive(Clone, Copy, Debug, Default)]
struct Spent {
    time: Duration,
    count: u32,
}

impl Spent {
    fn add(&mut self, time: Duration) {
        self.time += time;
        self.count += 1;
    }

    fn mean(&self) -> Duration {
        self.time.checked_div(self.count).unwrap_or_default()
    }
}

impl Pace {
    pub(crate) fn add_pass(&mut self, time: Duration) {
        self.passes.add(time);
    }

    pub(crate) fn add_maps(&mut self, time: Duration) {
        self.maps.add(time);
    }

    /// Wall-clock time that so many passes and maps will take, as those so far on average.
    pub(crate) fn of(&self, passes: u64, maps: u64) -> Duration {
        let seconds = |mean: Duration, count: u64| mean.as_secs_f64() * count as f64;
        let all = seconds(self.passes.mean(), passes) + seconds(self.maps.mean(), maps);
        Duration::try_from_secs_f64(all).unwrap_or(Duration::MAX)
    }
}

/// Wall-clock time until a render ends, by each of its limits; `None` where it has no such limit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Remaining {
    /// Until the last pass, as those so far took.
    pub passes: Option<Duration>,
    /// Until the time is up.
    pub time: Option<Duration>,
    /// Until the grain is as fine as was asked for; `None` also before it was looked at first.
    pub grain: Option<Duration>,
}

impl Remaining {
    /// What comes first; `None` where nothing but the observer ends the render.
    pub fn first(&self) -> Option<Duration> {
        self.passes.into_iter().chain(self.time).chain(self.grain).min()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn maps_count_where_they_are_made_again() {
        let s = Duration::from_secs;
        let mut pace = Pace::default();
        assert_eq!(pace.of(10, 10), Duration::ZERO, "nothing is known yet");
        pace.add_maps(s(6));
        pace.add_pass(s(1));
        pace.add_pass(s(3));
        assert_eq!(pace.of(5, 0), s(10));
        assert_eq!(pace.of(5, 5), s(40));
        assert_eq!(pace.of(u64::MAX, u64::MAX), Duration::MAX);
    }

    #[test]
    fn the_first_limit_counts() {
        let s = Duration::from_secs;
        let first = |passes, time| Remaining { passes, time, grain: Some(s(9)) }.first();
        assert_eq!(Remaining::default().first(), None);
        assert_eq!(first(None, None), Some(s(9)));
        assert_eq!(first(Some(s(3)), None), Some(s(3)));
        assert_eq!(first(Some(s(3)), Some(s(2))), Some(s(2)));
    }
}
