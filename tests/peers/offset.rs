//! shapely against the offsets of outlines.
