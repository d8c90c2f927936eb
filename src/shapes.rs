//! Parts from a handful of numbers: parameters in, a lazy contour out.
//!
//! A shape never holds its outline: it yields one directed [`Element`](crate::geometry::Element) when asked, and the
//! same parameters give the same elements, bit for bit, every time. Only the modified cycloid gear is here yet.

pub mod cycloid_gear;
