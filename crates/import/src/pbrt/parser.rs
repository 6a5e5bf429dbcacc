//! From text to directives and their parameters. After a mistake reading goes on at the next directive.

use scenefile::{Diagnostic, Span};

use super::lexer::{self, Token};
use super::params::{Param, Params, Values};
use super::state::Target;
use super::{Importer, Open};

/// A mistake was reported; the directive ends here.
pub(super) struct Broken;

pub(super) type Parsed<T> = Result<T, Broken>;

impl Importer {
    /// Reads all that is open.
    pub(super) fn run(&mut self) {
        while !self.open.is_empty() {
            match self.token() {
                None => self.close_file(),
                Some((Token::Word, span)) => {
                    let name = self.slice(span).to_owned();
                    if self.directive(&name, span).is_err() {
                        self.skip();
                    }
                }
                Some((_, span)) => {
                    self.report.error("syntax", "a directive was expected here", span);
                    self.skip();
                }
            }
        }
    }

    fn close_file(&mut self) {
        let Some(Open { scopes, graphics, .. }) = self.open.pop() else { return };
        let surplus = if self.open.is_empty() {
            Vec::new()
        } else {
            self.scopes.split_off(scopes.min(self.scopes.len()))
        };
        for scope in surplus {
            let text = format!("`{}` without `{}` in this file", scope.begin(), scope.end());
            self.report.error("syntax", text, scope.span());
        }
        if let Some(graphics) = graphics {
            self.graphics = *graphics;
        }
    }

    /// To the next word that may be a directive.
    fn skip(&mut self) {
        while let Some((token, span)) = self.peek() {
            if token == Token::Word && self.slice(span).starts_with(|c: char| c.is_ascii_uppercase()) {
                return;
            }
            self.peeked = None;
        }
    }

    /// The next token of the innermost text; `None` at its end.
    pub(super) fn token(&mut self) -> Option<(Token, Span)> {
        let token = self.peek();
        self.peeked = None;
        token
    }

    pub(super) fn peek(&mut self) -> Option<(Token, Span)> {
        if self.peeked.is_none() {
            loop {
                let open = self.open.last()?;
                let file = open.file;
                let found = lexer::next(self.text(file), open.at);
                let at = match &found {
                    Ok(None) => return None,
                    Ok(Some((_, _, end))) | Err((_, end)) => *end,
                };
                if let Some(open) = self.open.last_mut() {
                    open.at = at;
                }
                match found {
                    Ok(Some((token, start, end))) => {
                        self.peeked = Some((token, Span { file, start, end }));
                        break;
                    }
                    Err((start, end)) => {
                        self.report.error(
                            "syntax",
                            "this string has no closing quote on its line",
                            Span { file, start, end },
                        );
                    }
                    Ok(None) => return None,
                }
            }
        }
        self.peeked
    }

    /// Reports that something else was expected after `what`.
    fn expected<T>(
        &mut self,
        expected: &str,
        what: &str,
        found: Option<(Token, Span)>,
        after: Span,
    ) -> Parsed<T> {
        let (text, span) = match found {
            Some((_, span)) => (format!("`{what}` takes {expected} here"), span),
            None => (format!("the file ends where `{what}` takes {expected}"), after),
        };
        self.report.error("syntax", text, span);
        Err(Broken)
    }

    /// A string, as the name after a directive.
    pub(super) fn string(&mut self, what: &str, after: Span) -> Parsed<(String, Span)> {
        match self.peek() {
            Some((Token::Text, span)) => {
                self.peeked = None;
                Ok((lexer::unquoted(self.slice(span)), span))
            }
            found => self.expected("a string in quotes", what, found, after),
        }
    }

    /// A word without quotes.
    pub(super) fn word(&mut self, what: &str, after: Span) -> Parsed<(String, Span)> {
        match self.peek() {
            Some((Token::Word, span)) => {
                self.peeked = None;
                Ok((self.slice(span).to_owned(), span))
            }
            found => self.expected("a word", what, found, after),
        }
    }

