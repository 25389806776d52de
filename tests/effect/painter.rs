//! A host's own pipeline that draws a scene's triangles into the views that the library sets up.

use ash::vk;
use halfshade::render::DrawnView;
use halfshade::shot::Shot;

use super::host::Host;

/// [byte] Of a view's matrix.
const MATRIX: u64 = 64;

/// The scene as the host draws it.
pub struct Painter {
    device: ash::Device,
    commands: vk::CommandBuffer,
    set_layout: vk::DescriptorSetLayout,
    pool: vk::DescriptorPool,
    set: vk::DescriptorSet,
    layout: vk::PipelineLayout,
    pipeline: vk::Pipeline,
    vertices: vk::Buffer,
    vertex_count: u32,
}

/// The vertex shader of the example in C.
fn shader() -> Vec<u32> {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/shadow.vert");
    let source = std::fs::read_to_string(file).expect("it is there");
    let compiler = shaderc::Compiler::new().expect("shaderc is there");
    let kind = shaderc::ShaderKind::Vertex;
    let words = compiler.compile_into_spirv(&source, kind, "shadow.vert", "main", None);
    words.expect("it compiles").as_binary().to_vec()
}

impl Painter {
    /// `projections`: of the effect, as it is prepared now.
    pub fn new(host: &mut Host, shot: &Shot, projections: vk::Buffer) -> Self {
        let scene = &shot.scene;
        let positions = scene.positions_around(shot.origin());
        let corners = scene.triangles.iter().flatten();
        let corners: Vec<[f32; 3]> = corners.map(|&i| positions[i as usize].to_array()).collect();
        let vertices = host.buffer(bytemuck::cast_slice(&corners)).0;
        let device = host.gpu.raw().1.clone();
        // SAFETY: plain Vulkan; the infos are complete, and what they point to lives as long as the calls.
        let (set_layout, pool, set) = unsafe { matrix_set(&device, projections) };
        let set_layouts = [set_layout];
        let info = vk::PipelineLayoutCreateInfo::default().set_layouts(&set_layouts);
        // SAFETY: as above.
        let layout = unsafe { device.create_pipeline_layout(&info, None) }.expect("a layout");
        Self {
            pipeline: pipeline(&device, layout),
            commands: host.commands,
            set_layout,
            pool,
            set,
            layout,
            vertices,
            vertex_count: corners.len() as u32,
            device,
        }
    }

    /// Records the draws of a view.
    pub fn draw(&self, view: DrawnView) {
        let (device, commands) = (&self.device, self.commands);
        let point = vk::PipelineBindPoint::GRAPHICS;
        let offset = [view.offset as u32];
        // SAFETY: rendering has begun in the host's command buffer.
        unsafe {
            device.cmd_bind_pipeline(commands, point, self.pipeline);
            device.cmd_bind_descriptor_sets(commands, point, self.layout, 0, &[self.set], &offset);
            device.cmd_bind_vertex_buffers(commands, 0, &[self.vertices], &[0]);
            device.cmd_draw(commands, self.vertex_count, 1, 0, 0);
        }
    }
}

