//! `halfshade study`: error against run time.

mod figure;
mod merge;
mod pareto;
mod stability;
mod sweep_args;
mod tune;

use halfshade::Result;

use super::given::Given;

/// Measures error against run time on your shots and device.
///
/// `pareto` sweeps techniques and settings and reports all of them; `merge` joins parts of a sweep that ran on
/// several machines; `tune` finds the settings to use; `figure` repeats what the publications measured;
/// `stability` tries stiff and extreme cases.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(subcommand)]
    what: What,
}

#[derive(Debug, clap::Subcommand)]
enum What {
    Pareto(pareto::Args),
    Merge(merge::Args),
    Tune(tune::Args),
    Stability(stability::Args),
    Figure(figure::Args),
}

/// # Errors
/// What the command line of the study gets wrong.
pub fn check(args: &Args) -> Result<()> {
    match &args.what {
        What::Pareto(args) => pareto::check(args),
        What::Merge(_) => Ok(()),
        What::Tune(args) => tune::check(args),
        What::Stability(args) => stability::check(args),
        What::Figure(args) => figure::check(args),
    }
}

/// # Errors
/// What the study fails with.
pub fn run(args: &Args, given: &Given) -> Result<()> {
    match &args.what {
        What::Pareto(args) => pareto::run(args, given),
        What::Merge(args) => merge::run(args),
        What::Tune(args) => tune::run(args),
        What::Stability(args) => stability::run(args),
        What::Figure(args) => figure::run(args),
    }
}