    /// N finite numbers, in brackets or not.
    pub(super) fn numbers<const N: usize>(&mut self, what: &str, after: Span) -> Parsed<[f64; N]> {
        let bracket = matches!(self.peek(), Some((Token::Open, _)));
        if bracket {
            self.peeked = None;
        }
        let mut numbers = [0.0; N];
        for number in &mut numbers {
            let found = self.peek();
            let value = match found {
                Some((Token::Word, span)) => self.slice(span).parse::<f64>().ok().filter(|x| x.is_finite()),
                _ => None,
            };
            match value {
                Some(value) => *number = value,
                None => return self.expected(&format!("{N} numbers"), what, found, after),
            }
            self.peeked = None;
        }
        if bracket {
            match self.peek() {
                Some((Token::Close, _)) => self.peeked = None,
                found => {
                    return self.expected(&format!("{N} numbers and a closing bracket"), what, found, after);
                }
            }
        }
        Ok(numbers)
    }

    /// The parameters that follow, with the defaults of `target`.
    pub(super) fn params(&mut self, what: String, span: Span, target: Option<Target>) -> Parsed<Params> {
        let list = self.param_list()?;
        let defaults = self.graphics.defaults.clone();
        let defaults = target.map_or(&[][..], |t| &defaults[t as usize]);
        Ok(Params::new(what, span, self.graphics.space, list, defaults))
    }

    pub(super) fn param_list(&mut self) -> Parsed<Vec<Param>> {
        let mut list = Vec::new();
        while let Some((Token::Text, span)) = self.peek() {
            self.peeked = None;
            let declaration = lexer::unquoted(self.slice(span));
            let values = self.values(&declaration, span)?;
            // Version 3 writes truth values as strings.
            let values = match values {
                Values::Texts(texts)
                    if declaration.starts_with("bool")
                        && texts.iter().all(|t| t == "true" || t == "false") =>
                {
                    Values::Truths(texts.iter().map(|t| t == "true").collect())
                }
                values => values,
            };
            match Param::new(&declaration, values, span) {
                Ok(param) => list.push(param),
                Err(diagnostic) => self.report.push(diagnostic),
            }
        }
        Ok(list)
    }

    fn values(&mut self, declaration: &str, after: Span) -> Parsed<Values> {
        let mut numbers = Vec::new();
        let mut texts = Vec::new();
        let mut truths = Vec::new();
        let bracket = matches!(self.peek(), Some((Token::Open, _)));
        if bracket {
            self.peeked = None;
        }
        loop {
            let found = self.peek();
            match found {
                Some((Token::Close, _)) if bracket => {
                    self.peeked = None;
                    break;
                }
                Some((Token::Text, span)) => texts.push(lexer::unquoted(self.slice(span))),
                Some((Token::Word, span)) => match self.slice(span) {
                    "true" => truths.push(true),
                    "false" => truths.push(false),
                    word => match word.parse::<f64>() {
                        Ok(number) => numbers.push(number),
                        Err(_) if bracket && word.starts_with(|c: char| c.is_ascii_uppercase()) => {
                            return self.expected("a closing bracket", declaration, found, after);
                        }
                        Err(_) => return self.expected("values", declaration, found, after),
                    },
                },
                found => return self.expected("values", declaration, found, after),
            }
            self.peeked = None;
            if !bracket {
                break;
            }
        }
        let kinds = [!numbers.is_empty(), !texts.is_empty(), !truths.is_empty()];
        match kinds {
            [_, false, false] => Ok(Values::Numbers(numbers)),
            [false, true, false] => Ok(Values::Texts(texts)),
            [false, false, true] => Ok(Values::Truths(truths)),
            _ => {
                let text = format!("`{declaration}` mixes values of several types");
                self.report.push(Diagnostic::error("parameter", text).at(after));
                Err(Broken)
            }
        }
    }
}
