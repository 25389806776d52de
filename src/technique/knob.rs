//! Knobs: what can be asked of techniques. A knob is one row of the table in `settings`: a field of its settings with its
//! type, default, range and flag. The command line's flags and their help, the C library's fields, the sweeps of studies,
//! names in tables and specialization constants are derived from the rows.

use super::field::Numbered;
use super::row::Row;
use crate::{Error, Result};

/// A knob of the settings `S`.
#[derive(Debug)]
pub struct Knob<S> {
    /// The name of the field, here and in the C library.
    pub field: &'static str,
    pub row: Row,
    pub(super) access: Access<S>,
}

/// How a knob's field is read and written.
#[derive(Debug)]
pub(super) struct Access<S> {
    pub text: fn(&S) -> String,
    pub set_text: fn(&mut S, &str) -> Result<()>,
    pub number: fn(&S) -> u32,
    pub set_number: fn(&mut S, u32) -> Numbered<()>,
    pub check: fn(&S, &Row) -> Result<()>,
    pub choices: fn() -> Vec<(String, &'static str)>,
}

impl<S> Knob<S> {
    /// The names that it can have and what they are, in the order of their numbers; none unless it is a choice.
    pub fn choices(&self) -> Vec<(String, &'static str)> {
        (self.access.choices)()
    }

    /// What `--help` says of it.
    pub fn help(&self) -> String {
        let choices = self.choices().into_iter();
        let mut names: Vec<String> = choices.map(|(name, _)| name).collect();
        let last = names.pop().unwrap_or_default();
        let names = match names.is_empty() {
            true => last,
            false => format!("{} or {last}", names.join(", ")),
        };
        self.row.help.replace("{}", &names)
    }

    /// Its value, as the flag takes it; of a switch whether the flag is there.
    pub fn text(&self, settings: &S) -> String {
        (self.access.text)(settings)
    }

    /// Whether a switch's flag is there.
    pub fn is_on(&self, settings: &S) -> bool {
        ((self.access.number)(settings) != 0) != self.row.negates()
    }

    /// Sets it as the flag with this value does; a switch takes none.
    ///
    /// # Errors
    /// The text is no value of the knob, in a sentence. Ranges are for the settings to check.
    pub fn set(&self, settings: &mut S, text: &str) -> Result<()> {
        match self.row.is_switch() {
            true => self.set_number(settings, u32::from(!self.row.negates())),
            false => (self.access.set_text)(settings, text),
        }
    }

    /// Sets a switch as it is without its flag.
    ///
    /// # Errors
    /// It is no switch.
    pub fn unset(&self, settings: &mut S) -> Result<()> {
        self.set_number(settings, u32::from(self.row.negates()))
    }

    /// Its value as the C library and specialization constants have it: of a choice its place, of a field that is on or
    /// off 1 or 0.
    pub fn number(&self, settings: &S) -> u32 {
        (self.access.number)(settings)
    }

    /// # Errors
    /// There is no such choice, in a sentence.
    pub fn set_number(&self, settings: &mut S, number: u32) -> Result<()> {
        (self.access.set_number)(settings, number)
            .map_err(|allowed| Error::Invalid(format!("{} is {allowed}, not {number}", self.field)))
    }

    /// # Errors
    /// [`Error::Invalid`] when the value is not allowed.
    pub fn check(&self, settings: &S) -> Result<()> {
        (self.access.check)(settings, &self.row)
    }
}
