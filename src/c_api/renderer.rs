//! Renderers of the standalone tier.

use super::call::call;
use super::call_result::{CallResult, Fault};
use super::check::{fill, flag, optional, output, place, write_text};
use super::context::Held;
use super::convert::reserved;
use super::handles::Registry;
use super::shot::SHOTS;
use super::types::*;
use crate::plan::{Outputs, suited_exposure};
use crate::render::{DEFAULT_COSTS, DEFAULT_EXPOSURE, Frame, RenderOptions, Renderer};
use crate::shared::{Costs, Exposure};

/// A renderer and the frame that it rendered last.
pub struct Rendering {
    renderer: Renderer,
    frame: Option<Frame>,
}

impl Rendering {
    fn frame(&self) -> CallResult<&Frame> {
        self.frame.as_ref().ok_or_else(|| {
            Fault::new(
                HS_NOT_READY,
                "nothing was rendered yet; call hs_renderer_render first",
            )
        })
    }
}

/// All living renderers.
pub static RENDERERS: Registry<hs_renderer, Held<Rendering>> = Registry::new("renderer");

/// Makes a renderer for a shot as it is now: all memory, all pipelines. `info` may be NULL: visibility alone. It takes
/// seconds where the driver has to compile the pipelines first. On failure `*renderer` is NULL.
///
/// Any thread.
///
/// # Safety
/// `info` is NULL or points to a structure, `renderer` to a pointer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hs_renderer_create(
    shot: *mut hs_shot,
    info: *const hs_renderer_info,
    renderer: *mut *mut hs_renderer,
) -> hs_result {
    call(|scope| {
        // SAFETY: the caller's promise, here and below.
        let target = unsafe { place(renderer, "the pointer to the renderer") }?;
        *target = std::ptr::null_mut();
        let shot = SHOTS.enter(scope, shot)?;
        let mut options = options(unsafe { optional(info) }?)?;
        // A copy, so that the shot is free while the driver compiles.
        let shown = shot.with(|shot| Ok(shot.clone()))?;
        if options.exposure.scale == 0.0 {
            options.exposure.scale = suited_exposure(&shown);
        }
        let made = Rendering {
            renderer: Renderer::new(shot.context.gpu()?, &shown, options)?,
            frame: None,
        };
        shot.context.note(&made.renderer.plan().notes);
        *target = RENDERERS.add(Held::new(&shot.context, made))?;
        Ok(())
    })
}

fn options(info: Option<hs_renderer_info>) -> CallResult<RenderOptions> {
    let mut options = RenderOptions {
        outputs: Outputs { picture: false },
        costs: DEFAULT_COSTS,
        exposure: DEFAULT_EXPOSURE,
    };
    let Some(info) = info else {
        return Ok(options);
    };
    reserved(info.reserved)?;
    let or = |given: f32, usual: f32| if given == 0.0 { usual } else { given };
    options.outputs.picture = flag(info.picture, "picture")?;
    options.costs = Costs {
        edge: or(info.edge_cost, DEFAULT_COSTS.edge),
        visibility: or(info.visibility_cost, DEFAULT_COSTS.visibility),
    };
    if !info.exposure.is_finite() || !(0.0..f32::INFINITY).contains(&info.ambient) {
        return Err(Fault::invalid(
            "exposure and ambient must be finite, ambient not negative",
        ));
    }
    options.exposure = Exposure {
        scale: info.exposure,
        ambient: info.ambient,
        light_count: 0,
    };
    Ok(options)
}

/// Lets go of a renderer; NULL is fine. A handle that was destroyed before is ignored.
///
/// Any thread. Other threads' calls on it finish.
#[unsafe(no_mangle)]
pub extern "C" fn hs_renderer_destroy(renderer: *mut hs_renderer) {
    RENDERERS.remove(renderer);
}

/// Renders a frame and waits for it. Every frame is the same, bit for bit.
///
/// Any thread; calls on one renderer wait for one another.
#[unsafe(no_mangle)]
pub extern "C" fn hs_renderer_render(renderer: *mut hs_renderer) -> hs_result {
    with(renderer, |rendering| {
        rendering.frame = None;
        rendering.renderer.invalidate();
        rendering.frame = Some(rendering.renderer.render()?);
        Ok(())
    })
}

