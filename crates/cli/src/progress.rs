//! How a render tells of itself: a bar on a terminal, now and then a line in a pipe, or nothing.

use std::io::IsTerminal;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use nephroid::Remaining;

use crate::say::say;

/// Longest silence in a pipe while passes come.
const SILENCE: Duration = Duration::from_secs(10);

/// Where progress goes; always standard error.
#[derive(Clone, Debug)]
pub enum Progress {
    /// A bar that redraws itself.
    Bar(ProgressBar),
    /// Lines.
    Lines {
        /// When the last one was printed.
        last: Instant,
        /// Tenths of the render that were told.
        tenths: u64,
    },
    /// Nothing.
    Quiet,
}

/// How far a render is.
#[derive(Clone, Copy, Debug)]
pub struct Position {
    /// Passes that are done.
    pub done: u64,
    /// Passes that there will be.
    pub passes: Option<u64>,
    /// Since it began.
    pub elapsed: Duration,
    /// Until it ends.
    pub remaining: Remaining,
}

impl Progress {
    /// What suits standard error.
    pub fn new(quiet: bool) -> Self {
        if quiet {
            return Self::Quiet;
        }
        if !std::io::stderr().is_terminal() {
            return Self::Lines { last: Instant::now(), tenths: 0 };
        }
        let bar = ProgressBar::with_draw_target(Some(1000), ProgressDrawTarget::stderr());
        if let Ok(style) = ProgressStyle::with_template("{msg:18} {wide_bar} {prefix}") {
            bar.set_style(style);
        }
        bar.enable_steady_tick(Duration::from_millis(500));
        Self::Bar(bar)
    }

    /// A line that stays.
    pub fn line(&self, text: &str) {
        match self {
            Self::Bar(bar) => bar.suspend(|| say(text)),
            Self::Lines { .. } => say(text),
            Self::Quiet => {}
        }
    }

    /// What is being done now.
    pub fn doing(&self, what: &'static str) {
        if let Self::Bar(bar) = self {
            bar.set_message(what);
        }
    }

    /// A pass is done.
    pub fn pass(&mut self, at: &Position) {
        match self {
            Self::Bar(bar) => {
                let of = at.passes.map_or(String::new(), |passes| format!("/{passes}"));
                bar.set_prefix(format!("{}{of} passes, {}", at.done, left(at.remaining)));
                bar.set_position((at.share() * 1000.0) as u64);
            }
            Self::Lines { last, tenths } => {
                let now = (at.share() * 10.0 + 1e-9) as u64;
                if now > *tenths || last.elapsed() >= SILENCE {
                    *tenths = now;
                    *last = Instant::now();
                    say(&pass_line(at));
                }
            }
            Self::Quiet => {}
        }
    }

    /// Takes the bar away.
    pub fn finish(&self) {
        if let Self::Bar(bar) = self {
            bar.finish_and_clear();
        }
    }
}

impl Position {
    /// How much of the render is done, from 0 to 1, by the limit that is nearest.
    fn share(&self) -> f64 {
        let passes = self.passes.map_or(0.0, |passes| self.done as f64 / passes.max(1) as f64);
        let elapsed = self.elapsed.as_secs_f64();
        let time = self.remaining.time.map_or(0.0, |left| elapsed / (elapsed + left.as_secs_f64()).max(1e-9));
        passes.max(time).min(1.0)
    }
}

fn pass_line(at: &Position) -> String {
    let mut line = format!("pass {}", at.done);
    if let Some(passes) = at.passes {
        line += &format!("/{passes} ({} %)", at.done * 100 / passes.max(1));
    }
    line += &format!(", {} elapsed", duration(at.elapsed));
    if at.passes != Some(at.done) && at.remaining.first().is_some() {
        line += &format!(", {}", left(at.remaining));
    }
    line
}

/// Until the end; by both limits where there are two.
fn left(remaining: Remaining) -> String {
    match (remaining.passes, remaining.time) {
        (Some(passes), Some(time)) if passes <= time => {
            format!("{} left ({} of the time)", duration(passes), duration(time))
        }
        (Some(passes), Some(time)) => {
            format!("{} left of the time ({} to the last pass)", duration(time), duration(passes))
        }
        (Some(one), None) | (None, Some(one)) => format!("{} left", duration(one)),
        (None, None) => "no end".to_owned(),
    }
}

/// As people say it: 0.4 s, 12 s, 3 min 20 s, 2 h 05 min.
pub fn duration(time: Duration) -> String {
    let seconds = time.as_secs_f64();
    if seconds < 9.95 {
        return format!("{seconds:.1} s");
    }
    let s = seconds.round() as u64;
    match s {
        0..60 => format!("{s} s"),
        60..3600 => format!("{} min {:02} s", s / 60, s % 60),
        _ => format!("{} h {:02} min", s / 3600, s % 3600 / 60),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn durations() {
        let say = |s: f64| duration(Duration::from_secs_f64(s));
        let said = [0.04, 9.94, 9.96, 59.4, 59.6, 3599.4, 3600.0, 7500.0].map(say);
        assert_eq!(
            said,
            ["0.0 s", "9.9 s", "10 s", "59 s", "1 min 00 s", "59 min 59 s", "1 h 00 min", "2 h 05 min"]
        );
    }

    #[test]
    fn lines() {
        let s = Duration::from_secs;
        let line = |done, passes, elapsed, to_last: Option<u64>, time: Option<u64>| {
            let remaining = Remaining { passes: to_last.map(s), time: time.map(s) };
            pass_line(&Position { done, passes, elapsed: s(elapsed), remaining })
        };
        let said = [
            line(3, Some(12), 6, Some(18), None),
            line(12, Some(12), 24, Some(0), None),
            line(3, None, 6, None, Some(54)),
            line(3, Some(12), 6, Some(18), Some(54)),
            line(3, Some(120), 6, Some(240), Some(54)),
            line(3, None, 6, None, None),
        ];
        assert_eq!(
            said,
            [
                "pass 3/12 (25 %), 6.0 s elapsed, 18 s left",
                "pass 12/12 (100 %), 24 s elapsed",
                "pass 3, 6.0 s elapsed, 54 s left",
                "pass 3/12 (25 %), 6.0 s elapsed, 18 s left (54 s of the time)",
                "pass 3/120 (2 %), 6.0 s elapsed, 54 s left of the time (4 min 00 s to the last pass)",
                "pass 3, 6.0 s elapsed",
            ]
        );
    }
}
