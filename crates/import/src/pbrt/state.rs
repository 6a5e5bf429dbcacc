//! The graphics state, and what opens and closes around it.

use std::rc::Rc;

use scenefile::{Sourced, Span};

use super::lower::MaterialUse;
use super::media::Filling;
use super::params::{Param, Params};
use crate::matrix::Matrix;
use crate::spectrum::Space;

/// Which directives `Attribute` sets defaults for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Target {
    Shape,
    Light,
    Material,
    Medium,
    Texture,
}

impl Target {
    pub(super) fn from_name(name: &str) -> Option<Self> {
        match name {
            "shape" => Some(Self::Shape),
            "light" => Some(Self::Light),
            "material" => Some(Self::Material),
            "medium" => Some(Self::Medium),
            "texture" => Some(Self::Texture),
            _ => None,
        }
    }
}

/// What attributes hold at a place of the text.
#[derive(Clone, Debug)]
pub(super) struct Graphics {
    pub ctm: Matrix,
    /// Whether `ActiveTransform EndTime` holds, so that transforms do not concern the start.
    pub end_only: bool,
    pub reverse: bool,
    /// `None`: pbrt's default.
    pub material: Option<MaterialUse>,
    pub area_light: Option<Rc<Params>>,
    /// The picture that the area light shines in.
    pub area_texture: Option<Sourced<String>>,
    /// The medium inside of surfaces.
    pub interior: Option<Filling>,
    /// By [`Target`].
    pub defaults: Rc<[Vec<Param>; 5]>,
    pub space: Space,
}

impl Default for Graphics {
    fn default() -> Self {
        Self {
            ctm: Matrix::IDENTITY,
            end_only: false,
            reverse: false,
            material: None,
            area_light: None,
            area_texture: None,
            interior: None,
            defaults: Rc::default(),
            space: Space::default(),
        }
    }
}

/// What is open, where it began, and what its end restores.
pub(super) enum Scope {
    Attribute(Span, Box<Graphics>),
    Transform(Span, Box<Matrix>),
    Object(Span, Box<Graphics>),
}

impl Scope {
    pub(super) fn begin(&self) -> &'static str {
        match self {
            Self::Attribute(..) => "AttributeBegin",
            Self::Transform(..) => "TransformBegin",
            Self::Object(..) => "ObjectBegin",
        }
    }

    pub(super) fn end(&self) -> &'static str {
        match self {
            Self::Attribute(..) => "AttributeEnd",
            Self::Transform(..) => "TransformEnd",
            Self::Object(..) => "ObjectEnd",
        }
    }

    pub(super) fn span(&self) -> Span {
        match self {
            Self::Attribute(span, _) | Self::Transform(span, _) | Self::Object(span, _) => *span,
        }
    }
}
