//! What each directive does to the graphics state.

use std::rc::Rc;

use scenefile::desc::{Group, Instance};
use scenefile::{Diagnostic, Sourced, Span};

use super::parser::{Broken, Parsed};
use super::state::{Graphics, Scope, Target};
use super::{Importer, OpenObject};
use crate::matrix::Matrix;
use crate::spectrum::Space;

impl Importer {
    pub(super) fn directive(&mut self, name: &str, span: Span) -> Parsed<()> {
        match name {
            "Identity" => self.set_ctm(Matrix::IDENTITY, span),
            "Translate" => {
                let v = self.numbers::<3>(name, span)?;
                self.concat(Some(Matrix::translate(v)), span);
            }
            "Scale" => {
                let v = self.numbers::<3>(name, span)?;
                self.concat(Some(Matrix::scale(v)), span);
            }
            "Rotate" => {
                let [degrees, x, y, z] = self.numbers::<4>(name, span)?;
                self.concat(Matrix::rotate(degrees, [x, y, z]), span);
            }
            "LookAt" => {
                let [ex, ey, ez, lx, ly, lz, ux, uy, uz] = self.numbers::<9>(name, span)?;
                self.concat(Matrix::look_at([ex, ey, ez], [lx, ly, lz], [ux, uy, uz]), span);
            }
            "Transform" => {
                let m = self.numbers::<16>(name, span)?;
                self.set_ctm(Matrix::columns(&m), span);
            }
            "ConcatTransform" => {
                let m = self.numbers::<16>(name, span)?;
                self.concat(Some(Matrix::columns(&m)), span);
            }
            "CoordinateSystem" => {
                let (system, _) = self.string(name, span)?;
                self.coordinate_systems.insert(system, self.graphics.ctm);
            }
            "CoordSysTransform" => {
                let (system, at) = self.string(name, span)?;
                match self.coordinate_systems.get(&system) {
                    Some(m) => self.set_ctm(*m, span),
                    None => self.report.error(
                        "unknown-name",
                        format!("no coordinate system is named `{system}`"),
                        at,
                    ),
                }
            }
            "ReverseOrientation" => self.graphics.reverse ^= true,
            "TransformTimes" => {
                self.numbers::<2>(name, span)?;
            }
            "ActiveTransform" => self.active_transform(span)?,
            "AttributeBegin" => self.scopes.push(Scope::Attribute(span, Box::new(self.graphics.clone()))),
            "TransformBegin" => self.scopes.push(Scope::Transform(span, Box::new(self.graphics.ctm))),
            "AttributeEnd" | "TransformEnd" | "ObjectEnd" => self.end(name, span),
            "ObjectBegin" => self.object_begin(span)?,
            "ObjectInstance" => self.object_instance(span)?,
            "WorldBegin" => self.world_begin(span),
            "WorldEnd" => {}
            "Attribute" => self.attribute(span)?,
            "ColorSpace" => {
                let (space, at) = self.string(name, span)?;
                match Space::from_name(&space) {
                    Some(space) => self.graphics.space = space,
                    None => {
                        self.report.error("unknown-name", format!("no colour space is named `{space}`"), at)
                    }
                }
            }
            "Option" => self.option()?,
            "Include" | "Import" => self.include(name, span)?,
            "Camera" | "Film" | "PixelFilter" | "Filter" | "Sampler" | "Integrator" | "SurfaceIntegrator"
            | "Accelerator" | "VolumeIntegrator" | "Renderer" => self.setting(name, span)?,
            "MakeNamedMedium" => self.named_medium(span)?,
            "MediumInterface" => self.medium_interface(span)?,
            "Texture" => self.texture_directive(span)?,
            "Material" => {
                let (kind, at) = self.string(name, span)?;
                let params = self.params(format!("the material `{kind}`"), span, Some(Target::Material))?;
                let material = self.material(&kind, at, &params, None);
                params.finish(&mut self.report);
                self.graphics.material = Some(material);
            }
            "MakeNamedMaterial" => {
                let (material, _) = self.string(name, span)?;
                let params =
                    self.params(format!("the material `{material}`"), span, Some(Target::Material))?;
                let (kind, at) = match params.any("type").and_then(|p| Some((p.text()?.to_owned(), p.span))) {
                    Some(found) => found,
                    None => ("matte".to_owned(), span),
                };
                let lowered = self.material(&kind, at, &params, Some(&material));
                params.finish(&mut self.report);
                self.materials.insert(material, lowered);
            }
            "NamedMaterial" => {
                let (material, at) = self.string(name, span)?;
                self.graphics.material = Some(self.named_material(&material, at));
            }
            "LightSource" => {
                let (kind, at) = self.string(name, span)?;
                let params = self.params(format!("the light `{kind}`"), span, Some(Target::Light))?;
                self.light(&kind, at, &params);
                params.finish(&mut self.report);
            }
            "AreaLightSource" => {
                let (kind, at) = self.string(name, span)?;
                let params = self.params(format!("the area light `{kind}`"), span, Some(Target::Light))?;
                self.area_light(&kind, at, params);
            }
            "Shape" => {
                let (kind, at) = self.string(name, span)?;
                let params = self.params(format!("the shape `{kind}`"), span, Some(Target::Shape))?;
                if !self.in_world {
                    self.report.error("syntax", "a shape stands before `WorldBegin`", span);
                }
                self.shape(&kind, at, &params);
                params.finish(&mut self.report);
            }
            _ => {
                let error = Diagnostic::error("unknown-directive", format!("there is no directive `{name}`"));
                self.report.push(error.at(span));
                return Err(Broken);
            }
        }
        Ok(())
    }

