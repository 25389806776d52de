//! A pass: what is recorded under one name.

use crate::gpu::Blend;

/// A pass as its producer declares it. What it computes stands at the head of its shader.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Pass {
    /// Name in plans, labels, timings and tables; a pass that integrates visibility says so.
    pub name: &'static str,
    pub work: Work,
    /// Specialization constants by name, beside those of the frame, the view and its technique.
    pub constants: &'static [(&'static str, u32)],
    /// What it makes is there in the next frame: one that keeps the shadow map leaves the pass out.
    pub lasts: bool,
    /// It takes up what a driver that ends loops leaves over, and runs nowhere else.
    pub leftovers: bool,
    /// What a host lends it, beside the resources of the frame.
    pub lent: Lent,
}

/// What a pass does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Work {
    /// Fills buffers with zeros.
    Clear(&'static [&'static str]),
    /// Writes what a host says about the frame to the buffers that it concerns.
    Upload,
    /// Dispatches a compute shader.
    Dispatch { shader: &'static str, over: Domain },
    /// Draws into cleared images.
    Draw {
        vertex: &'static str,
        /// None: only depth is written.
        fragment: Option<&'static str>,
        what: Drawn,
        into: Target,
    },
    /// Copies an image into a layer of another, that of the step's level.
    CopyLayer {
        from: &'static str,
        to: &'static str,
    },
}

/// What a compute pass is dispatched over.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Domain {
    /// A single work group.
    Once,
    /// All pixels of the image, in tiles.
    Image,
    /// All pixels of the image, several to an invocation: a reduction.
    PixelReduction,
    /// All triangles, several to an invocation.
    TriangleReduction,
    /// The instances of a host's meshes, apart from one another.
    Instances,
    /// All pixels, if the view has casters or nothing is accumulated.
    Pixels,
    /// All tiles of the image.
    Tiles,
    /// All pixels of the tiles that the view has to look at.
    ListedTiles,
    /// Every packet of the image, if the view has casters.
    Packets,
    /// The view's list of coherent packets, in rounds.
    PacketList,
    /// The view's list of single pixels, in rounds.
    PixelList,
    /// The nodes of a level of the hierarchy over the map, if a view needs it.
    HierarchyLevel,
    /// The nodes of a level of a pyramid over a map of the view, from 1 up.
    PyramidLevel,
    /// All texels of the view's shadow map.
    MapTexels,
}

/// What is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Drawn {
    /// All triangles of the scene.
    Surface,
    /// The view's casters: opaque ones, then alpha-masked ones with a fragment shader of their own.
    Casters { masked: &'static str },
    /// The view's casters, by the host.
    ByHost,
    /// A triangle that covers the image.
    WholeImage,
    /// A rectangle for each texel of the view's map: an instance of six vertices.
    Texels,
}

impl Drawn {
    /// Whether it is triangles of the scene.
    pub const fn is_geometry(self) -> bool {
        matches!(self, Self::Surface | Self::Casters { .. } | Self::ByHost)
    }
}

/// What is drawn into.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Target {
    /// Images by name, all of the same extent.
    Images {
        colors: &'static [&'static str],
        depth: Option<&'static str>,
        extent: Extent,
        blend: Blend,
    },
    /// The image that a host lends for the result.
    Lent,
}

/// How much of an image is drawn to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Extent {
    /// All of it.
    Image,
    /// As much as the view's map has of it, from its first texel on, but for a margin [texel] on all sides.
    Map { margin: u32 },
}

/// What a host lends to a pass.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Lent {
    Nothing,
    /// The images of the visible surface.
    Surface,
    /// The buffers of a mesh.
    Mesh,
    /// The view's shadow map.
    Map,
}

impl Pass {
    pub const fn new(name: &'static str, work: Work) -> Self {
        Self {
            name,
            work,
            constants: &[],
            lasts: false,
            leftovers: false,
            lent: Lent::Nothing,
        }
    }

    pub const fn dispatch(name: &'static str, shader: &'static str, over: Domain) -> Self {
        Self::new(name, Work::Dispatch { shader, over })
    }

    /// A draw of depths into an image as large as the view's map, but for a margin [texel].
    pub const fn depths(
        name: &'static str,
        (vertex, fragment): (&'static str, Option<&'static str>),
        what: Drawn,
        depth: &'static str,
        margin: u32,
    ) -> Self {
        let into = Target::Images {
            colors: &[],
            depth: Some(depth),
            extent: Extent::Map { margin },
            blend: Blend::Replace,
        };
        let work = Work::Draw {
            vertex,
            fragment,
            what,
            into,
        };
        Self::new(name, work)
    }

    /// With these constants as well.
    pub const fn with(self, constants: &'static [(&'static str, u32)]) -> Self {
        Self { constants, ..self }
    }

    /// One whose results a frame can keep.
    pub const fn lasting(self) -> Self {
        Self {
            lasts: true,
            ..self
        }
    }

    /// One for what a driver that ends loops leaves over.
    pub const fn of_leftovers(self) -> Self {
        Self {
            leftovers: true,
            ..self
        }
    }

    /// One that a host lends something.
    pub const fn lent(self, lent: Lent) -> Self {
        Self { lent, ..self }
    }

    /// The shaders that it runs.
    pub fn shaders(&self) -> Vec<&'static str> {
        match self.work {
            Work::Clear(_) | Work::Upload | Work::CopyLayer { .. } => Vec::new(),
            Work::Dispatch { shader, .. } => vec![shader],
            Work::Draw {
                what: Drawn::ByHost,
                ..
            } => Vec::new(),
            Work::Draw {
                vertex,
                fragment,
                what,
                ..
            } => {
                let masked = match what {
                    Drawn::Casters { masked } => Some(masked),
                    _ => None,
                };
                [Some(vertex), fragment, masked]
                    .into_iter()
                    .flatten()
                    .collect()
            }
        }
    }

    /// What it is dispatched over, if it is.
    pub const fn domain(&self) -> Option<Domain> {
        match self.work {
            Work::Dispatch { over, .. } => Some(over),
            _ => None,
        }
    }
}
