//! The flags that stand on the command line, apart from those that have their defaults.

use clap::parser::ValueSource;
use clap::{ArgMatches, Command};

/// Long names of flags, without their dashes.
#[derive(Debug, Default)]
pub struct Given(Vec<String>);

impl Given {
    /// Those of a command and of the subcommands that were chosen.
    pub fn of(command: &Command, matches: &ArgMatches) -> Self {
        let mut given = Self::default();
        given.gather(command, matches);
        given
    }

    fn gather(&mut self, command: &Command, matches: &ArgMatches) {
        for argument in command.get_arguments() {
            let source = matches.value_source(argument.get_id().as_str());
            let is_given = source == Some(ValueSource::CommandLine);
            let name = argument.get_long().filter(|_| is_given);
            self.0.extend(name.map(str::to_owned));
        }
        if let Some((name, matches)) = matches.subcommand()
            && let Some(command) = command.find_subcommand(name)
        {
            self.gather(command, matches);
        }
    }

    pub fn has(&self, flag: &str) -> bool {
        self.flags().any(|given| given == flag)
    }

    pub fn flags(&self) -> impl Iterator<Item = &str> {
        self.0.iter().map(String::as_str)
    }
}
