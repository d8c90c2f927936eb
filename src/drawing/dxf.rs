//! DXF: drawings read into contours, and paths written as drawings.
