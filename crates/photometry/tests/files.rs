//! Small files of every kind, and damaged ones.
#![allow(clippy::unwrap_used, reason = "helpers of tests, too")]

use expect_test::{Expect, expect};
use math::Vec3;
use nephroid_photometry::{Photometry, Web, read};
use proptest::prelude::*;

const PI: f64 = std::f64::consts::PI;

/// An LM-63 file.
fn ies(head: &str, lamps: &str, angles: &str, candela: &str) -> String {
    format!("{head}\nTILT=NONE\n{lamps}\n{angles}\n{candela}\n")
}

fn web(text: &str) -> Web {
    read(text.as_bytes()).unwrap_or_else(|e| panic!("{e}\n{text}")).web
}

/// Intensity along a direction that need not have unit length; 0 outside.
fn toward(web: &Web, x: f32, y: f32, z: f32) -> f32 {
    web.locate(Vec3::new(x, y, z).normalize()).map_or(0.0, |cell| web.candela(cell))
}

fn close(found: f64, expected: f64) {
    assert!((found - expected).abs() <= 1e-4 * expected.abs().max(1e-3), "{found}, expected {expected}");
}

/// In the plane of azimuth φ (degrees) at 45° from straight down.
fn at(web: &Web, phi: f32) -> f64 {
    let (s, c) = phi.to_radians().sin_cos();
    f64::from(toward(web, c, -1.0, s))
}

#[test]
fn a_lamp_that_is_the_same_all_round() {
    let web = web(&ies("IESNA91", "1 1000 1 3 1 1 2 0 0 0 1 1 60", "0 90 180\n0", "100 100 100"));
    close(web.lumens(), 4.0 * PI * 100.0);
    for w in [Vec3::X, Vec3::NEG_Y, Vec3::Y, Vec3::new(0.6, 0.0, -0.8)] {
        close(f64::from(toward(&web, w.x, w.y, w.z)), 100.0);
    }
}

/// I = 50·γ/45: ∫ I dω has a closed form in each interval.
#[test]
fn intensities_are_linear_in_the_angle_and_end_with_the_grid() {
    let web = web(&ies("IESNA:LM-63-1995", "1 -1 2 3 1 1 2 0 0 0 0.5 1 60", "0 45 90\n0", "0 50 100"));
    close(at(&web, 77.0), 50.0);
    close(f64::from(toward(&web, 1.0, -(60f32.to_radians().tan().recip()), 0.0)), 100.0 * 60.0 / 90.0);
    assert_eq!(toward(&web, 1.0, 0.01, 0.0), 0.0);
    // 2π·(200/π)·∫₀^{π/2} θ sin θ dθ = 400.
    close(web.lumens(), 400.0);
}

#[test]
fn symmetries_of_type_c() {
    let file = |angles: &str, planes: &[f32]| {
        let rows: Vec<String> = planes.iter().map(|x| format!("{x} {x} {x}")).collect();
        let n = planes.len();
        web(&ies(
            "",
            &format!("1 1 1 3 {n} 1 1 0 0 0 1 1 1"),
            &format!("0 90 180\n{angles}"),
            &rows.join("\n"),
        ))
    };
    let check = |web: &Web, expected: &[(f32, f64)]| {
        expected.iter().for_each(|&(phi, x)| close(at(web, phi), x));
    };
    check(&file("0", &[7.0]), &[(0.0, 7.0), (123.0, 7.0), (359.0, 7.0)]);
    let quarter = file("0 90", &[10.0, 20.0]);
    check(
        &quarter,
        &[
            (0.0, 10.0),
            (45.0, 15.0),
            (90.0, 20.0),
            (135.0, 15.0),
            (180.0, 10.0),
            (-45.0, 15.0),
            (225.0, 15.0),
        ],
    );
    let half = file("0 90 180", &[10.0, 20.0, 40.0]);
    check(&half, &[(45.0, 15.0), (135.0, 30.0), (180.0, 40.0), (225.0, 30.0), (315.0, 15.0)]);
    let other_half = file("90 180 270", &[10.0, 20.0, 40.0]);
    check(
        &other_half,
        &[
            (90.0, 10.0),
            (135.0, 15.0),
            (180.0, 20.0),
            (45.0, 15.0),
            (0.0, 20.0),
            (-45.0, 30.0),
            (270.0, 40.0),
        ],
    );
    let whole = file("0 90 180 270 360", &[10.0, 20.0, 30.0, 40.0, 10.0]);
    check(&whole, &[(45.0, 15.0), (135.0, 25.0), (315.0, 25.0), (350.0, 40.0 - 30.0 * 80.0 / 90.0)]);
    // The plane that closes the turn may be missing.
    assert_eq!(file("0 90 180 270", &[10.0, 20.0, 30.0, 40.0]), whole);
}

