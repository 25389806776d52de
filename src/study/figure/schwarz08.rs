//! [Schwarz08]: what acceleration structures cost.

use super::check::{CLEAR, Check, all, number, numbers};
use super::row::{Curve, ERROR_ASIDE};
use super::{Candidate, Column, Experiment, Row, Trial, Truth};
use crate::Result;
use crate::shot::{Overrides, Shot};
use crate::technique::{Hierarchy, Settings, Technique};

const MIB: f64 = 1024.0 * 1024.0;
/// A built-in shot whose kernels need all levels.
const SCENE: &str = "grid";
const HSM: &str = "HSM";
const YSM: &str = "YSM";
const MSSM: &str = "MSSM";
/// Name, density, bits of a bound.
const STRUCTURES: [(&str, Hierarchy, u32); 6] = [
    (HSM, Hierarchy::Hsm, 32),
    (YSM, Hierarchy::Ysm, 32),
    (MSSM, Hierarchy::Mssm, 32),
    ("MSSM, 16-bit bounds", Hierarchy::Mssm, 16),
    ("graded", Hierarchy::Graded, 32),
    ("graded, 16-bit bounds", Hierarchy::Graded, 16),
];
/// How much longer an MSSM takes to build and how many more bytes, at the least: 15 and 21 times the time and 8.2 and 9 times
/// the bytes of an HSM in the paper, 8.5 and 17 times the time and 6 and 8.2 times the bytes of a YSM.
const LONGER: f64 = 4.0;
const LARGER: f64 = 4.0;

const BUILD_TIME: Column = Column {
    name: "build_ms",
    plotted: true,
    of: |row| row.pass_ms("hierarchy"),
};
const BYTES: Column = Column {
    name: "mib",
    plotted: true,
    of: |row| row.bytes("hierarchy") / MIB,
};

pub const TABLE1: Experiment = Experiment {
    name: "schwarz08-table1",
    source: "Schwarz and Stamminger 2008, table 1: construction time and memory of acceleration structures",
    paper: "on a GeForce 8800 GTX, 1024x1024: HSM 0.26 ms and 10.67 MB, MSSM 3.92 ms and 88 MB, YSM 0.46 ms and \
            14.67 MB; 2048x2048: HSM 0.87 ms and 42.67 MB, MSSM 18.65 ms and 384 MB, YSM 1.07 ms and 46.67 MB",
    claim: "MSSMs of more than 1024x1024 texels are too expensive to build and to keep; HSMs and YSMs cost a fraction of \
            both",
    here: "one hierarchy over the dual grid, with nodes as dense as an HSM, a YSM whose coarse map has 256x256 texels and \
           an MSSM have them, and graded ones; the built-in grid, whose kernels need all levels; maps from 256x256 to \
           4096x4096 texels. mib is what is allocated; where nodes of several spacings share an image, up to an eighth of \
           it is left over",
    missing: "",
    differs: "a CPU driver's caches see other costs than a GPU's memory, and it builds small upper levels one after the \
              other for little more than their start, which weighs on small maps; hierarchies end two levels below the \
              one that covers the map, so that an MSSM of 1024x1024 takes 72 MiB instead of 88; the pyramid \
              of the YSM ends where its coarse map begins",
    abscissa: "map",
    columns: &[BUILD_TIME, BYTES, ERROR_ASIDE],
    frames: 15,
    counters: false,
    takes_shots: false,
    trials: |scale, _| {
        let all = [256, 512, 1024, 2048, 4096];
        let maps = scale.pick(&[64, 128][..], &all[..], &all[..]);
        Ok(vec![trial(maps)?])
    },
    judge,
};

fn trial(maps: &[u32]) -> Result<Trial> {
    // Pixels matter to nothing here but to how many levels the largest kernel needs.
    let overrides = Overrides {
        size: Some((16, 16)),
        ..Overrides::default()
    };
    let candidates = maps.iter().flat_map(|&map| {
        STRUCTURES
            .into_iter()
            .map(move |(series, hierarchy, mssm_bits)| {
                let settings = Settings {
                    map,
                    hierarchy,
                    mssm_bits,
                    split: 1,
                    ..Settings::published(Technique::PacketContour)
                };
                Candidate::new(series, f64::from(map), settings)
            })
    });
    Ok(Trial {
        scene: SCENE.into(),
        shot: Shot::built_in(SCENE, &overrides)?,
        truth: Truth::Rays,
        samples: 64,
        candidates: candidates.collect(),
    })
}

/// An MSSM's values over those of another structure, by map.
fn times_as_much(rows: &[Row], other: &str, value: fn(&Row) -> f64) -> Curve {
    let of = |series| Curve::of(rows, SCENE, series, value);
    let (mssm, other) = (of(MSSM), of(other));
    let ratios = mssm.0.iter().map(|p| (p.0, p.1 / other.at(p.0)));
    Curve(ratios.collect())
}

fn judge(rows: &[Row]) -> Vec<Check> {
    let mut checks = Vec::new();
    for (other, paper_times, paper_bytes) in [
        (HSM, "15 and 21", "8.2 and 9"),
        (YSM, "8.5 and 17", "6 and 8.2"),
    ] {
        let longer = times_as_much(rows, other, BUILD_TIME.of).within(1024.0, f64::MAX);
        let times: Vec<f64> = longer.0.iter().map(|p| p.1).collect();
        checks.push(Check::new(
            format!(
                "from 1024x1024 texels on, an MSSM takes at least {LONGER} times as long to build as a {other} \
                 ({paper_times} times in the paper)"
            ),
            format!("{} times", numbers(times.iter().copied())),
            all(&times, |ratio| ratio >= LONGER),
        ));
        let larger = times_as_much(rows, other, BYTES.of).within(1024.0, f64::MAX);
        let bytes: Vec<f64> = larger.0.iter().map(|p| p.1).collect();
        checks.push(Check::new(
            format!("and at least {LARGER} times as many bytes ({paper_bytes} times in the paper)"),
            format!("{} times", numbers(bytes.iter().copied())),
            all(&bytes, |ratio| ratio >= LARGER),
        ));
    }
    let longer = times_as_much(rows, HSM, BUILD_TIME.of);
    checks.push(Check::new(
        "the larger the map, the more times as long as an HSM (τ ≥ 0.6)",
        format!("τ = {}", number(longer.trend())),
        longer.trend() >= CLEAR,
    ));
    checks
}
