use std::ffi::OsString;
use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use develop::{Display, Lut, Planes, Settled};
use film::{ExrOptions, Film};
use scenefile::desc::SceneDesc;

use crate::{Denoised, SceneHash};

/// A picture file to be written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Output {
    path: PathBuf,
    kind: OutputKind,
}

/// The format of a picture file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OutputKind {
    /// OpenEXR: linear radiance, all layers.
    Exr,
    /// PNG: 8 bits, exposed and displayed.
    Png,
}

/// Why a picture file is refused.
#[derive(Debug)]
pub enum PictureError {
    /// The name ends in no format that can be written.
    Extension(PathBuf),
    /// Two outputs are one file.
    Twice(PathBuf),
    /// The scene reads this file.
    Input(PathBuf),
    /// The file cannot be written.
    File(film::OutputError),
}

impl PictureError {
    /// What to do about it.
    pub fn help(&self) -> String {
        match self {
            Self::Extension(_) => {
                "end the name in .exr (linear radiance, all layers) or .png (8 bits, displayed)".into()
            }
            Self::Twice(_) | Self::Input(_) => "give each picture a name of its own".into(),
            Self::File(error) => error.help(),
        }
    }
}

impl fmt::Display for PictureError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Extension(path) => match path.extension() {
                Some(extension) => write!(
                    f,
                    "cannot write {}: pictures of type .{} are not known",
                    path.display(),
                    extension.display()
                ),
                None => write!(f, "cannot write {}: its name does not say which format", path.display()),
            },
            Self::Twice(path) => write!(f, "{} is to be written twice", path.display()),
            Self::Input(path) => write!(f, "cannot write {}: the scene reads this file", path.display()),
            Self::File(error) => write!(f, "{error}"),
        }
    }
}

impl std::error::Error for PictureError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::File(error) => Some(error),
            Self::Extension(_) | Self::Twice(_) | Self::Input(_) => None,
        }
    }
}

impl From<film::OutputError> for PictureError {
    fn from(error: film::OutputError) -> Self {
        Self::File(error)
    }
}

/// What pictures are written with, besides pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct PictureInfo {
    /// How 8-bit pictures show radiance.
    pub display: Display,
    /// What files say of themselves: names and values, in this order. The number of passes is added when a film is
    /// written.
    pub metadata: Vec<(String, String)>,
}

impl PictureInfo {
    /// Of a scene whose hash is known; without its look-up table, which [`read_lut`] reads.
    pub fn new(desc: &SceneDesc, hash: SceneHash) -> Self {
        let metadata = [
            ("software", concat!("nephroid ", env!("CARGO_PKG_VERSION")).to_owned()),
            ("sceneHash", hash.to_string()),
            ("integrator", desc.render.integrator.name().to_owned()),
            ("seed", desc.render.seed.to_string()),
        ];
        Self {
            display: Display {
                exposure: desc.film.exposure,
                white_balance: desc.film.white_balance,
                view: desc.film.view,
                lut: None,
            },
            metadata: metadata.map(|(name, value)| (name.to_owned(), value)).to_vec(),
        }
    }

    /// With the look-up table that a scene names, if any.
    ///
    /// # Errors
    /// Where its file cannot be read or is none.
    pub fn with_lut_of(mut self, desc: &SceneDesc) -> Result<Self, LutFileError> {
        self.display.lut = desc.film.lut.as_ref().map(|file| read_lut(&desc.resolve(file))).transpose()?;
        Ok(self)
    }

    /// How a film will be shown.
    pub fn settle(&self, film: &Film) -> Settled {
        self.display.settle(&Planes::of(film))
    }

    fn metadata_of(&self, film: &Film, settled: &Settled) -> Vec<(String, String)> {
        let passes = ("passes".to_owned(), film.passes().to_string());
        self.metadata.iter().cloned().chain([passes]).chain(settled.metadata()).collect()
    }
}

impl Output {
    /// The output of a path; its extension, in upper or lower case, says the format.
    ///
    /// # Errors
    /// Where the extension is neither exr nor png.
    pub fn new(path: &Path) -> Result<Self, PictureError> {
        let extension = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
        let kind = match extension.as_deref() {
            Some("exr") => OutputKind::Exr,
            Some("png") => OutputKind::Png,
            _ => return Err(PictureError::Extension(path.to_owned())),
        };
        Ok(Self { path: path.to_owned(), kind })
    }