#[test]
fn types_a_and_b_have_their_axes() {
    let head = "IES:LM-63-2019";
    // Height above the horizon in type A: 30 at all of it that lies 45° up, over both sides of the front.
    let a =
        web(&ies(head, "1 -1 1 3 3 3 1 0 0 0 1 1.00001 1", "-90 0 90\n-90 0 90", "0 0 60\n0 0 60\n0 0 60"));
    close(f64::from(toward(&a, 1.0, 1.0, 0.0)), 30.0);
    close(f64::from(toward(&a, 0.0, 1.0, 1.0)), 30.0);
    assert_eq!(toward(&a, -1.0, 1.0, 0.0), 0.0, "behind");
    // In type B the plane turns about the horizontal axis: its angle is 45° all along it.
    let b =
        web(&ies(head, "1 -1 1 3 3 2 1 0 0 0 1 1.00001 1", "-90 0 90\n-90 0 90", "0 0 60\n0 0 60\n0 0 60"));
    for z in [-3.0, -0.5, 0.0, 0.7, 5.0] {
        close(f64::from(toward(&b, 1.0, 1.0, z)), 30.0);
    }
    // To the right is +z; what begins at 0 is the same on both sides.
    let right = web(&ies(head, "1 -1 1 3 3 3 1 0 0 0 1 1 1", "-90 0 90\n-90 0 90", "0 0 0\n0 0 0\n8 8 8"));
    close(f64::from(toward(&right, 1.0, 0.0, 1.0)), 4.0);
    assert_eq!(toward(&right, 1.0, 0.0, -1.0), 0.0);
    for kind in [2, 3] {
        let lamps = format!("1 -1 1 2 2 {kind} 1 0 0 0 1 1 1");
        let both = web(&ies(head, &lamps, "0 90\n0 90", "10 10\n20 20"));
        for (y, z) in [(0.3, 0.0), (-0.3, 0.0)] {
            assert_eq!(toward(&both, 1.0, y, z), toward(&both, 1.0, -y, -z));
        }
        close(f64::from(toward(&both, 1.0, 0.0, -1.0)), 15.0);
        close(f64::from(toward(&both, 1.0, 0.0, 1.0)), 15.0);
    }
}

/// The same luminaire by two of its types, and turned: fluxes agree.
#[test]
fn flux_does_not_depend_on_the_axis() {
    let rows = "5 5 5\n5 5 5\n5 5 5";
    let file = |kind: u32| {
        web(&ies("", &format!("1 -1 1 3 3 {kind} 1 0 0 0 1 1 1"), "-90 0 90\n-90 0 90", rows)).lumens()
    };
    close(file(3), 2.0 * PI * 5.0);
    close(file(2), 2.0 * PI * 5.0);
}

