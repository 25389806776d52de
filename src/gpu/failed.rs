//! Failed calls.

use ash::vk;

use crate::error::Error;

/// Names a failed call.
pub(super) fn failed(call: &str) -> impl FnOnce(vk::Result) -> Error + '_ {
    move |result| Error::Vulkan {
        call: call.to_owned(),
        result,
    }
}
