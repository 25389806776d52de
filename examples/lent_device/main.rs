//! An engine with a Vulkan device of its own that lends it to the library: the shadow of a plate on a floor, recorded into the
//! engine's command buffer between the engine's images.
//!
//!     cargo run --release --example lent_device
//!
//! The engine's surface is filled on the CPU, where a real one draws its g-buffer. Runs under the validation layer where that is
//! installed. Prints a row of the shadow and fails if it is not what geometry says.

mod vulkan;

use std::error::Error;
use std::sync::Arc;

use ash::vk;
use glam::{DVec3, Vec3};
use halfshade::frame::{Casters, Surface};
use halfshade::gpu::{Enabled, Gpu, HostDevice, ImageState};
use halfshade::plan::HostFrame;
use halfshade::render::{DEFAULT_COSTS, Effect, FrameInput, Mesh, MeshInstance, SlotImages};
use halfshade::scene::{AreaLight, LightShape};
use halfshade::shared::NORMAL_SIGNED;
use halfshade::technique::{Settings, Technique};

use vulkan::Engine;

type Result<T, E = Box<dyn Error>> = std::result::Result<T, E>;

/// [pixel] The engine sees a floor of 8 × 8 from straight above.
const SIDE: u32 = 64;
const PIXELS: usize = (SIDE * SIDE) as usize;
const FLOOR: f32 = 8.0;

/// How the engine keeps its images between frames.
const AT_REST: ImageState = ImageState {
    layout: vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL,
    stage: vk::PipelineStageFlags2::FRAGMENT_SHADER,
    access: vk::AccessFlags2::SHADER_SAMPLED_READ,
};

pub fn main() -> Result<()> {
    let mut engine = Engine::new()?;
    let visibility = engine.shadow()?;
    engine.destroy();
    let middle = &visibility[(SIDE / 2 * SIDE) as usize..][..SIDE as usize];
    let shown = middle
        .iter()
        .map(|share| char::from(b" .:-=+*#"[7 - (share * 7.0).round() as usize]));
    println!(
        "the middle row, from light to umbra: [{}]",
        shown.collect::<String>()
    );
    check(middle)
}

/// A light of 1 × 1 four above the floor, a plate of 2 × 2 one above it: umbra as far as 5/6 from the middle, light beyond
/// 3/2. The pixels are 1/8 wide.
fn check(row: &[f32]) -> Result<()> {
    for (index, &share) in row.iter().enumerate() {
        let x = position(index as u32, 0)[0].abs();
        let right = match x {
            x if x < 0.75 => share < 0.02,
            x if x > 1.6 => share > 0.98,
            _ => (0.0..=1.0).contains(&share),
        };
        if !right {
            return Err(format!("the visibility at {x} is {share}").into());
        }
    }
    Ok(())
}

/// Where a pixel sees the floor.
fn position(column: u32, row: u32) -> [f32; 4] {
    let along = |pixel: u32| ((pixel as f32 + 0.5) / SIDE as f32 - 0.5) * FLOOR;
    [along(column), 0.0, along(row), 1.0]
}

impl Engine {
    /// The device as it is lent.
    fn lent(&self) -> HostDevice {
        HostDevice {
            get_instance_proc_addr: self.entry.static_fn().get_instance_proc_addr,
            instance: self.instance.handle(),
            physical: self.physical,
            device: self.device.handle(),
            api_version: vk::API_VERSION_1_3,
            debug_utils: false,
            enabled: Enabled {
                shader_storage_image_extended_formats: true,
                scalar_block_layout: true,
                dynamic_rendering: true,
                synchronization2: true,
                maintenance4: true,
            },
            family: self.family,
            callbacks: None,
        }
    }

    /// The visibility of the floor's pixels.
    fn shadow(&mut self) -> Result<Vec<f32>> {
        let light = AreaLight {
            name: String::new(),
            center: DVec3::new(0.0, 4.0, 0.0),
            // It shines along u × v: down.
            shape: LightShape::Rect {
                u: DVec3::X * 0.5,
                v: DVec3::Z * 0.5,
            },
            color: Vec3::ONE,
            intensity: None,
            beam: None,
        };
        // SAFETY: the device outlives the effect and all that it makes.
        let gpu: Arc<Gpu> = unsafe { Gpu::adopt(self.lent()) }?;
        let frame = HostFrame {
            size: (SIDE, SIDE),
            surface: Surface::Positions,
            light: light.clone(),
            settings: Settings {
                map: 256,
                ..Settings::usual(Technique::PacketContour)
            },
            casters: Casters::Gathered,
            side_faces: false,
            instances: 1,
            vertices: 4,
            triangles: 2,
        };
        // Plans; the memory comes with `prepare`.
        let mut effect = Effect::new(&gpu, frame, DEFAULT_COSTS)?;
        let (slot, mesh) = (self.slot()?, self.plate()?);
        // SAFETY: images and buffers are of this device, as described, and outlive the effect.
        unsafe { effect.prepare(std::slice::from_ref(&slot), &[mesh]) }?;
        self.begin()?;
        self.record(&mut effect, light)?;
        self.submit()?;
        self.read(&slot.visibility)
    }

    /// Records a frame with the plate where its mesh has it.
    fn record(&self, effect: &mut Effect, light: AreaLight) -> Result<()> {
        let [x, y, z] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let transform = [x, y, z].map(|[a, b, c]| [a, b, c, 0.0]);
        let mut frame = FrameInput {
            serial: 1,
            slot: 0,
            light,
            // For surfaces given as depths.
            world_from_clip: [[0.0; 4]; 4],
            normal_to_world: [x, y, z],
            normal_encoding: NORMAL_SIGNED,
            depth_empty: 0.0,
            background: 1.0,
            position_error: 0.0,
            instances: &mut std::iter::once(MeshInstance { mesh: 0, transform }),
            near: 0.1,
            maps: &mut std::iter::empty(),
            draw: None,
        };
        // SAFETY: the command buffer is recording, and the images are at rest when it runs.
        Ok(unsafe { effect.record(self.commands, &mut frame) }?)
    }

    /// Positions, normals, and where the visibility goes.
    fn slot(&mut self) -> Result<SlotImages> {
        let pixels = (0..SIDE).flat_map(|row| (0..SIDE).map(move |column| position(column, row)));
        let positions: Vec<[f32; 4]> = pixels.collect();
        let normals = vec![[0.0f32, 1.0, 0.0, 0.0]; PIXELS];
        Ok(SlotImages {
            surface: self.image(
                vk::Format::R32G32B32A32_SFLOAT,
                bytemuck::cast_slice(&positions),
            )?,
            normal: self.image(
                vk::Format::R32G32B32A32_SFLOAT,
                bytemuck::cast_slice(&normals),
            )?,
            visibility: self.image(vk::Format::R32_SFLOAT, &[])?,
            casters: Vec::new(),
        })
    }

    /// A plate of 2 × 2, one above the floor.
    fn plate(&mut self) -> Result<Mesh> {
        let corners = [
            [-1.0f32, 1.0, 1.0],
            [1.0, 1.0, 1.0],
            [1.0, 1.0, -1.0],
            [-1.0, 1.0, -1.0],
        ];
        let indices = [0u32, 1, 2, 0, 2, 3];
        Ok(Mesh {
            vertices: self.buffer(bytemuck::cast_slice(&corners))?.0,
            vertex_offset: 0,
            vertex_stride: 12,
            vertex_count: 4,
            indices: self.buffer(bytemuck::cast_slice(&indices))?.0,
            index_offset: 0,
            index_bytes: 4,
            triangle_count: 2,
        })
    }
}
