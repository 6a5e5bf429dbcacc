//! Lights.

use super::*;

#[test]
fn lights() {
    let text = "LightSource \"point\" \"rgb I\" [1 2 3] \"float scale\" 2 \"point3 from\" [1 1 1]\n\
                LightSource \"point\" \"float power\" 12.566371\n\
                LightSource \"spot\" \"float coneangle\" 40 \"float conedeltaangle\" 10 \"point3 to\" [0 -1 0]\n\
                LightSource \"distant\" \"rgb L\" [2 2 2] \"point3 from\" [0 3 0] \"point3 to\" [0 0 0] \"float illuminance\" 5\n\
                LightSource \"infinite\" \"rgb L\" [.5 .25 0] \"float scale\" 4\n\
                LightSource \"infinite\" \"float illuminance\" 3.1415927\n\
                LightSource \"point\" \"blackbody I\" 6504\n\
                LightSource \"point\" \"spectrum I\" [300 7 900 7]\n";
    let desc = world(&format!("{text}{TRIANGLE}"));
    let kinds: Vec<LightKind> = desc.lights.iter().skip(1).map(|l| l.kind.clone()).collect();
    let intensity = |kind: &LightKind| match kind {
        LightKind::Point { amount: PointAmount::Intensity(i), .. }
        | LightKind::Spot { amount: PointAmount::Intensity(i), .. } => *i,
        other => panic!("{other:?}"),
    };
    close(intensity(&kinds[0]), [2.0, 4.0, 6.0]);
    close(intensity(&kinds[1]), [1.0; 3]);
    let LightKind::Spot { direction, cone_angle, falloff_angle, .. } = kinds[2] else { panic!() };
    assert_eq!((direction, cone_angle, falloff_angle), ([0.0, -1.0, 0.0], 40.0, 10.0));
    let LightKind::Directional { direction, irradiance } = kinds[3] else { panic!() };
    assert_eq!((direction, irradiance), ([0.0, -3.0, 0.0], [10.0; 3]));
    assert_eq!(kinds[4], LightKind::Environment { radiance: [2.0, 1.0, 0.0] });
    let LightKind::Environment { radiance } = kinds[5] else { panic!() };
    close(radiance, [1.0; 3]);
    // Of luminance 1, whatever their size: near white, and warmer than D65 as equal energy is.
    for (kind, red) in [(&kinds[6], 0.9..1.1), (&kinds[7], 1.15..1.25)] {
        let rgb = intensity(kind);
        let luminance = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
        assert!((luminance - 1.0).abs() < 1e-4 && red.contains(&rgb[0]), "{rgb:?}");
    }
}

#[test]
fn area_lights_and_the_film() {
    let head = "Film \"rgb\" \"float iso\" 200 \"float exposuretime\" .25\n";
    let text = "AreaLightSource \"diffuse\" \"rgb L\" [4 2 0] \"bool twosided\" true\nShape \"sphere\"\n\
                AreaLightSource \"diffuse\" \"rgb L\" [1 1 .4] \"float power\" 30\nShape \"disk\"\n\
                AreaLightSource \"diffuse\" \"rgb L\" [0 0 0]\nShape \"disk\"\n";
    let desc = desc(&format!("{head}{HEAD}{text}"));
    let emission: Vec<_> = desc.objects.iter().map(|o| o.emission.as_deref()).collect();
    let first = emission[0].unwrap();
    assert!(first.two_sided);
    // Half as bright: 0.25 s at twice the speed.
    assert_eq!(first.amount, EmissionAmount::Radiance([2.0, 1.0, 0.0]));
    // 30 for white is 30, 30, 12 W here, halved: 12 W in the mean.
    let EmissionAmount::Power { watts, color } = emission[1].unwrap().amount else { panic!() };
    close([watts, color[0], color[2]], [12.0, 1.25, 0.5]);
    assert!(emission[2].is_none());
}
