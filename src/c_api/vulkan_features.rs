//! The chain of features that a host enables.

use ash::vk;

use super::call_result::{CallResult, Fault};
use super::vulkan_names::VkPhysicalDeviceFeatures2;
use crate::gpu::Enabled;

/// Where the required features stand in a chain; null = its structure is not there.
struct Places {
    shader_storage_image_extended_formats: *mut vk::Bool32,
    scalar_block_layout: *mut vk::Bool32,
    dynamic_rendering: *mut vk::Bool32,
    synchronization2: *mut vk::Bool32,
    maintenance4: *mut vk::Bool32,
}

impl Places {
    /// # Safety
    /// The chain is one of Vulkan's structures, each as its type says.
    unsafe fn find(features: *mut VkPhysicalDeviceFeatures2) -> CallResult<Self> {
        if features.is_null() || !features.is_aligned() {
            return Err(Fault::invalid("features is NULL or not aligned"));
        }
        // SAFETY: the caller's promise, here and below; addresses of fields are taken, no references.
        unsafe {
            if (*features).s_type != vk::StructureType::PHYSICAL_DEVICE_FEATURES_2 {
                return Err(Fault::invalid("features is no VkPhysicalDeviceFeatures2"));
            }
            let mut places = Self {
                shader_storage_image_extended_formats: &raw mut (*features)
                    .features
                    .shader_storage_image_extended_formats,
                scalar_block_layout: std::ptr::null_mut(),
                dynamic_rendering: std::ptr::null_mut(),
                synchronization2: std::ptr::null_mut(),
                maintenance4: std::ptr::null_mut(),
            };
            let mut next = (*features).p_next.cast::<vk::BaseOutStructure>();
            while !next.is_null() {
                places.look_at(next);
                next = (*next).p_next;
            }
            Ok(places)
        }
    }

    /// # Safety
    /// The structure is what its type says.
    unsafe fn look_at(&mut self, found: *mut vk::BaseOutStructure<'static>) {
        use vk::StructureType as Type;
        // SAFETY: the caller's promise.
        unsafe {
            match (*found).s_type {
                Type::PHYSICAL_DEVICE_VULKAN_1_2_FEATURES => {
                    let found = found.cast::<vk::PhysicalDeviceVulkan12Features>();
                    self.scalar_block_layout = &raw mut (*found).scalar_block_layout;
                }
                Type::PHYSICAL_DEVICE_VULKAN_1_3_FEATURES => {
                    let found = found.cast::<vk::PhysicalDeviceVulkan13Features>();
                    self.dynamic_rendering = &raw mut (*found).dynamic_rendering;
                    self.synchronization2 = &raw mut (*found).synchronization2;
                    self.maintenance4 = &raw mut (*found).maintenance4;
                }
                Type::PHYSICAL_DEVICE_SCALAR_BLOCK_LAYOUT_FEATURES => {
                    let found = found.cast::<vk::PhysicalDeviceScalarBlockLayoutFeatures>();
                    self.scalar_block_layout = &raw mut (*found).scalar_block_layout;
                }
                Type::PHYSICAL_DEVICE_DYNAMIC_RENDERING_FEATURES => {
                    let found = found.cast::<vk::PhysicalDeviceDynamicRenderingFeatures>();
                    self.dynamic_rendering = &raw mut (*found).dynamic_rendering;
                }
                Type::PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES => {
                    let found = found.cast::<vk::PhysicalDeviceSynchronization2Features>();
                    self.synchronization2 = &raw mut (*found).synchronization2;
                }
                Type::PHYSICAL_DEVICE_MAINTENANCE_4_FEATURES => {
                    let found = found.cast::<vk::PhysicalDeviceMaintenance4Features>();
                    self.maintenance4 = &raw mut (*found).maintenance4;
                }
                _ => {}
            }
        }
    }

    fn all(&self) -> [*mut vk::Bool32; 5] {
        [
            self.shader_storage_image_extended_formats,
            self.scalar_block_layout,
            self.dynamic_rendering,
            self.synchronization2,
            self.maintenance4,
        ]
    }
}

/// What a chain enables.
///
/// # Safety
/// `features` is NULL or a chain of Vulkan's structures, each as its type says.
pub unsafe fn enabled(features: *const VkPhysicalDeviceFeatures2) -> CallResult<Enabled> {
    // SAFETY: the caller's promise; nothing is written.
    let places = unsafe { Places::find(features.cast_mut()) }?;
    // SAFETY: null, or a field of a structure of the chain.
    let on = |place: *mut vk::Bool32| !place.is_null() && unsafe { *place } == vk::TRUE;
    Ok(Enabled {
        shader_storage_image_extended_formats: on(places.shader_storage_image_extended_formats),
        scalar_block_layout: on(places.scalar_block_layout),
        dynamic_rendering: on(places.dynamic_rendering),
        synchronization2: on(places.synchronization2),
        maintenance4: on(places.maintenance4),
    })
}

/// Sets the required features in a chain and leaves all others as they are.
///
/// # Safety
/// As for [`enabled`], and nothing else uses the chain during the call.
pub unsafe fn require(features: *mut VkPhysicalDeviceFeatures2) -> CallResult {
    // SAFETY: the caller's promise.
    let places = unsafe { Places::find(features) }?.all();
    if places.iter().any(|place| place.is_null()) {
        return Err(Fault::invalid(
            "the chain of features lacks VkPhysicalDeviceVulkan12Features or VkPhysicalDeviceVulkan13Features",
        ));
    }
    for place in places {
        // SAFETY: a field of a structure of the chain.
        unsafe { *place = vk::TRUE };
    }
    Ok(())
}
