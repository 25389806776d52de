//! The one error type of the crate.

use std::path::PathBuf;

/// Everything that can go wrong, as one sentence that says what to do about it.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A file could not be read or written.
    #[error("{}: {source}", shortened(path.display()))]
    Io {
        path: PathBuf,
        source: std::io::Error,
    },
    /// A file was read but its contents are not what they should be.
    #[error("{}: {}", shortened(path.display()), shortened(message))]
    Parse { path: PathBuf, message: String },
    /// A setting, a light, a camera or a size that cannot be rendered.
    #[error("{0}")]
    Invalid(String),
    /// The device lacks something that this work needs.
    #[error("{0}")]
    Unsupported(String),
    /// A Vulkan call failed; `call` names the call and the object.
    #[error("{call} failed: {result}{}", advice(*result))]
    Vulkan {
        call: String,
        result: ash::vk::Result,
    },
    /// The allocator failed for the named resource.
    #[error("no device memory for {resource}: {message}")]
    Memory { resource: String, message: String },
    /// Ctrl-C, or a caller's wish.
    #[error("interrupted")]
    Interrupted,
    /// The validation layer reported warnings or errors.
    #[error("the validation layer reported {} message(s), the first: {}", .0.len(), .0[0])]
    Validation(Vec<String>),
}

/// What to do about a failed call, where that is known.
fn advice(result: ash::vk::Result) -> &'static str {
    match result {
        ash::vk::Result::ERROR_OUT_OF_DEVICE_MEMORY | ash::vk::Result::ERROR_OUT_OF_HOST_MEMORY => {
            "; choose a smaller --map or --size, or close other programs"
        }
        ash::vk::Result::ERROR_DEVICE_LOST => {
            "; the device is lost: its driver gave up, or it was reset; open it again, and if that repeats, update \
             the driver"
        }
        _ => "",
    }
}

/// [character] More of a message or a path is left out from its middle: they quote files, which may hold anything.
const LONGEST: usize = 400;

fn shortened(text: impl ToString) -> String {
    let text = text.to_string();
    let place = |index| text.char_indices().nth(index).map(|(at, _)| at);
    let count = text.chars().count();
    match (place(LONGEST / 2), place(count.saturating_sub(LONGEST / 2))) {
        (Some(head), Some(tail)) if count > LONGEST => {
            format!("{} … {}", &text[..head], &text[tail..])
        }
        _ => text,
    }
}

pub type Result<T, E = Error> = std::result::Result<T, E>;

impl Error {
    /// Whether the device can do nothing further.
    pub fn is_device_lost(&self) -> bool {
        let lost = ash::vk::Result::ERROR_DEVICE_LOST;
        matches!(self, Self::Vulkan { result, .. } if *result == lost)
    }

    pub fn io(path: impl Into<PathBuf>, source: std::io::Error) -> Self {
        Self::Io {
            path: path.into(),
            source,
        }
    }

    pub fn parse(path: impl Into<PathBuf>, message: impl Into<String>) -> Self {
        Self::Parse {
            path: path.into(),
            message: message.into(),
        }
    }
}
