//! Knobs: what can be asked of techniques. A knob is one row of the table in `settings`: a field of its settings with its
//! type, default, range and flag. The command line's flags and their help, the C library's fields, the sweeps of studies,
//! names in tables and specialization constants are derived from the rows.

use std::fmt::Display;
use std::str::FromStr;

use super::choice::Choice;
use crate::{Error, Result};

/// A knob of the settings `S`.
#[derive(Debug)]
pub struct Knob<S> {
    /// The name of the field, here and in the C library.
    pub field: &'static str,
    pub row: Row,
    pub(super) access: Access<S>,
}

/// What a row of the table says beside name, type and default.
#[derive(Debug, Clone, Copy)]
pub struct Row {
    /// The flag, without its dashes.
    pub flag: &'static str,
    /// What stands for its value in `--help`; None: a switch, which is there or not.
    pub value_name: Option<&'static str>,
    /// For `--help`, with {} for the names of a choice.
    pub help: &'static str,
    /// Its default depends on the technique or the device; the help says how.
    pub depends: bool,
    /// The specialization constant that it sets.
    pub constant: Option<&'static str>,
    /// The flag of studies that names several values of it, and what stands for them.
    pub sweep: Option<SweepFlag>,
    allowed: Allowed,
    /// A sentence on what is allowed, with {} in its place.
    rule: &'static str,
}

/// A flag of studies.
#[derive(Debug, Clone, Copy)]
pub struct SweepFlag {
    pub flag: &'static str,
    pub value_name: &'static str,
    pub help: &'static str,
    /// Values without the flag, separated by commas; none = what is usual.
    pub default: Option<&'static str>,
}

