//! What calibration measured, as a table.

use halfshade::calibrate::Measured;

use super::super::calibration::{Calibration, Row};

/// The lines of a race, which is not empty, the fastest first.
pub fn rows(race: &str, measured: &[Measured<Calibration>]) -> Vec<Row> {
    let best = measured.iter().map(Measured::median);
    let best = best.fold(f64::INFINITY, f64::min);
    let mut rows: Vec<Row> = (measured.iter())
        .map(|entry| Row {
            race: race.into(),
            candidate: entry.candidate,
            rounds: entry.costs.len(),
            median_ms: entry.median(),
            spread_ms: entry.spread(),
            ratio: entry.median() / best,
        })
        .collect();
    rows.sort_by(|a, b| a.ratio.total_cmp(&b.ratio));
    rows
}

/// The table and the result, for a terminal.
pub fn written(rows: &[Row], chosen: &Calibration) -> String {
    let mut lines = vec![format!(
        "{:<20} {:<10} {:<7} {:<10} {:>8} {:>8} {:>10} {:>9} {:>6}",
        "race", "packet", "mapping", "leaf", "Q_e", "Q_v", "median ms", "spread ms", "ratio"
    )];
    for row in rows {
        let Calibration { packet, .. } = row.candidate;
        let (name, mapping, leaf) = match packet {
            (1, 1) => ("no packets".to_owned(), "-", "-"),
            _ => (
                format!("{}x{}", packet.0, packet.1),
                row.candidate.mapping.name(),
                row.candidate.leaf.name(),
            ),
        };
        lines.push(format!(
            "{:<20} {name:<10} {mapping:<7} {leaf:<10} {:>8.3} {:>8.3} {:>10.3} {:>9.3} {:>6.3}",
            row.race,
            row.candidate.edge_cost,
            row.candidate.visibility_cost,
            row.median_ms,
            row.spread_ms,
            row.ratio
        ));
    }
    lines.push(format!(
        "chosen: packet {}x{}, mapping {}, leaf {}, Q_e {:.3}, Q_v {:.3}",
        chosen.packet.0,
        chosen.packet.1,
        chosen.mapping,
        chosen.leaf,
        chosen.edge_cost,
        chosen.visibility_cost
    ));
    lines.join("\n")
}
