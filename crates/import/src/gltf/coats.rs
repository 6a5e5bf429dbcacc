//! What extensions add to a material: transmission, volume, coats, sheen, films, grain.

use scenefile::desc::{Channel, ColorDesc, FloatDesc, Principled, Roughness, Texture};
use scenefile::{Sourced, Span};

use super::Importer;
use super::fault::{Fault, Known};
use super::json::Value;
use crate::matrix::narrow;

/// The least share of light that a colour of attenuation stands for; black would absorb without end.
const DARKEST: f64 = 1e-4;

impl<'t> Importer<'t> {
    /// Adds every extension of a material; the turn of its tangent, in degrees.
    pub(super) fn extended(&mut self, value: &'t Value<'t>, made: &mut Principled) -> Known<f32> {
        self.transmission(value, made)?;
        if let Some(ior) = value.extension("KHR_materials_ior") {
            let index = ior.number("ior", 1.5)?;
            if index != 0.0 && index < 1.0 {
                return Err(Fault::new("out-of-range", format!("the index {index} is not ≥ 1"), ior.span()));
            }
            // 0 asks for a Fresnel term of 1, as that of a very high index.
            made.ior = if index == 0.0 { 1e3 } else { index as f32 }.into();
        }
        if let Some(dispersion) = value.extension("KHR_materials_dispersion")
            && dispersion.number("dispersion", 0.0)? > 0.0
        {
            self.report.instead(
                "dispersion is not rendered",
                "all colours have the same index",
                dispersion.span(),
            );
        }
        if let Some(specular) = value.extension("KHR_materials_specular") {
            let factor = specular.number("specularFactor", 1.0)?;
            made.specular = self.float(factor, specular.get("specularTexture"), Channel::Alpha);
            let color = specular.numbers("specularColorFactor", [1.0; 3])?;
            made.specular_color = self.color(color, specular.get("specularColorTexture"));
        }
        if let Some(coat) = value.extension("KHR_materials_clearcoat") {
            let factor = coat.number("clearcoatFactor", 0.0)?;
            made.clearcoat = self.float(factor, coat.get("clearcoatTexture"), Channel::Red);
            let roughness = coat.number("clearcoatRoughnessFactor", 0.0)?;
            made.clearcoat_roughness =
                self.float(roughness, coat.get("clearcoatRoughnessTexture"), Channel::Green);
            if let Some(normal) = coat.get("clearcoatNormalTexture").filter(|_| factor > 0.0) {
                let text = "normals of a clear coat are not rendered";
                self.report.instead(text, "the coat has those of the base", normal.span());
            }
        }
        if let Some(sheen) = value.extension("KHR_materials_sheen") {
            let color = sheen.numbers("sheenColorFactor", [0.0; 3])?;
            made.sheen_color = self.color(color, sheen.get("sheenColorTexture"));
            let roughness = sheen.number("sheenRoughnessFactor", 0.0)?;
            made.sheen_roughness = self.float(roughness, sheen.get("sheenRoughnessTexture"), Channel::Alpha);
        }
        self.iridescence(value, made)?;
        self.anisotropy(value, made)
    }

    /// Transmission through thin walls, or into a solid where there is a volume of some thickness. Where the mesh ends is
    /// where the solid does: thickness itself is for renderers that do not trace rays.
    fn transmission(&mut self, value: &'t Value<'t>, made: &mut Principled) -> Known<()> {
        if let Some(transmission) = value.extension("KHR_materials_transmission") {
            let factor = transmission.number("transmissionFactor", 0.0)?;
            made.transmission = self.float(factor, transmission.get("transmissionTexture"), Channel::Red);
        }
        made.thin = true;
        if let Some(volume) = value.extension("KHR_materials_volume")
            && volume.number("thicknessFactor", 0.0)? > 0.0
        {
            made.thin = false;
            let color = volume.numbers("attenuationColor", [1.0; 3])?;
            let distance = volume.number("attenuationDistance", f64::INFINITY)?;
            if distance <= 0.0 {
                return Err(Fault::new("out-of-range", "`attenuationDistance` is not > 0", volume.span()));
            }
            // σ = −ln c / d, of a color c that is left after a distance d.
            made.absorption = narrow(color.map(|c| -c.clamp(DARKEST, 1.0).ln() / distance + 0.0));
        }
        if let Some(diffuse) = value.extension("KHR_materials_diffuse_transmission") {
            let factor = diffuse.number("diffuseTransmissionFactor", 0.0)?;
            made.diffuse_transmission =
                self.float(factor, diffuse.get("diffuseTransmissionTexture"), Channel::Alpha);
            let color = diffuse.numbers("diffuseTransmissionColorFactor", [1.0; 3])?;
            let texture = diffuse.get("diffuseTransmissionColorTexture");
            if factor > 0.0 && self.color(color, texture) != made.base_color {
                let text = "a colour of its own for diffuse transmission is not rendered";
                self.report.instead(text, "the base colour takes its place", diffuse.span());
            }
        }
        Ok(())
    }

