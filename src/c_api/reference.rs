//! Ground truth on the CPU.

use std::sync::atomic::AtomicBool;

use super::call::call;
use super::call_result::Fault;
use super::check::{fill, input};
use super::shot::SHOTS;
use super::types::*;
use crate::reference::{ReferenceOptions, trace};

/// Traces the true visibility of a light with rays, on all processors; needs no device. Each array takes `count` =
/// width * height values, row by row from the top, NaN where the pixel sees no surface; any of them may be NULL.
///
/// `visibility`: as hs_renderer_visibility gives it. `facing`: the share of the light in front of the surface; where
/// it is not 1, the part below the horizon does not count as hidden. `standard_error`: of `visibility`.
///
/// Any thread; it takes as long as it takes, and does not keep other calls on the shot waiting.
///
/// # Safety
/// `info` points to a structure, the arrays to `count` values.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hs_reference(
    shot: *const hs_shot,
    info: *const hs_reference_info,
    visibility: *mut f32,
    facing: *mut f32,
    standard_error: *mut f32,
    count: u64,
) -> hs_result {
    call(|scope| {
        let shot = SHOTS.enter(scope, shot)?;
        // SAFETY: the caller's promise, here and below.
        let info = unsafe { input(info) }?;
        let shot = shot.with(|shot| Ok(shot.clone()))?;
        shot.validate()?;
        let pixels = u64::from(shot.width) * u64::from(shot.height);
        if count != pixels {
            return Err(Fault::invalid(format!(
                "count is {count} and must be {pixels}, the pixels of the shot"
            )));
        }
        let options = ReferenceOptions {
            samples: info.samples,
            seed: info.seed,
        };
        let never = AtomicBool::new(false);
        let image = trace(&shot, info.light as usize, options, &|_| {}, &never)?;
        for (target, plane, name) in [
            (visibility, &image.visibility, "visibility"),
            (facing, &image.facing, "facing"),
            (standard_error, &image.standard_error, "standard_error"),
        ] {
            if !target.is_null() {
                unsafe { fill(target, count, &plane.data, name) }?;
            }
        }
        Ok(())
    })
}
