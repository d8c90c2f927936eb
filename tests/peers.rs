//! Other programs judge what this one reads and writes: LinuxCNC's `rs274` the G-code and the macros, `ezdxf` the drawings, `shapely`
//! the offsets.
//!
//! They must be installed, so these tests have a feature of their own: `.ci/run` installs them and runs
//! `PEER_PYTHON=target/peers/bin/python cargo test --features peers --test peers`. Without them they fail; none is skipped.

#[path = "offset/contours.rs"]
mod contours;
#[path = "peers/drawing.rs"]
mod drawing;
#[path = "peers/gcode.rs"]
mod gcode;
#[path = "peers/macros.rs"]
mod macros;
#[path = "peers/offset.rs"]
mod offset;

use std::process::Command;

/// The Python that has ezdxf and shapely.
fn python() -> Command {
    Command::new(std::env::var_os("PEER_PYTHON").expect("PEER_PYTHON names a Python with ezdxf and shapely"))
}
