//! The flags that commands share: what to render, and on which device.

use std::path::PathBuf;
use std::sync::Arc;

use halfshade::gpu::{Gpu, Options};
use halfshade::shot::{Overrides, Shot};
use halfshade::{Error, Result};

use super::calibration::Calibration;
use super::given::Given;
use super::knob_args::KnobArgs;
use super::load_args::LoadArgs;
use super::progress;

/// What to render and how.
#[derive(Debug, clap::Args)]
pub struct ShotArgs {
    /// A shot file (.json), or a .gltf or .glb with a camera and a light
    pub shot: PathBuf,
    #[command(flatten)]
    knobs: KnobArgs,
    /// Make the scene's own point and spot lights spheres of this radius, in scene units, 0 or more
    #[arg(long, value_name = "R")]
    radius: Option<f64>,
    /// Angular diameter of the scene's own directional lights in degrees, 0 to less than 180 [default: 0.533]
    #[arg(long, value_name = "DEGREES")]
    sun_angle: Option<f64>,
    /// Which scene of the glTF, counted from 0 [default: the file's own]
    #[arg(long, value_name = "N")]
    scene: Option<usize>,
    /// Which camera of the glTF, counted from 0; a shot file's own camera goes first [default: 0]
    #[arg(long, value_name = "N")]
    camera: Option<usize>,
    /// With --budget: an image (PNG, JPEG or WebP), stretched over the picture, of the share of it that is left: white all
    /// [default: the shot file's "budget_map"]
    #[arg(long, value_name = "FILE")]
    budget_map: Option<PathBuf>,
    #[command(flatten)]
    load: LoadArgs,
}

impl ShotArgs {
    /// # Errors
    /// A value is out of its range.
    pub fn check(&self) -> Result<()> {
        self.overrides().validate()?;
        self.knobs.settings(&Calibration::default())?.validate()
    }

    /// Loads the shot, with the flags' settings and a note on each of the `given` flags that it does not read; what the
    /// flags leave open comes from `calibration`.
    pub fn load(&self, calibration: &Calibration, given: &Given) -> Result<Shot> {
        let overrides = self.overrides();
        let mut shot = progress::spin("loading", || Shot::load(&self.shot, &overrides))?;
        shot.settings = self.knobs.settings(calibration)?;
        shot.notes.extend(unread(&shot, given));
        Ok(shot)
    }

    fn overrides(&self) -> Overrides {
        Overrides {
            // Adding 0 takes the sign from −0.
            radius: self.radius.map(|radius| radius + 0.0),
            sun_angle_deg: self.sun_angle.map(|angle| angle + 0.0),
            scene_index: self.scene,
            camera_index: self.camera,
            budget_map: self.budget_map.clone(),
            ..self.load.overrides()
        }
    }
}

/// A note on each flag of a technique that is of no use to any light of the shot.
fn unread(shot: &Shot, given: &Given) -> Vec<String> {
    let settings = &shot.settings;
    let is_read = |flag: &str, point| settings.reads(flag, point) != Some(false);
    let note = |flag: &&str| match is_read(flag, false) {
        true => {
            format!(
                "--{flag} is ignored, for a light without extent casts a hard shadow whatever the technique."
            )
        }
        false => format!(
            "--{flag} is ignored, for {} does not read it.",
            settings.technique
        ),
    };
    let idle = |flag: &&str| !(shot.lights.iter()).any(|light| is_read(flag, light.is_point()));
    given.flags().filter(idle).map(|flag| note(&flag)).collect()
}

/// Where to render.
#[derive(Debug, clap::Args)]
pub struct DeviceArgs {
    /// A part of the device's name as `halfshade devices` lists it [default: discrete before integrated before CPU]
    #[arg(long, value_name = "SUBSTRING")]
    device: Option<String>,
    /// Run under the Vulkan validation layer; any warning or error fails the run
    #[arg(long)]
    pub validate: bool,
    /// Most memory that a frame may take on the device, such as 512MiB or 2GiB [default: all that it has]
    #[arg(long, value_name = "BYTES", value_parser = parse_bytes)]
    max_memory: Option<u64>,
    /// For tests, which put themselves between the program and Vulkan.
    #[arg(skip)]
    pub loader: Option<ash::vk::PFN_vkGetInstanceProcAddr>,
}

/// A number of bytes, or of KiB, MiB, GiB or TiB.
fn parse_bytes(text: &str) -> Result<u64, String> {
    let digits = text.trim_end_matches(|c: char| !c.is_ascii_digit());
    let units = ["", "KiB", "MiB", "GiB", "TiB"];
    let unit = units
        .iter()
        .position(|unit| *unit == text[digits.len()..].trim());
    unit.zip(digits.parse::<u64>().ok())
        .and_then(|(unit, number)| number.checked_mul(1 << (10 * unit)))
        .ok_or_else(|| {
            "a size is written 512MiB, or with KiB, GiB, TiB or nothing for bytes".to_owned()
        })
}

impl DeviceArgs {
    pub fn open(&self) -> Result<Arc<Gpu>> {
        self.open_for(false)
    }

    /// `costs`: to tell what pipelines cost.
    fn open_for(&self, costs: bool) -> Result<Arc<Gpu>> {
        Gpu::open(&Options {
            costs,
            device: self.device.clone(),
            validate: self.validate,
            cache_folder: super::project_folders().map(|folders| folders.cache_dir().to_path_buf()),
            max_memory: self.max_memory,
            loader: self.loader,
        })
    }

    /// Runs `work` on an open device, closes the device, and fails if the validation layer has said
    /// anything until then.
    pub fn with_device<T>(&self, work: impl FnOnce(&Arc<Gpu>) -> Result<T>) -> Result<T> {
        Self::with_gpu(self.open()?, work)
    }

    /// As [`Self::with_device`], on a device that tells what pipelines cost, if it does.
    pub fn with_costs<T>(&self, work: impl FnOnce(&Arc<Gpu>) -> Result<T>) -> Result<T> {
        Self::with_gpu(self.open_for(true)?, work)
    }

    fn with_gpu<T>(gpu: Arc<Gpu>, work: impl FnOnce(&Arc<Gpu>) -> Result<T>) -> Result<T> {
        let messages = gpu.validation_messages();
        let result = work(&gpu);
        drop(gpu);
        let said = messages.lock().map(|said| said.clone()).unwrap_or_default();
        match result {
            Ok(_) if !said.is_empty() => Err(Error::Validation(said)),
            result => result,
        }
    }
}
