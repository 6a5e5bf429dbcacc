//! The verbs of light transport.
