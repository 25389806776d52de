//! The Pareto front: what nothing else beats in both error and time.

use super::run::{Measured, Run};

/// The runs that no other run of `runs` equals or beats in both shadow time and error while being better in one, the
/// fastest first. Error: mean absolute error over shadow pixels; time: median of the shadow passes.
pub fn front<'a>(runs: impl IntoIterator<Item = &'a Run>) -> Vec<&'a Run> {
    let mut all: Vec<(&Run, f64, f64)> = runs
        .into_iter()
        .filter_map(|run| {
            run.measured()
                .map(|measured| (run, time(measured), error(measured)))
        })
        .collect();
    all.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.2.total_cmp(&b.2)));
    let mut front: Vec<&Run> = Vec::new();
    let mut best = f64::INFINITY;
    for (run, _, error) in all {
        if error < best {
            best = error;
            front.push(run);
        }
    }
    front
}

/// [ms] The time by which runs are compared.
pub(super) fn time(measured: &Measured) -> f64 {
    measured.shadow_ms.median
}

/// The error by which runs are compared.
pub(super) fn error(measured: &Measured) -> f64 {
    measured.errors.metrics.mae_shadow
}
