//! `halfshade calibrate`: which settings and constants of the cost model are fastest on this device.

mod bench;
mod table;

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use halfshade::Result;
use halfshade::calibrate::{Measured, Thoroughness, search_costs, winner};
use halfshade::gpu::Gpu;
use halfshade::shared::Costs;
use halfshade::technique::{Leaf, Mapping, Settings};

use self::bench::Bench;
use self::table::{rows, written};
use super::calibration::{Calibration, Row};
use super::shot_args::DeviceArgs;
use super::{on_interrupt, outputs, print};

/// Tunes packet, mapping, leaf rule and cost model for this device, and stores them for `render`.
///
/// Measures the GPU time of `classify` and the visibility passes. In three races: packets and mappings;
/// leaf rules of the best of them; then Q_e and Q_v of [Yang09 eq. 6] by a search in log space. A
/// challenger must beat what there is by more than the noise.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Shots to measure instead of the built-in colonnade, tree and grid
    shots: Vec<PathBuf>,
    #[command(flatten)]
    device: DeviceArgs,
    /// Measure and print, but store nothing
    #[arg(long)]
    dry_run: bool,
    /// A rough answer: small pictures, few candidates and rounds
    #[arg(long)]
    quick: bool,
    /// Try nothing further after this time [default: 300, or 8 with --quick]
    #[arg(long, value_name = "S", value_parser = clap::value_parser!(u64).range(1..=86400))]
    seconds: Option<u64>,
}

/// [pixel] Packet sizes, and how pixels map to invocations: the built-in default, then the likeliest first,
/// in case time runs out.
const LAYOUTS: [((u32, u32), Mapping); 13] = [
    (Settings::LOCAL, Mapping::Serial),
    ((4, 4), Mapping::Serial),
    ((4, 4), Mapping::Lanes),
    ((8, 4), Mapping::Serial),
    ((4, 2), Mapping::Serial),
    ((3, 3), Mapping::Serial),
    ((2, 2), Mapping::Serial),
    ((4, 2), Mapping::Lanes),
    ((8, 4), Mapping::Lanes),
    ((2, 2), Mapping::Lanes),
    ((8, 8), Mapping::Lanes),
    ((3, 3), Mapping::Lanes),
    ((8, 8), Mapping::Serial),
];
/// Layouts of `--quick`.
const QUICK_LAYOUTS: usize = 2;
/// Layouts this much slower than the best are not tried with the other leaf rule.
const HOPELESS: f64 = 1.3;

const ROUNDS: usize = 7;
const QUICK_ROUNDS: usize = 3;
const SEARCH: Thoroughness = Thoroughness {
    grid: 5,
    grid_rounds: 3,
    rounds: 7,
    races_max: 10,
};
const QUICK_SEARCH: Thoroughness = Thoroughness {
    grid: 3,
    grid_rounds: 1,
    rounds: 3,
    races_max: 2,
};

/// Shares of the time after which no further candidate is prepared, and races end with their round.
const LAYOUTS_READY: f64 = 0.25;
const LAYOUTS_RACED: f64 = 0.45;
const LEAVES_READY: f64 = 0.55;
const LEAVES_RACED: f64 = 0.65;

/// # Errors
/// A shot cannot be read or rendered, the device measures no time, the result cannot be stored, or Ctrl-C;
/// then the stored calibration is as it was.
pub fn run(args: &Args) -> Result<()> {
    let interrupted = on_interrupt()?;
    args.device
        .with_device(|gpu| calibrate(args, gpu, &interrupted))
}

fn calibrate(args: &Args, gpu: &Arc<Gpu>, interrupted: &AtomicBool) -> Result<()> {
    let budget = Duration::from_secs(args.seconds.unwrap_or(if args.quick { 8 } else { 300 }));
    let mut bench = Bench::new(gpu, &args.shots, args.quick, budget, interrupted)?;
    let stored = Calibration::file(&gpu.info).filter(|_| !args.dry_run);
    outputs::check_read(stored.as_deref(), &bench.files())?;
    let mut measured = Vec::new();
    let chosen = tune(&mut bench, args.quick, &mut measured)?;
    let what = bench.describe();
    drop(bench);
    print(&format!(
        "{} ({}): {what}\n{}\n",
        gpu.info.name,
        gpu.info.driver,
        written(&measured, &chosen)
    ))?;
    if args.dry_run {
        return print("not stored (--dry-run)\n");
    }
    let file = chosen.store(&gpu.info, measured)?;
    print(&format!("stored in {}\n", file.display()))
}