/// Copies a light's visibility: 1 lit ... 0 umbra, NaN where the pixel sees no surface; the share of the light's
/// area that the visible surface sees. Row by row from the top, `count` = width * height values.
///
/// HS_NOT_READY before the first frame. Any thread; calls on one renderer wait for one another.
///
/// # Safety
/// `visibility` points to `count` values.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hs_renderer_visibility(
    renderer: *mut hs_renderer,
    light: u32,
    visibility: *mut f32,
    count: u64,
) -> hs_result {
    with(renderer, |rendering| {
        rendering.frame()?;
        let values = rendering.renderer.visibility(light as usize)?;
        // SAFETY: the caller's promise.
        unsafe { fill(visibility, count, &values, "visibility") }
    })
}

/// Copies the shaded picture: RGBA, 8 bits each, sRGB, row by row from the top, `bytes` = 4 * width * height.
///
/// HS_NOT_READY before the first frame, HS_UNSUPPORTED when the renderer was made without. Any thread; calls on one
/// renderer wait for one another.
///
/// # Safety
/// `rgba` points to `bytes` bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hs_renderer_picture(
    renderer: *mut hs_renderer,
    rgba: *mut u8,
    bytes: u64,
) -> hs_result {
    with(renderer, |rendering| {
        if !rendering.frame()?.plan.outputs.picture {
            return Err(Fault::new(
                HS_UNSUPPORTED,
                "the renderer was made without a picture; set picture in hs_renderer_info",
            ));
        }
        let values = rendering.renderer.picture()?;
        // SAFETY: the caller's promise.
        unsafe { fill(rgba, bytes, &values, "the picture") }
    })
}

/// Tells what the last frame was.
///
/// HS_NOT_READY before the first frame. Any thread; calls on one renderer wait for one another.
///
/// # Safety
/// `statistics` points to a structure with `type` and `size` set.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hs_renderer_statistics(
    renderer: *mut hs_renderer,
    statistics: *mut hs_statistics,
) -> hs_result {
    with(renderer, |rendering| {
        // SAFETY: the caller's promise.
        let target = unsafe { output(statistics) }?;
        let frame = rendering.frame()?;
        let fits = rendering.renderer.fits()?;
        let counters = rendering.renderer.counters()?;
        let count = |test: fn(&crate::shared::Fit) -> bool| {
            fits.iter().filter(|fit| test(fit)).count() as u32
        };
        let wide = |[low, high]: [u32; 2]| u64::from(low) | u64::from(high) << 32;
        *target = hs_statistics {
            r#type: target.r#type,
            size: target.size,
            next: target.next,
            device_ms: frame.timings.ms(|_| true),
            memory_bytes: frame.plan.memory_bytes(),
            pass_count: frame.plan.passes().len() as u32,
            view_count: frame.plan.views().count() as u32,
            views_with_receivers: count(|fit| fit.receiver_count > 0),
            views_with_casters: count(|fit| fit.level_count > 0),
            pixels: counters.pixels.into(),
            lit: counters.lit.into(),
            umbra: counters.umbra.into(),
            penumbra: counters.penumbra.into(),
            packets: counters.packets.into(),
            coherent_packets: counters.coherent_packets.into(),
            reprocessed_packets: counters.reprocessed_packets.into(),
            nodes_visited: wide(counters.nodes_visited),
            edges_extracted: wide(counters.edges_extracted),
            samples_read: wide(counters.samples_read),
        };
        Ok(())
    })
}

/// Tells about a pass of the last frame, in the order of first recording; `index` is below `pass_count`.
///
/// HS_NOT_READY before the first frame. Any thread; calls on one renderer wait for one another.
///
/// # Safety
/// `pass` points to a structure with `type` and `size` set.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hs_renderer_pass(
    renderer: *mut hs_renderer,
    index: u32,
    pass: *mut hs_pass,
) -> hs_result {
    with(renderer, |rendering| {
        // SAFETY: the caller's promise.
        let target = unsafe { output(pass) }?;
        let frame = rendering.frame()?;
        let passes = frame.plan.passes();
        let count = passes.len();
        let &(name, times) = passes.get(index as usize).ok_or_else(|| {
            Fault::invalid(format!("there is no pass {index}; the frame has {count}"))
        })?;
        write_text(&mut target.name, name);
        target.count = times;
        target.reserved = 0;
        target.device_ms = frame.timings.ms(|known| known == name);
        Ok(())
    })
}

/// Runs `work` on a renderer.
fn with(renderer: *mut hs_renderer, work: impl FnOnce(&mut Rendering) -> CallResult) -> hs_result {
    call(|scope| RENDERERS.enter(scope, renderer)?.with(work))
}
