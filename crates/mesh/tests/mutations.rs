//! Damaged files: refused or read as some valid mesh, never a panic, and quickly.

use nephroid_mesh::{TriangleMesh, obj, ply, stl};

/// Steele, Lea & Flood 2014 (SplitMix64).
struct Numbers(u64);

impl Numbers {
    fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % n as u64) as usize
    }
}

const OBJ: &[u8] =
    b"mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0.5\nv 0 1 0\nv 0.5 0.25 1e-2\nvt 0 0\nvt 1 0\nvn 0 0 1\n\
    vn 0 1 0\nusemtl a\nf 1/1/1 2/2/1 3/1/2\nf -5//1 -3//2 -2//1\nf 1 2 5 3 4\nf 1 2 \\\n 3\n";

fn ply_text() -> Vec<u8> {
    b"ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty double z\n\
      property float nx\nproperty float ny\nproperty float nz\nelement face 2\n\
      property list uchar int vertex_indices\nproperty list int float extra\nend_header\n\
      0 0 0 0 0 1\n1 0 0 0 1 0\n1 1 0 1 0 0\n0 1 0 0 0 1\n.5 .2 0 0 0 0\n3 0 1 2 0\n5 0 1 4 2 3 2 1 1\n"
        .to_vec()
}

fn ply_binary(length: &str) -> Vec<u8> {
    let mut out = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n\
         property float u\nproperty float v\nelement face 3\nproperty list {length} int vertex_indices\n\
         element other 1\nproperty list int int numbers\nend_header\n"
    )
    .into_bytes();
    for i in 0..25 {
        out.extend(((i * i % 7) as f32).to_le_bytes());
    }
    for face in [&[0, 1, 2][..], &[0, 2, 4, 3], &[4, 2, 1]] {
        match length {
            "uchar" => out.push(face.len() as u8),
            "short" => out.extend((face.len() as i16).to_le_bytes()),
            _ => out.extend((face.len() as i32).to_le_bytes()),
        }
        face.iter().for_each(|i: &i32| out.extend(i.to_le_bytes()));
    }
    out.extend(2i32.to_le_bytes());
    out.extend([0; 8]);
    out
}

const STL: &[u8] =
    b"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1e0 0\nendloop\nendfacet\nendsolid a\n";

fn stl_binary() -> Vec<u8> {
    let mut out = vec![0; 80];
    out.extend(2u32.to_le_bytes());
    for i in 0..2 {
        (0..12).for_each(|k| out.extend(((k * k + i) as f32).to_le_bytes()));
        out.extend([0; 2]);
    }
    out
}

fn mutate(original: &[u8], numbers: &mut Numbers) -> Vec<u8> {
    const INTERESTING: [&[u8]; 12] = [
        b"nan",
        b"-inf",
        b"1e999",
        b"-1",
        b"99999999999",
        b"4294967295",
        b"0",
        b"\n",
        b" ",
        b"/",
        b"\xff\xff\xff\xff",
        b"list",
    ];
    let mut bytes = original.to_vec();
    for _ in 0..1 + numbers.below(3) {
        if bytes.is_empty() {
            break;
        }
        let at = numbers.below(bytes.len());
        match numbers.below(6) {
            0 => bytes[at] = numbers.below(256) as u8,
            1 => bytes[at] ^= 1 << numbers.below(8),
            2 => bytes.truncate(at),
            3 => drop(bytes.remove(at)),
            4 => {
                let word = INTERESTING[numbers.below(INTERESTING.len())];
                let end = (at + numbers.below(5)).min(bytes.len());
                bytes.splice(at..end, word.iter().copied());
            }
            _ => {
                let from = numbers.below(bytes.len());
                let part = bytes[from..(from + numbers.below(20)).min(bytes.len())].to_vec();
                bytes.splice(at..at, part);
            }
        }
    }
    bytes
}

#[test]
fn damaged_files_never_panic_and_never_give_an_invalid_mesh() {
    type Parser = fn(&[u8]) -> Result<TriangleMesh, nephroid_mesh::MeshError>;
    let seeds: [(Vec<u8>, Parser); 7] = [
        (STL.to_vec(), stl::parse),
        (stl_binary(), stl::parse),
        (OBJ.to_vec(), obj::parse),
        (ply_text(), ply::parse),
        (ply_binary("uchar"), ply::parse),
        (ply_binary("short"), ply::parse),
        (ply_binary("uint"), ply::parse),
    ];
    let mut numbers = Numbers(2024);
    for (seed, parse) in &seeds {
        parse(seed).unwrap().validate().unwrap();
        let (mut read, mut refused) = (0, 0);
        for _ in 0..20_000 {
            let bytes = mutate(seed, &mut numbers);
            match parse(&bytes) {
                Ok(mesh) => {
                    mesh.validate().unwrap_or_else(|e| panic!("{e}: {:?}", String::from_utf8_lossy(&bytes)));
                    read += 1;
                }
                Err(e) => {
                    assert!(!e.message.is_empty() && !e.help.is_empty());
                    refused += 1;
                }
            }
        }
        // The mutations are neither too timid nor too wild to reach past the header.
        assert!(read > 500 && refused > 500, "{read} read, {refused} refused");
    }
}
