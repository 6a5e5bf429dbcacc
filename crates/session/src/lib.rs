//! Jobs: which passes run, what is saved, whom to tell.
