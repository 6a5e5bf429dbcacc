//! What a file says to use.

use super::Importer;
use super::fault::Known;

/// Extensions that are read, where they are met.
const READ: &[&str] = &[
    "EXT_mesh_gpu_instancing",
    "EXT_texture_webp",
    "KHR_lights_punctual",
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_diffuse_transmission",
    "KHR_materials_dispersion",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_iridescence",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    "KHR_node_visibility",
    "KHR_texture_transform",
];

/// Extensions that change no picture at rest, or of which it is said where they are met that they are not read.
const NO_PICTURE: &[&str] = &[
    "EXT_meshopt_compression",
    "KHR_animation_pointer",
    "KHR_draco_mesh_compression",
    "KHR_materials_variants",
    "KHR_meshopt_compression",
    "KHR_texture_basisu",
    "KHR_xmp",
    "KHR_xmp_json_ld",
    "MSFT_texture_dds",
];

impl Importer<'_> {
    /// Says what is not known of the extensions that the file uses, and what else is not rendered of the whole file.
    pub(super) fn extensions(&mut self) -> Known<()> {
        let known = |name: &str| READ.contains(&name) || NO_PICTURE.contains(&name);
        let required = self.list("extensionsRequired")?;
        for value in required {
            let Some(name) = value.as_text() else { continue };
            if !known(name) {
                let text = format!("the file requires the extension `{name}`, which is not known");
                self.report.instead(text, "what it says is left out", value.span());
            }
        }
        for value in self.list("extensionsUsed")? {
            let Some(name) = value.as_text() else { continue };
            if !known(name) && !required.iter().any(|r| r.as_text() == Some(name)) {
                let text = format!("the extension `{name}` is not known");
                self.report.instead(text, "what it says is left out", value.span());
            }
        }
        if let Some(first) = self.list("animations")?.first() {
            self.report.instead("animations are not played", "all stands as without them", first.span());
        }
        if let Some(variants) = self.source.root.extension("KHR_materials_variants") {
            let text = "variants of materials cannot be chosen";
            self.report.instead(text, "the default materials are rendered", variants.span());
        }
        Ok(())
    }
}
