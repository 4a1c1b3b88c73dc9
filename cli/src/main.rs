//! The program `plunge`.

use std::process::ExitCode;

fn main() -> ExitCode {
    plunge::main()
}
