//! Whatever call fails, whenever it fails: an error that names it, nothing left behind, and the next frame is right.
//! `HALFSHADE_SLOW=1` fails every call of a render, one after the other; else each function's first and last call.

#[path = "support/faults.rs"]
mod faults;
#[path = "support/slow.rs"]
mod slow;
#[path = "support/gpu.rs"]
mod support;

use std::collections::BTreeMap;
use std::sync::Arc;

use faults::with_fault;
use halfshade::gpu::{Gpu, Options};
use halfshade::plan::Outputs;
use halfshade::render::{DEFAULT_COSTS, DEFAULT_EXPOSURE, RenderOptions, Renderer};
use halfshade::shot::Shot;
use halfshade::technique::{Settings, Technique};
use halfshade::{Error, Result};
use support::load;

fn open() -> Result<Arc<Gpu>> {
    Gpu::open(&Options {
        validate: true,
        loader: Some(faults::loader),
        ..Options::default()
    })
}

/// Of a technique with few pipelines, as each of some hundred runs makes them anew.
fn shot() -> Shot {
    load(
        "plate",
        16,
        Settings {
            map: 16,
            ..Settings::usual(Technique::Hard)
        },
    )
}

fn renderer(gpu: &Arc<Gpu>, shot: &Shot) -> Result<Renderer> {
    let options = RenderOptions {
        outputs: Outputs { picture: true },
        costs: DEFAULT_COSTS,
        exposure: DEFAULT_EXPOSURE,
    };
    Renderer::new(gpu, shot, options)
}

type Products = (Vec<u32>, Vec<u8>);

/// A frame and what is read of it.
fn frame(renderer: &mut Renderer) -> Result<Products> {
    renderer.render()?;
    let bits = renderer.visibility(0)?.into_iter().map(f32::to_bits);
    Ok((bits.collect(), renderer.picture()?))
}

/// The error must name the call, and tell a lost device from all else.
fn check_error(error: &Error, call: &str) {
    let text = error.to_string();
    assert!(text.contains(call), "{call} failed, not: {text}");
    let losing = [
        "vkWaitForFences",
        "vkGetQueryPoolResults",
        "vkQueueSubmit2",
        "vkQueueWaitIdle",
    ];
    assert_eq!(error.is_device_lost(), losing.contains(&call), "{text}");
    assert_eq!(
        text.contains("the device is lost"),
        error.is_device_lost(),
        "{text}"
    );
}

/// Which calls to fail: of each function the first and the last, or all.
fn chosen(called: &[&'static str]) -> Vec<usize> {
    let mut places: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
    for (index, name) in called.iter().enumerate() {
        places.entry(name).or_default().push(index);
    }
    let step = |count: usize| count.div_ceil(slow::cases(1, u32::MAX) as usize).max(1);
    let some = |list: Vec<usize>| -> Vec<usize> {
        let last = list.last().copied();
        list.iter()
            .step_by(step(list.len()))
            .copied()
            .chain(last)
            .collect()
    };
    let mut chosen: Vec<usize> = places.into_values().flat_map(some).collect();
    chosen.sort();
    chosen.dedup();
    chosen
}

/// Fails a call while the first renderer of a device is made, which must leave the device as it was.
fn first_renderer_fails(shot: &Shot, index: usize, name: &str) {
    let gpu = open().expect("nothing failed");
    let messages = gpu.validation_messages();
    let (result, _) = with_fault(Some(index), || frame(&mut renderer(&gpu, shot)?));
    check_error(&result.expect_err("it failed"), name);
    assert_eq!(gpu.memory_in_use(), 0);
    frame(&mut renderer(&gpu, shot).expect("nothing failed")).expect("nothing failed");
    drop(gpu);
    let messages = messages.lock().expect("no callback panicked");
    assert!(messages.is_empty(), "{}", messages.join("\n"));
}

#[test]
fn every_call_may_fail() {
    let (gpu, opening) = with_fault(None, open);
    let gpu = gpu.expect("a Vulkan device and the validation layer");
    let messages = gpu.validation_messages();
    let shot = shot();

    // While a renderer is made and renders its first frame. The device keeps the memory that it has taken once, so
    // that later renderers take none.
    let whole = || frame(&mut renderer(&gpu, &shot)?);
    let (expected, first) = with_fault(None, whole);
    let expected = expected.expect("nothing failed");
    let (_, rendering) = with_fault(None, whole);
    for (turn, index) in chosen(&rendering).into_iter().enumerate() {
        let (result, called) = with_fault(Some(index), whole);
        assert_eq!(
            called[..=index],
            rendering[..=index],
            "other calls than before"
        );
        check_error(&result.expect_err("it failed"), rendering[index]);
        assert_eq!(
            gpu.memory_in_use(),
            0,
            "after {}, call {index}",
            rendering[index]
        );
        // The device is as good as before.
        if turn % 16 == 0 {
            assert!(
                whole().expect("nothing failed") == expected,
                "after call {index}"
            );
        }
    }

    // In a frame, after which the same renderer goes on.
    let mut renderer = renderer(&gpu, &shot).expect("nothing failed");
    frame(&mut renderer).expect("nothing failed");
    let (_, called) = with_fault(None, || frame(&mut renderer));
    for index in chosen(&called) {
        let (result, _) = with_fault(Some(index), || frame(&mut renderer));
        check_error(&result.expect_err("it failed"), called[index]);
        assert!(
            frame(&mut renderer).expect("nothing failed") == expected,
            "after call {index}"
        );
    }
    drop(renderer);
    assert_eq!(gpu.memory_in_use(), 0);
    assert_eq!(Arc::strong_count(&gpu), 1);
    drop(gpu);
    let messages = messages.lock().expect("no callback panicked");
    assert!(messages.is_empty(), "{}", messages.join("\n"));
    drop(messages);

    let taking = ["vkAllocateMemory", "vkMapMemory"];
    for index in chosen(&first) {
        if taking.contains(&first[index]) {
            first_renderer_fails(&shot, index, first[index]);
        }
    }

    // While the device is opened. The pipeline cache is no loss.
    for (index, name) in opening.iter().enumerate() {
        match (with_fault(Some(index), open).0, *name) {
            (Ok(_), "vkCreatePipelineCache") => {}
            (Ok(_), name) => panic!("{name} failed unnoticed"),
            (Err(error), name) => check_error(&error, name),
        }
    }
    let all: Vec<&str> = opening
        .iter()
        .chain(&first)
        .chain(&called)
        .copied()
        .collect();
    println!(
        "{} calls while opening, {} in the first frame, {} in the next",
        opening.len(),
        rendering.len(),
        called.len()
    );
    for name in faults::NAMES {
        let idle = ["vkQueueWaitIdle"];
        assert!(
            all.contains(name) || idle.contains(name),
            "{name} is never called"
        );
    }
}
