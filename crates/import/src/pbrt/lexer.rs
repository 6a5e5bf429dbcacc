//! Words, strings and brackets of pbrt's text.

/// What stands at a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Token {
    /// `[`.
    Open,
    /// `]`.
    Close,
    /// A string; its range includes the quotes.
    Text,
    /// A directive, number or truth value.
    Word,
}

/// A token and its bytes, from the first to one past the last.
pub(super) type Placed = (Token, usize, usize);

/// The next token at or after byte `at`; `None` at the end.
///
/// # Errors
/// A string that its line does not end: its range.
pub(super) fn next(text: &str, at: usize) -> Result<Option<Placed>, (usize, usize)> {
    let bytes = text.as_bytes();
    let mut start = at;
    loop {
        match bytes.get(start) {
            None => return Ok(None),
            Some(b'#') => {
                start += bytes[start..].iter().position(|b| *b == b'\n').unwrap_or(bytes.len() - start)
            }
            Some(b) if b.is_ascii_whitespace() || *b == 0x0b => start += 1,
            Some(_) => break,
        }
    }
    match bytes[start] {
        b'[' => Ok(Some((Token::Open, start, start + 1))),
        b']' => Ok(Some((Token::Close, start, start + 1))),
        b'"' => {
            let mut end = start + 1;
            loop {
                match bytes.get(end) {
                    None | Some(b'\n') => return Err((start, end)),
                    Some(b'"') => return Ok(Some((Token::Text, start, end + 1))),
                    // A backslash never hides the end of the line.
                    Some(b'\\') if bytes.get(end + 1).is_some_and(|b| *b != b'\n') => end += 2,
                    Some(_) => end += 1,
                }
            }
        }
        _ => {
            let ends = |b: &u8| b.is_ascii_whitespace() || matches!(b, b'[' | b']' | b'"' | b'#');
            let length = bytes[start..].iter().position(ends).unwrap_or(bytes.len() - start);
            Ok(Some((Token::Word, start, start + length)))
        }
    }
}

/// A string without its quotes and with its escapes resolved.
pub(super) fn unquoted(token: &str) -> String {
    let inner = token.strip_prefix('"').unwrap_or(token);
    let inner = inner.strip_suffix('"').unwrap_or(inner);
    let mut out = String::with_capacity(inner.len());
    let mut chars = inner.chars();
    while let Some(c) = chars.next() {
        match (c, c == '\\') {
            (_, true) => match chars.next() {
                Some('n') => out.push('\n'),
                Some('t') => out.push('\t'),
                Some('r') => out.push('\r'),
                Some('b') => out.push('\u{8}'),
                Some('f') => out.push('\u{c}'),
                Some(other) => out.push(other),
                None => out.push('\\'),
            },
            (c, false) => out.push(c),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(text: &str) -> Vec<(Token, &str)> {
        let (mut at, mut out) = (0, Vec::new());
        while let Some((token, start, end)) = next(text, at).unwrap() {
            out.push((token, &text[start..end]));
            at = end;
        }
        out
    }

    #[test]
    fn tokens() {
        use Token::*;
        let found = all("Shape \"a b\"# c \"\n [-1 2e3]true[\"x\\\"y\"]# end");
        let expected = [
            (Word, "Shape"),
            (Text, "\"a b\""),
            (Open, "["),
            (Word, "-1"),
            (Word, "2e3"),
            (Close, "]"),
            (Word, "true"),
            (Open, "["),
            (Text, "\"x\\\"y\""),
            (Close, "]"),
        ];
        assert_eq!(found, expected);
        assert_eq!(unquoted("\"x\\\"y\\n\\\\\""), "x\"y\n\\");
    }

    #[test]
    fn strings_end_on_their_line() {
        assert_eq!(next("a \"b\nc\"", 1), Err((2, 4)));
        assert_eq!(next("\"b\\", 0), Err((0, 3)));
        assert_eq!(next("\"b\\\n\"", 0), Err((0, 3)));
    }
}
