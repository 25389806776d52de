//! Creates what the plan lists, and fills what the host knows.

use std::sync::Arc;

use glam::{DVec3, Vec3};

use crate::error::Result;
use crate::gpu::{Buffer, Gpu, Image, ImageKind, Resources};
use crate::plan::{Front, Plan};
use crate::scene::{Material, Scene};
use crate::shared::{self, Surface, View};
use crate::shot::Shot;

/// Resources of a drawn scene, under the names that shaders know them by. Everything that a shader could name exists;
/// what the plan leaves out is an empty placeholder.
pub fn create(
    gpu: &Arc<Gpu>,
    plan: &Plan,
    shot: &Shot,
    costs: shared::Costs,
    exposure: shared::Exposure,
) -> Result<Resources> {
    let mut resources = create_common(gpu, plan, costs)?;
    create_scene(gpu, plan, shot, &mut resources)?;
    let exposure = Buffer::with_data(gpu, "exposure", &[exposure])?;
    resources.add_buffer("exposure", exposure);
    Ok(resources)
}

/// Resources of a host's frame: nothing is known yet of what stands where.
pub fn create_for_host(gpu: &Arc<Gpu>, plan: &Plan, costs: shared::Costs) -> Result<Resources> {
    let mut resources = create_common(gpu, plan, costs)?;
    let names = [
        "positions",
        "position_residuals",
        "triangles",
        "surfaces",
        "texcoords",
        "vertex_surfaces",
        "texels",
        "host",
        "instances",
    ];
    add_planned(gpu, plan, &names, &mut resources)?;
    Ok(resources)
}

fn create_common(gpu: &Arc<Gpu>, plan: &Plan, costs: shared::Costs) -> Result<Resources> {
    let mut resources = Resources::default();
    create_views(gpu, plan, &mut resources)?;
    create_images(gpu, plan, &mut resources)?;
    let costs = Buffer::with_data(gpu, "costs", &[costs])?;
    resources.add_buffer("costs", costs);
    let counters = [shared::Counters::default()];
    resources.add_buffer("counters", Buffer::with_data(gpu, "counters", &counters)?);
    let names = [
        "caster_indices",
        "kernels",
        "packets",
        "pixels",
        "occlusion",
        "fits",
        "lists",
        "rounds",
        "partial",
        "progress",
        "visibility",
        "picture",
        "givens",
        "projections",
    ];
    add_planned(gpu, plan, &names, &mut resources)?;
    Ok(resources)
}

fn add_planned(
    gpu: &Arc<Gpu>,
    plan: &Plan,
    names: &[&'static str],
    resources: &mut Resources,
) -> Result<()> {
    for name in names {
        resources.add_buffer(name, Buffer::new(gpu, name, planned(plan, name))?);
    }
    Ok(())
}

fn planned(plan: &Plan, name: &str) -> u64 {
    plan.resources
        .iter()
        .find(|(known, _)| *known == name)
        .map_or(0, |&(_, bytes)| bytes)
}

fn create_scene(gpu: &Arc<Gpu>, plan: &Plan, shot: &Shot, resources: &mut Resources) -> Result<()> {
    let scene = &*shot.scene;
    let mut add = |name: &'static str, data: &[u8]| -> Result<()> {
        let data = if planned(plan, name) > 0 { data } else { &[] };
        resources.add_buffer(name, Buffer::with_data(gpu, name, data)?);
        Ok(())
    };
    let positions = scene.positions_around(shot.origin());
    let positions: Vec<[f32; 3]> = positions.iter().map(|p| p.to_array()).collect();
    let texcoords: Vec<[f32; 2]> = scene.texcoords.iter().map(|t| t.to_array()).collect();
    let (surfaces, texels) = surfaces(scene);
    let mut vertex_surfaces = vec![0u32; scene.positions.len()];
    for (triangle, &surface) in scene.triangles.iter().zip(&scene.triangle_materials) {
        for &vertex in triangle {
            vertex_surfaces[vertex as usize] = surface;
        }
    }
    add("positions", bytemuck::cast_slice(&positions))?;
    let residuals = residuals(scene, shot.origin(), &positions);
    add("position_residuals", bytemuck::cast_slice(&residuals))?;
    add("triangles", bytemuck::cast_slice(&scene.triangles))?;
    add(
        "triangle_surfaces",
        bytemuck::cast_slice(&scene.triangle_materials),
    )?;
    add("triangle_planes", bytemuck::cast_slice(&planes(shot)))?;
    add("surfaces", bytemuck::cast_slice(&surfaces))?;
    add("texcoords", bytemuck::cast_slice(&texcoords))?;
    add("vertex_surfaces", bytemuck::cast_slice(&vertex_surfaces))?;
    add("texels", &texels)
}

