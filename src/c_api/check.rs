//! Checks of what callers pass, before any of it is used.

use std::ffi::{CStr, c_char, c_void};
use std::path::PathBuf;

use super::call_result::{CallResult, Fault};
use super::structure::Structure;
use super::types::HS_OUT_OF_HOST_MEMORY;

/// What every structure begins with.
#[repr(C)]
#[derive(Clone, Copy)]
struct Head {
    kind: u32,
    size: u32,
    next: *const c_void,
}

/// Checks all but what extends the structure, which is returned.
fn check_head<T: Structure>(pointer: *const T) -> CallResult<*const c_void> {
    let name = T::NAME;
    let invalid = |text: String| Err(Fault::invalid(text));
    if pointer.is_null() {
        return invalid(format!("the pointer to {name} is NULL"));
    }
    if !pointer.is_aligned() {
        return invalid(format!("the pointer to {name} is not aligned"));
    }
    // The type and size alone: a structure that is too short may end behind them.
    // SAFETY: not NULL, aligned, and the caller promises a structure, which begins with these two.
    let (kind, size) = unsafe {
        let words = pointer.cast::<u32>();
        (*words, *words.add(1))
    };
    if kind != T::TYPE {
        return invalid(format!("{name}: type is {kind} and must be {}", T::TYPE));
    }
    if size as usize != size_of::<T>() {
        return invalid(format!(
            "{name}: size is {size} and this library's is {}; use the header that belongs to it",
            size_of::<T>()
        ));
    }
    // SAFETY: the structure is as large as the library's own.
    Ok(unsafe { (*pointer.cast::<Head>()).next })
}

fn check<T: Structure>(pointer: *const T) -> CallResult {
    match check_head(pointer)?.is_null() {
        true => Ok(()),
        false => Err(Fault::invalid(format!(
            "{}: next must be NULL, for nothing extends it",
            T::NAME
        ))),
    }
}

/// Most structures that extend another; a chain that is longer may have no end.
const CHAINED_MAX: usize = 64;

/// A structure that the caller has filled, and those that extend it, in their order.
///
/// # Safety
/// As for [`input`], for each of them.
pub unsafe fn extended<T: Structure, N: Structure>(pointer: *const T) -> CallResult<(T, Vec<N>)> {
    let mut next = check_head(pointer)?.cast::<N>();
    // SAFETY: checked, and the caller's promise; so too below.
    let structure = unsafe { *pointer };
    let mut chained = Vec::new();
    while !next.is_null() {
        if chained.len() == CHAINED_MAX {
            return Err(Fault::invalid(format!(
                "{}: more than {CHAINED_MAX} structures extend it",
                T::NAME
            )));
        }
        let after = check_head(next)?;
        chained.push(unsafe { *next });
        next = after.cast();
    }
    Ok((structure, chained))
}

/// A structure that the caller has filled, and the one that extends it, if one does. Takes no memory.
///
/// # Safety
/// As for [`input`], for both.
pub unsafe fn extended_once<T: Structure, N: Structure>(
    pointer: *const T,
) -> CallResult<(T, Option<N>)> {
    let next = check_head(pointer)?.cast::<N>();
    // SAFETY: checked, and the caller's promise.
    Ok((unsafe { *pointer }, unsafe { optional(next) }?))
}

/// A structure that the caller has filled.
///
/// # Safety
/// `pointer` is NULL or points to a structure of at least the `size` that it states.
pub unsafe fn input<T: Structure>(pointer: *const T) -> CallResult<T> {
    check(pointer)?;
    // SAFETY: checked, and the caller's promise.
    Ok(unsafe { *pointer })
}

/// As [`input`]; NULL stands for the defaults.
///
/// # Safety
/// As for [`input`].
pub unsafe fn optional<T: Structure>(pointer: *const T) -> CallResult<Option<T>> {
    match pointer.is_null() {
        true => Ok(None),
        // SAFETY: the caller's promise.
        false => unsafe { input(pointer) }.map(Some),
    }
}

/// A structure that is to be filled.
///
/// # Safety
/// As for [`input`], and nothing else uses it during the call.
pub unsafe fn output<'a, T: Structure>(pointer: *mut T) -> CallResult<&'a mut T> {
    check(pointer)?;
    // SAFETY: checked, and the caller's promise.
    Ok(unsafe { &mut *pointer })
}

/// Where a single value is to be written.
///
/// # Safety
/// `pointer` is NULL or points to a value that nothing else uses during the call.
pub unsafe fn place<'a, T>(pointer: *mut T, name: &str) -> CallResult<&'a mut T> {
    check_pointer(pointer, 1, name)?;
    // SAFETY: checked, and the caller's promise.
    Ok(unsafe { &mut *pointer })
}

