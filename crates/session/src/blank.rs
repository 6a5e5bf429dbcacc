use film::{Film, Layer};
use scene::Scene;
use scenefile::Diagnostic;

use crate::PictureInfo;

/// What the brightest pixel of a dark picture and the darkest of a white one is after exposure: black and white under every
/// view.
const DARK: f32 = 1.0 / 256.0;
const WHITE: f32 = 16.0;
/// The share of pixels that makes a picture white.
const NEARLY_ALL: f32 = 0.95;

/// Why the picture of `film` is black or white all over; `None` where it is not.
pub(crate) fn blank(film: &Film, scene: &Scene, info: &PictureInfo) -> Option<Diagnostic> {
    let luminance: Vec<f32> = film.beauty().into_iter().map(color::luminance).collect();
    let brightest = luminance.iter().copied().fold(0.0, f32::max);
    if brightest == 0.0 {
        return Some(unlit(film, scene));
    }
    let settled = info.settle(film);
    if settled.is_automatic {
        return None;
    }
    let exposed = |luminance: f32| luminance * settled.ev.exp2();
    let steps = |from: f32, to: f32| (to / from).log2() + settled.ev;
    let set = format!("at an exposure of {} EV", settled.ev);
    if exposed(brightest) < DARK {
        let message = format!("the picture is black: its brightest pixel is {brightest:.1e}, {set}");
        let try_this = steps(exposed(brightest), 1.0).round();
        return Some(Diagnostic::warning("picture-dark", message).help(try_exposure(try_this)));
    }
    let white = luminance.iter().filter(|&&l| exposed(l) >= WHITE).count() as f32;
    if white >= NEARLY_ALL * luminance.len() as f32 {
        let mut sorted = luminance;
        sorted.sort_by(f32::total_cmp);
        let median = sorted[sorted.len() / 2];
        let message =
            format!("the picture is white: half of its pixels are brighter than {median:.1e}, {set}");
        let try_this = steps(exposed(median), 0.18).round();
        return Some(Diagnostic::warning("picture-white", message).help(try_exposure(try_this)));
    }
    None
}

fn try_exposure(ev: f32) -> String {
    format!("try `--exposure {ev}`, or `--exposure auto`; `nephroid develop` does it without rendering again")
}

/// Why no light at all reached the film.
fn unlit(film: &Film, scene: &Scene) -> Diagnostic {
    let dark = |why: &str, help: &str| {
        Diagnostic::warning("picture-dark", format!("the picture is black: {why}")).help(help)
    };
    if !film.layer(Layer::Depth).iter().any(|depth| depth.is_finite()) {
        let [eye, middle] = [scene.camera().position(), scene.bounds().center()].map(|p| p.to_array());
        return dark(
            &format!("the camera at {eye:?} sees no surface"),
            &format!(
                "the middle of what there is lies at {middle:?}: look there, `--camera X,Y,Z:X,Y,Z:FOV`"
            ),
        );
    }
    if scene.lights().is_empty() {
        let help = "give an object `radiance` or `lumens`, or add one of [[lights]]";
        return dark("nothing emits light", help);
    }
    let idle: Vec<_> =
        scene.light_ids().filter(|&id| scene.meets_nothing(id)).map(|id| scene.light_name(id)).collect();
    if let [first, ..] = idle.as_slice() {
        let all = if idle.len() > 1 { format!(" and {} more", idle.len() - 1) } else { String::new() };
        return dark(
            &format!("what `{first}`{all} sends out meets nothing"),
            "light leaves a surface on the side of its normal: turn it with `flip_normals = true`",
        );
    }
    dark(
        "there is light, but none of it reaches what the camera sees",
        "look for a closed wall between, a lamp inside of a solid, or surfaces of colour 0",
    )
}

#[cfg(test)]
mod tests {
    use scenefile::SceneDesc;
    use scenefile::desc::{Camera, Emission, Light, LightKind, Material, Object, Shape};

    use super::*;
    use crate::{Control, Job, Session, compile};

    /// What is said of a ball of radius 1 in the origin, seen from z = 4.
    fn said(change: impl FnOnce(&mut SceneDesc)) -> Option<String> {
        let camera = Camera { position: [0.0, 0.0, 4.0], ..Camera::default() };
        let mut desc = SceneDesc { camera: Some(camera.into()), ..SceneDesc::default() };
        desc.film.size = [16, 16];
        desc.film.exposure = color::Exposure::Ev(0.0);
        let ball = Shape::Sphere { center: [0.0; 3], radius: 1.0 };
        desc.objects.push(Object::new(ball, Material::diffuse(0.5)).into());
        change(&mut desc);
        let scene = compile(&desc, 1).unwrap().scene;
        let job = Job { passes: 0..1, ..Job::new(&desc, scene).unwrap() };
        let mut session = Session::new(job, 1).unwrap();
        session.run(&mut |_| Control::Continue).unwrap();
        session
            .blank(&PictureInfo::new(&desc, crate::scene_hash(&desc).unwrap()))
            .map(|blank| format!("{} / {}", blank.message, blank.help.unwrap_or_default()))
    }

    fn sky(desc: &mut SceneDesc, radiance: f32) {
        desc.lights.push(Light::from(LightKind::Environment { radiance: [radiance; 3] }).into());
    }

    #[test]
    fn a_picture_with_light_is_not_blank() {
        assert_eq!(said(|desc| sky(desc, 1.0)), None);
        assert_eq!(said(|desc| sky(desc, 0.02)), None);
    }

    #[test]
    fn exposures_that_hide_a_picture_are_told() {
        let dark = said(|desc| sky(desc, 1e-4)).unwrap();
        assert!(dark.contains("brightest pixel is 1.0e-4") && dark.contains("--exposure 13"), "{dark}");
        let white = said(|desc| sky(desc, 1e4)).unwrap();
        assert!(white.contains("white") && white.contains("--exposure -1"), "{white}");
        let automatic = said(|desc| {
            sky(desc, 1e-4);
            desc.film.exposure = color::Exposure::Auto;
        });
        assert_eq!(automatic, None);
    }

    #[test]
    fn what_keeps_a_picture_black_is_told() {
        let lamp = |normal| {
            let disk = Shape::Disk { center: [0.0, 3.0, 0.0], normal, radius: 0.3 };
            let emission = Some(Emission::radiance([5.0; 3]).into());
            Object { emission, ..Object::new(disk, Material::diffuse(0.0)) }
        };
        let away = said(|desc| desc.objects.push(lamp([0.0, 1.0, 0.0]).into())).unwrap();
        assert!(away.contains("meets nothing"), "{away}");
        let behind = said(|desc| {
            desc.objects.push(lamp([0.0, -1.0, 0.0]).into());
            desc.camera = Some(
                Camera { look_at: [0.0, 0.0, 9.0], position: [0.0, 0.0, 4.0], ..Camera::default() }.into(),
            );
        });
        assert!(behind.unwrap().contains("sees no surface"));
        assert!(said(|_| {}).unwrap().contains("nothing emits light"));
        let shut = said(|desc| {
            desc.objects.push(lamp([0.0, -1.0, 0.0]).into());
            let lid = Shape::Sphere { center: [0.0, 3.0, 0.0], radius: 0.5 };
            desc.objects.push(Object::new(lid, Material::diffuse(0.0)).into());
        });
        assert!(shut.unwrap().contains("none of it reaches"));
    }
}
