//! A curve cut into lines or pairs of tangent arcs that stay within a tolerance of it.
