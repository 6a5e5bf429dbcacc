//! Materials (glTF 2.0 §3.9): metal and roughness, alpha, emission. What extensions add is in [`coats`](super::coats).

use scenefile::desc::{
    Channel, ColorDesc, ColorSpace, Emission, EmissionAmount, FloatDesc, Material, MaterialKind, Principled,
    Roughness, Texture,
};
use scenefile::{Sourced, Span};

use super::Importer;
use super::fault::{Fault, Known};
use super::json::Value;
use super::textures::Reading;
use crate::names::free_name;

/// What a surface is made of, and the light it gives.
#[derive(Clone, Debug, Default)]
pub(super) struct Surface {
    /// A key of the description's materials.
    pub material: Option<String>,
    pub emission: Option<Emission>,
}

/// How much of a surface is there (§3.9.4).
enum Alpha {
    Opaque,
    Mask(f64),
    Blend,
}

impl<'t> Importer<'t> {
    /// The surface of a material; without a number the default one. `colored`: vertices have colours, which are factors.
    pub(super) fn surface(&mut self, material: Option<usize>, colored: bool) -> Surface {
        if let Some(known) = self.surfaces.get(&(material, colored)) {
            return known.clone();
        }
        let made = match material.and_then(|i| self.list("materials").ok()?.get(i)) {
            Some(value) => {
                let made = self.material(value, colored);
                self.told(made).unwrap_or_default()
            }
            None => {
                // §3.9.1: metallic and rough.
                let mut plain = Principled {
                    metallic: 1.0.into(),
                    roughness: 1.0.into(),
                    base_color: 1.0.into(),
                    ..Principled::default()
                };
                if colored {
                    plain.base_color = self.vertex_color(Channel::Rgb, super::WHOLE);
                }
                Surface {
                    material: Some(self.add_material("default", plain.into(), super::WHOLE)),
                    emission: None,
                }
            }
        };
        self.surfaces.insert((material, colored), made.clone());
        made
    }

    fn add_material(&mut self, wanted: &str, material: Material, span: Span) -> String {
        let mut material = material;
        if super::ranges::kept(&mut material) {
            let text = "a material has a value outside of its range";
            self.report.instead(text, "it is moved to the range's end", span);
        }
        let key = free_name(&self.desc.materials, if wanted.is_empty() { "material" } else { wanted });
        self.desc.materials.insert(key.clone(), Sourced::at(material, span));
        key
    }

    fn vertex_color(&mut self, channel: Channel, span: Span) -> ColorDesc {
        ColorDesc::Texture(Sourced::at(self.add_texture(Texture::VertexColor { channel }, span), span))
    }

