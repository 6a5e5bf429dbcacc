use super::*;
use expect_test::{Expect, expect};

const TWO_TRIANGLES: &str = "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 4\nproperty float x\n\
    property float y\nproperty float z\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n\
    0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n";

fn square() -> TriangleMesh {
    parse(TWO_TRIANGLES.as_bytes()).unwrap()
}

fn refused(bytes: &[u8], expected: Expect) {
    expected.assert_eq(&parse(bytes).unwrap_err().to_string());
}

/// A property's type, and how a value is written in it.
#[derive(Clone, Copy)]
struct Writer {
    big: bool,
}

impl Writer {
    fn put(self, out: &mut Vec<u8>, kind: &str, value: f64) {
        let mut bytes = match kind {
            "char" => (value as i8).to_le_bytes().to_vec(),
            "uchar" => (value as u8).to_le_bytes().to_vec(),
            "short" => (value as i16).to_le_bytes().to_vec(),
            "ushort" => (value as u16).to_le_bytes().to_vec(),
            "int" => (value as i32).to_le_bytes().to_vec(),
            "uint" => (value as u32).to_le_bytes().to_vec(),
            "float" => (value as f32).to_le_bytes().to_vec(),
            _ => value.to_le_bytes().to_vec(),
        };
        if self.big {
            bytes.reverse();
        }
        out.extend(bytes);
    }
}

/// The unit square with odd extras: uvs, normals, colours, lists among vertices, elements that are not known.
fn square_in_binary(
    big: bool,
    float: &str,
    length: &str,
    index: &str,
    polygon: bool,
    extras: bool,
) -> Vec<u8> {
    let order = if big { "big" } else { "little" };
    let mut header = format!("ply\r\nformat binary_{order}_endian 1.0\r\n");
    if extras {
        header += "element camera 2\nproperty double f\nproperty list ushort short marks\nelement nothing 99999999\n";
    }
    header += &format!("element vertex 4\nproperty uchar red\nproperty {float} z\nproperty {float} x\n");
    if extras {
        header += "property list char float weights\n";
    }
    header += &format!("property {float} y\nproperty {float} s\nproperty {float} t\n");
    header += &format!("element face {}\nproperty ushort material\n", if polygon { 1 } else { 2 });
    header += &format!("property list {length} {index} vertex_index\nproperty uchar flags\n");
    if extras {
        header += "property list uchar float texcoord\n";
    }
    header += "end_header\n";
    let w = Writer { big };
    let mut out = header.into_bytes();
    if extras {
        for marks in [0, 3] {
            w.put(&mut out, "double", 1.5);
            w.put(&mut out, "ushort", f64::from(marks));
            (0..marks).for_each(|m| w.put(&mut out, "short", f64::from(m)));
        }
    }
    for (x, y) in [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)] {
        w.put(&mut out, "uchar", 200.0);
        w.put(&mut out, float, 0.0);
        w.put(&mut out, float, x);
        if extras {
            w.put(&mut out, "char", 1.0);
            w.put(&mut out, "float", 7.0);
        }
        for value in [y, x, y] {
            w.put(&mut out, float, value);
        }
    }
    let faces: &[&[u32]] = if polygon { &[&[0, 1, 2, 3]] } else { &[&[0, 1, 2], &[0, 2, 3]] };
    for face in faces {
        w.put(&mut out, "ushort", 513.0);
        w.put(&mut out, length, face.len() as f64);
        face.iter().for_each(|&i| w.put(&mut out, index, f64::from(i)));
        w.put(&mut out, "uchar", 3.0);
        if extras {
            w.put(&mut out, "uchar", 1.0);
            w.put(&mut out, "float", 0.5);
        }
    }
    out
}

