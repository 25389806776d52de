//! Reading files that may be anything.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use crate::{Error, Result};

/// The contents of a regular file; pipes and devices, which may never end, are refused.
pub(crate) fn read(path: &Path) -> Result<Vec<u8>> {
    read_at_most(path, u64::MAX)
}

/// The first `limit` [byte] of a regular file, or all of it where it is shorter.
pub(crate) fn read_at_most(path: &Path, limit: u64) -> Result<Vec<u8>> {
    let failed = |source| Error::io(path, source);
    // Asked before opening, because opening a pipe without a writer waits for one.
    if !std::fs::metadata(path).map_err(failed)?.is_file() {
        return Err(Error::parse(path, "is not a regular file"));
    }
    let mut bytes = Vec::new();
    File::open(path)
        .and_then(|file| file.take(limit).read_to_end(&mut bytes))
        .map_err(failed)?;
    Ok(bytes)
}
