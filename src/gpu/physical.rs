//! The system's Vulkan devices: what each is, whether it can run the engine, and which one is taken.

use std::ffi::CStr;

use ash::vk;

use super::failed::failed;
use super::instance::{create_instance, load};
use super::requirements;
use super::validation::Messages;
use crate::error::{Error, Result};

/// A Vulkan device and whether it can run the engine.
#[derive(Debug, Clone, serde::Serialize)]
pub struct DeviceInfo {
    pub name: String,
    /// "discrete", "integrated", "virtual", "cpu" or "other".
    pub kind: &'static str,
    /// Name and version of the driver.
    pub driver: String,
    /// Version of Vulkan.
    pub vulkan: String,
    /// [invocation]
    pub subgroup_size: u32,
    /// [bit] The rasteriser moves vertices onto a grid of 2^−n pixels: 4 at least.
    pub subpixel_bits: u32,
    /// The device's UUID in hexadecimal digits: names what is stored per device.
    pub uuid: String,
    /// What it lacks; empty = it can run the engine.
    pub missing: Vec<String>,
}

pub(super) fn describe(instance: &ash::Instance, device: vk::PhysicalDevice) -> DeviceInfo {
    let mut driver = vk::PhysicalDeviceDriverProperties::default();
    let mut v11 = vk::PhysicalDeviceVulkan11Properties::default();
    let mut properties = vk::PhysicalDeviceProperties2::default()
        .push_next(&mut driver)
        .push_next(&mut v11);
    // SAFETY: the device was enumerated from this instance, and the chain outlives the call.
    unsafe { instance.get_physical_device_properties2(device, &mut properties) };
    let core = properties.properties;
    let text = |name: Result<&CStr, _>| {
        name.map(|n| n.to_string_lossy().into_owned())
            .unwrap_or_default()
    };
    DeviceInfo {
        name: text(core.device_name_as_c_str()),
        kind: match core.device_type {
            vk::PhysicalDeviceType::DISCRETE_GPU => "discrete",
            vk::PhysicalDeviceType::INTEGRATED_GPU => "integrated",
            vk::PhysicalDeviceType::VIRTUAL_GPU => "virtual",
            vk::PhysicalDeviceType::CPU => "cpu",
            _ => "other",
        },
        driver: format!(
            "{} {}",
            text(driver.driver_name_as_c_str()),
            text(driver.driver_info_as_c_str())
        ),
        vulkan: format!(
            "{}.{}.{}",
            vk::api_version_major(core.api_version),
            vk::api_version_minor(core.api_version),
            vk::api_version_patch(core.api_version)
        ),
        subgroup_size: v11.subgroup_size,
        subpixel_bits: core.limits.sub_pixel_precision_bits,
        uuid: v11
            .device_uuid
            .iter()
            .map(|byte| format!("{byte:02x}"))
            .collect(),
        missing: requirements::missing(instance, device),
    }
}

/// Every Vulkan device of the system, able to run the engine or not.
pub fn list_devices() -> Result<Vec<DeviceInfo>> {
    let entry = load(None)?;
    let (instance, _) = create_instance(&entry, false, &Messages::default())?;
    // SAFETY: the instance is destroyed after its last use.
    unsafe {
        let devices = instance
            .enumerate_physical_devices()
            .map_err(failed("vkEnumeratePhysicalDevices"));
        let list = devices.map(|devices| devices.iter().map(|&d| describe(&instance, d)).collect());
        instance.destroy_instance(None);
        list
    }
}

/// The device that `wanted` names, or else the best one.
pub(super) fn pick(
    instance: &ash::Instance,
    wanted: Option<&str>,
) -> Result<(vk::PhysicalDevice, DeviceInfo)> {
    // SAFETY: a plain query.
    let devices = unsafe { instance.enumerate_physical_devices() }
        .map_err(failed("vkEnumeratePhysicalDevices"))?;
    let mut found: Vec<_> = devices
        .into_iter()
        .map(|device| (device, describe(instance, device)))
        .collect();
    if found.is_empty() {
        return Err(Error::Unsupported(
            "no Vulkan device: install a driver (mesa-vulkan-drivers has lavapipe)".into(),
        ));
    }
    let names = |list: &[(vk::PhysicalDevice, DeviceInfo)]| {
        list.iter()
            .map(|(_, info)| info.name.clone())
            .collect::<Vec<_>>()
            .join(", ")
    };
    if let Some(wanted) = wanted {
        let all = names(&found);
        let wanted_lower = wanted.to_lowercase();
        let named = |info: &DeviceInfo| info.name.to_lowercase().contains(&wanted_lower);
        found.retain(|(_, info)| info.uuid == wanted_lower || named(info));
        if found.is_empty() {
            return Err(Error::Unsupported(format!(
                "no Vulkan device is called \"{wanted}\"; there are: {all}"
            )));
        }
    }
    let rank = |info: &DeviceInfo| {
        let kinds = ["discrete", "integrated", "virtual", "cpu", "other"];
        (
            !info.missing.is_empty(),
            kinds.iter().position(|&kind| kind == info.kind),
        )
    };
    found.sort_by_key(|(_, info)| rank(info));
    let (device, info) = found.swap_remove(0);
    if info.missing.is_empty() {
        return Ok((device, info));
    }
    Err(Error::Unsupported(format!(
        "{} cannot run the engine: it lacks {}",
        info.name,
        info.missing.join(", ")
    )))
}
