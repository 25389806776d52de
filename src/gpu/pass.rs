//! Pipelines whose resources are bound by the names that the shaders give them.

use std::collections::BTreeMap;
use std::sync::Arc;

use ash::vk;

use super::device::{Gpu, failed};
use super::memory::{ImageKind, Resource, Resources};
use super::shader::{Binding, BindingKind, Shader};
use crate::error::{Error, Result};

/// Values of specialization constants: (constant id, value).
pub type Specialization = Vec<(u32, u32)>;

/// A pipeline with everything bound: ready to be recorded any number of times.
pub(super) struct Pass {
    gpu: Arc<Gpu>,
    pub(super) pipeline: vk::Pipeline,
    pub(super) layout: vk::PipelineLayout,
    pub(super) set: vk::DescriptorSet,
    set_layout: vk::DescriptorSetLayout,
    pool: vk::DescriptorPool,
}

/// A compute shader with its resources.
pub struct ComputePass(pub(super) Pass);

/// A pair of vertex and fragment shader with their resources.
pub struct GraphicsPass(pub(super) Pass);

/// The fixed part of a graphics pipeline. Triangles are filled and not culled; depth is reverse-Z.
pub struct GraphicsState<'a> {
    pub vertex: &'a str,
    /// None: only depth is written.
    pub fragment: Option<&'a str>,
    pub colors: &'a [ImageKind],
}

impl ComputePass {
    /// `name` is the debug name. Errors: a resource that the shader names is missing or of another
    /// kind, or a Vulkan call failed.
    pub fn new(
        gpu: &Arc<Gpu>,
        name: &str,
        shader: &str,
        specialization: &Specialization,
        resources: &Resources,
    ) -> Result<Self> {
        let shader = Shader::find(shader)?;
        let mut pass = Pass::bind(
            gpu,
            name,
            &[shader],
            resources,
            vk::ShaderStageFlags::COMPUTE,
        )?;
        let module = Module::new(gpu, shader)?;
        let constants = Constants::new(specialization);
        let constants = constants.info();
        let stage = module.stage(vk::ShaderStageFlags::COMPUTE, &constants);
        let info = vk::ComputePipelineCreateInfo::default()
            .stage(stage)
            .layout(pass.layout);
        // SAFETY: all that `info` points to outlives the call.
        let created = unsafe {
            gpu.device
                .create_compute_pipelines(gpu.cache, &[info], None)
        };
        pass.pipeline = created.map_err(|(_, result)| {
            failed(&format!("vkCreateComputePipelines of {name}"))(result)
        })?[0];
        gpu.name(pass.pipeline, name);
        Ok(Self(pass))
    }
}

impl GraphicsPass {
    /// As `ComputePass::new`.
    pub fn new(
        gpu: &Arc<Gpu>,
        name: &str,
        state: &GraphicsState,
        specialization: &Specialization,
        resources: &Resources,
    ) -> Result<Self> {
        let vertex = Shader::find(state.vertex)?;
        let fragment = state.fragment.map(Shader::find).transpose()?;
        let shaders: Vec<&Shader> = [Some(vertex), fragment].into_iter().flatten().collect();
        let stages = vk::ShaderStageFlags::VERTEX | vk::ShaderStageFlags::FRAGMENT;
        let mut pass = Pass::bind(gpu, name, &shaders, resources, stages)?;
        pass.pipeline = create_graphics_pipeline(
            gpu,
            name,
            state,
            vertex,
            fragment,
            specialization,
            pass.layout,
        )?;
        gpu.name(pass.pipeline, name);
        Ok(Self(pass))
    }
}