/// Factors: the second one counts until 1995; afterwards its place says something else.
#[test]
fn factors() {
    let flux = |head: &str| web(&ies(head, "2 500 3 2 1 1 2 0 0 0 0.9 0.8 1", "0 180\n0", "10 10")).lumens();
    let all = 4.0 * PI * 10.0 * 3.0 * 0.9;
    close(flux("IESNA:LM-63-1995"), all * 0.8);
    close(flux("[TEST] of 1986"), all * 0.8);
    close(flux("IESNA:LM-63-2002"), all);
    close(flux("IES:LM-63-2019"), all);
    let file = read(ies("IESNA91", "2 500 1 2 1 1 2 0 0 0 1 1 75", "0 180\n0", "1 1").as_bytes()).unwrap();
    assert_eq!((file.lamp_lumens, file.input_watts), (Some(1000.0), Some(75.0)));
    let absolute = read(ies("IESNA91", "1 -1 1 2 1 1 2 0 0 0 1 1 0", "0 180\n0", "1 1").as_bytes()).unwrap();
    assert_eq!((absolute.lamp_lumens, absolute.input_watts), (None, None));
}

#[test]
fn lines_may_end_and_numbers_be_parted_in_any_way() {
    let plain = web(&ies("IESNA91", "1 -1 1 3 2 1 2 0 0 0 1 1 0", "0 45 90\n0 90", "1 2 3\n4 5 6"));
    let texts = [
        "\u{feff}IESNA91\r\nTILT=NONE\r\n1,-1,1,3,2,1,2,0,0,0\r\n1,1,0\r\n0,45,\r\n90\r\n0,90\r\n1\r\n2\r\n3,4 5\t6\r\n",
        "IESNA91\rtilt = none\r1 -1 1 3 2 1 2 0 0 0 1 1 0 0 45 90 0 90 1.0 2. 3e0 4 5 +6\r\r",
        "IESNA91\nTILT=NONE\n\n1 -1 1 3 2 1 2\n0 0 0 1 1 0 0 45 90 0 90 1 2 3 4 5 6\n[END] 9",
    ];
    for text in texts {
        assert_eq!(web(text), plain, "{text:?}");
    }
    let latin =
        b"IESNA91\n[MANUFAC] Gl\xfchlampe\nTILT=NONE\n1 -1 1 3 2 1 2 0 0 0 1 1 0 0 45 90 0 90 1 2 3 4 5 6";
    assert_eq!(read(latin).unwrap().web, plain);
}

#[test]
fn tilt_is_read_over_and_told() {
    let rest = "1 -1 1 2 1 1 2 0 0 0 1 1 0\n0 180\n0\n10 10";
    let included =
        read(format!("IESNA91\nTILT=INCLUDE\n1\n3\n0 45 90\n1 0.9 0.8\n{rest}").as_bytes()).unwrap();
    let named = read(format!("IESNA91\nTILT=lamp.tlt\n{rest}").as_bytes()).unwrap();
    let none = read(format!("IESNA91\nTILT=NONE\n{rest}").as_bytes()).unwrap();
    assert_eq!(included.web, none.web);
    assert_eq!(named.web, none.web);
    let notes =
        |file: &Photometry| file.notes.iter().map(|n| format!("{}: {}", n.line, n.text)).collect::<Vec<_>>();
    assert_eq!(notes(&none), [""; 0]);
    assert_eq!(notes(&named), ["2: TILT=lamp.tlt: the lamp shines as in a luminaire that is not tilted"]);
}

/// A EULUMDAT file with planes every 360°/planes, three angles, and the intensities given.
fn ldt(symmetry: u32, planes: usize, sets: usize, lumens: &str, rows: &[f32]) -> String {
    let mut lines: Vec<String> = vec!["Maker".into(), "1".into(), symmetry.to_string(), planes.to_string()];
    lines
        .extend(["90", "3", "90", "", "Lamp", "", "lamp.ldt", "", "0", "0", "0", "0", "0"].map(String::from));
    lines.extend(["0", "0", "0", "0", "100", "100", "1", "0"].map(String::from));
    lines.push(sets.to_string());
    for _ in 0..sets {
        lines.extend(["1", "LED", lumens, "3000", "80", "12,5"].map(String::from));
    }
    lines.extend((0..10).map(|_| "0.5".to_owned()));
    lines.extend((0..planes).map(|i| format!("{}", 360.0 / planes as f64 * i as f64)));
    lines.extend(["0", "90", "180"].map(String::from));
    lines.extend(rows.iter().flat_map(|x| [x; 3]).map(|x| format!("{x:.1}").replace('.', ",")));
    lines.join("\r\n")
}

