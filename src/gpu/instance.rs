//! The loader and the instance.

use std::ffi::CStr;

use ash::{ext, vk};

use super::failed::failed;
use super::validation::{self, Messages};
use crate::error::{Error, Result};

const VALIDATION_LAYER: &CStr = c"VK_LAYER_KHRONOS_validation";

pub(super) fn load(loader: Option<vk::PFN_vkGetInstanceProcAddr>) -> Result<ash::Entry> {
    if let Some(get_instance_proc_addr) = loader {
        let functions = ash::StaticFn {
            get_instance_proc_addr,
        };
        // SAFETY: whoever gives a loader promises that it is one and stays there.
        return Ok(unsafe { ash::Entry::from_static_fn(functions) });
    }
    // SAFETY: loading the system's Vulkan loader; it stays loaded while the entry lives.
    unsafe { ash::Entry::load() }.map_err(|e| {
        Error::Unsupported(format!(
            "no Vulkan loader ({e}): install libvulkan1 and a driver"
        ))
    })
}

/// An instance, with the messenger's own creation and destruction validated too.
pub(super) fn create_instance(
    entry: &ash::Entry,
    validate: bool,
    messages: &Messages,
) -> Result<(ash::Instance, bool)> {
    // SAFETY: plain queries.
    let (layers, extensions) = unsafe {
        (
            entry
                .enumerate_instance_layer_properties()
                .map_err(failed("vkEnumerateInstanceLayerProperties"))?,
            entry
                .enumerate_instance_extension_properties(None)
                .map_err(failed("vkEnumerateInstanceExtensionProperties"))?,
        )
    };
    if validate
        && !layers
            .iter()
            .any(|l| l.layer_name_as_c_str() == Ok(VALIDATION_LAYER))
    {
        return Err(Error::Unsupported(
            "the Khronos validation layer is not there: install vulkan-validationlayers or leave out --validate".into(),
        ));
    }
    let debug = validate
        || extensions
            .iter()
            .any(|e| e.extension_name_as_c_str() == Ok(ext::debug_utils::NAME));
    let application = vk::ApplicationInfo::default()
        .application_name(c"halfshade")
        .api_version(vk::API_VERSION_1_3);
    let enabled_layers = if validate {
        vec![VALIDATION_LAYER.as_ptr()]
    } else {
        vec![]
    };
    let enabled_extensions = if debug {
        vec![ext::debug_utils::NAME.as_ptr()]
    } else {
        vec![]
    };
    let synchronization = [vk::ValidationFeatureEnableEXT::SYNCHRONIZATION_VALIDATION];
    let mut features =
        vk::ValidationFeaturesEXT::default().enabled_validation_features(&synchronization);
    let mut messenger = validation::messenger_info(messages);
    let mut info = vk::InstanceCreateInfo::default()
        .application_info(&application)
        .enabled_layer_names(&enabled_layers)
        .enabled_extension_names(&enabled_extensions);
    if validate {
        info = info.push_next(&mut features).push_next(&mut messenger);
    }
    // SAFETY: all that `info` points to outlives the call.
    let instance =
        unsafe { entry.create_instance(&info, None) }.map_err(failed("vkCreateInstance"))?;
    Ok((instance, debug))
}

/// Destroys an instance that no device was opened on.
pub(super) struct InstanceGuard(pub Option<ash::Instance>);

impl InstanceGuard {
    pub fn release(mut self) -> ash::Instance {
        self.0.take().expect("released once")
    }
}

impl Drop for InstanceGuard {
    fn drop(&mut self) {
        if let Some(instance) = &self.0 {
            // SAFETY: nothing was created on it, or it was destroyed before.
            unsafe { instance.destroy_instance(None) };
        }
    }
}
