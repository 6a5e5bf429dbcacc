//! Why a command failed, and the exit status that tells it.

use std::io;

use crate::say;

/// Exit status where all is well.
pub const OK: u8 = 0;
/// Exit status where something failed on the way.
pub const FAILED: u8 = 1;
/// Exit status where the command line or the scene is wrong.
pub const WRONG: u8 = 2;

/// Why a command failed.
#[derive(Debug)]
pub enum Failure {
    /// The command line or a file that it names is wrong: one message each.
    Usage(Vec<String>),
    /// The scene is wrong: its diagnostics as text, and messages about the rest.
    Scene(String, Vec<String>),
    /// Something failed on the way.
    Runtime(String),
}

/// The exit status, or why there was a failure.
pub type Outcome = Result<u8, Failure>;

impl Failure {
    /// One thing that is wrong with the command line.
    pub fn usage(message: impl ToString) -> Self {
        Self::Usage(vec![message.to_string()])
    }

    /// One thing that failed on the way.
    pub fn runtime(message: impl ToString) -> Self {
        Self::Runtime(message.to_string())
    }

    /// Says it on standard error; the exit status.
    pub fn report(&self) -> u8 {
        match self {
            Self::Usage(messages) => {
                messages.iter().for_each(|m| say::error(m));
                WRONG
            }
            Self::Scene(diagnostics, messages) => {
                say::say(say::painted(diagnostics).trim_end());
                messages.iter().for_each(|m| say::error(m));
                WRONG
            }
            Self::Runtime(message) => {
                say::error(message);
                FAILED
            }
        }
    }
}

impl From<io::Error> for Failure {
    fn from(error: io::Error) -> Self {
        Self::Runtime(format!("standard output cannot be written: {error}"))
    }
}