fn check_pointer<T>(pointer: *const T, count: u64, name: &str) -> CallResult<usize> {
    if count > 0 && pointer.is_null() {
        return Err(Fault::invalid(format!("{name} is NULL")));
    }
    if !pointer.is_aligned() {
        return Err(Fault::invalid(format!("{name} is not aligned")));
    }
    let bytes = count.checked_mul(size_of::<T>() as u64);
    match bytes.and_then(|bytes| isize::try_from(bytes).ok()) {
        Some(_) => Ok(count as usize),
        None => Err(Fault::invalid(format!(
            "{name}: {count} elements are more than memory can hold"
        ))),
    }
}

/// `count` values that the caller has filled; NULL is fine when there are none.
///
/// # Safety
/// `pointer` is NULL or points to `count` values, which nothing changes during the call.
pub unsafe fn slice<'a, T: Copy>(pointer: *const T, count: u64, name: &str) -> CallResult<&'a [T]> {
    let count = check_pointer(pointer, count, name)?;
    if count == 0 {
        return Ok(&[]);
    }
    // SAFETY: checked, and the caller's promise.
    Ok(unsafe { std::slice::from_raw_parts(pointer, count) })
}

/// `count` structures that the caller has filled, each checked.
///
/// # Safety
/// As for [`slice`].
pub unsafe fn structures_of<'a, T: Structure>(
    pointer: *const T,
    count: u64,
    name: &str,
) -> CallResult<&'a [T]> {
    let count = check_pointer(pointer, count, name)?;
    for index in 0..count {
        // SAFETY: the caller's promise.
        check(unsafe { pointer.add(index) })?;
    }
    // SAFETY: the caller's promise; each was looked at.
    unsafe { slice(pointer, count as u64, name) }
}

/// `count` values that are made of the places of structures in the caller's array.
///
/// # Safety
/// `make` asks no more than what the caller promises of each place.
pub unsafe fn each<T, R>(
    pointer: *const T,
    count: u64,
    name: &str,
    make: impl Fn(*const T) -> CallResult<R>,
) -> CallResult<Vec<R>> {
    let count = check_pointer(pointer, count, name)?;
    // SAFETY: the caller's promise: so many are there.
    (0..count)
        .map(|index| make(unsafe { pointer.add(index) }))
        .collect()
}

/// Copies `values` to the caller's memory, which must have room for exactly as many.
///
/// # Safety
/// `pointer` is NULL or points to `count` values that nothing else uses during the call.
pub unsafe fn fill<T: Copy>(pointer: *mut T, count: u64, values: &[T], name: &str) -> CallResult {
    if count != values.len() as u64 {
        return Err(Fault::invalid(format!(
            "{name} has room for {count} values and must have it for {}",
            values.len()
        )));
    }
    check_pointer(pointer, count, name)?;
    // SAFETY: checked, and the caller's promise; the caller's memory is not the library's.
    unsafe { std::ptr::copy_nonoverlapping(values.as_ptr(), pointer, values.len()) };
    Ok(())
}

/// A copy that fails instead of aborting where memory runs out.
pub fn collected<T>(values: impl ExactSizeIterator<Item = T>, name: &str) -> CallResult<Vec<T>> {
    let mut list = Vec::new();
    list.try_reserve_exact(values.len()).map_err(|_| {
        Fault::new(
            HS_OUT_OF_HOST_MEMORY,
            format!("no memory for {} {name}", values.len()),
        )
    })?;
    list.extend(values);
    Ok(list)
}

/// A text; None for NULL.
///
/// # Safety
/// `pointer` is NULL or points to bytes that end with a NUL.
pub unsafe fn text(pointer: *const c_char, name: &str) -> CallResult<Option<String>> {
    if pointer.is_null() {
        return Ok(None);
    }
    // SAFETY: the caller's promise.
    let bytes = unsafe { CStr::from_ptr(pointer) };
    match bytes.to_str() {
        Ok(text) => Ok(Some(text.to_owned())),
        Err(_) => Err(Fault::invalid(format!("{name} is not UTF-8"))),
    }
}

/// A path that must be there.
///
/// # Safety
/// As for [`text`].
pub unsafe fn path(pointer: *const c_char, name: &str) -> CallResult<PathBuf> {
    // SAFETY: the caller's promise.
    match unsafe { text(pointer, name) }? {
        Some(text) => Ok(text.into()),
        None => Err(Fault::invalid(format!("{name} is NULL"))),
    }
}

/// Writes a text, cut where there is no room left, with a NUL at its end.
pub fn write_text(target: &mut [c_char], text: &str) {
    let mut end = text.len().min(target.len() - 1);
    while !text.is_char_boundary(end) {
        end -= 1;
    }
    target.fill(0);
    for (to, byte) in target.iter_mut().zip(text[..end].bytes()) {
        *to = byte as c_char;
    }
}

/// Whether a number that stands for yes or no is one.
pub fn flag(value: u32, name: &str) -> CallResult<bool> {
    match value {
        0 => Ok(false),
        1 => Ok(true),
        other => Err(Fault::invalid(format!("{name} is 0 or 1, not {other}"))),
    }
}