    /// Where.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// In which format.
    pub fn kind(&self) -> OutputKind {
        self.kind
    }

    /// Writes a film, into a temporary file that is then renamed: the path holds what it held before, or all of the
    /// picture.
    ///
    /// # Errors
    /// Where the file cannot be written.
    pub fn write(&self, film: &Film, info: &PictureInfo) -> Result<(), PictureError> {
        self.write_picture(film, info, None)
    }

    /// The same with what a denoiser made of the film: EXR has it as the layer `denoised` beside all others, PNG shows it.
    /// The exposure is that of the film.
    ///
    /// # Errors
    /// As [`write`](Self::write).
    pub fn write_denoised(
        &self,
        film: &Film,
        info: &PictureInfo,
        denoised: &Denoised,
    ) -> Result<(), PictureError> {
        self.write_picture(film, info, Some(denoised))
    }

    fn write_picture(
        &self,
        film: &Film,
        info: &PictureInfo,
        denoised: Option<&Denoised>,
    ) -> Result<(), PictureError> {
        let mut planes = Planes::of(film);
        let settled = info.display.settle(&planes);
        let mut metadata = info.metadata_of(film, &settled);
        metadata.extend(denoised.map(Denoised::metadata));
        match self.kind {
            OutputKind::Exr => {
                let more =
                    denoised.map(|d| ("denoised".to_owned(), d.pixels().to_vec())).into_iter().collect();
                film::write_exr(&self.path, film, &ExrOptions { metadata, more, ..Default::default() })?
            }
            OutputKind::Png => {
                planes.denoised = denoised.map_or_else(Vec::new, |denoised| denoised.pixels().to_vec());
                film::write_png(&self.path, film.width(), film.height(), &settled.show(&planes), &metadata)?;
            }
        }
        Ok(())
    }
}

impl Output {
    /// Writes planes that were read and perhaps mixed, otherwise as [`write`](Self::write).
    ///
    /// # Errors
    /// Where the file cannot be written.
    pub fn write_planes(&self, planes: &Planes, info: &PictureInfo) -> Result<(), PictureError> {
        let settled = info.display.settle(planes);
        let metadata: Vec<_> = info.metadata.iter().cloned().chain(settled.metadata()).collect();
        let (width, height) = (planes.width, planes.height);
        match self.kind {
            OutputKind::Exr => {
                film::write_exr_channels(&self.path, [width, height], &planes.channels(), &metadata)?
            }
            OutputKind::Png => film::write_png(&self.path, width, height, &settled.show(planes), &metadata)?,
        }
        Ok(())
    }
}

/// Whether two names are of one file in existing folders.
pub fn is_same_file(a: &Path, b: &Path) -> bool {
    identity(a) == identity(b)
}

/// Why a file is no look-up table.
#[derive(Debug)]
pub struct LutFileError {
    path: PathBuf,
    reason: String,
}

impl fmt::Display for LutFileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} is no look-up table (.cube): {}", self.path.display(), self.reason)
    }
}

impl std::error::Error for LutFileError {}

/// Greatest file of a look-up table that is read, in bytes: a table of 256³ colours with room to spare.
const MOST_LUT: u64 = 1 << 30;

/// Reads a .cube file.
///
/// # Errors
/// Where it cannot be read or is none.
pub fn read_lut(path: &Path) -> Result<Arc<Lut>, LutFileError> {
    let error = |reason: String| LutFileError { path: path.to_owned(), reason };
    let size = std::fs::metadata(path).map_err(|e| error(e.to_string()))?.len();
    if size > MOST_LUT {
        return Err(error("it is larger than 1 GiB".into()));
    }
    let text = std::fs::read_to_string(path).map_err(|e| error(e.to_string()))?;
    Lut::parse(&text).map(Arc::new).map_err(|e| error(e.to_string()))
}

