//! `halfshade shaders`: what the passes of a shot cost as the driver compiles them.

use std::fmt::Write;

use halfshade::gpu::Limits;
use halfshade::plan::{Outputs, plan};
use halfshade::render::{PassCost, static_costs};
use halfshade::{Error, Result};

use super::calibration::Calibration;
use super::given::Given;
use super::print_notes;
use super::shot_args::{DeviceArgs, ShotArgs};

/// Prints what the driver says that each pass of a shot costs: registers, occupancy, spills, instructions.
///
/// Compiles and renders nothing, so that devices serve that can do no more, such as Mesa's RADV without hardware: with
/// VK_DRIVER_FILES naming its file, RADV_FORCE_FAMILY=navi21 stands for such a GPU. A pass stands as often as it differs in shaders or
/// constants, with the number of steps of a frame that run it so; numbers are called and counted as the driver does.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    shot: ShotArgs,
    #[command(flatten)]
    device: DeviceArgs,
    /// Print comma-separated values, all that the driver tells, instead of a table without what is 0 everywhere
    #[arg(long)]
    csv: bool,
}

/// # Errors
/// A flag's value is out of its range.
pub fn check(args: &Args) -> Result<()> {
    args.shot.check()
}

/// # Errors
/// When the shot can't be read, or the device does not tell.
pub fn run(args: &Args, given: &Given) -> Result<()> {
    args.device.with_costs(|gpu| {
        if !gpu.tells_costs() {
            return Err(Error::Unsupported(format!(
                "{} does not say what shaders cost: it lacks VK_KHR_pipeline_executable_properties, which Mesa's drivers for GPUs \
                 have",
                gpu.info.name
            )));
        }
        let shot = args.shot.load(&Calibration::of(&gpu.info), given)?;
        print_notes(&shot);
        let outputs = Outputs { picture: true };
        // Nothing is allocated.
        let limits = Limits {
            memory_bytes: u64::MAX,
            ..gpu.limits
        };
        let costs = static_costs(gpu, &plan(&shot, outputs, &limits)?)?;
        let table = Table::new(&costs);
        super::print(&if args.csv { table.csv() } else { table.text() })
    })
}

/// A row for each shader.
struct Table {
    columns: Vec<String>,
    rows: Vec<Row>,
}

struct Row {
    pass: &'static str,
    steps: usize,
    stage: String,
    /// One for each column; None: the driver does not tell this of such a shader.
    values: Vec<Option<f64>>,
}

impl Table {
    fn new(costs: &[PassCost]) -> Self {
        let mut columns: Vec<String> = Vec::new();
        let shaders = costs.iter().flat_map(|cost| &cost.shaders);
        for (name, _) in shaders.flat_map(|shader| &shader.statistics) {
            // What only tells shaders apart is no cost.
            let is_cost = !name.to_lowercase().contains("hash");
            if is_cost && !columns.contains(name) {
                columns.push(name.clone());
            }
        }
        let mut rows = Vec::new();
        for cost in costs {
            rows.extend(cost.shaders.iter().map(|shader| {
                let value = |column: &String| {
                    let found = shader.statistics.iter().find(|(name, _)| name == column);
                    found.map(|&(_, value)| value)
                };
                Row {
                    pass: cost.name,
                    steps: cost.steps,
                    stage: shader.stage.clone(),
                    values: columns.iter().map(value).collect(),
                }
            }));
        }
        Self { columns, rows }
    }

    /// Cells by row, the header first.
    fn cells(&self, columns: &[usize]) -> Vec<Vec<String>> {
        let header = ["pass", "steps", "shader"].map(str::to_owned).into_iter();
        let header = header.chain(columns.iter().map(|&column| self.columns[column].clone()));
        let row = |row: &Row| {
            let first = [
                row.pass.to_owned(),
                row.steps.to_string(),
                row.stage.clone(),
            ];
            let value =
                |&column: &usize| row.values[column].map_or(String::new(), |v| v.to_string());
            first.into_iter().chain(columns.iter().map(value)).collect()
        };
        let mut cells = vec![header.collect()];
        cells.extend(self.rows.iter().map(row));
        cells
    }

    fn csv(&self) -> String {
        let all: Vec<usize> = (0..self.columns.len()).collect();
        let lines = self.cells(&all).into_iter().map(|row| row.join(",") + "\n");
        lines.collect()
    }

    fn text(&self) -> String {
        let counts = |&column: &usize| {
            let values = self.rows.iter().filter_map(|row| row.values[column]);
            values.into_iter().any(|value| value != 0.0)
        };
        let columns: Vec<usize> = (0..self.columns.len()).filter(counts).collect();
        let cells = self.cells(&columns);
        let width = |column: usize| {
            let lengths = cells.iter().map(|row| row[column].chars().count());
            lengths.max().unwrap_or(0)
        };
        let widths: Vec<usize> = (0..cells[0].len()).map(width).collect();
        let mut text = String::new();
        for row in &cells {
            let mut line = String::new();
            for (column, (cell, width)) in row.iter().zip(&widths).enumerate() {
                // Writing to a string does not fail.
                let _ = match column {
                    0 | 2 => write!(line, "{cell:width$}  "),
                    _ => write!(line, "{cell:>width$}  "),
                };
            }
            let _ = writeln!(text, "{}", line.trim_end());
        }
        text
    }
}
