//! The folder of a study: a file for each finished run, and what is made of them.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::str::FromStr;

use crate::image::write_atomically;
use crate::{Error, Result};

use super::bench::Pictures;
use super::run::{Machine, Run};
use super::{page, plot, sheet, table};

/// In which runs, what they look like, and contact sheets lie.
const SUBFOLDERS: [&str; 4] = ["runs", "pictures", "errors", "sheets"];
/// What is made of all runs.
const REPORTS: [&str; 4] = ["results.json", "results.csv", "pareto.svg", "index.html"];

/// A study on disk:
///
/// - `runs/KEY.json`: each run, with everything needed to repeat it
/// - `pictures/KEY.png`, `errors/KEY.png`: what it looks like, and its error
/// - `results.csv`, `results.json`, `pareto.svg`, `sheets/`, `index.html`: made from these
#[derive(Debug, Clone)]
pub struct Folder {
    path: PathBuf,
}

/// One of several equal parts of a study.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shard {
    /// < `count`
    pub index: usize,
    pub count: usize,
}

impl Shard {
    pub const WHOLE: Self = Self { index: 0, count: 1 };

    /// Whether item `number` of the study belongs to this part.
    pub fn holds(self, number: usize) -> bool {
        number % self.count == self.index
    }
}

impl FromStr for Shard {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self> {
        let parts = text.split_once('/');
        let parts =
            parts.and_then(|(index, count)| Some((index.parse().ok()?, count.parse().ok()?)));
        match parts {
            Some((index, count)) if index < count => Ok(Self { index, count }),
            _ => Err(Error::Invalid(
                "a shard is written I/N, such as 0/4 for the first of four".into(),
            )),
        }
    }
}

impl Folder {
    /// # Errors
    /// There is no study at `path`.
    pub fn existing(path: &Path) -> Result<Self> {
        let folder = Self { path: path.into() };
        match folder.runs_folder().is_dir() {
            true => Ok(folder),
            false => Err(Error::Invalid(format!("{} holds no study", path.display()))),
        }
    }

    /// Makes the folder if it is not there.
    ///
    /// # Errors
    /// It cannot be made, or holds other things than a study.
    pub fn open(path: &Path) -> Result<Self> {
        let folder = Self { path: path.into() };
        if path.is_dir() && !folder.runs_folder().is_dir() {
            let mut entries = fs::read_dir(path).map_err(|error| Error::io(path, error))?;
            if entries.next().is_some() {
                return Err(Error::Invalid(format!(
                    "{} holds something else than a study; name a new folder",
                    path.display()
                )));
            }
        }
        for sub in SUBFOLDERS {
            let sub = path.join(sub);
            fs::create_dir_all(&sub).map_err(|error| Error::io(sub, error))?;
        }
        Ok(folder)
    }

    /// The files that are there now and that the study may write: its reports, and all in its subfolders.
    ///
    /// # Errors
    /// A folder cannot be read.
    pub fn files(&self) -> Result<Vec<PathBuf>> {
        let reports = REPORTS.into_iter().map(|name| self.path.join(name));
        let mut files: Vec<PathBuf> = reports.filter(|file| file.exists()).collect();
        for sub in SUBFOLDERS.into_iter().map(|sub| self.path.join(sub)) {
            let failed = |error| Error::io(&sub, error);
            for entry in fs::read_dir(&sub).map_err(failed)? {
                files.push(entry.map_err(failed)?.path());
            }
        }
        Ok(files)
    }

    fn runs_folder(&self) -> PathBuf {
        self.path.join("runs")
    }

    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Whether a run of this key is finished.
    pub fn has(&self, key: &str) -> bool {
        self.file("runs", key, "json").exists()
    }

    fn file(&self, sub: &str, key: &str, ending: &str) -> PathBuf {
        self.path.join(sub).join(format!("{key}.{ending}"))
    }

    pub(super) fn picture_file(&self, run: &Run) -> PathBuf {
        self.file("pictures", &run.key(), "png")
    }

    pub(super) fn error_file(&self, run: &Run) -> PathBuf {
        self.file("errors", &run.key(), "png")
    }

