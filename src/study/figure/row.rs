//! What was measured, a point of a curve each.

use serde::Serialize;

use super::super::run::{Measured, Run};
use crate::compare::Metrics;

/// A point of a curve.
#[derive(Debug, Clone, Serialize)]
pub struct Row {
    pub scene: String,
    pub series: String,
    /// See `Experiment::abscissa`.
    pub x: f64,
    pub run: Run,
}

/// A figure of a row.
#[derive(Debug)]
pub struct Column {
    /// With its unit.
    pub name: &'static str,
    /// Whether a plot shows it.
    pub plotted: bool,
    /// NaN: it was not measured.
    pub of: fn(&Row) -> f64,
}

/// Mean absolute error of the visibility over shadow pixels.
pub const ERROR: Column = Column {
    name: "mae_shadow",
    plotted: true,
    of: Row::error,
};
/// The same where it is not what the figure is about.
pub const ERROR_ASIDE: Column = Column {
    plotted: false,
    ..ERROR
};
pub const SHADOW_PIXELS: Column = Column {
    name: "shadow_pixels",
    plotted: false,
    of: |row| row.of(|measured| measured.errors.metrics.shadow_pixels as f64),
};
/// Median of the frames, and their extremes.
pub const TIME: Column = Column {
    name: "shadow_ms",
    plotted: true,
    of: Row::ms,
};
pub const TIME_ASIDE: Column = Column {
    plotted: false,
    ..TIME
};
pub const TIME_MIN: Column = Column {
    name: "shadow_ms_min",
    plotted: false,
    of: |row| row.of(|measured| measured.shadow_ms.min),
};
pub const TIME_MAX: Column = Column {
    name: "shadow_ms_max",
    plotted: false,
    of: |row| row.of(|measured| measured.shadow_ms.max),
};

impl Row {
    fn of(&self, value: impl Fn(&Measured) -> f64) -> f64 {
        self.run.measured().map_or(f64::NAN, value)
    }

    /// Of the errors of its visibility.
    pub(super) fn metrics(&self, value: impl Fn(&Metrics) -> f64) -> f64 {
        self.of(|measured| value(&measured.errors.metrics))
    }

    pub fn error(&self) -> f64 {
        self.of(|measured| measured.errors.metrics.mae_shadow)
    }

    /// [ms] Of the shadow passes.
    pub fn ms(&self) -> f64 {
        self.of(|measured| measured.shadow_ms.median)
    }

    /// [ms] The whole frame.
    pub fn frame_ms(&self) -> f64 {
        self.of(|measured| measured.total_ms.median)
    }

    /// [ms] Of one pass, summed over a frame.
    pub fn pass_ms(&self, pass: &str) -> f64 {
        self.of(|measured| measured.passes.get(pass).map_or(f64::NAN, |ms| ms.median))
    }

    /// [ms] Of the passes that integrate visibility.
    pub fn visibility_ms(&self) -> f64 {
        self.of(|measured| measured.visibility_ms.median)
    }

    /// What the device counted.
    pub fn count(&self, counter: &str) -> f64 {
        self.of(|measured| {
            let count = measured.counters.get(counter);
            count.map_or(f64::NAN, |&count| count as f64)
        })
    }

    /// What the device counted, per pixel that is integrated in a view.
    pub fn per_penumbra_pixel(&self, counter: &str) -> f64 {
        self.count(counter) / self.count("penumbra")
    }

    /// [byte] Of one of the frame's resources.
    pub fn bytes(&self, resource: &str) -> f64 {
        self.of(|measured| {
            let bytes = measured.resources.get(resource);
            bytes.map_or(f64::NAN, |&bytes| bytes as f64)
        })
    }
}

/// What the rows are called by, each once, in their order.
pub(super) fn distinct(rows: &[Row], name: fn(&Row) -> &String) -> Vec<&str> {
    let mut names: Vec<&str> = Vec::new();
    for row in rows {
        if !names.contains(&name(row).as_str()) {
            names.push(name(row));
        }
    }
    names
}