#[test]
fn symmetries_of_eulumdat() {
    let whole = web(&ldt(0, 4, 1, "2000", &[10.0, 20.0, 30.0, 40.0]));
    for (phi, x) in [(0.0, 20.0), (45.0, 30.0), (135.0, 50.0), (315.0, 50.0)] {
        close(at(&whole, phi), x);
    }
    let round = web(&ldt(1, 4, 1, "1000", &[10.0]));
    close(at(&round, 200.0), 10.0);
    close(round.lumens(), 4.0 * PI * 10.0);
    let half = web(&ldt(2, 4, 1, "1000", &[10.0, 20.0, 40.0]));
    for (phi, x) in [(45.0, 15.0), (135.0, 30.0), (225.0, 30.0), (315.0, 15.0)] {
        close(at(&half, phi), x);
    }
    // From C270 over C0 to C90.
    let other = web(&ldt(3, 4, 1, "1000", &[10.0, 20.0, 40.0]));
    for (phi, x) in [(270.0, 10.0), (0.0, 20.0), (90.0, 40.0), (180.0, 20.0), (225.0, 15.0), (135.0, 30.0)] {
        close(at(&other, phi), x);
    }
    let quarter = web(&ldt(4, 4, 1, "1000", &[10.0, 20.0]));
    for (phi, x) in [(0.0, 10.0), (45.0, 15.0), (135.0, 15.0), (180.0, 10.0), (270.0, 20.0)] {
        close(at(&quarter, phi), x);
    }
    let file = read(ldt(0, 4, 2, "2000", &[10.0; 4]).as_bytes()).unwrap();
    assert_eq!((file.lamp_lumens, file.input_watts), (Some(2000.0), Some(12.5)));
    assert_eq!(file.notes[0].text, "of 2 sets of lamps the first one shines");
}

/// Places and directions are inverse, all over the grid.
#[test]
fn directions_lie_in_their_cells() {
    let c = web(&ies("", "1 -1 1 3 3 1 1 0 0 0 1 1 1", "0 40 90\n0 30 180", "1 2 3\n4 5 6\n7 8 9"));
    let b = web(&ies("", "1 -1 1 3 3 2 1 0 0 0 1 1 1", "-90 0 80\n-70 0 90", "1 2 3\n4 5 6\n7 8 9"));
    for web in [c, b] {
        let [azimuths, polars] = web.cells();
        let total: f64 = (0..azimuths).map(|i| (0..polars).map(|j| web.solid_angle(i, j)).sum::<f64>()).sum();
        assert!(total > 1.0 && total < 4.0 * PI);
        for k in 0..azimuths * polars * 9 {
            let cell = nephroid_photometry::Cell {
                azimuth: k / 9 / polars,
                polar: k / 9 % polars,
                s: 0.1 + 0.4 * (k % 3) as f32,
                t: 0.1 + 0.4 * (k % 9 / 3) as f32,
            };
            let found = web.locate(web.direction(cell)).unwrap();
            assert_eq!((found.azimuth, found.polar), (cell.azimuth, cell.polar));
            assert!((found.s - cell.s).abs() < 1e-4 && (found.t - cell.t).abs() < 1e-4, "{cell:?} {found:?}");
        }
    }
}

fn errors(expect: Expect, texts: &[&str]) {
    let all: Vec<String> = texts.iter().map(|t| read(t.as_bytes()).unwrap_err().to_string()).collect();
    expect.assert_eq(&(all.join("\n") + "\n"));
}

