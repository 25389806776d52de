//! `halfshade devices`: the Vulkan devices and whether each can run the engine.

use std::fmt::Write;

use halfshade::Result;
use halfshade::gpu::list_devices;

/// Lists the Vulkan devices and, for each that can't run the engine, what it lacks.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Print a JSON array instead of lines
    #[arg(long)]
    json: bool,
}

/// # Errors
/// When there is no Vulkan at all.
pub fn run(args: &Args) -> Result<()> {
    let devices = list_devices()?;
    if args.json {
        let text = serde_json::to_string_pretty(&devices)
            .map_err(|error| halfshade::Error::Invalid(error.to_string()))?;
        return super::print(&format!("{text}\n"));
    }
    let mut text = String::new();
    for device in &devices {
        let verdict = match device.missing.is_empty() {
            true => "can run the engine".to_owned(),
            false => format!(
                "cannot run the engine: it lacks {}",
                device.missing.join(", ")
            ),
        };
        // Writing to a string does not fail.
        let _ = writeln!(
            text,
            "{} ({}, {}, Vulkan {}, subgroups of {}): {verdict}",
            device.name, device.kind, device.driver, device.vulkan, device.subgroup_size
        );
    }
    if devices.is_empty() {
        text = "no Vulkan device: install a driver (mesa-vulkan-drivers has lavapipe)\n".into();
    }
    super::print(&text)
}
