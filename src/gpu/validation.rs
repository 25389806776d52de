//! Messages of the validation layer, collected so that any of them fails the run.

use std::ffi::{CStr, c_void};
use std::sync::{Arc, Mutex};

use ash::vk;

/// Warnings and errors so far; shared with the callback.
pub type Messages = Arc<Mutex<Vec<String>>>;

/// What to hear about. `messages` must outlive the messenger.
pub fn messenger_info(messages: &Messages) -> vk::DebugUtilsMessengerCreateInfoEXT<'static> {
    vk::DebugUtilsMessengerCreateInfoEXT::default()
        .message_severity(
            vk::DebugUtilsMessageSeverityFlagsEXT::WARNING
                | vk::DebugUtilsMessageSeverityFlagsEXT::ERROR,
        )
        .message_type(
            vk::DebugUtilsMessageTypeFlagsEXT::GENERAL
                | vk::DebugUtilsMessageTypeFlagsEXT::VALIDATION
                | vk::DebugUtilsMessageTypeFlagsEXT::PERFORMANCE,
        )
        .pfn_user_callback(Some(collect))
        .user_data(Arc::as_ptr(messages) as *mut c_void)
}

unsafe extern "system" fn collect(
    _severity: vk::DebugUtilsMessageSeverityFlagsEXT,
    _kind: vk::DebugUtilsMessageTypeFlagsEXT,
    data: *const vk::DebugUtilsMessengerCallbackDataEXT<'_>,
    user: *mut c_void,
) -> vk::Bool32 {
    // SAFETY: `user` is the mutex behind the `Messages` that the instance keeps until after its
    // destruction; `data` and its text are valid during the call.
    unsafe {
        let messages = &*(user as *const Mutex<Vec<String>>);
        let text = match data.as_ref() {
            Some(data) if !data.p_message.is_null() => CStr::from_ptr(data.p_message)
                .to_string_lossy()
                .into_owned(),
            _ => "a message without text".to_owned(),
        };
        if let Ok(mut messages) = messages.lock() {
            messages.push(text);
        }
    }
    vk::FALSE
}