#[derive(Debug, Clone, Copy)]
enum Allowed {
    Any,
    Within(u32, u32),
    OneOf(&'static [u32]),
    Share,
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

impl Row {
    /// A flag with a value.
    pub(super) const fn value(
        flag: &'static str,
        value_name: &'static str,
        help: &'static str,
    ) -> Self {
        Self {
            value_name: Some(value_name),
            ..Self::switch(flag, help)
        }
    }

    /// A flag without. One that begins with "no-" switches its field off.
    pub(super) const fn switch(flag: &'static str, help: &'static str) -> Self {
        Self {
            flag,
            value_name: None,
            help,
            depends: false,
            constant: None,
            sweep: None,
            allowed: Allowed::Any,
            rule: "",
        }
    }

    /// `rule`: a sentence, with {} for the range.
    pub(super) const fn within(self, least: u32, most: u32, rule: &'static str) -> Self {
        let allowed = Allowed::Within(least, most);
        Self {
            allowed,
            rule,
            ..self
        }
    }

    pub(super) const fn one_of(self, numbers: &'static [u32], rule: &'static str) -> Self {
        let allowed = Allowed::OneOf(numbers);
        Self {
            allowed,
            rule,
            ..self
        }
    }

    /// `rule`: a sentence, with {} for the range.
    pub(super) const fn share(self, rule: &'static str) -> Self {
        let allowed = Allowed::Share;
        Self {
            allowed,
            rule,
            ..self
        }
    }

    /// `rule`: a sentence.
    pub(super) const fn finite(self, rule: &'static str) -> Self {
        Self { rule, ..self }
    }

    /// The help says what the default is.
    pub(super) const fn depends(self) -> Self {
        Self {
            depends: true,
            ..self
        }
    }

    pub(super) const fn sets(self, constant: &'static str) -> Self {
        Self {
            constant: Some(constant),
            ..self
        }
    }

    pub(super) const fn swept(
        self,
        flag: &'static str,
        value_name: &'static str,
        help: &'static str,
    ) -> Self {
        let sweep = SweepFlag {
            flag,
            value_name,
            help,
            default: None,
        };
        Self {
            sweep: Some(sweep),
            ..self
        }
    }

    /// With these values where the study's flag is not given.
    pub(super) const fn swept_over(self, default: &'static str) -> Self {
        let sweep = match self.sweep {
            Some(sweep) => Some(SweepFlag {
                default: Some(default),
                ..sweep
            }),
            None => None,
        };
        Self { sweep, ..self }
    }

    pub fn is_switch(&self) -> bool {
        self.value_name.is_none()
    }

    /// Whether a switch's flag switches its field off.
    fn negates(&self) -> bool {
        self.flag.starts_with("no-")
    }

    fn refuse<T>(&self, allowed: &str, value: impl Display) -> Result<T> {
        let rule = self.rule.replace("{}", allowed);
        Err(Error::Invalid(format!("{rule}, not {value}")))
    }
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

/// What a number stands for, or else which numbers stand for something.
pub(super) type Numbered<T> = std::result::Result<T, String>;

/// The type of a knob's field.
pub(super) trait Field: Sized {
    fn text(&self) -> String;
    fn parse(text: &str) -> Result<Self>;
    fn number(&self) -> u32;
    fn from_number(number: u32) -> Numbered<Self>;

    /// # Errors
    /// It is not allowed.
    fn check(&self, _row: &Row) -> Result<()> {
        Ok(())
    }

    /// Names and what they are, of a choice.
    fn choices() -> Vec<(String, &'static str)> {
        Vec::new()
    }
}

fn parsed<T: FromStr<Err: Display>>(text: &str) -> Result<T> {
    text.parse()
        .map_err(|error: T::Err| Error::Invalid(error.to_string()))
}

impl Field for u32 {
    fn text(&self) -> String {
        self.to_string()
    }

    fn parse(text: &str) -> Result<Self> {
        parsed(text)
    }

    fn number(&self) -> u32 {
        *self
    }

    fn from_number(number: u32) -> Numbered<Self> {
        Ok(number)
    }

    fn check(&self, row: &Row) -> Result<()> {
        match row.allowed {
            Allowed::Within(least, most) if !(least..=most).contains(self) => {
                row.refuse(&format!("{least} to {most}"), self)
            }
            Allowed::OneOf(numbers) if !numbers.contains(self) => {
                let numbers: Vec<String> = numbers.iter().map(u32::to_string).collect();
                row.refuse(&numbers.join(" or "), self)
            }
            _ => Ok(()),
        }
    }
}

impl Field for bool {
    fn text(&self) -> String {
        self.to_string()
    }

    fn parse(text: &str) -> Result<Self> {
        parsed(text)
    }

    fn number(&self) -> u32 {
        (*self).into()
    }

    fn from_number(number: u32) -> Numbered<Self> {
        let found = [false, true].get(number as usize);
        found.copied().ok_or_else(|| "0 or 1".into())
    }
}

/// What `local` stands for where a width and a height are asked for.
pub const LOCAL: (u32, u32) = (0, 0);

/// A width and a height, or `local`.
impl Field for (u32, u32) {
    fn text(&self) -> String {
        match *self {
            LOCAL => "local".into(),
            (width, height) => format!("{width}x{height}"),
        }
    }

    fn parse(text: &str) -> Result<Self> {
        if text == "local" {
            return Ok(LOCAL);
        }
        let sides = text.split_once(['x', 'X', '×']);
        let sides =
            sides.and_then(|(width, height)| Some((width.parse().ok()?, height.parse().ok()?)));
        sides.filter(|&sides| sides != LOCAL).ok_or_else(|| {
            Error::Invalid("a packet is local, or written 4x4, each side from 1 to 8 pixels".into())
        })
    }

    /// Width below, height above.
    fn number(&self) -> u32 {
        self.0 | self.1 << 16
    }

    fn from_number(number: u32) -> Numbered<Self> {
        Ok((number & 0xffff, number >> 16))
    }

    fn check(&self, row: &Row) -> Result<()> {
        match row.allowed {
            Allowed::Within(least, most)
                if *self != LOCAL
                    && ![self.0, self.1]
                        .iter()
                        .all(|side| (least..=most).contains(side)) =>
            {
                row.refuse(&format!("{least}x{least} to {most}x{most}"), self.text())
            }
            _ => Ok(()),
        }
    }
}

/// A finite number from 0, or a share.
impl Field for f32 {
    fn text(&self) -> String {
        self.to_string()
    }

    fn parse(text: &str) -> Result<Self> {
        // Adding 0 takes the sign from −0.
        parsed(text).map(|value: f32| value + 0.0)
    }

    fn number(&self) -> u32 {
        self.to_bits()
    }

    fn from_number(number: u32) -> Numbered<Self> {
        Ok(f32::from_bits(number))
    }

    fn check(&self, row: &Row) -> Result<()> {
        let (most, allowed) = match row.allowed {
            Allowed::Share => (1.0, "0 to 1"),
            _ => (f32::MAX, ""),
        };
        match (0.0..=most).contains(self) {
            true => Ok(()),
            false => row.refuse(allowed, self),
        }
    }
}

/// A number, or none, which is 0 where a number must stand for it.
impl Field for Option<u32> {
    fn text(&self) -> String {
        self.map_or_else(|| NONE.to_owned(), |value| value.to_string())
    }

    fn parse(text: &str) -> Result<Self> {
        match text {
            NONE => Ok(None),
            number => parsed(number).map(Some),
        }
    }

    fn number(&self) -> u32 {
        self.unwrap_or(0)
    }

    fn from_number(number: u32) -> Numbered<Self> {
        Ok((number != 0).then_some(number))
    }

    fn check(&self, row: &Row) -> Result<()> {
        self.map_or(Ok(()), |value| value.check(row))
    }
}

/// How a number that is not there is written.
const NONE: &str = "none";

/// A finite number from 0, or what is usual.
impl Field for Option<f32> {
    fn text(&self) -> String {
        self.map(|value| value.to_string()).unwrap_or_default()
    }

    fn parse(text: &str) -> Result<Self> {
        // Adding 0 takes the sign from −0.
        parsed(text).map(|value: f32| Some(value + 0.0))
    }

    fn number(&self) -> u32 {
        self.unwrap_or(-1.0).to_bits()
    }

    fn from_number(number: u32) -> Numbered<Self> {
        let value = f32::from_bits(number);
        Ok((value != -1.0).then_some(value))
    }

    fn check(&self, row: &Row) -> Result<()> {
        match self {
            Some(value) if !(value.is_finite() && *value >= 0.0) => row.refuse("", value),
            _ => Ok(()),
        }
    }
}

impl<T: Choice> Field for T {
    fn text(&self) -> String {
        self.to_string()
    }

    fn parse(text: &str) -> Result<Self> {
        parsed(text)
    }

    fn number(&self) -> u32 {
        let place = T::ALL.iter().position(|known| known == self);
        place.unwrap_or_default() as u32
    }

    fn from_number(number: u32) -> Numbered<Self> {
        let found = T::ALL.get(number as usize);
        found
            .copied()
            .ok_or_else(|| format!("0 to {}", T::ALL.len().saturating_sub(1)))
    }

    fn choices() -> Vec<(String, &'static str)> {
        let choice = |value: &T| (value.to_string(), value.summary());
        T::ALL.iter().map(choice).collect()
    }
}
