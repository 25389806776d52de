//! Several samples of a pixel with one visibility [Schwarz08 §7]: pictures against those of many pixels in the place of each.

#[path = "support/gpu.rs"]
mod support;

use std::sync::Arc;

use halfshade::gpu::Gpu;
use halfshade::plan::Outputs;
use halfshade::render::{DEFAULT_COSTS, DEFAULT_EXPOSURE, RenderOptions, Renderer};
use halfshade::technique::{Settings, Technique};
use support::{load, with_gpu};

/// [pixel]
const SIDE: usize = 64;
/// [pixel] In the place of each, in both directions.
const FINER: usize = 4;

/// Linear RGB of a scene, row by row.
fn picture(gpu: &Arc<Gpu>, scene: &str, side: usize, settings: &Settings) -> Vec<[f64; 3]> {
    let options = RenderOptions {
        outputs: Outputs { picture: true },
        costs: DEFAULT_COSTS,
        exposure: DEFAULT_EXPOSURE,
    };
    let shot = load(scene, side as u32, settings.clone());
    let mut renderer = Renderer::new(gpu, &shot, options).expect("a renderer");
    renderer.render().expect("a frame");
    let linear = |byte: &u8| {
        let value = f64::from(*byte) / 255.0;
        match value <= 0.04045 {
            true => value / 12.92,
            false => ((value + 0.055) / 1.055).powf(2.4),
        }
    };
    let bytes = renderer.picture().expect("a picture");
    let pixel = |rgba: &[u8]| [0, 1, 2].map(|channel| linear(&rgba[channel]));
    bytes.chunks_exact(4).map(pixel).collect()
}

/// The means of FINER × FINER pixels each.
fn averaged(fine: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let mean = |index: usize| {
        let (left, top) = (index % SIDE * FINER, index / SIDE * FINER);
        let all =
            (0..FINER * FINER).map(|i| fine[(top + i / FINER) * SIDE * FINER + left + i % FINER]);
        let sum = all.fold([0.0; 3], |sum, pixel| {
            [0, 1, 2].map(|channel| sum[channel] + pixel[channel])
        });
        sum.map(|sum| sum / (FINER * FINER) as f64)
    };
    (0..SIDE * SIDE).map(mean).collect()
}

/// The largest difference in a channel of each pixel.
fn differences(a: &[[f64; 3]], b: &[[f64; 3]]) -> Vec<f64> {
    let of_pixel = |(a, b): (&[f64; 3], &[f64; 3])| {
        a.iter()
            .zip(b)
            .map(|(a, b)| (a - b).abs())
            .fold(0.0, f64::max)
    };
    a.iter().zip(b).map(of_pixel).collect()
}

fn settings() -> Settings {
    Settings {
        map: 512,
        split: 1,
        ..Settings::usual(Technique::PacketContour)
    }
}

/// [Schwarz08, fig. 9] Samples smooth silhouettes; where they take their pixel's visibility whatever they lie on, some pixels
/// beside silhouettes are far too dark or too bright.
#[test]
fn samples_look_at_neighbours_for_their_visibility() {
    with_gpu(|gpu| {
        for scene in ["knot", "tree"] {
            let truth = averaged(&picture(gpu, scene, SIDE * FINER, &settings()));
            let errors = |change: &dyn Fn(&mut Settings)| {
                let mut changed = settings();
                change(&mut changed);
                differences(&picture(gpu, scene, SIDE, &changed), &truth)
            };
            let single = errors(&|_| {});
            let four = errors(&|settings| settings.multisample = 4);
            let own = errors(&|settings| {
                settings.multisample = 4;
                settings.neighbour_visibility = false;
            });
            let mean = |errors: &[f64]| errors.iter().sum::<f64>() / errors.len() as f64;
            let [single, own, four] = [&single, &own, &four].map(|errors| mean(errors));
            println!(
                "{scene}: mean errors {single:.5} of one sample, {own:.5} and {four:.5} of four"
            );
            assert!(four < own && own < single, "{scene}: {single} {own} {four}");
            assert!(four < 0.8 * single, "{scene}: {single} {four}");
        }
    });
}

/// Where a pixel sees one triangle alone, its samples are one.
#[test]
fn a_pixel_of_one_triangle_is_the_same_to_the_bit() {
    with_gpu(|gpu| {
        let single = picture(gpu, "plate", SIDE, &settings());
        let four = picture(
            gpu,
            "plate",
            SIDE,
            &Settings {
                multisample: 4,
                ..settings()
            },
        );
        let changed = differences(&single, &four)
            .iter()
            .filter(|off| **off > 0.0)
            .count();
        // Silhouettes and diagonals of four triangles, with what their visibility changes.
        assert!(
            changed > 20 && changed < SIDE * SIDE / 8,
            "{changed} pixels differ"
        );
    });
}
