//! Mitsuba's binary meshes, versions 3 and 4.
//!
//! Facts of the format: Mitsuba 0.6, documentation of the plugin `serialized`. Little endian: the identifier 0x041C and the
//! version, 16 bits each, then a zlib stream: flags (32 bits), in version 4 a name ending with a zero, the numbers of vertices and
//! triangles (64 bits each), then positions, and by the flags normals, texture coordinates and colours, each one a
//! vertex, then indices (32 bits; 64 where there are more vertices than fit). A file may hold several; at its end stand
//! the places of all (32 bits each in version 3, 64 in version 4) and their number (32 bits).

use std::io::Read;

use flate2::read::ZlibDecoder;
use scenefile::desc::Triple;

use crate::surfaces::Mesh;

const IDENTIFIER: u16 = 0x041C;
const HAS_NORMALS: u32 = 1;
const HAS_UVS: u32 = 2;
const HAS_COLORS: u32 = 8;
const FACE_NORMALS: u32 = 16;
const SINGLE: u32 = 0x1000;
const DOUBLE: u32 = 0x2000;
/// Bytes that a mesh may unpack to for each packed one; zlib reaches 1032 at most, meshes a tenth.
const MOST_GROWTH: u64 = 1032;
/// Of a mesh's name.
const MOST_NAME: usize = 4096;

/// The mesh at a place of a file, and whether its faces are shaded flat.
///
/// # Errors
/// Why not, in words that follow the file's name. Memory is bounded by the bytes there are.
pub(super) fn read(bytes: &[u8], index: usize) -> Result<(Mesh, bool), String> {
    let short = || "ends too early".to_owned();
    let (id, version) = header(bytes).ok_or_else(short)?;
    if id != IDENTIFIER {
        return Err("is no serialized mesh".into());
    }
    if !matches!(version, 3 | 4) {
        return Err(format!("is of version {version}, not 3 or 4"));
    }
    let (start, end) = place(bytes, index, version)?;
    let packed = bytes.get(start..end).ok_or_else(short)?;
    let (id, version) = header(packed).ok_or_else(short)?;
    if id != IDENTIFIER || !matches!(version, 3 | 4) {
        return Err(format!("has no mesh where number {index} should be"));
    }
    let body = &packed[4..];
    let most = MOST_GROWTH.saturating_mul(body.len() as u64);
    let mut stream = Stream { inner: ZlibDecoder::new(body).take(most), most };
    stream.mesh(version)
}

fn header(bytes: &[u8]) -> Option<(u16, u16)> {
    let [a, b, c, d] = *bytes.first_chunk()?;
    Some((u16::from_le_bytes([a, b]), u16::from_le_bytes([c, d])))
}

/// Where a mesh begins and what follows it, by the table at the file's end.
fn place(bytes: &[u8], index: usize, version: u16) -> Result<(usize, usize), String> {
    let count = bytes.last_chunk().map_or(0, |c| u32::from_le_bytes(*c)) as usize;
    if index >= count {
        return Err(format!("holds {count} meshes, of which none is number {index}"));
    }
    let size = if version == 3 { 4 } else { 8 };
    let table = count.checked_mul(size).and_then(|n| (bytes.len() - 4).checked_sub(n));
    let Some(table) = table else { return Err("has a table of more meshes than fit".into()) };
    let at = |i: usize| {
        let entry = &bytes[table + i * size..][..size];
        entry.iter().rev().fold(0usize, |n, b| n << 8 | usize::from(*b))
    };
    let end = if index + 1 < count { at(index + 1) } else { table };
    if at(index) < end && end <= table { Ok((at(index), end)) } else { Err("has a broken table".into()) }
}

struct Stream<R> {
    inner: R,
    /// Bytes that the stream can hold.
    most: u64,
}

impl<R: Read> Stream<R> {
    fn bytes<const N: usize>(&mut self) -> Result<[u8; N], String> {
        let mut out = [0; N];
        self.inner.read_exact(&mut out).map_err(|e| format!("cannot be unpacked: {e}"))?;
        Ok(out)
    }

    fn u32(&mut self) -> Result<u32, String> {
        self.bytes().map(u32::from_le_bytes)
    }

    fn u64(&mut self) -> Result<u64, String> {
        self.bytes().map(u64::from_le_bytes)
    }

    /// So many items of so many bytes, all at once.
    fn block(&mut self, count: u64, size: u64) -> Result<Vec<u8>, String> {
        let wanted = count.checked_mul(size).filter(|n| *n <= self.most);
        let Some(wanted) = wanted else { return Err("says that it holds more than fits into it".into()) };
        let mut out = Vec::new();
        (&mut self.inner)
            .take(wanted)
            .read_to_end(&mut out)
            .map_err(|e| format!("cannot be unpacked: {e}"))?;
        if out.len() as u64 == wanted { Ok(out) } else { Err("ends too early".into()) }
    }

    /// `N` numbers for each of `count`.
    fn vectors<const N: usize>(&mut self, count: u64, double: bool) -> Result<Vec<[f32; N]>, String> {
        let size = if double { 8 } else { 4 };
        let bytes = self.block(count, (N * size) as u64)?;
        let number = |b: &[u8]| match (<[u8; 8]>::try_from(b), <[u8; 4]>::try_from(b)) {
            (Ok(b), _) => f64::from_le_bytes(b) as f32,
            (_, Ok(b)) => f32::from_le_bytes(b),
            _ => f32::NAN,
        };
        let vector = |b: &[u8]| std::array::from_fn(|i| number(&b[i * size..][..size]));
        let all: Vec<[f32; N]> = bytes.chunks_exact(N * size).map(vector).collect();
        if all.iter().flatten().all(|x| x.is_finite()) {
            return Ok(all);
        }
        Err("holds a number that is not finite".into())
    }

