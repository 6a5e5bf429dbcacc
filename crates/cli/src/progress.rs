//! How a render tells of itself, on standard error: a bar on a terminal, now and then a line in a pipe, JSON for programs,
//! or nothing.

use std::io::IsTerminal;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use nephroid::{Film, Remaining};
use serde_json::{Value, json};

use crate::args::{How, RunArgs};
use crate::grain::percent;
use crate::say;

/// Shortest time between two lines of passes.
const BETWEEN_LINES: Duration = Duration::from_secs(5);
/// Shortest time between two objects of passes.
const BETWEEN_OBJECTS: Duration = Duration::from_millis(500);
/// Shortest time between two looks at the grain.
const BETWEEN_LOOKS: Duration = Duration::from_secs(1);

/// Where progress goes; always standard error.
#[derive(Clone, Debug)]
pub struct Progress {
    form: Form,
    /// When a pass was told last.
    told: Option<Instant>,
    /// When the grain was looked at last, and what it was.
    grain: Option<(Instant, f64)>,
}

/// In which form.
#[derive(Clone, Debug)]
enum Form {
    /// A bar that redraws itself.
    Bar(ProgressBar),
    /// Lines.
    Lines,
    /// An object a line.
    Json,
    /// Nothing.
    None,
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
    /// The grain that ends it.
    pub goal: Option<f32>,
}

impl Progress {
    /// What was asked for, or else suits standard error.
    pub fn new(args: &RunArgs) -> Self {
        let form = match args.progress {
            _ if args.quiet => Form::None,
            Some(How::None) => Form::None,
            Some(How::Json) => Form::Json,
            Some(How::Lines) => Form::Lines,
            Some(How::Bar) => Form::Bar(bar()),
            None if std::io::stderr().is_terminal() => Form::Bar(bar()),
            None => Form::Lines,
        };
        Self { form, told: None, grain: None }
    }

    /// Lines, or nothing.
    pub fn plain(quiet: bool) -> Self {
        Self { form: if quiet { Form::None } else { Form::Lines }, told: None, grain: None }
    }

    /// The same form without a bar.
    pub fn before(args: &RunArgs) -> Self {
        match args.progress {
            Some(How::Json) if !args.quiet => Self { form: Form::Json, told: None, grain: None },
            Some(How::None) => Self::plain(true),
            Some(How::Json | How::Bar | How::Lines) | None => Self::plain(args.quiet),
        }
    }

    /// What may be wrong with a scene: said whatever the form.
    pub fn diagnostics(&self, text: &str) {
        match (&self.form, text.trim_end()) {
            (_, "") => {}
            (Form::Json, text) => self.object("warning", text, json!({})),
            (Form::Bar(_) | Form::Lines | Form::None, text) => say::say(&say::painted(text)),
        }
    }

    /// A line that stays.
    pub fn line(&self, text: &str) {
        self.object("note", text, json!({}));
    }

    /// The pictures show so many passes now.
    pub fn preview(&self, passes: u64) {
        if let Form::Json = self.form {
            self.object("preview", "", json!({ "passes": passes }));
        }
    }

    /// How it ended: a line, or for programs these values.
    pub fn end(&self, text: &str, values: Value) {
        match self.form {
            Form::Json => self.object("end", text, values),
            Form::Bar(_) | Form::Lines if text.is_empty() => {}
            Form::Bar(_) | Form::Lines | Form::None => self.line(text),
        }
    }

    /// A line that stays; for programs an object with `event` and these values in its place.
    pub fn object(&self, event: &str, text: &str, values: Value) {
        match &self.form {
            Form::Bar(bar) => bar.suspend(|| say::say(text)),
            Form::Lines => say::say(text),
            Form::Json => {
                let mut values = values;
                values["event"] = event.into();
                if ["note", "warning", "error"].contains(&event) {
                    values["text"] = text.into();
                }
                say::say(&values.to_string());
            }
            Form::None => {}
        }
    }

