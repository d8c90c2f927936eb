//! Outlines at a distance: the wire beside the contour it cuts.
