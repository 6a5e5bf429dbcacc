//! Printing that survives closed pipes, and colours where they are wanted.

use std::io::{self, ErrorKind, IsTerminal, Write};

/// A line on standard error; a closed one is no mistake.
pub fn say(text: &str) {
    let _ = writeln!(io::stderr().lock(), "{text}");
}

/// Text on standard output. A reader that went away has read enough.
///
/// # Errors
/// Where the text cannot be written for another reason, a full disk say.
pub fn print(text: &str) -> io::Result<()> {
    let mut out = io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        result => result,
    }
}

/// What went wrong, on standard error.
pub fn error(text: &str) {
    say(&paint(&format!("error: {text}"), wants_colour()));
}

/// What may be wrong, on standard error.
pub fn warning(text: &str) -> String {
    paint(&format!("warning: {text}"), wants_colour())
}

/// Text of diagnostics, painted where standard error is a terminal.
pub fn painted(text: &str) -> String {
    paint(text, wants_colour())
}

/// Whether standard error is a terminal that takes colours, and NO_COLOR is not set (no-color.org).
fn wants_colour() -> bool {
    let unset = |name: &str| std::env::var_os(name).is_none_or(|value| value.is_empty());
    io::stderr().is_terminal()
        && unset("NO_COLOR")
        && std::env::var_os("TERM").is_none_or(|term| term != "dumb")
}

/// Paints what stands before the first colon of lines that begin with a severity, the frames of snippets, and help.
fn paint(text: &str, colour: bool) -> String {
    if !colour {
        return text.to_owned();
    }
    let mut out = String::with_capacity(text.len() * 2);
    for line in text.split_inclusive('\n') {
        let code = match line {
            _ if line.starts_with("error") => "1;31",
            _ if line.starts_with("warning") => "1;33",
            _ if line.starts_with("note") => "1;36",
            _ if line.trim_start().starts_with("--> ") => "34",
            _ if line.trim_start().starts_with("= help") => "36",
            _ => "",
        };
        let end = match code {
            "" => 0,
            "1;31" | "1;33" => line.find(':').unwrap_or(0),
            _ => line.trim_end().len(),
        };
        if end > 0 {
            out += &format!("\u{1b}[{code}m{}\u{1b}[0m{}", &line[..end], &line[end..]);
        } else {
            out += line;
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paint_changes_nothing_but_colours() {
        let text = "error[x]: a: b\n --> f.toml:1:2\n  |\n1 | error = 2\n  = help: do\n";
        assert_eq!(paint(text, false), text);
        let painted = paint(text, true);
        assert!(painted.starts_with("\u{1b}[1;31merror[x]\u{1b}[0m: a: b\n"), "{painted:?}");
        let mut plain = painted;
        for code in ["\u{1b}[1;31m", "\u{1b}[34m", "\u{1b}[36m", "\u{1b}[0m"] {
            assert!(plain.contains(code), "{code:?}");
            plain = plain.replace(code, "");
        }
        assert_eq!(plain, text);
    }
}
