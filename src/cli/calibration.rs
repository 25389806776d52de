//! What `halfshade calibrate` found out about a device, stored per device in the user's data folder.

use std::io::Write;
use std::path::PathBuf;

use halfshade::gpu::DeviceInfo;
use halfshade::image::write_atomically;
use halfshade::render::DEFAULT_COSTS;
use halfshade::shared::Costs;
use halfshade::technique::{Leaf, Mapping, Settings};
use halfshade::{Error, Result};

/// Of the stored file. Files of any other format are refused.
const FORMAT: u32 = 2;

/// The settings that are fastest on a device, and the cost model's constants.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Calibration {
    /// Cost of extracting an edge, in visited nodes [Yang09 eq. 6]; more than 0, at most 10⁶.
    pub edge_cost: f32,
    /// Cost of integrating an edge for one pixel, in visited nodes; more than 0, at most 10⁶.
    pub visibility_cost: f32,
    /// [pixel] Each 1 to 8, or [`Settings::LOCAL`].
    pub packet: (u32, u32),
    pub leaf: Leaf,
    pub mapping: Mapping,
}

/// A line of the measured table.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Row {
    /// What was compared with what; medians of other races are not comparable.
    pub race: String,
    pub candidate: Calibration,
    /// Rounds of the race.
    pub rounds: usize,
    /// [ms] GPU time of `classify` and the visibility passes in a frame, the geometric mean over the shots.
    pub median_ms: f64,
    /// [ms] Median absolute deviation.
    pub spread_ms: f64,
    /// ≥ 1. To the lowest median of the race.
    pub ratio: f64,
}

/// The file.
#[derive(Debug, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct Stored {
    format: u32,
    device: String,
    /// Its name and version; another one may have other costs.
    driver: String,
    /// Of halfshade.
    version: String,
    calibration: Calibration,
    measured: Vec<Row>,
}

impl Default for Calibration {
    /// One default for all devices: local packets are the fastest on lavapipe and on NVIDIA alike.
    fn default() -> Self {
        let settings = Settings::default();
        Self {
            edge_cost: DEFAULT_COSTS.edge,
            visibility_cost: DEFAULT_COSTS.visibility,
            packet: settings.packet,
            leaf: settings.leaf,
            mapping: settings.mapping,
        }
    }
}

impl Calibration {
    pub fn costs(&self) -> Costs {
        Costs {
            edge: self.edge_cost,
            visibility: self.visibility_cost,
        }
    }

    /// Changes settings to what it has found.
    pub fn apply(&self, settings: &mut Settings) {
        settings.packet = self.packet;
        settings.leaf = self.leaf;
        settings.mapping = self.mapping;
    }

    /// # Errors
    /// When a value is out of its range.
    pub fn validate(&self) -> Result<()> {
        self.costs().validate()?;
        let settings = Settings {
            packet: self.packet,
            ..Settings::default()
        };
        settings.validate()
    }

    /// Where a device's calibration is stored. None: the user has no home folder.
    pub fn file(device: &DeviceInfo) -> Option<PathBuf> {
        let folders = super::project_folders()?;
        Some(
            folders
                .data_dir()
                .join(format!("calibration-{}.json", device.uuid)),
        )
    }

    /// The stored calibration of a device, or the built-in one; a file that is broken, of another format
    /// or made with another driver is reported on stderr and ignored.
    pub fn of(device: &DeviceInfo) -> Self {
        match Self::stored(device) {
            Ok(stored) => stored.unwrap_or_default(),
            Err(why) => {
                // Nobody is left to tell when stderr is closed.
                let _ = writeln!(
                    std::io::stderr(),
                    "note: the stored calibration is ignored ({why}); run `halfshade calibrate` anew"
                );
                Self::default()
            }
        }
    }

    /// None: there is none. Errors: why it cannot be used.
    fn stored(device: &DeviceInfo) -> Result<Option<Self>> {
        let Some(file) = Self::file(device) else {
            return Ok(None);
        };
        let text = match std::fs::read_to_string(&file) {
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(None),
            text => text.map_err(|error| Error::io(&file, error))?,
        };
        let refused = |why: String| Error::parse(&file, why);
        let stored: Stored =
            serde_json::from_str(&text).map_err(|error| refused(error.to_string()))?;
        if stored.format != FORMAT {
            return Err(refused(format!("format {}, not {FORMAT}", stored.format)));
        }
        if stored.driver != device.driver {
            return Err(refused(format!(
                "made with the driver {:?}, which is now {:?}",
                stored.driver, device.driver
            )));
        }
        let checked = stored.calibration.validate();
        checked.map_err(|error| refused(error.to_string()))?;
        Ok(Some(stored.calibration))
    }

    /// Stores it for a device, with the table that it follows from, and returns the file.
    ///
    /// # Errors
    /// There is no home folder, or the file cannot be written; then an older one is still there.
    pub fn store(&self, device: &DeviceInfo, measured: Vec<Row>) -> Result<PathBuf> {
        let file = Self::file(device).ok_or_else(|| {
            Error::Unsupported("there is no home folder to store the calibration in".into())
        })?;
        if let Some(folder) = file.parent() {
            std::fs::create_dir_all(folder).map_err(|error| Error::io(folder, error))?;
        }
        let stored = Stored {
            format: FORMAT,
            device: device.name.clone(),
            driver: device.driver.clone(),
            version: env!("CARGO_PKG_VERSION").into(),
            calibration: *self,
            measured,
        };
        let text = serde_json::to_string_pretty(&stored)
            .map_err(|error| Error::Invalid(error.to_string()))?;
        write_atomically(&file, |out| writeln!(out, "{text}"))?;
        Ok(file)
    }
}
