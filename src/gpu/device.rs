//! An open device.

use std::ffi::CString;
use std::mem::ManuallyDrop;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};

use ash::vk::Handle;
use ash::{ext, khr, vk};
use gpu_allocator::vulkan::Allocator;

use super::create::{create_allocator, create_cache, create_device, tells_costs, tick_ns};
use super::failed::failed;
use super::host_device::HostDevice;
use super::instance::{InstanceGuard, create_instance, load};
use super::physical::{DeviceInfo, describe, pick};
use super::requirements::{self, Limits};
use super::validation::{self, Messages};
use crate::error::{Error, Result};

/// How to open a device.
#[derive(Debug, Clone, Default)]
pub struct Options {
    /// A part of the device's name, in any case, or its whole UUID in hexadecimal digits. None: discrete before integrated before CPU.
    pub device: Option<String>,
    /// Run under the Khronos validation layer with synchronization validation.
    pub validate: bool,
    /// Folder for the pipeline cache, which is read at opening and written at closing.
    pub cache_folder: Option<PathBuf>,
    /// [byte] Plans that take more are refused. None: those that take more than the device has.
    pub max_memory: Option<u64>,
    /// Pipelines can say what they cost ([`ComputePass::costs`](super::ComputePass::costs)), where the driver tells. They are compiled
    /// anew each time then.
    pub costs: bool,
    /// Where all Vulkan functions come from, which must stay there while the device is open. None: the
    /// system's loader.
    pub loader: Option<vk::PFN_vkGetInstanceProcAddr>,
}

/// An open device. Everything that lives on it keeps it open.
pub struct Gpu {
    /// None: the device is a host's, as is all that it was made of.
    entry: Option<ash::Entry>,
    instance: ash::Instance,
    physical: vk::PhysicalDevice,
    messenger: Option<(ext::debug_utils::Instance, vk::DebugUtilsMessengerEXT)>,
    messages: Messages,
    pub(super) device: ash::Device,
    pub(super) debug: Option<ext::debug_utils::Device>,
    /// Null: the device is a host's, who alone submits to it.
    pub(super) queue: vk::Queue,
    /// Queue submissions need external synchronization.
    pub(super) submission: Mutex<()>,
    /// Something was.
    pub(super) submitted: AtomicBool,
    pub(super) family: u32,
    pub(super) allocator: ManuallyDrop<Mutex<Allocator>>,
    pub(super) cache: vk::PipelineCache,
    cache_file: Option<PathBuf>,
    pub(super) statistics: Option<khr::pipeline_executable_properties::Device>,
    /// [ns] Length of a timestamp tick; 0 = the queue has no timestamps.
    pub(super) tick_ns: f64,
    callbacks: Option<Callbacks>,
    pub limits: Limits,
    pub info: DeviceInfo,
}

