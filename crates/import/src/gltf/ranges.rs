//! Values that a file should not have.

use scenefile::desc::{ColorDesc, FloatDesc, Material, MaterialKind, Roughness};

/// Moves the constants of a principled material into the ranges that glTF gives for them. Whether any lay outside.
pub(super) fn kept(material: &mut Material) -> bool {
    let mut moved = false;
    let mut keep = |x: &mut f32| {
        let inside = if x.is_nan() { 0.0 } else { x.clamp(0.0, 1.0) };
        moved |= inside != *x;
        *x = inside;
    };
    if let FloatDesc::Value(x) = &mut material.opacity {
        keep(x);
    }
    material.opacity_cutoff.iter_mut().for_each(&mut keep);
    if let MaterialKind::Principled(m) = &mut material.kind {
        let mut numbers = vec![
            &mut m.metallic,
            &mut m.specular,
            &mut m.transmission,
            &mut m.diffuse_transmission,
            &mut m.sheen_roughness,
            &mut m.clearcoat,
            &mut m.clearcoat_roughness,
            &mut m.film,
        ];
        if let Roughness::Perceived { roughness, .. } = &mut m.roughness {
            numbers.push(roughness);
        }
        for number in numbers {
            if let FloatDesc::Value(x) = number {
                keep(x);
            }
        }
        for color in [&mut m.base_color, &mut m.specular_color, &mut m.sheen_color] {
            if let ColorDesc::Rgb(rgb) = color {
                rgb.iter_mut().for_each(&mut keep);
            }
        }
    }
    moved
}

#[cfg(test)]
mod tests {
    use scenefile::desc::Principled;

    use super::*;

    #[test]
    fn constants_are_kept_in_range() {
        let mut material: Material = Principled {
            base_color: [1.0, 5.0, -0.25].into(),
            metallic: 2.0.into(),
            ..Principled::default()
        }
        .into();
        assert!(kept(&mut material));
        let MaterialKind::Principled(m) = &material.kind else { panic!() };
        assert_eq!((&m.base_color, &m.metallic), (&[1.0, 1.0, 0.0].into(), &1.0.into()));
        assert!(!kept(&mut material), "nothing is left to move");
    }
}
