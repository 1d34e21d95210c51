//! The binary; all of its code is in the library.

use std::process::ExitCode;

fn main() -> color_eyre::Result<ExitCode> {
    phaselab::shell::report_panics()?;
    Ok(phaselab::cli::main(std::env::args_os()))
}
