//! A row of the table of knobs: what it says about a knob beside the type and the default.

use std::fmt::Display;

use crate::{Error, Result};

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
    pub(super) allowed: Allowed,
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
pub(super) enum Allowed {
    Any,
    Within(u32, u32),
    OneOf(&'static [u32]),
    Share,
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
    pub(super) fn negates(&self) -> bool {
        self.flag.starts_with("no-")
    }

    pub(super) fn refuse<T>(&self, allowed: &str, value: impl Display) -> Result<T> {
        let rule = self.rule.replace("{}", allowed);
        Err(Error::Invalid(format!("{rule}, not {value}")))
    }
}
