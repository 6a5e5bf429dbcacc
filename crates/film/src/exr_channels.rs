use std::io::Cursor;
use std::path::Path;

use exr::prelude::{ReadChannels, ReadLayers};

use crate::{ReadError, ReadErrorKind};

/// The channels of an EXR file, row by row from the top, with their names.
#[derive(Clone, Debug, PartialEq)]
pub struct ExrChannels {
    width: usize,
    height: usize,
    channels: Vec<(String, Vec<f32>)>,
}

impl ExrChannels {
    /// Reads the first part of a file, of any program: its data window, any float or integer type, any compression that
    /// the crate `exr` knows.
    ///
    /// # Errors
    /// Where the file can't be read, or is no EXR picture.
    pub fn read(path: &Path) -> Result<Self, ReadError> {
        let bytes = std::fs::read(path).map_err(|e| ReadError::new(path, ReadErrorKind::Io(e)))?;
        Self::decode(&bytes).map_err(|kind| ReadError::new(path, kind))
    }

    /// [`read`](Self::read) from the bytes of a file.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn decode(bytes: &[u8]) -> Result<Self, ReadErrorKind> {
        if !bytes.starts_with(&[0x76, 0x2f, 0x31, 0x01]) {
            return Err(ReadErrorKind::Format("it is no EXR file".into()));
        }
        let image = exr::prelude::read()
            .no_deep_data()
            .largest_resolution_level()
            .all_channels()
            .all_layers()
            .all_attributes()
            .non_parallel()
            .from_buffered(Cursor::new(bytes))
            .map_err(|e| ReadErrorKind::Format(e.to_string()))?;
        let Some(part) = image.layer_data.first() else {
            return Err(ReadErrorKind::Format("it holds no part".into()));
        };
        let (width, height) = (part.size.0, part.size.1);
        let whole = |values: &Vec<f32>| values.len() == width * height;
        let channels = part.channel_data.list.iter();
        let channels = channels
            .map(|c| (c.name.to_string(), c.sample_data.values_as_f32().collect()))
            .filter(|(_, values)| whole(values));
        Ok(Self { width, height, channels: channels.collect() })
    }

    /// Pixels a row.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> usize {
        self.height
    }

    /// Names of the channels, as in the file.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.channels.iter().map(|(name, _)| name.as_str())
    }

    /// The values of a channel.
    pub fn channel(&self, name: &str) -> Option<&[f32]> {
        self.channels.iter().find(|(n, _)| n == name).map(|(_, values)| values.as_slice())
    }

    /// The colours of a layer: its channels R, G and B. The empty name is the root layer.
    pub fn colours(&self, layer: &str) -> Option<Vec<[f32; 3]>> {
        self.triples(layer, ["R", "G", "B"])
    }

    /// The vectors of a layer: its channels X, Y and Z.
    pub fn vectors(&self, layer: &str) -> Option<Vec<[f32; 3]>> {
        self.triples(layer, ["X", "Y", "Z"])
    }

    fn triples(&self, layer: &str, letters: [&str; 3]) -> Option<Vec<[f32; 3]>> {
        let channel = |letter: &str| match layer {
            "" => self.channel(letter),
            layer => self.channel(&format!("{layer}.{letter}")),
        };
        let [x, y, z] = letters.map(channel);
        let (x, y, z) = (x?, y?, z?);
        Some((0..x.len()).map(|i| [x[i], y[i], z[i]]).collect())
    }

    /// Names of all layers with R, G and B, sorted; without the root layer.
    pub fn colour_layers(&self) -> Vec<String> {
        let mut names: Vec<String> = self
            .names()
            .filter_map(|name| name.strip_suffix(".R"))
            .filter(|layer| ["G", "B"].iter().all(|c| self.channel(&format!("{layer}.{c}")).is_some()))
            .map(str::to_owned)
            .collect();
        names.sort();
        names
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn channels_come_back() {
        let channel = |name: &str, value: f32| (name.to_owned(), vec![value, value + 0.5]);
        let channels: Vec<_> =
            [("R", 1.0), ("G", 2.0), ("B", 3.0), ("x.R", 4.0), ("x.G", 5.0), ("x.B", 6.0), ("y.R", 7.0)]
                .map(|(name, value)| channel(name, value))
                .to_vec();
        let bytes = crate::encode_exr_channels(2, 1, &channels, &[]).unwrap();
        let read = ExrChannels::decode(&bytes).unwrap();
        assert_eq!(read.colours(""), Some(vec![[1.0, 2.0, 3.0], [1.5, 2.5, 3.5]]));
        assert_eq!(read.colour_layers(), ["x"]);
        assert_eq!(read.colours("y"), None);
        assert!(matches!(ExrChannels::decode(b"PNG"), Err(ReadErrorKind::Format(_))));
        assert!(crate::encode_exr_channels(3, 1, &channels, &[]).is_err());
    }
}
