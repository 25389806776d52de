//! The settings to use: fastest within an error, or least wrong within a time.

use super::front::{error, time};
use super::run::{Measured, Run};

/// What is wanted of settings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Goal {
    /// The least time with at most this mean absolute error over shadow pixels.
    MaxError(f64),
    /// The least error with at most this many ms of shadow passes.
    MaxMs(f64),
}

impl Goal {
    fn allows(self, measured: &Measured) -> bool {
        match self {
            Self::MaxError(limit) => error(measured) <= limit,
            Self::MaxMs(limit) => time(measured) <= limit,
        }
    }

    /// What is to be small.
    fn cost(self, measured: &Measured) -> f64 {
        match self {
            Self::MaxError(_) => time(measured),
            Self::MaxMs(_) => error(measured),
        }
    }
}

/// The runs that reach the goal, the best first.
pub fn best(runs: &[Run], goal: Goal) -> Vec<&Run> {
    let mut reached: Vec<(&Run, f64)> = runs
        .iter()
        .filter_map(|run| Some((run, run.measured()?)))
        .filter(|(_, measured)| goal.allows(measured))
        .map(|(run, measured)| (run, goal.cost(measured)))
        .collect();
    reached.sort_by(|a, b| a.1.total_cmp(&b.1));
    reached.into_iter().map(|(run, _)| run).collect()
}