/// The races, one after the other; each starts from what the last one chose.
fn tune(bench: &mut Bench, quick: bool, measured: &mut Vec<Row>) -> Result<Calibration> {
    let rounds = if quick { QUICK_ROUNDS } else { ROUNDS };
    bench.say("packets and mappings");
    let layouts = if quick {
        &LAYOUTS[..QUICK_LAYOUTS]
    } else {
        &LAYOUTS
    };
    let candidates = layouts.iter().map(|&(packet, mapping)| Calibration {
        packet,
        mapping,
        leaf: Leaf::PerPixel,
        ..Calibration::default()
    });
    // The path without packets is a yardstick, not a candidate: --packet 1x1 asks for it.
    let mut ready = prepared(bench, candidates, LAYOUTS_READY)?;
    let yardstick = Calibration {
        packet: (1, 1),
        ..ready[0]
    };
    bench.prepare(&yardstick)?;
    ready.push(yardstick);
    let mut layouts = bench.race(&ready, rounds, LAYOUTS_RACED)?;
    measured.extend(rows("packet and mapping", &layouts));
    layouts.pop();
    let mut chosen = layouts[winner(&layouts)].candidate;

    bench.say("leaf rules");
    let leaves = with_both_leaf_rules(&chosen, &layouts);
    let ready = prepared(bench, leaves.into_iter(), LEAVES_READY)?;
    let leaves = bench.race(&ready, rounds, LEAVES_RACED)?;
    measured.extend(rows("leaf rule", &leaves));
    chosen = leaves[winner(&leaves)].candidate;

    bench.say("cost model");
    let costs = search(bench, quick, &chosen, measured)?;
    Ok(Calibration {
        edge_cost: costs.edge,
        visibility_cost: costs.visibility,
        ..chosen
    })
}

/// Those of the candidates that the device can do and for which there is time until `share` of it is
/// spent, at least the first.
fn prepared(
    bench: &mut Bench,
    candidates: impl Iterator<Item = Calibration>,
    share: f64,
) -> Result<Vec<Calibration>> {
    let mut ready = Vec::new();
    for candidate in candidates {
        if !ready.is_empty() && !bench.has_time(share) {
            break;
        }
        bench.prepare(&candidate)?;
        ready.push(candidate);
    }
    Ok(ready)
}

/// The chosen candidate first, then those that it did not leave far behind, best first, each with either
/// leaf rule.
fn with_both_leaf_rules(
    chosen: &Calibration,
    layouts: &[Measured<Calibration>],
) -> Vec<Calibration> {
    let best = layouts.iter().map(Measured::median);
    let limit = best.fold(f64::INFINITY, f64::min) * HOPELESS;
    let mut hopeful: Vec<_> = (layouts.iter())
        .filter(|layout| layout.median() <= limit && layout.candidate != *chosen)
        .collect();
    hopeful.sort_by(|a, b| a.median().total_cmp(&b.median()));
    let others = hopeful.into_iter().map(|layout| layout.candidate);
    std::iter::once(*chosen)
        .chain(others)
        .flat_map(|candidate| {
            [Leaf::PerPixel, Leaf::Reprocess].map(|leaf| Calibration { leaf, ..candidate })
        })
        .collect()
}

fn search(
    bench: &mut Bench,
    quick: bool,
    chosen: &Calibration,
    measured: &mut Vec<Row>,
) -> Result<Costs> {
    let at = |costs: &Costs| Calibration {
        edge_cost: costs.edge,
        visibility_cost: costs.visibility,
        ..*chosen
    };
    let thoroughness = if quick { QUICK_SEARCH } else { SEARCH };
    let bench = std::cell::RefCell::new(bench);
    let found = search_costs(
        chosen.costs(),
        thoroughness,
        &|| bench.borrow().has_time(1.0),
        &mut |costs| bench.borrow_mut().measure(&at(costs)),
    )?;
    for (index, race) in found.races.iter().enumerate() {
        let race: Vec<_> = (race.iter())
            .map(|point| Measured {
                candidate: at(&point.candidate),
                costs: point.costs.clone(),
            })
            .collect();
        measured.extend(rows(&format!("cost model {}", index + 1), &race));
    }
    Ok(found.costs)
}
