//! JSON (RFC 8259) as a tree that knows where each value was written.

use std::borrow::Cow;

use scenefile::{FileId, Span};

use super::fault::{Fault, Known};

/// Arrays and objects within one another, at most.
const DEEPEST: usize = 200;
/// Values of a text, at most: each takes up to 100 bytes of memory.
const MOST_VALUES: usize = 8 << 20;

/// A value and its place in the scene's own text.
#[derive(Debug)]
pub(super) struct Value<'t> {
    start: u32,
    end: u32,
    kind: Kind<'t>,
}

#[derive(Debug)]
enum Kind<'t> {
    Null,
    Bool(bool),
    Number(f64),
    Text(Cow<'t, str>),
    Array(Vec<Value<'t>>),
    Object(Vec<(Cow<'t, str>, Value<'t>)>),
}

impl<'t> Value<'t> {
    pub(super) fn span(&self) -> Span {
        Span { file: FileId(0), start: self.start as usize, end: self.end as usize }
    }

    fn noun(&self) -> &'static str {
        match self.kind {
            Kind::Null => "null",
            Kind::Bool(_) => "a truth value",
            Kind::Number(_) => "a number",
            Kind::Text(_) => "a string",
            Kind::Array(_) => "an array",
            Kind::Object(_) => "an object",
        }
    }

    fn wrong(&self, key: &str, wanted: &str) -> Fault {
        Fault::new("wrong-type", format!("`{key}` is {} where {wanted} is due", self.noun()), self.span())
    }

    /// The value of a key; `None` where there is none, or this is no object.
    pub(super) fn get(&self, key: &str) -> Option<&Value<'t>> {
        match &self.kind {
            Kind::Object(pairs) => pairs.iter().find(|(name, _)| name == key).map(|(_, value)| value),
            _ => None,
        }
    }

    /// The object of an extension.
    pub(super) fn extension(&self, name: &str) -> Option<&Value<'t>> {
        self.get("extensions")?.get(name)
    }

    /// The items of an array; none where the key is absent.
    pub(super) fn array(&self, key: &str) -> Known<&[Value<'t>]> {
        match self.get(key) {
            None => Ok(&[]),
            Some(Value { kind: Kind::Array(items), .. }) => Ok(items),
            Some(other) => Err(other.wrong(key, "an array")),
        }
    }

    pub(super) fn text(&self, key: &str) -> Known<Option<&str>> {
        match self.get(key) {
            None => Ok(None),
            Some(Value { kind: Kind::Text(text), .. }) => Ok(Some(text)),
            Some(other) => Err(other.wrong(key, "a string")),
        }
    }

    /// The string that this is.
    pub(super) fn as_text(&self) -> Option<&str> {
        match &self.kind {
            Kind::Text(text) => Some(text),
            _ => None,
        }
    }

    /// The name that things may have; empty for none.
    pub(super) fn name(&self) -> &str {
        self.get("name").and_then(Value::as_text).unwrap_or_default()
    }

    pub(super) fn truth(&self, key: &str, default: bool) -> Known<bool> {
        match self.get(key) {
            None => Ok(default),
            Some(Value { kind: Kind::Bool(value), .. }) => Ok(*value),
            Some(other) => Err(other.wrong(key, "true or false")),
        }
    }

    pub(super) fn as_number(&self, key: &str) -> Known<f64> {
        match self.kind {
            Kind::Number(x) => Ok(x),
            _ => Err(self.wrong(key, "a number")),
        }
    }

    pub(super) fn number(&self, key: &str, default: f64) -> Known<f64> {
        self.get(key).map_or(Ok(default), |value| value.as_number(key))
    }

    /// An array of so many numbers.
    pub(super) fn numbers<const N: usize>(&self, key: &str, default: [f64; N]) -> Known<[f64; N]> {
        let Some(value) = self.get(key) else { return Ok(default) };
        match &value.kind {
            Kind::Array(items) if items.len() == N => {
                let mut numbers = [0.0; N];
                for (number, item) in numbers.iter_mut().zip(items) {
                    *number = item.as_number(key)?;
                }
                Ok(numbers)
            }
            _ => Err(value.wrong(key, &format!("an array of {N} numbers"))),
        }
    }

    /// A whole number that is not negative.
    pub(super) fn as_whole(&self, key: &str) -> Known<u64> {
        let x = self.as_number(key)?;
        // Beyond 2^53 not every whole number is told from the next.
        if (0.0..=9_007_199_254_740_992.0).contains(&x) && x.fract() == 0.0 {
            Ok(x as u64)
        } else {
            Err(Fault::new("out-of-range", format!("`{key}` is {x}: no whole number ≥ 0"), self.span()))
        }
    }

    pub(super) fn whole(&self, key: &str) -> Known<Option<u64>> {
        self.get(key).map(|value| value.as_whole(key)).transpose()
    }

    /// The item of a list of the whole file that a key names by its number.
    pub(super) fn pick<'v>(
        &self,
        key: &str,
        noun: &str,
        list: &'v [Value<'t>],
    ) -> Known<Option<(usize, &'v Value<'t>)>> {
        self.get(key).map(|value| value.pick_self(key, noun, list)).transpose()
    }

    /// The same of this value itself.
    pub(super) fn pick_self<'v>(
        &self,
        key: &str,
        noun: &str,
        list: &'v [Value<'t>],
    ) -> Known<(usize, &'v Value<'t>)> {
        let index = self.as_whole(key)?;
        usize::try_from(index).ok().and_then(|i| Some((i, list.get(i)?))).ok_or_else(|| {
            let text = format!("there is no {noun} {index}: the file has {}", list.len());
            Fault::new("out-of-range", text, self.span())
        })
    }
}