#[test]
fn mistakes_are_named_with_their_line() {
    let ies = |rest: &str| format!("IESNA91\nTILT=NONE\n{rest}");
    let texts = [
        String::new(),
        "IESNA91\n[TEST] no tilt".into(),
        ies(""),
        ies("1 -1 1 2 1 1 2 0 0 0 1 1 nan"),
        ies("1 -1 1 2 1 9 2 0 0 0 1 1 0\n0 90\n0\n1 1"),
        ies("1 -1 1 4000000000 1 1 2 0 0 0 1 1 0\n0 90"),
        ies("1 -1 1 3000 3000 1 2 0 0 0 1 1 0\n0 90"),
        ies("1 -1 1 2 1 1 2 0 0 0 1 1 0\n0 90\n0\n1"),
        ies("1 -1 1 2 1 1 2 0 0 0 1 1 0\n0 90\n0\n1 -5"),
        ies("1 -1 1 2 1 1 2 0 0 0 1 1 0\n90 0\n0\n1 5"),
        ies("1 -1 1 2 2 1 2 0 0 0 1 1 0\n0 90\n0 120\n1 5 1 5"),
        ies("1 -1 0 2 1 1 2 0 0 0 1 1 0\n0 90\n0\n1 5"),
        ies("1 -1 1 2.5 1 1 2 0 0 0 1 1 0\n0 90\n0\n1 5"),
        ldt(7, 4, 1, "1000", &[1.0; 4]),
        ldt(0, 4, 1, "0", &[1.0; 4]),
        ldt(0, 4, 1, "1000", &[1.0; 3]),
        ldt(0, 4, 1, "many", &[1.0; 4]),
        ldt(0, 4, 77, "1000", &[1.0; 4]).replace("\r\n77\r\n", "\r\n9999999999\r\n"),
    ];
    errors(
        expect![[r#"
        line 1: the file ends before the symmetry
        line 2: the line `TILT=` is missing
        line 3: the file ends before the number of lamps
        line 3: the input watts must be a number, not `nan`
        line 3: the photometric type is 9; there are 1 (C), 2 (B) and 3 (A)
        line 3: the number of vertical angles is 4000000000, more than the file can hold
        line 3: the number of vertical angles is 3000, more than the file can hold
        line 5: 2 numbers (intensities) are due, more than the file can hold
        line 6: an intensity of -5
        line 4: a vertical angle of 0 degrees after one of 90
        line 5: horizontal angles from 0 to 120; they go from 0 to 0, 90, 180 or 360, or from 90 to 270
        line 3: the factors on intensities are 0, 1 and 1
        line 3: the number of vertical angles is 2.5
        line 3: the symmetry is 7; there are 0 to 4
        line 29: the luminous flux of the lamps is 0, the conversion factor 1
        line 58: the file ends before intensities: 12 lines are due from line 50 on
        line 29: the luminous flux of the lamps must be a number, not `many`
        line 26: the number of sets of lamps is 9999999999
    "#]],
        &texts.each_ref().map(String::as_str),
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    /// Whatever is in a file, it is read or refused.
    #[test]
    fn anything_is_read_or_refused(
        bytes in proptest::collection::vec(any::<u8>(), 0..400),
        words in "(TILT=NONE\n)?([0-9 .,\n-]{0,200})",
        cut in 0usize..1200,
        at in 0usize..1200,
        with in any::<u8>(),
    ) {
        let _ = read(&bytes);
        let _ = read(words.as_bytes());
        for whole in [ldt(0, 4, 1, "1000", &[1.0; 4]), ies("IESNA91", "1 -1 1 3 2 1 2 0 0 0 1 1 0", "0 45 90\n0 90", "1 2 3\n4 5 6")] {
            let mut damaged = whole.into_bytes();
            let _ = read(&damaged[..cut.min(damaged.len())]);
            let at = at % damaged.len();
            damaged[at] = with;
            if let Ok(file) = read(&damaged) {
                prop_assert!(file.web.lumens().is_finite());
            }
        }
    }
}
