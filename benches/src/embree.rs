//! The peer: Intel's Embree 4, found at run time and called through its C interface.
#![allow(unsafe_code)] // a C library

use std::ffi::{c_char, c_void};
use std::path::PathBuf;
use std::process::Command;

use libloading::Library;
use math::{Ray, Vec3};

type Handle = *mut c_void;

/// `RTCRayHit` of embree4/rtcore_ray.h: a ray (12 words), then what it hits, then room for what newer versions add.
#[repr(C, align(16))]
struct RayHit {
    origin: [f32; 3],
    t_near: f32,
    direction: [f32; 3],
    time: f32,
    t_far: f32,
    mask: u32,
    id: u32,
    flags: u32,
    normal: [f32; 3],
    u: f32,
    v: f32,
    prim: u32,
    geom: u32,
    instances: [u32; 9],
}

/// `RTC_INVALID_GEOMETRY_ID`.
const NONE: u32 = u32::MAX;
/// `RTC_SCENE_FLAG_ROBUST`.
const ROBUST: i32 = 1 << 2;

struct Functions {
    new_scene: unsafe extern "C" fn(Handle) -> Handle,
    set_scene_flags: unsafe extern "C" fn(Handle, i32),
    commit_scene: unsafe extern "C" fn(Handle),
    release_scene: unsafe extern "C" fn(Handle),
    new_geometry: unsafe extern "C" fn(Handle, i32) -> Handle,
    new_buffer: unsafe extern "C" fn(Handle, i32, u32, i32, usize, usize) -> *mut c_void,
    commit_geometry: unsafe extern "C" fn(Handle),
    attach_geometry: unsafe extern "C" fn(Handle, Handle) -> u32,
    release_geometry: unsafe extern "C" fn(Handle),
    intersect: unsafe extern "C" fn(Handle, *mut RayHit, *const c_void),
}

/// Embree with one thread.
pub(crate) struct Embree {
    device: Handle,
    functions: Functions,
}

impl Embree {
    /// Loads the library named by `$NEPHROID_EMBREE`, or the one in the package `embreex` of the Python named by
    /// `$NEPHROID_PYTHON` (default `python3`).
    ///
    /// # Errors
    /// What is missing.
    pub(crate) fn load() -> Result<Self, String> {
        let path = find()?;
        // SAFETY: the library's initialisers are Embree's own. It is never unloaded (its threads live on), hence
        // `leak`. The types are those of its C header; `get` checks that the names are there.
        unsafe {
            let library: &'static Library =
                Box::leak(Box::new(Library::new(&path).map_err(|e| format!("{}: {e}", path.display()))?));
            macro_rules! get {
                ($name:literal) => {
                    *library.get(concat!($name, "\0").as_bytes()).map_err(|e| e.to_string())?
                };
            }
            let new_device: unsafe extern "C" fn(*const c_char) -> Handle = get!("rtcNewDevice");
            let functions = Functions {
                new_scene: get!("rtcNewScene"),
                set_scene_flags: get!("rtcSetSceneFlags"),
                commit_scene: get!("rtcCommitScene"),
                release_scene: get!("rtcReleaseScene"),
                new_geometry: get!("rtcNewGeometry"),
                new_buffer: get!("rtcSetNewGeometryBuffer"),
                commit_geometry: get!("rtcCommitGeometry"),
                attach_geometry: get!("rtcAttachGeometry"),
                release_geometry: get!("rtcReleaseGeometry"),
                intersect: get!("rtcIntersect1"),
            };
            let device = new_device(c"threads=1".as_ptr());
            if device.is_null() {
                Err("Embree refuses a device".into())
            } else {
                Ok(Self { device, functions })
            }
        }
    }

    /// A scene of triangles, robust, of the default build quality.
    pub(crate) fn scene(&self, positions: &[Vec3], triangles: &[[u32; 3]]) -> EmbreeScene<'_> {
        let f = &self.functions;
        // SAFETY: the handles come from Embree and are used as its manual says; the buffers that it hands out have
        // room for the given numbers of items, in the given formats (and are padded by itself).
        unsafe {
            let geometry = (f.new_geometry)(self.device, 0);
            let vertices = (f.new_buffer)(geometry, 1, 0, 0x9003, size_of::<Vec3>(), positions.len());
            std::ptr::copy_nonoverlapping(positions.as_ptr(), vertices.cast(), positions.len());
            let indices = (f.new_buffer)(geometry, 0, 0, 0x5003, size_of::<[u32; 3]>(), triangles.len());
            std::ptr::copy_nonoverlapping(triangles.as_ptr(), indices.cast(), triangles.len());
            let scene = (f.new_scene)(self.device);
            (f.set_scene_flags)(scene, ROBUST);
            (f.commit_geometry)(geometry);
            (f.attach_geometry)(scene, geometry);
            (f.release_geometry)(geometry);
            (f.commit_scene)(scene);
            EmbreeScene { scene, embree: self }
        }
    }
}

/// A committed scene.
pub(crate) struct EmbreeScene<'a> {
    scene: Handle,
    embree: &'a Embree,
}

impl Drop for EmbreeScene<'_> {
    fn drop(&mut self) {
        // SAFETY: the handle is this value's own.
        unsafe { (self.embree.functions.release_scene)(self.scene) }
    }
}

impl EmbreeScene<'_> {
    /// t of the first hit, and the triangle.
    #[inline]
    pub(crate) fn closest(&self, ray: &Ray) -> Option<(f32, u32)> {
        let mut query = RayHit {
            origin: ray.origin.to_array(),
            t_near: 0.0,
            direction: ray.direction.to_array(),
            time: 0.0,
            t_far: ray.t_max,
            mask: u32::MAX,
            id: 0,
            flags: 0,
            normal: [0.0; 3],
            u: 0.0,
            v: 0.0,
            prim: NONE,
            geom: NONE,
            instances: [NONE; 9],
        };
        // SAFETY: the scene is committed, and the query is laid out and aligned as Embree wants it.
        unsafe { (self.embree.functions.intersect)(self.scene, &mut query, std::ptr::null()) };
        (query.geom != NONE).then_some((query.t_far, query.prim))
    }
}

fn find() -> Result<PathBuf, String> {
    if let Some(path) = std::env::var_os("NEPHROID_EMBREE") {
        return Ok(path.into());
    }
    let python = std::env::var("NEPHROID_PYTHON").unwrap_or_else(|_| "python3".into());
    let code = "import importlib.util as u; print(u.find_spec('embreex').submodule_search_locations[0])";
    let missing = || "set NEPHROID_EMBREE to the library, or install the Python package embreex".to_owned();
    let out = Command::new(python).args(["-c", code]).output().map_err(|_| missing())?;
    if !out.status.success() {
        return Err(missing());
    }
    let package = PathBuf::from(String::from_utf8_lossy(&out.stdout).trim());
    let folder = package.with_file_name("embreex.libs");
    let entries = std::fs::read_dir(&folder).map_err(|_| missing())?;
    let names = entries.filter_map(|e| e.ok()).map(|e| e.path());
    names
        .into_iter()
        .find(|p| p.file_name().is_some_and(|n| n.to_string_lossy().starts_with("libembree4")))
        .ok_or_else(missing)
}