    fn material(&mut self, value: &'t Value<'t>, colored: bool) -> Known<Surface> {
        let span = value.span();
        let gloss = value.extension("KHR_materials_pbrSpecularGlossiness");
        let (base, keys) = match (gloss, value.get("pbrMetallicRoughness")) {
            (Some(gloss), _) => (Some(gloss), ["diffuseFactor", "diffuseTexture"]),
            (None, base) => (base, ["baseColorFactor", "baseColorTexture"]),
        };
        let factor = base.map_or(Ok([1.0; 4]), |base| base.numbers(keys[0], [1.0; 4]))?;
        let texture = base.and_then(|base| base.get(keys[1]));
        let mut color = self.color([factor[0], factor[1], factor[2]], texture);
        if colored {
            let vertex = self.vertex_color(Channel::Rgb, span);
            color = self.product(color, vertex, span);
        }
        let alpha = alpha(value)?;
        let mut emission = self.emission(value)?;
        let two_sided = value.truth("doubleSided", false)?;
        let mut made: Material = if value.extension("KHR_materials_unlit").is_some() {
            let (amount, texture) = match &color {
                ColorDesc::Rgb(rgb) => (*rgb, None),
                ColorDesc::Texture(name) => ([1.0; 3], Some(name.clone())),
            };
            let glow = self.glow()?;
            let amount = amount.map(|x| (f64::from(x) * glow) as f32);
            emission = Some(Emission { amount: EmissionAmount::Radiance(amount), texture, two_sided });
            MaterialKind::Diffuse { color: 0.0.into() }.into()
        } else {
            let mut principled = Principled { base_color: color, ..Principled::default() };
            match gloss {
                Some(gloss) => self.glossiness(gloss, &mut principled)?,
                None => self.metal(base, &mut principled)?,
            }
            let rotation = self.extended(value, &mut principled)?;
            Material { rotation: rotation.into(), ..principled.into() }
        };
        if let Some(info) = value.get("normalTexture") {
            let reading = Reading { space: ColorSpace::Linear, ..Reading::color([1.0; 3]) };
            made.normal_map = self.texture(info, reading);
            made.normal_strength = info.number("scale", 1.0)? as f32;
        }
        if !matches!(alpha, Alpha::Opaque) {
            let mut opacity = self.float(factor[3], texture, Channel::Alpha);
            if colored {
                let vertex = self.vertex_color(Channel::Alpha, span);
                opacity = self.float_product(opacity, super::textures::as_float(vertex), span);
            }
            if emission.is_some() && opacity != FloatDesc::Value(1.0) {
                let text = "the transparency of a surface that shines is not rendered";
                self.report.instead(text, "it is opaque", span);
            }
            made.opacity = opacity;
            if let Alpha::Mask(cutoff) = alpha {
                made.opacity_cutoff = Some(cutoff as f32);
            }
        }
        if let Some(emission) = &mut emission {
            emission.two_sided = two_sided;
        }
        Ok(Surface { material: Some(self.add_material(value.name(), made, span)), emission })
    }

    /// §3.9.2: the roughness is in the green channel, the metal in the blue one; α is the square of the roughness.
    fn metal(&mut self, base: Option<&'t Value<'t>>, principled: &mut Principled) -> Known<()> {
        let number = |key: &str| base.map_or(Ok(1.0), |base| base.number(key, 1.0));
        let texture = base.and_then(|base| base.get("metallicRoughnessTexture"));
        principled.metallic = self.float(number("metallicFactor")?, texture, Channel::Blue);
        let roughness = self.float(number("roughnessFactor")?, texture, Channel::Green);
        principled.roughness = Roughness::from(roughness);
        Ok(())
    }

    /// `emissiveFactor`, `emissiveTexture` and `KHR_materials_emissive_strength`; see [`glow`](Self::glow).
    fn emission(&mut self, value: &'t Value<'t>) -> Known<Option<Emission>> {
        let strength = match value.extension("KHR_materials_emissive_strength") {
            Some(extension) => extension.number("emissiveStrength", 1.0)?,
            None => 1.0,
        };
        let factor = value.numbers("emissiveFactor", [0.0; 3])?.map(|x| (x * strength) as f32);
        if factor.iter().any(|x| *x < 0.0 || !x.is_finite()) {
            return Err(Fault::new("out-of-range", "the emission is not ≥ 0", value.span()));
        }
        if factor == [0.0; 3] {
            return Ok(None);
        }
        self.shines |= factor.iter().any(|x| *x > 1.0);
        let glow = self.glow()?;
        let radiance = factor.map(|x| (f64::from(x) * glow) as f32);
        let texture =
            value.get("emissiveTexture").and_then(|info| self.texture(info, Reading::color([1.0; 3])));
        Ok(Some(Emission { amount: EmissionAmount::Radiance(radiance), texture, two_sided: false }))
    }
}

fn alpha(value: &Value<'_>) -> Known<Alpha> {
    match value.text("alphaMode")? {
        None | Some("OPAQUE") => Ok(Alpha::Opaque),
        Some("MASK") => Ok(Alpha::Mask(value.number("alphaCutoff", 0.5)?)),
        Some("BLEND") => Ok(Alpha::Blend),
        Some(other) => {
            Err(Fault::new("unknown-kind", format!("there is no alpha mode `{other}`"), value.span()))
        }
    }
}
