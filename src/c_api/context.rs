//! Contexts: a device, and where messages go.

use std::ffi::{CString, c_void};
use std::mem::ManuallyDrop;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};

use super::check::{optional, place, text};
use super::handles::CONTEXTS;
use super::outcome::{Fault, Outcome, call};
use super::types::*;
use crate::gpu::{Gpu, Options};

/// What everything that a caller creates lives in.
pub struct Context {
    gpu: ManuallyDrop<Option<Arc<Gpu>>>,
    /// What the validation layer says.
    messages: Arc<Mutex<Vec<String>>>,
    log: Log,
    sentence: Mutex<String>,
    lost: AtomicBool,
}

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

    pub fn gpu(&self) -> Outcome<&Arc<Gpu>> {
        self.gpu.as_ref().ok_or_else(|| {
            Fault::new(
                HS_UNSUPPORTED,
                "the context was created without a device; leave HS_CONTEXT_WITHOUT_DEVICE out",
            )
        })
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

/// Creates a context with a device of its own. `info` may be NULL: the best device, no log. On failure `*context`
/// is NULL and the sentence is this thread's: hs_last_error(NULL, ...).
///
/// Any thread; contexts know nothing of each other.
///
/// # Safety
/// `info` is NULL or points to a structure whose texts end with a NUL, `context` to a pointer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hs_context_create(
    info: *const hs_context_info,
    context: *mut *mut hs_context,
) -> hs_result {
    call(|_| {
        // SAFETY: the caller's promise, here and below.
        let target = unsafe { place(context, "the pointer to the context") }?;
        *target = std::ptr::null_mut();
        let created = match unsafe { optional(info) }? {
            None => Context::new(Some(Gpu::open(&Options::default())?), Log::NONE),
            Some(info) => unsafe { create(&info) }?,
        };
        *target = CONTEXTS.add(created)?;
        Ok(())
    })
}

/// # Safety
/// The texts end with a NUL.
unsafe fn create(info: &hs_context_info) -> Outcome<Context> {
    let known = HS_CONTEXT_VALIDATE | HS_CONTEXT_WITHOUT_DEVICE;
    if info.flags & !known != 0 || info.reserved != 0 {
        return Err(Fault::invalid(
            "hs_context_info: flags has unknown bits, or reserved is not 0",
        ));
    }
    // SAFETY: the caller's promise.
    let (device, cache_folder) = unsafe {
        (
            text(info.device, "device")?,
            text(info.cache_folder, "cache_folder")?,
        )
    };
    let log = Log {
        callback: info.log,
        user: info.log_user,
    };
    let options = Options {
        device,
        validate: info.flags & HS_CONTEXT_VALIDATE != 0,
        cache_folder: cache_folder.map(Into::into),
        max_memory: (info.max_memory > 0).then_some(info.max_memory),
        ..Options::default()
    };
    let gpu = match info.flags & HS_CONTEXT_WITHOUT_DEVICE {
        0 => Some(Gpu::open(&options)?),
        _ => None,
    };
    Ok(Context::new(gpu, log))
}

/// Lets go of a context; NULL is fine. What was created in it keeps it until it is destroyed itself, so any order
/// of destruction is right. A handle that was destroyed before is ignored.
///
/// Any thread. Other threads' calls on the context finish.
#[unsafe(no_mangle)]
pub extern "C" fn hs_context_destroy(context: *mut hs_context) {
    CONTEXTS.remove(context);
}

/// How many warnings and errors the validation layer has given so far; 0 without HS_CONTEXT_VALIDATE. Their texts
/// go to the log when the context ends.
///
/// Any thread.
///
/// # Safety
/// `count` points to a number.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hs_context_validation_messages(
    context: *const hs_context,
    count: *mut u64,
) -> hs_result {
    call(|scope| {
        // SAFETY: the caller's promise.
        let target = unsafe { place(count, "count") }?;
        let context = CONTEXTS.enter(scope, context)?;
        *target = match context.messages.lock() {
            Ok(said) => said.len() as u64,
            Err(_) => 0,
        };
        Ok(())
    })
}
