use super::*;
use sampling::{Domain, Sampler};

fn arena() -> Camera {
    let position = Vec3::new(2.78, 2.73, -8.0);
    Camera::perspective(position, position + Vec3::Z, Vec3::Y, Fov::Smaller(39.307_648), [256, 256], None)
        .unwrap()
}

fn thin() -> Camera {
    let lens = Lens { radius: 0.2, focus_distance: 3.0 };
    Camera::perspective(Vec3::ONE, Vec3::ZERO, Vec3::Y, Fov::Vertical(50.0), [40, 20], Some(lens)).unwrap()
}

#[test]
fn plus_x_is_left_for_a_camera_that_looks_along_plus_z() {
    let camera = arena();
    for (x, y, z) in [(2.78, 2.73, 3.0), (0.5, 4.0, 5.6), (4.9, 0.1, 0.2), (3.2, 5.0, 1.0)] {
        let k = (z + 8.0) * 12.5 / 35.0;
        let expected = Vec2::new(128.0 * (1.0 - (x - 2.78) / k), 128.0 * (1.0 - (y - 2.73) / k));
        let p = Vec3::new(x, y, z);
        let found = camera.film_position(camera.position(), p - camera.position()).unwrap();
        assert!(found.distance(expected) < 1e-3, "{found} {expected}");
        let connected = camera.sample_wi(p, [0.3, 0.6]).unwrap();
        assert!(connected.film_position.distance(expected) < 1e-3);
        let ray = camera.sample_we(expected, [0.3, 0.6]).ray;
        let t = p.distance(ray.origin);
        assert!(ray.at(t).distance(p) < 1e-4);
    }
    assert_eq!(camera.film_position(camera.position(), -Vec3::Z), None, "behind");
    assert_eq!(camera.film_position(camera.position(), Vec3::X + Vec3::Z), None, "outside");
}

#[test]
fn rays_and_film_positions_are_inverse_and_focus_is_sharp() {
    let camera = thin();
    for i in 0..200 {
        let mut s = Sampler::new(1, 0, Domain::Other, i);
        let film = Vec2::new(s.next_1d() * 40.0, s.next_1d() * 20.0);
        let [a, b] = [camera.sample_we(film, s.next_2d()).ray, camera.sample_we(film, s.next_2d()).ray];
        let found = camera.film_position(a.origin, a.direction).unwrap();
        assert!(found.distance(film) < 1e-3, "{found} {film}");
        let in_focus = |r: Ray| r.at(3.0 / r.direction.dot(camera.forward()));
        assert!(in_focus(a).distance(in_focus(b)) < 1e-5);
        assert!((a.origin.distance(Vec3::ONE)) <= 0.2 + 1e-6);
    }
}

#[test]
fn fields_of_view() {
    let edge = |fov, resolution: [u32; 2], film: Vec2| {
        let c = Camera::perspective(Vec3::ZERO, Vec3::Z, Vec3::Y, fov, resolution, None).unwrap();
        c.sample_we(film, [0.5; 2]).ray.direction.angle_between(Vec3::Z).to_degrees()
    };
    let close = |a: f32, b: f32| assert!((a - b).abs() < 1e-3, "{a} {b}");
    close(edge(Fov::Vertical(40.0), [80, 20], Vec2::new(40.0, 0.0)), 20.0);
    close(edge(Fov::Horizontal(40.0), [80, 20], Vec2::new(0.0, 10.0)), 20.0);
    close(edge(Fov::Smaller(40.0), [80, 20], Vec2::new(40.0, 0.0)), 20.0);
    close(edge(Fov::Smaller(40.0), [20, 80], Vec2::new(0.0, 40.0)), 20.0);
    let c = arena().with_resolution([512, 256]).unwrap();
    close(
        c.sample_we(Vec2::new(256.0, 0.0), [0.5; 2]).ray.direction.angle_between(Vec3::Z).to_degrees(),
        19.653_824,
    );
}

