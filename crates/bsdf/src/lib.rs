//! Scattering functions.
