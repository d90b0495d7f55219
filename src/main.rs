//! The program: everything it does is in the crates of this folder.

use std::process::ExitCode;

fn main() -> ExitCode {
    selvedge_cli::main()
}
