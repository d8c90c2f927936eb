//! The command `dripfeed`: a result becomes an exit code, nothing else happens here.

use std::process::ExitCode;

fn main() -> ExitCode {
    dripfeed::cli::main()
}