    /// What may be wrong: said whatever the form.
    pub fn warn(&self, text: &str) {
        match &self.form {
            Form::None => say::say(&say::warning(text)),
            Form::Json => self.object("warning", text, json!({})),
            Form::Bar(_) | Form::Lines => self.line(&say::warning(text)),
        }
    }

    /// What went wrong: said whatever the form.
    pub fn error(&self, text: &str) {
        match &self.form {
            Form::Json => self.object("error", text, json!({})),
            Form::Bar(_) | Form::Lines | Form::None => say::error(text),
        }
    }

    /// What is being done now.
    pub fn doing(&self, what: &'static str) {
        if let Form::Bar(bar) = &self.form {
            bar.set_message(what);
        }
    }

    /// A pass is done, and in the film.
    pub fn pass(&mut self, at: &Position, film: &Film) {
        let since = self.told.map(|told| told.elapsed());
        let is_due = |between| since.is_none_or(|since| since >= between);
        let is_last = at.passes == Some(at.done);
        match &self.form {
            Form::Bar(bar) => {
                let bar = bar.clone();
                let grain = self.grain(film);
                bar.set_prefix(bar_text(at, grain));
                bar.set_position((at.share() * 1000.0) as u64);
            }
            Form::Lines if is_last || is_due(BETWEEN_LINES) => {
                let grain = film.grain();
                say::say(&pass_line(at, grain));
                self.told = Some(Instant::now());
            }
            Form::Json if is_last || is_due(BETWEEN_OBJECTS) => {
                let grain = film.grain();
                self.object("pass", "", object(at, grain));
                self.told = Some(Instant::now());
            }
            Form::Lines | Form::Json | Form::None => {}
        }
    }

    /// Takes the bar away.
    pub fn finish(&self) {
        if let Form::Bar(bar) = &self.form {
            bar.finish_and_clear();
        }
    }

    /// The grain of a film, as of a second ago at most.
    fn grain(&mut self, film: &Film) -> Option<f64> {
        if self.grain.is_none_or(|(looked, _)| looked.elapsed() >= BETWEEN_LOOKS) {
            self.grain = film.grain().map(|grain| (Instant::now(), grain));
        }
        self.grain.map(|(_, grain)| grain)
    }
}

fn bar() -> ProgressBar {
    let bar = ProgressBar::with_draw_target(Some(1000), ProgressDrawTarget::stderr());
    if let Ok(style) = ProgressStyle::with_template("{msg:17} {wide_bar} {prefix}") {
        bar.set_style(style);
    }
    bar.enable_steady_tick(Duration::from_millis(500));
    bar
}

impl Position {
    /// How much of the render is done, from 0 to 1, by the limit that is nearest.
    fn share(&self) -> f64 {
        let passes = self.passes.map_or(0.0, |passes| self.done as f64 / passes.max(1) as f64);
        let elapsed = self.elapsed.as_secs_f64();
        let of = |left: Duration| elapsed / (elapsed + left.as_secs_f64()).max(1e-9);
        let others = self.remaining.time.into_iter().chain(self.remaining.grain);
        others.map(of).fold(passes, f64::max).min(1.0)
    }
}

fn bar_text(at: &Position, grain: Option<f64>) -> String {
    let of = at.passes.map_or(String::new(), |passes| format!("/{passes}"));
    format!("{}{of} passes{}, {}", at.done, grain_text(at, grain), left(at.remaining))
}

fn pass_line(at: &Position, grain: Option<f64>) -> String {
    let mut line = format!("pass {}", at.done);
    if let Some(passes) = at.passes {
        line += &format!("/{passes} ({} %)", at.done * 100 / passes.max(1));
    }
    line += &grain_text(at, grain);
    line += &format!(", {} elapsed", duration(at.elapsed));
    if at.passes != Some(at.done) && at.remaining.first().is_some() {
        line += &format!(", {}", left(at.remaining));
    }
    line
}

