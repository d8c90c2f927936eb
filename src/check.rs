//! What can be found wrong with a program before it is fed.
