//! Pipelines whose resources are bound by the names that the shaders give them.

use std::collections::BTreeMap;
use std::sync::Arc;

use ash::vk;

use super::cost::Cost;
use super::device::Gpu;
use super::failed::failed;
use super::host::HostImage;
use super::pipeline::{GraphicsState, create_compute_pipeline, create_graphics_pipeline};
use super::resources::{Resource, Resources};
use super::shader::{Binding, BindingKind, Constants, Shader};
use crate::error::{Error, Result};
use crate::shared::Push;

/// A pipeline with everything bound: ready to be recorded any number of times.
pub(super) struct Pass {
    gpu: Arc<Gpu>,
    pub(super) pipeline: vk::Pipeline,
    pub(super) layout: vk::PipelineLayout,
    /// One for each list of resources that it was made with.
    sets: Vec<vk::DescriptorSet>,
    set_layout: vk::DescriptorSetLayout,
    pool: vk::DescriptorPool,
}

/// A compute shader with its resources.
pub struct ComputePass(Pass);

/// A pair of vertex and fragment shader with their resources.
pub struct GraphicsPass(Pass);

/// A pass with one of the lists of resources that it was made with.
#[derive(Clone, Copy)]
pub struct Bound<'a> {
    pass: &'a Pass,
    set: vk::DescriptorSet,
}

impl Bound<'_> {
    /// Binds pipeline and resources, and pushes.
    pub(super) fn record(
        &self,
        device: &ash::Device,
        commands: vk::CommandBuffer,
        point: vk::PipelineBindPoint,
        stages: vk::ShaderStageFlags,
        push: Push,
    ) {
        let layout = self.pass.layout;
        // SAFETY: recording; the pass and what it binds are alive until submission ends.
        unsafe {
            device.cmd_bind_pipeline(commands, point, self.pass.pipeline);
            device.cmd_bind_descriptor_sets(commands, point, layout, 0, &[self.set], &[]);
            device.cmd_push_constants(commands, layout, stages, 0, bytemuck::bytes_of(&push));
        }
    }
}

impl<'a> From<&'a ComputePass> for Bound<'a> {
    fn from(pass: &'a ComputePass) -> Self {
        pass.with(0)
    }
}

impl<'a> From<&'a GraphicsPass> for Bound<'a> {
    fn from(pass: &'a GraphicsPass) -> Self {
        pass.with(0)
    }
}

/// Where a pass finds its resources: in the first of these that has the name.
pub type Sources<'a> = [&'a Resources];

impl ComputePass {
    /// `name` is the debug name. Errors: a resource that the shader names is missing or of another
    /// kind, or a Vulkan call failed.
    pub fn new(
        gpu: &Arc<Gpu>,
        name: &str,
        shader: &str,
        constants: &Constants,
        resources: &Resources,
    ) -> Result<Self> {
        Self::with_each(gpu, name, shader, constants, &[&[resources]])
    }

    /// A pass that can be recorded with each of several lists of resources; without any it can only say what it costs.
    ///
    /// # Errors
    /// As for [`Self::new`].
    pub fn with_each(
        gpu: &Arc<Gpu>,
        name: &str,
        shader: &str,
        constants: &Constants,
        lists: &[&Sources],
    ) -> Result<Self> {
        let shader = Shader::find(shader)?;
        let stages = vk::ShaderStageFlags::COMPUTE;
        let mut pass = Pass::bind(gpu, name, &[shader], lists, stages)?;
        pass.pipeline = create_compute_pipeline(gpu, name, shader, constants, pass.layout)?;
        gpu.name(pass.pipeline, name);
        Ok(Self(pass))
    }

    /// With the list of resources of that number, or the first.
    pub fn with(&self, list: usize) -> Bound<'_> {
        self.0.with(list)
    }

    /// What the driver says that its shaders cost. Empty unless the device is open for it.
    ///
    /// # Errors
    /// A Vulkan call failed.
    pub fn costs(&self) -> Result<Vec<Cost>> {
        self.0.gpu.costs_of(self.0.pipeline)
    }
}

