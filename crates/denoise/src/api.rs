//! The functions of Open Image Denoise 2 that are called, as its public header declares them. The only unsafe code of
//! this crate is here: handles are made and released in pairs, and images outlive the filter that is given their
//! addresses.
#![allow(unsafe_code, reason = "functions of a C library")]

use std::ffi::{CStr, c_char, c_int, c_void};

/// A handle of the library; null where it could not be made.
type Handle = *mut c_void;

/// `OIDN_DEVICE_TYPE_CPU`.
const CPU: c_int = 1;
/// `OIDN_FORMAT_FLOAT3`.
const FLOAT3: c_int = 3;
/// Bytes of a pixel.
const PIXEL: usize = size_of::<[f32; 3]>();

/// The library's functions.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Functions {
    pub new_device: unsafe extern "C" fn(c_int) -> Handle,
    pub set_device_bool: unsafe extern "C" fn(Handle, *const c_char, bool),
    pub get_device_int: unsafe extern "C" fn(Handle, *const c_char) -> c_int,
    pub commit_device: unsafe extern "C" fn(Handle),
    pub get_device_error: unsafe extern "C" fn(Handle, *mut *const c_char) -> c_int,
    pub release_device: unsafe extern "C" fn(Handle),
    pub new_filter: unsafe extern "C" fn(Handle, *const c_char) -> Handle,
    pub set_image:
        unsafe extern "C" fn(Handle, *const c_char, *mut c_void, c_int, usize, usize, usize, usize, usize),
    pub set_filter_bool: unsafe extern "C" fn(Handle, *const c_char, bool),
    pub commit_filter: unsafe extern "C" fn(Handle),
    pub execute_filter: unsafe extern "C" fn(Handle),
    pub release_filter: unsafe extern "C" fn(Handle),
}

/// Loads a library by its path, or by a name that the system looks up.
pub(crate) fn load(name: &std::ffi::OsStr) -> Result<libloading::Library, String> {
    // SAFETY: what runs while it is loaded is the library's own; the user chose it.
    unsafe { libloading::Library::new(name) }.map_err(|error| error.to_string())
}

impl Functions {
    /// Those of a library, which must outlive them, or the name of the first that it lacks.
    pub(crate) fn of(library: &libloading::Library) -> Result<Self, &'static str> {
        macro_rules! get {
            ($name:literal) => {{
                // SAFETY: the types are those of the public header of version 2; the version is asked before others are called.
                let symbol = unsafe { library.get($name.as_bytes()) };
                *symbol.map_err(|_| $name)?
            }};
        }
        Ok(Self {
            new_device: get!("oidnNewDevice"),
            set_device_bool: get!("oidnSetDeviceBool"),
            get_device_int: get!("oidnGetDeviceInt"),
            commit_device: get!("oidnCommitDevice"),
            get_device_error: get!("oidnGetDeviceError"),
            release_device: get!("oidnReleaseDevice"),
            new_filter: get!("oidnNewFilter"),
            set_image: get!("oidnSetSharedFilterImage"),
            set_filter_bool: get!("oidnSetFilterBool"),
            commit_filter: get!("oidnCommitFilter"),
            execute_filter: get!("oidnExecuteFilter"),
            release_filter: get!("oidnReleaseFilter"),
        })
    }
}

/// A device that computes on the processor; released when dropped.
pub(crate) struct Device<'f> {
    functions: &'f Functions,
    handle: Handle,
}

/// Planes that a filter reads, by the library's names for them.
pub(crate) type Inputs<'a> = [(&'static CStr, &'a [[f32; 3]])];

impl<'f> Device<'f> {
    /// Makes one.
    pub(crate) fn new(functions: &'f Functions) -> Result<Self, String> {
        // SAFETY: makes a handle or null; null is not used but to ask what went wrong, which the library allows.
        let handle = unsafe { (functions.new_device)(CPU) };
        let device = Self { functions, handle };
        if handle.is_null() {
            return Err(device.error().err().unwrap_or_else(|| "it has no device for this processor".into()));
        }
        // SAFETY: the handle is valid, names end in NUL.
        unsafe {
            // Threads are left where the system puts them: others render on the same cores.
            (functions.set_device_bool)(handle, c"setAffinity".as_ptr(), false);
            (functions.commit_device)(handle);
        }
        device.error()?;
        Ok(device)
    }

    /// A number that the device knows.
    pub(crate) fn int(&self, name: &CStr) -> i32 {
        // SAFETY: the handle is valid, the name ends in NUL.
        unsafe { (self.functions.get_device_int)(self.handle, name.as_ptr()) }
    }

    /// Denoises planes of one size into `out`; all slices hold `size[0]` times `size[1]` pixels, which is checked.
    pub(crate) fn filter(
        &self,
        size: [usize; 2],
        inputs: &Inputs<'_>,
        flags: &[&CStr],
        out: &mut [[f32; 3]],
    ) -> Result<(), String> {
        let pixels = size[0].checked_mul(size[1]);
        if inputs.iter().map(|(_, plane)| plane.len()).chain([out.len()]).any(|n| Some(n) != pixels) {
            return Err("planes of other sizes".into());
        }
        let f = self.functions;
        let [width, height] = size;
        // SAFETY: the device is valid, names end in NUL; planes have the size that is told, are not written but for the
        // output, and live until the filter is released below.
        unsafe {
            let filter = (f.new_filter)(self.handle, c"RT".as_ptr());
            if filter.is_null() {
                return Err(self.error().err().unwrap_or_else(|| "it makes no filter".into()));
            }
            let set = |name: &CStr, at: *mut c_void| {
                (f.set_image)(filter, name.as_ptr(), at, FLOAT3, width, height, 0, PIXEL, PIXEL * width);
            };
            for (name, plane) in inputs {
                set(name, plane.as_ptr().cast_mut().cast());
            }
            set(c"output", out.as_mut_ptr().cast());
            for flag in flags {
                (f.set_filter_bool)(filter, flag.as_ptr(), true);
            }
            (f.commit_filter)(filter);
            (f.execute_filter)(filter);
            (f.release_filter)(filter);
        }
        self.error()
    }

    /// What went wrong since this was last asked.
    fn error(&self) -> Result<(), String> {
        let mut message = std::ptr::null();
        // SAFETY: the handle is valid or null, for which the library tells of the thread's last error; the message is text
        // that lives until the next call.
        unsafe {
            let code = (self.functions.get_device_error)(self.handle, &mut message);
            if code == 0 {
                return Ok(());
            }
            if message.is_null() {
                return Err(format!("error {code}"));
            }
            Err(CStr::from_ptr(message).to_string_lossy().into_owned())
        }
    }
}

impl Drop for Device<'_> {
    fn drop(&mut self) {
        if !self.handle.is_null() {
            // SAFETY: the handle is valid and not used again.
            unsafe { (self.functions.release_device)(self.handle) }
        }
    }
}