/// A host's functions for memory on the host.
struct Callbacks(vk::AllocationCallbacks<'static>);

// SAFETY: the host promises functions that any thread may call.
unsafe impl Send for Callbacks {}
// SAFETY: as above.
unsafe impl Sync for Callbacks {}

impl Gpu {
    /// Opens a device. Errors: no Vulkan, no such device, something required is missing, or a call failed.
    pub fn open(options: &Options) -> Result<Arc<Self>> {
        let entry = load(options.loader)?;
        let messages = Messages::default();
        let (instance, debug) = create_instance(&entry, options.validate, &messages)?;
        let guard = InstanceGuard(Some(instance));
        let instance = guard.0.as_ref().expect("taken only at the end");
        let (physical, info) = pick(instance, options.device.as_deref())?;
        let family = requirements::queue_family(instance, physical).ok_or_else(|| {
            Error::Unsupported("no queue family with graphics and compute".into())
        })?;
        let messenger = if options.validate {
            let debug_instance = ext::debug_utils::Instance::new(&entry, instance);
            // SAFETY: `messages` is kept until after the instance is destroyed.
            let messenger = unsafe {
                debug_instance
                    .create_debug_utils_messenger(&validation::messenger_info(&messages), None)
            }
            .map_err(failed("vkCreateDebugUtilsMessengerEXT"))?;
            Some((debug_instance, messenger))
        } else {
            None
        };
        let costs = options.costs && tells_costs(instance, physical);
        let opened = create_device(instance, physical, family, costs).and_then(|device| {
            create_allocator(instance, physical, &device)
                .inspect_err(|_| unsafe {
                    // SAFETY: nothing was created on it.
                    device.destroy_device(None)
                })
                .map(|allocator| (device, allocator))
        });
        let (device, allocator) = match opened {
            Ok(opened) => opened,
            Err(error) => {
                if let Some((debug_instance, messenger)) = &messenger {
                    // SAFETY: destroyed once, before its instance.
                    unsafe { debug_instance.destroy_debug_utils_messenger(*messenger, None) };
                }
                return Err(error);
            }
        };
        let tick_ns = tick_ns(instance, physical, family);
        let limits = Limits {
            allowed_bytes: options.max_memory.unwrap_or(u64::MAX),
            ..requirements::limits(instance, physical)
        };
        let debug = debug.then(|| ext::debug_utils::Device::new(instance, &device));
        // SAFETY: the family has at least one queue.
        let queue = unsafe { device.get_device_queue(family, 0) };
        // What is found in a cache has no statistics.
        let cache_file = options
            .cache_folder
            .as_ref()
            .filter(|_| !costs)
            .map(|folder| folder.join(format!("pipelines-{}.bin", info.uuid)));
        let cache = create_cache(&device, cache_file.as_deref(), None);
        let statistics =
            costs.then(|| khr::pipeline_executable_properties::Device::new(instance, &device));
        Ok(Arc::new(Self {
            entry: Some(entry),
            instance: guard.release(),
            physical,
            messenger,
            messages,
            device,
            debug,
            queue,
            submission: Mutex::new(()),
            family,
            allocator: ManuallyDrop::new(Mutex::new(allocator)),
            cache,
            cache_file,
            statistics,
            submitted: AtomicBool::new(false),
            tick_ns,
            callbacks: None,
            limits,
            info,
        }))
    }

    /// A device that belongs to a host, and stays the host's: nothing is submitted to it or waited for.
    ///
    /// # Errors
    /// It lacks something that is required, the host has not enabled it, or a call failed.
    ///
    /// # Safety
    /// The handles are alive, belong together, and outlive the result and all that lives on it; what is said to be
    /// enabled is.
    pub unsafe fn adopt(host: HostDevice) -> Result<Arc<Self>> {
        // SAFETY: the caller's promise.
        let instance =
            unsafe { requirements::load_instance(host.get_instance_proc_addr, host.instance) }?;
        requirements::check_host(&instance, &host)?;
        // SAFETY: the caller's promise.
        let device = unsafe { ash::Device::load(instance.fp_v1_0(), host.device) };
        let debug = (host.debug_utils).then(|| ext::debug_utils::Device::new(&instance, &device));
        let callbacks = host.callbacks.map(Callbacks);
        let allocator = create_allocator(&instance, host.physical, &device)?;
        let cache = create_cache(
            &device,
            None,
            callbacks.as_ref().map(|callbacks| &callbacks.0),
        );
        Ok(Arc::new(Self {
            entry: None,
            physical: host.physical,
            messenger: None,
            messages: Messages::default(),
            debug,
            queue: vk::Queue::null(),
            submission: Mutex::new(()),
            family: host.family,
            allocator: ManuallyDrop::new(Mutex::new(allocator)),
            cache,
            cache_file: None,
            statistics: None,
            submitted: AtomicBool::new(false),
            tick_ns: 0.0,
            callbacks,
            limits: requirements::limits(&instance, host.physical),
            info: describe(&instance, host.physical),
            instance,
            device,
        }))
    }

    /// Whether work can be submitted; otherwise the device is a host's.
    pub fn has_queue(&self) -> bool {
        !self.queue.is_null()
    }

    /// A host's functions for memory on the host. (Device memory is the allocator's business, which takes none.)
    pub(super) fn callbacks(&self) -> Option<&vk::AllocationCallbacks<'static>> {
        self.callbacks.as_ref().map(|callbacks| &callbacks.0)
    }

    /// What a format can be used for, optimally tiled.
    pub(super) fn format_features(&self, format: vk::Format) -> vk::FormatFeatureFlags {
        // SAFETY: a plain query on a device of this instance.
        unsafe {
            self.instance
                .get_physical_device_format_properties(self.physical, format)
        }
        .optimal_tiling_features
    }

    /// The raw device, for those who record commands of their own.
    pub fn raw(&self) -> (&ash::Instance, &ash::Device, vk::Queue, u32) {
        (&self.instance, &self.device, self.queue, self.family)
    }

    /// A handle on the validation layer's warnings and errors that stays valid after the device is gone:
    /// the last ones come when it is destroyed.
    pub fn validation_messages(&self) -> Arc<Mutex<Vec<String>>> {
        self.messages.clone()
    }

    /// [byte] Memory that what lives on the device takes.
    pub fn memory_in_use(&self) -> u64 {
        let allocator = self.allocator.lock();
        allocator.map_or(0, |allocator| {
            allocator.generate_report().total_allocated_bytes
        })
    }

    /// Names an object for the validation layer and for frame debuggers.
    pub(super) fn name<T: vk::Handle>(&self, object: T, name: &str) {
        let (Some(debug), Ok(name)) = (&self.debug, CString::new(name)) else {
            return;
        };
        let info = vk::DebugUtilsObjectNameInfoEXT::default()
            .object_handle(object)
            .object_name(&name);
        // SAFETY: the handle belongs to this device. A name that can't be set is no loss.
        let _ = unsafe { debug.set_debug_utils_object_name(&info) };
    }

    /// Waits until the queue is idle; errors only if the device is lost. A host waits for its own.
    pub fn wait(&self) -> Result<()> {
        if !self.has_queue() {
            return Ok(());
        }
        let _one_at_a_time = self.submission.lock();
        // SAFETY: the queue is externally synchronized by the lock.
        unsafe { self.device.queue_wait_idle(self.queue) }.map_err(failed("vkQueueWaitIdle"))
    }

    fn store_cache(&self) {
        let Some(file) = &self.cache_file else { return };
        // SAFETY: the cache is alive.
        let Ok(data) = (unsafe { self.device.get_pipeline_cache_data(self.cache) }) else {
            return;
        };
        let Some(folder) = file.parent() else { return };
        // A cache that can't be stored is no loss: the pipelines are built again next time.
        let partial = file.with_extension(format!("{}.partial", std::process::id()));
        let stored = std::fs::create_dir_all(folder)
            .and_then(|()| std::fs::write(&partial, data))
            .and_then(|()| std::fs::rename(&partial, file));
        if stored.is_err() {
            let _ = std::fs::remove_file(&partial);
        }
    }
}

impl Drop for Gpu {
    fn drop(&mut self) {
        // SAFETY: everything that lives on the device keeps an Arc of it, so nothing is left; each
        // object is destroyed once, children before parents.
        unsafe {
            // Devices that only compile cannot wait.
            if self.entry.is_some() && self.submitted.load(Ordering::Relaxed) {
                let _ = self.device.device_wait_idle();
            }
            self.store_cache();
            self.device
                .destroy_pipeline_cache(self.cache, self.callbacks());
            ManuallyDrop::drop(&mut self.allocator);
            if self.entry.is_none() {
                return;
            }
            self.device.destroy_device(None);
            if let Some((debug, messenger)) = &self.messenger {
                debug.destroy_debug_utils_messenger(*messenger, None);
            }
            self.instance.destroy_instance(None);
        }
    }
}
