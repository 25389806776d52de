//! Creates what the plan lists, and fills what the host knows.

use std::collections::BTreeMap;
use std::sync::Arc;

use bytemuck::Pod;
use glam::{DVec3, Vec3};

use crate::error::Result;
use crate::frame::Shape;
use crate::gpu::{Buffer, Gpu, Image, Resources};
use crate::plan::{Plan, PlannedResource, ViewPlan};
use crate::scene::{Material, Scene};
use crate::shared::{self, Surface, View};
use crate::shot::Shot;

/// What buffers hold from the start, by name.
type Contents = BTreeMap<&'static str, Vec<u8>>;

/// Resources of a drawn scene, under the names that shaders know them by. Everything that a shader could name exists;
/// what the plan leaves out is an empty placeholder.
pub fn create(
    gpu: &Arc<Gpu>,
    plan: &Plan,
    shot: &Shot,
    costs: shared::Costs,
    exposure: shared::Exposure,
) -> Result<Resources> {
    let views: Vec<View> = plan.views().map(|planned| planned.view).collect();
    let mut contents = scene_contents(shot);
    contents.insert("views", bytes(&views));
    if let Some(map) = &shot.budget_map {
        let shares = map.stretched(shot.width as usize, shot.height as usize);
        contents.insert("budget_shares", bytes(&shares));
    }
    let mut resources = create_planned(gpu, plan, costs, contents)?;
    let mut add = |name, data: Vec<u8>| -> Result<()> {
        resources.add_buffer(name, Buffer::with_data(gpu, name, &data)?);
        Ok(())
    };
    add("frame", bytes(&[plan.frame]))?;
    add("lights", bytes(&lights(plan)))?;
    add("exposure", bytes(&[exposure]))?;
    Ok(resources)
}

/// Resources of a host's frame: nothing is known yet of what stands where.
pub fn create_for_host(gpu: &Arc<Gpu>, plan: &Plan, costs: shared::Costs) -> Result<Resources> {
    let mut resources = create_planned(gpu, plan, costs, Contents::new())?;
    let lights = size_of_val(lights(plan).as_slice()) as u64;
    for (name, bytes) in [
        ("frame", size_of::<shared::Frame>() as u64),
        ("lights", lights),
    ] {
        resources.add_buffer(name, Buffer::new(gpu, name, bytes)?);
    }
    Ok(resources)
}

/// What the plan lists, and what all frames have.
fn create_planned(
    gpu: &Arc<Gpu>,
    plan: &Plan,
    costs: shared::Costs,
    mut contents: Contents,
) -> Result<Resources> {
    let tables = plan.views().map(ViewPlan::table);
    contents.insert("sectors", tables.flat_map(bytes).collect());
    contents.insert("corners", bytes(&plan.corners()));
    let mut resources = Resources::default();
    for planned in &plan.resources {
        create_one(gpu, planned, contents.get(planned.name), &mut resources)?;
    }
    let costs = Buffer::with_data(gpu, "costs", &[costs])?;
    resources.add_buffer("costs", costs);
    let counters = [shared::Counters::default()];
    resources.add_buffer("counters", Buffer::with_data(gpu, "counters", &counters)?);
    Ok(resources)
}

fn create_one(
    gpu: &Arc<Gpu>,
    planned: &PlannedResource,
    content: Option<&Vec<u8>>,
    resources: &mut Resources,
) -> Result<()> {
    let name = planned.name;
    match (planned.shape, content) {
        (Shape::Buffer(1..), Some(content)) => {
            resources.add_buffer(name, Buffer::with_data(gpu, name, content)?);
        }
        (Shape::Buffer(bytes), _) => {
            resources.add_buffer(name, Buffer::new(gpu, name, bytes)?);
        }
        (Shape::Image { kind, size, layers }, _) => {
            let (size, layers) = match planned.bytes() {
                0 => ((1, 1), 1),
                _ => (size, layers),
            };
            resources.add_image(name, Image::new(gpu, name, kind, size, layers)?);
        }
    }
    Ok(())
}

fn bytes<T: Pod>(data: &[T]) -> Vec<u8> {
    bytemuck::cast_slice(data).to_vec()
}

fn lights(plan: &Plan) -> Vec<shared::Light> {
    plan.lights.iter().map(|light| light.light).collect()
}

/// Triangles, materials and textures, whether the plan lists them or not.
fn scene_contents(shot: &Shot) -> Contents {
    let scene = &*shot.scene;
    let positions = scene.positions_around(shot.origin());
    let positions: Vec<[f32; 3]> = positions.iter().map(|p| p.to_array()).collect();
    let texcoords: Vec<[f32; 2]> = scene.texcoords.iter().map(|t| t.to_array()).collect();
    let colors: Vec<[f32; 3]> = scene.colors.iter().map(|color| color.to_array()).collect();
    let (surfaces, texels) = surfaces(scene);
    let mut vertex_surfaces = vec![0u32; scene.positions.len()];
    for (triangle, &surface) in scene.triangles.iter().zip(&scene.triangle_materials) {
        for &vertex in triangle {
            vertex_surfaces[vertex as usize] = surface;
        }
    }
    let residuals = residuals(scene, shot.origin(), &positions);
    Contents::from([
        ("positions", bytes(&positions)),
        ("position_residuals", bytes(&residuals)),
        ("triangles", bytes(&scene.triangles)),
        ("triangle_surfaces", bytes(&scene.triangle_materials)),
        ("triangle_planes", bytes(&planes(shot))),
        ("triangle_casts", bytes(&bits(&scene.casts))),
        ("surfaces", bytes(&surfaces)),
        ("texcoords", bytes(&texcoords)),
        ("vertex_colors", bytes(&colors)),
        ("vertex_surfaces", bytes(&vertex_surfaces)),
        ("texels", texels),
    ])
}

/// What rounding has left over of positions relative to `origin`.
fn residuals(scene: &Scene, origin: DVec3, rounded: &[[f32; 3]]) -> Vec<[f32; 3]> {
    let residual = |(exact, rounded): (&DVec3, &[f32; 3])| {
        let rounded = Vec3::from_array(*rounded).as_dvec3();
        (exact - origin - rounded).as_vec3().to_array()
    };
    scene.positions.iter().zip(rounded).map(residual).collect()
}

/// Bits, 32 to a word, the first at the least place.
fn bits(flags: &[bool]) -> Vec<u32> {
    let word = |flags: &[bool]| {
        let bits = flags.iter().enumerate();
        bits.fold(0, |word, (place, flag)| word | u32::from(*flag) << place)
    };
    flags.chunks(32).map(word).collect()
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
