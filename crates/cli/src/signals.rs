//! Ctrl-C and its like: the first asks to stop, the second ends the process.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use nephroid::discard_unfinished;

/// Exit status of an interrupted run, as shells count it: 128 + SIGINT.
pub const INTERRUPTED: u8 = 130;

/// Counts requests to stop.
#[derive(Clone, Debug, Default)]
pub struct Interrupt(Arc<AtomicUsize>);

impl Interrupt {
    /// Catches SIGINT, SIGTERM and SIGHUP (Ctrl-C and closing on Windows). `on_first` runs once, on a thread of its
    /// own; the second signal ends the process.
    ///
    /// # Errors
    /// Where the system refuses.
    pub fn catch(mut on_first: impl FnMut() + Send + 'static) -> Result<Self, ctrlc::Error> {
        let interrupt = Self::default();
        let count = interrupt.0.clone();
        ctrlc::set_handler(move || {
            if count.fetch_add(1, Ordering::SeqCst) > 0 {
                // Files are replaced whole or not at all; nothing half-written is left beside them.
                discard_unfinished();
                std::process::exit(INTERRUPTED.into());
            }
            on_first();
        })?;
        Ok(interrupt)
    }

    /// Whether a stop was asked for.
    pub fn is_asked(&self) -> bool {
        self.0.load(Ordering::SeqCst) > 0
    }
}
