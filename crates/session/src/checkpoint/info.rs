use std::ops::Range;
use std::path::{Path, PathBuf};
use std::time::Duration;

use scenefile::{Loaded, SceneDesc};
use toml::{Table, Value};

use super::CheckpointErrorKind;
use crate::hash::{file_hash, files};
use crate::{Phase, SceneHash, Timings, scene_hash};

/// Who writes checkpoints: a pass may be another in another version.
pub(crate) const PROGRAM: &str = concat!("nephroid ", env!("CARGO_PKG_VERSION"));

/// A scene file of another program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SceneSource {
    /// Its absolute path.
    pub file: PathBuf,
    /// Values that were replaced in it.
    pub overrides: Vec<String>,
}

/// How a scene file is read, with values replaced in it.
pub type ReadScene<'a> = &'a dyn Fn(&Path, &[String]) -> Loaded;

/// What a checkpoint says of its render, besides the film: enough to go on without the scene file.
#[derive(Clone, Debug, PartialEq)]
pub struct CheckpointInfo {
    /// The scene and its settings; its base folder is absolute. Where there is a `source`, of a file that was read the settings
    /// alone.
    pub desc: SceneDesc,
    /// The file of another program that the scene is read from again; `None`: the scene is in the checkpoint.
    pub source: Option<SceneSource>,
    /// The scene file, for people.
    pub name: Option<PathBuf>,
    /// What the scene is known by.
    pub hash: SceneHash,
    /// Each file that the scene reads, as it names it, and the hash of what is in it.
    pub files: Vec<(PathBuf, SceneHash)>,
    /// The passes that were asked for ([`crate::Job::passes`]).
    pub passes: Range<u64>,
    /// The time that was asked for.
    pub time: Option<Duration>,
    /// Wall-clock time spent on rendering.
    pub elapsed: Duration,
    /// What each phase took.
    pub timings: Timings,
    /// Pictures that were asked for, as absolute paths.
    pub outputs: Vec<PathBuf>,
}

impl CheckpointInfo {
    /// Of a scene, whose files are read to know them again.
    ///
    /// # Errors
    /// Where a file cannot be read, or the description has values that no scene file may have, so that it could not be
    /// read again; the message says which.
    pub fn new(desc: &SceneDesc) -> Result<Self, String> {
        Self::of(desc.clone(), None)
    }