fn shifted() -> Camera {
    arena().with_resolution([64, 32]).unwrap().shifted(Vec2::new(0.25, -0.5)).unwrap()
}

fn parallel() -> Camera {
    let position = Vec3::new(1.0, 2.0, 3.0);
    Camera::orthographic(position, Vec3::ZERO, Vec3::Y, Side::Height, 1.5, [40, 20])
        .and_then(|camera| camera.shifted(Vec2::new(0.1, 0.3)))
        .unwrap()
}

fn globe(map: SkyMapping) -> Camera {
    let position = Vec3::new(0.3, -0.2, 0.1);
    Camera::spherical(position, position + Vec3::new(0.2, 0.1, -1.0), Vec3::Y, map, [12, 8]).unwrap()
}

#[test]
fn a_shift_moves_the_picture() {
    let [still, moved] = [arena().with_resolution([64, 32]).unwrap(), shifted()];
    // A quarter of the width to the right: what was there is in the middle. Half the height down.
    let p = still.sample_we(Vec2::new(32.0 + 16.0, 16.0 + 16.0 - 1e-3), [0.5; 2]).ray.at(3.0);
    let found = moved.sample_wi(p, [0.5; 2]).unwrap().film_position;
    assert!(found.distance(Vec2::new(32.0, 16.0)) < 2e-3, "{found}");
    let again = moved.with_resolution([128, 64]).unwrap().sample_wi(p, [0.5; 2]).unwrap().film_position;
    assert!(again.distance(Vec2::new(64.0, 32.0)) < 4e-3, "{again}");
    assert_eq!(arena().shifted(Vec2::new(f32::NAN, 0.0)), Err(CameraError::NotFinite));
}

#[test]
fn parallel_rays_cover_their_extent() {
    let camera = parallel();
    let [a, b] = [Vec2::ZERO, Vec2::new(40.0, 20.0)].map(|film| camera.sample_we(film, [0.5; 2]));
    assert_eq!(a.ray.direction, b.ray.direction);
    assert!(a.ray.direction.distance(camera.forward()) < 1e-6);
    let across = b.ray.origin - a.ray.origin;
    assert!((across.length() - 1.5f32.hypot(3.0)).abs() < 1e-5, "{across}");
    assert!(across.dot(camera.forward()).abs() < 1e-5);
    assert!(a.spread == 0.0 && (a.width - 1.5 / 20.0).abs() < 1e-6);
    let behind = camera.position() - camera.forward();
    assert_eq!(camera.sample_wi(behind, [0.5; 2]), None);
    for i in 0..100 {
        let mut s = Sampler::new(2, 0, Domain::Other, i);
        let film = Vec2::new(s.next_1d() * 40.0, s.next_1d() * 20.0);
        let ray = camera.sample_we(film, s.next_2d()).ray;
        let found = camera.film_position(ray.origin, ray.direction).unwrap();
        let to = camera.sample_wi(ray.at(5.0), [0.5; 2]).unwrap();
        assert!(found.distance(film) < 1e-4 && to.film_position.distance(film) < 1e-4, "{found} {film}");
        assert!(to.p.distance(ray.origin) < 1e-5 && (to.distance - 5.0).abs() < 1e-5);
        let area = 1.0 / camera.pdf_we(ray.origin, ray.direction).across(7.0);
        assert!((area - (1.5f64 / 20.0).powi(2)).abs() < 1e-7, "{area}");
    }
}

