//! Reading 3B.
