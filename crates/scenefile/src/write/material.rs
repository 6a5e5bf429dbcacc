//! Textures and materials.

use super::value::{Fields, number, triple};
use crate::desc::{
    Channel, ColorSpace, Facets, Image, Mapping, Material, MaterialKind, Metal, NoiseKind, Principled,
    Roughness, Texture, TextureFilter, ThinFilm, Triple, Wrap,
};
use crate::spec;

pub(super) fn texture_fields(texture: &Texture) -> Fields {
    let new = |kind| Fields::new(&spec::TEXTURES, Some(kind));
    match texture {
        Texture::Image(image) => image_fields(image),
        Texture::Checker { a, b, mapping: m } => {
            let mut f = new("checker");
            f.color("a", a);
            f.color("b", b);
            mapping(&mut f, m);
            f
        }
        Texture::Dots { inside, outside, mapping: m } => {
            let mut f = new("dots");
            f.color("inside", inside);
            f.color("outside", outside);
            mapping(&mut f, m);
            f
        }
        Texture::Product { a, b } => {
            let mut f = new("product");
            f.color("a", a);
            f.color("b", b);
            f
        }
        Texture::Mix { a, b, amount } => {
            let mut f = new("mix");
            f.color("a", a);
            f.color("b", b);
            f.float("amount", amount);
            f
        }
        Texture::Noise(noise) => {
            let mut f = new(match noise.kind {
                NoiseKind::Fbm => "fbm",
                NoiseKind::Wrinkled => "wrinkled",
                NoiseKind::Windy => "windy",
                NoiseKind::Marble { .. } => "marble",
            });
            if noise.kind != NoiseKind::Windy {
                f.integer("octaves", noise.octaves);
                f.number("roughness", noise.roughness);
            }
            if let NoiseKind::Marble { scale, variation } = noise.kind {
                f.number("scale", scale);
                f.number("variation", variation);
            }
            super::transform(&mut f, &noise.transform);
            f
        }
        Texture::VertexColor { channel: c } => {
            let mut f = new("vertex-color");
            channel(&mut f, *c);
            f
        }
    }
}

fn image_fields(image: &Image) -> Fields {
    let mut f = Fields::new(&spec::TEXTURES, Some("image"));
    f.text("file", &image.source.written());
    f.word(
        "color_space",
        match image.color_space {
            ColorSpace::Srgb => "srgb",
            ColorSpace::Linear => "linear",
        },
    );
    let wrap = |wrap| match wrap {
        Wrap::Repeat => "repeat",
        Wrap::Clamp => "clamp",
        Wrap::Mirror => "mirror",
        Wrap::Black => "black",
    };
    let [u, v] = image.wrap;
    f.word("wrap", wrap(u));
    if v != u {
        f.word("wrap_v", wrap(v));
    }
    f.word(
        "filter",
        match image.filter {
            TextureFilter::Trilinear => "trilinear",
            TextureFilter::Bilinear => "bilinear",
            TextureFilter::Nearest => "nearest",
        },
    );
    mapping(&mut f, &image.mapping);
    channel(&mut f, image.channel);
    f.bool("invert", image.invert);
    f.color("factor", &image.factor.into());
    f
}

fn mapping(f: &mut Fields, mapping: &Mapping) {
    match mapping {
        Mapping::Uv { set, scale, rotation, offset } => {
            f.integer("uv_set", *set);
            f.factor_pair("scale", *scale);
            f.number("rotation", *rotation);
            f.pair("offset", offset.map(number));
        }
        Mapping::Planar { u, v, offset } => {
            f.raw("planar_u", triple(*u));
            f.raw("planar_v", triple(*v));
            f.pair("offset", offset.map(number));
        }
    }
}

fn channel(f: &mut Fields, channel: Channel) {
    f.word(
        "channel",
        match channel {
            Channel::Rgb => "rgb",
            Channel::Red => "r",
            Channel::Green => "g",
            Channel::Blue => "b",
            Channel::Alpha => "a",
        },
    );
}

pub(super) fn material_fields(material: &Material) -> Fields {
    let mut f = Fields::new(&spec::MATERIALS, Some(material.kind.name()));
    kind_fields(&mut f, &material.kind);
    if let Some(name) = &material.normal_map {
        f.text("normal_map", name);
    }
    f.float("opacity", &material.opacity);
    f.optional_number("opacity_cutoff", material.opacity_cutoff);
    f.number("normal_strength", material.normal_strength);
    if let Some(name) = &material.bump_map {
        f.text("bump_map", name);
    }
    f.number("bump_height", material.bump_height);
    f.float("rotation", &material.rotation);
    if material.kind.has_two_sided() {
        f.bool("two_sided", material.two_sided);
    }
    f
}