fn grain_text(at: &Position, grain: Option<f64>) -> String {
    let goal = at.goal.map_or(String::new(), |goal| format!(" (to {})", percent(goal.into())));
    grain.map_or(String::new(), |grain| format!(", grain {}{goal}", percent(grain)))
}

/// A pass for programs; what is not known is null.
fn object(at: &Position, grain: Option<f64>) -> Value {
    let seconds = |time: Duration| (time.as_secs_f64() * 1000.0).round() / 1000.0;
    json!({
        "done": at.done,
        "passes": at.passes,
        "share": (at.share() * 1e4).round() / 1e4,
        "elapsed_s": seconds(at.elapsed),
        "left_s": at.remaining.first().map(seconds),
        "grain": grain.map(|grain| (grain * 1e6).round() / 1e6),
    })
}

/// Until the end; where there are two limits, by the nearest, and by the others too.
fn left(remaining: Remaining) -> String {
    let limits = [
        (remaining.passes, "to the last pass"),
        (remaining.time, "of the time"),
        (remaining.grain, "to that grain"),
    ];
    let mut known: Vec<(Duration, &str)> =
        limits.into_iter().filter_map(|(left, what)| Some((left?, what))).collect();
    // Stable: passes before time where they are equal.
    known.sort_by_key(|(left, _)| *left);
    match known.as_slice() {
        [] => "no end".to_owned(),
        [(first, _)] => format!("{} left", duration(*first)),
        [(first, _), (second, what), ..] => {
            format!("{} left ({} {what})", duration(*first), duration(*second))
        }
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

    fn at(done: u64, passes: Option<u64>, elapsed: u64, left: [Option<u64>; 3]) -> Position {
        let s = Duration::from_secs;
        let [to_last, time, to_grain] = left.map(|left| left.map(s));
        let remaining = Remaining { passes: to_last, time, grain: to_grain };
        Position { done, passes, elapsed: s(elapsed), remaining, goal: to_grain.map(|_| 0.02) }
    }

    #[test]
    fn lines() {
        let line = |done, passes, elapsed, left, grain| pass_line(&at(done, passes, elapsed, left), grain);
        let said = [
            line(3, Some(12), 6, [Some(18), None, None], None),
            line(12, Some(12), 24, [Some(0), None, None], Some(0.0412)),
            line(3, None, 6, [None, Some(54), None], None),
            line(3, Some(12), 6, [Some(18), Some(54), None], None),
            line(3, Some(120), 6, [Some(240), Some(54), None], None),
            line(9, None, 6, [None, Some(54), Some(30)], Some(0.071)),
            line(3, None, 6, [None; 3], None),
        ];
        assert_eq!(
            said,
            [
                "pass 3/12 (25 %), 6.0 s elapsed, 18 s left",
                "pass 12/12 (100 %), grain 4.1 %, 24 s elapsed",
                "pass 3, 6.0 s elapsed, 54 s left",
                "pass 3/12 (25 %), 6.0 s elapsed, 18 s left (54 s of the time)",
                "pass 3/120 (2 %), 6.0 s elapsed, 54 s left (4 min 00 s to the last pass)",
                "pass 9, grain 7.1 % (to 2.0 %), 6.0 s elapsed, 30 s left (54 s of the time)",
                "pass 3, 6.0 s elapsed",
            ]
        );
    }

    #[test]
    fn the_nearest_limit_says_how_much_is_done() {
        assert_eq!(at(3, Some(12), 6, [Some(18), None, None]).share(), 0.25);
        assert_eq!(at(3, Some(12), 6, [Some(18), Some(6), None]).share(), 0.5);
        assert_eq!(at(3, None, 6, [None, Some(18), Some(2)]).share(), 0.75);
        assert_eq!(at(3, None, 6, [None; 3]).share(), 0.0);
    }
}
