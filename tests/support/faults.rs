//! A Vulkan loader between the engine and the system's: it writes down every call that may fail, and makes a chosen
//! one fail as a device could. Everything else goes to the system's loader.
//!
//! The table is one for the whole process, so one test at a time may use it.
#![allow(dead_code)] // Each program uses a part of it.

use std::ffi::{CStr, c_char, c_void};
use std::sync::atomic::{AtomicPtr, Ordering};
use std::sync::{Mutex, OnceLock, PoisonError};

use ash::vk;

/// What the engine has called, and which call is to fail.
#[derive(Default)]
struct Table {
    called: Vec<&'static str>,
    failing: Option<usize>,
}

static TABLE: Mutex<Table> = Mutex::new(Table {
    called: Vec::new(),
    failing: None,
});

/// The system's loader, which stays loaded.
static SYSTEM: OnceLock<ash::Entry> = OnceLock::new();

fn table<T>(work: impl FnOnce(&mut Table) -> T) -> T {
    work(&mut TABLE.lock().unwrap_or_else(PoisonError::into_inner))
}

/// Runs `work`. Returns its result, and the names of the calls that could have failed in it; that with the number
/// `failing`, counted from 0, has failed.
pub fn with_fault<T>(failing: Option<usize>, work: impl FnOnce() -> T) -> (T, Vec<&'static str>) {
    table(|table| {
        *table = Table {
            failing,
            called: Vec::new(),
        };
    });
    let result = work();
    let called = table(|table| std::mem::take(table).called);
    (result, called)
}

/// Writes a call down. Whether it has to fail.
fn fails(name: &'static str) -> bool {
    table(|table| {
        table.called.push(name);
        table.failing == Some(table.called.len() - 1)
    })
}

/// Functions that may fail, each with its arguments and the error with which it fails here. Those marked `after` are
/// carried out and fail then, since they wait for what the device is busy with.
macro_rules! interpose {
    ($($name:ident($($argument:ident: $ty:ty),*) = $error:ident $($after:ident)?;)*) => {
        $(#[allow(non_snake_case)]
        mod $name {
            #[allow(unused_imports)] // Not every function needs all of them.
            use super::{Callbacks, c_char, c_void, vk};
            use std::sync::atomic::{AtomicPtr, Ordering};

            type Function = unsafe extern "system" fn($($ty),*) -> vk::Result;
            static REAL: AtomicPtr<()> = AtomicPtr::new(std::ptr::null_mut());

            pub unsafe extern "system" fn interposed($($argument: $ty),*) -> vk::Result {
                let fails = super::fails(stringify!($name));
                let waits = false $(|| stringify!($after) == "after")?;
                if fails && !waits {
                    return vk::Result::$error;
                }
                let real = REAL.load(Ordering::Acquire);
                // SAFETY: it was set before this function was given out, to the function of this name; the
                // arguments are those that the caller has given for it.
                let result = unsafe {
                    std::mem::transmute::<*mut (), Function>(real)($($argument),*)
                };
                if fails { vk::Result::$error } else { result }
            }

            pub fn wrap(real: unsafe extern "system" fn()) -> unsafe extern "system" fn() {
                // Anew each time: a driver that was unloaded may come back elsewhere.
                REAL.store(real as *mut (), Ordering::Release);
                // SAFETY: the caller knows by the name what type the function has.
                unsafe { std::mem::transmute::<Function, unsafe extern "system" fn()>(interposed) }
            }
        })*

        /// What to give out instead of a function.
        fn wrapped(name: &CStr, real: unsafe extern "system" fn()) -> unsafe extern "system" fn() {
            match name.to_str() {
                $(Ok(stringify!($name)) => $name::wrap(real),)*
                _ => real,
            }
        }

        /// The names of all functions in the table.
        pub const NAMES: &[&str] = &[$(stringify!($name)),*];
    };
}

type Callbacks = *const vk::AllocationCallbacks<'static>;

