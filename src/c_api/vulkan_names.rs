//! Vulkan's types under the names of its C header, which `halfshade_vulkan.h` uses as they stand.

#![allow(non_camel_case_types)]

use ash::vk;

pub type VkInstance = vk::Instance;
pub type VkPhysicalDevice = vk::PhysicalDevice;
pub type VkDevice = vk::Device;
pub type VkCommandBuffer = vk::CommandBuffer;
pub type VkImage = vk::Image;
pub type VkBuffer = vk::Buffer;
pub type VkFormat = vk::Format;
pub type VkFormatFeatureFlags = vk::FormatFeatureFlags;
pub type VkImageUsageFlags = vk::ImageUsageFlags;
pub type VkBufferUsageFlags = vk::BufferUsageFlags;
pub type VkQueueFlags = vk::QueueFlags;
pub type VkImageLayout = vk::ImageLayout;
pub type VkPipelineStageFlags2 = vk::PipelineStageFlags2;
pub type VkAccessFlags2 = vk::AccessFlags2;
pub type VkIndexType = vk::IndexType;
pub type VkDeviceSize = vk::DeviceSize;
pub type VkPhysicalDeviceFeatures2 = vk::PhysicalDeviceFeatures2<'static>;
pub type VkAllocationCallbacks = vk::AllocationCallbacks<'static>;
/// May be NULL.
pub type PFN_vkGetInstanceProcAddr = Option<vk::PFN_vkGetInstanceProcAddr>;
