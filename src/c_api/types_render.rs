//! The types and constants of `halfshade.h`: settings, renderers and what they tell.

use std::ffi::{c_char, c_void};

use super::structure::structures;
use super::types_context::*;

/// The knobs of a technique; hs_settings_default fills them all.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hs_settings {
    /// HS_TYPE_SETTINGS
    pub r#type: u32,
    /// sizeof(hs_settings)
    pub size: u32,
    /// NULL, or hs_knob structures for knobs that have no field here.
    pub next: *const c_void,
    /// HS_TECHNIQUE_...
    pub technique: u32,
    /// [pixel] [1, 8] Width of a packet, the pixels that share a traversal; 0 and a height of 0: packets form locally.
    pub packet_width: u32,
    /// [pixel] [1, 8], or 0
    pub packet_height: u32,
    /// HS_LEAF_...
    pub leaf: u32,
    /// HS_MAPPING_...
    pub mapping: u32,
    /// [1, 16] The light is cut into split * split sub-lights with a map each. Error and cost: its square.
    pub split: u32,
    /// [texel] [16, 8192] Width and height of a shadow map.
    pub map: u32,
    /// 32 or 16: bits of a bound in the hierarchy. 16: half the memory, wider kernels.
    pub mssm_bits: u32,
    /// 1 = leave out nodes whose back-projection misses the light.
    pub footprint_pruning: u32,
    /// PIXEL_CONTOUR: 1 = walk the hierarchy instead of every cell.
    pub hierarchical: u32,
    /// MICROPATCH...: 1 = patches reach out to their neighbours.
    pub gap_filling: u32,
    /// [1, 4] BITMASK, DEPTH_PEELING: layers of the map.
    pub layers: u32,
    /// DEPTH_PEELING: HS_OCCLUDERS_...
    pub occluders: u32,
    /// [8, 16] BITMASK: the light has light_samples * light_samples samples.
    pub light_samples: u32,
    /// BITMASK: HS_PATTERN_...
    pub pattern: u32,
    /// [1, 1024] PCSS: samples of the search for blockers.
    pub blocker_samples: u32,
    /// [1, 1024] PCSS: samples of the filter.
    pub filter_samples: u32,
    /// HARD: 1 = the share of 3x3 samples instead of the nearest one.
    pub percentage_closer: u32,
    /// [1, 4096] REFERENCE_MAPS.
    pub maps: u32,
    /// [texel] [0, ...) Depth bias in texels of the receiver's slope; -1 = the usual one of what runs. What the
    /// format of a host's surface rounds off comes on top of it by itself; see `position_error` of hs_vk_frame.
    pub bias: f32,
    /// 1 = count pixels, packets, nodes and edges, which takes time.
    pub counters: u32,
    /// [0, 4096] PACKET_CONTOUR with casters that the library knows beforehand: points of the light that cast hard
    /// shadows, on all of it, in place of sub-lights that an occluder is nearer to than they are wide; 0 = none.
    pub near_points: u32,
}

/// A knob by its name, chained to hs_settings.next, any number of them up to 64. Later ones win over earlier ones and over
/// the fields of hs_settings, so that every knob of every technique can be reached.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hs_knob {
    /// HS_TYPE_KNOB
    pub r#type: u32,
    /// sizeof(hs_knob)
    pub size: u32,
    /// NULL, or the next hs_knob.
    pub next: *const c_void,
    /// As `halfshade render --help` has it, without dashes: "neighbours".
    pub name: *const c_char,
    /// As the command line takes it: "flood". "1" or "0" of what has no value there: the flag is given, or not.
    pub value: *const c_char,
}

/// What a shot holds.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hs_shot_counts {
    /// HS_TYPE_SHOT_COUNTS
    pub r#type: u32,
    /// sizeof(hs_shot_counts)
    pub size: u32,
    /// NULL
    pub next: *mut c_void,
    /// [pixel]
    pub width: u32,
    /// [pixel]
    pub height: u32,
    /// Lights.
    pub lights: u32,
    /// 0
    pub reserved: u32,
}

