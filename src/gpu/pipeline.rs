//! Pipelines: shaders, their constants and the fixed state.

use ash::vk;

use super::device::Gpu;
use super::failed::failed;
use super::memory::ImageKind;
use super::shader::{Constants, Shader};
use crate::error::Result;

/// What becomes of a colour where there is one already.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Blend {
    /// The later one stays.
    Replace,
    /// They are added, in the order of what is drawn.
    Add,
}

/// The fixed part of a graphics pipeline. Triangles are filled and not culled; depth is reverse-Z.
pub struct GraphicsState<'a> {
    pub vertex: &'a str,
    /// None: only depth is written.
    pub fragment: Option<&'a str>,
    pub colors: &'a [vk::Format],
    pub blend: Blend,
    /// Whether depth is drawn to.
    pub depth: bool,
    /// What is drawn to has [`SAMPLES`](super::SAMPLES) samples a texel.
    pub multisampled: bool,
}

/// A compute pipeline. Errors: a Vulkan call failed.
pub(super) fn create_compute_pipeline(
    gpu: &Gpu,
    name: &str,
    shader: &Shader,
    constants: &Constants,
    layout: vk::PipelineLayout,
) -> Result<vk::Pipeline> {
    let module = Module::new(gpu, shader)?;
    let constants = Specialization::new(shader, constants);
    let constants = constants.info();
    let stage = module.stage(vk::ShaderStageFlags::COMPUTE, &constants);
    let info = vk::ComputePipelineCreateInfo::default()
        .flags(gpu.pipeline_flags())
        .stage(stage)
        .layout(layout);
    // SAFETY: all that `info` points to outlives the call.
    let created = unsafe {
        gpu.device
            .create_compute_pipelines(gpu.cache, &[info], gpu.callbacks())
    };
    Ok(created
        .map_err(|(_, result)| failed(&format!("vkCreateComputePipelines of {name}"))(result))?[0])
}

/// A graphics pipeline. Errors: a Vulkan call failed.
pub(super) fn create_graphics_pipeline(
    gpu: &Gpu,
    name: &str,
    state: &GraphicsState,
    vertex: &Shader,
    fragment: Option<&Shader>,
    constants: &Constants,
    layout: vk::PipelineLayout,
) -> Result<vk::Pipeline> {
    let of_vertex = Specialization::new(vertex, constants);
    let of_fragment = fragment.map(|shader| Specialization::new(shader, constants));
    let of_vertex = of_vertex.info();
    let of_fragment = of_fragment.as_ref().map(Specialization::info);
    let vertex = Module::new(gpu, vertex)?;
    let fragment = fragment
        .map(|shader| Module::new(gpu, shader))
        .transpose()?;
    let mut stages = vec![vertex.stage(vk::ShaderStageFlags::VERTEX, &of_vertex)];
    let fragment = fragment.as_ref().zip(of_fragment.as_ref());
    stages.extend(
        fragment.map(|(module, constants)| module.stage(vk::ShaderStageFlags::FRAGMENT, constants)),
    );
    let mut rendering =
        vk::PipelineRenderingCreateInfo::default().color_attachment_formats(state.colors);
    if state.depth {
        rendering = rendering.depth_attachment_format(ImageKind::Depth.format());
    }
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
    let samples = match state.multisampled {
        true => ImageKind::DepthSamples.samples(),
        false => ImageKind::Depth.samples(),
    };
    let samples = vk::PipelineMultisampleStateCreateInfo::default().rasterization_samples(samples);
    let depth = vk::PipelineDepthStencilStateCreateInfo::default()
        .depth_test_enable(state.depth)
        .depth_write_enable(state.depth)
        .depth_compare_op(vk::CompareOp::GREATER);
    let attachments = vec![
        vk::PipelineColorBlendAttachmentState::default()
            .blend_enable(state.blend == Blend::Add)
            .src_color_blend_factor(vk::BlendFactor::ONE)
            .dst_color_blend_factor(vk::BlendFactor::ONE)
            .color_write_mask(vk::ColorComponentFlags::RGBA);
        state.colors.len()
    ];
    let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&attachments);
    let dynamic = vk::PipelineDynamicStateCreateInfo::default()
        .dynamic_states(&[vk::DynamicState::VIEWPORT, vk::DynamicState::SCISSOR]);
    let info = vk::GraphicsPipelineCreateInfo::default()
        .flags(gpu.pipeline_flags())
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
            .create_graphics_pipelines(gpu.cache, &[info], gpu.callbacks())
    };
    Ok(created
        .map_err(|(_, result)| failed(&format!("vkCreateGraphicsPipelines of {name}"))(result))?[0])
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
        let raw = unsafe { gpu.device.create_shader_module(&info, gpu.callbacks()) }
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
        unsafe {
            self.gpu
                .device
                .destroy_shader_module(self.raw, self.gpu.callbacks())
        };
    }
}

/// The constants of a shader as Vulkan takes them.
struct Specialization {
    entries: Vec<vk::SpecializationMapEntry>,
    values: Vec<u32>,
}

impl Specialization {
    fn new(shader: &Shader, constants: &Constants) -> Self {
        let constants = shader.constants_by_id(constants);
        let entry = |(i, &(id, _)): (usize, &(u32, u32))| vk::SpecializationMapEntry {
            constant_id: id,
            offset: 4 * i as u32,
            size: 4,
        };
        Self {
            entries: constants.iter().enumerate().map(entry).collect(),
            values: constants.iter().map(|&(_, value)| value).collect(),
        }
    }

    fn info(&self) -> vk::SpecializationInfo<'_> {
        vk::SpecializationInfo::default()
            .map_entries(&self.entries)
            .data(bytemuck::cast_slice(&self.values))
    }
}