    fn set_ctm(&mut self, m: Matrix, span: Span) {
        if self.graphics.end_only {
            return;
        }
        if m.is_usable() {
            self.graphics.ctm = m;
        } else {
            self.report.error(
                "degenerate",
                "this transform flattens space, is not affine, or overflows",
                span,
            );
        }
    }

    fn concat(&mut self, m: Option<Matrix>, span: Span) {
        let m = m.map_or(Matrix([[f64::NAN; 4]; 4]), |m| self.graphics.ctm.after(&m));
        self.set_ctm(m, span);
    }

    fn active_transform(&mut self, span: Span) -> Parsed<()> {
        let (which, at) = self.word("ActiveTransform", span)?;
        match which.as_str() {
            "StartTime" | "All" => self.graphics.end_only = false,
            "EndTime" => {
                self.graphics.end_only = true;
                self.report.instead("motion is not rendered", "everything stays where it starts", span);
            }
            _ => {
                let text = format!("`{which}` is none of StartTime, EndTime and All");
                self.report.error("syntax", text, at);
            }
        }
        Ok(())
    }

    /// Closes what is open innermost, which must be what `name` ends; `TransformEnd` may close an attribute block, as
    /// in pbrt-v4.
    fn end(&mut self, name: &str, span: Span) {
        let outer = self.open.last().map_or(0, |open| open.scopes);
        let fits = |scope: &Scope| match name {
            "ObjectEnd" => matches!(scope, Scope::Object(..)),
            "AttributeEnd" => matches!(scope, Scope::Attribute(..)),
            _ => !matches!(scope, Scope::Object(..)),
        };
        if self.scopes.len() <= outer || !self.scopes.last().is_some_and(fits) {
            let mut error =
                Diagnostic::error("syntax", format!("`{name}` ends nothing that is open here")).at(span);
            if let Some(scope) = self.scopes.last() {
                error = error.label(scope.span(), format!("`{}` comes first", scope.end()));
            }
            self.report.push(error);
            return;
        }
        match self.scopes.pop() {
            Some(Scope::Attribute(_, graphics)) => self.graphics = *graphics,
            Some(Scope::Transform(_, ctm)) => self.graphics.ctm = *ctm,
            Some(Scope::Object(begin, graphics)) => {
                self.graphics = *graphics;
                if let Some(OpenObject { name, group }) = self.object.take() {
                    self.desc.groups.insert(name, Sourced::at(group, begin));
                }
            }
            None => {}
        }
    }