    /// Of a scene that was read from a file of another program, with values replaced; it may be large and hold pictures: the
    /// checkpoint names the file and has the settings alone.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn of_import(desc: &SceneDesc, file: &Path, overrides: &[String]) -> Result<Self, String> {
        let file = std::path::absolute(file).map_err(|e| format!("{} is not known: {e}", file.display()))?;
        Self::of(desc.clone(), Some(SceneSource { file, overrides: overrides.to_vec() }))
    }

    fn of(mut desc: SceneDesc, source: Option<SceneSource>) -> Result<Self, String> {
        // The empty path is the working directory, for which `absolute` would be an error.
        let base = if desc.base.as_os_str().is_empty() { Path::new(".") } else { &desc.base };
        desc.base = std::path::absolute(base)
            .map_err(|e| format!("the folder {} is not known: {e}", base.display()))?;
        let hash = scene_hash(&desc)?;
        let read = |file: &Path| {
            let path = desc.resolve(file);
            let hash = file_hash(&path).map_err(|e| format!("{} cannot be read: {e}", path.display()))?;
            Ok((file.to_owned(), hash))
        };
        let files = files(&desc).into_iter().map(read).collect::<Result<_, String>>()?;
        let info = Self {
            passes: 0..desc.render.passes.into(),
            desc: if source.is_some() { settings_of(desc) } else { desc },
            name: source.as_ref().map(|source| source.file.clone()),
            source,
            hash,
            files,
            time: None,
            elapsed: Duration::ZERO,
            timings: Timings::default(),
            outputs: Vec::new(),
        };
        // What cannot be read again should be known before anything is rendered.
        match Self::from_text(info.to_text().as_bytes()) {
            Ok(again) if again == info => Ok(info),
            Ok(_) => Err("the scene has a value that a scene file does not keep".into()),
            Err(CheckpointErrorKind::Content(why)) => Err(why),
            Err(_) => Err("the scene cannot be written as a scene file".into()),
        }
    }

    /// Files of the scene that are not what they were when the render began, each with what is wrong with it.
    ///
    /// Cost: reads every file, about 0.3 GB/s.
    pub fn changed_files(&self) -> Vec<(PathBuf, String)> {
        let changed = |(file, known): &(PathBuf, SceneHash)| {
            let path = self.desc.resolve(file);
            match file_hash(&path) {
                Ok(hash) if hash == *known => None,
                Ok(_) => Some((path, "it was changed since the render began".into())),
                Err(error) => Some((path, format!("it cannot be read: {error}"))),
            }
        };
        self.files.iter().filter_map(changed).collect()
    }

    /// The whole scene: the settings of the checkpoint, and where there is a `source` the world that `read` finds there.
    ///
    /// # Errors
    /// Where that is no scene any more, or another than it was.
    pub fn scene(&self, read: ReadScene<'_>) -> Result<SceneDesc, CheckpointErrorKind> {
        let Some(source) = &self.source else { return Ok(self.desc.clone()) };
        let changed = |why: String| CheckpointErrorKind::Files(vec![(source.file.clone(), why)]);
        let loaded = read(&source.file, &source.overrides);
        let Some(world) = loaded.desc else {
            let first = loaded.diagnostics.iter().find(|d| d.is_error()).map(|d| d.message.clone());
            return Err(changed(format!("it cannot be read any more: {}", first.unwrap_or_default())));
        };
        let settings = self.desc.clone();
        let desc = SceneDesc {
            textures: world.textures,
            materials: world.materials,
            objects: world.objects,
            lights: world.lights,
            groups: world.groups,
            instances: world.instances,
            ..settings
        };
        match scene_hash(&desc) {
            Ok(hash) if hash == self.hash => Ok(desc),
            Ok(_) => Err(changed("it was changed since the render began".into())),
            Err(why) => Err(changed(why)),
        }
    }

    /// As TOML.
    pub(crate) fn to_text(&self) -> String {
        let path = |path: &Path| Value::from(path.to_string_lossy().into_owned());
        let mut table = Table::new();
        table.insert("program".into(), PROGRAM.into());
        table.insert("base".into(), path(&self.desc.base));
        if let Some(name) = &self.name {
            table.insert("name".into(), path(name));
        }
        if let Some(source) = &self.source {
            table.insert("source".into(), path(&source.file));
            table.insert("set".into(), source.overrides.clone().into());
        }
        table.insert("hash".into(), self.hash.to_string().into());
        table.insert("passes".into(), [self.passes.start, self.passes.end].map(|n| n as i64).to_vec().into());
        if let Some(time) = self.time {
            table.insert("time_s".into(), time.as_secs_f64().into());
        }
        table.insert("elapsed_s".into(), self.elapsed.as_secs_f64().into());
        let timings = self.timings.iter().map(|(phase, t)| (phase.name().to_owned(), t.as_secs_f64().into()));
        table.insert("timings_s".into(), Value::Table(timings.collect()));
        table.insert("outputs".into(), self.outputs.iter().map(|p| path(p)).collect::<Vec<_>>().into());
        let file =
            |(name, hash): &(PathBuf, SceneHash)| Value::Array(vec![path(name), hash.to_string().into()]);
        table.insert("files".into(), self.files.iter().map(file).collect::<Vec<_>>().into());
        table.insert("scene".into(), scenefile::to_toml(&self.desc).into());
        table.to_string()
    }

    pub(crate) fn from_text(text: &[u8]) -> Result<Self, CheckpointErrorKind> {
        let wrong =
            |what: &str| CheckpointErrorKind::Content(format!("what it says of its {what} makes no sense"));
        let text = str::from_utf8(text).map_err(|_| wrong("render"))?;
        let table: Table = text.parse().map_err(|_| wrong("render"))?;
        let string = |key: &str| table.get(key).and_then(Value::as_str).ok_or_else(|| wrong(key));
        let program = string("program")?;
        if program != PROGRAM {
            return Err(CheckpointErrorKind::Program(program.to_owned()));
        }
        let list = |key: &str| table.get(key).and_then(Value::as_array).ok_or_else(|| wrong(key));
        let seconds = |value: &Value| value.as_float().and_then(|s| Duration::try_from_secs_f64(s).ok());
        let base = PathBuf::from(string("base")?);
        let desc = read_scene(string("scene")?, base)?;
        let passes: Option<Vec<u64>> =
            list("passes")?.iter().map(|n| n.as_integer().and_then(|n| n.try_into().ok())).collect();
        let passes = match passes.as_deref() {
            Some([start, end]) if start < end => *start..*end,
            _ => return Err(wrong("passes")),
        };
        let time = match table.get("time_s") {
            Some(value) => Some(seconds(value).ok_or_else(|| wrong("time"))?),
            None => None,
        };
        let mut timings = Timings::default();
        for phase in Phase::ALL {
            let spent = table.get("timings_s").and_then(|t| t.get(phase.name())).and_then(seconds);
            timings.add(phase, spent.ok_or_else(|| wrong("timings"))?);
        }
        let source = match table.get("source").and_then(Value::as_str) {
            Some(file) => {
                let overrides: Option<_> =
                    list("set")?.iter().map(|v| v.as_str().map(str::to_owned)).collect();
                Some(SceneSource { file: file.into(), overrides: overrides.ok_or_else(|| wrong("set"))? })
            }
            None => None,
        };
        let outputs = list("outputs")?.iter().map(|p| p.as_str().map(PathBuf::from));
        let file = |value: &Value| {
            let [name, hash] = value.as_array()?.as_slice() else { return None };
            Some((PathBuf::from(name.as_str()?), read_hash(hash.as_str()?)?))
        };
        Ok(Self {
            desc,
            source,
            name: table.get("name").and_then(Value::as_str).map(PathBuf::from),
            hash: read_hash(string("hash")?).ok_or_else(|| wrong("hash"))?,
            files: list("files")?.iter().map(file).collect::<Option<_>>().ok_or_else(|| wrong("files"))?,
            passes,
            time,
            elapsed: table.get("elapsed_s").and_then(seconds).ok_or_else(|| wrong("time"))?,
            timings,
            outputs: outputs.collect::<Option<_>>().ok_or_else(|| wrong("outputs"))?,
        })
    }
}

/// A scene without its world.
fn settings_of(desc: SceneDesc) -> SceneDesc {
    let none = SceneDesc::default();
    SceneDesc {
        textures: none.textures,
        materials: none.materials,
        objects: none.objects,
        lights: none.lights,
        groups: none.groups,
        instances: none.instances,
        ..desc
    }
}

fn read_hash(text: &str) -> Option<SceneHash> {
    u128::from_str_radix(text, 16).ok().map(SceneHash)
}

fn read_scene(text: &str, base: PathBuf) -> Result<SceneDesc, CheckpointErrorKind> {
    let loaded = scenefile::reread(text, &base);
    let Some(desc) = loaded.desc else {
        let first = loaded.diagnostics.iter().find(|d| d.is_error()).map(|d| d.message.clone());
        let why = format!("its scene is not one: {}", first.unwrap_or_default());
        return Err(CheckpointErrorKind::Content(why));
    };
    Ok(SceneDesc { base, ..desc })
}
