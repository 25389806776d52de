//! The command line.

mod cli;
#[cfg(test)]
#[path = "../tests/support/faults.rs"]
mod faults;
#[cfg(test)]
#[path = "../tests/support/slow.rs"]
mod slow;

use std::process::ExitCode;

use clap::error::ErrorKind;
use clap::{ArgMatches, CommandFactory, FromArgMatches};
use cli::given::Given;
use halfshade::Result;

/// Soft shadows of area lights, without noise and without history, on Vulkan.
///
/// Results go to the named files and to standard output; notes, errors and, on a terminal, progress go
/// to standard error. Exit code 0: done. 1: refused or failed because of what a file holds or the machine has, with
/// one sentence that says why, and no unfinished file left. 2: wrong usage, which the command line alone tells.
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
    Shaders(cli::shaders::Args),
    Reference(cli::reference::Args),
    Compare(cli::compare::Args),
    Study(cli::study::Args),
    Calibrate(cli::calibrate::Args),
    Devices(cli::devices::Args),
}

impl Command {
    /// # Errors
    /// What the command line alone gets wrong, as far as its parser does not see it.
    fn check(&self) -> Result<()> {
        match self {
            Self::Render(args) => cli::render::check(args),
            Self::Plan(args) => cli::plan::check(args),
            Self::Shaders(args) => cli::shaders::check(args),
            Self::Reference(args) => cli::reference::check(args),
            Self::Compare(args) => cli::compare::check(args),
            Self::Study(args) => cli::study::check(args),
            Self::Calibrate(_) | Self::Devices(_) => Ok(()),
        }
    }

    fn run(&self, given: &Given) -> Result<()> {
        match self {
            Self::Render(args) => cli::render::run(args, given),
            Self::Plan(args) => cli::plan::run(args, given),
            Self::Shaders(args) => cli::shaders::run(args, given),
            Self::Reference(args) => cli::reference::run(args, given),
            Self::Compare(args) => cli::compare::run(args),
            Self::Study(args) => cli::study::run(args, given),
            Self::Calibrate(args) => cli::calibrate::run(args),
            Self::Devices(args) => cli::devices::run(args),
        }
    }
}

/// The subcommand that was called.
fn called(program: &clap::Command, mut matches: &ArgMatches) -> clap::Command {
    let mut called = program;
    while let Some((name, inner)) = matches.subcommand()
        && let Some(command) = called.find_subcommand(name)
    {
        (called, matches) = (command, inner);
    }
    called.clone()
}

fn main() -> ExitCode {
    let mut program = Arguments::command();
    let matches = program.get_matches_mut();
    let parsed = Arguments::from_arg_matches(&matches);
    let command = match parsed {
        Ok(arguments) => arguments.command,
        Err(error) => error.format(&mut program).exit(),
    };
    if let Err(error) = command.check() {
        let message = cli::one_line(&error.to_string());
        let mut command = called(&program, &matches);
        command.error(ErrorKind::ValueValidation, message).exit();
    }
    match command.run(&Given::of(&program, &matches)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            cli::print_error(&error);
            ExitCode::FAILURE
        }
    }
}