impl GraphicsPass {
    /// As `ComputePass::new`.
    pub fn new(
        gpu: &Arc<Gpu>,
        name: &str,
        state: &GraphicsState,
        constants: &Constants,
        resources: &Resources,
    ) -> Result<Self> {
        Self::with_each(gpu, name, state, constants, &[&[resources]])
    }

    /// As `ComputePass::with_each`.
    pub fn with_each(
        gpu: &Arc<Gpu>,
        name: &str,
        state: &GraphicsState,
        constants: &Constants,
        lists: &[&Sources],
    ) -> Result<Self> {
        let vertex = Shader::find(state.vertex)?;
        let fragment = state.fragment.map(Shader::find).transpose()?;
        let shaders: Vec<&Shader> = [Some(vertex), fragment].into_iter().flatten().collect();
        let stages = vk::ShaderStageFlags::VERTEX | vk::ShaderStageFlags::FRAGMENT;
        let mut pass = Pass::bind(gpu, name, &shaders, lists, stages)?;
        pass.pipeline =
            create_graphics_pipeline(gpu, name, state, vertex, fragment, constants, pass.layout)?;
        gpu.name(pass.pipeline, name);
        Ok(Self(pass))
    }

    /// With the list of resources of that number, or the first.
    pub fn with(&self, list: usize) -> Bound<'_> {
        self.0.with(list)
    }

    /// As `ComputePass::costs`.
    pub fn costs(&self) -> Result<Vec<Cost>> {
        self.0.gpu.costs_of(self.0.pipeline)
    }
}

