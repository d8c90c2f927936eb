//! dripfeed
fn main() {}
