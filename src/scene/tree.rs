//! The node tree of a glTF scene, flattened.

use std::collections::HashSet;

use glam::DAffine3;
use gltf::json::{Index, Node, Scene};

use super::document::Document;
use crate::Result;

/// A node and where it stands.
pub(super) struct Placed {
    pub node: Index<Node>,
    /// Node space to world space.
    pub world: DAffine3,
    /// Its mesh casts shadows.
    pub casts: bool,
    /// Neither it nor a node above it is hidden [KHR_node_visibility].
    pub visible: bool,
}

/// All nodes of a scene (None = the file's default, else its first), parents before children. `casters`: names of the nodes
/// that cast shadows, each with all below it; None = all do.
///
/// # Errors
/// When the scene does not exist, its nodes do not form a tree, or none of them has the name of a caster.
pub(super) fn walk(
    document: &Document,
    scene: Option<usize>,
    casters: Option<&[String]>,
) -> Result<Vec<Placed>> {
    let root = &document.root;
    let index = match scene {
        Some(index) => index,
        None => root.scene.map_or(0, |index| index.value()),
    };
    let scene: &Scene = root.scenes.get(index).ok_or_else(|| {
        let count = root.scenes.len();
        document.error(format!(
            "has no scene {index}; it holds {count} scene(s), counted from 0"
        ))
    })?;
    let mut visited = vec![false; root.nodes.len()];
    let mut placed = Vec::new();
    let named: Option<HashSet<&str>> =
        casters.map(|names| names.iter().map(String::as_str).collect());
    let mut unknown = named.clone().unwrap_or_default();
    let root_of_scene = |node: &Index<Node>| (*node, DAffine3::IDENTITY, named.is_none(), true);
    let mut open: Vec<_> = scene.nodes.iter().rev().map(root_of_scene).collect();
    while let Some((index, parent, below_caster, below_visible)) = open.pop() {
        let node = document.get(index, "node", "the node tree")?;
        if std::mem::replace(&mut visited[index.value()], true) {
            let index = index.value();
            return Err(document.error(format!(
                "node {index}: is reached twice; nodes must form a tree"
            )));
        }
        let world = parent * document.transforms[index.value()];
        let name = node.name.as_deref().unwrap_or_default();
        let is_named = named.as_ref().is_some_and(|named| named.contains(name));
        unknown.remove(name);
        let casts = below_caster || is_named;
        let visible = below_visible && !is_hidden(node);
        placed.push(Placed {
            node: index,
            world,
            casts,
            visible,
        });
        let children = node.children.iter().flatten();
        open.extend(children.rev().map(|child| (*child, world, casts, visible)));
    }
    match unknown.is_empty() {
        true => Ok(placed),
        false => Err(document.error(no_such_nodes(unknown))),
    }
}

/// Whether a node hides itself and all below it.
fn is_hidden(node: &Node) -> bool {
    let extensions = node.extensions.as_ref();
    let visibility = extensions.and_then(|extensions| extensions.others.get("KHR_node_visibility"));
    visibility.and_then(|json| json.get("visible")?.as_bool()) == Some(false)
}

/// What is wrong with names of casters.
fn no_such_nodes(unknown: HashSet<&str>) -> String {
    let mut names: Vec<String> = unknown.iter().map(|name| format!("{name:?}")).collect();
    names.sort();
    format!(
        "has no node of the name {}, which \"casters\" asks for; give names of the scene's nodes",
        names.join(", ")
    )
}
