//! The flags that commands share: what to render, and on which device.

use std::path::PathBuf;
use std::sync::Arc;

use halfshade::gpu::{Gpu, Options};
use halfshade::shot::{Leaf, Mapping, Occluders, Overrides, Pattern, Settings, Shot, Technique};
use halfshade::{Error, Result};

use super::calibration::Calibration;
use super::given::Given;
use super::load_args::LoadArgs;
use super::progress;

/// What to render and how.
#[derive(Debug, clap::Args)]
pub struct ShotArgs {
    /// A shot file (.json), or a .gltf or .glb with a camera and a light
    pub shot: PathBuf,
    /// Which publication computes the visibility: packet-contour, pixel-contour, micropatch,
    /// micropatch-hierarchical, bitmask, depth-peeling, pcss, hard or reference-maps
    #[arg(long, value_name = "NAME", default_value_t = Technique::PacketContour)]
    technique: Technique,
    /// Pixels that share a traversal, 1x1 to 8x8; 1x1 is the pixel-wise path [default: calibrated, else 4x4]
    #[arg(long, value_name = "WxH", value_parser = parse_packet)]
    packet: Option<(u32, u32)>,
    /// What a leaf does where a packet's pixels disagree: reprocess or per-pixel [default: calibrated, else per-pixel]
    #[arg(long, value_name = "RULE")]
    leaf: Option<Leaf>,
    /// How a packet maps to shader invocations: serial or lanes [default: calibrated, else serial]
    #[arg(long, value_name = "MAPPING")]
    mapping: Option<Mapping>,
    /// Cut each light into N×N sub-lights, 1 to 16; 1 is fastest and leaks where occluders overlap
    /// [default: 4 with packet-contour, else 1]
    #[arg(long, value_name = "N")]
    split: Option<u32>,
    /// Width and height of a shadow map in texels, 16 to 8192
    #[arg(long, value_name = "R", default_value_t = 512)]
    map: u32,
    /// Bits of a depth bound in the hierarchy over the map, 32 or 16 (half its memory, the same image)
    #[arg(long, value_name = "BITS", default_value_t = 32)]
    mssm_bits: u32,
    /// Depth bias in texels of the receiver's slope, 0 or more
    /// [default: 0.25 with contours, 0.5 with reference-maps, 6 with pcss, else 1]
    #[arg(long, value_name = "TEXELS")]
    bias: Option<f32>,
    /// Visit nodes whose back-projection misses the light as well, as the paper does
    #[arg(long)]
    no_footprint_pruning: bool,
    /// With pixel-contour: walk the MSSM instead of every cell of the kernel
    #[arg(long)]
    hierarchical: bool,
    /// With micropatch and micropatch-hierarchical: leave the gaps between patches open
    #[arg(long)]
    no_gap_filling: bool,
    /// With bitmask and depth-peeling: layers of the shadow map, 1 to 4 [default: 4 with depth-peeling, else 1]
    #[arg(long, value_name = "N")]
    layers: Option<u32>,
    /// With depth-peeling: what a layer's texels stand for, micropatches or contours
    #[arg(long, value_name = "KIND", default_value_t = Occluders::Micropatches)]
    occluders: Occluders,
    /// With bitmask: N×N samples of the light, 8 to 16
    #[arg(long, value_name = "N", default_value_t = 16)]
    light_samples: u32,
    /// With bitmask: where the light's samples stand, regular or jittered
    #[arg(long, value_name = "NAME", default_value_t = Pattern::Jittered)]
    pattern: Pattern,
    /// With pcss: samples of the search for blockers, 1 to 1024
    #[arg(long, value_name = "N", default_value_t = 16)]
    blocker_samples: u32,
    /// With pcss: samples of the filter, 1 to 1024
    #[arg(long, value_name = "N", default_value_t = 32)]
    filter_samples: u32,
    /// With hard: the share of 3×3 samples that hide the pixel, instead of the nearest one
    #[arg(long)]
    percentage_closer: bool,
    /// With reference-maps: hard shadow maps from points on the light, 1 to 4096
    #[arg(long, value_name = "N", default_value_t = 1024)]
    maps: u32,
    /// With packet-contour: points of the light that cast hard shadows, on all of it, where an occluder is nearer to
    /// sub-lights than they are wide, 0 to 4096; 0 = integrate these as well
    #[arg(long, value_name = "N", default_value_t = 256)]
    near_points: u32,
    /// Count pixels, packets, nodes and edges (takes time)
    #[arg(long)]
    pub counters: bool,
    /// Make the scene's own point and spot lights discs of this radius, in scene units, 0 or more
    #[arg(long, value_name = "R")]
    radius: Option<f64>,
    /// Which scene of the glTF, counted from 0 [default: the file's own]
    #[arg(long, value_name = "N")]
    scene: Option<usize>,
    /// Which camera of the glTF, counted from 0; a shot file's own camera goes first [default: 0]
    #[arg(long, value_name = "N")]
    camera: Option<usize>,
    #[command(flatten)]
    load: LoadArgs,
}

impl ShotArgs {
    /// # Errors
    /// A value is out of its range.
    pub fn check(&self) -> Result<()> {
        self.overrides().validate()?;
        self.settings(&Calibration::default()).validate()
    }

    /// Loads the shot, with the flags' settings and a note on each of the `given` flags that it does not read; what the
    /// flags leave open comes from `calibration`.
    pub fn load(&self, calibration: &Calibration, given: &Given) -> Result<Shot> {
        let overrides = self.overrides();
        let mut shot = progress::spin("loading", || Shot::load(&self.shot, &overrides))?;
        shot.settings = self.settings(calibration);
        shot.notes.extend(unread(&shot, given));
        Ok(shot)
    }

    fn overrides(&self) -> Overrides {
        Overrides {
            // Adding 0 takes the sign from −0.
            radius: self.radius.map(|radius| radius + 0.0),
            scene_index: self.scene,
            camera_index: self.camera,
            ..self.load.overrides()
        }
    }

    fn settings(&self, calibration: &Calibration) -> Settings {
        let usual = Settings::usual(self.technique);
        Settings {
            technique: self.technique,
            packet: self.packet.unwrap_or(calibration.packet),
            leaf: self.leaf.unwrap_or(calibration.leaf),
            mapping: self.mapping.unwrap_or(calibration.mapping),
            split: self.split.unwrap_or(usual.split),
            map: self.map,
            mssm_bits: self.mssm_bits,
            footprint_pruning: !self.no_footprint_pruning,
            hierarchical: self.hierarchical,
            gap_filling: !self.no_gap_filling,
            layers: self.layers.unwrap_or(usual.layers),
            occluders: self.occluders,
            light_samples: self.light_samples,
            pattern: self.pattern,
            blocker_samples: self.blocker_samples,
            filter_samples: self.filter_samples,
            percentage_closer: self.percentage_closer,
            maps: self.maps,
            near_points: self.near_points,
            // Adding 0 takes the sign from −0.
            bias: self.bias.map(|bias| bias + 0.0),
            counters: self.counters,
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

/// The value of `--packet`; its range is checked with the other settings.
pub fn parse_packet(text: &str) -> Result<(u32, u32), String> {
    let sides = text.split_once(['x', 'X', '×']);
    sides
        .and_then(|(width, height)| Some((width.parse().ok()?, height.parse().ok()?)))
        .ok_or_else(|| "a packet is written 4x4, each side from 1 to 8 pixels".to_owned())
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
        Gpu::open(&Options {
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
        let gpu = self.open()?;
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
