//! What effects are compared with.

use std::sync::Arc;

use ash::vk;
use glam::DVec3;
use halfshade::frame::{Casters, Surface};
use halfshade::gpu::{Gpu, HostImageInfo};
use halfshade::plan::HostFrame;
use halfshade::render::{Mesh, Renderer, SlotImages};
use halfshade::scene::AreaLight;
use halfshade::shared::{Fit, View};
use halfshade::shot::Shot;
use halfshade::technique::Settings;

use super::host::Host;
use super::{PIXELS, SIDE, gpu};

/// A shot of the scene, drawn by the renderer, and what the host needs of it.
pub struct Stage {
    pub shot: Shot,
    pub expected: Vec<f32>,
    pub positions: Vec<[f32; 4]>,
    pub normals: Vec<[f32; 4]>,
    /// Of the first view.
    pub map: Vec<f32>,
    pub fit: Fit,
    pub view: View,
    pub side_faces: bool,
}

impl Stage {
    /// Wide enough to see past the floor, and far enough along it for side faces. `change`: what is different about
    /// the light.
    pub fn new(gpu: &Arc<Gpu>, settings: Settings, change: impl FnOnce(&mut AreaLight)) -> Self {
        let mut shot = gpu::load("plate", SIDE, settings);
        shot.camera.vfov_deg = 100.0;
        change(&mut shot.lights[0]);
        // A host's positions and lights have no more bits than f32 relative to its origin.
        let origin = shot.origin();
        let rounded = |point: DVec3| (point - origin).as_vec3().as_dvec3() + origin;
        let scene = Arc::make_mut(&mut shot.scene);
        scene.positions.iter_mut().for_each(|p| *p = rounded(*p));
        shot.lights[0].center = rounded(shot.lights[0].center);
        let mut renderer: Renderer = gpu::renderer(gpu, &shot);
        renderer.render().expect("a frame");
        let texels = (shot.settings.map * shot.settings.map) as usize;
        let read = |name| renderer.read_image(name, PIXELS).expect("a g-buffer");
        let (positions, normals) = (read("position_world"), read("normal_world"));
        let expected = renderer.visibility(0).expect("visibility");
        renderer.render_view(0).expect("a view");
        let views = || renderer.plan().views();
        Self {
            expected,
            positions,
            normals,
            map: renderer.read_image("shadow_map", texels).expect("a map"),
            fit: renderer.fits().expect("fits")[0],
            view: views().next().expect("a view").view,
            side_faces: views().any(|view| view.pose.face > 0),
            shot,
        }
    }

    /// The light in the space of the positions.
    pub fn light(&self) -> AreaLight {
        let mut light = self.shot.lights[0].clone();
        light.center -= self.shot.origin();
        light
    }

    pub fn frame(&self, casters: Casters) -> HostFrame {
        HostFrame {
            size: (SIDE, SIDE),
            surface: Surface::Positions,
            light: self.light(),
            settings: self.shot.settings.clone(),
            casters,
            side_faces: self.side_faces,
            instances: 4,
            vertices: 1000,
            triangles: 1000,
        }
    }

    pub fn slot(&self, host: &mut Host, casters: Vec<HostImageInfo>) -> SlotImages {
        let (size, float) = ((SIDE, SIDE), vk::Format::R32G32B32A32_SFLOAT);
        SlotImages {
            surface: host.image(float, size, bytemuck::cast_slice(&self.positions)),
            normal: host.image(float, size, bytemuck::cast_slice(&self.normals)),
            visibility: host.image(vk::Format::R32_SFLOAT, size, &[]),
            casters,
        }
    }

    /// The scene's triangles as meshes: the first with indices of 32 bits, the second of 16, the third without.
    pub fn meshes(&self, host: &mut Host) -> Vec<Mesh> {
        let scene = &self.shot.scene;
        let positions = scene.positions_around(self.shot.origin());
        let corners = |triangle: &[u32; 3]| triangle.map(|i| positions[i as usize].to_array());
        // Padded to 20 bytes each, and begun at an offset.
        let mut strided = vec![0.0f32; 5];
        for position in &positions {
            strided.extend([position.x, position.y, position.z, 7.0, 7.0]);
        }
        let shared = host.buffer(bytemuck::cast_slice(&strided)).0;
        let thirds = scene.triangles.len() / 3;
        let (wide, rest) = scene.triangles.split_at(thirds);
        let (narrow, alone) = rest.split_at(thirds);
        let narrow: Vec<u16> = narrow.as_flattened().iter().map(|&i| i as u16).collect();
        // An odd number of leading indices, so that they begin in the middle of a word.
        let mut shifted = vec![0u16];
        shifted.extend(&narrow);
        shifted.resize(shifted.len().next_multiple_of(2) + 2, 0);
        let flat: Vec<[f32; 3]> = alone.iter().flat_map(corners).collect();
        let mesh = Mesh {
            vertices: shared,
            vertex_offset: 20,
            vertex_stride: 20,
            vertex_count: positions.len() as u32,
            indices: host.buffer(bytemuck::cast_slice(wide)).0,
            index_offset: 0,
            index_bytes: 4,
            triangle_count: wide.len() as u32,
        };
        vec![
            mesh,
            Mesh {
                indices: host.buffer(bytemuck::cast_slice(&shifted)).0,
                index_offset: 2,
                index_bytes: 2,
                triangle_count: (narrow.len() / 3) as u32,
                ..mesh
            },
            Mesh {
                vertices: host.buffer(bytemuck::cast_slice(&flat)).0,
                vertex_offset: 0,
                vertex_stride: 12,
                vertex_count: flat.len() as u32,
                indices: vk::Buffer::null(),
                triangle_count: alone.len() as u32,
                ..mesh
            },
        ]
    }
}
