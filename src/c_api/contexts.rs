//! Creating contexts and letting go of them.

use super::call::call;
use super::call_result::{CallResult, Fault};
use super::check::{optional, place, text};
use super::context::{CONTEXTS, Context, Log};
use super::types::*;
use crate::gpu::{Gpu, Options};

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
unsafe fn create(info: &hs_context_info) -> CallResult<Context> {
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
        *target = context.message_count();
        Ok(())
    })
}
