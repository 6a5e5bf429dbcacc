//! The C++ peer: compiled where a compiler and the header are found, and driven line by line.

use std::io::{BufRead, BufReader, Write};
use std::path::PathBuf;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use math::Vec3;

use crate::search::{scratch_dir, write_points};

/// Sizes of a leaf that are tried: the library's default, and up to what suits it best.
const LEAVES: [usize; 4] = [10, 20, 32, 64];

/// A running `nanoflann_bench.cpp`. It is measured with whichever leaf size is fastest for the query.
pub(crate) struct Nanoflann {
    child: Child,
    input: ChildStdin,
    output: BufReader<ChildStdout>,
    dir: PathBuf,
    best: usize,
}

impl Drop for Nanoflann {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
        let _ = std::fs::remove_dir_all(&self.dir);
    }
}

impl Nanoflann {
    /// Compiles the peer with `$CXX` (default `c++`) and `$NANOFLANN_INCLUDE`, and gives it the points.
    ///
    /// # Errors
    /// What is missing.
    pub(crate) fn start(points: &[Vec3], queries: &[Vec3]) -> Result<Self, String> {
        let dir = scratch_dir("nanoflann").map_err(|e| e.to_string())?;
        Self::start_in(&dir, points, queries).inspect_err(|_| {
            let _ = std::fs::remove_dir_all(&dir);
        })
    }

    fn start_in(dir: &std::path::Path, points: &[Vec3], queries: &[Vec3]) -> Result<Self, String> {
        let program = dir.join("nanoflann_bench");
        let source = concat!(env!("CARGO_MANIFEST_DIR"), "/cpp/nanoflann_bench.cpp");
        let compiler = std::env::var("CXX").unwrap_or_else(|_| "c++".into());
        let mut compile = Command::new(&compiler);
        compile.args(["-O3", "-march=x86-64-v3", "-std=c++17", "-o"]).arg(&program).arg(source);
        if let Some(include) = std::env::var_os("NANOFLANN_INCLUDE") {
            compile.arg("-I").arg(include);
        }
        let done = compile.output().map_err(|e| format!("no C++ compiler ({compiler}): {e}"))?;
        if !done.status.success() {
            let text = String::from_utf8_lossy(&done.stderr);
            let first = text.lines().find(|l| l.contains("error")).unwrap_or("compilation failed").to_owned();
            return Err(format!("{first} (Debian: libnanoflann-dev; elsewhere set NANOFLANN_INCLUDE)"));
        }
        let (points_path, queries_path) = (dir.join("points"), dir.join("queries"));
        write_points(&points_path, points).map_err(|e| e.to_string())?;
        write_points(&queries_path, queries).map_err(|e| e.to_string())?;
        let mut child = Command::new(&program)
            .args([points_path, queries_path])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .map_err(|e| e.to_string())?;
        let (Some(input), Some(output)) = (child.stdin.take(), child.stdout.take()) else {
            return Err("no pipe to the program".into());
        };
        let output = BufReader::new(output);
        Ok(Self { child, input, output, dir: dir.to_owned(), best: LEAVES[0] })
    }

    fn ask<const N: usize>(&mut self, command: &str) -> Result<[f64; N], String> {
        writeln!(self.input, "{command}").and_then(|()| self.input.flush()).map_err(|e| e.to_string())?;
        let mut line = String::new();
        self.output.read_line(&mut line).map_err(|e| e.to_string())?;
        let numbers: Result<Vec<f64>, _> = line.split_whitespace().map(str::parse).collect();
        let numbers = numbers.map_err(|e| format!("nanoflann answered {line:?}: {e}"))?;
        numbers.try_into().map_err(|_| format!("nanoflann answered {line:?}"))
    }

    /// Builds a tree for each leaf size; the least time.
    pub(crate) fn build(&mut self) -> Result<f64, String> {
        let mut least = f64::INFINITY;
        for leaf in LEAVES {
            least = least.min(self.ask::<1>(&format!("build {leaf}"))?[0]);
        }
        Ok(least)
    }

    /// Settles on the leaf size that answers k-nearest queries fastest.
    pub(crate) fn choose_knn(&mut self, k: usize, count: usize) -> Result<(), String> {
        self.choose(|peer| peer.knn(k, 0, count).map(|r| r.0))
    }

    /// Settles on the leaf size that answers radius queries fastest.
    pub(crate) fn choose_radius(&mut self, radius: f32, count: usize) -> Result<(), String> {
        self.choose(|peer| peer.radius(radius, 0, count).map(|r| r.0))
    }

    fn choose(&mut self, mut time: impl FnMut(&mut Self) -> Result<f64, String>) -> Result<(), String> {
        let mut best = (f64::INFINITY, self.best);
        for _ in 0..3 {
            for leaf in LEAVES {
                self.best = leaf;
                let t = time(self)?;
                if t < best.0 {
                    best = (t, leaf);
                }
            }
        }
        self.best = best.1;
        Ok(())
    }

    /// (seconds, sum of k-th distances).
    pub(crate) fn knn(&mut self, k: usize, first: usize, count: usize) -> Result<(f64, f64), String> {
        let leaf = self.best;
        let [time, sum] = self.ask(&format!("knn {leaf} {k} {first} {count}"))?;
        Ok((time, sum))
    }

    /// (seconds, hits, sum of squared distances).
    pub(crate) fn radius(
        &mut self,
        radius: f32,
        first: usize,
        count: usize,
    ) -> Result<(f64, f64, f64), String> {
        let leaf = self.best;
        let [time, hits, sum] = self.ask(&format!("radius {leaf} {radius} {first} {count}"))?;
        Ok((time, hits, sum))
    }
}
