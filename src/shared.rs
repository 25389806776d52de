//! The structs and constants that host and shaders both see. This is their one source: `build.rs`
//! includes this file and writes the GLSL declarations from it; a test compares every offset with
//! what the compiled shaders say.
//!
//! The types carry GLSL's names and have the size and alignment of `layout(scalar)`.

#![allow(non_camel_case_types)]

use bytemuck::{Pod, Zeroable};

pub type float = f32;
pub type uint = u32;
pub type vec2 = [f32; 2];
pub type vec3 = [f32; 3];
pub type vec4 = [f32; 4];
pub type uvec2 = [u32; 2];
pub type uvec3 = [u32; 3];
pub type uvec4 = [u32; 4];

#[path = "shared/declare.rs"]
#[macro_use]
mod declare;

pub use declare::{Field, Layout};

shared_constants! {
    /// [level] The largest kernel starts from up to 4×4 roots: the two levels above them take longer to build than they
    /// save, in all scenes seen.
    ROOT_LEVELS: uint = 2;
    /// Most levels a hierarchy can have: 8192 = 2^13, and the level of single cells, less those of the roots.
    LEVELS_MAX: uint = 12;
    /// [invocation] Work group of passes over lists and triangles.
    GROUP_SIZE: uint = 64;
    /// [work group] Lists longer than this many groups wrap into a second dispatch dimension, since
    /// a device may allow no more than 65535 groups in one.
    GROUPS_PER_ROW: uint = 32768;
    /// `Progress::next` of an entry that is finished.
    FINISHED: uint = 0x7fffffff;
    /// [pixel] Of a window, at least, however few lanes a subgroup has.
    WINDOW_PIXELS_MIN: uint = 4;
    /// [pixel] Side of the work group of passes over images and over the hierarchy.
    TILE_SIZE: uint = 8;
    /// tan 60°: the front face of a sub-light holds the receivers that lie within it of the axis in
    /// both directions; the side faces hold the rest.
    FRONT_REACH: float = 1.7320508;
    /// Tangent of the widest angle a map reaches. Casters beyond it (an occluder nearer to the light
    /// plane than a 16th of its distance from the sub-light's centre) are cut off.
    TANGENT_MAX: float = 16.0;
    /// Number of entries of a sub-light's sector table, less one.
    SECTOR_STEPS: uint = 1024;
    /// [share of d_p] Largest slope bias: receivers at grazing angles would otherwise lose their
    /// contact shadows altogether.
    BIAS_SLOPE_MAX: float = 0.05;
    /// [per texel] Steepest plane of a receiver: a sample's depth is at most 1, so what changes by more is beyond all
    /// samples one texel on.
    PLANE_MAX: float = 2.0;
    /// [share of d_p] Bias for the rounding of positions and depths, per unit of the coordinates'
    /// magnitude over the receiver's depth.
    BIAS_ROUNDING: float = 1e-6;
    /// [share] Rounding of plane distances, per unit of the magnitude of the coordinates that they are found from: receivers
    /// on a triangle's own plane count as on its side.
    PLANE_ROUNDING: float = 2e-6;
    /// The same of what is found from a triangle's corners and the light alone: 4 units in the last place.
    CORNER_ROUNDING: float = 2.4e-7;
    /// [share] Rounding of a receiver's height over the light's plane, and of the light's over the receiver's, per unit of
    /// the coordinates' magnitude: 8 units in the last place. What is no higher counts as in the plane, so that a surface
    /// whose plane runs along the light's border is decided the same in all its pixels.
    HORIZON_ROUNDING: float = 4.768_371_6e-7;
    /// Positive nodes and weights of the quadrature of irradiance, symmetric about 0: the 16 nodes t of Gauss and
    /// Legendre, moved towards the ends of −1 … 1 by sin κt / sin κ, κ = 0.95 π/2.
    IRRADIANCE_NODES: vec2 [8] = [
        [0.141_745_43, 0.280_737_52],
        [0.409_227_16, 0.249_552_95],
        [0.633_446_7, 0.196_330_64],
        [0.799_293_64, 0.135_296_9],
        [0.906_031_5, 0.080_057_345],
        [0.964_289_4, 0.039_234_38],
        [0.990_079_76, 0.014_960_952],
        [0.998_630_17, 0.003_829_305],
    ];
    /// Coefficients of z⁰ … z⁵ of (s − atan s) / s³ with z = s² in [0, 1]: the polynomial through its values at the zeros of
    /// Chebyshev's T₆, off by up to 4.3e-6.
    ARCTANGENT: float [6] =
        [0.333_329_02, -0.199_685_5, 0.138_961_26, -0.092_292_994, 0.044_866_39, -0.010_578_67];
    /// Kernel of a pixel that no occluder of this view can shadow.
    KERNEL_LIT: uint = 0;
    /// Kernel of a pixel whose sub-light is hidden altogether.
    KERNEL_UMBRA: uint = 1;
    /// Kernel of a pixel that must be integrated.
    KERNEL_PENUMBRA: uint = 2;
    /// Kernel of a pixel that this view has nothing to say about: no surface there, another face's
    /// receiver, or one that faces away.
    KERNEL_NONE: uint = 3;
    /// Kernel of a pixel whose visibility in this view is joined from that of pixels around it, on the grid that `first` tells.
    KERNEL_JOINED: uint = 4;
    /// Rows of a tile that the grids have on which pixels are evaluated, and columns, `TILE_SIZE` bits for a grid: all, half and a quarter.
    /// The first and the last are among them, so that nothing is joined across tiles; a grid has all rows of the sparser ones.
    GRID_ROWS: uint = 0x0081_a5ff;
    /// [grid] The sparsest.
    GRID_MAX: uint = 2;
    /// A light shines from its plane to one side.
    SPREAD_PLANE: uint = 0;
    /// From a point to all sides alike.
    SPREAD_POINT: uint = 1;
    /// From infinity.
    SPREAD_SUN: uint = 2;
    /// To all sides; each receiver sees a disc that faces it.
    SPREAD_SPHERE: uint = 3;
    /// Cells along a side of the cube that cuts the receivers of a sphere into cones. A receiver at a cone's border sees the disc
    /// that faces the cone narrower by the cosine of their angle.
    CONE_SPLIT: uint = 2;
    CONE_COUNT: uint = 24;
    /// No matter which cone; they are numbered from 1.
    ALL_CONES: uint = 0;
    /// [micro-occluder] Least budget along a side of a kernel.
    LEAST_BUDGET: uint = 4;
    /// Visibility comes from the shadow map itself, whole.
    QUALITY_FINEST: uint = 0;
    /// Visibility comes from the finer, or from the coarser, of the two levels round a pixel's level of quality, as far as that
    /// is in it [Schwarz08 §4.2].
    QUALITY_FINER: uint = 1;
    QUALITY_COARSER: uint = 2;
    /// Of an entry of the list of pixels: which of the two is left to be integrated, where that is not both. Images have at
    /// most 2³⁰ pixels.
    LISTED_FINER: uint = 0x40000000;
    LISTED_COARSER: uint = 0x80000000;
    /// A host's normals are stored as they are, each component from −1 to 1.
    NORMAL_SIGNED: uint = 0;
    /// They are moved to [0, 1].
    NORMAL_UNSIGNED: uint = 1;
    /// They are folded to an octahedron, whose x and y are moved to [0, 1].
    NORMAL_OCTAHEDRAL: uint = 2;
}

