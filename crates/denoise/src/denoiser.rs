use std::ffi::OsStr;
use std::fmt;
use std::path::{Path, PathBuf};

use crate::api::{Device, Functions, load};
use crate::places::Candidate;
use crate::{DenoiseError, Places};

/// Open Image Denoise, loaded.
#[derive(Debug)]
pub struct Denoiser {
    functions: Functions,
    version: [i32; 3],
    path: PathBuf,
    /// Where the functions are; `None` in tests.
    _library: Option<libloading::Library>,
}

/// A picture and what is known of the surfaces that it shows; planes of equal size, row by row, or empty where they are not
/// known. Normals count only beside an albedo.
#[derive(Clone, Copy, Debug)]
pub struct Images<'a> {
    /// Pixels a row, and rows.
    pub size: [usize; 2],
    /// Linear radiance.
    pub beauty: &'a [[f32; 3]],
    /// Reflectance, 0 to 1.
    pub albedo: &'a [[f32; 3]],
    /// Normals, components −1 to 1.
    pub normal: &'a [[f32; 3]],
}

impl Denoiser {
    /// Finds the library and loads it.
    ///
    /// # Errors
    /// Where there is none, or what is there is not one of version 2 that works on this machine.
    pub fn find(places: &Places) -> Result<Self, DenoiseError> {
        for candidate in places.candidates()? {
            let name: &OsStr = match &candidate {
                Candidate::File(path) => path.as_os_str(),
                Candidate::System(name) => OsStr::new(name),
            };
            match (load(name), &candidate) {
                (Ok(library), _) => return Self::of(library, Path::new(name)),
                (Err(_), Candidate::System(_)) => {}
                (Err(why), Candidate::File(path)) => return Err(DenoiseError::Unloadable(path.clone(), why)),
            }
        }
        Err(DenoiseError::NotFound)
    }

    fn of(library: libloading::Library, path: &Path) -> Result<Self, DenoiseError> {
        let functions = Functions::of(&library).map_err(|name| DenoiseError::Lacks(path.to_owned(), name))?;
        Self::with(functions, path, Some(library))
    }

    fn with(
        functions: Functions,
        path: &Path,
        library: Option<libloading::Library>,
    ) -> Result<Self, DenoiseError> {
        let device = Device::new(&functions).map_err(DenoiseError::Failed)?;
        let version = [c"versionMajor", c"versionMinor", c"versionPatch"].map(|name| device.int(name));
        drop(device);
        if version[0] != 2 {
            return Err(DenoiseError::Version(path.to_owned(), version[0]));
        }
        Ok(Self { functions, version, path: path.to_owned(), _library: library })
    }

    /// Where it was found: a file, or a name that the system knows.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The picture without noise. Albedo and normals are denoised before it, each by itself, so that noise in them (depth
    /// of field, glass) does not come back through them.
    ///
    /// Values that are not finite count as 0, negative radiance as 0. Pixels outside of the smallest window that holds all of
    /// which something is known (radiance, albedo or normal) stay 0: they were not rendered, or show nothing.
    ///
    /// # Errors
    /// Where sizes differ, or the library fails.
    pub fn denoise(&self, images: &Images<'_>) -> Result<Vec<[f32; 3]>, DenoiseError> {
        let Images { size, beauty, albedo, normal } = *images;
        let pixels = size[0].checked_mul(size[1]).filter(|&n| n > 0).ok_or(DenoiseError::Size)?;
        let is_known = |plane: &[[f32; 3]]| !plane.is_empty();
        if beauty.len() != pixels || [albedo, normal].iter().any(|p| is_known(p) && p.len() != pixels) {
            return Err(DenoiseError::Size);
        }
        let normal = if is_known(albedo) { normal } else { &[] };
        let beauty = bounded(beauty, 0.0, f32::MAX);
        let features = [(c"albedo", bounded(albedo, 0.0, 1.0)), (c"normal", bounded(normal, -1.0, 1.0))];
        let device = Device::new(&self.functions).map_err(DenoiseError::Failed)?;
        let mut clean = Vec::new();
        for (name, plane) in features.iter().filter(|(_, plane)| is_known(plane)) {
            let mut out = vec![[0.0; 3]; pixels];
            device.filter(size, &[(*name, plane)], &[], &mut out).map_err(DenoiseError::Failed)?;
            clean.push((*name, out));
        }
        let mut inputs = vec![(c"color", beauty.as_slice())];
        inputs.extend(clean.iter().map(|(name, plane)| (*name, plane.as_slice())));
        let flags: &[_] = if clean.is_empty() { &[c"hdr"] } else { &[c"hdr", c"cleanAux"] };
        let mut out = vec![[0.0; 3]; pixels];
        device.filter(size, &inputs, flags, &mut out).map_err(DenoiseError::Failed)?;
        let planes = features.iter().map(|(_, plane)| plane).chain([&beauty]);
        let window = Window::of(size[0], planes);
        for (i, pixel) in out.iter_mut().enumerate() {
            if !window.contains(i % size[0], i / size[0]) {
                *pixel = [0.0; 3];
            } else if pixel.iter().any(|v| !v.is_finite()) {
                *pixel = beauty[i];
            }
        }
        Ok(out)
    }
}

