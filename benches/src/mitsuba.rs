//! The path tracing peer: Mitsuba 3 in a Python process, driven line by line.

use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

/// What one render is asked for.
#[derive(Clone, Copy)]
pub(crate) struct Request {
    /// Samples a pixel.
    pub spp: u64,
    /// Scattering events at most; `None`: no limit.
    pub depth: Option<u32>,
    /// Scattering events before Russian roulette begins.
    pub roulette: u32,
    /// Of the random numbers.
    pub seed: u64,
}

/// A running `mitsuba_paths.py`.
pub(crate) struct Mitsuba {
    child: Child,
    input: ChildStdin,
    output: BufReader<ChildStdout>,
    /// Mitsuba's version.
    pub version: String,
}

impl Drop for Mitsuba {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl Mitsuba {
    /// Starts it with the Python named by `$NEPHROID_PYTHON` (default `python3`) and renders once, so that kernels
    /// are compiled.
    ///
    /// # Errors
    /// What is missing: a package, the LLVM library.
    pub(crate) fn start(scene: &Path, variant: &str, first: Request) -> Result<Self, String> {
        let python = std::env::var("NEPHROID_PYTHON").unwrap_or_else(|_| "python3".into());
        let script = concat!(env!("CARGO_MANIFEST_DIR"), "/python/mitsuba_paths.py");
        let mut child = Command::new(&python)
            .arg(script)
            .arg(scene)
            .arg(variant)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(|e| format!("no Python ({python}): {e}"))?;
        let (Some(input), Some(output)) = (child.stdin.take(), child.stdout.take()) else {
            return Err("no pipe to Python".into());
        };
        let mut peer = Self { child, input, output: BufReader::new(output), version: String::new() };
        let started = peer.line().and_then(|line| {
            let version = line.strip_prefix("ready ").map(str::to_owned);
            peer.version = version.ok_or_else(|| format!("Mitsuba answered {line:?}"))?;
            peer.render(first)
        });
        match started {
            Ok(_) => Ok(peer),
            Err(why) => Err(peer.last_words().unwrap_or(why)),
        }
    }

    fn line(&mut self) -> Result<String, String> {
        let mut line = String::new();
        self.output.read_line(&mut line).map_err(|e| e.to_string())?;
        if line.is_empty() { Err("Mitsuba ended".into()) } else { Ok(line.trim().to_owned()) }
    }

    /// (seconds of processor time, mean of the pixels).
    pub(crate) fn render(&mut self, request: Request) -> Result<(f64, [f64; 3]), String> {
        let Request { spp, depth, roulette, seed } = request;
        let depth = depth.map_or(-1, i64::from);
        writeln!(self.input, "{spp} {depth} {roulette} {seed}")
            .and_then(|()| self.input.flush())
            .map_err(|e| e.to_string())?;
        let line = self.line()?;
        let numbers: Result<Vec<f64>, _> = line.split_whitespace().map(str::parse).collect();
        match numbers.as_deref() {
            Ok(&[seconds, r, g, b]) => Ok((seconds, [r, g, b])),
            _ => Err(format!("Mitsuba answered {line:?}")),
        }
    }

    /// The last line that it said before it died.
    fn last_words(&mut self) -> Option<String> {
        let _ = self.child.kill();
        let errors = std::io::read_to_string(self.child.stderr.take()?).ok()?;
        errors.lines().rfind(|line| !line.trim().is_empty()).map(|line| line.trim().to_owned())
    }
}
