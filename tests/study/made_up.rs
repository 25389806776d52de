//! Runs that nobody measured.

use std::collections::BTreeMap;

use halfshade::compare::Metrics;
use halfshade::image::RgbImage;
use halfshade::spread::Spread;
use halfshade::study::{Errors, Machine, Measured, Outcome, Pictures, Run};
use halfshade::technique::{Settings, Technique};

/// A run of a shot that took so many ms and has this error.
pub fn run(shot: &str, technique: Technique, ms: f64, error: f64) -> Run {
    let settings = Settings::usual(technique);
    let spread = Spread::of([ms]);
    let metrics = Metrics {
        pixels: 64,
        shadow_pixels: 32,
        mismatched: 0,
        left_out_by_facing: 0,
        mae: error,
        rmse: error,
        bias: error,
        max: error,
        share_over_0_05: 0.0,
        mae_shadow: error,
        rmse_shadow: error,
        bias_shadow: error,
        p99: error,
        share_over_0_05_shadow: 0.0,
    };
    let measured = Measured {
        frames: 1,
        warm: true,
        shadow_ms: spread,
        visibility_ms: spread,
        raster_ms: spread,
        compute_ms: spread,
        total_ms: spread,
        passes: BTreeMap::new(),
        memory_bytes: 1,
        resources: BTreeMap::new(),
        errors: Errors {
            metrics,
            mae_shadow_all: Some(error),
            flip: error,
            flicker: None,
        },
        counters: BTreeMap::new(),
    };
    Run {
        shot: shot.into(),
        shot_file: format!("{shot}.json"),
        content: shot.into(),
        size: (8, 8),
        label: settings.label(),
        command: format!("halfshade render {shot}.json"),
        settings,
        truth_samples: 16,
        machine: Machine {
            device: "none <script>&".into(),
            device_kind: "cpu".into(),
            driver: "none".into(),
            subgroup_size: 1,
            version: "0".into(),
            commit: "0".into(),
        },
        outcome: Outcome::Measured(Box::new(measured)),
    }
}

/// 8×8 pixels of one colour.
pub fn pictures() -> Pictures {
    let grey = RgbImage {
        width: 8,
        height: 8,
        rgb8: vec![128; 8 * 8 * 3],
    };
    Pictures {
        picture: grey.clone(),
        error: grey,
    }
}
