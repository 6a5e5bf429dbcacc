use std::ffi::OsString;
use std::path::{Path, PathBuf};

use crate::DenoiseError;

/// Names of the library, the likelier first.
#[cfg(target_os = "windows")]
const NAMES: &[&str] = &["OpenImageDenoise.dll"];
/// Names of the library, the likelier first.
#[cfg(target_os = "macos")]
const NAMES: &[&str] = &["libOpenImageDenoise.2.dylib", "libOpenImageDenoise.dylib"];
/// Names of the library, the likelier first.
#[cfg(not(any(target_os = "windows", target_os = "macos")))]
const NAMES: &[&str] = &["libOpenImageDenoise.so.2", "libOpenImageDenoise.so"];

/// Folders in which a program keeps its libraries.
const FOLDERS: &[&str] = &["", "lib", "lib64", "bin"];

/// Where the library is looked for; the environment as far as it matters.
#[derive(Clone, Debug, Default)]
pub struct Places {
    /// `NEPHROID_OIDN`: the library, or a folder that has it, or has it in `lib`.
    pub named: Option<PathBuf>,
    /// `OIDN_DIR`: a folder that may have it.
    pub folder: Option<PathBuf>,
    /// `PATH`.
    pub path: Option<OsString>,
    /// The user's own folder, in which Python keeps packages.
    pub home: Option<PathBuf>,
}

/// What to load.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Candidate {
    /// A file; where it can't be loaded, that is an error.
    File(PathBuf),
    /// A name that the system looks up; where it knows none, the search goes on.
    System(&'static str),
}

impl Places {
    /// Those of this process.
    pub fn of_environment() -> Self {
        let folder = |name| std::env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
        Self {
            named: folder("NEPHROID_OIDN"),
            folder: folder("OIDN_DIR"),
            path: std::env::var_os("PATH"),
            home: folder("HOME").or_else(|| folder("USERPROFILE")),
        }
    }

    /// What to try, in this order: what `NEPHROID_OIDN` names and then nothing else; `OIDN_DIR`; the system's; that of
    /// the Python package.
    pub(crate) fn candidates(&self) -> Result<Vec<Candidate>, DenoiseError> {
        if let Some(named) = &self.named {
            let file = if named.is_file() { Some(named.clone()) } else { library_in(named) };
            let file = file.ok_or_else(|| DenoiseError::NotThere(named.clone()))?;
            return Ok(vec![Candidate::File(file)]);
        }
        let folder = self.folder.as_deref().and_then(library_in).map(Candidate::File);
        let system = NAMES.iter().map(|name| Candidate::System(name));
        Ok(folder.into_iter().chain(system).chain(self.of_python().map(Candidate::File)).collect())
    }

    /// That of the package `pyoidn` of the Python on the path, or of the user's own packages. Python is not run.
    fn of_python(&self) -> Option<PathBuf> {
        let is_python = |folder: &PathBuf| {
            ["python3", "python", "python3.exe", "python.exe"].iter().any(|name| folder.join(name).is_file())
        };
        let python = std::env::split_paths(self.path.as_ref()?).find(is_python)?;
        // `bin/python3` on most systems, `python.exe` or `Scripts\python.exe` on Windows.
        let roots = [python.parent().map(Path::to_owned), Some(python.clone())];
        let own = self.home.as_ref().map(|home| home.join(".local"));
        roots
            .into_iter()
            .chain([own])
            .flatten()
            .flat_map(|root| packages(&root))
            .find_map(|packages| library_in(&packages.join("pyoidn").join("oidn")))
    }
}

/// Folders below `root` in which Python keeps packages: the newest Python's first.
fn packages(root: &Path) -> Vec<PathBuf> {
    let mut found = vec![root.join("Lib").join("site-packages")];
    for lib in ["lib", "local/lib"] {
        let Ok(entries) = std::fs::read_dir(root.join(lib)) else { continue };
        let version = |folder: &Path| -> Option<(u32, u32)> {
            let name = folder.file_name()?.to_str()?.strip_prefix("python")?;
            let (major, minor) = name.split_once('.').unwrap_or((name, "0"));
            Some((major.parse().ok()?, minor.parse().ok()?))
        };
        let mut pythons: Vec<_> = entries
            .filter_map(|entry| entry.ok().map(|entry| entry.path()))
            .filter_map(|folder| Some((version(&folder)?, folder)))
            .collect();
        pythons.sort_by(|a, b| b.cmp(a));
        for (_, python) in pythons {
            found.extend(["site-packages", "dist-packages"].map(|name| python.join(name)));
        }
    }
    found
}

fn library_in(folder: &Path) -> Option<PathBuf> {
    let files = FOLDERS.iter().flat_map(|sub| NAMES.iter().map(move |name| folder.join(sub).join(name)));
    files.into_iter().find(|file| file.is_file())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    fn put(file: PathBuf) -> PathBuf {
        fs::create_dir_all(file.parent().unwrap()).unwrap();
        fs::write(&file, "no library").unwrap();
        file
    }

    #[test]
    fn what_is_named_is_taken_or_an_error() {
        let folder = tempfile::tempdir().unwrap();
        let other = put(folder.path().join("other").join(NAMES[0]));
        let at = |named: PathBuf| {
            let folder = other.parent().map(Path::to_owned);
            Places { named: Some(named), folder, ..Places::default() }.candidates()
        };
        let file = put(folder.path().join("a").join("lib").join(NAMES[0]));
        let odd = put(folder.path().join("odd.so"));
        assert_eq!(at(folder.path().join("a")), Ok(vec![Candidate::File(file.clone())]));
        assert_eq!(at(folder.path().join("a").join("lib")), Ok(vec![Candidate::File(file)]));
        assert_eq!(at(odd.clone()), Ok(vec![Candidate::File(odd)]));
        let none = folder.path().join("none");
        assert_eq!(at(none.clone()), Err(DenoiseError::NotThere(none)));
    }

    #[test]
    fn the_folder_comes_before_the_system_and_python_last() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path();
        let system: Vec<_> = NAMES.iter().map(|name| Candidate::System(name)).collect();
        assert_eq!(Places::default().candidates(), Ok(system.clone()));

        put(root.join("env/bin/python3"));
        let package = |root: PathBuf, python: &str| {
            put(root.join("lib").join(python).join("site-packages/pyoidn/oidn/lib").join(NAMES[0]))
        };
        let old = package(root.join("env"), "python3.9");
        let own = package(root.join("home/.local"), "python3.12");
        let mut places = Places {
            path: Some(std::env::join_paths([root.join("none"), root.join("env/bin")]).unwrap()),
            home: Some(root.join("home")),
            ..Places::default()
        };
        let and = |file: &Path| [system.clone(), vec![Candidate::File(file.to_owned())]].concat();
        assert_eq!(places.candidates(), Ok(and(&old)));
        let new = package(root.join("env"), "python3.11");
        assert_eq!(places.candidates(), Ok(and(&new)));
        fs::remove_dir_all(root.join("env/lib")).unwrap();
        assert_eq!(places.candidates(), Ok(and(&own)));

        let first = put(root.join("oidn").join("lib64").join(NAMES[0]));
        places.folder = Some(root.join("oidn"));
        assert_eq!(places.candidates().unwrap()[0], Candidate::File(first));
        places.folder = Some(root.join("nothing"));
        assert_eq!(places.candidates(), Ok(and(&own)));
    }
}
