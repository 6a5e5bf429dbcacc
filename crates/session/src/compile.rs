use std::fmt;
use std::sync::Arc;

use par::Workers;
use scene::{Scene, Survey};
use scenefile::{Diagnostic, SceneDesc};

use crate::surroundings::{camera_warning, lamp_warnings};

/// A scene that can be rendered.
#[derive(Clone, Debug)]
pub struct Compiled {
    /// The scene.
    pub scene: Arc<Scene>,
    /// What may be wrong with it.
    pub warnings: Vec<Diagnostic>,
}

/// Why a description gives no scene.
#[derive(Clone, Debug, PartialEq)]
pub enum CompileError {
    /// The system starts no more threads; its reason.
    Threads(String),
    /// Everything that is wrong with the scene.
    Scene(Vec<Diagnostic>),
}

impl fmt::Display for CompileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Threads(reason) => write!(f, "threads cannot be started: {reason}"),
            Self::Scene(diagnostics) => {
                for (i, diagnostic) in diagnostics.iter().enumerate() {
                    write!(f, "{}{}", if i > 0 { "; " } else { "" }, diagnostic.message)?;
                }
                Ok(())
            }
        }
    }
}

impl std::error::Error for CompileError {}

/// Compiles a description on `threads` threads (0: one for each core): reads its meshes and images, resolves its
/// names, builds what rays and light sampling need. The scene does not depend on the number of threads.
///
/// # Errors
/// Where the description is wrong, with every reason, or threads cannot be started.
pub fn compile(desc: &SceneDesc, threads: usize) -> Result<Compiled, CompileError> {
    let workers = Workers::new(threads).map_err(CompileError::Threads)?;
    let (scene, mut warnings) = workers.run(|| scene::compile(desc)).map_err(CompileError::Scene)?;
    warnings.extend(camera_warning(&scene, desc));
    warnings.extend(lamp_warnings(&scene));
    Ok(Compiled { scene: Arc::new(scene), warnings })
}

/// Looks at what a description makes, as [`compile`] does, without building what rays need; that the camera is inside of something
/// is not found out.
///
/// # Errors
/// As [`compile`].
pub fn survey(desc: &SceneDesc, threads: usize) -> Result<(Survey, Vec<Diagnostic>), CompileError> {
    let workers = Workers::new(threads).map_err(CompileError::Threads)?;
    workers.run(|| scene::survey(desc)).map_err(CompileError::Scene)
}

#[cfg(test)]
mod tests {
    use super::*;
    use scenefile::desc::{
        Camera, Group, Instance, Light, LightKind, Material, Object, Shape, TransformStep,
    };

    #[test]
    fn a_survey_tells_what_the_scene_has() {
        let mut desc = SceneDesc { camera: Some(Camera::default().into()), ..SceneDesc::default() };
        let ball = |level| {
            Object::new(
                Shape::Icosphere { center: [0.0; 3], radius: 1.0, level, smooth: true },
                Material::diffuse(0.5),
            )
        };
        desc.objects.push(ball(5).into());
        desc.groups.insert("g".into(), Group { objects: vec![ball(3).into()] }.into());
        for x in [3.0, 9.0] {
            let transform = vec![TransformStep::Translate([x, 0.0, 0.0])];
            desc.instances.push(Instance { name: None, group: "g".into(), transform, material: None }.into());
        }
        desc.lights.push(Light::from(LightKind::Environment { radiance: [1.0; 3] }).into());
        let scene = compile(&desc, 2).unwrap().scene;
        let (survey, _) = survey(&desc, 2).unwrap();
        let (a, b) = (survey.summary, scene.summary());
        assert_eq!(survey.bounds, scene.bounds());
        assert_eq!(
            (a.objects, a.instances, a.triangles, a.mesh_bytes),
            (b.objects, b.instances, b.triangles, b.mesh_bytes)
        );
        assert_eq!(survey.lights[0].1.power(), scene.lights()[0].power());
        // An estimate, within a third.
        let ratio = a.bvh_bytes as f64 / b.bvh_bytes as f64;
        assert!((0.67..1.5).contains(&ratio), "{} {}", a.bvh_bytes, b.bvh_bytes);
    }

    #[test]
    fn a_scene_without_camera_is_refused_with_the_reason() {
        let error = compile(&SceneDesc::default(), 1).unwrap_err();
        assert!(matches!(&error, CompileError::Scene(d) if !d.is_empty()));
        assert!(error.to_string().contains("camera"), "{error}");
    }
}
