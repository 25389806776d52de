//! Time and bytes of the structures over a shadow map ([Schwarz08 table 1]), by map size: the hierarchical shadow map
//! and the dual-grid MSSM in 32 and 16 bits. `cargo bench --bench acceleration_structures`.

mod gpu_time;

use criterion::{Criterion, criterion_group, criterion_main};
use gpu_time::{GpuTime, bench, criterion, open, renderer, shot};
use halfshade::render::Renderer;
use halfshade::technique::{Settings, Technique};

/// [texel] Width and height of the map.
const MAPS: [u32; 5] = [256, 512, 1024, 2048, 4096];
/// [pixel] Few: they matter to nothing here but how many levels of the MSSM the largest kernel needs.
const SIZE: u32 = 8;

/// Name of a structure, the scene, who reads it, bits of a bound, its pass and its bytes. The kernels of the grid are
/// the largest, so all levels of an MSSM are built; an HSM always has all, and over the grid's large maps its walks are
/// longer than lavapipe lets a loop run.
type Structure = (
    &'static str,
    &'static str,
    Technique,
    u32,
    fn(&str) -> bool,
    fn(&Renderer) -> u64,
);

const STRUCTURES: [Structure; 3] = [
    (
        "hsm",
        "tree",
        Technique::MicropatchHierarchical,
        32,
        |pass| pass == "hsm",
        |renderer| bytes(renderer, "hsm"),
    ),
    (
        "mssm_32",
        "grid",
        Technique::PacketContour,
        32,
        |pass| pass == "mssm",
        |renderer| bytes(renderer, "mssm"),
    ),
    (
        "mssm_16",
        "grid",
        Technique::PacketContour,
        16,
        |pass| pass == "mssm",
        |renderer| bytes(renderer, "mssm"),
    ),
];

fn bytes(renderer: &Renderer, name: &str) -> u64 {
    let resources = renderer.plan().memory();
    resources
        .filter(|&(known, _)| known == name)
        .map(|(_, bytes)| bytes)
        .sum()
}

fn acceleration_structures(criterion: &mut Criterion<GpuTime>) {
    let gpu = open();
    let mut group = criterion.benchmark_group("acceleration_structures");
    for map in MAPS {
        for (name, scene, technique, mssm_bits, counts, bytes) in STRUCTURES {
            let settings = Settings {
                technique,
                map,
                mssm_bits,
                split: 1,
                ..Settings::default()
            };
            let make = || renderer(&gpu, &shot(scene, SIZE), settings.clone());
            bench(
                &mut group,
                &gpu,
                &format!("{name}/{map}"),
                bytes,
                counts,
                make,
            );
        }
    }
    group.finish();
}

criterion_group! { name = benches; config = criterion(); targets = acceleration_structures }
criterion_main!(benches);
