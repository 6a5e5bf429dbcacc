//! Lights of nodes: `KHR_lights_punctual`. They shine along −z of their nodes.
//!
//! Candela and lux become W/sr and W/m² of each channel by 683 lm a watt, which Blender's exporter multiplies its watts by
//! (and the extension's notes on implementation name): a lamp of Blender comes back as it was. In files of Blender surfaces
//! shine in W/(sr·m²) nevertheless; in others with lamps nits are taken alike, so that both keep their proportions. Without
//! lamps nothing is converted: white that is lit by our own studio and a surface that shines by 1 look alike.

use scenefile::Sourced;
use scenefile::desc::{Light, LightKind, PointAmount};

use super::Importer;
use super::fault::{Fault, Known};
use super::json::Value;
use crate::matrix::{Matrix, narrow, times, unit};

/// Lumens of a watt, as exporters mean it: of green light of 555 nm.
const LUMENS_PER_WATT: f64 = 683.0;

impl<'t> Importer<'t> {
    /// Whether Blender wrote the file.
    pub(super) fn is_of_blender(&self) -> bool {
        let generator =
            self.source.root.get("asset").and_then(|asset| asset.text("generator").ok().flatten());
        generator.is_some_and(|name| name.contains("Blender"))
    }

    /// W/(sr·m²) of a surface that shines by 1.
    pub(super) fn glow(&self) -> Known<f64> {
        let lamps = match self.source.root.extension("KHR_lights_punctual") {
            Some(extension) => extension.array("lights")?,
            None => &[],
        };
        Ok(if lamps.is_empty() || self.is_of_blender() { 1.0 } else { 1.0 / LUMENS_PER_WATT })
    }

    /// Adds the light of a node, if it has one.
    pub(super) fn light(&mut self, node: &'t Value<'t>, world: &Matrix) -> Known<()> {
        let Some(name) = node.extension("KHR_lights_punctual") else { return Ok(()) };
        let all = match self.source.root.extension("KHR_lights_punctual") {
            Some(extension) => extension.array("lights")?,
            None => &[],
        };
        let Some((_, light)) = name.pick("light", "light", all)? else { return Ok(()) };
        let wrong = |text: String| Fault::new("out-of-range", text, light.span());
        let color = light.numbers("color", [1.0; 3])?;
        let strength = light.number("intensity", 1.0)?;
        let amount = times(color, strength / LUMENS_PER_WATT);
        if amount.iter().any(|x| *x < 0.0 || !(*x as f32).is_finite()) {
            return Err(wrong("the light's intensity is not ≥ 0".into()));
        }
        let direction = || {
            unit(world.vector([0.0, 0.0, -1.0])).ok_or_else(|| wrong("the light's node has no extent".into()))
        };
        if let Some(range) = light.get("range") {
            self.report.instead(
                "a light's range does not end it",
                "it falls with the square of the distance",
                range.span(),
            );
        }
        let position = narrow(world.point([0.0; 3]));
        let amount = narrow(amount);
        let kind = match light.text("type")? {
            Some("point") => LightKind::Point { position, amount: PointAmount::Intensity(amount) },
            Some("directional") => {
                LightKind::Directional { direction: narrow(direction()?), irradiance: amount }
            }
            Some("spot") => {
                // Without `spot` all is as by default.
                let cone = light.get("spot").unwrap_or(light);
                let outer = cone.number("outerConeAngle", std::f64::consts::FRAC_PI_4)?;
                let inner = cone.number("innerConeAngle", 0.0)?;
                if !(inner >= 0.0 && outer > inner && outer <= std::f64::consts::PI) {
                    return Err(wrong(format!(
                        "the spot's angles are {inner} and {outer}, not 0 ≤ inner < outer ≤ π/2"
                    )));
                }
                let inner = if self.is_of_blender() { inner_of_blender(inner, outer) } else { inner };
                LightKind::Spot {
                    position,
                    direction: narrow(direction()?),
                    cone_angle: outer.to_degrees() as f32,
                    falloff_angle: (outer - inner).to_degrees() as f32,
                    amount: PointAmount::Intensity(amount),
                }
            }
            other => {
                let text = format!("there is no light `{}`", other.unwrap_or_default());
                return Err(Fault::new("unknown-kind", text, light.span()));
            }
        };
        let wanted =
            [light.name(), node.name()].into_iter().find(|name| !name.is_empty()).unwrap_or_default();
        // Lights have names of their own, but one table serves.
        let name = self.free_name(wanted);
        self.desc.lights.push(Sourced::at(Light { name, light_group: None, kind }, node.span()));
        Ok(())
    }
}

/// Where the edge of a spot of Blender begins to darken. Its exporter writes (1 − blend) · outer; the light itself rises, as
/// ours does, smoothly in the cosine, over blend · (1 − cos outer): so it is measured of Blender 4.5.
fn inner_of_blender(written: f64, outer: f64) -> f64 {
    let blend = 1.0 - written / outer;
    (outer.cos() + blend * (1.0 - outer.cos())).clamp(-1.0, 1.0).acos().min(outer)
}
