//! Media: only what they absorb, where they do not scatter.

use scenefile::desc::Triple;

use super::Importer;
use super::plugin::{Plugin, Tag, Value};

impl Importer {
    /// What the inside of a shape absorbs, per unit of length; media that are more than that are said to be left out.
    pub(super) fn media(&mut self, plugin: &Plugin) -> Triple {
        let mut absorption = [0.0; 3];
        for param in &plugin.params {
            let id = match &param.value {
                Value::Plugin(p) if p.tag == Tag::Medium => true,
                Value::Reference(id) => self.ids.get(id).is_some_and(|p| p.tag == Tag::Medium),
                _ => false,
            };
            if !id {
                continue;
            }
            param.mark();
            let Some(medium) = self.resolve(param) else { continue };
            match self.absorption(&medium) {
                Some(sigma) if param.name == "interior" => absorption = sigma,
                // What lies outside of one shape lies inside of another, or in the room.
                _ if param.name == "exterior" && self.absorption(&medium).is_some() => {}
                _ => {
                    let text = format!("{} is not rendered", medium.what());
                    self.report.instead(text, "the space is clear", medium.span);
                }
            }
        }
        absorption
    }

    /// The absorption of a medium that does nothing else; `None` of others.
    fn absorption(&mut self, medium: &Plugin) -> Option<Triple> {
        if medium.kind != "homogeneous" {
            return None;
        }
        medium.params.iter().for_each(|p| p.mark());
        let scale = medium.number_or(&mut self.report, "scale", 1.0);
        let [total, albedo, absorbed, scattered] =
            ["sigma_t", "albedo", "sigma_a", "sigma_s"].map(|name| self.channels(medium, name));
        let sigma = match (total, absorbed) {
            (Some(total), _) if albedo == Some([0.0; 3]) => total,
            (_, Some(absorbed)) if scattered == Some([0.0; 3]) => absorbed,
            _ => return None,
        };
        let sigma = sigma.map(|s| (s * scale) as f32);
        sigma.iter().all(|s| *s >= 0.0 && s.is_finite()).then_some(sigma)
    }
}
