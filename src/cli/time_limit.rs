//! An end to work that takes too long. A device cannot be told to stop, so the process ends.

use std::process;
use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::thread;
use std::time::Duration;

use halfshade::Error;

/// While it lives, the time runs.
pub struct TimeLimit {
    /// Dropped, it tells the watch that the work is done.
    _work: Sender<()>,
}

impl TimeLimit {
    /// Ends the process with exit code 1 and one sentence, unless dropped before. Nothing that has begun to be written
    /// may be left behind by then, so files are written when it is gone.
    pub fn start(limit: Duration) -> Self {
        let (work, done) = mpsc::channel();
        thread::spawn(move || {
            if done.recv_timeout(limit) == Err(RecvTimeoutError::Timeout) {
                super::print_error(&Error::Invalid(format!(
                    "not done after the {} s of --max-seconds, nothing was written; choose a smaller --size, --map or \
                     --split, or a larger limit",
                    limit.as_secs_f64()
                )));
                process::exit(1);
            }
        });
        Self { _work: work }
    }
}

/// The value of `--max-seconds`.
pub fn parse_seconds(text: &str) -> Result<Duration, String> {
    let seconds = text.parse().ok().filter(|&seconds: &f64| seconds > 0.0);
    seconds
        .and_then(|seconds| Duration::try_from_secs_f64(seconds).ok())
        .ok_or_else(|| "a time is a number of seconds above 0, such as 10 or 0.5".to_owned())
}
