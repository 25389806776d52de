//! Devices and renderers that come and go leave nothing. `HALFSHADE_SLOW=1` does so 1000 times.

#[path = "support/heap.rs"]
mod heap;
#[path = "support/slow.rs"]
mod slow;
#[path = "support/gpu.rs"]
mod support;

use std::sync::Arc;

use halfshade::gpu::{Gpu, Options};
use halfshade::shot::{Settings, Shot, Technique};
use support::{load, renderer, same_bits, with_gpu};

#[global_allocator]
static HEAP: heap::Counting = heap::Counting;

/// [byte] What drivers, loaders and fragments of free memory may keep of a cycle: measured, 1 to 4 KiB under lavapipe
/// where nothing of the engine is left. The smallest buffer of a renderer takes more with its staging.
const KEPT_PER_CYCLE: usize = 8 << 10;
/// [byte] A page cache's worth, whatever the number of cycles.
const KEPT: usize = 4 << 20;

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

/// Without the validation layer, which takes memory for every object that there ever was.
#[test]
fn cycles_take_no_memory() {
    let cycles = slow::cases(40, 1000);
    let shot = shot();
    let whole = || {
        cycle(
            &Gpu::open(&Options::default()).expect("a Vulkan device"),
            &shot,
        )
    };
    let expected = whole();
    let mut before = (0, 0);
    for turn in 0..cycles {
        // What drivers and libraries keep for good they have by now.
        if turn == cycles / 4 {
            before = (heap::live(), resident());
        }
        assert!(same_bits(&whole(), &expected), "cycle {turn}");
    }
    let turns = (cycles - cycles / 4) as usize;
    let grown = resident().saturating_sub(before.1);
    println!("{turns} cycles: {grown} bytes, {} each", grown / turns);
    assert_eq!(heap::live(), before.0, "the engine holds something");
    assert!(
        grown <= KEPT + KEPT_PER_CYCLE * turns,
        "{grown} bytes after {turns} cycles"
    );
}

#[test]
fn cycles_are_valid() {
    let shot = shot();
    for _ in 0..slow::cases(2, 20) {
        with_gpu(|gpu| {
            for _ in 0..slow::cases(3, 50) {
                cycle(gpu, &shot);
            }
        });
    }
}
