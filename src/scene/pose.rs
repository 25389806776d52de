//! Where the vertices of a mesh stand before any animation plays: instances, skins by their joints, morph targets by their
//! weights [glTF 2.0 §3.7.2 to 3.7.3; EXT_mesh_gpu_instancing].

use std::collections::HashMap;

use glam::{DAffine3, DQuat, DVec3};
use gltf::json::accessor::{ComponentType, Type};
use gltf::json::{Accessor as AccessorJson, Index, Node, Skin};
use serde::Deserialize;

use super::accessor::Accessor;
use super::document::{Document, label};
use super::notes::Notes;
use super::tree::Placed;
use crate::Result;

const INSTANCING: &str = "EXT_mesh_gpu_instancing";

/// A node's mesh, posed.
pub(super) struct Pose {
    /// Mesh space to world space, for each of its instances; not used by a mesh with joints.
    pub places: Vec<DAffine3>,
    /// Mesh space to world space, for each joint of its skin; none without one.
    pub joints: Vec<DAffine3>,
    /// Of the morph targets; those beyond have weight 0.
    pub weights: Vec<f64>,
}

#[derive(Deserialize)]
struct Instancing {
    attributes: HashMap<String, Index<AccessorJson>>,
}

/// The poses of a scene's meshes.
pub(super) struct Posing<'a> {
    document: &'a Document<'a>,
    /// Node space to world space, for each node of the scene.
    worlds: HashMap<usize, DAffine3>,
}

impl<'a> Posing<'a> {
    pub fn new(document: &'a Document<'a>, placed: &[Placed]) -> Self {
        let worlds = placed.iter().map(|place| (place.node.value(), place.world));
        Self {
            document,
            worlds: worlds.collect(),
        }
    }

    /// How the mesh of a node stands. `instances_left`: how many more of it there may be.
    ///
    /// # Errors
    /// When its skin or its instances are malformed, or there are too many of them.
    pub fn of(&self, place: &Placed, instances_left: usize, notes: &mut Notes) -> Result<Pose> {
        let document = self.document;
        let node = document.get(place.node, "node", "the node tree")?;
        let name = label("node", place.node.value(), node.name.as_deref());
        let joints = match node.skin {
            Some(skin) => self.joints(skin, &name, notes)?,
            None => Vec::new(),
        };
        let places = match instancing(document, node, &name)? {
            Some(_) if !joints.is_empty() => {
                notes.add("instances of a mesh with a skin are ignored", &name);
                vec![place.world]
            }
            Some(instancing) => {
                let locals = instances(document, &instancing, instances_left, &name)?;
                locals
                    .into_iter()
                    .map(|local| place.world * local)
                    .collect()
            }
            None => vec![place.world],
        };
        let of_mesh = node.mesh.and_then(|mesh| document.root.get(mesh));
        let weights = node.weights.as_ref();
        let weights = weights.or_else(|| of_mesh?.weights.as_ref());
        Ok(Pose {
            places,
            joints,
            weights: weights
                .into_iter()
                .flatten()
                .copied()
                .map(f64::from)
                .collect(),
        })
    }

    /// Mesh space to world space for each joint. The node of the mesh does not count [glTF 2.0 §3.7.3.3].
    fn joints(&self, skin: Index<Skin>, user: &str, notes: &mut Notes) -> Result<Vec<DAffine3>> {
        let document = self.document;
        let json = document.get(skin, "skin", user)?;
        let name = label("skin", skin.value(), json.name.as_deref());
        document.spend(
            json.joints.len() as u64 * size_of::<DAffine3>() as u64,
            &name,
        )?;
        let inverse = json.inverse_bind_matrices.map(|index| {
            let what = format!("the inverse bind matrices of {name}");
            Accessor::open(document, index, Type::Mat4, &[ComponentType::F32], &what)
        });
        let inverse = inverse.transpose()?;
        let joint = |(i, &joint): (usize, &Index<Node>)| {
            document.get(joint, "node", &name)?;
            let world = self.worlds.get(&joint.value()).copied();
            let world = world.unwrap_or_else(|| {
                notes.add(
                    "a joint is no node of the scene; its own transform alone counts",
                    &name,
                );
                document.transforms[joint.value()]
            });
            let bind = match &inverse {
                Some(matrices) if i < matrices.count => matrix(matrices.floats(i)),
                _ => DAffine3::IDENTITY,
            };
            Ok(world * bind)
        };
        json.joints.iter().enumerate().map(joint).collect()
    }
}

fn matrix([a, b, c, _, d, e, f, _, g, h, i, _, x, y, z, _]: [f32; 16]) -> DAffine3 {
    DAffine3::from_cols_array(&[a, b, c, d, e, f, g, h, i, x, y, z].map(f64::from))
}

fn instancing(document: &Document, node: &Node, name: &str) -> Result<Option<Instancing>> {
    let extensions = node.extensions.as_ref();
    let json = extensions.and_then(|extensions| extensions.others.get(INSTANCING));
    let parsed = json.map(Instancing::deserialize).transpose();
    parsed.map_err(|e| document.error(format!("{name}: {INSTANCING}: {e}")))
}

/// Mesh space to node space, for each instance.
fn instances(
    document: &Document,
    json: &Instancing,
    left: usize,
    name: &str,
) -> Result<Vec<DAffine3>> {
    let open = |key: &str, shape, components: &[_]| {
        let index = json.attributes.get(key).copied();
        let what = format!("{key} of the instances of {name}");
        index
            .map(|index| Accessor::open(document, index, shape, components, &what))
            .transpose()
    };
    let numbers = [ComponentType::F32, ComponentType::I8, ComponentType::I16];
    let translations = open("TRANSLATION", Type::Vec3, &numbers[..1])?;
    let rotations = open("ROTATION", Type::Vec4, &numbers)?;
    let scales = open("SCALE", Type::Vec3, &numbers[..1])?;
    let all = [&translations, &rotations, &scales];
    let count = all
        .iter()
        .filter_map(|accessor| Some(accessor.as_ref()?.count))
        .min();
    let count = count.unwrap_or(0);
    if count > left {
        return Err(document.error(format!(
            "{name}: the scene exceeds the limit on primitives (instances counted); raise --max-primitives"
        )));
    }
    document.spend(
        (count as u64).saturating_mul(size_of::<DAffine3>() as u64),
        name,
    )?;
    let vector = |accessor: &Option<Accessor>, i, default| match accessor {
        Some(accessor) => DVec3::from_array(accessor.floats::<3>(i).map(f64::from)),
        None => default,
    };
    let local = |i| {
        let rotation = match &rotations {
            Some(accessor) => {
                let rotation = DQuat::from_array(accessor.floats::<4>(i).map(f64::from));
                match rotation.length() > 0.0 {
                    true => rotation.normalize(),
                    false => DQuat::IDENTITY,
                }
            }
            None => DQuat::IDENTITY,
        };
        DAffine3::from_scale_rotation_translation(
            vector(&scales, i, DVec3::ONE),
            rotation,
            vector(&translations, i, DVec3::ZERO),
        )
    };
    Ok((0..count).map(local).collect())
}
