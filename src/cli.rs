//! The subcommands: each has its arguments, a `check` of what the command line alone gets wrong, where it can get
//! anything wrong, and a `run` that returns an error or prints its result.

use std::io::{self, Write};
use std::ops::RangeInclusive;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use halfshade::reference as ray_tracer;
use halfshade::shot::{MAX_SIZE, Shot};
use halfshade::{Error, Result};

pub mod calibrate;
pub mod calibration;
pub mod compare;
pub mod devices;
pub mod given;
mod knob_args;
mod load_args;
mod outputs;
pub mod plan;
mod progress;
pub mod reference;
pub mod render;
pub mod shaders;
pub mod shot_args;
mod stats;
pub mod study;
mod time_limit;

/// Rays per pixel, as a parser of flags wants its ranges.
const SAMPLES: RangeInclusive<i64> =
    *ray_tracer::SAMPLES.start() as i64..=*ray_tracer::SAMPLES.end() as i64;

/// Timed frames that can be asked for.
const REPEAT: RangeInclusive<i64> = 1..=10000;

/// The user's folders for caches and data. None: there is no home folder.
pub fn project_folders() -> Option<directories::ProjectDirs> {
    directories::ProjectDirs::from("", "", "halfshade")
}

/// A flag that Ctrl-C sets, for work that ends in its own way.
///
/// # Errors
/// Ctrl-C cannot be caught.
pub fn on_interrupt() -> Result<Arc<AtomicBool>> {
    let interrupted = Arc::new(AtomicBool::new(false));
    let flag = Arc::clone(&interrupted);
    ctrlc::set_handler(move || flag.store(true, Ordering::Relaxed))
        .map_err(|error| Error::Invalid(format!("Ctrl-C cannot be caught: {error}")))?;
    Ok(interrupted)
}

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

/// What was ignored or changed when the shot was read, or is said about its flags, a sentence each.
pub fn notes(shot: &Shot) -> impl Iterator<Item = &String> {
    shot.scene.notes.iter().chain(&shot.notes)
}

/// The notes of a shot, a line each on stderr.
pub fn print_notes(shot: &Shot) {
    notes(shot).for_each(|note| print_note(note));
}

/// A line on stderr.
pub fn print_note(note: &str) {
    // Nobody is left to tell when stderr is closed.
    let _ = writeln!(io::stderr(), "note: {}", one_line(note));
}

/// An error as one line.
pub fn print_error(error: &Error) {
    // Nobody is left to tell when stderr is closed.
    let _ = writeln!(io::stderr(), "halfshade: {}", one_line(&error.to_string()));
}

/// A sentence without line breaks, whatever a driver or a file name has put into it.
pub fn one_line(text: &str) -> String {
    let words: Vec<&str> = text.split(char::is_control).map(str::trim).collect();
    words.join(" ").trim_end().to_owned()
}

/// The value of `--size`: `WxH` in pixels, each from 1 to 32768.
pub fn parse_size(text: &str) -> Result<(u32, u32), String> {
    let side = |text: &str| {
        text.parse()
            .ok()
            .filter(|side| (1..=MAX_SIZE).contains(side))
    };
    let sides = text.split_once(['x', 'X', '×']);
    sides
        .and_then(|(width, height)| Some((side(width)?, side(height)?)))
        .ok_or_else(|| format!("a size is written 640x480, each side from 1 to {MAX_SIZE}"))
}
