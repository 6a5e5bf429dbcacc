//! Pixels: filters, sums, layers, EXR and PNG.
