//! `halfshade plan`: what will run, and what is left out and why.

use halfshade::Result;
use halfshade::plan::{Outputs, plan};

use super::calibration::Calibration;
use super::given::Given;
use super::shot_args::{DeviceArgs, ShotArgs};
use super::{print_note, print_notes};

/// Prints the passes that a shot needs, with sizes and memory, and what is left out and why.
///
/// Renders nothing. Sizes are pixels and texels, memory is bytes; the device's limits count.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    shot: ShotArgs,
    #[command(flatten)]
    device: DeviceArgs,
    /// Plan for the visibility alone, without a shaded picture
    #[arg(long)]
    visibility_only: bool,
}

/// # Errors
/// A flag's value is out of its range.
pub fn check(args: &Args) -> Result<()> {
    args.shot.check()
}

/// # Errors
/// When the shot can't be read or exceeds the device's limits.
pub fn run(args: &Args, given: &Given) -> Result<()> {
    args.device.with_device(|gpu| {
        let shot = args.shot.load(&Calibration::of(&gpu.info), given)?;
        print_notes(&shot);
        let outputs = Outputs {
            picture: !args.visibility_only,
        };
        let plan = plan(&shot, outputs, &gpu.limits)?;
        plan.notes.iter().for_each(|note| print_note(note));
        super::print(&plan.to_string())
    })
}