fn create_graphics_pipeline(
    gpu: &Gpu,
    name: &str,
    state: &GraphicsState,
    vertex: &Shader,
    fragment: Option<&Shader>,
    specialization: &Specialization,
    layout: vk::PipelineLayout,
) -> Result<vk::Pipeline> {
    let constants = Constants::new(specialization);
    let constants = constants.info();
    let vertex = Module::new(gpu, vertex)?;
    let fragment = fragment
        .map(|shader| Module::new(gpu, shader))
        .transpose()?;
    let mut stages = vec![vertex.stage(vk::ShaderStageFlags::VERTEX, &constants)];
    stages.extend(
        fragment
            .as_ref()
            .map(|module| module.stage(vk::ShaderStageFlags::FRAGMENT, &constants)),
    );
    let formats: Vec<vk::Format> = state.colors.iter().map(|kind| kind.format()).collect();
    let mut rendering = vk::PipelineRenderingCreateInfo::default()
        .color_attachment_formats(&formats)
        .depth_attachment_format(ImageKind::Depth.format());
    let input = vk::PipelineVertexInputStateCreateInfo::default();
    let assembly = vk::PipelineInputAssemblyStateCreateInfo::default()
        .topology(vk::PrimitiveTopology::TRIANGLE_LIST);
    let viewport = vk::PipelineViewportStateCreateInfo::default()
        .viewport_count(1)
        .scissor_count(1);
    let raster = vk::PipelineRasterizationStateCreateInfo::default()
        .polygon_mode(vk::PolygonMode::FILL)
        .cull_mode(vk::CullModeFlags::NONE)
        .line_width(1.0);
    let samples = vk::PipelineMultisampleStateCreateInfo::default()
        .rasterization_samples(vk::SampleCountFlags::TYPE_1);
    let depth = vk::PipelineDepthStencilStateCreateInfo::default()
        .depth_test_enable(true)
        .depth_write_enable(true)
        .depth_compare_op(vk::CompareOp::GREATER);
    let attachments = vec![
        vk::PipelineColorBlendAttachmentState::default()
            .color_write_mask(vk::ColorComponentFlags::RGBA);
        formats.len()
    ];
    let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&attachments);
    let dynamic = vk::PipelineDynamicStateCreateInfo::default()
        .dynamic_states(&[vk::DynamicState::VIEWPORT, vk::DynamicState::SCISSOR]);
    let info = vk::GraphicsPipelineCreateInfo::default()
        .stages(&stages)
        .vertex_input_state(&input)
        .input_assembly_state(&assembly)
        .viewport_state(&viewport)
        .rasterization_state(&raster)
        .multisample_state(&samples)
        .depth_stencil_state(&depth)
        .color_blend_state(&blend)
        .dynamic_state(&dynamic)
        .layout(layout)
        .push_next(&mut rendering);
    // SAFETY: all that `info` points to outlives the call.
    let created = unsafe {
        gpu.device
            .create_graphics_pipelines(gpu.cache, &[info], None)
    };
    Ok(created
        .map_err(|(_, result)| failed(&format!("vkCreateGraphicsPipelines of {name}"))(result))?[0])
}

