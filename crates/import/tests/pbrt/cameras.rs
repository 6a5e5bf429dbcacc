//! Cameras and the parts of a picture.

use super::*;

const BALL: &str = "LightSource \"point\"\nTranslate 2 0 5\nShape \"sphere\"\n";

fn film(width: u32, height: u32, more: &str) -> String {
    format!("Film \"rgb\" \"integer xresolution\" {width} \"integer yresolution\" {height} {more}\n")
}

#[test]
fn a_part_of_the_picture() {
    // fov 90 over the shorter side: the window is ±2 by ±1. Its right upper quarter.
    let crop = film(200, 100, "\"float cropwindow\" [.5 1 0 .5]");
    let part = desc(&format!("{crop}Camera \"perspective\"\nWorldBegin\n{BALL}"));
    let camera = part.camera.as_ref().unwrap();
    assert_eq!((part.film.size, camera.shift, camera.fov_axis), ([100, 50], [0.5, 0.5], FovAxis::Y));
    close([camera.fov], [2.0 * 0.5f32.atan().to_degrees()]);
    // Rows 80 to 100 of all columns, from −1 to −0.6.
    let bounds = film(200, 100, "\"integer pixelbounds\" [0 200 80 100]");
    let part = desc(&format!("{bounds}Camera \"perspective\"\nWorldBegin\n{BALL}"));
    let camera = part.camera.as_ref().unwrap();
    assert_eq!(part.film.size, [200, 20]);
    close(camera.shift, [0.0, -0.8 / 0.4]);
    close([camera.fov], [2.0 * 0.2f32.atan().to_degrees()]);
    // A window off the middle, of square pixels.
    let text = "Camera \"perspective\" \"float screenwindow\" [0 2 -.5 .5]\n";
    let window = desc(&format!("{}{text}WorldBegin\n{BALL}", film(200, 100, "")));
    assert_eq!(window.camera.as_ref().unwrap().shift, [0.5, 0.0]);
}

#[test]
fn parallel_rays() {
    let text = "Scale .5 .5 .5\nCamera \"orthographic\" \"float screenwindow\" [-3 3 -1.5 1.5]\n";
    let desc = desc(&format!("{}{text}WorldBegin\n{BALL}", film(200, 100, "")));
    let camera = desc.camera.as_ref().unwrap();
    // 3 units high in a world twice as large.
    assert_eq!(camera.kind, CameraKind::Orthographic { extent: 6.0 });
    assert_eq!((camera.fov_axis, camera.shift), (FovAxis::Y, [0.0; 2]));
}

#[test]
fn the_whole_sphere() {
    type V = [f32; 3];
    let cross = |a: V, b: V| -> V {
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    };
    for scale in ["1 1 1", "-1 1 1"] {
        for (mapping, uv, pbrt) in [
            // pbrt-v4, SphericalCamera: (sin θ cos φ, cos θ, sin θ sin φ), θ = πv and φ = 2πu.
            ("equirectangular", [0.0, 0.5], [1.0, 0.0, 0.0]),
            ("equirectangular", [0.25, 0.5], [0.0, 0.0, 1.0]),
            ("equirectangular", [0.6, 0.0], [0.0, 1.0, 0.0]),
            // The middle is +z there and y and z change places; +x at the right, +y at the bottom.
            ("equalarea", [0.5, 0.5], [0.0, 1.0, 0.0]),
            ("equalarea", [1.0, 0.5], [1.0, 0.0, 0.0]),
            ("equalarea", [0.5, 1.0], [0.0, 0.0, 1.0]),
        ] {
            let text = format!("Scale {scale}\nCamera \"spherical\" \"string mapping\" \"{mapping}\"\n");
            let desc = desc(&format!("{text}WorldBegin\nLightSource \"point\"\nShape \"sphere\"\n"));
            let camera = desc.camera.as_ref().unwrap();
            let ahead: V = std::array::from_fn(|i| camera.look_at[i] - camera.position[i]);
            let CameraKind::Spherical { mapping } = camera.kind else { panic!() };
            let axis = |x: V, s: f32| x.map(|c| c * s);
            // Where the point of the picture is seen here, as the descriptions of camera and mapping say.
            let seen = match (mapping, uv) {
                (scenefile::desc::SkyMapping::LatLong, [_, 0.0]) => camera.up,
                (scenefile::desc::SkyMapping::LatLong, [u, _]) => {
                    let (s, c) = (std::f32::consts::TAU * u).sin_cos();
                    let x = cross(camera.up, ahead);
                    std::array::from_fn(|i| s * x[i] - c * ahead[i])
                }
                (_, [_, 1.0]) => axis(camera.up, -1.0),
                (_, [1.0, _]) => cross(ahead, camera.up),
                _ => ahead,
            };
            // The ball of radius 1 tells whether the world was mirrored.
            let mirrored = matrix(&desc.objects[0])[0];
            let camera_x = if scale.starts_with('-') { -1.0 } else { 1.0 };
            close(seen, [pbrt[0] * camera_x * mirrored, pbrt[1], pbrt[2]]);
        }
    }
}

#[test]
fn lens_systems() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("lens.dat"), "# f = 100 mm\n50 0 1.5 10\n1e12 5 1 10\n").unwrap();
    let text = "Camera \"realistic\" \"string lensfile\" \"lens.dat\" \"float aperturediameter\" 8 \"float focusdistance\" 1e6\n";
    let film = film(300, 200, "\"float diagonal\" 36.0555");
    let loaded = read_in(folder.path(), &format!("{film}{text}WorldBegin\n{BALL}"));
    assert!(loaded.diagnostics.len() == 1 && loaded.render().contains("100.0 mm"), "{}", loaded.render());
    let desc = loaded.desc.unwrap();
    let camera = desc.camera.as_ref().unwrap();
    // A film of 30 by 20 mm behind a lens of 100.
    close([camera.fov], [2.0 * 0.1f32.atan().to_degrees()]);
    let CameraKind::ThinLens { lens_radius, .. } = camera.kind else { panic!() };
    close([lens_radius], [0.004]);
}
