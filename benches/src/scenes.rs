//! Scenes of the repository, rendered by the library as the command line does.

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use nephroid::{Control, Event, Job, Scene, SceneDesc, Session, compile, load};

use crate::clock::{Spell, median, spell};

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

    /// Camera paths of a pass.
    pub(crate) fn pixels(&self) -> f64 {
        let [width, height] = self.scene.resolution().map(f64::from);
        width * height
    }

    /// Photon paths that `auto` traces each pass.
    pub(crate) fn photon_paths(&self) -> Result<u64, String> {
        let settings = nephroid::settings(&self.desc).map_err(|e| e.to_string())?;
        Ok(integrators::Auto::new(settings, &self.scene).paths_per_pass())
    }

    /// Medians of `rounds` in turn, on one thread and on two.
    pub(crate) fn one_and_two(&self, passes: u64, rounds: usize) -> Result<[Spell; 2], String> {
        let mut times = [(Vec::new(), Vec::new()), (Vec::new(), Vec::new())];
        for _ in 0..rounds {
            for (threads, (undisturbed, elapsed)) in (1..).zip(&mut times) {
                let mut session = self.session(0..passes, threads)?;
                let mut outcome = Ok(());
                let spell = spell(threads, || outcome = run(&mut session));
                outcome?;
                undisturbed.push(spell.undisturbed_s);
                elapsed.push(spell.elapsed_s);
            }
        }
        Ok(times.map(|(u, e)| Spell { undisturbed_s: median(&u), elapsed_s: median(&e) }))
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