shared! {
    /// The camera and the size of the scene. Where the engine draws the surface, all positions on the device are relative
    /// to the camera's eye.
    struct Frame {
        /// Unit vector divided by tan(fov / 2) · aspect, or, where rays are parallel, by half the width of what is seen.
        right: vec3,
        /// Unit vector divided by tan(fov / 2), or by half the height.
        up: vec3,
        /// Unit vector.
        forward: vec3,
        /// [scene units] Distance of the near plane.
        near: float,
        /// [scene units] Distance beyond everything.
        far: float,
        /// [pixel]
        size: uvec2,
        /// [triangle]
        opaque_count: uint,
        /// [triangle]
        masked_count: uint,
    }

    /// A material as the alpha test and the shading see it.
    struct Surface {
        /// [0, 1] Linear RGB and alpha.
        base_color: vec4,
        /// [0, 1] Texels whose alpha is below are holes; 0 = none.
        alpha_cutoff: float,
        /// [texel] First texel in `texels`.
        texture_first: uint,
        /// [texel] 0 = no texture.
        texture_size: uvec2,
        /// `Wrap` of u, of v.
        wrap: uvec2,
        /// 1 = bilinear, 0 = nearest.
        linear: uint,
        /// 1 = the camera sees both sides.
        double_sided: uint,
    }

    /// A whole light: what `resolve` and `shade` need of it.
    struct Light {
        /// [scene units]
        center: vec3,
        /// Unit vectors in the light plane.
        u: vec3,
        v: vec3,
        /// Unit vector along which it shines.
        n: vec3,
        /// [scene units] Half sizes along u and v; the radius, twice, for a disc; the tangent of a sun's angular radius.
        half_size: vec2,
        /// 1 = disc.
        round: uint,
        /// [half sizes²] Area of its outline.
        area: float,
        /// A polygon's corners in `corners`; 0 = it is none.
        corner_first: uint,
        corner_count: uint,
        /// Sum of the weights of its views' sub-lights, summed in f32 in the order of the views.
        weight_sum: float,
        /// One of `SPREAD_…`.
        spread: uint,
        /// [radiance · scene units²] Linear RGB radiance times area: the radiant intensity along `n`, which does not
        /// end where the area does.
        intensity: vec3,
        /// Unit vector: the middle of the cone that its shine is kept in (`Beam`).
        beam: vec3,
        /// The cosine up to which all of it is there, and how fast its root ends there, per cosine; 0 = there is no cone.
        beam_start: float,
        beam_slope: float,
        /// [view] Its first view and how many it has.
        view_first: uint,
        view_count: uint,
    }

    /// One face of one sub-light, as the host knows it (`algorithm.md` §1).
    struct View {
        /// [scene units] The sub-light's centre.
        center: vec3,
        /// [scene units] What its rounding has left over.
        center_residual: vec3,
        /// [scene units] Surfaces no higher over the light's plane are the lamp's own and cast no shadow.
        touch: float,
        /// Unit vectors of the map: right × up = forward.
        right: vec3,
        up: vec3,
        forward: vec3,
        /// Unit vectors of the light plane divided by the sub-light's half sizes.
        light_u: vec3,
        light_v: vec3,
        /// Unit vector along which the light shines.
        light_n: vec3,
        /// [scene units] The sub-light's half sizes; 1 for a light without extent.
        half_size: vec2,
        /// [half sizes] Where the sub-light begins and ends, seen from its centre: −1, −1, 1, 1 unless
        /// a disc's rim or a polygon's sides cut it; all 0 for a light without extent.
        extent: vec4,
        /// [half sizes] Centre and radius of the disc that bounds it, if one does.
        rim: vec3,
        /// [half sizes²] Area.
        area: float,
        /// What it adds to the light's visibility, before the division by the light's `weight_sum`.
        weight: float,
        /// First entry of its sector table, which its edges follow.
        sector_first: uint,
        /// 0 = front; 1, 2 = along ±u; 3, 4 = along ±v.
        face: uint,
        /// The front face holds receivers within this tangent of the axis: `FRONT_REACH`, or
        /// infinity where there are no side faces.
        reach: float,
        /// [texel] Width and height of the shadow map.
        map_size: uint,
        /// [texel] Slope bias.
        bias: float,
        /// [level] Number of the hierarchy's levels that there is memory for.
        levels_max: uint,
        /// [scene units] Not 0: rays to the sub-light are parallel, and this is the L of the map that takes it to a disc
        /// (`scene/light/sun.rs`); `center` is a point of the plane.
        parallel: float,
        /// Their direction; its component along `light_n` is 1.
        ray: vec3,
        /// [scene units] Centre and radius of the sphere that the sub-light is of; cones are seen from there.
        sphere: vec4,
        /// The view's receivers are those in this cone; ALL_CONES: whatever cone they are in.
        cone: uint,
        /// Unit vector, and the least cosine with it of ways to receivers; 0 and 0 = the light's shine is kept in no cone.
        beam: vec3,
        beam_cosine: float,
    }

    /// What the device finds out about a view: bounds, then the projection fitted to them, then the
    /// work that is left (`algorithm.md` §10). All zero at the start of a frame.
    ///
    /// Bounds are reduced by `atomicMax` of order-preserving integers; a lower bound is the upper
    /// bound of the negated value, so that 0 is "nothing yet" for all.
    struct Fit {
        /// [pixel] Receivers in this view.
        receiver_count: uint,
        /// [scene units] Upper bounds of x, y, z, −x, −y, −z over receivers in the face's frame.
        receiver_bounds: uint [6],
        /// [scene units] The same relative to the eye: what is level in the scene is level in this box.
        receiver_box: uint [6],
        /// Upper bounds of the slopes of the four planes between light and receivers: +x, +y, −x, −y.
        receiver_slopes: uint [4],
        /// Upper bounds of x/z, y/z, −x/z, −y/z and −z over casters.
        caster_bounds: uint [5],
        /// VkDrawIndexedIndirectCommand of opaque and of masked casters.
        opaque_draw: uint [5],
        masked_draw: uint [5],
        /// [scene units] Depth d = near / z.
        near: float,
        /// [texel] t = focal · tangent + center.
        focal: vec2,
        center: vec2,
        /// [level] Number of the hierarchy's levels; 0 = no casters.
        level_count: uint,
        /// VkDispatchIndirectCommand of each pass.
        image_groups: uvec3,
        classify_groups: uvec3,
        /// [packet] Traversals that the driver ended before they were finished.
        unfinished: uint,
    }

    /// The dispatches that build the hierarchies of views side by side, kept for the first of them. All zero at the start of a frame.
    struct HierarchyGroups {
        /// VkDispatchIndirectCommand of each level.
        of_level: uvec3 [LEVELS_MAX as usize],
    }

    /// Bounds of the visible surface in a tile of the image.
    struct TileBounds {
        /// [scene units] Box of positions, relative to the eye; empty where there is no surface.
        lower: vec3,
        upper: vec3,
        /// Box of the unit normals.
        normal_lower: vec3,
        normal_upper: vec3,
        /// [scene units] Range of normal · position.
        height_lower: float,
        height_upper: float,
        /// [scene units] By how much positions may be off, at most.
        error: float,
    }

    /// A tile of the image that a view has to look at.
    struct Tile {
        /// [tile]
        place: uvec2,
        /// The `KERNEL_…` of all pixels in the view; KERNEL_PENUMBRA: each has one of its own.
        status: uint,
        /// No occluder of its pixels is nearer to the light.
        depth_max: float,
    }

    /// The dispatches of the lists of views side by side in a round, kept for the first of them. All zero at the start of a frame.
    struct Round {
        /// VkDispatchIndirectCommand of each list.
        packet_groups: uvec3,
        pixel_groups: uvec3,
    }

    /// Lengths of a view's lists. All zero at the start of a frame.
    struct Lists {
        packet_count: uint,
        pixel_count: uint,
        tile_count: uint,
        /// VkDispatchIndirectCommand over the tiles of views side by side, kept for the first of them.
        tile_groups: uvec3,
    }

    /// A pixel's kernel: the dual cells that its sub-light can project to [Yang09 eq. 1].
    struct Kernel {
        /// One of `KERNEL_…`.
        status: uint,
        /// [cell] First and last cell, x | y << 16.
        first: uint,
        last: uint,
        /// Depth range of the kernel.
        depth_min: float,
        depth_max: float,
    }

    /// A coherent packet [Yang09 §4.1].
    struct Packet {
        /// Position in the grid of packets, row by row.
        index: uint,
        /// [cell] Extended kernel: first and last cell, x | y << 16.
        first: uint,
        last: uint,
        /// Biased depth range of its penumbra pixels.
        depth_min: float,
        depth_max: float,
        /// Least depth of them without the bias: that of the farthest receiver.
        depth_far: float,
        /// [texel] Box of its penumbra pixels' t_p: x and y of the lower, then the upper corner.
        centers: vec4,
        /// [texel] Where `plane_depths` holds.
        origin: vec2,
        /// Range of the biased depths of their planes at the origin.
        plane_depths: vec2,
        /// [per texel] Range of their planes' changes of depth: the least in x and y, then the largest.
        planes: vec4,
    }

    /// What local packets form in [Yang09 §6]: penumbra pixels of a tile of the image, as many as a subgroup has lanes, or
    /// what is left of them.
    struct Window {
        /// [tile]
        place: uvec2,
        /// A bit for each of them, in Morton order.
        penumbra: uvec2,
    }

    /// Where a list's entry goes on in the next round.
    struct Progress {
        /// Number of the next cell of a scan; the node of a walk, x | y << 16; or `FINISHED`.
        next: uint,
        /// Of a walk: its root, x | y << 16, its level and its stack.
        root: uint,
        level: uint,
        stack: uint,
    }

    /// `--counters`, summed over all views.
    struct Counters {
        pixels: uint,
        lit: uint,
        umbra: uint,
        penumbra: uint,
        packets: uint,
        coherent_packets: uint,
        reprocessed_packets: uint,
        /// 64-bit counts: low word, high word.
        nodes_visited: uvec2,
        edges_extracted: uvec2,
        /// Depths and depth bounds that visibility passes read.
        samples_read: uvec2,
        /// [level] That penumbra pixels' budgets take, before they are smoothed, in sum.
        coarse_levels: uint,
    }

    /// What a pass is told when it is recorded.
    struct Push {
        /// Index of the view, or of the first of several side by side, or of the light for passes that run per light.
        index: uint,
        /// [view] From one of the views side by side to the next.
        stride: uint,
        /// Level of the hierarchy to build, layer to draw, or round in which a list is worked off.
        level: uint,
    }

    /// The cost model of the classification [Yang09 eq. 6]; Q_n = 1.
    struct Costs {
        edge: float,
        visibility: float,
    }

    /// How `shade` turns radiance into a picture.
    struct Exposure {
        /// Factor on radiance.
        scale: float,
        /// [radiance] Constant light from everywhere.
        ambient: float,
        light_count: uint,
    }

    /// What a host's images mean.
    struct Host {
        /// Columns of the matrix from clip space to the world, for depths.
        world_from_clip: vec4 [4],
        /// Columns of the matrix from the normals' space to the world.
        normal_to_world: vec3 [3],
        /// One of `NORMAL_…`.
        normal_encoding: uint,
        /// The depth where there is no surface.
        depth_empty: float,
        /// [0, 1] Visibility that is exported where there is no surface.
        background: float,
        /// By how much a number may be off that the surface's image holds: a share of itself, and a step.
        surface_share: float,
        surface_step: float,
        /// [scene units] By how much positions may be off; 0 = as the image's format says.
        position_error: float,
    }

    /// A host's mesh at a place.
    struct Instance {
        /// Rows of the matrix from the mesh to the world.
        transform: vec4 [3],
        /// Its first vertex among the casters' positions, and its number of them.
        position_first: uint,
        vertex_count: uint,
        /// Its first triangle among the casters' triangles, and its number of them.
        triangle_first: uint,
        triangle_count: uint,
        /// [word] First component of its first position, and from one vertex to the next.
        vertex_word_first: uint,
        vertex_words: uint,
        /// [index] Its first index.
        index_first: uint,
        /// [byte] 2 or 4; 0 = it has no indices.
        index_bytes: uint,
    }

    /// What a host says about a view's shadow map.
    struct Given {
        /// [scene units] Distance of the nearest caster from the sub-light's plane, or less.
        near: float,
        /// [texel] As in `Fit`, where the host has the map already.
        focal: vec2,
        center: vec2,
        /// Its depths: depth = depth_scale + depth_offset / z.
        depth_scale: float,
        depth_offset: float,
        /// The depth where there is no caster.
        depth_empty: float,
        /// 1 = its columns run against the view's right.
        mirrored: uint,
    }

    /// A view's projection for a host that draws its casters.
    struct Projection {
        /// Columns.
        clip_from_world: vec4 [4],
        /// To 256 bytes, to which any device can align uniform buffers.
        reserved: vec4 [12],
    }
}
