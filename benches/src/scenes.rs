//! Scenes of the repository, rendered by the library as the command line does.

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use nephroid::{Control, Event, Job, Scene, SceneDesc, Session, compile, load};

/// A scene ready to be rendered.
pub(crate) struct Ready {
    pub desc: SceneDesc,
    pub scene: Arc<Scene>,
}

/// Path of a scene, by its name below `scenes`.
pub(crate) fn path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes").join(name)
}

impl Ready {
    /// Reads and compiles; `changes` as after `--set`.
    pub(crate) fn new(name: &str, changes: &[&str]) -> Result<Self, String> {
        let changes: Vec<String> = changes.iter().map(|c| (*c).to_owned()).collect();
        let loaded = load(&path(name), &changes);
        let text = loaded.render();
        let desc = loaded.desc.ok_or(text)?;
        let scene = compile(&desc, 0).map_err(|e| e.to_string())?.scene;
        Ok(Self { desc, scene })
    }

    /// A session of these passes, not yet run.
    pub(crate) fn session(&self, passes: Range<u64>, threads: usize) -> Result<Session, String> {
        let job = Job::new(&self.desc, self.scene.clone()).map_err(|e| e.to_string())?;
        Session::new(Job { passes, ..job }, threads).map_err(|e| e.to_string())
    }

    /// Wall-clock ratio of one thread to two, without what other programs took: medians of `rounds` in turn.
    pub(crate) fn two_over_one(&self, passes: u64, rounds: usize) -> Result<(f64, f64, f64), String> {
        let mut times = [Vec::new(), Vec::new()];
        for _ in 0..rounds {
            for (threads, times) in (1..).zip(&mut times) {
                let mut session = self.session(0..passes, threads)?;
                let mut outcome = Ok(());
                times.push(crate::clock::undisturbed_s(threads, || outcome = run(&mut session)));
                outcome?;
            }
        }
        let [one, two] = times.map(|t| crate::clock::median(&t));
        Ok((one / two, one, two))
    }
}

/// Runs a session to its end.
///
/// # Errors
/// Where it ends early, or warns: then something else than the scene was rendered.
pub(crate) fn run(session: &mut Session) -> Result<(), String> {
    let mut warning = None;
    let outcome = session.run(&mut |event| {
        if let Event::Warning(w) = event {
            warning = Some(w.to_string());
        }
        Control::Continue
    });
    match (outcome, warning) {
        (Ok(_), None) => Ok(()),
        (Err(error), _) => Err(error.to_string()),
        (_, Some(warning)) => Err(warning),
    }
}