/// # Safety
/// The buffer is of this device.
unsafe fn matrix_set(
    device: &ash::Device,
    projections: vk::Buffer,
) -> (
    vk::DescriptorSetLayout,
    vk::DescriptorPool,
    vk::DescriptorSet,
) {
    let kind = vk::DescriptorType::UNIFORM_BUFFER_DYNAMIC;
    let binding = [vk::DescriptorSetLayoutBinding::default()
        .descriptor_type(kind)
        .descriptor_count(1)
        .stage_flags(vk::ShaderStageFlags::VERTEX)];
    let size = [vk::DescriptorPoolSize::default()
        .ty(kind)
        .descriptor_count(1)];
    let pool = vk::DescriptorPoolCreateInfo::default()
        .max_sets(1)
        .pool_sizes(&size);
    let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&binding);
    // SAFETY: the infos are complete, and the caller's promise.
    unsafe {
        let layout = device
            .create_descriptor_set_layout(&info, None)
            .expect("a layout");
        let pool = device.create_descriptor_pool(&pool, None).expect("a pool");
        let layouts = [layout];
        let info = vk::DescriptorSetAllocateInfo::default()
            .descriptor_pool(pool)
            .set_layouts(&layouts);
        let set = device.allocate_descriptor_sets(&info).expect("a set")[0];
        let range = [vk::DescriptorBufferInfo::default()
            .buffer(projections)
            .range(MATRIX)];
        let write = vk::WriteDescriptorSet::default()
            .dst_set(set)
            .descriptor_type(kind)
            .buffer_info(&range);
        device.update_descriptor_sets(&[write], &[]);
        (layout, pool, set)
    }
}

fn pipeline(device: &ash::Device, layout: vk::PipelineLayout) -> vk::Pipeline {
    let words = shader();
    let code = vk::ShaderModuleCreateInfo::default().code(&words);
    // SAFETY: shaderc has made it.
    let module = unsafe { device.create_shader_module(&code, None) }.expect("a module");
    let stage = [vk::PipelineShaderStageCreateInfo::default()
        .stage(vk::ShaderStageFlags::VERTEX)
        .module(module)
        .name(c"main")];
    let binding = [vk::VertexInputBindingDescription::default().stride(12)];
    let position =
        [vk::VertexInputAttributeDescription::default().format(vk::Format::R32G32B32_SFLOAT)];
    let input = vk::PipelineVertexInputStateCreateInfo::default()
        .vertex_binding_descriptions(&binding)
        .vertex_attribute_descriptions(&position);
    let assembly = vk::PipelineInputAssemblyStateCreateInfo::default()
        .topology(vk::PrimitiveTopology::TRIANGLE_LIST);
    let viewport = vk::PipelineViewportStateCreateInfo::default()
        .viewport_count(1)
        .scissor_count(1);
    let raster = vk::PipelineRasterizationStateCreateInfo::default().line_width(1.0);
    let samples = vk::PipelineMultisampleStateCreateInfo::default()
        .rasterization_samples(vk::SampleCountFlags::TYPE_1);
    let depth = vk::PipelineDepthStencilStateCreateInfo::default()
        .depth_test_enable(true)
        .depth_write_enable(true)
        .depth_compare_op(vk::CompareOp::GREATER);
    let states = [vk::DynamicState::VIEWPORT, vk::DynamicState::SCISSOR];
    let dynamic = vk::PipelineDynamicStateCreateInfo::default().dynamic_states(&states);
    let mut rendering =
        vk::PipelineRenderingCreateInfo::default().depth_attachment_format(vk::Format::D32_SFLOAT);
    let info = vk::GraphicsPipelineCreateInfo::default()
        .stages(&stage)
        .vertex_input_state(&input)
        .input_assembly_state(&assembly)
        .viewport_state(&viewport)
        .rasterization_state(&raster)
        .multisample_state(&samples)
        .depth_stencil_state(&depth)
        .dynamic_state(&dynamic)
        .layout(layout)
        .push_next(&mut rendering);
    // SAFETY: the info is complete; a module is not needed after its pipeline is there.
    unsafe {
        let made = device.create_graphics_pipelines(vk::PipelineCache::null(), &[info], None);
        device.destroy_shader_module(module, None);
        made.expect("a pipeline")[0]
    }
}

impl Drop for Painter {
    fn drop(&mut self) {
        // SAFETY: the queue is idle, so nothing uses them.
        unsafe {
            self.device.destroy_pipeline(self.pipeline, None);
            self.device.destroy_pipeline_layout(self.layout, None);
            self.device.destroy_descriptor_pool(self.pool, None);
            self.device
                .destroy_descriptor_set_layout(self.set_layout, None);
        }
    }
}
