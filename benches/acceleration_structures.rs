//! Time and bytes of the hierarchies over a shadow map ([Schwarz08 table 1]), by map size and by how densely their nodes
//! stand, with bounds of 32 bits and with 16. `cargo bench --bench acceleration_structures`.

mod gpu_time;

use criterion::{Criterion, criterion_group, criterion_main};
use gpu_time::{GpuTime, bench, criterion, open, renderer, shot};
use halfshade::render::Renderer;
use halfshade::technique::{Hierarchy, Settings};

/// [texel] Width and height of the map.
const MAPS: [u32; 5] = [256, 512, 1024, 2048, 4096];
/// [pixel] Few: they matter to nothing here but how many levels the largest kernel needs.
const SIZE: u32 = 8;

/// The scene with the largest kernels, so that all levels are built.
const SCENE: &str = "grid";

/// [byte] Of the hierarchy.
fn bytes(renderer: &Renderer) -> u64 {
    let resources = renderer.plan().memory();
    resources
        .filter(|&(name, _)| name == "hierarchy")
        .map(|(_, bytes)| bytes)
        .sum()
}

fn acceleration_structures(criterion: &mut Criterion<GpuTime>) {
    let gpu = open();
    let mut group = criterion.benchmark_group("acceleration_structures");
    let densities = Hierarchy::ALL.iter();
    let kinds: Vec<_> = densities
        .flat_map(|&kind| [(kind, 32), (kind, 16)])
        .collect();
    for (map, (hierarchy, mssm_bits)) in MAPS
        .iter()
        .flat_map(|&map| kinds.iter().map(move |&kind| (map, kind)))
    {
        let settings = Settings {
            map,
            hierarchy,
            mssm_bits,
            split: 1,
            ..Settings::default()
        };
        let make = || renderer(&gpu, &shot(SCENE, SIZE), settings.clone());
        let name = format!("{hierarchy}_{mssm_bits}/{map}");
        bench(
            &mut group,
            &gpu,
            &name,
            bytes,
            |pass| pass == "hierarchy",
            make,
        );
    }
    group.finish();
}

criterion_group! { name = benches; config = criterion(); targets = acceleration_structures }
criterion_main!(benches);
