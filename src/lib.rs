//! Makes wire-EDM blocks on demand and drip-feeds them to a control over a serial link.

pub mod units;

pub mod place;

pub mod geometry;

pub mod motion;

pub mod shapes;

pub mod interpolator;

pub mod rounding;

pub mod formats;

pub mod macros;

pub mod compensation;

pub mod cutting;

pub mod program;

pub mod journal;

pub mod tape;

pub mod protocol;

pub mod profile;

pub mod link;

pub mod drawing;

pub mod check;

pub mod plot;

pub mod keys;

pub mod part;

pub mod cli;
