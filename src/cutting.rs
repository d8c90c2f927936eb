//! How a contour is cut: its lead-in, overcut, tabs and passes.