fn kind_fields(f: &mut Fields, kind: &MaterialKind) {
    match kind {
        MaterialKind::Diffuse { color } | MaterialKind::Mirror { color } => f.color("color", color),
        MaterialKind::Phong { diffuse, specular, exponent } => {
            f.color("diffuse", diffuse);
            f.color("specular", specular);
            f.float("exponent", exponent);
        }
        MaterialKind::Dielectric(m) => {
            f.ior("ior", &m.ior);
            f.optional_number("outside_ior", m.outside_ior);
            f.color("color", &m.color);
            f.color("specular", &m.specular);
            roughness(f, &m.roughness);
            facets(f, m.facets);
            film(f, &m.film);
            absorption(f, m.absorption);
            f.integer("priority", m.priority);
        }
        MaterialKind::Conductor(m) => {
            metal(f, &m.metal);
            f.color("specular", &m.specular);
            roughness(f, &m.roughness);
            facets(f, m.facets);
            film(f, &m.film);
        }
        MaterialKind::Plastic { color, ior, roughness: r } => {
            f.color("color", color);
            f.ior("ior", ior);
            roughness(f, r);
        }
        MaterialKind::RoughDiffuse { color, roughness } | MaterialKind::Sheen { color, roughness } => {
            f.color("color", color);
            f.float("roughness", roughness);
        }
        MaterialKind::DiffuseTransmission { reflectance, transmittance } => {
            f.color("reflectance", reflectance);
            f.color("transmittance", transmittance);
        }
        MaterialKind::ThinDielectric(m) => {
            f.ior("ior", &m.ior);
            f.color("color", &m.color);
            f.color("specular", &m.specular);
            roughness(f, &m.roughness);
        }
        MaterialKind::CoatedDiffuse(m) => {
            f.color("color", &m.color);
            f.color("specular", &m.specular);
            f.ior("ior", &m.ior);
            roughness(f, &m.roughness);
            facets(f, m.facets);
            f.bool("nonlinear", m.nonlinear);
            f.number("depth", m.depth);
        }
        MaterialKind::CoatedConductor(m) => {
            metal(f, &m.metal);
            roughness(f, &m.roughness);
            f.ior("ior", &m.ior);
            f.float("coat_roughness", &m.coat_roughness);
            f.number("depth", m.depth);
            facets(f, m.facets);
        }
        MaterialKind::Principled(m) => principled(f, m),
        MaterialKind::Mix { a, b, amount } => {
            super::material_at(f, "a", a);
            super::material_at(f, "b", b);
            f.float("amount", amount);
        }
    }
}

fn principled(f: &mut Fields, m: &Principled) {
    f.color("base_color", &m.base_color);
    f.float("metallic", &m.metallic);
    roughness(f, &m.roughness);
    f.ior("ior", &m.ior);
    f.float("specular", &m.specular);
    f.color("specular_color", &m.specular_color);
    f.float("transmission", &m.transmission);
    f.bool("thin", m.thin);
    f.float("diffuse_transmission", &m.diffuse_transmission);
    f.color("sheen_color", &m.sheen_color);
    f.float("sheen_roughness", &m.sheen_roughness);
    f.float("clearcoat", &m.clearcoat);
    f.float("clearcoat_roughness", &m.clearcoat_roughness);
    f.float("film", &m.film);
    f.float("film_thickness", &m.film_thickness_nm);
    f.number("film_ior", m.film_ior);
    absorption(f, m.absorption);
    f.integer("priority", m.priority);
}

fn metal(f: &mut Fields, metal: &Metal) {
    match metal {
        Metal::Named(name) => f.text("metal", name),
        Metal::Index { n, k } => {
            f.triple("n", *n);
            f.triple("k", *k);
        }
    }
}

fn roughness(f: &mut Fields, roughness: &Roughness) {
    match roughness {
        Roughness::Perceived { roughness, anisotropy } => {
            f.float("roughness", roughness);
            f.float("anisotropy", anisotropy);
        }
        Roughness::Alpha { along, across } => {
            f.float("alpha", along);
            if across != along {
                f.float("alpha_across", across);
            }
        }
    }
}

fn facets(f: &mut Fields, facets: Facets) {
    f.word(
        "facets",
        match facets {
            Facets::Conserving => "conserving",
            Facets::SingleBounce => "single-bounce",
            Facets::Separable => "separable",
            Facets::Beckmann => "beckmann",
        },
    );
}

fn film(f: &mut Fields, film: &ThinFilm) {
    f.number("film_thickness", film.thickness_nm);
    f.number("film_ior", film.ior);
}

fn absorption(f: &mut Fields, absorption: Triple) {
    f.color("absorption", &absorption.into());
}
