//! Diagnostics as plain text with the line they point at.

use unicode_width::UnicodeWidthChar;

use crate::diagnostic::{Diagnostic, Label, Severity};
use crate::source::{Sources, Span};

/// Columns of a shown line, at most.
const WIDTH: usize = 120;
/// Columns kept before the caret when a line is cut.
const BEFORE: usize = 40;
/// Bytes of a line looked at on either side of the mark's start.
const LOOK_AROUND: usize = 1 << 10;
/// Columns of a tab.
const TAB: &str = "    ";

/// Where a span starts, as people count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Position {
    /// From 1.
    pub line: usize,
    /// From 1, in characters.
    pub column: usize,
}

/// The line and column of a byte; that of the end for bytes beyond it.
pub fn position(text: &str, byte: usize) -> Position {
    let byte = floor_boundary(text, byte);
    let line_start = text[..byte].rfind('\n').map_or(0, |i| i + 1);
    let line = text.as_bytes()[..line_start].iter().filter(|&&b| b == b'\n').count() + 1;
    Position { line, column: text[line_start..byte].chars().count() + 1 }
}

fn floor_boundary(text: &str, byte: usize) -> usize {
    let mut byte = byte.min(text.len());
    while !text.is_char_boundary(byte) {
        byte -= 1;
    }
    byte
}

/// One line with tabs and control characters replaced, and the columns of the marked part.
struct Shown {
    line: String,
    from: usize,
    to: usize,
}

/// The first line of a span.
fn shown(text: &str, span: Span) -> Shown {
    let start = floor_boundary(text, span.start);
    let line_start = text[..start].rfind('\n').map_or(0, |i| i + 1);
    let line_end = text[start..].find('\n').map_or(text.len(), |i| start + i);
    // Of a very long line only the neighbourhood is looked at.
    let near = |byte: usize| floor_boundary(text, byte);
    let window_start = near(start.saturating_sub(LOOK_AROUND)).max(line_start);
    let window_end = near(start + LOOK_AROUND).min(line_end);
    let cut = window_start > line_start;
    let line = text[window_start..window_end].trim_end_matches('\r');
    let (start, end) = (start - window_start, floor_boundary(text, span.end).saturating_sub(window_start));
    // Characters, their columns, and whether they are marked.
    let mut cells: Vec<(String, usize)> = Vec::new();
    let (mut from, mut to, mut column) = (None, 0, 0);
    for (i, c) in line.char_indices() {
        let cell = match c {
            '\t' => TAB.to_owned(),
            c if c.is_control() => "\u{fffd}".to_owned(),
            c => c.to_string(),
        };
        let width = if c == '\t' { TAB.len() } else { c.width().unwrap_or(1) };
        if i >= start {
            from.get_or_insert(column);
            if i < end {
                to = column + width;
            }
        }
        cells.push((cell, width));
        column += width;
    }
    let from = from.unwrap_or(column);
    let to = to.max(from + 1);
    if column <= WIDTH && !cut && window_end == line_end {
        return Shown { line: cells.into_iter().map(|(cell, _)| cell).collect(), from, to };
    }
    // A window around the mark.
    let first = from.saturating_sub(BEFORE);
    let mut line = String::new();
    let (mut at, mut left, mut used) = (0, None, 0);
    for (cell, width) in &cells {
        if at >= first && used + width <= WIDTH {
            if left.is_none() {
                left = Some(at);
                if at > 0 {
                    line.push('…');
                }
            }
            line.push_str(cell);
            used += width;
        } else if left.is_some() {
            line.push('…');
            break;
        }
        at += width;
    }
    let left = left.unwrap_or(0);
    let shift = usize::from(left > 0);
    let from = from.saturating_sub(left) + shift;
    let to = (to.saturating_sub(left) + shift).min(used + shift).max(from + 1);
    Shown { line, from, to }
}

/// What is printed for one label.
fn block(label: &Label, sources: &Sources, main: bool, gutter: usize) -> String {
    let arrow = if main { "-->" } else { ":::" };
    let pad = " ".repeat(gutter);
    let path = printable(&sources.path(label.span.file).display().to_string());
    let Some(source) = sources.get(label.span.file) else { return String::new() };
    if label.span.start == 0 && label.span.end == 0 {
        let text =
            if label.text.is_empty() { String::new() } else { format!(": {}", printable(&label.text)) };
        return format!("{pad}{arrow} {path}{text}\n");
    }
    let Position { line, column } = position(&source.text, label.span.start);
    let Shown { line: text, from, to } = shown(&source.text, label.span);
    let mark = if main { "^" } else { "-" }.repeat(to - from);
    let underline = format!("{}{mark} {}", " ".repeat(from), printable(&label.text));
    format!(
        "{pad}{arrow} {path}:{line}:{column}\n{pad} |\n{line:>gutter$} | {}\n{pad} | {}\n",
        text.trim_end(),
        underline.trim_end()
    )
}

