//! One paper per file.