    fn object_begin(&mut self, span: Span) -> Parsed<()> {
        let (name, at) = self.string("ObjectBegin", span)?;
        if self.object.is_some() {
            self.report.error("syntax", "an object begins within an object", span);
            return Ok(());
        }
        if self.desc.groups.contains_key(&name) {
            self.report.error("duplicate-name", format!("two objects are named `{name}`"), at);
        }
        self.scopes.push(Scope::Object(span, Box::new(self.graphics.clone())));
        self.object = Some(OpenObject { name, group: Group::default() });
        Ok(())
    }

    fn object_instance(&mut self, span: Span) -> Parsed<()> {
        let (name, at) = self.string("ObjectInstance", span)?;
        if self.object.is_some() {
            self.report.error("syntax", "an object is placed within an object", span);
            return Ok(());
        }
        let instance = Instance {
            name: None,
            group: Sourced::at(name, at),
            transform: self.mirror.after(&self.graphics.ctm).steps(),
            material: None,
        };
        self.desc.instances.push(Sourced::at(instance, span));
        Ok(())
    }

    fn attribute(&mut self, span: Span) -> Parsed<()> {
        let (name, at) = self.string("Attribute", span)?;
        let list = self.param_list()?;
        match Target::from_name(&name) {
            Some(target) => Rc::make_mut(&mut self.graphics.defaults)[target as usize].extend(list),
            None => {
                let text = format!("`{name}` is none of shape, light, material, medium and texture");
                self.report.error("unknown-name", text, at);
            }
        }
        Ok(())
    }

    fn option(&mut self) -> Parsed<()> {
        for param in self.param_list()? {
            match param.name.as_str() {
                "seed" => self.desc.render.seed = param.numbers().first().map_or(0, |x| x.max(0.0) as u64),
                // These do not change what the picture converges to.
                "rendercoordsys"
                | "disablepixeljitter"
                | "disablewavelengthjitter"
                | "pixelstats"
                | "wavefront"
                | "debugstart"
                | "mseimage"
                | "mseimageout"
                | "msereferenceimage"
                | "msereferenceout" => {}
                name => {
                    let text = format!("the option `{name}` is not supported");
                    self.report.instead(text, "it is ignored", param.span);
                }
            }
        }
        Ok(())
    }

    fn include(&mut self, directive: &str, span: Span) -> Parsed<()> {
        let (name, at) = self.string(directive, span)?;
        let path = self.base.join(self.find_file(&name));
        if self.open_file(&path, at, &format!("`{name}`")).is_ok()
            && directive == "Import"
            && let Some(open) = self.open.last_mut()
        {
            open.graphics = Some(Box::new(self.graphics.clone()));
        }
        Ok(())
    }

    /// What is understood when the world begins.
    fn setting(&mut self, directive: &str, span: Span) -> Parsed<()> {
        let (kind, _) = self.string(directive, span)?;
        let params = self.params(format!("the {} `{kind}`", directive.to_lowercase()), span, None)?;
        if self.in_world {
            self.report.error("syntax", format!("`{directive}` stands after `WorldBegin`"), span);
            return Ok(());
        }
        match directive {
            "Camera" => {
                if let Some(camera_to_world) = self.graphics.ctm.inverse() {
                    self.coordinate_systems.insert("camera".into(), camera_to_world);
                    self.preamble.camera = Some((params, camera_to_world, kind));
                }
            }
            "Film" => self.preamble.film = Some((params, kind)),
            "PixelFilter" | "Filter" => self.preamble.filter = Some((params, kind)),
            "Sampler" => self.preamble.sampler = Some((params, kind)),
            "Integrator" | "SurfaceIntegrator" => self.preamble.integrator = Some((params, kind)),
            // How rays find surfaces does not show.
            _ => {}
        }
        Ok(())
    }

    fn world_begin(&mut self, span: Span) {
        if std::mem::replace(&mut self.in_world, true) {
            self.report.error("syntax", "a second `WorldBegin`", span);
            return;
        }
        self.settle(span);
        // A space set before holds on; a transform does not.
        self.graphics = Graphics { ctm: Matrix::IDENTITY, end_only: false, ..self.graphics.clone() };
        self.coordinate_systems.insert("world".into(), Matrix::IDENTITY);
    }
}