#[test]
fn a_globe_sees_what_lies_where() {
    for map in [SkyMapping::LatLong, SkyMapping::EqualArea] {
        let camera = globe(map);
        let ahead = camera.sample_we(Vec2::new(6.0, 4.0), [0.5; 2]).ray.direction;
        assert!(ahead.distance(camera.forward()) < 1e-6, "{map:?}");
        let right = camera.sample_we(Vec2::new(9.0, 4.0), [0.5; 2]).ray.direction;
        assert!(right.dot(camera.forward().cross(Vec3::Y)) > 0.6, "{map:?} {right}");
        let above = camera.sample_we(Vec2::new(6.0, 1.0), [0.5; 2]).ray.direction;
        assert!(above.y > 0.6, "{map:?} {above}");
        for i in 0..500 {
            let mut s = Sampler::new(2, 0, Domain::Other, i);
            let film = Vec2::new(s.next_1d() * 12.0, s.next_1d() * 8.0);
            let ray = camera.sample_we(film, s.next_2d()).ray;
            let found = camera.film_position(ray.origin, ray.direction).unwrap();
            let to = camera.sample_wi(ray.at(5.0), [0.5; 2]).unwrap();
            // About the poles of longitudes a pixel's width is nothing.
            let about =
                if map == SkyMapping::LatLong { 4.0 * ray.direction.x.hypot(ray.direction.z) } else { 1.0 };
            assert!((found - film).x.abs() * about.min(1.0) < 1e-4, "{found} {film}");
            assert!((found - film).y.abs() < 1e-4 && to.film_position.distance(found) < 1e-3);
        }
        // Beyond the border is what the sphere goes on with.
        let beyond = camera.sample_we(Vec2::new(-0.2, 3.0), [0.5; 2]).ray;
        assert!(camera.film_position(beyond.origin, beyond.direction).is_some());
        assert!(!camera.holds(Vec2::new(-0.2, 3.0)) && !camera.holds(Vec2::new(12.0, 3.0)));
    }
}

#[test]
fn pdf_is_the_jacobian_of_film_to_directions() {
    // A pixel's solid angle, measured as the sum of the solid angles of a fine grid within it.
    for camera in [arena(), thin(), shifted(), globe(SkyMapping::LatLong), globe(SkyMapping::EqualArea)] {
        let film = Vec2::new(3.0, 2.0);
        let u = [0.9, 0.2];
        let ray = |x: f32, y: f32| camera.sample_we(film + Vec2::new(x, y), u).ray;
        let c = ray(0.5, 0.5);
        let h = 0.05;
        let dx = (ray(0.5 + h, 0.5).direction - ray(0.5 - h, 0.5).direction) / (2.0 * h);
        let dy = (ray(0.5, 0.5 + h).direction - ray(0.5, 0.5 - h).direction) / (2.0 * h);
        let solid_angle = dx.cross(dy).length();
        let WePdf::PerSteradian(pdf) = camera.pdf_we(c.origin, c.direction) else { panic!() };
        let product = f64::from(solid_angle) * pdf;
        assert!((product - 1.0).abs() < 2e-3, "{product}");
        let spread = camera.sample_we(film + Vec2::splat(0.5), u).spread;
        assert!((spread * spread / solid_angle - 1.0).abs() < 2e-3);
    }
}

/// A point of a surface that shines everywhere, uniform with this density per area, and the surface's normal.
type Shining = fn([f32; 2]) -> (Vec3, Vec3, f32);

fn plane(u: [f32; 2]) -> (Vec3, Vec3, f32) {
    let half = 1.5;
    (((Vec2::from(u) * 2.0 - Vec2::ONE) * half).extend(0.0), Vec3::Z, 1.0 / (4.0 * half * half))
}

fn shell(u: [f32; 2]) -> (Vec3, Vec3, f32) {
    let w = warp::sphere(u);
    (2.0 * w, -w, warp::SPHERE_PDF_W / 4.0)
}

