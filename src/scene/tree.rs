//! The node tree of a glTF scene, flattened.

use glam::DAffine3;
use gltf::json::{Index, Node, Scene};

use super::document::Document;
use crate::Result;

/// A node and where it stands.
pub(super) struct Placed {
    pub node: Index<Node>,
    /// Node space to world space.
    pub world: DAffine3,
}

/// All nodes of a scene (None = the file's default, else its first), parents before children.
///
/// # Errors
/// When the scene does not exist or its nodes do not form a tree.
pub(super) fn walk(document: &Document, scene: Option<usize>) -> Result<Vec<Placed>> {
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
    let at_origin = |node: &Index<Node>| (*node, DAffine3::IDENTITY);
    let mut open: Vec<_> = scene.nodes.iter().rev().map(at_origin).collect();
    while let Some((index, parent)) = open.pop() {
        let node = document.get(index, "node", "the node tree")?;
        if std::mem::replace(&mut visited[index.value()], true) {
            let index = index.value();
            return Err(document.error(format!(
                "node {index}: is reached twice; nodes must form a tree"
            )));
        }
        let world = parent * document.transforms[index.value()];
        placed.push(Placed { node: index, world });
        let children = node.children.iter().flatten();
        open.extend(children.rev().map(|child| (*child, world)));
    }
    Ok(placed)
}
