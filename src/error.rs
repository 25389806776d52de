//! The one error type of the crate.

use std::path::PathBuf;

/// Everything that can go wrong, as one sentence that says what to do about it.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A file could not be read or written.
    #[error("{}: {source}", path.display())]
    Io {
        path: PathBuf,
        source: std::io::Error,
    },
    /// A file was read but its contents are not what they should be.
    #[error("{}: {message}", path.display())]
    Parse { path: PathBuf, message: String },
    /// A setting, a light, a camera or a size that cannot be rendered.
    #[error("{0}")]
    Invalid(String),
    /// The device lacks something that this work needs.
    #[error("{0}")]
    Unsupported(String),
    /// A Vulkan call failed; `call` names the call and the object.
    #[error("{call} failed: {result}")]
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
