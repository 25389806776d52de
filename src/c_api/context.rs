//! Contexts: a device, and where messages go.

use std::ffi::{CString, c_void};
use std::mem::ManuallyDrop;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};

use super::call_result::{CallResult, Fault};
use super::handles::Registry;
use super::types::*;
use crate::gpu::Gpu;

/// What everything that a caller creates lives in.
pub struct Context {
    gpu: ManuallyDrop<Option<Arc<Gpu>>>,
    /// What the validation layer says.
    messages: Arc<Mutex<Vec<String>>>,
    log: Log,
    sentence: Mutex<String>,
    lost: AtomicBool,
}

/// All living contexts.
pub static CONTEXTS: Registry<hs_context, Context> = Registry::new("context");

/// Where messages go.
#[derive(Clone, Copy)]
pub struct Log {
    pub callback: hs_log_callback,
    pub user: *mut c_void,
}

// SAFETY: the pointer is the caller's and only ever handed back to its callback, on the thread of a call.
unsafe impl Send for Log {}
// SAFETY: as above.
unsafe impl Sync for Log {}

impl Log {
    pub const NONE: Self = Self {
        callback: None,
        user: std::ptr::null_mut(),
    };

    pub fn say(&self, severity: u32, message: &str) {
        let (Some(callback), Ok(message)) = (self.callback, CString::new(message)) else {
            return;
        };
        // SAFETY: the caller's function with the caller's pointer.
        unsafe { callback(severity, message.as_ptr(), self.user) };
    }
}

impl Context {
    pub fn new(gpu: Option<Arc<Gpu>>, log: Log) -> Self {
        let messages = gpu.as_ref().map(|gpu| gpu.validation_messages());
        Self {
            gpu: ManuallyDrop::new(gpu),
            messages: messages.unwrap_or_default(),
            log,
            sentence: Mutex::default(),
            lost: AtomicBool::new(false),
        }
    }

    #[cfg(test)]
    pub fn without_device() -> Arc<Self> {
        Arc::new(Self::new(None, Log::NONE))
    }

    pub fn gpu(&self) -> CallResult<&Arc<Gpu>> {
        self.gpu.as_ref().ok_or_else(|| {
            Fault::new(
                HS_UNSUPPORTED,
                "the context was created without a device; leave HS_CONTEXT_WITHOUT_DEVICE out",
            )
        })
    }

    /// How many warnings and errors the validation layer has given.
    pub fn message_count(&self) -> u64 {
        match self.messages.lock() {
            Ok(said) => said.len() as u64,
            Err(_) => 0,
        }
    }

    pub fn is_lost(&self) -> bool {
        self.lost.load(Ordering::Relaxed)
    }

    /// The sentence of the last call that failed.
    pub fn sentence(&self) -> String {
        match self.sentence.lock() {
            Ok(sentence) => sentence.clone(),
            Err(_) => String::new(),
        }
    }

    pub fn remember(&self, fault: &Fault) {
        if fault.code == HS_DEVICE_LOST {
            self.lost.store(true, Ordering::Relaxed);
        }
        if let Ok(mut sentence) = self.sentence.lock() {
            sentence.clone_from(&fault.text);
        }
        self.log.say(HS_LOG_ERROR, &fault.text);
    }

    /// Passes on what was noted about a file.
    pub fn note<'a>(&self, notes: impl IntoIterator<Item = &'a String>) {
        for note in notes {
            self.log.say(HS_LOG_NOTE, note);
        }
    }
}

impl Drop for Context {
    fn drop(&mut self) {
        // SAFETY: dropped once, and not used any more. What lives on the device keeps the context, so the device
        // ends here and the validation layer has its last word.
        unsafe { ManuallyDrop::drop(&mut self.gpu) };
        for message in self.messages.lock().iter().flat_map(|said| said.iter()) {
            self.log.say(HS_LOG_WARNING, message);
        }
    }
}

/// An object that lives in a context.
pub struct Held<T> {
    // Before the context, which it needs while it goes.
    value: Mutex<T>,
    pub context: Arc<Context>,
}

impl<T> Held<T> {
    pub fn new(context: &Arc<Context>, value: T) -> Self {
        Self {
            value: Mutex::new(value),
            context: context.clone(),
        }
    }

    /// Runs `work` on the object, one call at a time.
    pub fn with<R>(&self, work: impl FnOnce(&mut T) -> CallResult<R>) -> CallResult<R> {
        let mut value = self.value.lock().map_err(|_| {
            Fault::new(
                HS_INTERNAL,
                "an earlier call on this object ended in an error of the library; destroy it",
            )
        })?;
        work(&mut value)
    }
}
