//! A call: its context, what it does, and the sentence of its error.

use std::cell::RefCell;
use std::ffi::c_char;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;

use super::call_result::{CallResult, Fault, quietly};
use super::context::{CONTEXTS, Context, Held};
use super::handles::Registry;
use super::types::*;

thread_local! {
    static LAST_ERROR: RefCell<LastError> = const { RefCell::new(LastError { text: String::new(), homeless: false }) };
}

/// Of the last call of a thread that failed.
struct LastError {
    text: String,
    /// It named no living object, so that no context has heard of it.
    homeless: bool,
}

/// Which context a call belongs to, as soon as it is known.
#[derive(Default)]
pub struct Scope {
    context: Option<Arc<Context>>,
}

impl Scope {
    /// Errors of this call belong to `context`. Errors: its device was lost, which nothing mends.
    pub fn enter(&mut self, context: &Arc<Context>) -> CallResult {
        self.context = Some(context.clone());
        match context.is_lost() {
            true => Err(Fault::new(
                HS_DEVICE_LOST,
                "the device was lost; destroy the context and create another",
            )),
            false => Ok(()),
        }
    }
}

/// Runs an export's body: no panic leaves it, and the sentence of its error is kept.
pub fn call(body: impl FnOnce(&mut Scope) -> CallResult) -> hs_result {
    let mut scope = Scope::default();
    let ended = catch_unwind(AssertUnwindSafe(|| body(&mut scope)));
    let fault = match ended {
        Ok(Ok(())) => return HS_OK,
        Ok(Err(fault)) => fault,
        Err(_) => Fault::new(
            HS_INTERNAL,
            "an error in the library; please report what was called",
        ),
    };
    // Dropping the context's last reference may run code that panics, as any other.
    let _ = catch_unwind(AssertUnwindSafe(|| {
        let context = scope.context.take();
        LAST_ERROR.with_borrow_mut(|last| {
            last.text.clone_from(&fault.text);
            last.homeless = context.is_none();
        });
        if let Some(context) = context {
            context.remember(&fault);
        }
    }));
    fault.code
}

/// Copies the sentence that belongs to the last call that failed: on `context`, or, where that is NULL, on this
/// thread. A call with a handle that is not alive belongs to no context; its sentence is told for any, on its thread, until
/// another call fails there.
///
/// `text` receives at most `capacity` bytes of UTF-8 with a NUL at the end; it may be NULL when `capacity` is 0.
/// Returns the number of bytes that the whole sentence takes with its NUL; 1 when there is none, 0 when `context`
/// is not a context. Any thread may call it at any time.
///
/// # Safety
/// `text` points to `capacity` writable bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hs_last_error(
    context: *const hs_context,
    text: *mut c_char,
    capacity: u64,
) -> u64 {
    let mut length = 0;
    quietly(|| {
        let (of_thread, homeless) =
            LAST_ERROR.with_borrow(|last| (last.text.clone(), last.homeless));
        let sentence = match CONTEXTS.get(context) {
            Some(_) if homeless => Some(of_thread),
            Some(found) => Some(found.sentence()),
            None => context.is_null().then_some(of_thread),
        };
        if let Some(sentence) = sentence {
            length = sentence.len() as u64 + 1;
            if !text.is_null() && capacity > 0 {
                let room = usize::try_from(capacity).unwrap_or(usize::MAX);
                let count = sentence.len().min(room - 1);
                // SAFETY: the caller promises `capacity` bytes, of which at most `count` + 1 are written.
                unsafe {
                    std::ptr::copy_nonoverlapping(sentence.as_ptr(), text.cast::<u8>(), count);
                    *text.add(count) = 0;
                }
            }
        }
    });
    length
}

impl<H, T> Registry<H, Held<T>> {
    /// An object whose context the call then belongs to.
    pub fn enter(&self, scope: &mut Scope, handle: *const H) -> CallResult<Arc<Held<T>>> {
        let held = self.find(handle)?;
        scope.enter(&held.context)?;
        Ok(held)
    }
}

impl Registry<hs_context, Context> {
    pub fn enter(&self, scope: &mut Scope, handle: *const hs_context) -> CallResult<Arc<Context>> {
        let context = self.find(handle)?;
        scope.enter(&context)?;
        Ok(context)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_becomes_a_code() {
        assert_eq!(call(|_| panic!("on purpose")), HS_INTERNAL);
    }

    #[test]
    fn a_lost_device_stays_lost() {
        let context = Context::without_device();
        let lost = || Fault::new(HS_DEVICE_LOST, "vkQueueSubmit2 failed");
        let first = call(|scope| {
            scope.enter(&context)?;
            Err(lost())
        });
        assert_eq!(first, HS_DEVICE_LOST);
        for _ in 0..2 {
            assert_eq!(call(|scope| scope.enter(&context)), HS_DEVICE_LOST);
        }
    }
}
