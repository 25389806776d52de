//! `halfshade study merge`: joins parts of a study.

use std::path::PathBuf;

use halfshade::Result;
use halfshade::study::Folder;

/// Joins the folders of several studies, such as the shards of one, into a folder with reports of its own.
///
/// Runs of the same shot, settings and device count once: the first stays.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Folders of studies
    #[arg(required = true, value_name = "FOLDER")]
    parts: Vec<PathBuf>,
    /// The folder of the whole, new or one to add to
    #[arg(short, long, value_name = "FOLDER")]
    output: PathBuf,
}

/// # Errors
/// A folder holds no study, or a file cannot be read or written.
pub fn run(args: &Args) -> Result<()> {
    let whole = Folder::open(&args.output)?;
    for part in &args.parts {
        whole.merge(&Folder::existing(part)?)?;
    }
    super::pareto::report(&whole)
}
