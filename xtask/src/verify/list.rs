//! What is verified.

/// A scene with a picture of it that another renderer made.
pub struct Case {
    /// Scene file, below the folder of scenes.
    pub scene: &'static str,
    /// The picture: an EXR to be compared with, or a screenshot to look at.
    pub reference: Reference,
    /// Scattering events at most, as in the reference; `None`: as the scene file says.
    pub max_depth: Option<u32>,
    /// Camera samples a pixel.
    pub passes: u32,
}

/// A picture to compare with.
pub enum Reference {
    /// Linear radiance, so many times larger each way than what is rendered; the median ratio of blocks is to lie so near 1.
    Radiance { file: &'static str, shrink: usize, bar: f64 },
    /// Of another kind of renderer: for the eye. Empty: there is none.
    Screenshot(&'static str),
}

const fn bitterli(scene: &'static str, file: &'static str, depth: u32, passes: u32) -> Case {
    let reference = Reference::Radiance { file, shrink: 4, bar: 0.02 };
    Case { scene, reference, max_depth: Some(depth), passes }
}

const fn ignis(scene: &'static str, file: &'static str, depth: u32) -> Case {
    let reference = Reference::Radiance { file, shrink: 1, bar: 0.01 };
    Case { scene, reference, max_depth: Some(depth), passes: 64 }
}

const fn gltf(scene: &'static str, screenshot: &'static str) -> Case {
    Case { scene, reference: Reference::Screenshot(screenshot), max_depth: None, passes: 64 }
}

const fn arena(scene: &'static str, file: &'static str) -> Case {
    let reference = Reference::Radiance { file, shrink: 1, bar: 0.01 };
    Case { scene, reference, max_depth: None, passes: 64 }
}

const CORNELL: &str = "bitterli-cornell-box/reference/TungstenRender.exr";
const BIDIR: &str = "bitterli-veach-bidir/reference/TungstenRender.exr";
const MIS: &str = "bitterli-veach-mis/reference/TungstenRender.exr";

/// Every scene with a picture. Mitsuba's `max_depth` counts a path's segments from the eye, the one that ends on a light included: n
/// of them have n − 1 scattering events. Bitterli's files for Mitsuba and pbrt name one more than his own for Tungsten, whose paths of
/// `max_bounces` n have n − 1 events: so what they name is two more than the events of the reference (veach-bidir tells them apart). The
/// pbrt file of veach-mis lacks the metals' tint and is not compared (pbrt's conductor has none).
pub const CASES: &[Case] = &[
    bitterli("bitterli-cornell-box/mitsuba-3/scene_v3.xml", CORNELL, 63, 128),
    bitterli("bitterli-cornell-box/pbrt-v4/scene-v4.pbrt", CORNELL, 63, 128),
    bitterli("bitterli-veach-bidir/mitsuba-3/scene_v3.xml", BIDIR, 5, 512),
    bitterli("bitterli-veach-bidir/pbrt-v4/scene-v4.pbrt", BIDIR, 5, 512),
    bitterli("bitterli-veach-mis/mitsuba-3/scene_v3.xml", MIS, 1, 128),
    ignis(
        "ignis-evaluation/evaluation/mitsuba/plane.xml",
        "ignis-evaluation/evaluation/references/ref-plane-d6-4096.exr",
        5,
    ),
    ignis(
        "ignis-evaluation/evaluation/mitsuba/room.xml",
        "ignis-evaluation/evaluation/references/ref-room-4096.exr",
        3,
    ),
    ignis(
        "ignis-evaluation/evaluation/mitsuba/point.xml",
        "ignis-evaluation/evaluation/references/ref-point-4096.exr",
        3,
    ),
    ignis(
        "ignis-evaluation/evaluation/mitsuba/sphere-light.xml",
        "ignis-evaluation/evaluation/references/ref-sphere-light-4096.exr",
        3,
    ),
    ignis(
        "ignis-evaluation/evaluation/mitsuba/multilight.xml",
        "ignis-evaluation/evaluation/references/ref-multilight-4096.exr",
        3,
    ),
    ignis(
        "ignis-evaluation/evaluation/mitsuba/emissive-plane.xml",
        "ignis-evaluation/evaluation/references/ref-emissive-plane-4096.exr",
        3,
    ),
    ignis(
        "ignis-evaluation/evaluation/mitsuba/emissive-plane-scale.xml",
        "ignis-evaluation/evaluation/references/ref-emissive-plane-scale-4096.exr",
        3,
    ),
    arena("references/box.xml", "references/box.exr"),
    arena("references/box-spheres.xml", "references/box-spheres.exr"),
    gltf("gltf/Box/Box.glb", ""),
    gltf("gltf/BoxVertexColors/BoxVertexColors.glb", ""),
    gltf("gltf/CornellBox-bevy/CornellBox.glb", ""),
    gltf("gltf/EmissiveStrengthTest/EmissiveStrengthTest.glb", ""),
    gltf("gltf/GlassVaseFlowers/GlassVaseFlowers.glb", "gltf/GlassVaseFlowers/screenshot.jpg"),
    gltf("gltf/LightsPunctualLamp/LightsPunctualLamp.gltf", "gltf/LightsPunctualLamp/screenshot.png"),
    gltf("gltf/MetalRoughSpheresNoTextures/MetalRoughSpheresNoTextures.glb", ""),
    gltf("gltf/OrientationTest/OrientationTest.glb", ""),
    gltf("gltf/SimpleInstancing/SimpleInstancing.glb", ""),
    gltf("gltf/TextureCoordinateTest/TextureCoordinateTest.glb", ""),
    gltf("gltf/TextureTransformTest/TextureTransformTest.gltf", ""),
    gltf(
        "gltf/TransmissionRoughnessTest/TransmissionRoughnessTest.glb",
        "gltf/TransmissionRoughnessTest/screenshot.jpg",
    ),
    gltf("gltf/TransmissionTest/TransmissionTest.glb", "gltf/TransmissionTest/screenshot.jpg"),
];