/// Reads a text.
pub(super) fn parse(text: &str) -> Known<Value<'_>> {
    let mut parser = Parser { text, at: 0, left: MOST_VALUES };
    if u32::try_from(text.len()).is_err() {
        return Err(parser.fault("the text is longer than 4 GiB"));
    }
    let value = parser.value(0)?;
    parser.space();
    // Chunks of binary files may be filled with zeros by mistake.
    if parser.text[parser.at..].bytes().any(|b| b != 0) {
        return Err(parser.fault("something follows the end of the JSON text"));
    }
    Ok(value)
}

struct Parser<'t> {
    text: &'t str,
    at: usize,
    left: usize,
}

impl<'t> Parser<'t> {
    fn fault(&self, message: &str) -> Fault {
        let end = (self.at + 1).min(self.text.len());
        Fault::new("syntax", message, Span { file: FileId(0), start: self.at.min(end), end })
    }

    fn peek(&self) -> Option<u8> {
        self.text.as_bytes().get(self.at).copied()
    }

    fn space(&mut self) {
        while matches!(self.peek(), Some(b' ' | b'\t' | b'\n' | b'\r')) {
            self.at += 1;
        }
    }

    /// Whether the next byte is this one, which is taken then.
    fn take(&mut self, byte: u8) -> bool {
        self.space();
        let found = self.peek() == Some(byte);
        self.at += usize::from(found);
        found
    }

