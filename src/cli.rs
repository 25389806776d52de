//! The subcommands: each has its arguments and a `run` that returns an error or prints its result.

use std::io::{self, Write};
use std::path::Path;

use halfshade::{Error, Result};

pub mod compare;

/// Prints to stdout; a reader that has gone away (`| head`) is no error.
///
/// # Errors
/// When stdout cannot be written to, such as a full disk.
pub fn print(text: &str) -> Result<()> {
    let mut stdout = io::stdout().lock();
    match stdout
        .write_all(text.as_bytes())
        .and_then(|()| stdout.flush())
    {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(Error::io(Path::new("standard output"), error))
        }
        _ => Ok(()),
    }
}
