//! A drawing as SVG: its own light background, so that it is readable on dark pages too, and numbers of one digit behind
//! the point, so that it has the same bytes everywhere.

use std::fmt::Write as _;

/// A place in pixels, x to the right, y down.
pub type Point = [f64; 2];

pub const INK: &str = "#2b2b2b";
pub const FAINT: &str = "#767676";
pub const CAMERA: &str = "#1a5fb4";
pub const LIGHT: &str = "#c64600";
pub const GREEN: &str = "#26744a";
pub const VIOLET: &str = "#813d9c";
pub const GLASS: &str = "#8fc3e8";
const PAPER: &str = "#fbfaf6";

/// How a shape is drawn.
#[derive(Clone, Copy)]
pub struct Ink {
    line: &'static str,
    width: f64,
    fill: &'static str,
    fill_opacity: f64,
    dashed: bool,
}

impl Ink {
    pub const fn line(color: &'static str) -> Self {
        Self { line: color, width: 1.5, fill: "none", fill_opacity: 1.0, dashed: false }
    }

    pub const fn fill(color: &'static str) -> Self {
        Self { line: "none", fill: color, ..Self::line(color) }
    }

    pub const fn wide(self, width: f64) -> Self {
        Self { width, ..self }
    }

    pub const fn dashed(self) -> Self {
        Self { dashed: true, ..self }
    }

    /// Filled with a colour of this opacity, 0 to 1.
    pub const fn filled(self, fill: &'static str, fill_opacity: f64) -> Self {
        Self { fill, fill_opacity, ..self }
    }
}

/// Where a label stands from its point.
#[derive(Clone, Copy)]
pub enum Anchor {
    Start,
    Middle,
    End,
}

/// How a label is set.
#[derive(Clone, Copy)]
pub struct Text {
    size: f64,
    color: &'static str,
    anchor: Anchor,
    bold: bool,
}

/// A label of the usual size that starts at its point.
pub const LABEL: Text = Text { size: 14.0, color: INK, anchor: Anchor::Start, bold: false };

impl Text {
    pub const fn color(self, color: &'static str) -> Self {
        Self { color, ..self }
    }

    pub const fn middle(self) -> Self {
        Self { anchor: Anchor::Middle, ..self }
    }

    pub const fn end(self) -> Self {
        Self { anchor: Anchor::End, ..self }
    }

    pub const fn bold(self) -> Self {
        Self { bold: true, size: 15.0, ..self }
    }
}

/// The room that a label takes.
#[cfg_attr(not(test), expect(dead_code, reason = "a test reads it"))]
struct Room {
    text: String,
    min: Point,
    max: Point,
}

pub struct Canvas {
    size: Point,
    title: &'static str,
    body: String,
    /// For the test that no label lies over another.
    rooms: Vec<Room>,
}

impl Canvas {
    /// An empty drawing; the title is what it shows, for those who cannot see it.
    pub fn new(size: Point, title: &'static str) -> Self {
        Self { size, title, body: String::new(), rooms: Vec::new() }
    }

    pub fn path(&mut self, points: &[Point], ink: Ink) {
        self.shape("polyline", &format!("points=\"{}\"", joined(points)), ink);
    }

    pub fn polygon(&mut self, points: &[Point], ink: Ink) {
        self.shape("polygon", &format!("points=\"{}\"", joined(points)), ink);
    }

    pub fn circle(&mut self, center: Point, radius: f64, ink: Ink) {
        self.ellipse(center, [radius; 2], ink);
    }

    pub fn ellipse(&mut self, [x, y]: Point, [rx, ry]: Point, ink: Ink) {
        let place =
            format!("cx=\"{}\" cy=\"{}\" rx=\"{}\" ry=\"{}\"", number(x), number(y), number(rx), number(ry));
        self.shape("ellipse", &place, ink);
    }

    pub fn rect(&mut self, [x, y]: Point, [width, height]: Point, ink: Ink) {
        self.polygon(&[[x, y], [x + width, y], [x + width, y + height], [x, y + height]], ink);
    }

    /// A path with a head at its end.
    pub fn arrow(&mut self, points: &[Point], ink: Ink) {
        let [.., from, to] = *points else { return };
        let [x, y] = [to[0] - from[0], to[1] - from[1]];
        let length = x.hypot(y);
        let [x, y] = [x / length, y / length];
        let at = |along: f64, across: f64| [to[0] - along * x - across * y, to[1] - along * y + across * x];
        let (head, half) = (4.0 + 3.0 * ink.width, 1.5 + 1.5 * ink.width);
        let mut line = points.to_vec();
        if let Some(end) = line.last_mut() {
            *end = at(0.6 * head, 0.0);
        }
        self.path(&line, ink);
        self.polygon(&[to, at(head, half), at(head, -half)], Ink::fill(ink.line));
    }