impl Pass {
    /// Layouts and a descriptor set for the resources that the shaders name.
    fn bind(
        gpu: &Arc<Gpu>,
        name: &str,
        shaders: &[&Shader],
        resources: &Resources,
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
            set: vk::DescriptorSet::null(),
            set_layout: vk::DescriptorSetLayout::null(),
            pool: vk::DescriptorPool::null(),
        };
        pass.create_layouts(name, &bindings, stages)?;
        pass.create_set(name, &bindings)?;
        for binding in bindings.values() {
            pass.write(name, binding, resources)?;
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
                    None,
                )
                .map_err(failed(&format!("vkCreateDescriptorSetLayout of {name}")))?;
            let push = [vk::PushConstantRange::default()
                .stage_flags(stages)
                .size(size_of::<crate::shared::Push>() as u32)];
            self.layout = device
                .create_pipeline_layout(
                    &vk::PipelineLayoutCreateInfo::default()
                        .set_layouts(&[self.set_layout])
                        .push_constant_ranges(&push),
                    None,
                )
                .map_err(failed(&format!("vkCreatePipelineLayout of {name}")))?;
        }
        Ok(())
    }

    fn create_set(&mut self, name: &str, bindings: &BTreeMap<u32, Binding>) -> Result<()> {
        let sizes: Vec<_> = bindings
            .values()
            .map(|b| {
                vk::DescriptorPoolSize::default()
                    .ty(descriptor_type(b.kind))
                    .descriptor_count(1)
            })
            .collect();
        let device = &self.gpu.device;
        // SAFETY: all that the infos point to outlives the calls; the pool frees the set.
        unsafe {
            self.pool = device
                .create_descriptor_pool(
                    &vk::DescriptorPoolCreateInfo::default()
                        .max_sets(1)
                        .pool_sizes(&sizes),
                    None,
                )
                .map_err(failed(&format!("vkCreateDescriptorPool of {name}")))?;
            self.set = device
                .allocate_descriptor_sets(
                    &vk::DescriptorSetAllocateInfo::default()
                        .descriptor_pool(self.pool)
                        .set_layouts(&[self.set_layout]),
                )
                .map_err(failed(&format!("vkAllocateDescriptorSets of {name}")))?[0];
        }
        self.gpu.name(self.set, name);
        Ok(())
    }

    fn write(&self, name: &str, binding: &Binding, resources: &Resources) -> Result<()> {
        let write = vk::WriteDescriptorSet::default()
            .dst_set(self.set)
            .dst_binding(binding.binding)
            .descriptor_type(descriptor_type(binding.kind));
        let update = |write| {
            // SAFETY: the set is in no use yet, and the resource is of the declared kind.
            unsafe { self.gpu.device.update_descriptor_sets(&[write], &[]) }
        };
        match (resources.get(binding.name), binding.kind) {
            (Some(Resource::Buffer(buffer)), BindingKind::StorageBuffer) => {
                let info = [vk::DescriptorBufferInfo::default()
                    .buffer(buffer.raw)
                    .range(vk::WHOLE_SIZE)];
                update(write.buffer_info(&info));
            }
            (
                Some(Resource::Image(image)),
                BindingKind::StorageImage | BindingKind::SampledImage,
            ) => {
                let info = [vk::DescriptorImageInfo::default()
                    .image_view(image.view)
                    .image_layout(vk::ImageLayout::GENERAL)];
                update(write.image_info(&info));
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
        let device = &self.gpu.device;
        // SAFETY: destroyed once, null handles are ignored; whoever submitted work has waited for it.
        unsafe {
            device.destroy_pipeline(self.pipeline, None);
            device.destroy_pipeline_layout(self.layout, None);
            device.destroy_descriptor_pool(self.pool, None);
            device.destroy_descriptor_set_layout(self.set_layout, None);
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

/// A shader module; needed only while the pipeline is created.
struct Module<'a> {
    gpu: &'a Gpu,
    raw: vk::ShaderModule,
}

impl<'a> Module<'a> {
    fn new(gpu: &'a Gpu, shader: &Shader) -> Result<Self> {
        let words: Vec<u32> = bytemuck::pod_collect_to_vec(shader.words);
        let info = vk::ShaderModuleCreateInfo::default().code(&words);
        // SAFETY: the words are SPIR-V that shaderc wrote.
        let raw = unsafe { gpu.device.create_shader_module(&info, None) }
            .map_err(failed(&format!("vkCreateShaderModule of {}", shader.name)))?;
        Ok(Self { gpu, raw })
    }

    fn stage<'b>(
        &self,
        stage: vk::ShaderStageFlags,
        constants: &'b vk::SpecializationInfo<'b>,
    ) -> vk::PipelineShaderStageCreateInfo<'b> {
        vk::PipelineShaderStageCreateInfo::default()
            .stage(stage)
            .module(self.raw)
            .name(c"main")
            .specialization_info(constants)
    }
}

impl Drop for Module<'_> {
    fn drop(&mut self) {
        // SAFETY: destroyed once; pipelines do not need their modules.
        unsafe { self.gpu.device.destroy_shader_module(self.raw, None) };
    }
}

struct Constants {
    entries: Vec<vk::SpecializationMapEntry>,
    values: Vec<u32>,
}

impl Constants {
    fn new(specialization: &Specialization) -> Self {
        let entry = |(i, &(id, _)): (usize, &(u32, u32))| vk::SpecializationMapEntry {
            constant_id: id,
            offset: 4 * i as u32,
            size: 4,
        };
        Self {
            entries: specialization.iter().enumerate().map(entry).collect(),
            values: specialization.iter().map(|&(_, value)| value).collect(),
        }
    }

    fn info(&self) -> vk::SpecializationInfo<'_> {
        vk::SpecializationInfo::default()
            .map_entries(&self.entries)
            .data(bytemuck::cast_slice(&self.values))
    }
}
