//! Plans on shapes one can reckon by hand.
