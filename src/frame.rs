//! What a frame is made of, as data: passes and the resources between them. Whoever produces something declares the passes
//! that make it and the memory that it takes: the front (`front`), the shadow maps and the structures over them (`map`),
//! what every technique with kernels shares (`kernel`), the back (`back`), and each technique its own. The plan puts them in
//! order and sizes them; the renderer interprets what is planned.

pub mod back;
pub mod front;
mod graph;
mod hierarchy;
pub mod kernel;
pub mod map;
mod pass;
mod resource;

pub use graph::{Graph, Scope, Step, counts};
pub use hierarchy::Density;
pub use pass::{Domain, Drawn, Extent, Lent, Pass, Target, Work};
pub use resource::{Inventory, Resource, Shape, Sizes};

/// Where the visible surface comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Front {
    /// The scene is drawn.
    Drawn,
    /// A host's images are read.
    Imported(Surface),
}

/// What a host says about its visible surface, beside its normals.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Surface {
    /// Depths, as its projection gave them.
    Depths,
    /// Positions; w > 0 where there is a surface.
    Positions,
}

/// Where the shadow maps come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Casters {
    /// The scene's triangles, fitted to and drawn.
    Scene,
    /// The triangles of a host's meshes, gathered at the start of the frame; then as for a scene.
    Gathered,
    /// A host draws them itself.
    DrawnByHost,
    /// A host has the maps already.
    Maps,
}

impl Casters {
    /// Whether the library draws them from triangles, and fits the maps to these.
    pub fn are_triangles(self) -> bool {
        matches!(self, Self::Scene | Self::Gathered)
    }
}