impl Pass {
    fn with(&self, list: usize) -> Bound<'_> {
        Bound {
            pass: self,
            set: *self.sets.get(list).unwrap_or(&self.sets[0]),
        }
    }

    /// Layouts, and a descriptor set for each list of the resources that the shaders name.
    fn bind(
        gpu: &Arc<Gpu>,
        name: &str,
        shaders: &[&Shader],
        lists: &[&Sources],
        stages: vk::ShaderStageFlags,
    ) -> Result<Self> {
        // Shaders of one pass share a number where they share a name.
        let bindings: BTreeMap<u32, Binding> = shaders
            .iter()
            .flat_map(|shader| shader.bindings)
            .map(|b| (b.binding, *b))
            .collect();
        let mut pass = Self {
            gpu: gpu.clone(),
            pipeline: vk::Pipeline::null(),
            layout: vk::PipelineLayout::null(),
            sets: Vec::new(),
            set_layout: vk::DescriptorSetLayout::null(),
            pool: vk::DescriptorPool::null(),
        };
        pass.create_layouts(name, &bindings, stages)?;
        if lists.is_empty() {
            return Ok(pass);
        }
        pass.create_sets(name, &bindings, lists.len())?;
        for (set, sources) in pass.sets.iter().zip(lists) {
            for binding in bindings.values() {
                pass.write(name, *set, binding, sources)?;
            }
        }
        Ok(pass)
    }

    fn create_layouts(
        &mut self,
        name: &str,
        bindings: &BTreeMap<u32, Binding>,
        stages: vk::ShaderStageFlags,
    ) -> Result<()> {
        let entries: Vec<_> = bindings
            .values()
            .map(|b| {
                vk::DescriptorSetLayoutBinding::default()
                    .binding(b.binding)
                    .descriptor_type(descriptor_type(b.kind))
                    .descriptor_count(1)
                    .stage_flags(stages)
            })
            .collect();
        let device = &self.gpu.device;
        // SAFETY: all that the infos point to outlives the calls; `Drop` destroys what is created.
        unsafe {
            self.set_layout = device
                .create_descriptor_set_layout(
                    &vk::DescriptorSetLayoutCreateInfo::default().bindings(&entries),
                    self.gpu.callbacks(),
                )
                .map_err(failed(&format!("vkCreateDescriptorSetLayout of {name}")))?;
            let push = [vk::PushConstantRange::default()
                .stage_flags(stages)
                .size(size_of::<Push>() as u32)];
            self.layout = device
                .create_pipeline_layout(
                    &vk::PipelineLayoutCreateInfo::default()
                        .set_layouts(&[self.set_layout])
                        .push_constant_ranges(&push),
                    self.gpu.callbacks(),
                )
                .map_err(failed(&format!("vkCreatePipelineLayout of {name}")))?;
        }
        Ok(())
    }

    fn create_sets(
        &mut self,
        name: &str,
        bindings: &BTreeMap<u32, Binding>,
        count: usize,
    ) -> Result<()> {
        let sizes: Vec<_> = bindings
            .values()
            .map(|b| {
                vk::DescriptorPoolSize::default()
                    .ty(descriptor_type(b.kind))
                    .descriptor_count(count as u32)
            })
            .collect();
        let layouts = vec![self.set_layout; count];
        let device = &self.gpu.device;
        // SAFETY: all that the infos point to outlives the calls; the pool frees the sets.
        unsafe {
            self.pool = device
                .create_descriptor_pool(
                    &vk::DescriptorPoolCreateInfo::default()
                        .max_sets(count as u32)
                        .pool_sizes(&sizes),
                    self.gpu.callbacks(),
                )
                .map_err(failed(&format!("vkCreateDescriptorPool of {name}")))?;
            self.sets = device
                .allocate_descriptor_sets(
                    &vk::DescriptorSetAllocateInfo::default()
                        .descriptor_pool(self.pool)
                        .set_layouts(&layouts),
                )
                .map_err(failed(&format!("vkAllocateDescriptorSets of {name}")))?;
        }
        for set in &self.sets {
            self.gpu.name(*set, name);
        }
        Ok(())
    }

    fn write(
        &self,
        name: &str,
        set: vk::DescriptorSet,
        binding: &Binding,
        sources: &Sources,
    ) -> Result<()> {
        let write = vk::WriteDescriptorSet::default()
            .dst_set(set)
            .dst_binding(binding.binding)
            .descriptor_type(descriptor_type(binding.kind));
        // SAFETY: the set is in no use yet, and the resource is of the declared kind; so too below.
        let update = |write: vk::WriteDescriptorSet| unsafe {
            self.gpu.device.update_descriptor_sets(&[write], &[]);
        };
        let buffer = |buffer, offset, range| {
            let info = [vk::DescriptorBufferInfo {
                buffer,
                offset,
                range,
            }];
            update(write.buffer_info(&info));
        };
        let image = |view, layout| {
            let info = [vk::DescriptorImageInfo::default()
                .image_view(view)
                .image_layout(layout)];
            update(write.image_info(&info));
        };
        let found = sources.iter().find_map(|source| source.get(binding.name));
        match (found, binding.kind) {
            (Some(Resource::Buffer(own)), BindingKind::StorageBuffer) => {
                buffer(own.raw, 0, vk::WHOLE_SIZE);
            }
            (Some(Resource::HostBuffer(lent)), BindingKind::StorageBuffer) => {
                buffer(lent.raw, lent.offset, lent.range);
            }
            (Some(Resource::Image(own)), BindingKind::StorageImage | BindingKind::SampledImage) => {
                image(own.view, vk::ImageLayout::GENERAL)
            }
            (Some(Resource::HostImage(lent)), BindingKind::SampledImage) => {
                image(lent.view, HostImage::SAMPLED);
            }
            (found, kind) => {
                let what = if found.is_some() {
                    "of another kind"
                } else {
                    "missing"
                };
                return Err(Error::Unsupported(format!(
                    "{name}: {} ({kind:?}) is {what}",
                    binding.name
                )));
            }
        }
        Ok(())
    }
}

impl Drop for Pass {
    fn drop(&mut self) {
        let (device, callbacks) = (&self.gpu.device, self.gpu.callbacks());
        // SAFETY: destroyed once, null handles are ignored; whoever submitted work has waited for it.
        unsafe {
            device.destroy_pipeline(self.pipeline, callbacks);
            device.destroy_pipeline_layout(self.layout, callbacks);
            device.destroy_descriptor_pool(self.pool, callbacks);
            device.destroy_descriptor_set_layout(self.set_layout, callbacks);
        }
    }
}

fn descriptor_type(kind: BindingKind) -> vk::DescriptorType {
    match kind {
        BindingKind::StorageBuffer => vk::DescriptorType::STORAGE_BUFFER,
        BindingKind::StorageImage => vk::DescriptorType::STORAGE_IMAGE,
        BindingKind::SampledImage => vk::DescriptorType::SAMPLED_IMAGE,
    }
}