/// Open Image Denoise and its version.
impl fmt::Display for Denoiser {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [major, minor, patch] = self.version;
        write!(f, "Open Image Denoise {major}.{minor}.{patch}")
    }
}

/// Columns and rows of a picture, the ends left out.
struct Window {
    columns: std::ops::Range<usize>,
    rows: std::ops::Range<usize>,
}

impl Window {
    /// The smallest that holds all pixels that are not 0 in one of the planes.
    fn of<'a>(width: usize, planes: impl Iterator<Item = &'a Vec<[f32; 3]>>) -> Self {
        let mut window = Self { columns: 0..0, rows: 0..0 };
        for plane in planes {
            for (i, _) in plane.iter().enumerate().filter(|(_, pixel)| **pixel != [0.0; 3]) {
                window.columns = grown(&window.columns, i % width);
                window.rows = grown(&window.rows, i / width);
            }
        }
        window
    }

    fn contains(&self, x: usize, y: usize) -> bool {
        self.columns.contains(&x) && self.rows.contains(&y)
    }
}

/// The smallest range that holds another one and an index.
fn grown(range: &std::ops::Range<usize>, index: usize) -> std::ops::Range<usize> {
    if range.is_empty() { index..index + 1 } else { range.start.min(index)..range.end.max(index + 1) }
}

fn bounded(plane: &[[f32; 3]], least: f32, greatest: f32) -> Vec<[f32; 3]> {
    let value = |v: f32| if v.is_finite() { v.clamp(least, greatest) } else { 0.0 };
    plane.iter().map(|pixel| pixel.map(value)).collect()
}

#[cfg(test)]
#[allow(unsafe_code, reason = "a library that is played by functions")]
mod tests {
    use super::*;
    use std::collections::BTreeMap;
    use std::ffi::{CStr, c_char, c_int, c_void};

    /// What a filter was told.
    #[derive(Default)]
    struct Played {
        images: BTreeMap<String, (*mut [f32; 3], usize)>,
        flags: Vec<String>,
    }

    fn text(name: *const c_char) -> String {
        unsafe { CStr::from_ptr(name) }.to_str().unwrap().to_owned()
    }

    unsafe extern "C" fn new_device(_kind: c_int) -> *mut c_void {
        Box::into_raw(Box::new(0u8)).cast()
    }
    unsafe extern "C" fn no_device(_kind: c_int) -> *mut c_void {
        std::ptr::null_mut()
    }
    unsafe extern "C" fn set_bool(_device: *mut c_void, _name: *const c_char, _value: bool) {}
    unsafe extern "C" fn version_2(_device: *mut c_void, name: *const c_char) -> c_int {
        if text(name) == "versionMajor" { 2 } else { 5 }
    }
    unsafe extern "C" fn version_3(_device: *mut c_void, _name: *const c_char) -> c_int {
        3
    }
    unsafe extern "C" fn nothing(_handle: *mut c_void) {}
    unsafe extern "C" fn no_error(_device: *mut c_void, _message: *mut *const c_char) -> c_int {
        0
    }
    unsafe extern "C" fn out_of_memory(_device: *mut c_void, message: *mut *const c_char) -> c_int {
        unsafe { *message = c"out of memory".as_ptr() };
        4
    }
    unsafe extern "C" fn release_device(device: *mut c_void) {
        drop(unsafe { Box::from_raw(device.cast::<u8>()) });
    }
    unsafe extern "C" fn new_filter(_device: *mut c_void, kind: *const c_char) -> *mut c_void {
        assert_eq!(text(kind), "RT");
        Box::into_raw(Box::<Played>::default()).cast()
    }
    unsafe extern "C" fn set_image(
        filter: *mut c_void,
        name: *const c_char,
        at: *mut c_void,
        format: c_int,
        width: usize,
        height: usize,
        offset: usize,
        pixel: usize,
        row: usize,
    ) {
        assert_eq!((format, offset, pixel, row), (3, 0, 12, 12 * width));
        let filter = unsafe { &mut *filter.cast::<Played>() };
        filter.images.insert(text(name), (at.cast(), width * height));
    }
    unsafe extern "C" fn set_flag(filter: *mut c_void, name: *const c_char, value: bool) {
        assert!(value);
        unsafe { &mut *filter.cast::<Played>() }.flags.push(text(name));
    }
    /// Adds up all that it is given; the picture, which has flags, is made 100 greater.
    unsafe extern "C" fn execute(filter: *mut c_void) {
        let Played { images, flags } = unsafe { &*filter.cast::<Played>() };
        let (out, count) = images["output"];
        for i in 0..count {
            let read = |name: &str| images.get(name).map_or([0.0; 3], |(at, _)| unsafe { *at.add(i) });
            let planes = ["color", "albedo", "normal"].map(read);
            let more = if flags == &["hdr", "cleanAux"] { 100.0 } else { 0.25 };
            unsafe { *out.add(i) = std::array::from_fn(|c| planes.iter().map(|p| p[c]).sum::<f32>() + more) };
        }
    }
    unsafe extern "C" fn release_filter(filter: *mut c_void) {
        drop(unsafe { Box::from_raw(filter.cast::<Played>()) });
    }