/// The outputs of paths, each of which could be written now. Nothing is left behind.
///
/// # Errors
/// All that are refused: unknown formats, files that cannot be written, files named twice.
pub fn check_outputs<P: AsRef<Path>>(paths: &[P]) -> Result<Vec<Output>, Vec<PictureError>> {
    let (mut outputs, mut errors) = (Vec::new(), Vec::new());
    let mut seen = Vec::new();
    for path in paths {
        let path = path.as_ref();
        let key = identity(path);
        if seen.contains(&key) {
            errors.push(PictureError::Twice(path.to_owned()));
            continue;
        }
        seen.push(key);
        match Output::new(path).and_then(|o| film::check_writable(path).map(|()| o).map_err(Into::into)) {
            Ok(output) => outputs.push(output),
            Err(error) => errors.push(error),
        }
    }
    if errors.is_empty() { Ok(outputs) } else { Err(errors) }
}

/// Outputs that would replace a file that the scene reads.
pub fn overwritten_inputs(outputs: &[Output], desc: &SceneDesc) -> Vec<PictureError> {
    let inputs: Vec<_> =
        crate::hash::files(desc).into_iter().map(|file| identity(&desc.resolve(file))).collect();
    let overwrites = |output: &&Output| inputs.contains(&identity(&output.path));
    outputs.iter().filter(overwrites).map(|output| PictureError::Input(output.path.clone())).collect()
}

/// Equal for two names of one file in existing folders.
pub(crate) fn identity(path: &Path) -> (PathBuf, OsString) {
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let folder = folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
    (folder, path.file_name().unwrap_or_default().to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use film::{PassFilm, PixelSample};

    fn messages(paths: &[PathBuf]) -> Vec<String> {
        check_outputs(paths).unwrap_err().iter().map(ToString::to_string).collect()
    }

    #[test]
    fn formats_are_known_by_extension() {
        let kind = |path: &str| Output::new(Path::new(path)).map(|o| o.kind()).ok();
        assert_eq!(kind("a.exr"), Some(OutputKind::Exr));
        assert_eq!(kind("b/a.PNG"), Some(OutputKind::Png));
        for unknown in ["a", "exr", ".png", "a.jpg", "a.exr.tmp", ""] {
            assert_eq!(kind(unknown), None, "{unknown}");
        }
    }

    #[test]
    fn everything_wrong_is_said_and_nothing_left() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        let paths = [at("a.exr"), at("b.jpg"), at("none/c.png"), at("./a.exr"), at("d")];
        let said = messages(&paths);
        assert_eq!(said.len(), 4, "{said:?}");
        for (message, part) in said.iter().zip([".jpg", "none", "twice", "format"]) {
            assert!(message.contains(part), "{message}");
        }
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
        assert_eq!(check_outputs(&[at("a.exr"), at("a.png")]).unwrap().len(), 2);
    }

    #[test]
    fn what_the_scene_reads_is_not_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let mut desc = SceneDesc { base: folder.path().to_owned(), ..SceneDesc::default() };
        desc.textures.insert("wood".into(), scenefile::desc::Texture::image("wood.png").into());
        let outputs =
            ["a.png", "./wood.png", "wood.exr"].map(|n| Output::new(&folder.path().join(n)).unwrap());
        let said: Vec<_> = overwritten_inputs(&outputs, &desc).iter().map(ToString::to_string).collect();
        assert_eq!(said.len(), 1, "{said:?}");
        assert!(said[0].contains("wood.png"));
    }

    #[test]
    fn a_film_becomes_files_of_either_format() {
        let folder = tempfile::tempdir().unwrap();
        let mut film = Film::new(2, 1);
        let sample = PixelSample { direct: [0.25, 0.5, 1.0], ..PixelSample::default() };
        film.add(0, &PassFilm::new(2, 1, vec![sample; 2]).unwrap()).unwrap();
        let info = PictureInfo::new(&SceneDesc::default(), SceneHash(5));
        for name in ["a.exr", "a.png"] {
            let path = folder.path().join(name);
            Output::new(&path).unwrap().write(&film, &info).unwrap();
            let image = film::RgbImage::read(&path).unwrap();
            assert_eq!((image.width(), image.height()), (2, 1));
            if name == "a.exr" {
                assert_eq!(image.pixels(), [[0.25, 0.5, 1.0]; 2]);
                let bytes = std::fs::read(&path).unwrap();
                let text = String::from_utf8_lossy(&bytes);
                for said in
                    ["sceneHash", &SceneHash(5).to_string(), "passes", "seed", "nephroid 0.", "(automatic)"]
                {
                    assert!(text.contains(said), "{said}");
                }
            }
        }
    }
}