/// Without control characters, which could steer a terminal.
fn printable(text: &str) -> String {
    text.chars().map(|c| if c.is_control() && c != '\n' { '\u{fffd}' } else { c }).collect()
}

impl Diagnostic {
    /// Plain text: message, places with their lines, help. Ends with a newline.
    pub fn render(&self, sources: &Sources) -> String {
        let mut out = format!("{}[{}]: {}\n", self.severity.name(), self.code, printable(&self.message));
        let line = |label: &Label| match sources.get(label.span.file) {
            Some(source) => position(&source.text, label.span.start).line,
            None => 1,
        };
        let gutter = self.labels.iter().map(line).max().unwrap_or(1).to_string().len();
        for (i, label) in self.labels.iter().enumerate() {
            out += &block(label, sources, i == 0, gutter);
        }
        if let Some(help) = &self.help {
            let pad = " ".repeat(gutter);
            out +=
                &format!("{pad} = help: {}\n", printable(help).replace('\n', &format!("\n{pad}         ")));
        }
        out
    }
}

/// All diagnostics one after the other, and a last line that counts them; empty for none.
pub fn render_all(diagnostics: &[Diagnostic], sources: &Sources) -> String {
    let mut out = String::new();
    for diagnostic in diagnostics {
        out += &diagnostic.render(sources);
        out.push('\n');
    }
    let count = |severity: Severity| diagnostics.iter().filter(|d| d.severity == severity).count();
    let say = |n: usize, what: &str| match n {
        0 => None,
        1 => Some(format!("1 {what}")),
        n => Some(format!("{n} {what}s")),
    };
    let counts: Vec<String> =
        [say(count(Severity::Error), "error"), say(count(Severity::Warning), "warning")]
            .into_iter()
            .flatten()
            .collect();
    if !counts.is_empty() {
        out += &counts.join(", ");
        out.push('\n');
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use expect_test::{Expect, expect};

    fn check(text: &str, marked: &str, expected: Expect) {
        let mut sources = Sources::default();
        let file = sources.add("a.toml", text);
        let start = text.find(marked).unwrap();
        let span = Span { file, start, end: start + marked.len() };
        expected.assert_eq(
            &Diagnostic::error("x", "message").label(span, "here").help("do\nthis").render(&sources),
        );
    }

    #[test]
    fn marks_the_place() {
        check(
            "a = 1\n  bee = 2\n",
            "bee",
            expect![[r#"
                error[x]: message
                 --> a.toml:2:3
                  |
                2 |   bee = 2
                  |   ^^^ here
                  = help: do
                          this
            "#]],
        );
    }

    #[test]
    fn tabs_wide_characters_and_crlf() {
        check(
            "\r\n\t\"漢字é\" = \u{1b}x\r\n",
            "x",
            expect![[r#"
                error[x]: message
                 --> a.toml:2:11
                  |
                2 |     "漢字é" = �x
                  |                ^ here
                  = help: do
                          this
            "#]],
        );
    }

    #[test]
    fn spans_of_several_lines_end_with_the_first() {
        check(
            "a = [\n1\n]\n",
            "[\n1\n]",
            expect![[r#"
                error[x]: message
                 --> a.toml:1:5
                  |
                1 | a = [
                  |     ^ here
                  = help: do
                          this
            "#]],
        );
    }

    #[test]
    fn long_lines_are_cut_around_the_mark() {
        check(
            &format!("a = [{}ABC{}]", "1, ".repeat(400), ", 1".repeat(400)),
            "ABC",
            expect![[r#"
                error[x]: message
                 --> a.toml:1:1206
                  |
                1 | … 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, ABC, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, …
                  |                                          ^^^ here
                  = help: do
                          this
            "#]],
        );
        check(
            &format!("{}\n", "x".repeat(500)),
            &"x".repeat(500),
            expect![[r#"
                error[x]: message
                 --> a.toml:1:1
                  |
                1 | xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx…
                  | ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ here
                  = help: do
                          this
            "#]],
        );
    }

    #[test]
    fn any_span_of_any_text_renders() {
        let text = "ä\tb\r\n\n漢\u{0}";
        let mut sources = Sources::default();
        let file = sources.add("t", text);
        for start in 0..text.len() + 3 {
            for end in 0..text.len() + 3 {
                let span = Span { file, start, end };
                assert!(Diagnostic::error("x", "m").at(span).render(&sources).contains("t"));
            }
        }
        let elsewhere = Span { file: crate::FileId(9), start: 1, end: 2 };
        assert_eq!(Diagnostic::error("x", "m").at(elsewhere).render(&sources), "error[x]: m\n");
    }
}
