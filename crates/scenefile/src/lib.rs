//! Scene descriptions: the TOML reader, its diagnostics and its reference.