interpose! {
    vkEnumerateInstanceLayerProperties(count: *mut u32, list: *mut vk::LayerProperties) = ERROR_OUT_OF_HOST_MEMORY;
    vkEnumerateInstanceExtensionProperties(layer: *const c_char, count: *mut u32, list: *mut vk::ExtensionProperties)
        = ERROR_OUT_OF_HOST_MEMORY;
    vkCreateInstance(info: *const vk::InstanceCreateInfo, callbacks: Callbacks, made: *mut vk::Instance)
        = ERROR_INITIALIZATION_FAILED;
    vkEnumeratePhysicalDevices(instance: vk::Instance, count: *mut u32, list: *mut vk::PhysicalDevice)
        = ERROR_INITIALIZATION_FAILED;
    vkCreateDebugUtilsMessengerEXT(instance: vk::Instance, info: *const vk::DebugUtilsMessengerCreateInfoEXT,
        callbacks: Callbacks, made: *mut vk::DebugUtilsMessengerEXT) = ERROR_OUT_OF_HOST_MEMORY;
    vkCreateDevice(device: vk::PhysicalDevice, info: *const vk::DeviceCreateInfo, callbacks: Callbacks,
        made: *mut vk::Device) = ERROR_TOO_MANY_OBJECTS;
    vkCreatePipelineCache(device: vk::Device, info: *const vk::PipelineCacheCreateInfo, callbacks: Callbacks,
        made: *mut vk::PipelineCache) = ERROR_OUT_OF_HOST_MEMORY;
    vkAllocateMemory(device: vk::Device, info: *const vk::MemoryAllocateInfo, callbacks: Callbacks,
        made: *mut vk::DeviceMemory) = ERROR_OUT_OF_DEVICE_MEMORY;
    vkMapMemory(device: vk::Device, memory: vk::DeviceMemory, offset: vk::DeviceSize, size: vk::DeviceSize,
        flags: vk::MemoryMapFlags, pointer: *mut *mut c_void) = ERROR_MEMORY_MAP_FAILED;
    vkCreateBuffer(device: vk::Device, info: *const vk::BufferCreateInfo, callbacks: Callbacks, made: *mut vk::Buffer)
        = ERROR_OUT_OF_HOST_MEMORY;
    vkBindBufferMemory(device: vk::Device, buffer: vk::Buffer, memory: vk::DeviceMemory, offset: vk::DeviceSize)
        = ERROR_OUT_OF_DEVICE_MEMORY;
    vkCreateImage(device: vk::Device, info: *const vk::ImageCreateInfo, callbacks: Callbacks, made: *mut vk::Image)
        = ERROR_OUT_OF_HOST_MEMORY;
    vkBindImageMemory(device: vk::Device, image: vk::Image, memory: vk::DeviceMemory, offset: vk::DeviceSize)
        = ERROR_OUT_OF_DEVICE_MEMORY;
    vkCreateImageView(device: vk::Device, info: *const vk::ImageViewCreateInfo, callbacks: Callbacks,
        made: *mut vk::ImageView) = ERROR_OUT_OF_HOST_MEMORY;
    vkCreateShaderModule(device: vk::Device, info: *const vk::ShaderModuleCreateInfo, callbacks: Callbacks,
        made: *mut vk::ShaderModule) = ERROR_OUT_OF_HOST_MEMORY;
    vkCreateDescriptorSetLayout(device: vk::Device, info: *const vk::DescriptorSetLayoutCreateInfo,
        callbacks: Callbacks, made: *mut vk::DescriptorSetLayout) = ERROR_OUT_OF_HOST_MEMORY;
    vkCreatePipelineLayout(device: vk::Device, info: *const vk::PipelineLayoutCreateInfo, callbacks: Callbacks,
        made: *mut vk::PipelineLayout) = ERROR_OUT_OF_HOST_MEMORY;
    vkCreateDescriptorPool(device: vk::Device, info: *const vk::DescriptorPoolCreateInfo, callbacks: Callbacks,
        made: *mut vk::DescriptorPool) = ERROR_OUT_OF_DEVICE_MEMORY;
    vkAllocateDescriptorSets(device: vk::Device, info: *const vk::DescriptorSetAllocateInfo,
        made: *mut vk::DescriptorSet) = ERROR_OUT_OF_POOL_MEMORY;
    vkCreateComputePipelines(device: vk::Device, cache: vk::PipelineCache, count: u32,
        infos: *const vk::ComputePipelineCreateInfo, callbacks: Callbacks, made: *mut vk::Pipeline)
        = ERROR_OUT_OF_HOST_MEMORY;
    vkCreateGraphicsPipelines(device: vk::Device, cache: vk::PipelineCache, count: u32,
        infos: *const vk::GraphicsPipelineCreateInfo, callbacks: Callbacks, made: *mut vk::Pipeline)
        = ERROR_OUT_OF_DEVICE_MEMORY;
    vkCreateCommandPool(device: vk::Device, info: *const vk::CommandPoolCreateInfo, callbacks: Callbacks,
        made: *mut vk::CommandPool) = ERROR_OUT_OF_HOST_MEMORY;
    vkResetCommandPool(device: vk::Device, pool: vk::CommandPool, flags: vk::CommandPoolResetFlags)
        = ERROR_OUT_OF_DEVICE_MEMORY;
    vkAllocateCommandBuffers(device: vk::Device, info: *const vk::CommandBufferAllocateInfo,
        made: *mut vk::CommandBuffer) = ERROR_OUT_OF_HOST_MEMORY;
    vkBeginCommandBuffer(commands: vk::CommandBuffer, info: *const vk::CommandBufferBeginInfo)
        = ERROR_OUT_OF_HOST_MEMORY;
    vkEndCommandBuffer(commands: vk::CommandBuffer) = ERROR_OUT_OF_HOST_MEMORY after;
    vkCreateFence(device: vk::Device, info: *const vk::FenceCreateInfo, callbacks: Callbacks, made: *mut vk::Fence)
        = ERROR_OUT_OF_HOST_MEMORY;
    vkResetFences(device: vk::Device, count: u32, fences: *const vk::Fence) = ERROR_OUT_OF_DEVICE_MEMORY;
    vkWaitForFences(device: vk::Device, count: u32, fences: *const vk::Fence, all: vk::Bool32, timeout: u64)
        = ERROR_DEVICE_LOST after;
    vkCreateQueryPool(device: vk::Device, info: *const vk::QueryPoolCreateInfo, callbacks: Callbacks,
        made: *mut vk::QueryPool) = ERROR_OUT_OF_DEVICE_MEMORY;
    vkGetQueryPoolResults(device: vk::Device, pool: vk::QueryPool, first: u32, count: u32, size: usize,
        data: *mut c_void, stride: vk::DeviceSize, flags: vk::QueryResultFlags) = ERROR_DEVICE_LOST;
    vkQueueSubmit2(queue: vk::Queue, count: u32, infos: *const vk::SubmitInfo2, fence: vk::Fence) = ERROR_DEVICE_LOST;
    vkQueueWaitIdle(queue: vk::Queue) = ERROR_DEVICE_LOST after;
}

