//! The names by which settings are chosen on the command line and in tables.

use std::fmt;
use std::str::FromStr;

use super::{Leaf, Mapping, Occluders, Pattern, Technique};
use crate::Error;

/// Gives an enum `ALL`, `Display` and `FromStr` by one table of names.
macro_rules! named {
    ($kind:ident, $what:literal, $($variant:ident = $name:literal),+) => {
        impl $kind {
            pub const ALL: &[Self] = &[$(Self::$variant),+];

            /// The kebab-case name.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $name),+
                }
            }
        }

        impl fmt::Display for $kind {
            fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.pad(self.name())
            }
        }

        impl FromStr for $kind {
            type Err = Error;

            fn from_str(name: &str) -> Result<Self, Error> {
                match name {
                    $($name => Ok(Self::$variant),)+
                    _ => Err(Error::Invalid(format!(
                        "there is no {} {name:?}; choose one of {}",
                        $what,
                        [$($name),+].join(", "),
                    ))),
                }
            }
        }
    };
}

named!(
    Leaf,
    "leaf mode",
    Reprocess = "reprocess",
    PerPixel = "per-pixel"
);
named!(Mapping, "mapping", Serial = "serial", Lanes = "lanes");
named!(
    Technique,
    "technique",
    PacketContour = "packet-contour",
    PixelContour = "pixel-contour",
    Micropatch = "micropatch",
    MicropatchHierarchical = "micropatch-hierarchical",
    Bitmask = "bitmask",
    DepthPeeling = "depth-peeling",
    Pcss = "pcss",
    Hard = "hard",
    ReferenceMaps = "reference-maps"
);
named!(
    Pattern,
    "sample pattern",
    Regular = "regular",
    Jittered = "jittered"
);
named!(
    Occluders,
    "kind of occluder",
    Micropatches = "micropatches",
    Contours = "contours"
);
