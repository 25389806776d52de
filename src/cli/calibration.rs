//! What `halfshade calibrate` found out about a device, stored per device in the user's data folder.

use std::path::PathBuf;

use halfshade::gpu::DeviceInfo;
use halfshade::image::write_atomically;
use halfshade::render::DEFAULT_COSTS;
use halfshade::shared::Costs;
use halfshade::shot::{Leaf, Mapping, Settings};
use halfshade::{Error, Result};

/// The settings that are fastest on a device, and the cost model's constants.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Calibration {
    /// Cost of extracting an edge, in visited nodes [Yang09 eq. 6].
    pub edge_cost: f32,
    /// Cost of integrating an edge for one pixel, in visited nodes.
    pub visibility_cost: f32,
    /// [pixel]
    pub packet: (u32, u32),
    pub leaf: Leaf,
    pub mapping: Mapping,
}

impl Default for Calibration {
    /// As measured on lavapipe.
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

    /// Where a device's calibration is stored. None: the user has no home folder.
    pub fn file(device: &DeviceInfo) -> Option<PathBuf> {
        let folders = super::project_folders()?;
        Some(
            folders
                .data_dir()
                .join(format!("calibration-{}.json", device.uuid)),
        )
    }

    /// The stored calibration of a device, or the built-in one; a file that can't be read is reported
    /// and ignored.
    pub fn of(device: &DeviceInfo) -> Self {
        let Some(text) = Self::file(device).and_then(|file| std::fs::read_to_string(file).ok())
        else {
            return Self::default();
        };
        serde_json::from_str(&text).unwrap_or_else(|error| {
            eprintln!(
                "note: the stored calibration is ignored ({error}); run `halfshade calibrate` anew"
            );
            Self::default()
        })
    }

    /// Stores it for a device.
    pub fn store(&self, device: &DeviceInfo) -> Result<PathBuf> {
        let file = Self::file(device).ok_or_else(|| {
            Error::Unsupported("there is no home folder to store the calibration in".into())
        })?;
        if let Some(folder) = file.parent() {
            std::fs::create_dir_all(folder).map_err(|error| Error::io(folder, error))?;
        }
        let text = serde_json::to_string_pretty(self)
            .map_err(|error| Error::Invalid(error.to_string()))?;
        write_atomically(&file, |out| out.write_all(text.as_bytes()))?;
        Ok(file)
    }
}