    fn iridescence(&mut self, value: &'t Value<'t>, made: &mut Principled) -> Known<()> {
        let Some(film) = value.extension("KHR_materials_iridescence") else { return Ok(()) };
        let factor = film.number("iridescenceFactor", 0.0)?;
        made.film = self.float(factor, film.get("iridescenceTexture"), Channel::Red);
        made.film_ior = film.number("iridescenceIor", 1.3)? as f32;
        let most = film.number("iridescenceThicknessMaximum", 400.0)?;
        let least = film.number("iridescenceThicknessMinimum", 100.0)?;
        let texture = film.get("iridescenceThicknessTexture");
        made.film_thickness_nm = match texture {
            None => FloatDesc::Value(most as f32),
            Some(_) => {
                let share = self.float(1.0, texture, Channel::Green);
                self.float_mix(
                    FloatDesc::Value(least as f32),
                    FloatDesc::Value(most as f32),
                    share,
                    film.span(),
                )
            }
        };
        Ok(())
    }

    /// `KHR_materials_anisotropy`: along the grain α is mix(α, 1, strength²), across it α.
    fn anisotropy(&mut self, value: &'t Value<'t>, made: &mut Principled) -> Known<f32> {
        let Some(grain) = value.extension("KHR_materials_anisotropy") else { return Ok(0.0) };
        let factor = grain.number("anisotropyStrength", 0.0)?;
        let Roughness::Perceived { roughness, .. } = made.roughness.clone() else { return Ok(0.0) };
        if factor == 0.0 {
            return Ok(0.0);
        }
        let span = grain.span();
        let texture = grain.get("anisotropyTexture");
        if let Some(texture) = texture {
            let text = "the directions of an anisotropy texture are not rendered";
            self.report.instead(
                text,
                "the grain follows the texture coordinates and `anisotropyRotation`",
                texture.span(),
            );
        }
        let strength = self.float(factor, texture, Channel::Blue);
        let share = self.float_product(strength.clone(), strength, span);
        let across = self.float_product(roughness.clone(), roughness, span);
        let along = self.float_mix(across.clone(), FloatDesc::Value(1.0), share, span);
        made.roughness = Roughness::Alpha { along, across };
        Ok(grain.number("anisotropyRotation", 0.0)?.to_degrees() as f32)
    }

    /// `KHR_materials_pbrSpecularGlossiness`, which is superseded: a dielectric whose index gives the greatest reflectance at
    /// normal incidence, or metal where that is more than dielectrics have.
    pub(super) fn glossiness(&mut self, gloss: &'t Value<'t>, made: &mut Principled) -> Known<()> {
        let span = gloss.span();
        self.report.instead(
            "specular and glossiness are not rendered as such",
            "metal and roughness near them are",
            span,
        );
        let specular = gloss.numbers("specularFactor", [1.0; 3])?;
        let texture = gloss.get("specularGlossinessTexture");
        let gloss = gloss.number("glossinessFactor", 1.0)?;
        made.roughness = self.rough(gloss, texture, span).into();
        let most = specular.iter().copied().fold(0.0, f64::max);
        // Dielectrics reflect 4 %, metals at least half.
        let metal = ((most - 0.04) / (0.5 - 0.04)).clamp(0.0, 1.0);
        match texture {
            None if metal > 0.5 => {
                made.metallic = 1.0.into();
                made.base_color = ColorDesc::Rgb(specular.map(|x| x as f32));
            }
            None if most > 0.0 => {
                let root = most.min(0.3).sqrt();
                made.ior = (((1.0 + root) / (1.0 - root)) as f32).into();
                made.specular_color = ColorDesc::Rgb(specular.map(|x| (x / most) as f32));
            }
            None => made.specular = 0.0.into(),
            Some(_) => {}
        }
        Ok(())
    }

    /// 1 − glossiness.
    fn rough(&mut self, gloss: f64, texture: Option<&'t Value<'t>>, span: Span) -> FloatDesc {
        let share = self.float(gloss, texture, Channel::Alpha);
        match share {
            FloatDesc::Value(gloss) => FloatDesc::Value(1.0 - gloss),
            share => {
                let mix = Texture::Mix { a: 1.0.into(), b: 0.0.into(), amount: share };
                FloatDesc::Texture(Sourced::at(self.add_texture(mix, span), span))
            }
        }
    }
}
