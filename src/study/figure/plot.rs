//! Plots of curves: a row of panels for each figure, a panel for each scene.

use std::ops::Range;

use plotters::prelude::*;

use crate::Result;

use super::super::plot::{Area, failed, muted, short};
use super::row::distinct;
use super::{Column, Experiment, Row};

/// [pixel] Of a panel, and of a line of the legend.
const PANEL: (u32, u32) = (460, 320);
const LINE: i32 = 20;
/// [pixel] Of the plot, so that its title has room.
const WIDTH_MIN: u32 = 760;
/// How many times the smallest value the largest is where an axis is logarithmic.
const X_WIDE: f64 = 4.0;
const Y_WIDE: f64 = 20.0;

/// The plotted columns of all rows as an SVG, axes logarithmic where the values span much.
///
/// # Errors
/// It cannot be drawn.
pub fn curves(experiment: &Experiment, rows: &[Row]) -> Result<String> {
    let scenes = distinct(rows, |row| &row.scene);
    let series = distinct(rows, |row| &row.series);
    let plotted = || experiment.columns.iter().filter(|column| column.plotted);
    let legend = LINE as u32 * (series.len() as u32 + 2);
    let size = (
        (PANEL.0 * scenes.len() as u32).max(WIDTH_MIN),
        legend + PANEL.1 * plotted().count() as u32,
    );
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, size).into_drawing_area();
        root.fill(&WHITE).map_err(failed)?;
        let (head, mut below) = root.split_vertically(legend);
        draw_legend(&head, experiment, &series)?;
        for column in plotted() {
            let (line, rest) = below.split_vertically(PANEL.1);
            below = rest;
            let areas = line.split_evenly((1, scenes.len().max(1)));
            for (area, scene) in areas.iter().zip(&scenes) {
                draw_panel(area, experiment, column, scene, &series, rows)?;
            }
        }
        root.present().map_err(failed)?;
    }
    Ok(svg)
}

fn draw_legend(area: &Area, experiment: &Experiment, series: &[&str]) -> Result<()> {
    let font = ("sans-serif", 13).into_font();
    let title = format!("{}: {}", experiment.name, experiment.source);
    area.draw(&Text::new(title, (12, 6), font.clone()))
        .map_err(failed)?;
    for (index, name) in series.iter().enumerate() {
        let y = LINE * (index as i32 + 1) + 10;
        let dot = Circle::new((18, y + 6), 5, muted(index).filled());
        area.draw(&dot).map_err(failed)?;
        area.draw(&Text::new((*name).to_owned(), (30, y), font.clone()))
            .map_err(failed)?;
    }
    Ok(())
}

/// An axis: the logarithm to this base of all values, or the values themselves.
#[derive(Clone, Copy)]
struct Axis(Option<f64>);

impl Axis {
    /// Logarithmic where all values are more than 0 and the largest is at least `wide` times the smallest.
    fn of(values: impl Iterator<Item = f64>, base: f64, wide: f64) -> Self {
        let (low, high) = extremes(values);
        Self((low > 0.0 && high >= wide * low).then_some(base))
    }

    fn place(self, value: f64) -> f64 {
        self.0.map_or(value, |base| value.log(base))
    }

    fn label(self, place: f64) -> String {
        short(self.0.map_or(place, |base| base.powf(place)))
    }

    /// Around all places, with some air; from 0 on where the values themselves are placed.
    fn range(self, values: impl Iterator<Item = f64>) -> Range<f64> {
        let (low, high) = extremes(values.map(|value| self.place(value)));
        let low = if self.0.is_none() { low.min(0.0) } else { low };
        let air = 0.06 * (high - low).max(1e-9);
        match low.is_finite() {
            true if self.0.is_none() && low == 0.0 => 0.0..high + air,
            true => low - air..high + air,
            false => 0.0..1.0,
        }
    }
}

/// (∞, −∞) without values.
fn extremes(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
        (low.min(value), high.max(value))
    })
}

fn draw_panel(
    area: &Area,
    experiment: &Experiment,
    column: &Column,
    scene: &str,
    series: &[&str],
    rows: &[Row],
) -> Result<()> {
    let points = |series: &str| -> Vec<(f64, f64)> {
        let own = rows
            .iter()
            .filter(|row| row.scene == scene && row.series == series);
        let points = own.map(|row| (row.x, (column.of)(row)));
        points.filter(|point| point.1.is_finite()).collect()
    };
    let all: Vec<(f64, f64)> = series.iter().flat_map(|name| points(name)).collect();
    let (xs, ys) = (all.iter().map(|p| p.0), all.iter().map(|p| p.1));
    let (x, y) = (
        Axis::of(xs.clone(), 2.0, X_WIDE),
        Axis::of(ys.clone(), 10.0, Y_WIDE),
    );
    let mut chart = ChartBuilder::on(area)
        .caption(scene, ("sans-serif", 14))
        .margin(10)
        .x_label_area_size(36)
        .y_label_area_size(60)
        .build_cartesian_2d(x.range(xs), y.range(ys))
        .map_err(failed)?;
    chart
        .configure_mesh()
        .x_desc(experiment.abscissa)
        .y_desc(column.name)
        .x_label_formatter(&|place| x.label(*place))
        .y_label_formatter(&|place| y.label(*place))
        .light_line_style(RGBColor(240, 240, 240))
        .draw()
        .map_err(failed)?;
    for (index, name) in series.iter().enumerate() {
        let mut line: Vec<(f64, f64)> = points(name)
            .into_iter()
            .map(|point| (x.place(point.0), y.place(point.1)))
            .collect();
        line.sort_by(|a, b| a.0.total_cmp(&b.0));
        let dots = line
            .iter()
            .map(|&p| Circle::new(p, 3, muted(index).filled()));
        chart.draw_series(dots).map_err(failed)?;
        chart
            .draw_series(LineSeries::new(line, muted(index).stroke_width(2)))
            .map_err(failed)?;
    }
    Ok(())
}
