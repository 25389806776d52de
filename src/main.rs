//! The command line.

mod cli;
#[cfg(test)]
#[path = "../tests/support/faults.rs"]
mod faults;
#[cfg(test)]
#[path = "../tests/support/slow.rs"]
mod slow;

use std::process::ExitCode;

use clap::Parser;

/// Soft shadows of area lights, without noise and without history, on Vulkan.
///
/// Results go to the named files and to standard output; notes, errors and, on a terminal, progress go
/// to standard error. Exit code 0: done. 1: refused or failed, with one sentence that says why, and no
/// unfinished file left. 2: wrong usage.
#[derive(Debug, clap::Parser)]
#[command(version)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, clap::Subcommand)]
enum Command {
    Render(cli::render::Args),
    Plan(cli::plan::Args),
    Reference(cli::reference::Args),
    Compare(cli::compare::Args),
    Study(cli::study::Args),
    Calibrate(cli::calibrate::Args),
    Devices(cli::devices::Args),
}

fn main() -> ExitCode {
    let result = match Arguments::parse().command {
        Command::Render(args) => cli::render::run(&args),
        Command::Plan(args) => cli::plan::run(&args),
        Command::Reference(args) => cli::reference::run(&args),
        Command::Compare(args) => cli::compare::run(&args),
        Command::Study(args) => cli::study::run(&args),
        Command::Calibrate(args) => cli::calibrate::run(&args),
        Command::Devices(args) => cli::devices::run(&args),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            cli::print_error(&error);
            ExitCode::FAILURE
        }
    }
}
