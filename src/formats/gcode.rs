//! G-code as wire cutters speak it.
