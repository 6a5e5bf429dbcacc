use std::fmt;
use std::sync::Arc;

use par::Workers;
use scene::Scene;
use scenefile::{Diagnostic, SceneDesc};

use crate::surroundings::camera_warning;

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
    Ok(Compiled { scene: Arc::new(scene), warnings })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scene_without_camera_is_refused_with_the_reason() {
        let error = compile(&SceneDesc::default(), 1).unwrap_err();
        assert!(matches!(&error, CompileError::Scene(d) if !d.is_empty()));
        assert!(error.to_string().contains("camera"), "{error}");
    }
}
