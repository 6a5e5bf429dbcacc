//! Media: as far as they absorb within glass.

use scenefile::Span;

use super::Importer;
use super::params::Params;
use super::parser::Parsed;
use super::soft::MILK;
use crate::matrix::narrow;

/// What is rendered of a medium.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Filling {
    /// Per unit of length.
    pub absorption: [f32; 3],
    /// Whether it was said that the rest is not rendered.
    is_said: bool,
}

impl Importer {
    pub(super) fn named_medium(&mut self, span: Span) -> Parsed<()> {
        let (name, _) = self.string("MakeNamedMedium", span)?;
        let params = self.params(format!("the medium `{name}`"), span, Some(super::state::Target::Medium))?;
        let absorption = self.absorption(&params, span);
        self.media.insert(name, absorption);
        Ok(())
    }

    /// What a homogeneous medium absorbs; what it scatters is lost.
    fn absorption(&mut self, params: &Params, span: Span) -> Option<Filling> {
        if params.text("type") != Some("homogeneous") || params.any("preset").is_some() {
            let text = "participating media are not rendered";
            self.report.instead(text, "light crosses them as if they were empty", span);
            return None;
        }
        let scale = params.number_or("scale", 1.0);
        let mut of = |name: &str, default| self.channels(params, name).unwrap_or(default);
        let (absorbed, scattered) = (of("sigma_a", MILK[0]), of("sigma_s", MILK[1]));
        let is_said = scattered.iter().any(|s| *s > 0.0) || params.any("Le").is_some();
        if is_said {
            let text = "media that scatter light are not rendered";
            self.report.instead(text, "within glass they absorb, elsewhere light crosses them freely", span);
        }
        Some(Filling { absorption: narrow(absorbed.map(|a| (a * scale).max(0.0))), is_said })
    }

    pub(super) fn medium_interface(&mut self, span: Span) -> Parsed<()> {
        let (inside, at) = self.string("MediumInterface", span)?;
        // A single name stands for inside and outside.
        let mut outside = inside.clone();
        if matches!(self.peek(), Some((super::lexer::Token::Text, _))) {
            outside = self.string("MediumInterface", span)?.0;
        }
        // What surrounds the camera or lies between surfaces of no glass is empty space here.
        let absorbs = |this: &Self, name: &str| this.media.get(name).copied().flatten();
        if let Some(filling) = absorbs(self, &outside) {
            self.outside_of_glass(filling, at);
        }
        self.graphics.interior = absorbs(self, &inside).filter(|f| f.absorption != [0.0; 3]);
        Ok(())
    }

    /// Says that a medium is not rendered, unless that was said of all that scatters.
    pub(super) fn outside_of_glass(&mut self, filling: Filling, at: Span) {
        if !filling.is_said && filling.absorption != [0.0; 3] {
            let text = "a medium outside of glass is not rendered";
            self.report.instead(text, "light crosses it as if it were empty", at);
        }
    }
}
