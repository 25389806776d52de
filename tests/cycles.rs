//! Devices and renderers that come and go leave nothing. `HALFSHADE_SLOW=1` does so 1000 times.

#[path = "support/heap.rs"]
mod heap;
#[path = "support/slow.rs"]
mod slow;
#[path = "support/gpu.rs"]
mod support;

use std::sync::Arc;

use halfshade::gpu::{Gpu, Options};
use halfshade::shot::Shot;
use halfshade::technique::{Settings, Technique};
use support::{load, renderer, same_bits, with_gpu};

#[global_allocator]
static HEAP: heap::Counting = heap::Counting;

/// [byte] Fragments of free memory that drivers and libraries may keep, however many cycles there are: 300 KiB were
/// measured after 400. The resources of a single renderer take more than a hundredth of it.
const KEPT: usize = 4 << 20;

/// [byte] What a driver keeps of each renderer that there ever was. SwiftShader's pipeline cache keeps what it has
/// compiled for layouts that are gone: 1.6 MB (without the cache 0.15 MB).
fn kept_of_each(gpu: &Gpu) -> usize {
    match gpu.info.driver.starts_with("SwiftShader") {
        true => 2 << 20,
        false => 0,
    }
}

/// [byte] What the process has in memory, drivers included.
fn resident() -> usize {
    let statistics = std::fs::read_to_string("/proc/self/statm").expect("Linux tells");
    let pages = statistics
        .split(' ')
        .nth(1)
        .and_then(|pages| pages.parse::<usize>().ok());
    pages.expect("the second number counts pages") * 4096
}

fn shot() -> Shot {
    let settings = Settings {
        map: 16,
        ..Settings::usual(Technique::Hard)
    };
    load("plate", 16, settings)
}

/// Makes a renderer, renders and destroys it.
fn cycle(gpu: &Arc<Gpu>, shot: &Shot) -> Vec<f32> {
    let mut renderer = renderer(gpu, shot);
    renderer.render().expect("a frame");
    let visibility = renderer.visibility(0).expect("visibility");
    assert!(gpu.memory_in_use() > 0);
    drop(renderer);
    assert_eq!(gpu.memory_in_use(), 0, "the allocator holds something");
    visibility
}

/// One after the other: they count the memory of the whole process.
#[test]
fn cycles_leave_nothing() {
    cycles_take_no_memory();
    cycles_are_valid();
}

/// Without the validation layer, which takes memory for every object that there ever was.
fn cycles_take_no_memory() {
    let cycles = slow::cases(40, 1000);
    let shot = shot();
    let open = || Gpu::open(&Options::default()).expect("a Vulkan device");
    let expected = cycle(&open(), &shot);
    let live = heap::live();
    let gpu = open();
    let mut before = 0;
    for turn in 0..cycles {
        // What drivers and libraries keep for good they have by now.
        if turn == cycles / 4 {
            before = resident();
        }
        assert!(same_bits(&cycle(&gpu, &shot), &expected), "cycle {turn}");
    }
    let turns = (cycles - cycles / 4) as usize;
    let grown = resident().saturating_sub(before);
    let kept = KEPT + turns * kept_of_each(&gpu);
    assert!(grown <= kept, "{grown} bytes after {turns} cycles");
    drop(gpu);
    assert_eq!(heap::live(), live, "the engine holds something");
    // Not before: what a test prints is kept in memory.
    println!("{turns} cycles: {grown} bytes, {} each", grown / turns);
}

/// Devices come and go as well. (lavapipe keeps some 40 KiB of each that has rendered, whatever it has rendered, so
/// that only the engine's own memory can be held against it.)
fn cycles_are_valid() {
    let shot = shot();
    let mut before = None;
    for _ in 0..slow::cases(3, 20) {
        with_gpu(|gpu| {
            for _ in 0..slow::cases(3, 50) {
                cycle(gpu, &shot);
            }
        });
        let live = heap::live();
        assert_eq!(
            *before.get_or_insert(live),
            live,
            "the engine holds something of a device"
        );
    }
}
