//! Roughness of facets.

use scenefile::desc::{FloatDesc, Roughness};

use super::Importer;
use super::params::Params;

/// How a version makes the α of facets from its `roughness`.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Remap {
    /// pbrt-v4: α = √roughness.
    Root,
    /// pbrt-v3: a polynomial in the logarithm.
    Logarithm,
}

impl Remap {
    fn alpha(self, roughness: f64) -> f64 {
        match self {
            Self::Root => roughness.max(0.0).sqrt(),
            Self::Logarithm => {
                let x = roughness.max(1e-3).ln();
                1.62142 + x * (0.819955 + x * (0.1734 + x * (0.0171201 + x * 0.000640711)))
            }
        }
    }
}

impl Importer {
    /// α of facets along and across.
    pub(super) fn roughness(
        &mut self,
        params: &Params,
        prefix: &str,
        remap: Remap,
        default: f64,
    ) -> Roughness {
        let remapped = params.truth("remaproughness").unwrap_or(true);
        let both = self.float(params, &format!("{prefix}roughness")).unwrap_or((default as f32).into());
        let u = self.float(params, &format!("{prefix}uroughness")).unwrap_or(both.clone());
        let v = self.float(params, &format!("{prefix}vroughness")).unwrap_or(both);
        let mut alpha = |value: FloatDesc| match value {
            // 0 is smooth in either version.
            FloatDesc::Value(0.0) => FloatDesc::Value(0.0),
            FloatDesc::Value(x) if remapped => {
                FloatDesc::Value(remap.alpha(f64::from(x)).clamp(0.0, 1.0) as f32)
            }
            FloatDesc::Value(x) => FloatDesc::Value(x.clamp(0.0, 1.0)),
            texture => {
                if remapped {
                    let text = "a texture of roughness is not remapped";
                    self.report.instead(text, "it is taken as the facets' α", params.span);
                }
                texture
            }
        };
        Roughness::Alpha { along: alpha(u), across: alpha(v) }
    }
}
