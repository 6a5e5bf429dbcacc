use crate::fixed::Fixed96;
use crate::{FilmError, Layer, PassFilm};

/// Sums of named layers, layer by layer, each row by row.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct NamedLayers {
    names: Vec<String>,
    /// Weighted.
    sums: Vec<[Fixed96; 3]>,
    /// Without weights; empty while every weight was 1.
    unweighted: Vec<[Fixed96; 3]>,
}

/// Sums of one named layer: weighted, and without weights (empty where the former stand for both).
pub(crate) type LayerSums<'a> = (&'a [[Fixed96; 3]], &'a [[Fixed96; 3]]);

impl NamedLayers {
    /// Longest name, in bytes: with ".R" it fits what EXR takes.
    const MOST_BYTES: usize = 200;

    pub(crate) fn new(names: Vec<String>, pixels: usize) -> Result<Self, FilmError> {
        Self::check(&names)?;
        let sums = vec![[Fixed96::default(); 3]; names.len() * pixels];
        Ok(Self { names, sums, unweighted: Vec::new() })
    }

    /// From parts that belong together; the lengths are the caller's care.
    pub(crate) fn from_parts(
        names: Vec<String>,
        sums: Vec<[Fixed96; 3]>,
        unweighted: Vec<[Fixed96; 3]>,
    ) -> Self {
        Self { names, sums, unweighted }
    }

    pub(crate) fn check(names: &[String]) -> Result<(), FilmError> {
        let ordinary = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
        for (i, name) in names.iter().enumerate() {
            let good = !name.is_empty() && name.len() <= Self::MOST_BYTES && name.chars().all(ordinary);
            if !good || Layer::from_name(name).is_some() || names[..i].contains(name) {
                return Err(FilmError::LayerName(name.clone()));
            }
        }
        Ok(())
    }

    pub(crate) fn memory_bytes(&self) -> usize {
        size_of_val(&*self.sums) + size_of_val(&*self.unweighted)
    }

    pub(crate) fn names(&self) -> &[String] {
        &self.names
    }

    /// The sums of one layer.
    pub(crate) fn sums(&self, index: usize, pixels: usize) -> Option<LayerSums<'_>> {
        let range = index * pixels..(index + 1) * pixels;
        let plain = self.unweighted.get(range.clone()).unwrap_or_default();
        (index < self.names.len()).then(|| (&self.sums[range], plain))
    }

    /// Refuses a pass with another number of layers.
    pub(crate) fn check_values(&self, pass: &PassFilm) -> Result<(), FilmError> {
        if pass.layers().len() == self.sums.len() {
            return Ok(());
        }
        let found = pass.layers().len() / pass.pixels().len().max(1);
        Err(FilmError::Layers { expected: self.names.clone(), found: vec![String::new(); found] })
    }

    pub(crate) fn check_names(&self, other: &Self) -> Result<(), FilmError> {
        if other.names == self.names {
            return Ok(());
        }
        Err(FilmError::Layers { expected: self.names.clone(), found: other.names.clone() })
    }

    /// Adds a pass that [`check_values`](Self::check_values) let through.
    pub(crate) fn add(&mut self, pass: &PassFilm) {
        let weights = pass.pixels().iter().map(|p| p.weight).cycle();
        for ((sum, value), weight) in self.sums.iter_mut().zip(pass.layers()).zip(weights) {
            add(sum, value, weight);
        }
        for (sum, value) in self.unweighted.iter_mut().zip(pass.layers()) {
            add(sum, value, 1.0);
        }
    }

    /// Adds another's sums; of the two, both or none keep sums without weights, or the other's weights were all 1.
    pub(crate) fn merge(&mut self, other: &Self) {
        let plain = if other.unweighted.is_empty() { &other.sums } else { &other.unweighted };
        for (sum, from) in self.unweighted.iter_mut().zip(plain) {
            add_sum(sum, from);
        }
        for (sum, from) in self.sums.iter_mut().zip(&other.sums) {
            add_sum(sum, from);
        }
    }

    /// Starts to keep sums without weights, which so far equal the weighted ones.
    pub(crate) fn split_weights(&mut self) {
        self.unweighted = self.sums.clone();
    }
}

fn add(sum: &mut [Fixed96; 3], value: &[f32; 3], weight: f32) {
    if *value == [0.0; 3] {
        return;
    }
    for (s, v) in sum.iter_mut().zip(value) {
        s.add(weight * v);
    }
}

fn add_sum(sum: &mut [Fixed96; 3], from: &[Fixed96; 3]) {
    for (s, f) in sum.iter_mut().zip(from) {
        s.add_sum(*f);
    }
}