/// The scene of rows that all have the same; none without rows.
pub(super) fn only_scene(rows: &[Row]) -> &str {
    rows.first().map_or("", |row| &row.scene)
}

/// The points of a curve, x ascending; what was not measured is left out.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve(pub Vec<(f64, f64)>);

impl Curve {
    /// The rows of a series on a scene, by one of their figures.
    pub fn of(rows: &[Row], scene: &str, series: &str, value: fn(&Row) -> f64) -> Self {
        let own = rows
            .iter()
            .filter(|row| row.scene == scene && row.series == series);
        let points = own.map(|row| (row.x, value(row)));
        let mut points: Vec<_> = points.filter(|point| point.1.is_finite()).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        Self(points)
    }

    /// NaN: there is no point at this x.
    pub fn at(&self, x: f64) -> f64 {
        let point = self.0.iter().find(|point| point.0 == x);
        point.map_or(f64::NAN, |point| point.1)
    }

    /// The value at the smallest x; NaN without points.
    pub fn first(&self) -> f64 {
        self.0.first().map_or(f64::NAN, |point| point.1)
    }

    /// The value at the largest x; NaN without points.
    pub fn last(&self) -> f64 {
        self.0.last().map_or(f64::NAN, |point| point.1)
    }

    /// The points with `low` ≤ x ≤ `high`.
    pub fn within(&self, low: f64, high: f64) -> Self {
        let points = self.0.iter().copied();
        Self(points.filter(|p| (low..=high).contains(&p.0)).collect())
    }

    /// The point of the least value.
    pub fn lowest(&self) -> Option<(f64, f64)> {
        let points = self.0.iter().copied();
        points.min_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// [−1, 1] Kendall's τ: the share of pairs of points that rise, less those that fall; NaN for less than two.
    pub fn trend(&self) -> f64 {
        let (mut sum, mut pairs) = (0.0, 0.0);
        for (index, before) in self.0.iter().enumerate() {
            for after in &self.0[index + 1..] {
                let rise = after.1 - before.1;
                sum += if rise == 0.0 { 0.0 } else { rise.signum() };
                pairs += 1.0;
            }
        }
        sum / pairs
    }

    /// The exponent p of the power law y ~ xᵖ that fits best (least squares of the logarithms); NaN for less than two
    /// points.
    pub fn power(&self) -> f64 {
        let count = self.0.len() as f64;
        let logs: Vec<(f64, f64)> = self.0.iter().map(|p| (p.0.ln(), p.1.ln())).collect();
        let mean = |pick: fn(&(f64, f64)) -> f64| logs.iter().map(pick).sum::<f64>() / count;
        let (x, y) = (mean(|p| p.0), mean(|p| p.1));
        let products: f64 = logs.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
        let squares: f64 = logs.iter().map(|p| (p.0 - x).powi(2)).sum();
        products / squares
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn trends_and_powers_by_hand() {
        let falls = Curve(vec![(1.0, 8.0), (2.0, 4.0), (4.0, 2.0)]);
        assert_eq!(falls.trend(), -1.0);
        assert!((falls.power() + 1.0).abs() < 1e-12);
        // Two pairs rise, one falls.
        assert_eq!(
            Curve(vec![(1.0, 1.0), (2.0, 3.0), (3.0, 2.0)]).trend(),
            1.0 / 3.0
        );
        assert_eq!(falls.lowest(), Some((4.0, 2.0)));
        assert_eq!(
            (falls.first(), falls.last(), falls.at(2.0)),
            (8.0, 2.0, 4.0)
        );
        assert_eq!(falls.within(1.5, 3.0).0, [(2.0, 4.0)]);
        assert!(Curve(vec![]).trend().is_nan() && Curve(vec![]).power().is_nan());
    }
}
