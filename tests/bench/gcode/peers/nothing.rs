//! A package needs a target of this kind; the benchmark is `main.rs`.
