//! How a render tells of itself: a bar on a terminal, now and then a line in a pipe, or nothing.

use std::io::IsTerminal;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

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
        /// Tenths of the passes that were told.
        tenths: u64,
    },
    /// Nothing.
    Quiet,
}

impl Progress {
    /// What suits standard error, for a render of `passes`.
    pub fn new(quiet: bool, passes: u64) -> Self {
        if quiet {
            return Self::Quiet;
        }
        if !std::io::stderr().is_terminal() {
            return Self::Lines { last: Instant::now(), tenths: 0 };
        }
        let bar = ProgressBar::with_draw_target(Some(passes), ProgressDrawTarget::stderr());
        if let Ok(style) = ProgressStyle::with_template("{msg:18} {wide_bar} {pos}/{len} passes, {prefix}") {
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
    pub fn doing(&self, what: &str) {
        if let Self::Bar(bar) = self {
            bar.set_message(what.to_owned());
        }
    }

    /// `done` of `passes` are done; the rest takes about `remaining`.
    pub fn passes(&mut self, done: u64, passes: u64, elapsed: Duration, remaining: Duration) {
        match self {
            Self::Bar(bar) => {
                bar.set_prefix(format!("{} left", duration(remaining)));
                bar.set_position(done);
            }
            Self::Lines { last, tenths } => {
                let now = done * 10 / passes.max(1);
                if now > *tenths || last.elapsed() >= SILENCE {
                    *tenths = now;
                    *last = Instant::now();
                    say(&pass_line(done, passes, elapsed, remaining));
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

fn pass_line(done: u64, passes: u64, elapsed: Duration, remaining: Duration) -> String {
    let percent = done * 100 / passes.max(1);
    let mut line = format!("pass {done}/{passes} ({percent} %), {} elapsed", duration(elapsed));
    if done < passes {
        line += &format!(", {} left", duration(remaining));
    }
    line
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
        assert_eq!(pass_line(3, 12, s(6), s(18)), "pass 3/12 (25 %), 6.0 s elapsed, 18 s left");
        assert_eq!(pass_line(12, 12, s(24), s(0)), "pass 12/12 (100 %), 24 s elapsed");
    }
}