/// Means over pixels of what light points of radiance 1, connected to the camera, give: f·flux = L/p_area.
fn traced(camera: &Camera, surface: Shining, n: u64) -> Vec<(f64, f64)> {
    let [width, height] = camera.resolution().map(|n| n as usize);
    let mut sums = vec![(0f64, 0f64); width * height];
    for i in 0..n {
        let mut s = Sampler::new(3, 0, Domain::Other, i);
        let (p, n, pdf_a) = surface(s.next_2d());
        if let Some(c) = camera.sample_wi(p, s.next_2d()) {
            let pixel = c.film_position.y as usize * width + c.film_position.x as usize;
            let x = f64::from(c.importance * c.wi.dot(n).abs() / pdf_a);
            sums[pixel].0 += x;
            sums[pixel].1 += x * x;
        }
    }
    let n = n as f64;
    sums.iter().map(|(s, s2)| (s / n, ((s2 / n - (s / n).powi(2)) / n).sqrt())).collect()
}

#[test]
fn light_traced_to_the_film_is_the_radiance_that_rays_see() {
    let position = Vec3::new(0.3, -0.2, 2.0);
    let look = Vec3::new(0.0, 0.1, 0.0);
    let lens = Lens { radius: 0.1, focus_distance: 1.5 };
    let view =
        |lens| Camera::perspective(position, look, Vec3::Y, Fov::Vertical(30.0), [4, 3], lens).unwrap();
    let flat = Camera::orthographic(position, look, Vec3::Y, Side::Width, 1.6, [4, 3]).unwrap();
    let round = |map| globe(map).with_resolution([4, 3]).unwrap();
    let shift = Vec2::new(-0.2, 0.3);
    let cases: [(Camera, Shining); 7] = [
        (view(None), plane),
        (view(Some(lens)), plane),
        (view(None).shifted(shift).unwrap(), plane),
        (flat, plane),
        (flat.shifted(shift).unwrap(), plane),
        (round(SkyMapping::EqualArea), shell),
        (round(SkyMapping::LatLong), shell),
    ];
    for (camera, surface) in cases {
        for (mean, error) in traced(&camera, surface, 200_000) {
            assert!((mean - 1.0).abs() < 4.5 * error && error < 0.02, "{camera:?}: {mean} ± {error}");
        }
    }
}

#[test]
fn mistakes_are_named() {
    let make = |at: Vec3, up: Vec3, fov: f32, resolution: [u32; 2], lens: Option<Lens>| {
        Camera::perspective(Vec3::ZERO, at, up, Fov::Vertical(fov), resolution, lens).err()
    };
    let size = [2, 2];
    assert_eq!(make(Vec3::NAN, Vec3::Y, 40.0, size, None), Some(CameraError::NotFinite));
    assert_eq!(make(Vec3::ZERO, Vec3::Y, 40.0, size, None), Some(CameraError::NoDirection));
    assert_eq!(make(Vec3::Y, Vec3::Y, 40.0, size, None), Some(CameraError::BadUp));
    assert_eq!(make(Vec3::Z, Vec3::Y, 180.0, size, None), Some(CameraError::BadFov));
    assert_eq!(make(Vec3::Z, Vec3::Y, f32::NAN, size, None), Some(CameraError::BadFov));
    assert_eq!(make(Vec3::Z, Vec3::Y, 40.0, [0, 2], None), Some(CameraError::NoPixels));
    let lens = Lens { radius: 0.0, focus_distance: 1.0 };
    assert_eq!(make(Vec3::Z, Vec3::Y, 40.0, size, Some(lens)), Some(CameraError::BadLens));
    let flat =
        |extent, size| Camera::orthographic(Vec3::ZERO, Vec3::Z, Vec3::Y, Side::Smaller, extent, size).err();
    assert_eq!(flat(0.0, size), Some(CameraError::BadExtent));
    assert_eq!(flat(f32::INFINITY, size), Some(CameraError::BadExtent));
    assert_eq!(flat(1.0, [0, 1]), Some(CameraError::NoPixels));
    let all = Camera::spherical(Vec3::ZERO, Vec3::Z, Vec3::Z, SkyMapping::LatLong, size).err();
    assert_eq!(all, Some(CameraError::BadUp));
}
