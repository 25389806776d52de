//! Claims held against numbers.

use std::fmt;

use serde::Serialize;

use crate::number::decimals;

/// |τ| from which on a curve counts as rising or falling, see `Curve::trend`.
pub(super) const CLEAR: f64 = 0.6;

/// One thing that a publication says, and whether it was found here.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Check {
    /// The claim, and when it counts as found.
    pub claim: String,
    /// What was measured.
    pub found: String,
    pub holds: bool,
}

impl Check {
    pub(super) fn new(claim: impl Into<String>, found: impl Into<String>, holds: bool) -> Self {
        Self {
            claim: claim.into(),
            found: found.into(),
            holds,
        }
    }
}

/// What the checks of an experiment say together.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// All of the claims were found.
    SameTrend,
    /// Some were.
    SameTrendInPart,
    /// None was.
    Differs,
}

impl Verdict {
    pub fn of(checks: &[Check]) -> Self {
        match checks.iter().filter(|check| check.holds).count() {
            0 => Self::Differs,
            held if held == checks.len() => Self::SameTrend,
            _ => Self::SameTrendInPart,
        }
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(match self {
            Self::SameTrend => "the same trend",
            Self::SameTrendInPart => "the same trend in part",
            Self::Differs => "it differs",
        })
    }
}

/// Whether there are values, and all of them are so.
pub(super) fn all(values: &[f64], are: impl Fn(f64) -> bool) -> bool {
    !values.is_empty() && values.iter().all(|&value| are(value))
}

/// A number in four digits; "—" is none.
pub(super) fn number(value: f64) -> String {
    let magnitude = value.abs();
    if !value.is_finite() {
        return "—".into();
    }
    if magnitude != 0.0 && magnitude < 1e-5 {
        return format!("{value:.2e}");
    }
    let digits = if magnitude > 0.0 {
        3 - magnitude.log10().floor() as i32
    } else {
        0
    };
    let text = decimals(value, digits.clamp(0, 8) as usize);
    match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    }
}

/// Numbers in a row.
pub(super) fn numbers(values: impl IntoIterator<Item = f64>) -> String {
    let values: Vec<String> = values.into_iter().map(number).collect();
    values.join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verdicts() {
        let check = |holds| Check::new("", "", holds);
        assert_eq!(Verdict::of(&[check(true), check(true)]), Verdict::SameTrend);
        let part = Verdict::of(&[check(true), check(false)]);
        assert_eq!(part, Verdict::SameTrendInPart);
        assert_eq!(Verdict::of(&[check(false)]), Verdict::Differs);
    }

    #[test]
    fn numbers_have_four_digits() {
        let all = numbers([
            0.0123456,
            12.3,
            1234567.0,
            0.0,
            1.0,
            f64::NAN,
            0.000001234,
            -0.0,
        ]);
        assert_eq!(all, "0.01235, 12.3, 1234567, 0, 1, —, 1.23e-6, 0");
    }
}
