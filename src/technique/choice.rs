//! What is chosen by name: techniques, and knobs with few values.

use std::fmt::Display;
use std::str::FromStr;

use crate::Error;

/// A choice between names.
pub trait Choice: Copy + PartialEq + Display + FromStr<Err = Error> + 'static {
    /// In the order of their numbers in the C library.
    const ALL: &'static [Self];

    /// What it is, in a sentence.
    fn summary(self) -> &'static str;
}

/// Declares an enum whose values have names, on the command line, in tables, in files and in the C library.
macro_rules! choice {
    ($(#[$doc:meta])* enum $kind:ident, $what:literal {
        $($(#[doc = $summary:literal])+ $variant:ident = $name:literal,)+
    }) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
        pub enum $kind {
            $($(#[doc = $summary])+ #[serde(rename = $name)] $variant,)+
        }

        impl $kind {
            /// In the order of their numbers in the C library.
            pub const ALL: &'static [Self] = &[$(Self::$variant),+];

            /// The kebab-case name.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $name),+
                }
            }
        }

        impl $crate::technique::Choice for $kind {
            const ALL: &'static [Self] = Self::ALL;

            fn summary(self) -> &'static str {
                match self {
                    $(Self::$variant => concat!($($summary),+),)+
                }
            }
        }

        impl std::fmt::Display for $kind {
            fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.pad(self.name())
            }
        }

        impl std::str::FromStr for $kind {
            type Err = $crate::Error;

            fn from_str(name: &str) -> Result<Self, $crate::Error> {
                let found = Self::ALL.iter().find(|known| known.name() == name);
                found.copied().ok_or_else(|| $crate::Error::Invalid(format!(
                    "there is no {} {name:?}; choose one of {}",
                    $what,
                    [$($name),+].join(", "),
                )))
            }
        }
    };
}

pub(crate) use choice;
