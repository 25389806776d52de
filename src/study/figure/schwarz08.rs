//! [Schwarz08]: what acceleration structures cost.

use super::check::{Check, number, numbers};
use super::row::{Curve, ERROR_ASIDE, only_scene};
use super::{Candidate, Column, Experiment, Row, Trial, Truth};
use crate::shot::{Overrides, Settings, Shot, Technique};

const MIB: f64 = 1024.0 * 1024.0;
const SERIES: &str = "HSM and MSSM of the same map";
/// [texel, MiB] Side of the map, and the bytes of its HSM and MSSM in the paper.
const PAPER: [(f64, f64, f64); 2] = [(1024.0, 10.67, 88.0), (2048.0, 42.67, 384.0)];
/// [share] By how much bytes that are the same may differ: the paper rounds to two digits.
const SAME_BYTES: f64 = 0.01;
/// How much longer the paper builds an MSSM at the least, of 1024² and 2048² texels: 15 and 21 times.
const LONGER: f64 = 5.0;

const HSM_TIME: Column = Column {
    name: "hsm_ms",
    plotted: true,
    of: |row| row.pass_ms("hsm"),
};
const MSSM_TIME: Column = Column {
    name: "mssm_ms",
    plotted: true,
    of: |row| row.pass_ms("mssm"),
};
const HSM_MIB: Column = Column {
    name: "hsm_mib",
    plotted: true,
    of: hsm_mib,
};
const MSSM_MIB: Column = Column {
    name: "mssm_mib",
    plotted: true,
    of: |row| row.bytes("mssm") / MIB,
};
const STORED_HSM_MIB: Column = Column {
    name: "hsm_stored_mib",
    plotted: false,
    of: |row| row.bytes("hsm") / MIB,
};

pub const TABLE1: Experiment = Experiment {
    name: "schwarz08-table1",
    source: "Schwarz and Stamminger 2008, table 1: construction time and memory of acceleration structures",
    paper: "on a GeForce 8800 GTX, 1024x1024: HSM 0.26 ms and 10.67 MB, MSSM 3.92 ms and 88 MB, YSM 0.46 ms and \
            14.67 MB; 2048x2048: HSM 0.87 ms and 42.67 MB, MSSM 18.65 ms and 384 MB, YSM 1.07 ms and 46.67 MB",
    claim: "MSSMs of more than 1024x1024 texels are too expensive to build and to keep; HSMs cost a fraction of both",
    here: "both structures of the same map of the built-in knot, from 256x256 to 4096x4096 texels. The MSSM is the \
           dual-grid one, both hold two 32-bit depths a node. hsm_mib counts level 0 as the paper does, which is the shadow map itself here and is stored once; hsm_stored_mib is what \
           is stored on top, in one image of half the map's width and all levels below each other",
    missing: "the YSM, which does not exist here yet",
    differs: "only as many levels of the MSSM are built as the kernels can ask for, while there is memory for all; a \
              CPU driver's caches see other costs than a GPU's memory",
    abscissa: "map",
    columns: &[
        HSM_TIME,
        MSSM_TIME,
        HSM_MIB,
        MSSM_MIB,
        STORED_HSM_MIB,
        ERROR_ASIDE,
    ],
    frames: 15,
    counters: false,
    takes_shots: false,
    trials: |scale, _| {
        let side = scale.pick(16, 32, 256);
        let all = [256, 512, 1024, 2048, 4096];
        let maps = scale.pick(&[64, 128][..], &all[..], &all[..]);
        let overrides = Overrides {
            size: Some((side, side)),
            ..Overrides::default()
        };
        let candidates = maps.iter().map(|&map| {
            let settings = Settings {
                map,
                ..Settings::usual(Technique::MicropatchHierarchical)
            };
            Candidate::new(SERIES, f64::from(map), settings)
        });
        Ok(vec![Trial {
            scene: "knot".into(),
            shot: Shot::built_in("knot", &overrides)?,
            truth: Truth::Rays,
            samples: 64,
            candidates: candidates.collect(),
        }])
    },
    judge,
};

/// [MiB] Of a min-max pyramid of two floats a texel: level 0, which is stored as one float here, and the levels that
/// are stored. Their image is half as wide as the map and as high, and has a third of its texels left over.
fn hsm_mib(row: &Row) -> f64 {
    let level_0 = 2.0 * row.bytes("shadow_map");
    let levels = row.bytes("hsm") * 2.0 / 3.0;
    (level_0 + levels) / MIB
}

fn judge(rows: &[Row]) -> Vec<Check> {
    let curve = |value| Curve::of(rows, only_scene(rows), SERIES, value);
    let (hsm, mssm) = (curve(HSM_TIME.of), curve(MSSM_TIME.of));
    let longer: Vec<f64> = mssm.0.iter().map(|p| p.1 / hsm.at(p.0)).collect();
    let (hsm_bytes, mssm_bytes) = (curve(HSM_MIB.of), curve(MSSM_MIB.of));
    let mut checks = vec![
        Check::new(
            "an MSSM takes at least five times as long to build as an HSM in every size (the paper's: 15 and 21 times)",
            format!("{} times", numbers(longer.iter().copied())),
            !longer.is_empty() && longer.iter().all(|&ratio| ratio >= LONGER),
        ),
        Check::new(
            "the ratio of the times grows with the map",
            format!(
                "from {} to {}",
                number(longer.first().copied().unwrap_or(f64::NAN)),
                number(longer.last().copied().unwrap_or(f64::NAN))
            ),
            longer.first() < longer.last(),
        ),
    ];
    for (map, hsm, mssm) in PAPER {
        let found = (hsm_bytes.at(map), mssm_bytes.at(map));
        let same = |found: f64, paper: f64| (found / paper - 1.0).abs() <= SAME_BYTES;
        if found.1.is_finite() {
            checks.push(Check::new(
                format!("an HSM and an MSSM of {map} texels take {hsm} and {mssm} MB"),
                format!("{} and {} MiB", number(found.0), number(found.1)),
                same(found.0, hsm) && same(found.1, mssm),
            ));
        }
    }
    checks
}
