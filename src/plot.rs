//! A program as a picture.
