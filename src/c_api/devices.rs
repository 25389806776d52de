//! Which library, and which devices.

use std::ffi::{CStr, c_char};

use super::call::call;
use super::call_result::Fault;
use super::check::{output, place, write_text};
use super::context::CONTEXTS;
use super::types::*;
use crate::gpu::{DeviceInfo, list_devices};

/// HS_ABI_VERSION of the library, to be compared with the header's. Any thread.
#[unsafe(no_mangle)]
pub extern "C" fn hs_abi_version() -> u32 {
    HS_ABI_VERSION
}

/// The library's version, such as "0.1.0"; valid for ever. Any thread.
#[unsafe(no_mangle)]
pub extern "C" fn hs_version() -> *const c_char {
    const VERSION: &CStr =
        match CStr::from_bytes_with_nul(concat!(env!("CARGO_PKG_VERSION"), "\0").as_bytes()) {
            Ok(version) => version,
            Err(_) => c"",
        };
    VERSION.as_ptr()
}

/// The name of a result code, such as "HS_NOT_READY"; valid for ever, never NULL. Any thread.
#[unsafe(no_mangle)]
pub extern "C" fn hs_result_name(result: hs_result) -> *const c_char {
    let name = match result {
        HS_OK => c"HS_OK",
        HS_INVALID_ARGUMENT => c"HS_INVALID_ARGUMENT",
        HS_UNSUPPORTED => c"HS_UNSUPPORTED",
        HS_OUT_OF_HOST_MEMORY => c"HS_OUT_OF_HOST_MEMORY",
        HS_OUT_OF_DEVICE_MEMORY => c"HS_OUT_OF_DEVICE_MEMORY",
        HS_DEVICE_LOST => c"HS_DEVICE_LOST",
        HS_NOT_READY => c"HS_NOT_READY",
        HS_IO => c"HS_IO",
        HS_PARSE => c"HS_PARSE",
        HS_INTERNAL => c"HS_INTERNAL",
        _ => c"an unknown result",
    };
    name.as_ptr()
}

/// Lists the system's Vulkan devices. `*count` says how many elements `devices` has, each with `type` and `size`
/// set, and then how many there are; elements beyond them are left alone. With `devices` NULL only the number is
/// told. HS_INVALID_ARGUMENT with the number told when there is no room for all.
///
/// Any thread.
///
/// # Safety
/// `count` points to a number and `devices` is NULL or points to as many structures.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hs_devices(devices: *mut hs_device_info, count: *mut u32) -> hs_result {
    call(|_| {
        // SAFETY: the caller's promise, here and below.
        let count = unsafe { place(count, "count") }?;
        let found = list_devices()?;
        let room = std::mem::replace(count, found.len() as u32);
        if devices.is_null() {
            return Ok(());
        }
        if (room as usize) < found.len() {
            return Err(Fault::invalid(format!(
                "there is room for {room} devices and there are {}",
                found.len()
            )));
        }
        for (index, info) in found.iter().enumerate() {
            write(unsafe { output(devices.add(index)) }?, info);
        }
        Ok(())
    })
}

/// Tells which device a context has. HS_UNSUPPORTED when it has none.
///
/// Any thread.
///
/// # Safety
/// `device` points to a structure with `type` and `size` set.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hs_context_device(
    context: *const hs_context,
    device: *mut hs_device_info,
) -> hs_result {
    call(|scope| {
        let context = CONTEXTS.enter(scope, context)?;
        // SAFETY: the caller's promise.
        let target = unsafe { output(device) }?;
        write(target, &context.gpu()?.info);
        Ok(())
    })
}

fn write(target: &mut hs_device_info, info: &DeviceInfo) {
    write_text(&mut target.name, &info.name);
    write_text(&mut target.kind, info.kind);
    write_text(&mut target.driver, &info.driver);
    write_text(&mut target.uuid, &info.uuid);
    write_text(&mut target.missing, &info.missing.join(", "));
    target.subgroup_size = info.subgroup_size;
    target.usable = u32::from(info.missing.is_empty());
}
