//! The types that knobs have: how their values are written, numbered in the C library, and checked.

use std::fmt::Display;
use std::str::FromStr;

use super::choice::Choice;
use super::row::{Allowed, Row};
use crate::{Error, Result};

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
