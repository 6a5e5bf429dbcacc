//! Nephroid as a library.
