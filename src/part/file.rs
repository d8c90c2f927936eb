//! Part files.
