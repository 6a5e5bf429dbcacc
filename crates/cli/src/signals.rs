//! Ctrl-C and its like: the first asks to stop, the second ends the process.
//!
//! What comes within a quarter of a second is one request: `timeout` and some shells send a signal to a process and
//! again to its group.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use nephroid::discard_unfinished;

use crate::failure::Failure;
use crate::progress::Progress;

/// Exit status of an interrupted run, as shells count it: 128 + SIGINT.
pub const INTERRUPTED: u8 = 130;

/// Signals that are so near to the first are the same request.
const ONE_REQUEST: Duration = Duration::from_millis(250);

/// Knows of requests to stop.
#[derive(Clone, Debug, Default)]
pub struct Interrupt {
    asked: Arc<AtomicBool>,
    /// Through which the first request is answered.
    progress: Arc<Mutex<Option<Progress>>>,
}

impl Interrupt {
    /// Catches SIGINT, SIGTERM and SIGHUP (Ctrl-C and closing on Windows); once in a process. The second request ends
    /// the process.
    pub fn catch() -> Result<Self, Failure> {
        let interrupt = Self::default();
        let Self { asked, progress } = interrupt.clone();
        let mut first: Option<Instant> = None;
        ctrlc::set_handler(move || match first {
            None => {
                first = Some(Instant::now());
                asked.store(true, Ordering::SeqCst);
                if let Some(progress) = &*progress.lock().unwrap_or_else(PoisonError::into_inner) {
                    progress
                        .line("interrupted: the picture is written after this pass; once more ends at once");
                }
            }
            Some(first) if first.elapsed() < ONE_REQUEST => {}
            Some(_) => {
                // Files are replaced whole or not at all; nothing half-written is left beside them.
                discard_unfinished();
                std::process::exit(INTERRUPTED.into());
            }
        })
        .map_err(|e| Failure::runtime(format!("Ctrl-C cannot be caught: {e}")))?;
        Ok(interrupt)
    }

    /// The first request is answered through `progress` from now on.
    pub fn answer_through(&self, progress: &Progress) {
        *self.progress.lock().unwrap_or_else(PoisonError::into_inner) = Some(progress.clone());
    }

    /// Whether a stop was asked for.
    pub fn is_asked(&self) -> bool {
        self.asked.load(Ordering::SeqCst)
    }
}