    const PLAYED: Functions = Functions {
        new_device,
        set_device_bool: set_bool,
        get_device_int: version_2,
        commit_device: nothing,
        get_device_error: no_error,
        release_device,
        new_filter,
        set_image,
        set_filter_bool: set_flag,
        commit_filter: nothing,
        execute_filter: execute,
        release_filter,
    };

    fn denoiser(functions: Functions) -> Result<Denoiser, DenoiseError> {
        Denoiser::with(functions, Path::new("played"), None)
    }

    #[test]
    fn features_are_denoised_first_and_empty_pixels_stay_empty() {
        let denoiser = denoiser(PLAYED).unwrap();
        assert_eq!(denoiser.to_string(), "Open Image Denoise 2.5.5");
        let beauty = [[1.0, -2.0, f32::NAN], [0.0; 3]];
        let albedo = [[0.5, 7.0, 0.0], [0.0; 3]];
        let normal = [[0.0, 0.0, -1.0], [0.0; 3]];
        let images = Images { size: [2, 1], beauty: &beauty, albedo: &albedo, normal: &normal };
        // Each feature gets 1/4, the picture 100; albedo is at most 1, what is negative or not finite is 0.
        assert_eq!(denoiser.denoise(&images), Ok(vec![[102.0, 101.5, 99.5], [0.0; 3]]));
    }

    #[test]
    fn black_pixels_within_the_picture_are_denoised_too() {
        let denoiser = denoiser(PLAYED).unwrap();
        let mut beauty = [[0.0; 3]; 5];
        (beauty[1], beauty[3]) = ([1.0; 3], [2.0; 3]);
        let images = Images { size: [5, 1], beauty: &beauty, albedo: &[], normal: &[] };
        let red: Vec<f32> = denoiser.denoise(&images).unwrap().iter().map(|p| p[0]).collect();
        assert_eq!(red, [0.0, 1.25, 0.25, 2.25, 0.0]);
    }

    #[test]
    fn sizes_must_agree() {
        let denoiser = denoiser(PLAYED).unwrap();
        let two = [[0.0; 3]; 2];
        for (size, albedo) in
            [([2, 2], &two[..]), ([2, 1], &two[..1]), ([0, 0], &[]), ([usize::MAX, 2], &two[..])]
        {
            let images = Images { size, beauty: &two, albedo, normal: &two };
            assert_eq!(denoiser.denoise(&images), Err(DenoiseError::Size));
        }
    }

    #[test]
    fn what_goes_wrong_is_said() {
        let said = |functions| denoiser(functions).unwrap_err().to_string();
        let other = said(Functions { get_device_int: version_3, ..PLAYED });
        assert_eq!(other, "played is Open Image Denoise 3; version 2 is needed");
        let none = said(Functions { new_device: no_device, ..PLAYED });
        assert_eq!(none, "Open Image Denoise failed: it has no device for this processor");
        let full = said(Functions { get_device_error: out_of_memory, ..PLAYED });
        assert_eq!(full, "Open Image Denoise failed: out of memory");
    }

    #[test]
    fn a_file_that_is_no_library_is_an_error() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("odd.so");
        std::fs::write(&file, "no library").unwrap();
        let places = Places { named: Some(file.clone()), ..Places::default() };
        let error = Denoiser::find(&places).unwrap_err();
        assert!(matches!(&error, DenoiseError::Unloadable(path, _) if *path == file), "{error}");
    }

    /// Where the library is there, it must do what it is for.
    #[test]
    fn the_library_takes_noise_away() {
        let denoiser = match Denoiser::find(&Places::of_environment()) {
            Ok(denoiser) => denoiser,
            Err(DenoiseError::NotFound) => return,
            Err(error) => panic!("{error}"),
        };
        let n = 64;
        let noise = |i: usize| ((i as u32).wrapping_mul(2_654_435_769) >> 8) as f32 / (1 << 24) as f32;
        let beauty: Vec<_> = (0..n * n).map(|i| [0.5 + noise(i); 3]).collect();
        let (albedo, normal) = (vec![[0.5; 3]; n * n], vec![[0.0, 0.0, 1.0]; n * n]);
        let images = Images { size: [n, n], beauty: &beauty, albedo: &albedo, normal: &normal };
        let clean = denoiser.denoise(&images).unwrap();
        assert_eq!(denoiser.denoise(&images).unwrap(), clean, "the same again");
        let mean = |pixels: &[[f32; 3]]| pixels.iter().map(|p| p[1]).sum::<f32>() / (n * n) as f32;
        let scatter = |pixels: &[[f32; 3]]| {
            let m = mean(pixels);
            pixels.iter().map(|p| (p[1] - m).powi(2)).sum::<f32>() / (n * n) as f32
        };
        assert!((mean(&clean) - mean(&beauty)).abs() < 0.02 * mean(&beauty), "{}", mean(&clean));
        assert!(scatter(&clean) < 0.1 * scatter(&beauty), "{} of {}", scatter(&clean), scatter(&beauty));
    }
}
