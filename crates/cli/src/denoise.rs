//! Noise is taken out of pictures.

use std::time::Instant;

use nephroid::desc::Denoise;
use nephroid::{DenoiseError, Denoised, Denoiser, Places, Planes};

use crate::failure::Failure;
use crate::progress::Progress;

/// The library, found, and whether pictures without it are a failure.
#[derive(Debug)]
pub struct Denoising {
    denoiser: Denoiser,
    how: Denoise,
}

impl Denoising {
    /// Finds the library where it is wanted. Where it is not there, a sentence says how to get it and nothing is denoised.
    ///
    /// # Errors
    /// Where it is required and not there.
    pub fn find(how: Denoise, progress: &Progress) -> Result<Option<Self>, Failure> {
        let find = || Denoiser::find(&Places::of_environment());
        match how {
            Denoise::Off => Ok(None),
            Denoise::Auto => match find() {
                Ok(denoiser) => Ok(Some(Self { denoiser, how })),
                Err(error) => {
                    progress.warn(&said(&error, ": pictures keep their noise"));
                    Ok(None)
                }
            },
            Denoise::Require => match find() {
                Ok(denoiser) => Ok(Some(Self { denoiser, how })),
                Err(error) => Err(Failure::Usage(vec![said(&error, "")])),
            },
        }
    }

    /// Denoises a picture and says so. `None`: it failed, and the picture is to be written with its noise; `Err`: that is
    /// a failure.
    pub fn apply(&self, planes: &Planes, progress: &Progress) -> Result<Option<Denoised>, ()> {
        let start = Instant::now();
        match Denoised::new(planes, &self.denoiser) {
            Ok(denoised) => {
                let seconds = start.elapsed().as_secs_f64();
                progress.line(&format!("denoised with {} ({seconds:.1} s)", denoised.by()));
                Ok(Some(denoised))
            }
            Err(error) => {
                let message = said(&error, ": the picture keeps its noise");
                match self.how {
                    Denoise::Require => {
                        progress.error(&message);
                        Err(())
                    }
                    Denoise::Auto | Denoise::Off => {
                        progress.warn(&message);
                        Ok(None)
                    }
                }
            }
        }
    }
}

fn said(error: &DenoiseError, then: &str) -> String {
    format!("{error}{then}\n  = help: {}", error.help())
}