/// The loader to open a device with.
///
/// # Safety
/// As for the system's.
pub unsafe extern "system" fn loader(
    instance: vk::Instance,
    name: *const c_char,
) -> vk::PFN_vkVoidFunction {
    // SAFETY: the system's loader is taken as it is; the name is a string, as the caller promises.
    unsafe {
        let system = SYSTEM.get_or_init(|| ash::Entry::load().expect("a Vulkan loader"));
        let real = (system.static_fn().get_instance_proc_addr)(instance, name)?;
        match CStr::from_ptr(name).to_bytes() {
            b"vkGetDeviceProcAddr" => {
                DEVICE_FUNCTIONS.store(real as *mut (), Ordering::Release);
                let ours: vk::PFN_vkGetDeviceProcAddr = device_function;
                Some(std::mem::transmute::<
                    vk::PFN_vkGetDeviceProcAddr,
                    unsafe extern "system" fn(),
                >(ours))
            }
            _ => Some(wrapped(CStr::from_ptr(name), real)),
        }
    }
}

/// The system's `vkGetDeviceProcAddr`.
static DEVICE_FUNCTIONS: AtomicPtr<()> = AtomicPtr::new(std::ptr::null_mut());

unsafe extern "system" fn device_function(
    device: vk::Device,
    name: *const c_char,
) -> vk::PFN_vkVoidFunction {
    let real = DEVICE_FUNCTIONS.load(Ordering::Acquire);
    // SAFETY: it was set before this function was given out; the rest is as the caller promises.
    unsafe {
        let real = std::mem::transmute::<*mut (), vk::PFN_vkGetDeviceProcAddr>(real);
        Some(wrapped(CStr::from_ptr(name), real(device, name)?))
    }
}
