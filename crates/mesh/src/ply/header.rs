use super::place;
use crate::MeshError;
use crate::text::{integer, shown, word};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Format {
    Ascii,
    LittleEndian,
    BigEndian,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    fn named(name: &[u8]) -> Option<Self> {
        Some(match name {
            b"char" | b"int8" => Self::I8,
            b"uchar" | b"uint8" => Self::U8,
            b"short" | b"int16" => Self::I16,
            b"ushort" | b"uint16" => Self::U16,
            b"int" | b"int32" => Self::I32,
            b"uint" | b"uint32" => Self::U32,
            b"float" | b"float32" => Self::F32,
            b"double" | b"float64" => Self::F64,
            _ => return None,
        })
    }

    /// Bytes of a value in binary.
    pub(super) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }
}

#[derive(Debug)]
pub(super) struct Property {
    pub(super) name: String,
    /// Type of the length, for a list.
    pub(super) list: Option<Scalar>,
    /// Type of the value or values.
    pub(super) kind: Scalar,
}

#[derive(Debug)]
pub(super) struct Element {
    pub(super) name: String,
    pub(super) count: u64,
    pub(super) properties: Vec<Property>,
}

#[derive(Debug)]
pub(super) struct Header {
    pub(super) format: Format,
    pub(super) elements: Vec<Element>,
    /// Bytes of the header: the data follow.
    pub(super) length: usize,
}

/// Reads the header, whose lines end in LF or CR LF.
pub(super) fn parse(bytes: &[u8]) -> Result<Header, MeshError> {
    let mut header = Header { format: Format::Ascii, elements: Vec::new(), length: 0 };
    let mut format = None;
    loop {
        let at = header.length;
        let error = |message: String, help: &str| MeshError::new(place(bytes, at, true), message, help);
        let rest = &bytes[at..];
        let Some(end) = rest.iter().position(|&b| b == b'\n') else {
            return Err(if at == 0 {
                not_ply(bytes)
            } else {
                error("the header has no `end_header`".into(), "the file is cut off: export the mesh again")
            });
        };
        header.length += end + 1;
        let mut line = &rest[..end];
        if at == 0 {
            if line.trim_ascii() != b"ply" {
                return Err(not_ply(bytes));
            }
            continue;
        }
        match word(&mut line) {
            Some(b"format") => {
                format = match word(&mut line) {
                    Some(b"ascii") => Some(Format::Ascii),
                    Some(b"binary_little_endian") => Some(Format::LittleEndian),
                    Some(b"binary_big_endian") => Some(Format::BigEndian),
                    _ => {
                        return Err(error(
                            "unknown format: expected ascii, binary_little_endian or binary_big_endian"
                                .into(),
                            "export the mesh again",
                        ));
                    }
                };
            }
            Some(b"element") => header.elements.push(element(line).ok_or_else(|| {
                error("expected `element NAME COUNT`".into(), "the header is damaged: export the mesh again")
            })?),
            Some(b"property") => {
                let property = property(line).ok_or_else(|| {
                    error(
                        format!("`{}` is no property", shown(line.trim_ascii())),
                        "expected `property TYPE NAME` or `property list TYPE TYPE NAME` with char, uchar, short, \
                         ushort, int, uint, float or double",
                    )
                })?;
                let element = header.elements.last_mut().ok_or_else(|| {
                    error(
                        "a property before the first element".into(),
                        "the header is damaged: export the mesh again",
                    )
                })?;
                element.properties.push(property);
            }
            Some(b"end_header") => {
                header.format = format.ok_or_else(|| {
                    error("the header has no `format` line".into(), "export the mesh again")
                })?;
                return Ok(header);
            }
            Some(b"comment" | b"obj_info") | None => {}
            Some(other) => {
                return Err(error(
                    format!("`{}` is unknown in a PLY header", shown(other)),
                    "expected format, comment, element, property or end_header",
                ));
            }
        }
    }
}

fn not_ply(bytes: &[u8]) -> MeshError {
    MeshError::new(place(bytes, 0, true), "the first line is not `ply`", "check that this is a PLY file")
}

fn element(mut line: &[u8]) -> Option<Element> {
    let name = String::from_utf8_lossy(word(&mut line)?).into_owned();
    let count = u64::try_from(integer(word(&mut line)?)?).ok()?;
    Some(Element { name, count, properties: Vec::new() })
}

fn property(mut line: &[u8]) -> Option<Property> {
    let mut kind = word(&mut line)?;
    let mut list = None;
    if kind == b"list" {
        list = Some(Scalar::named(word(&mut line)?)?);
        kind = word(&mut line)?;
    }
    let kind = Scalar::named(kind)?;
    Some(Property { name: String::from_utf8_lossy(word(&mut line)?).into_owned(), list, kind })
}
