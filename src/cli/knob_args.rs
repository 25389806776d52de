//! The flags of all knobs, made from the table of knobs.

use clap::builder::ValueParser;
use clap::parser::ValueSource;
use clap::{Arg, ArgAction, ArgMatches, Args, Command, FromArgMatches};

use halfshade::Result;
use halfshade::study::Sweep;
use halfshade::technique::{KNOBS, Knob, Settings, SweepFlag};

use super::calibration::Calibration;

/// The knobs that the command line names, in the order of the table, with their values.
#[derive(Debug, Default)]
pub struct KnobArgs(Vec<(&'static Knob, String)>);

impl KnobArgs {
    /// What the flags leave open is as `calibration` says, or else as is usual for the technique.
    ///
    /// # Errors
    /// A value is none of its knob's.
    pub fn settings(&self, calibration: &Calibration) -> Result<Settings> {
        let mut asked = Settings::default();
        self.set(&mut asked)?;
        let mut settings = Settings::usual(asked.technique);
        calibration.apply(&mut settings);
        self.set(&mut settings)?;
        Ok(settings)
    }

    fn set(&self, settings: &mut Settings) -> Result<()> {
        let mut given = self.0.iter();
        given.try_for_each(|(knob, value)| knob.set(settings, value))
    }
}

impl Args for KnobArgs {
    fn augment_args(command: Command) -> Command {
        let defaults = Settings::default();
        command.args(KNOBS.iter().map(|knob| flag(knob, &defaults)))
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl FromArgMatches for KnobArgs {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let is_given =
            |knob: &&Knob| matches.value_source(knob.row.flag) == Some(ValueSource::CommandLine);
        let value = |knob: &'static Knob| {
            let value = match knob.row.is_switch() {
                true => None,
                false => matches.get_one::<String>(knob.row.flag).cloned(),
            };
            (knob, value.unwrap_or_default())
        };
        Ok(Self(KNOBS.iter().filter(is_given).map(value).collect()))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

fn flag(knob: &'static Knob, defaults: &Settings) -> Arg {
    let row = &knob.row;
    let arg = Arg::new(row.flag).long(row.flag).help(knob.help());
    match row.value_name {
        None => arg.action(ArgAction::SetTrue),
        Some(value_name) => {
            let arg = arg.value_name(value_name).value_parser(value_of(knob));
            match row.depends {
                true => arg,
                false => arg.default_value(knob.text(defaults)),
            }
        }
    }
}

/// A value of a knob, as it is written.
fn value_of(knob: &'static Knob) -> ValueParser {
    ValueParser::from(move |text: &str| {
        knob.set(&mut Settings::default(), text)?;
        Ok::<_, halfshade::Error>(text.to_owned())
    })
}

/// Values to try of those knobs that studies sweep.
#[derive(Debug, Default)]
pub struct SweepValues(Vec<(&'static Knob, Vec<String>)>);

impl SweepValues {
    /// What the flags ask to try, where they do; packets are the device's where they do not.
    pub fn sweep(&self, calibration: &Calibration) -> Sweep {
        let mut calibrated = Settings::default();
        calibration.apply(&mut calibrated);
        let is_packet = |knob: &Knob| knob.field == "packet";
        let values = |(knob, values): &(&'static Knob, Vec<String>)| match values.is_empty() {
            true if is_packet(knob) => (*knob, vec![knob.text(&calibrated)]),
            _ => (*knob, values.clone()),
        };
        Sweep(self.0.iter().map(values).collect())
    }

    /// The study's flags that no settings of `all` read.
    pub fn unread<'a>(&'a self, all: &'a [Settings]) -> impl Iterator<Item = &'static str> + 'a {
        let is_read = |knob: &Knob| {
            let reads = |settings: &Settings| settings.reads(knob.row.flag, false);
            all.iter().any(|settings| reads(settings) == Some(true))
        };
        let given = self.0.iter().filter(|(_, values)| !values.is_empty());
        given.filter_map(move |(knob, _)| Some(knob.row.sweep.filter(|_| !is_read(knob))?.flag))
    }
}

impl Args for SweepValues {
    fn augment_args(command: Command) -> Command {
        let swept = KNOBS
            .iter()
            .filter_map(|knob| Some((knob, knob.row.sweep?)));
        command.args(swept.map(|(knob, sweep)| sweep_flag(knob, sweep)))
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl FromArgMatches for SweepValues {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let values = |knob: &'static Knob| {
            let values = matches.get_many::<String>(knob.row.sweep?.flag);
            Some((knob, values.into_iter().flatten().cloned().collect()))
        };
        Ok(Self(KNOBS.iter().filter_map(values).collect()))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

fn sweep_flag(knob: &'static Knob, sweep: SweepFlag) -> Arg {
    let arg = Arg::new(sweep.flag)
        .long(sweep.flag)
        .value_name(sweep.value_name)
        .help(sweep.help)
        .value_delimiter(',')
        .action(ArgAction::Append)
        .value_parser(value_of(knob));
    match sweep.default {
        Some(default) => arg.default_value(default),
        None => arg,
    }
}
