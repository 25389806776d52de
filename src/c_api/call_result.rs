//! How a call ends: a code, and a sentence for people.

use std::panic::{AssertUnwindSafe, catch_unwind};

use ash::vk;

use super::types_context::*;
use crate::Error;

/// Why a call failed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fault {
    pub code: hs_result,
    pub text: String,
}

pub type CallResult<T = ()> = Result<T, Fault>;

impl Fault {
    pub fn new(code: hs_result, text: impl Into<String>) -> Self {
        Self {
            code,
            text: text.into(),
        }
    }

    pub fn invalid(text: impl Into<String>) -> Self {
        Self::new(HS_INVALID_ARGUMENT, text)
    }
}

impl From<Error> for Fault {
    fn from(error: Error) -> Self {
        let code = match &error {
            Error::Io { .. } => HS_IO,
            Error::Parse { .. } => HS_PARSE,
            Error::Invalid(_) => HS_INVALID_ARGUMENT,
            Error::Unsupported(_) => HS_UNSUPPORTED,
            Error::Memory { .. } => HS_OUT_OF_DEVICE_MEMORY,
            Error::Vulkan { result, .. } => match *result {
                vk::Result::ERROR_OUT_OF_HOST_MEMORY => HS_OUT_OF_HOST_MEMORY,
                vk::Result::ERROR_OUT_OF_DEVICE_MEMORY => HS_OUT_OF_DEVICE_MEMORY,
                vk::Result::ERROR_DEVICE_LOST => HS_DEVICE_LOST,
                _ => HS_INTERNAL,
            },
            Error::Interrupted | Error::Validation(_) => HS_INTERNAL,
        };
        Self::new(code, error.to_string())
    }
}

/// Runs a body that cannot fail but might panic.
pub fn quietly(body: impl FnOnce()) {
    let _ = catch_unwind(AssertUnwindSafe(body));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_error_has_its_code() {
        let vulkan = |result| Error::Vulkan {
            call: "vkQueueSubmit2".into(),
            result,
        };
        let io = std::io::Error::from(std::io::ErrorKind::NotFound);
        let cases = [
            (Error::io("a", io), HS_IO),
            (Error::parse("a", "b"), HS_PARSE),
            (Error::Invalid("a".into()), HS_INVALID_ARGUMENT),
            (Error::Unsupported("a".into()), HS_UNSUPPORTED),
            (
                vulkan(vk::Result::ERROR_OUT_OF_HOST_MEMORY),
                HS_OUT_OF_HOST_MEMORY,
            ),
            (
                vulkan(vk::Result::ERROR_OUT_OF_DEVICE_MEMORY),
                HS_OUT_OF_DEVICE_MEMORY,
            ),
            (vulkan(vk::Result::ERROR_DEVICE_LOST), HS_DEVICE_LOST),
            (vulkan(vk::Result::ERROR_UNKNOWN), HS_INTERNAL),
            (Error::Validation(vec!["a".into()]), HS_INTERNAL),
        ];
        for (error, code) in cases {
            assert_eq!(Fault::from(error).code, code);
        }
    }
}