    fn mesh(&mut self, version: u16) -> Result<(Mesh, bool), String> {
        let flags = self.u32()?;
        if version == 4 {
            let mut name = 0;
            while self.bytes::<1>()? != [0] {
                name += 1;
                if name > MOST_NAME {
                    return Err("has a name that does not end".into());
                }
            }
        }
        let double = match flags & (SINGLE | DOUBLE) {
            SINGLE => false,
            DOUBLE => true,
            _ => return Err("does not say how its numbers are stored".into()),
        };
        let (vertices, faces) = (self.u64()?, self.u64()?);
        if vertices > u64::from(u32::MAX) {
            return Err("has more vertices than fit".into());
        }
        let positions: Vec<Triple> = self.vectors(vertices, double)?;
        let mut normals: Vec<Triple> =
            if flags & HAS_NORMALS != 0 { self.vectors(vertices, double)? } else { Vec::new() };
        for n in &mut normals {
            let length = n.map(|x| f64::from(x) * f64::from(x)).iter().sum::<f64>().sqrt();
            // Those of no length are found anew.
            *n = if length > 0.0 { n.map(|x| (f64::from(x) / length) as f32) } else { [0.0; 3] };
        }
        let uvs = if flags & HAS_UVS != 0 { self.vectors(vertices, double)? } else { Vec::new() };
        if flags & HAS_COLORS != 0 {
            self.vectors::<3>(vertices, double)?;
        }
        let bytes = self.block(faces, 12)?;
        let index = |b: &[u8]| b.iter().rev().fold(0u32, |n, b| n << 8 | u32::from(*b));
        let indices: Vec<[u32; 3]> =
            bytes.chunks_exact(12).map(|t| std::array::from_fn(|i| index(&t[4 * i..][..4]))).collect();
        if let Some(bad) = indices.iter().flatten().find(|i| u64::from(**i) >= vertices) {
            return Err(format!("names vertex {bad}, but there are {vertices}"));
        }
        Ok((Mesh { positions, normals, uvs, indices }, flags & FACE_NORMALS != 0))
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use flate2::Compression;
    use flate2::write::ZlibEncoder;

    use super::*;

    /// A file of triangles, one a mesh, at heights 0, 1, …
    fn file(version: u16, double: bool, count: u32, edit: impl Fn(&mut Vec<u8>)) -> Vec<u8> {
        let mut out = Vec::new();
        let mut places = Vec::new();
        for height in 0..count {
            let mut body = Vec::new();
            let flags = HAS_NORMALS | HAS_UVS | if double { DOUBLE } else { SINGLE };
            body.extend(flags.to_le_bytes());
            if version == 4 {
                body.extend(b"name\0");
            }
            body.extend([3u64.to_le_bytes(), 1u64.to_le_bytes()].concat());
            let mut put = |x: f64| match double {
                true => body.extend(x.to_le_bytes()),
                false => body.extend((x as f32).to_le_bytes()),
            };
            let z = f64::from(height);
            [0.0, 0.0, z, 1.0, 0.0, z, 0.0, 1.0, z].into_iter().for_each(&mut put);
            [0.0, 0.0, 2.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0].into_iter().for_each(&mut put);
            [0.0, 0.0, 1.0, 0.0, 0.0, 1.0].into_iter().for_each(&mut put);
            body.extend([0u32, 1, 2].map(u32::to_le_bytes).concat());
            edit(&mut body);
            places.push(out.len() as u64);
            out.extend([IDENTIFIER.to_le_bytes(), version.to_le_bytes()].concat());
            let mut packer = ZlibEncoder::new(Vec::new(), Compression::best());
            packer.write_all(&body).unwrap();
            out.extend(packer.finish().unwrap());
        }
        for p in places {
            match version {
                3 => out.extend((p as u32).to_le_bytes()),
                _ => out.extend(p.to_le_bytes()),
            }
        }
        out.extend(count.to_le_bytes());
        out
    }

    #[test]
    fn meshes_of_every_version() {
        for (version, double) in [(3, false), (3, true), (4, false), (4, true)] {
            let bytes = file(version, double, 3, |_| ());
            for index in 0..3 {
                let (mesh, flat) = read(&bytes, index).unwrap();
                assert_eq!(mesh.positions[2], [0.0, 1.0, index as f32]);
                assert_eq!(mesh.normals, [[0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [0.0; 3]]);
                assert_eq!((mesh.uvs[1], &mesh.indices[..], flat), ([1.0, 0.0], &[[0, 1, 2]][..], false));
            }
            assert!(read(&bytes, 3).unwrap_err().contains("3 meshes"));
        }
    }

    #[test]
    fn broken_files() {
        let good = file(4, false, 2, |_| ());
        for n in 0..good.len() {
            assert!(read(&good[..n], 0).is_err(), "{n}");
            assert!(read(&good[..n], 1).is_err(), "{n}");
        }
        let huge = file(4, false, 1, |b| b[9..17].copy_from_slice(&0xffff_ffffu64.to_le_bytes()));
        assert!(read(&huge, 0).unwrap_err().contains("more than fits"));
        let wild = file(3, false, 1, |b| {
            let end = b.len();
            b[end - 4..].copy_from_slice(&7u32.to_le_bytes());
        });
        assert!(read(&wild, 0).unwrap_err().contains("vertex 7"));
        let mut mad = good.clone();
        let end = mad.len();
        mad[end - 4..].copy_from_slice(&u32::MAX.to_le_bytes());
        assert!(read(&mad, 0).unwrap_err().contains("more meshes than fit"));
        assert!(read(b"PK\x03\x04xxxx", 0).unwrap_err().contains("no serialized"));
        assert!(read(&file(3, false, 1, |b| b[1] = 0), 0).is_err());
    }
}
