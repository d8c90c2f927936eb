//! LinuxCNC's `rs274` against the writer of G-code.