/// What rounding has left over of positions relative to `origin`.
fn residuals(scene: &Scene, origin: DVec3, rounded: &[[f32; 3]]) -> Vec<[f32; 3]> {
    let residual = |(exact, rounded): (&DVec3, &[f32; 3])| {
        let rounded = Vec3::from_array(*rounded).as_dvec3();
        (exact - origin - rounded).as_vec3().to_array()
    };
    scene.positions.iter().zip(rounded).map(residual).collect()
}

/// The planes of all triangles: the unit normal n of the front and n · x, worked out in f64, for positions are found from
/// them however large a triangle is.
fn planes(shot: &Shot) -> Vec<[f32; 4]> {
    let plane = |index| {
        let [a, b, c] = shot.scene.corners_around(shot.origin(), index);
        let normal = (b - a).cross(c - a).normalize_or_zero();
        normal.extend(normal.dot(a)).as_vec4().to_array()
    };
    (0..shot.scene.triangles.len()).map(plane).collect()
}

/// Materials, and the texels of all textures one after the other.
fn surfaces(scene: &Scene) -> (Vec<Surface>, Vec<u8>) {
    let mut texels = Vec::new();
    let mut firsts = Vec::new();
    for texture in &scene.textures {
        firsts.push((texels.len() / 4) as u32);
        texels.extend_from_slice(&texture.rgba);
    }
    let surface = |material: &Material| {
        let mut surface = Surface {
            base_color: material.base_color.into(),
            alpha_cutoff: material.alpha_cutoff.unwrap_or(0.0),
            double_sided: u32::from(material.double_sided),
            ..Default::default()
        };
        if let Some(index) = material.texture {
            let texture = &scene.textures[index];
            surface.texture_first = firsts[index];
            surface.texture_size = [texture.width, texture.height];
            surface.wrap = texture.wrap.map(|wrap| wrap as u32);
            surface.linear = u32::from(texture.linear);
        }
        surface
    };
    (scene.materials.iter().map(surface).collect(), texels)
}

fn create_views(gpu: &Arc<Gpu>, plan: &Plan, resources: &mut Resources) -> Result<()> {
    let mut sectors: Vec<f32> = Vec::new();
    let mut views: Vec<View> = Vec::new();
    for planned in plan.views() {
        views.push(planned.view);
        if let Some(table) = &planned.sectors {
            sectors.extend_from_slice(table);
        }
    }
    resources.add_buffer("sectors", Buffer::with_data(gpu, "sectors", &sectors)?);
    if plan.front == Front::Imported {
        // They come with each frame.
        let lights = (plan.lights.len() * size_of::<shared::Light>()) as u64;
        for (name, bytes) in [
            ("frame", size_of::<shared::Frame>() as u64),
            ("views", (views.len() * size_of::<View>()) as u64),
            ("lights", lights),
        ] {
            resources.add_buffer(name, Buffer::new(gpu, name, bytes)?);
        }
        return Ok(());
    }
    let lights: Vec<shared::Light> = plan.lights.iter().map(|light| light.light).collect();
    resources.add_buffer("frame", Buffer::with_data(gpu, "frame", &[plan.frame])?);
    resources.add_buffer("views", Buffer::with_data(gpu, "views", &views)?);
    resources.add_buffer("lights", Buffer::with_data(gpu, "lights", &lights)?);
    Ok(())
}

/// `size` if the plan has the image, or else that of a placeholder.
fn side(plan: &Plan, name: &str, size: (u32, u32)) -> (u32, u32) {
    if planned(plan, name) > 0 {
        size
    } else {
        (1, 1)
    }
}

fn create_images(gpu: &Arc<Gpu>, plan: &Plan, resources: &mut Resources) -> Result<()> {
    let map = (plan.map.max(1), plan.map.max(1));
    let layers = plan.sets().map(|set| set.recipe.layers);
    let layers = layers.max().unwrap_or(0).max(1);
    let images = [
        (
            "camera_depth",
            ImageKind::Depth,
            side(plan, "camera_depth", plan.size),
            1,
        ),
        ("position_world", ImageKind::Vector, plan.size, 1),
        ("normal_world", ImageKind::Vector, plan.size, 1),
        (
            "albedo",
            ImageKind::Color,
            side(plan, "albedo", plan.size),
            1,
        ),
        ("shadow_map", ImageKind::Depth, map, 1),
        (
            "mssm",
            match plan.mssm_bits {
                16 => ImageKind::Bounds16,
                _ => ImageKind::Bounds,
            },
            side(plan, "mssm", map),
            plan.levels.max(1),
        ),
        (
            "layers",
            ImageKind::Layers,
            side(plan, "layers", map),
            layers,
        ),
        (
            "hsm",
            ImageKind::Bounds,
            side(plan, "hsm", (map.0.div_ceil(2), map.0.next_power_of_two())),
            1,
        ),
    ];
    for (name, kind, size, layers) in images {
        resources.add_image(name, Image::new(gpu, name, kind, size, layers)?);
    }
    Ok(())
}
