use scene::{LightId, Scene};
use scenefile::{Diagnostic, SceneDesc};

/// Rays along each side of the picture that look about.
const SIDE: u32 = 8;

/// What is odd about the place of the camera: inside a dielectric, or inside a solid whose back is all that it sees.
pub(crate) fn camera_warning(scene: &Scene, desc: &SceneDesc) -> Option<Diagnostic> {
    let span = desc.camera.as_ref().and_then(|camera| camera.span);
    if let Some(medium) = scene.camera_medium(scene.camera().position()).current() {
        let message = format!("the camera is inside a dielectric of index {}", medium.ior);
        let help = "move it outside, unless it is meant to look out of the glass or the water";
        return Some(Diagnostic::warning("camera-inside", message).at(span).help(help));
    }
    let inside = "the camera is inside a solid: wherever it looks, it sees the back of one material";
    let help = "move it outside, or set `flip_normals = true` on the object if that is a room";
    sees_one_back(scene).then(|| Diagnostic::warning("camera-inside", inside).at(span).help(help))
}

/// Whether rays through the picture, and those against them, all meet the back of the same material, which neither
/// shines nor lets light through.
fn sees_one_back(scene: &Scene) -> bool {
    let size = scene.resolution().map(|n| n as f32);
    let mut material = None;
    for i in 0..SIDE * SIDE {
        let at = |k: u32, size: f32| (k as f32 + 0.5) / SIDE as f32 * size;
        let position = [at(i % SIDE, size[0]), at(i / SIDE, size[1])];
        let ahead = scene.camera().sample_we(position.into(), [0.5; 2]).ray;
        let mut behind = ahead;
        behind.direction = -behind.direction;
        for ray in [ahead, behind] {
            let Some(hit) = scene.intersect(&ray) else { return false };
            let back = ray.direction.dot(hit.ng) > 0.0;
            let same = *material.get_or_insert(hit.material) == hit.material;
            if !back || !same || hit.light.is_some() || scene.medium(&hit).is_some() {
                return false;
            }
        }
    }
    true
}

/// Lamps that shine away from everything.
pub(crate) fn lamp_warnings(scene: &Scene) -> Vec<Diagnostic> {
    let turned = |id: &LightId| scene.is_turned_away(*id);
    let warning = |id: LightId| {
        let message =
            format!("the lamp `{}` shines away from the scene and the camera", scene.light_name(id));
        let help = "light leaves on the side of the normal: turn it with `flip_normals = true`, or let both sides \
                    shine with `two_sided_emission = true`";
        Diagnostic::warning("lamp-turned-away", message).help(help)
    };
    scene.light_ids().filter(turned).map(warning).collect()
}

#[cfg(test)]
mod tests {
    use scenefile::SceneDesc;
    use scenefile::desc::{Camera, Emission, Group, Instance, Light, LightKind, Material, Object, Shape};

    fn warnings(material: Material, radius: f32, more: impl FnOnce(&mut SceneDesc)) -> Vec<String> {
        let camera = Camera { position: [0.0, 0.0, 4.0], ..Camera::default() };
        let mut desc = SceneDesc { camera: Some(camera.into()), ..SceneDesc::default() };
        desc.lights.push(Light::from(LightKind::Environment { radiance: [1.0; 3] }).into());
        desc.objects.push(Object::new(Shape::Sphere { center: [0.0; 3], radius }, material).into());
        more(&mut desc);
        crate::compile(&desc, 1).unwrap().warnings.iter().map(|d| d.message.clone()).collect()
    }

    fn glass() -> Material {
        Material::dielectric(1.5)
    }

    #[test]
    fn a_camera_inside_a_solid_is_told() {
        assert_eq!(warnings(Material::diffuse(0.5), 1.0, |_| {}), Vec::<String>::new());
        assert!(warnings(Material::diffuse(0.5), 9.0, |_| {})[0].contains("inside a solid"));
        assert_eq!(warnings(glass(), 1.0, |_| {}), Vec::<String>::new());
        assert!(warnings(glass(), 9.0, |_| {})[0].contains("dielectric of index 1.5"));
    }

    #[test]
    fn lamps_that_are_turned_away_are_told() {
        let lamp = |normal: [f32; 3], center: [f32; 3]| {
            warnings(Material::diffuse(0.5), 1.0, |desc| {
                let disk = Object::new(Shape::Disk { center, normal, radius: 0.3 }, Material::diffuse(0.0));
                desc.objects
                    .push(Object { emission: Some(Emission::radiance([5.0; 3]).into()), ..disk }.into());
            })
        };
        assert!(lamp([0.0, 1.0, 0.0], [0.0, 3.0, 0.0])[0].contains("shines away"));
        assert_eq!(lamp([0.0, -1.0, 0.0], [0.0, 3.0, 0.0]), Vec::<String>::new());
        // The camera at z = 4 sees this one shine.
        assert_eq!(lamp([0.0, 0.0, 1.0], [0.0, 0.0, 2.0]), Vec::<String>::new());
        assert!(lamp([0.0, 0.0, 1.0], [0.0, 0.0, 5.0])[0].contains("shines away"));
    }

    #[test]
    fn glass_with_holes_is_told() {
        let of = |shape: Shape, material: Material| {
            warnings(Material::diffuse(0.5), 1.0, |desc| {
                desc.objects.push(Object::new(shape, material).into())
            })
        };
        let tube = |closed| Shape::Cylinder {
            base: [5.0, 0.0, 0.0],
            axis: [0.0, 1.0, 0.0],
            radius: 1.0,
            height: 1.0,
            segments: 16,
            closed,
            inward: false,
        };
        assert!(of(tube(false), glass())[0].contains("open surface"));
        assert_eq!(of(tube(true), glass()), Vec::<String>::new());
        assert_eq!(of(tube(false), Material::diffuse(0.5)), Vec::<String>::new());
        let pane = Shape::Disk { center: [5.0, 0.0, 0.0], normal: [0.0, 1.0, 0.0], radius: 1.0 };
        assert!(of(pane, glass())[0].contains("open surface"));
        // Lamps of groups are placed for each instance; a fault of theirs is one.
        let lamps = warnings(Material::diffuse(0.5), 1.0, |desc| {
            let emission = Some(Emission::radiance([5.0; 3]).into());
            let lamp = Object { emission, ..Object::new(tube(false), glass()) };
            desc.groups.insert("lamps".into(), Group { objects: vec![lamp.into()] }.into());
            let group =
                || Instance { name: None, group: "lamps".into(), transform: Vec::new(), material: None };
            desc.instances.extend([group().into(), group().into()]);
        });
        assert_eq!(lamps.iter().filter(|text| text.contains("open surface")).count(), 1);
    }

    #[test]
    fn rooms_are_no_solids() {
        let turned = warnings(Material::diffuse(0.5), 9.0, |desc| desc.objects[0].flip_normals = true);
        assert_eq!(turned, Vec::<String>::new());
        let furnished = warnings(Material::diffuse(0.5), 9.0, |desc| {
            let ball = Shape::Sphere { center: [0.0; 3], radius: 1.0 };
            desc.objects.push(Object::new(ball, Material::diffuse(0.2)).into());
        });
        assert_eq!(furnished, Vec::<String>::new());
    }
}
