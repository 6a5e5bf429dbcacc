//! STL: loose triangles, in text or binary.
//!
//! Corners at the same position become one vertex. Normals of facets are not read: the order of the corners says the same, and is
//! right where the two differ. A binary file is known by its length, which its number of triangles decides, since many begin
//! with the word `solid` as text does. Facts of the format: 3D Systems, *StereoLithography Interface Specification*, 1989.

use std::collections::HashMap;

use math::Vec3;

use crate::assemble::finish;
use crate::text::{float, shown, word};
use crate::{MeshError, Place, TriangleMesh};

/// Bytes before the triangles of a binary file, the last four of which say how many these are.
const HEAD: usize = 84;
/// Bytes of a triangle: a normal, three corners, two bytes of attributes.
const TRIANGLE: usize = 50;

/// Reads the triangles of an STL file, of all its solids. Time is linear in the file, memory at most a small multiple of its size.
///
/// # Errors
/// Where a statement is malformed, the file is cut off, a number is not finite, or no triangle is there.
pub fn parse(bytes: &[u8]) -> Result<TriangleMesh, MeshError> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let mut triangles = Triangles::default();
    if let Some(count) = binary_count(bytes) {
        binary(&bytes[HEAD..], count, &mut triangles)?;
    } else {
        Text { rest: bytes, line: 1 }.read(&mut triangles)?;
    }
    finish(triangles.mesh)
}

/// How many triangles a binary file says it has; `None` for text.
fn binary_count(bytes: &[u8]) -> Option<u32> {
    let count = u32::from_le_bytes(*bytes.get(HEAD - 4..)?.first_chunk()?);
    let is_as_long = bytes.len() as u64 == HEAD as u64 + TRIANGLE as u64 * u64::from(count);
    let is_text = {
        let mut rest = bytes;
        word(&mut rest).is_some_and(|w| w.eq_ignore_ascii_case(b"solid")) && !bytes[..HEAD].contains(&0)
    };
    (is_as_long || !is_text).then_some(count)
}

fn binary(bytes: &[u8], count: u32, triangles: &mut Triangles) -> Result<(), MeshError> {
    let there = bytes.len() / TRIANGLE;
    if (there as u64) < u64::from(count) {
        return Err(MeshError::new(
            Place::Byte((HEAD + TRIANGLE * there) as u64),
            format!("the file ends after {there} of {count} triangles"),
            "copy or export it again",
        ));
    }
    for triangle in bytes.chunks_exact(TRIANGLE).take(count as usize) {
        let mut floats = triangle.as_chunks::<4>().0.iter().map(|b| f32::from_le_bytes(*b)).skip(3);
        let mut corner = || Vec3::from_array(std::array::from_fn(|_| floats.next().unwrap_or_default()));
        triangles.push([corner(), corner(), corner()]);
    }
    Ok(())
}

/// Triangles over shared vertices.
#[derive(Default)]
struct Triangles {
    mesh: TriangleMesh,
    known: HashMap<[u32; 3], u32>,
}

impl Triangles {
    fn push(&mut self, corners: [Vec3; 3]) {
        let positions = &mut self.mesh.positions;
        self.mesh.indices.push(corners.map(|p| {
            // Adding zero turns −0 into +0.
            let key = (p + Vec3::ZERO).to_array().map(f32::to_bits);
            *self.known.entry(key).or_insert_with(|| {
                positions.push(p);
                positions.len() as u32 - 1
            })
        }));
    }
}

/// What is left of a text, and the number of the line that it begins in.
struct Text<'a> {
    rest: &'a [u8],
    line: u64,
}

impl<'a> Text<'a> {
    fn read(mut self, triangles: &mut Triangles) -> Result<(), MeshError> {
        self.expect("solid")?;
        self.skip_line();
        while let Some(found) = self.word() {
            match found {
                w if w.eq_ignore_ascii_case(b"facet") => triangles.push(self.facet()?),
                // What follows either is a name.
                w if w.eq_ignore_ascii_case(b"endsolid") || w.eq_ignore_ascii_case(b"solid") => {
                    self.skip_line()
                }
                other => return Err(self.unexpected(Some(other), "`facet` or `endsolid`")),
            }
        }
        Ok(())
    }

    fn facet(&mut self) -> Result<[Vec3; 3], MeshError> {
        self.expect("normal")?;
        // Some programs write none as `nan nan nan`.
        for _ in 0..3 {
            self.word();
        }
        self.expect("outer")?;
        self.expect("loop")?;
        let mut corners = [Vec3::ZERO; 3];
        for corner in &mut corners {
            self.expect("vertex")?;
            *corner = Vec3::new(self.number()?, self.number()?, self.number()?);
        }
        self.expect("endloop")?;
        self.expect("endfacet")?;
        Ok(corners)
    }

