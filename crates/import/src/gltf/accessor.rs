//! Accessors (glTF 2.0 §3.6.2): typed columns of numbers, dense or sparse.

use super::bytes::Buffers;
use super::fault::{Fault, Known};
use super::json::Value;

/// Items of an accessor without data, at most, in a small file.
const FEW_ZEROS: usize = 1 << 16;

/// The file: its JSON and its bytes.
#[derive(Debug)]
pub(super) struct Source<'t> {
    pub root: &'t Value<'t>,
    pub buffers: Buffers,
}

/// The type of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Component {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl Component {
    fn of(code: u64) -> Option<Self> {
        Some(match code {
            5120 => Self::I8,
            5121 => Self::U8,
            5122 => Self::I16,
            5123 => Self::U16,
            5125 => Self::U32,
            5126 => Self::F32,
            _ => return None,
        })
    }

    fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }

    /// The number at the start of some bytes; normalised as §3.11 says.
    fn float(self, b: &[u8], normalized: bool) -> f32 {
        let (value, most) = match self {
            Self::I8 => (f32::from(b[0] as i8), 127.0),
            Self::U8 => (f32::from(b[0]), 255.0),
            Self::I16 => (f32::from(i16::from_le_bytes([b[0], b[1]])), 32767.0),
            Self::U16 => (f32::from(u16::from_le_bytes([b[0], b[1]])), 65535.0),
            Self::U32 => (u32::from_le_bytes([b[0], b[1], b[2], b[3]]) as f32, u32::MAX as f32),
            Self::F32 => return f32::from_le_bytes([b[0], b[1], b[2], b[3]]),
        };
        if normalized { (value / most).max(-1.0) } else { value }
    }

    /// As an index.
    fn whole(self, b: &[u8]) -> u32 {
        match self {
            Self::I8 | Self::U8 => u32::from(b[0]),
            Self::I16 | Self::U16 => u32::from(u16::from_le_bytes([b[0], b[1]])),
            Self::U32 | Self::F32 => u32::from_le_bytes([b[0], b[1], b[2], b[3]]),
        }
    }
}

/// A column of vectors, checked to lie within its bytes.
#[derive(Debug)]
pub(super) struct Accessor<'b> {
    pub count: usize,
    /// Numbers of each vector.
    pub width: usize,
    component: Component,
    normalized: bool,
    stride: usize,
    /// `None`: zeros.
    data: Option<&'b [u8]>,
    /// Places and, tightly packed, the values that stand there instead.
    sparse: Option<(Vec<u32>, &'b [u8])>,
}

impl Source<'_> {
    /// The accessor that a key of a value names, if there is the key.
    pub(super) fn accessor(&self, of: &Value<'_>, key: &str) -> Known<Option<Accessor<'_>>> {
        match of.get(key) {
            None => Ok(None),
            Some(name) => self.accessor_at(name, key).map(Some),
        }
    }

    pub(super) fn accessor_at(&self, name: &Value<'_>, key: &str) -> Known<Accessor<'_>> {
        let (_, value) = name.pick_self(key, "accessor", self.root.array("accessors")?)?;
        let fault = |text: String| Fault::new("out-of-range", text, value.span());
        let component = component(value, "componentType")?;
        let width = match value.text("type")? {
            Some("SCALAR") => 1,
            Some("VEC2") => 2,
            Some("VEC3") => 3,
            Some("VEC4" | "MAT2") => 4,
            Some("MAT3") => 9,
            Some("MAT4") => 16,
            other => return Err(fault(format!("`{}` is no type of an accessor", other.unwrap_or_default()))),
        };
        let count = value.whole("count")?.unwrap_or(0) as usize;
        let size = width * component.size();
        let normalized = value.truth("normalized", false)?;
        let (mut data, mut stride) = (None, size);
        if value.get("bufferView").is_some() {
            let (bytes, said) = self.view_of(value)?;
            stride = said.filter(|s| *s != 0).unwrap_or(size);
            if stride < size {
                return Err(fault(format!("items of {size} bytes every {stride}")));
            }
            let offset = value.whole("byteOffset")?.unwrap_or(0) as usize;
            let whole = bytes.get(offset..).filter(|bytes| fits(bytes.len(), count, stride, size));
            data = Some(whole.ok_or_else(|| {
                fault(format!("{count} items of {size} bytes every {stride} from byte {offset} are beyond the {} of the bufferView", bytes.len()))
            })?);
        } else if count > FEW_ZEROS.max(self.buffers.size()) {
            return Err(fault(format!(
                "an accessor of {count} zeros is larger than the file makes plausible"
            )));
        }
        let sparse = value.get("sparse").map(|sparse| self.sparse(sparse, count, size)).transpose()?;
        Ok(Accessor { count, width, component, normalized, stride, data, sparse })
    }

    fn view_of(&self, value: &Value<'_>) -> Known<(&[u8], Option<usize>)> {
        let views = self.root.array("bufferViews")?;
        let (_, view) = value
            .pick("bufferView", "bufferView", views)?
            .ok_or_else(|| Fault::new("missing-key", "`bufferView` is missing", value.span()))?;
        self.view(view)
    }

    /// The bytes of a bufferView and its stride, if it says one.
    pub(super) fn view(&self, view: &Value<'_>) -> Known<(&[u8], Option<usize>)> {
        self.buffers.view(self.root, view)
    }

    fn sparse(&self, value: &Value<'_>, count: usize, size: usize) -> Known<(Vec<u32>, &[u8])> {
        let fault = |text: &str| Fault::new("out-of-range", text, value.span());
        let n = value.whole("count")?.unwrap_or(0) as usize;
        let (Some(indices), Some(values)) = (value.get("indices"), value.get("values")) else {
            return Err(fault("a sparse accessor without `indices` or `values`"));
        };
        let kind = component(indices, "componentType")?;
        let part = |of: &Value<'_>, size: usize| {
            let (bytes, _) = self.view_of(of)?;
            let offset = of.whole("byteOffset")?.unwrap_or(0) as usize;
            bytes
                .get(offset..)
                .filter(|bytes| fits(bytes.len(), n, size, size))
                .ok_or_else(|| fault("a sparse accessor reaches beyond its bufferView"))
        };
        let places: Vec<u32> =
            part(indices, kind.size())?.chunks_exact(kind.size()).take(n).map(|b| kind.whole(b)).collect();
        if places.iter().any(|&p| p as usize >= count) {
            return Err(fault("a sparse accessor replaces an item that is not there"));
        }
        Ok((places, part(values, size)?))
    }
}