    /// Keeps a finished run. Its file comes last, so that a run that is there has its pictures.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn keep(&self, run: &Run, pictures: Option<&Pictures>) -> Result<()> {
        if let Some(pictures) = pictures {
            pictures.picture.write(&self.picture_file(run))?;
            pictures.error.write(&self.error_file(run))?;
        }
        write_json(&self.file("runs", &run.key(), "json"), run)
    }

    /// Takes over the runs of another study; runs that are there already stay.
    ///
    /// # Errors
    /// A file cannot be read or written.
    pub fn merge(&self, other: &Self) -> Result<()> {
        let runs = other.runs()?;
        for run in runs.iter().filter(|run| !self.has(&run.key())) {
            for (from, to) in [
                (other.picture_file(run), self.picture_file(run)),
                (other.error_file(run), self.error_file(run)),
            ] {
                if from.exists() {
                    let bytes = fs::read(&from).map_err(|error| Error::io(&from, error))?;
                    write_atomically(&to, |out| out.write_all(&bytes))?;
                }
            }
            self.keep(run, None)?;
        }
        Ok(())
    }

    /// All finished runs, by shot, device, technique and name.
    ///
    /// # Errors
    /// A file cannot be read, or is no run.
    pub fn runs(&self) -> Result<Vec<Run>> {
        let folder = self.runs_folder();
        let failed = |error| Error::io(&folder, error);
        let entries = fs::read_dir(&folder).map_err(failed)?;
        let mut runs = Vec::new();
        for entry in entries {
            let path = entry.map_err(failed)?.path();
            if path.extension().is_some_and(|ending| ending == "json") {
                runs.push(read_run(&path)?);
            }
        }
        runs.sort_by_cached_key(|run| {
            let settings = &run.settings;
            (
                run.shot.clone(),
                run.machine.device.clone(),
                settings.technique.name(),
                (settings.map, settings.split),
                run.label.clone(),
            )
        });
        Ok(runs)
    }

    /// Makes tables, plot, sheets and page from the runs.
    ///
    /// # Errors
    /// There are no runs, or a file cannot be read or written.
    pub fn report(&self) -> Result<()> {
        let runs = self.runs()?;
        if runs.is_empty() {
            return Err(Error::Invalid(
                "no run is finished, so there is nothing to report".into(),
            ));
        }
        let [json, csv, svg, html] = REPORTS.map(|name| self.path.join(name));
        write_json(&json, &runs)?;
        write_text(&csv, &table::csv(&runs)?)?;
        let plot = plot::pareto(&runs)?;
        write_text(&svg, &plot)?;
        let sheets = sheet::sheets(self, &runs)?;
        for sheet in &sheets {
            write_text(&self.path.join("sheets").join(&sheet.file), &sheet.svg)?;
        }
        let page = page::page(&runs, &plot, &sheets)?;
        write_text(&html, &page)
    }
}

impl Run {
    /// Names a run: what was rendered how and where, whatever came out of it.
    pub fn key(&self) -> String {
        key(&self.content, &self.settings.flags(), &self.machine)
    }
}

/// See [`Run::key`]. The commit does not count: a study goes on after a change.
pub fn key(content: &str, flags: &[String], machine: &Machine) -> String {
    let text = [content, &flags.join(" "), &machine.device, &machine.driver].join("\n");
    blake3::hash(text.as_bytes()).to_hex()[..16].to_owned()
}

fn read_run(path: &Path) -> Result<Run> {
    let text = fs::read_to_string(path).map_err(|error| Error::io(path, error))?;
    serde_json::from_str(&text)
        .map_err(|error| Error::parse(path, format!("is no run of a study ({error})")))
}

fn write_json(path: &Path, value: &impl serde::Serialize) -> Result<()> {
    let text =
        serde_json::to_string_pretty(value).map_err(|error| Error::Invalid(error.to_string()))?;
    write_text(path, &text)
}

fn write_text(path: &Path, text: &str) -> Result<()> {
    write_atomically(path, |out: &mut dyn Write| -> io::Result<()> {
        out.write_all(text.as_bytes())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_share_everything_once() {
        let shards: Vec<Shard> = ["0/3", "1/3", "2/3"]
            .map(|text| text.parse().unwrap())
            .into();
        for number in 0..10 {
            assert_eq!(shards.iter().filter(|shard| shard.holds(number)).count(), 1);
        }
        for wrong in ["3/3", "1", "a/b", "-1/2", "0/0"] {
            assert!(wrong.parse::<Shard>().is_err(), "{wrong}");
        }
    }
}
