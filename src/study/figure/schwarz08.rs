//! [Schwarz08]: what acceleration structures cost.

use super::check::{CLEAR, Check, all, number, numbers};
use super::row::{Curve, ERROR_ASIDE};
use super::{Candidate, Column, Experiment, Row, Trial, Truth};
use crate::Result;
use crate::shot::{Overrides, Shot};
use crate::technique::{Settings, Technique};

const MIB: f64 = 1024.0 * 1024.0;
/// Built-in shots: kernels that need all levels of an MSSM, and kernels that are quickly done with micropatches.
const MSSM_SCENE: &str = "grid";
const HSM_SCENE: &str = "knot";
const HSM: &str = "HSM";
const MSSM: &str = "MSSM";
const MSSM_16: &str = "MSSM, 16-bit bounds";
/// [texel, MiB] Side of the map, and the bytes of its HSM and MSSM in the paper.
const PAPER: [(f64, f64, f64); 2] = [(1024.0, 10.67, 88.0), (2048.0, 42.67, 384.0)];
/// [share] By how much bytes that are the same may differ: the paper rounds to two digits.
const SAME_BYTES: f64 = 0.01;
/// How much longer the paper builds an MSSM at the least, of 1024² and 2048² texels: 15 and 21 times.
const LONGER: f64 = 5.0;

const BUILD_TIME: Column = Column {
    name: "build_ms",
    plotted: true,
    of: |row| row.pass_ms(structure(row)),
};
const BYTES: Column = Column {
    name: "mib",
    plotted: true,
    of: mib,
};
/// What is allocated for it, the shadow map apart.
const STORED: Column = Column {
    name: "stored_mib",
    plotted: false,
    of: |row| row.bytes(structure(row)) / MIB,
};

pub const TABLE1: Experiment = Experiment {
    name: "schwarz08-table1",
    source: "Schwarz and Stamminger 2008, table 1: construction time and memory of acceleration structures",
    paper: "on a GeForce 8800 GTX, 1024x1024: HSM 0.26 ms and 10.67 MB, MSSM 3.92 ms and 88 MB, YSM 0.46 ms and \
            14.67 MB; 2048x2048: HSM 0.87 ms and 42.67 MB, MSSM 18.65 ms and 384 MB, YSM 1.07 ms and 46.67 MB",
    claim: "MSSMs of more than 1024x1024 texels are too expensive to build and to keep; HSMs cost a fraction of both",
    here: "the dual-grid MSSM of the built-in grid, whose kernels need all its levels, with 32-bit and with 16-bit \
           bounds, and the HSM of the built-in knot, for micropatches take too many turns on the grid; maps from \
           256x256 to 4096x4096 texels. mib counts level 0 of the HSM as the paper does, which is the shadow map \
           itself here; stored_mib is what is allocated beside it",
    missing: "the YSM, which does not exist here yet",
    differs: "a CPU driver's caches see other costs than a GPU's memory, and it builds the small upper levels of an \
              HSM one after the other for little more than their start, which weighs on small maps; the MSSM ends two \
              levels below the one that covers the map",
    abscissa: "map",
    columns: &[BUILD_TIME, BYTES, STORED, ERROR_ASIDE],
    frames: 15,
    counters: false,
    takes_shots: false,
    trials: |scale, _| {
        let all = [256, 512, 1024, 2048, 4096];
        let maps = scale.pick(&[64, 128][..], &all[..], &all[..]);
        let hsm = [(HSM, Technique::MicropatchHierarchical, 32)];
        let mssm = [
            (MSSM, Technique::PacketContour, 32),
            (MSSM_16, Technique::PacketContour, 16),
        ];
        Ok(vec![
            trial(HSM_SCENE, maps, &hsm)?,
            trial(MSSM_SCENE, maps, &mssm)?,
        ])
    },
    judge,
};

/// Structures by who reads them, with bits of a bound, over maps.
fn trial(scene: &str, maps: &[u32], structures: &[(&str, Technique, u32)]) -> Result<Trial> {
    // Pixels matter to nothing here but to how many levels the largest kernel needs.
    let overrides = Overrides {
        size: Some((16, 16)),
        ..Overrides::default()
    };
    let candidates = maps.iter().flat_map(|&map| {
        structures
            .iter()
            .map(move |&(series, technique, mssm_bits)| {
                let settings = Settings {
                    map,
                    mssm_bits,
                    split: 1,
                    ..Settings::published(technique)
                };
                Candidate::new(series, f64::from(map), settings)
            })
    });
    Ok(Trial {
        scene: scene.into(),
        shot: Shot::built_in(scene, &overrides)?,
        truth: Truth::Rays,
        samples: 64,
        candidates: candidates.collect(),
    })
}

/// The pass and the resource of a row's structure.
fn structure(row: &Row) -> &'static str {
    match row.series == HSM {
        true => "hsm",
        false => "mssm",
    }
}

/// [MiB] Of all its levels, two bounds a node. Level 0 of a min-max pyramid is stored as one float here, the shadow map;
/// the image of its other levels is half as wide as the map and as high, and has a third of its texels left over.
fn mib(row: &Row) -> f64 {
    let bytes = match row.series == HSM {
        true => 2.0 * row.bytes("shadow_map") + row.bytes("hsm") * 2.0 / 3.0,
        false => row.bytes("mssm"),
    };
    bytes / MIB
}

fn judge(rows: &[Row]) -> Vec<Check> {
    let hsm = |value| Curve::of(rows, HSM_SCENE, HSM, value);
    let mssm = |value| Curve::of(rows, MSSM_SCENE, MSSM, value);
    let (hsm_times, mssm_times) = (hsm(BUILD_TIME.of), mssm(BUILD_TIME.of));
    let longer = Curve(
        mssm_times
            .0
            .iter()
            .map(|p| (p.0, p.1 / hsm_times.at(p.0)))
            .collect(),
    );
    let times: Vec<f64> = longer.0.iter().map(|p| p.1).collect();
    let mut checks = vec![
        Check::new(
            "an MSSM takes at least five times as long to build as an HSM in every size (15 and 21 times in the paper)",
            format!("{} times", numbers(times.iter().copied())),
            all(&times, |ratio| ratio >= LONGER),
        ),
        Check::new(
            "the larger the map, the more times as long (τ ≥ 0.6)",
            format!("τ = {}", number(longer.trend())),
            longer.trend() >= CLEAR,
        ),
    ];
    let (hsm, mssm) = (hsm(mib), mssm(mib));
    let same = |found: f64, paper: f64| (found / paper - 1.0).abs() <= SAME_BYTES;
    for (map, hsm_paper, mssm_paper) in PAPER {
        let (hsm, mssm) = (hsm.at(map), mssm.at(map));
        checks.push(Check::new(
            format!("an HSM and an MSSM of {map}x{map} take {hsm_paper} and {mssm_paper} MB"),
            format!("{} and {} MiB", number(hsm), number(mssm)),
            same(hsm, hsm_paper) && same(mssm, mssm_paper),
        ));
    }
    checks
}