    /// A line of text; `at` is on its base line.
    pub fn text(&mut self, at: Point, text: &str, style: Text) {
        let (anchor, share) = match style.anchor {
            Anchor::Start => ("start", 0.0),
            Anchor::Middle => ("middle", 0.5),
            Anchor::End => ("end", 1.0),
        };
        let weight = if style.bold { " font-weight=\"bold\"" } else { "" };
        let [x, y] = at;
        let shown = text.replace('&', "&amp;").replace('<', "&lt;");
        let _ = writeln!(
            self.body,
            "<text x=\"{}\" y=\"{}\" font-size=\"{}\" text-anchor=\"{anchor}\" fill=\"{}\"{weight}>{shown}</text>",
            number(x),
            number(y),
            number(style.size),
            style.color,
        );
        let each = if style.bold { 0.62 } else { 0.56 };
        let width = each * style.size * text.chars().count() as f64;
        let left = x - share * width;
        let room = Room {
            text: text.into(),
            min: [left, y - 0.75 * style.size],
            max: [left + width, y + 0.2 * style.size],
        };
        self.rooms.push(room);
    }

    /// Labels that overlap, or lie beyond the border.
    #[cfg(test)]
    pub fn collisions(&self) -> Vec<String> {
        let mut found = Vec::new();
        for (i, a) in self.rooms.iter().enumerate() {
            let [width, height] = self.size;
            if a.min[0] < 4.0 || a.min[1] < 4.0 || a.max[0] > width - 4.0 || a.max[1] > height - 4.0 {
                found.push(format!("`{}` leaves the drawing", a.text));
            }
            for b in &self.rooms[..i] {
                if (0..2).all(|axis| a.min[axis] < b.max[axis] && b.min[axis] < a.max[axis]) {
                    found.push(format!("`{}` lies over `{}`", a.text, b.text));
                }
            }
        }
        found
    }

    /// The text of the file.
    pub fn finish(&self) -> String {
        let [width, height] = self.size.map(number);
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" \
             font-family=\"Helvetica, Arial, 'DejaVu Sans', sans-serif\">\n<title>{}</title>\n\
             <rect width=\"{width}\" height=\"{height}\" rx=\"8\" fill=\"{PAPER}\"/>\n{}</svg>\n",
            self.title, self.body
        )
    }

    fn shape(&mut self, name: &str, place: &str, ink: Ink) {
        let mut style = format!(" fill=\"{}\"", ink.fill);
        if ink.fill_opacity < 1.0 {
            let _ = write!(style, " fill-opacity=\"{}\"", ink.fill_opacity);
        }
        if ink.line != "none" {
            let _ = write!(style, " stroke=\"{}\" stroke-width=\"{}\"", ink.line, number(ink.width));
            style.push_str(" stroke-linejoin=\"round\" stroke-linecap=\"round\"");
        }
        if ink.dashed {
            style.push_str(" stroke-dasharray=\"5 4\"");
        }
        let _ = writeln!(self.body, "<{name} {place}{style}/>");
    }
}

fn joined(points: &[Point]) -> String {
    let pair = |&[x, y]: &Point| format!("{},{}", number(x), number(y));
    points.iter().map(pair).collect::<Vec<_>>().join(" ")
}

/// With one digit behind the point, or none.
fn number(x: f64) -> String {
    let tenths = (10.0 * x).round() as i64;
    let sign = if tenths < 0 { "-" } else { "" };
    let tenths = tenths.abs();
    if tenths % 10 == 0 {
        format!("{sign}{}", tenths / 10)
    } else {
        format!("{sign}{}.{}", tenths / 10, tenths % 10)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_one_digit() {
        assert_eq!([3.0, -0.04, -0.26, 12.34].map(number), ["3", "0", "-0.3", "12.3"]);
    }

    #[test]
    fn labels_that_overlap_are_found() {
        let mut canvas = Canvas::new([200.0, 50.0], "");
        canvas.text([10.0, 30.0], "one", LABEL);
        canvas.text([60.0, 30.0], "two", LABEL);
        assert!(canvas.collisions().is_empty());
        canvas.text([30.0, 32.0], "three", LABEL);
        canvas.text([190.0, 30.0], "four", LABEL);
        assert_eq!(
            canvas.collisions(),
            ["`three` lies over `one`", "`three` lies over `two`", "`four` leaves the drawing"]
        );
    }
}