    fn value(&mut self, depth: usize) -> Known<Value<'t>> {
        self.space();
        if depth > DEEPEST {
            return Err(self.fault("arrays and objects are nested too deeply"));
        }
        if self.left == 0 {
            return Err(self.fault("the JSON text has too many values"));
        }
        self.left -= 1;
        let start = self.at;
        let kind = match self.peek() {
            Some(b'{') => self.object(depth)?,
            Some(b'[') => self.array(depth)?,
            Some(b'"') => Kind::Text(self.string()?),
            Some(b'-' | b'0'..=b'9') => self.number()?,
            Some(_) if self.word("true") => Kind::Bool(true),
            Some(_) if self.word("false") => Kind::Bool(false),
            Some(_) if self.word("null") => Kind::Null,
            Some(_) => return Err(self.fault("no JSON value begins here")),
            None => return Err(self.fault("the JSON text ends too early")),
        };
        Ok(Value { start: start as u32, end: self.at as u32, kind })
    }

    fn word(&mut self, word: &str) -> bool {
        let found = self.text[self.at..].starts_with(word);
        self.at += if found { word.len() } else { 0 };
        found
    }

    fn array(&mut self, depth: usize) -> Known<Kind<'t>> {
        self.at += 1;
        let mut items = Vec::new();
        if self.take(b']') {
            return Ok(Kind::Array(items));
        }
        loop {
            items.push(self.value(depth + 1)?);
            if self.take(b']') {
                items.shrink_to_fit();
                return Ok(Kind::Array(items));
            }
            if !self.take(b',') {
                return Err(self.fault("a comma or `]` is missing here"));
            }
        }
    }

    fn object(&mut self, depth: usize) -> Known<Kind<'t>> {
        self.at += 1;
        let mut pairs = Vec::new();
        if self.take(b'}') {
            return Ok(Kind::Object(pairs));
        }
        loop {
            self.space();
            if self.peek() != Some(b'"') {
                return Err(self.fault("a key in quotes is missing here"));
            }
            let key = self.string()?;
            if !self.take(b':') {
                return Err(self.fault("a colon is missing here"));
            }
            pairs.push((key, self.value(depth + 1)?));
            if self.take(b'}') {
                return Ok(Kind::Object(pairs));
            }
            if !self.take(b',') {
                return Err(self.fault("a comma or `}` is missing here"));
            }
        }
    }

    fn number(&mut self) -> Known<Kind<'t>> {
        let rest = &self.text[self.at..];
        let of_number = |b: u8| matches!(b, b'-' | b'+' | b'.' | b'e' | b'E' | b'0'..=b'9');
        let word = &rest[..rest.bytes().position(|b| !of_number(b)).unwrap_or(rest.len())];
        match word.parse::<f64>() {
            Ok(x) if x.is_finite() => {
                self.at += word.len();
                Ok(Kind::Number(x))
            }
            _ => Err(self.fault("this is no finite number")),
        }
    }

    fn string(&mut self) -> Known<Cow<'t, str>> {
        self.at += 1;
        let start = self.at;
        let bytes = self.text.as_bytes();
        while let Some(byte) = self.peek() {
            match byte {
                b'"' => {
                    let text = &self.text[start..self.at];
                    self.at += 1;
                    return Ok(Cow::Borrowed(text));
                }
                b'\\' => break,
                0..=0x1f => return Err(self.fault("a control character in a string")),
                _ => self.at += 1,
            }
        }
        let mut owned = self.text[start..self.at].to_owned();
        loop {
            let from = self.at;
            while !matches!(bytes.get(self.at), None | Some(b'"' | b'\\' | 0..=0x1f)) {
                self.at += 1;
            }
            owned += &self.text[from..self.at];
            match self.peek() {
                Some(b'"') => {
                    self.at += 1;
                    return Ok(Cow::Owned(owned));
                }
                Some(b'\\') => owned.push(self.escape()?),
                Some(_) => return Err(self.fault("a control character in a string")),
                None => return Err(self.fault("a string does not end")),
            }
        }
    }

    fn escape(&mut self) -> Known<char> {
        self.at += 1;
        let byte = self.peek().ok_or_else(|| self.fault("a string does not end"))?;
        self.at += 1;
        Ok(match byte {
            b'"' | b'\\' | b'/' => char::from(byte),
            b'b' => '\u{8}',
            b'f' => '\u{c}',
            b'n' => '\n',
            b'r' => '\r',
            b't' => '\t',
            b'u' => {
                let first = self.hex()?;
                let mut code = first;
                // A pair of surrogates stands for one character; one alone for none.
                if (0xd800..0xdc00).contains(&first) && self.text[self.at..].starts_with("\\u") {
                    self.at += 2;
                    let second = self.hex()?;
                    code = 0x10000 + ((first - 0xd800) << 10) + (second.wrapping_sub(0xdc00) & 0x3ff);
                }
                char::from_u32(code).unwrap_or(char::REPLACEMENT_CHARACTER)
            }
            _ => return Err(self.fault("this escape does not exist")),
        })
    }

    fn hex(&mut self) -> Known<u32> {
        let digits = self.text.get(self.at..self.at + 4);
        let code = digits
            .filter(|d| d.bytes().all(|b| b.is_ascii_hexdigit()))
            .and_then(|d| u32::from_str_radix(d, 16).ok())
            .ok_or_else(|| self.fault("four hexadecimal digits are due"))?;
        self.at += 4;
        Ok(code)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_and_places() {
        let text = "\u{20}{\"a\": [1, -2.5e1, true], \"n\\u00e4\\ud83d\\ude00\\n\": \"x\",\n \"o\":{\"e\":{}}}\n\0\0";
        let value = parse(text).unwrap();
        assert_eq!(value.array("a").unwrap().len(), 3);
        assert_eq!(value.text("nä😀\n").unwrap(), Some("x"));
        let span = value.get("a").unwrap().span();
        assert_eq!(&text[span.start..span.end], "[1, -2.5e1, true]");
        assert!(value.get("o").unwrap().get("e").is_some());
        assert!(value.numbers("a", [0.0; 3]).is_err());
        assert_eq!(value.numbers("b", [7.0; 2]).unwrap(), [7.0; 2]);
        assert_eq!(value.text("a").unwrap_err().message, "`a` is an array where a string is due");
    }

    #[test]
    fn what_is_no_json_is_refused() {
        for text in [
            "",
            "{",
            "[1,]",
            "{\"a\"}",
            "{\"a\":1,}",
            "nul",
            "1 2",
            "\"a",
            "\"\\x\"",
            "\"\\u12",
            "-",
            "1e999",
            "[1",
            "\"\u{1}\"",
            "{a:1}",
            "\"\\u12\u{e4}\"",
        ] {
            assert!(parse(text).is_err(), "{text}");
        }
        let deep = "[".repeat(100_000);
        assert!(parse(&deep).unwrap_err().message.contains("deeply"));
        let deep = format!("{}{}", "[".repeat(DEEPEST), "]".repeat(DEEPEST));
        assert!(parse(&deep).is_ok());
    }
}