    fn word(&mut self) -> Option<&'a [u8]> {
        let start = self.rest.iter().position(|b| !b.is_ascii_whitespace())?;
        self.line += self.rest[..start].iter().filter(|b| **b == b'\n').count() as u64;
        word(&mut self.rest)
    }

    fn skip_line(&mut self) {
        // The line break itself is left to be counted.
        let end = self.rest.iter().position(|b| *b == b'\n').unwrap_or(self.rest.len());
        self.rest = &self.rest[end..];
    }

    fn expect(&mut self, keyword: &str) -> Result<(), MeshError> {
        match self.word() {
            Some(found) if found.eq_ignore_ascii_case(keyword.as_bytes()) => Ok(()),
            other => Err(self.unexpected(other, &format!("`{keyword}`"))),
        }
    }

    fn number(&mut self) -> Result<f32, MeshError> {
        let found = self.word();
        found.and_then(float).ok_or_else(|| self.unexpected(found, "a number"))
    }

    fn unexpected(&self, found: Option<&[u8]>, expected: &str) -> MeshError {
        let found = found.map_or("the file ends".to_owned(), |word| format!("`{}` stands", shown(word)));
        let help = "STL is `solid`, then `facet normal … outer loop vertex x y z (three times) endloop endfacet`, then `endsolid`";
        MeshError::new(Place::Line(self.line), format!("{found} where {expected} is expected"), help)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "solid a thing\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   vertex 0 1 0\n  endloop\n \
                        endfacet\nFACET NORMAL nan nan nan OUTER LOOP VERTEX 0 1 0 VERTEX 1 0 0 VERTEX 1 1e0 -0 ENDLOOP ENDFACET\nendsolid a thing\n";

    fn binary_file(head: &[u8], triangles: &[[[f32; 3]; 3]]) -> Vec<u8> {
        let mut out = head.to_vec();
        out.resize(80, b' ');
        out.extend((triangles.len() as u32).to_le_bytes());
        for t in triangles {
            [[7.0; 3]].iter().chain(t).flatten().for_each(|x| out.extend(x.to_le_bytes()));
            out.extend([1, 2]);
        }
        out
    }

    const TWO: [[[f32; 3]; 3]; 2] = [
        [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        [[0.0, 1.0, -0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]],
    ];

    #[test]
    fn text_and_binary_are_the_same() {
        let text = parse(TEXT.as_bytes()).unwrap();
        assert_eq!((text.positions.len(), &text.indices), (4, &vec![[0, 1, 2], [2, 1, 3]]));
        // A head that reads like text does not deceive, whatever follows the triangles.
        for head in [&b"made by hand"[..], b"solid made by hand\n"] {
            assert_eq!(parse(&binary_file(head, &TWO)).unwrap(), text);
        }
        let mut trailing = binary_file(b"made by hand", &TWO);
        trailing.extend([0; 5]);
        assert_eq!(parse(&trailing).unwrap(), text);
        // Several solids, without names, without an end.
        let several = format!("\u{feff}solid\n{}{}", &TEXT[14..], TEXT.trim_end());
        assert_eq!(parse(several.as_bytes()).unwrap().indices.len(), 4);
    }

    #[test]
    fn faults_have_places() {
        let said = |bytes: &[u8]| parse(bytes).unwrap_err().to_string();
        let cut = &TEXT[..TEXT.find("vertex 0 1 0\n").unwrap()];
        assert!(
            said(cut.as_bytes()).starts_with("line 5: the file ends where `vertex`"),
            "{}",
            said(cut.as_bytes())
        );
        let wrong = TEXT.replace("vertex 1 0 0\n", "vertex 1 o 0\n");
        assert!(
            said(wrong.as_bytes()).starts_with("line 5: `o` stands where a number"),
            "{}",
            said(wrong.as_bytes())
        );
        let infinite = TEXT.replace("1e0", "1e99");
        assert!(said(infinite.as_bytes()).contains("inf"), "{}", said(infinite.as_bytes()));
        let binary = binary_file(b"x", &TWO);
        let short = said(&binary[..binary.len() - 1]);
        assert!(short.starts_with("byte 134: the file ends after 1 of 2 triangles"), "{short}");
        assert!(said(b"").contains("`solid` is expected"), "{}", said(b""));
        assert!(said(b"solid\nendsolid\n").contains("no triangle"));
        assert!(said(&binary_file(b"x", &[])).contains("no triangle"));
    }
}