#[test]
fn every_layout_gives_the_same_square() {
    let expected = square();
    expected.validate().unwrap();
    assert_eq!(expected.indices, [[0, 1, 2], [0, 2, 3]]);
    for big in [false, true] {
        for float in ["float", "double", "short"] {
            for length in ["uchar", "char", "ushort", "int", "uint"] {
                for index in ["int", "uint", "ushort", "uchar", "double"] {
                    for (polygon, extras) in [(false, false), (true, false), (false, true), (true, true)] {
                        let mesh =
                            parse(&square_in_binary(big, float, length, index, polygon, extras)).unwrap();
                        assert_eq!(mesh.positions, expected.positions);
                        assert_eq!(mesh.indices, expected.indices);
                        assert_eq!(mesh.uvs[2], Vec2::ONE);
                        assert!(mesh.normals.is_empty());
                    }
                }
            }
        }
    }
}

#[test]
fn text_may_have_faces_first_normals_and_any_uv_names() {
    for (u, v) in [("u", "v"), ("s", "t"), ("texture_u", "texture_v"), ("texture_s", "texture_t")] {
        let text = format!(
            "ply\nformat ascii 1.0\nelement face 1\nproperty list uint8 int32 vertex_index\nelement vertex 3\n\
             property float64 nx\nproperty float ny\nproperty float nz\nproperty float x\nproperty float y\n\
             property float z\nproperty float {u}\nproperty float {v}\nend_header\n3 2 1 0\n\
             0 0 -2  0 0 0  0 0\n0 0 -1  1 0 0  1 0\n0 0 0  0 1 0  0.25 1"
        );
        let mesh = parse(text.as_bytes()).unwrap();
        mesh.validate().unwrap();
        assert_eq!(mesh.indices, [[2, 1, 0]]);
        // The last normal was zero: it is made from the face.
        assert_eq!(mesh.normals, [Vec3::NEG_Z; 3]);
        assert_eq!(mesh.uvs[2], Vec2::new(0.25, 1.0));
    }
}

#[test]
fn faults_are_named_with_their_place() {
    let text = |from: &str, to: &str| {
        assert!(TWO_TRIANGLES.contains(from));
        TWO_TRIANGLES.replacen(from, to, 1).into_bytes()
    };
    refused(b"", expect!["line 1: the first line is not `ply` (check that this is a PLY file)"]);
    refused(b"solid\n", expect!["line 1: the first line is not `ply` (check that this is a PLY file)"]);
    refused(
        b"ply\nformat ascii 1.0\n",
        expect!["line 3: the header has no `end_header` (the file is cut off: export the mesh again)"],
    );
    refused(
        &text("ascii", "asci"),
        expect![
            "line 2: unknown format: expected ascii, binary_little_endian or binary_big_endian (export the mesh again)"
        ],
    );
    refused(
        &text("float x", "float128 x"),
        expect![
            "line 5: `float128 x` is no property (expected `property TYPE NAME` or `property list TYPE TYPE NAME` with char, uchar, short, ushort, int, uint, float or double)"
        ],
    );
    refused(
        &text("float x", "float w"),
        expect!["line 11: vertices without x, y and z (export the mesh again)"],
    );
    refused(
        &text("vertex 4", "vertex 4000000000000000"),
        expect![
            "line 11: 4000000000000000 `vertex` elements need 24000000000000000 bytes or more, but 40 are left (the file is cut off or its header wrong: export the mesh again)"
        ],
    );
    refused(
        &text("face 2", "face -2"),
        expect!["line 8: expected `element NAME COUNT` (the header is damaged: export the mesh again)"],
    );
    refused(
        &text("3 0 2 3", "3 0 2 4"),
        expect![
            "a face names vertex 4 (counting from 0), but there are 4 (the file is damaged: export the mesh again)"
        ],
    );
    refused(
        &text("3 0 2 3", "3 0 2 -1"),
        expect!["line 16: -1 is no vertex index (the file is damaged: export the mesh again)"],
    );
    refused(
        &text("3 0 2 3", "300000 0 2 3"),
        expect![
            "line 16: a list `vertex_indices` of 300000 values, but 7 bytes are left (the file is cut off or damaged: export the mesh again)"
        ],
    );
    refused(
        &text("3 0 2 3\n", "3 0"),
        expect![
            "line 16: a list `vertex_indices` of 3 values, but 2 bytes are left (the file is cut off or damaged: export the mesh again)"
        ],
    );
    refused(
        &text("1 1 0", "1 inf 0"),
        expect![
            "the position of vertex 2 (counting from 0) is [1, inf, 0] (repair the mesh: every number must be finite)"
        ],
    );
    refused(&text("1 1 0", "1 one 0"), expect!["line 13: `one` is not a number (export the mesh again)"]);
    refused(
        &text("face 2", "edge 2"),
        expect!["there is no triangle in the file (export the mesh again, with its faces)"],
    );

    let binary = square_in_binary(false, "float", "uchar", "int", false, false);
    let error = parse(&binary[..binary.len() - 20]).unwrap_err();
    // The two faces take 16 bytes each; the first is the one cut off.
    assert_eq!(error.place, Place::Byte(binary.len() as u64 - 32));
    for cut in 0..binary.len() {
        assert!(parse(&binary[..cut]).is_err(), "{cut}");
    }
}

