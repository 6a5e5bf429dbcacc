//! A folder, the program run in it, and what it said.

use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStderr, Command, Stdio};

use tempfile::TempDir;

/// A small box: a floor, a lamp, a glass and a metal ball.
pub const BOX: &str = r#"
[render]
passes = 2
max_depth = 4

[film]
size = [16, 12]

[camera]
position = [0, 1, 4]
look_at = [0, 0.5, 0]

[photon_map]
photons = 2000
caustic_photons = 2000
knn = 20
caustic_knn = 20
final_gather = 2

[materials.white]
kind = "diffuse"
color = 0.7

[materials.glass]
kind = "dielectric"
ior = 1.5

[materials.metal]
kind = "conductor"
metal = "gold"

[[objects]]
shape = "quad"
origin = [-2, 0, 2]
edge_u = [4, 0, 0]
edge_v = [0, 0, -4]
material = "white"

[[objects]]
name = "ball"
shape = "sphere"
center = [-0.5, 0.5, 0]
radius = 0.4
material = "glass"

[[objects]]
shape = "sphere"
center = [0.6, 0.5, -0.3]
radius = 0.4
material = "metal"

[[objects]]
name = "lamp"
shape = "disk"
center = [0, 2.5, 0]
normal = [0, -1, 0]
radius = 0.4
power = 30

[[lights]]
name = "bulb"
kind = "point"
position = [1.5, 1.5, 1]
power = 10
"#;

/// What a run left.
#[derive(Debug)]
pub struct Ran {
    /// Exit status; `None`: ended by a signal.
    pub code: Option<i32>,
    pub out: String,
    pub err: String,
}

/// A folder of its own.
pub struct Place(TempDir);

impl Place {
    /// With the small box as `box.toml`.
    pub fn new() -> Self {
        let place = Self(tempfile::tempdir().unwrap());
        place.write("box.toml", BOX);
        place
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub fn write(&self, name: &str, text: &str) {
        std::fs::write(self.path(name), text).unwrap();
    }

    pub fn read(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.path(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
    }

    /// Names in the folder, sorted.
    pub fn files(&self) -> Vec<String> {
        let name = |e: std::io::Result<std::fs::DirEntry>| e.unwrap().file_name().into_string().unwrap();
        let mut names: Vec<_> = std::fs::read_dir(self.0.path()).unwrap().map(name).collect();
        names.sort();
        names
    }

    pub fn command(&self, args: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_nephroid"));
        command.args(args).current_dir(self.0.path()).stdin(Stdio::null());
        command
    }

    /// Runs to the end.
    pub fn run(&self, args: &[&str]) -> Ran {
        let output = self.command(args).output().unwrap();
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
        Ran { code: output.status.code(), out: text(output.stdout), err: text(output.stderr) }
    }

    /// Runs to the end, which must be a good one.
    pub fn ok(&self, args: &[&str]) -> Ran {
        let ran = self.run(args);
        assert_eq!(ran.code, Some(0), "{args:?}: {}{}", ran.out, ran.err);
        ran
    }

    pub fn start(&self, args: &[&str]) -> Started {
        let mut child = self.command(args).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
        let err = BufReader::new(child.stderr.take().unwrap());
        Started { child, err, said: String::new() }
    }
}

/// A program that runs.
pub struct Started {
    child: Child,
    err: BufReader<ChildStderr>,
    said: String,
}

impl Started {
    /// Waits until standard error has a line with `part`.
    pub fn wait_for(&mut self, part: &str) {
        loop {
            let mut line = String::new();
            let n = self.err.read_line(&mut line).unwrap();
            assert!(n > 0, "ended without {part:?}: {}", self.said);
            self.said += &line;
            if line.contains(part) {
                return;
            }
        }
    }

    /// Sends a signal by name.
    pub fn signal(&self, name: &str) {
        let status = Command::new("kill").args(["-s", name, &self.child.id().to_string()]).status().unwrap();
        assert!(status.success());
    }

    /// Sends a signal by name, long enough after the last to be another request.
    pub fn signal_again(&self, name: &str) {
        std::thread::sleep(std::time::Duration::from_millis(300));
        self.signal(name);
    }

    /// Waits for the end.
    pub fn end(mut self) -> Ran {
        self.err.read_to_string(&mut self.said).unwrap();
        let code = self.child.wait().unwrap().code();
        Ran { code, out: String::new(), err: self.said }
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        // A folder whose permissions a test took away is given back to be removed.
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            let _ = std::fs::set_permissions(self.0.path(), std::fs::Permissions::from_mode(0o755));
        }
    }
}

/// Durations and sizes that depend on the machine, counts of photons, and what an automatic exposure found, as `_`.
pub fn masked(text: &str) -> String {
    let mut out = String::new();
    for line in text.split_inclusive('\n') {
        let words: Vec<&str> = line.split(' ').collect();
        let unit = |w: &str| {
            ["s", "KiB", "MiB", "B", "%", "stored"].contains(&w.trim_end_matches([',', ':', ';', '\n', ')']))
        };
        let number = |w: &str| w.parse::<f64>().is_ok();
        let masked: Vec<&str> = words
            .iter()
            .enumerate()
            .map(|(i, w)| {
                let found = i > 0 && words[i - 1] == "exposure" && line.contains("EV, automatic");
                let named = found || i > 0 && ["radius", "about"].contains(&words[i - 1]);
                if named || number(w) && words.get(i + 1).is_some_and(|w| unit(w)) { "_" } else { w }
            })
            .collect();
        out += &masked.join(" ");
        if line.ends_with('\n') && !out.ends_with('\n') {
            out.push('\n');
        }
    }
    out
}

/// Width and height of a picture.
pub fn size(path: &Path) -> (usize, usize) {
    let image = nephroid::RgbImage::read(path).unwrap();
    (image.width(), image.height())
}
