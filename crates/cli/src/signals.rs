//! Ctrl-C and its like: the first asks to stop, the second ends the process.
//!
//! What comes within a quarter of a second is one request: `timeout` and some shells send a signal to a process and
//! again to its group.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use nephroid::discard_unfinished;

/// Exit status of an interrupted run, as shells count it: 128 + SIGINT.
pub const INTERRUPTED: u8 = 130;

/// Signals that are so near to the first are the same request.
const ONE_REQUEST: Duration = Duration::from_millis(250);

/// Knows of requests to stop.
#[derive(Clone, Debug, Default)]
pub struct Interrupt(Arc<AtomicBool>);

impl Interrupt {
    /// Catches SIGINT, SIGTERM and SIGHUP (Ctrl-C and closing on Windows). `on_first` runs once, on a thread of its
    /// own; the second request ends the process.
    ///
    /// # Errors
    /// Where the system refuses.
    pub fn catch(mut on_first: impl FnMut() + Send + 'static) -> Result<Self, ctrlc::Error> {
        let interrupt = Self::default();
        let asked = interrupt.0.clone();
        let mut first: Option<Instant> = None;
        ctrlc::set_handler(move || match first {
            None => {
                first = Some(Instant::now());
                asked.store(true, Ordering::SeqCst);
                on_first();
            }
            Some(first) if first.elapsed() < ONE_REQUEST => {}
            Some(_) => {
                // Files are replaced whole or not at all; nothing half-written is left beside them.
                discard_unfinished();
                std::process::exit(INTERRUPTED.into());
            }
        })?;
        Ok(interrupt)
    }

    /// Whether a stop was asked for.
    pub fn is_asked(&self) -> bool {
        self.0.load(Ordering::SeqCst)
    }
}