/// What a renderer is made for.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hs_renderer_info {
    /// HS_TYPE_RENDERER_INFO
    pub r#type: u32,
    /// sizeof(hs_renderer_info)
    pub size: u32,
    /// NULL
    pub next: *const c_void,
    /// 1 = a shaded picture beside the visibility.
    pub picture: u32,
    /// Factor on the picture's radiance; 0 = what suits the shot: 1, or more or less for lights in candela, lux and nit. Usually 0.
    pub exposure: f32,
    /// [radiance] [0, ...) Constant light from everywhere, so that umbrae are dark rather than black; usually 0.04.
    pub ambient: f32,
    /// (0, 1e6] Cost of an edge, in visited nodes [Yang 2009, eq. 6]; 0 = the library's own.
    pub edge_cost: f32,
    /// (0, 1e6] Cost of a visibility, in visited nodes; 0 = the library's own.
    pub visibility_cost: f32,
    /// 0
    pub reserved: u32,
}

/// What the last frame was. The counters are zero unless the settings ask for them; pixels and packets count once
/// for each view.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hs_statistics {
    /// HS_TYPE_STATISTICS
    pub r#type: u32,
    /// sizeof(hs_statistics)
    pub size: u32,
    /// NULL
    pub next: *mut c_void,
    /// [ms] On the device, all passes; 0 where the device has no timestamps.
    pub device_ms: f64,
    /// [byte] Of all resources on the device.
    pub memory_bytes: u64,
    /// Different passes; see hs_renderer_pass.
    pub pass_count: u32,
    /// Views planned: sub-lights, times the faces of each.
    pub view_count: u32,
    /// Views in which the device found receivers.
    pub views_with_receivers: u32,
    /// Views in which it found casters too.
    pub views_with_casters: u32,
    /// Pixels that were looked at: lit, in the umbra, integrated, or joined from others.
    pub pixels: u64,
    /// Pixels fully lit.
    pub lit: u64,
    /// Pixels in the umbra.
    pub umbra: u64,
    /// Pixels that were integrated.
    pub penumbra: u64,
    /// Packets with pixels to integrate.
    pub packets: u64,
    /// Packets integrated together.
    pub coherent_packets: u64,
    /// Packets worked off pixel by pixel after all.
    pub reprocessed_packets: u64,
    /// Nodes of the hierarchy that were visited.
    pub nodes_visited: u64,
    /// Edges that were integrated.
    pub edges_extracted: u64,
    /// Depths and bounds of them that were read.
    pub samples_read: u64,
}

/// A pass of the last frame.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hs_pass {
    /// HS_TYPE_PASS
    pub r#type: u32,
    /// sizeof(hs_pass)
    pub size: u32,
    /// NULL
    pub next: *mut c_void,
    /// As `halfshade plan` prints it; with a NUL at the end.
    pub name: [c_char; 64],
    /// How often it was recorded.
    pub count: u32,
    /// 0
    pub reserved: u32,
    /// [ms] The sum over all times; 0 where the device has no timestamps.
    pub device_ms: f64,
}

/// How well to trace.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hs_reference_info {
    /// HS_TYPE_REFERENCE_INFO
    pub r#type: u32,
    /// sizeof(hs_reference_info)
    pub size: u32,
    /// NULL
    pub next: *const c_void,
    /// Which of the shot's lights, from 0.
    pub light: u32,
    /// [16, 65536] Rays for each pixel, rounded up to a multiple of 8.
    pub samples: u32,
    /// Another seed gives independent noise, the same seed the same image.
    pub seed: u64,
}

structures! {
    hs_settings = HS_TYPE_SETTINGS,
    hs_knob = HS_TYPE_KNOB,
    hs_shot_counts = HS_TYPE_SHOT_COUNTS,
    hs_renderer_info = HS_TYPE_RENDERER_INFO,
    hs_statistics = HS_TYPE_STATISTICS,
    hs_pass = HS_TYPE_PASS,
    hs_reference_info = HS_TYPE_REFERENCE_INFO,
}
