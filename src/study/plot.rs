//! Plots: error against time, log–log, a panel for each shot and device.

use plotters::coord::Shift;
use plotters::prelude::*;

use crate::technique::Technique;
use crate::{Error, Result};

use super::front::{error, front, time};
use super::run::{Measured, Run};

/// [pixel] Of a panel.
const PANEL: (u32, u32) = (640, 440);
/// [pixel] Of a line of the legend above all panels, which begins with a title.
const LEGEND_LINE: i32 = 24;
const LEGEND_TITLE: i32 = 32;
/// Panels side by side.
const COLUMNS: usize = 2;
/// Errors and times below are drawn there: a logarithm has no zero.
const ERROR_MIN: f64 = 1e-5;
const MS_MIN: f64 = 1e-4;

/// Colours that are told apart by the colour-blind (Paul Tol's "muted"), over and over.
pub(super) fn muted(index: usize) -> RGBColor {
    const COLORS: [(u8, u8, u8); 11] = [
        (204, 51, 17),
        (51, 34, 136),
        (136, 204, 238),
        (68, 170, 153),
        (17, 119, 51),
        (153, 153, 51),
        (204, 102, 119),
        (136, 34, 85),
        (120, 120, 120),
        (221, 204, 119),
        (170, 68, 153),
    ];
    let (red, green, blue) = COLORS[index % COLORS.len()];
    RGBColor(red, green, blue)
}

fn color(technique: Technique) -> RGBColor {
    let index = Technique::ALL.iter().position(|&other| other == technique);
    muted(index.unwrap_or(0))
}

pub(super) type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// Error over shadow pixels against the time of the shadow passes, every measured run a dot, the front a line.
///
/// # Errors
/// A plot cannot be drawn.
pub(super) fn pareto(runs: &[Run]) -> Result<String> {
    let mut panels: Vec<(String, Vec<&Run>)> = Vec::new();
    for run in runs {
        let title = format!("{}, {}", run.shot, run.machine.device);
        match panels.iter_mut().find(|(known, _)| *known == title) {
            Some((_, panel)) => panel.push(run),
            None => panels.push((title, vec![run])),
        }
    }
    let columns = COLUMNS.min(panels.len()).max(1);
    let rows = panels.len().div_ceil(columns).max(1);
    let width = PANEL.0 * columns as u32;
    let legend = legend(runs, width as i32);
    let legend_height = legend.last().map_or(0, |entry| entry.y) + LEGEND_LINE;
    let size = (width, legend_height as u32 + PANEL.1 * rows as u32);
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, size).into_drawing_area();
        root.fill(&WHITE).map_err(failed)?;
        let (above, below) = root.split_vertically(legend_height);
        draw_legend(&above, &legend)?;
        for (area, (title, panel)) in below.split_evenly((rows, columns)).iter().zip(&panels) {
            draw_panel(area, title, panel)?;
        }
        root.present().map_err(failed)?;
    }
    Ok(svg)
}

pub(super) fn failed<E: std::fmt::Display>(error: E) -> Error {
    Error::Invalid(format!("a plot cannot be drawn: {error}"))
}

/// A technique in the legend and where it stands.
struct Entry {
    technique: Technique,
    x: i32,
    y: i32,
}

/// The techniques that were run, in lines of a width in pixels.
fn legend(runs: &[Run], width: i32) -> Vec<Entry> {
    let used =
        |technique: &&Technique| runs.iter().any(|run| run.settings.technique == **technique);
    let (mut x, mut y) = (18, LEGEND_TITLE);
    let place = |&technique: &Technique| {
        let needed = 30 + 8 * technique.name().len() as i32;
        if x + needed > width {
            (x, y) = (18, y + LEGEND_LINE);
        }
        x += needed;
        Entry {
            technique,
            x: x - needed,
            y,
        }
    };
    Technique::ALL.iter().filter(used).map(place).collect()
}

fn draw_legend(area: &Area, legend: &[Entry]) -> Result<()> {
    let font = ("sans-serif", 13).into_font();
    let title = "Error against time: mean absolute error over shadow pixels, GPU time of the shadow passes; line: the front";
    area.draw(&Text::new(title, (12, 8), font.clone()))
        .map_err(failed)?;
    for &Entry { technique, x, y } in legend {
        let dot = Circle::new((x, y + 7), 5, color(technique).filled());
        area.draw(&dot).map_err(failed)?;
        area.draw(&Text::new(technique.name(), (x + 10, y), font.clone()))
            .map_err(failed)?;
    }
    Ok(())
}

fn draw_panel(area: &Area, title: &str, runs: &[&Run]) -> Result<()> {
    let points: Vec<(&Run, (f64, f64))> = runs
        .iter()
        .filter_map(|run| Some((*run, point(run.measured()?))))
        .collect();
    let range = |pick: fn(&(f64, f64)) -> f64| {
        let values = points.iter().map(|(_, point)| pick(point));
        let (low, high) = values.fold((f64::INFINITY, 0.0f64), |(low, high), value| {
            (low.min(value), high.max(value))
        });
        // At least a decade, so that the axis has numbers.
        let spare = (10.0 / (high / low)).sqrt().max(1.5);
        match low.is_finite() {
            true => low / spare..high * spare,
            false => 0.1..10.0,
        }
    };
    let (times, errors) = (range(|point| point.0), range(|point| point.1));
    let mut chart = ChartBuilder::on(area)
        .caption(title, ("sans-serif", 15))
        .margin(12)
        .x_label_area_size(40)
        .y_label_area_size(64)
        .build_cartesian_2d(times.log_scale(), errors.log_scale())
        .map_err(failed)?;
    chart
        .configure_mesh()
        .x_desc("time of the shadow passes [ms]")
        .y_desc("mean absolute error, shadow pixels")
        .y_labels(16)
        .x_label_formatter(&|ms| short(*ms))
        .y_label_formatter(&|error| short(*error))
        .light_line_style(RGBColor(240, 240, 240))
        .draw()
        .map_err(failed)?;
    let line = steps(
        front(runs.iter().copied())
            .iter()
            .filter_map(|run| run.measured()),
    );
    chart
        .draw_series(LineSeries::new(line, BLACK.stroke_width(1)))
        .map_err(failed)?;
    let dots = points
        .iter()
        .map(|(run, point)| Circle::new(*point, 4, color(run.settings.technique).filled()));
    chart.draw_series(dots).map_err(failed)?;
    Ok(())
}

/// The front as a line: until the next run there is nothing better than the last one.
fn steps<'a>(front: impl Iterator<Item = &'a Measured>) -> Vec<(f64, f64)> {
    let mut line: Vec<(f64, f64)> = Vec::new();
    for next in front.map(point) {
        if let Some(&(_, error)) = line.last() {
            line.push((next.0, error));
        }
        line.push(next);
    }
    line
}

fn point(measured: &Measured) -> (f64, f64) {
    (time(measured).max(MS_MIN), error(measured).max(ERROR_MIN))
}

/// A number in as few characters as tell it from its neighbours on a logarithmic axis.
pub(super) fn short(value: f64) -> String {
    let digits = (1.0 - value.abs().max(1e-9).log10().floor()).clamp(0.0, 6.0) as usize;
    let text = format!("{value:.digits$}");
    match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    }
}