fn component(of: &Value<'_>, key: &str) -> Known<Component> {
    let code = of.whole(key)?.unwrap_or(0);
    Component::of(code)
        .ok_or_else(|| Fault::new("unknown-kind", format!("{code} is no type of numbers"), of.span()))
}

/// Whether so many items, the last without what follows it, are in so many bytes.
fn fits(bytes: usize, count: usize, stride: usize, size: usize) -> bool {
    count == 0
        || (count - 1).checked_mul(stride).and_then(|n| n.checked_add(size)).is_some_and(|n| n <= bytes)
}

impl Accessor<'_> {
    /// Whether any of it is in a buffer.
    pub(super) fn has_data(&self) -> bool {
        self.data.is_some() || self.sparse.is_some()
    }

    fn read<const N: usize>(&self, b: &[u8]) -> [f32; N] {
        let size = self.component.size();
        std::array::from_fn(|i| self.component.float(&b[i * size..], self.normalized))
    }

    /// Every vector; `N` at most `width`.
    pub(super) fn floats<const N: usize>(&self) -> Vec<[f32; N]> {
        let mut out: Vec<[f32; N]> = match self.data {
            None => vec![[0.0; N]; self.count],
            Some(data) if self.component == Component::F32 => rows(data, self.stride, self.count, 4 * N)
                .map(|b| {
                    std::array::from_fn(|i| {
                        f32::from_le_bytes([b[4 * i], b[4 * i + 1], b[4 * i + 2], b[4 * i + 3]])
                    })
                })
                .collect(),
            Some(data) => {
                rows(data, self.stride, self.count, N * self.component.size()).map(|b| self.read(b)).collect()
            }
        };
        if let Some((places, values)) = &self.sparse {
            let size = self.width * self.component.size();
            for (place, value) in places.iter().zip(values.chunks_exact(size)) {
                out[*place as usize] = self.read(value);
            }
        }
        out
    }

    /// The vectors of some places, all within `count`.
    pub(super) fn floats_at<const N: usize>(&self, places: &[u32]) -> Vec<[f32; N]> {
        match self.data {
            Some(data) if self.sparse.is_none() => {
                places.iter().map(|&i| self.read(&data[i as usize * self.stride..])).collect()
            }
            _ => {
                let all = self.floats();
                places.iter().map(|&i| all[i as usize]).collect()
            }
        }
    }

    /// Every item as a whole number: indices and joints.
    pub(super) fn wholes<const N: usize>(&self) -> Vec<[u32; N]> {
        let size = self.component.size();
        let read = |b: &[u8]| std::array::from_fn(|i| self.component.whole(&b[i * size..]));
        let mut out: Vec<[u32; N]> = match self.data {
            None => vec![[0; N]; self.count],
            Some(data) => rows(data, self.stride, self.count, N * size).map(read).collect(),
        };
        if let Some((places, values)) = &self.sparse {
            for (place, value) in places.iter().zip(values.chunks_exact(self.width * size)) {
                out[*place as usize] = read(value);
            }
        }
        out
    }

    /// Indices of vertices, three at a time, where they lie together as triangles do.
    pub(super) fn triangles(&self) -> Option<Vec<[u32; 3]>> {
        let size = self.component.size();
        let data = self.data.filter(|_| self.stride == size && self.sparse.is_none())?;
        let data = &data[..self.count * size];
        Some(match self.component {
            Component::U32 => {
                let word = |b: &[u8]| u32::from_le_bytes([b[0], b[1], b[2], b[3]]);
                data.chunks_exact(12).map(|b| [word(b), word(&b[4..]), word(&b[8..])]).collect()
            }
            kind => {
                data.chunks_exact(3 * size).map(|b| [0, 1, 2].map(|i| kind.whole(&b[i * size..]))).collect()
            }
        })
    }
}

/// `count` rows of at least `size` bytes, `stride` apart.
fn rows(data: &[u8], stride: usize, count: usize, size: usize) -> impl Iterator<Item = &[u8]> {
    (0..count).map(move |i| &data[i * stride..i * stride + size])
}
