//! Pictures that a material file names, with their options.

use scenefile::Span;
use scenefile::desc::{Channel, Wrap};

use crate::report::Report;

/// A picture of a material.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Map {
    pub span: Span,
    /// As written.
    pub file: String,
    /// `-o`.
    pub offset: [f32; 2],
    /// `-s`.
    pub scale: [f32; 2],
    /// `-clamp`.
    pub wrap: Wrap,
    /// `-bm`.
    pub bump: f32,
    /// The gain of `-mm`.
    pub gain: f32,
    /// `-imfchan`.
    pub channel: Option<Channel>,
}

/// Options, then the file's name to the end of the line. `None`, said, where there is no name.
pub(super) fn parse_map(rest: &str, span: Span, report: &mut Report) -> Option<Map> {
    let mut map = Map {
        span,
        file: String::new(),
        offset: [0.0; 2],
        scale: [1.0; 2],
        wrap: Wrap::Repeat,
        bump: 1.0,
        gain: 1.0,
        channel: None,
    };
    let mut rest = rest;
    while let Some(option) = first(rest).filter(|word| word.starts_with('-') && word.parse::<f32>().is_err())
    {
        rest = rest[option.len()..].trim_start();
        match option {
            "-o" | "-s" | "-t" => {
                let mut given = [None; 3];
                for slot in &mut given {
                    *slot = number(&mut rest);
                }
                let target = match option {
                    "-o" => &mut map.offset,
                    "-s" => &mut map.scale,
                    _ => {
                        report.instead(
                            "turbulence of textures (`-t`) is not rendered",
                            "it is left out",
                            span,
                        );
                        continue;
                    }
                };
                for (to, from) in target.iter_mut().zip(given) {
                    *to = from.unwrap_or(*to);
                }
            }
            "-bm" => map.bump = number(&mut rest).unwrap_or(1.0),
            "-mm" => {
                let base = number(&mut rest).unwrap_or(0.0);
                map.gain = number(&mut rest).unwrap_or(1.0);
                if base != 0.0 {
                    report.instead("the base of `-mm` is not rendered", "the gain alone counts", span);
                }
            }
            "-clamp" => {
                if word(&mut rest) == Some("on") {
                    map.wrap = Wrap::Black;
                }
            }
            "-imfchan" => {
                map.channel = match word(&mut rest) {
                    Some("r") => Some(Channel::Red),
                    Some("g") => Some(Channel::Green),
                    Some("b") => Some(Channel::Blue),
                    Some("m") => Some(Channel::Alpha),
                    _ => None,
                };
            }
            // Of filtering, colour correction and resolution there is nothing to choose here.
            "-blendu" | "-blendv" | "-boost" | "-cc" | "-texres" | "-type" => {
                word(&mut rest);
            }
            // A name may begin so.
            _ => {
                map.file = format!("{option} {rest}").trim().to_owned();
                return Some(map);
            }
        }
    }
    map.file = rest.trim().trim_matches('"').to_owned();
    if map.file.is_empty() {
        report.instead("a texture without a file", "it is left out", span);
        return None;
    }
    Some(map)
}

fn first(rest: &str) -> Option<&str> {
    rest.split_ascii_whitespace().next()
}

fn word<'a>(rest: &mut &'a str) -> Option<&'a str> {
    let word = first(rest)?;
    *rest = rest.trim_start()[word.len()..].trim_start();
    Some(word)
}

/// The next word, if it is a number and something follows it.
fn number(rest: &mut &str) -> Option<f32> {
    let found = first(rest)?.parse::<f32>().ok().filter(|x| x.is_finite())?;
    let before = *rest;
    word(rest);
    if rest.is_empty() {
        // The last word is the file's name, whatever it looks like.
        *rest = before;
        return None;
    }
    Some(found)
}
