//! What a host lends to an effect, and what it says about a frame.

use ash::vk;
use glam::{Mat3, Mat4};

use super::given::{GivenMap, given_view};
use crate::error::{Error, Result};
use crate::frame::{Casters, Surface};
use crate::gpu::HostImageInfo;
use crate::plan::HostFrame;
use crate::scene::AreaLight;
use crate::shared::{Given, Instance, View};

/// The images of frames that are recorded with the same slot.
#[derive(Debug, Clone)]
pub struct SlotImages {
    pub surface: HostImageInfo,
    pub normal: HostImageInfo,
    /// Drawn to.
    pub visibility: HostImageInfo,
    pub casters: CasterImages,
}

/// Shadow maps that the host has already: one for each view, in their order, or none.
pub type CasterImages = Vec<HostImageInfo>;

/// A mesh in buffers of the host's, which shaders can read as storage.
#[derive(Debug, Clone, Copy)]
pub struct Mesh {
    pub vertices: vk::Buffer,
    /// [byte] Of the first position, three floats; a multiple of 4, as is the stride.
    pub vertex_offset: u64,
    pub vertex_stride: u32,
    pub vertex_count: u32,
    /// Null: three vertices for each triangle, in order.
    pub indices: vk::Buffer,
    /// [byte] A multiple of the size of an index.
    pub index_offset: u64,
    /// [byte] 2 or 4.
    pub index_bytes: u32,
    pub triangle_count: u32,
}

/// A mesh at a place.
#[derive(Debug, Clone, Copy)]
pub struct MeshInstance {
    /// Which of the prepared ones.
    pub mesh: usize,
    /// Rows of the matrix from the mesh to the world.
    pub transform: [[f32; 4]; 3],
}

/// A view that the host is to draw the casters of.
#[derive(Debug, Clone, Copy)]
pub struct DrawnView {
    pub index: u32,
    /// [byte] Where its projection stands in the buffer of projections.
    pub offset: u64,
}

/// A frame.
pub struct FrameInput<'a> {
    /// Of the frame, not less than that of the frame before; more than 0.
    pub serial: u64,
    pub slot: usize,
    pub light: AreaLight,
    /// Columns.
    pub world_from_clip: [[f32; 4]; 4],
    pub normal_to_world: [[f32; 3]; 3],
    /// One of `shared::NORMAL_…`.
    pub normal_encoding: u32,
    pub depth_empty: f32,
    /// [0, 1]
    pub background: f32,
    /// [scene units] By how much positions of the surface may be off; 0 = as the format of the surface's image says.
    pub position_error: f32,
    pub instances: &'a mut dyn ExactSizeIterator<Item = MeshInstance>,
    /// [scene units] More than 0: how near to the plane of a view casters may be, where the host draws them or has
    /// drawn them already.
    pub near: f32,
    pub maps: &'a mut dyn ExactSizeIterator<Item = GivenMap>,
    pub draw: Option<&'a mut dyn FnMut(DrawnView)>,
}

fn invalid<T>(text: impl Into<String>) -> Result<T> {
    Err(Error::Invalid(text.into()))
}

impl FrameInput<'_> {
    /// `slots`, `views`: how many are prepared, and planned.
    pub(super) fn validate(&self, host: &HostFrame, slots: usize, views: usize) -> Result<()> {
        self.light.validate()?;
        if self.serial == 0 {
            return invalid("a frame's serial is more than 0");
        }
        if self.slot >= slots {
            return invalid(format!(
                "there is no slot {}; {slots} are prepared",
                self.slot
            ));
        }
        let matrices = self
            .world_from_clip
            .iter()
            .flatten()
            .chain(self.normal_to_world.iter().flatten());
        if !matrices.into_iter().all(|number| number.is_finite()) {
            return invalid("a matrix is not finite");
        }
        let normals = Mat3::from_cols_array_2d(&self.normal_to_world).as_dmat3();
        if normals.determinant() == 0.0 {
            return invalid("normal_to_world is singular; normals in the world take the identity");
        }
        let positions = Mat4::from_cols_array_2d(&self.world_from_clip).as_dmat4();
        if host.surface == Surface::Depths && positions.determinant() == 0.0 {
            return invalid(
                "world_from_clip is singular; it is the inverse of the matrix that the depths were drawn with",
            );
        }
        if !(self.position_error.is_finite() && self.position_error >= 0.0) {
            return invalid("position_error is a length, or 0");
        }
        if !(0.0..=1.0).contains(&self.background) || self.depth_empty.is_nan() {
            return invalid("background is from 0 to 1, and depth_empty a number");
        }
        if self.instances.len() > host.instances as usize {
            return invalid(format!(
                "{} instances are more than the {} that the effect was made for",
                self.instances.len(),
                host.instances
            ));
        }
        let near = self.near.is_finite() && self.near > 0.0;
        match host.casters {
            Casters::DrawnByHost if self.draw.is_none() => {
                invalid("the host draws the casters, so the frame needs a callback")
            }
            Casters::DrawnByHost | Casters::Maps if !near => {
                invalid("the distance of the nearest caster is more than 0")
            }
            Casters::Maps if self.maps.len() != views => invalid(format!(
                "{} maps were given for {views} views",
                self.maps.len()
            )),
            _ => Ok(()),
        }
    }

    /// Writes what the host says about each view's map.
    pub(super) fn give(&mut self, views: &mut [View], givens: &mut [Given]) -> Result<()> {
        for given in givens.iter_mut() {
            given.near = self.near;
        }
        for ((view, given), map) in views.iter_mut().zip(givens).zip(&mut *self.maps) {
            given_view(view, given, &map)?;
        }
        Ok(())
    }

    /// Lists the instances; `meshes`: what all instances of each have in common. Returns the number of their triangles, or of those that fit.
    pub(super) fn gather(
        &mut self,
        host: &HostFrame,
        meshes: &[Instance],
        instances: &mut Vec<Instance>,
        chosen: &mut Vec<usize>,
    ) -> Result<u32> {
        instances.clear();
        chosen.clear();
        let (mut vertices, mut triangles) = (0u64, 0u64);
        for instance in &mut *self.instances {
            let Some(mesh) = meshes.get(instance.mesh) else {
                return invalid(format!(
                    "there is no mesh {}; {} are prepared",
                    instance.mesh,
                    meshes.len()
                ));
            };
            if !instance
                .transform
                .iter()
                .flatten()
                .all(|number| number.is_finite())
            {
                return invalid("the transform of an instance is not finite");
            }
            instances.push(Instance {
                transform: instance.transform,
                position_first: vertices as u32,
                triangle_first: triangles as u32,
                ..*mesh
            });
            chosen.push(instance.mesh);
            vertices += u64::from(mesh.vertex_count);
            triangles += u64::from(mesh.triangle_count);
            if vertices > host.vertices.into() || triangles > host.triangles.into() {
                return invalid(format!(
                    "the frame has more than the {} vertices or {} triangles that the effect was made for",
                    host.vertices, host.triangles
                ));
            }
        }
        Ok(triangles as u32)
    }
}