#[test]
fn second_coordinates_and_colours_in_every_type() {
    let text = |color: &str, alpha: &str, values: [&str; 3]| {
        let [a, b, c] = values;
        format!(
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty {color} red\nproperty float x\nproperty float y\n\
             property float z\nproperty float u2\nproperty float v2\nproperty {color} green\nproperty {color} blue\n\
             property {alpha} alpha\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n\
             {a} 0 0 0 0.5 0.25 {b} {c}\n{a} 1 0 0 1 0 {b} {c}\n{a} 0 1 0 0 1 {b} {c}\n3 0 1 2\n"
        )
    };
    let close = |a: [f32; 4], b: [f32; 4]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-5);
    // The middle of sRGB is 0.2158; alpha is never encoded, floats are as they are.
    let bytes = parse(text("uchar", "uchar", ["255", "128", "0 51"]).as_bytes()).unwrap();
    assert!(close(bytes.colors[1], [1.0, 0.215_861, 0.0, 0.2]), "{:?}", bytes.colors);
    assert_eq!(bytes.uvs2[0], Vec2::new(0.5, 0.25));
    let words = parse(text("ushort", "float", ["65535", "32896", "0 0.3"]).as_bytes()).unwrap();
    assert!(close(words.colors[2], [1.0, 0.215_861, 0.0, 0.3]), "{:?}", words.colors);
    let floats = parse(text("float", "float", ["7.5", "0.5", "0.125 1"]).as_bytes()).unwrap();
    assert_eq!(floats.colors[0], [7.5, 0.5, 0.125, 1.0]);
    // Creases split what goes along.
    let split = bytes.with_crease(0.1);
    assert_eq!((split.colors.len(), split.uvs2.len()), (3, 3));
    let joined = split.clone().merged(&split);
    assert_eq!((joined.colors.len(), joined.uvs2.len()), (6, 6));
    assert!(joined.merged(&TriangleMesh { colors: vec![], ..split }).colors.is_empty());
}

#[test]
fn binary_colours_are_those_of_the_text() {
    let mut file = b"ply\nformat binary_big_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\n\
        property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nproperty ushort alpha\n\
        element face 1\nproperty list uchar int vertex_indices\nend_header\n"
        .to_vec();
    for p in [[0.0f32, 0.0], [1.0, 0.0], [0.0, 1.0]] {
        file.extend([p[0], p[1], 0.0].iter().flat_map(|x| x.to_be_bytes()));
        file.extend([255, 128, 0, 0x33, 0x33]);
    }
    file.push(3);
    file.extend([0i32, 1, 2].iter().flat_map(|i| i.to_be_bytes()));
    let mesh = parse(&file).unwrap();
    for (a, b) in mesh.colors[2].iter().zip([1.0, 0.215_861, 0.0, 0.2]) {
        assert!((a - b).abs() < 1e-5, "{:?}", mesh.colors);
    }
}
