//! Triangle meshes: readers and generators.
