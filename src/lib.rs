//! dripfeed
