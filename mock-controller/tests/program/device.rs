//! As a serial device: one side of a pseudo-terminal stands for the cable.

use std::io::{Read as _, Write as _};

use crate::process::{Mock, wait_for};
use crate::pty::open;

#[test]
fn a_serial_device_is_a_link_that_is_open_from_the_start() {
    let master =
        rustix::pty::openpt(rustix::pty::OpenptFlags::RDWR | rustix::pty::OpenptFlags::NOCTTY).unwrap();
    rustix::pty::grantpt(&master).unwrap();
    rustix::pty::unlockpt(&master).unwrap();
    let device = rustix::pty::ptsname(&master, Vec::new()).unwrap().into_string().unwrap();
    // Held open, lest the other side count as hung up before the program is there.
    let _held = open(std::path::Path::new(&device));
    let mut cable = std::fs::File::from(master);
    let mut mock = Mock::start(&["--port", &device, "--baud", "115200", "--framing", "8N1", "--once"]);
    assert_eq!(mock.ready, device);
    let mut byte = [0];
    wait_for("DC1", || cable.read(&mut byte).unwrap() == 1 && byte[0] == 0x11);
    cable.write_all(b"%\nB10 B0 B000010 GX L1\nDD\n").unwrap();
    wait_for("DC3", || cable.read(&mut byte).unwrap() == 1 && byte[0] == 0x13);
    let (code, report) = mock.ended();
    assert_eq!((code, &report["blocks"], &report["programs"]), (0, &1.into(), &1.into()));
}
