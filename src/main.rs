//! The command line.

mod cli;

use std::process::ExitCode;

use clap::Parser;

/// Soft shadows of area lights.
#[derive(Debug, clap::Parser)]
#[command(version)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, clap::Subcommand)]
enum Command {
    Compare(cli::compare::Args),
    Reference(cli::reference::Args),
}

fn main() -> ExitCode {
    let result = match Arguments::parse().command {
        Command::Compare(args) => cli::compare::run(&args),
        Command::Reference(args) => cli::reference::run(&args),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("halfshade: {error}");
            ExitCode::FAILURE
        }
    }
}
