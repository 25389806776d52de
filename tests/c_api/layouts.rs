//! Sizes and offsets of every structure: C's against Rust's.

use std::fmt::Write;
use std::fs;
use std::mem::offset_of;
use std::process::Command;

use halfshade::c_api::types::*;
use halfshade::c_api::vulkan_frame_types::*;
use halfshade::c_api::vulkan_types::*;

use super::build::{Workshop, done, root};

struct Layout {
    name: &'static str,
    size: usize,
    fields: Vec<(&'static str, usize)>,
}

macro_rules! layouts {
    ($($name:ident { $($field:ident)* })*) => {
        vec![$(Layout {
            name: stringify!($name),
            size: size_of::<$name>(),
            fields: vec![$((stringify!($field).trim_start_matches("r#"), offset_of!($name, $field))),*],
        }),*]
    };
}

fn standalone() -> Vec<Layout> {
    layouts! {
        hs_context_info { r#type size next device cache_folder flags reserved log log_user max_memory }
        hs_device_info { r#type size next name kind driver uuid missing subgroup_size usable }
        hs_material { r#type size next base_color alpha_cutoff double_sided texture reserved }
        hs_texture { r#type size next rgba width height wrap linear reserved }
        hs_scene_info { r#type size next positions texcoords vertex_count indices triangle_count triangle_materials
            materials material_count textures texture_count origin }
        hs_scene_counts { r#type size next vertices triangles masked_triangles lights cameras lower upper }
        hs_camera { r#type size next eye target up vfov_deg width height }
        hs_light { r#type size next center u v normal radius color intensity shape reserved cone_deg }
        hs_polygon { r#type size next corners corner_count }
        hs_knob { r#type size next name value }
        hs_settings { r#type size next technique packet_width packet_height leaf mapping split map mssm_bits footprint_pruning
            hierarchical gap_filling layers occluders light_samples pattern blocker_samples filter_samples
            percentage_closer maps bias counters near_points }
        hs_shot_counts { r#type size next width height lights reserved }
        hs_renderer_info { r#type size next picture exposure ambient edge_cost visibility_cost reserved }
        hs_statistics { r#type size next device_ms memory_bytes pass_count view_count views_with_receivers
            views_with_casters pixels lit umbra penumbra packets coherent_packets reprocessed_packets nodes_visited
            edges_extracted samples_read }
        hs_pass { r#type size next name count reserved device_ms }
        hs_reference_info { r#type size next light samples seed }
    }
}

fn host_owned() -> Vec<Layout> {
    layouts! {
        hs_vk_format { format features }
        hs_vk_requirements { r#type size next api_version queue_flags required_extension_count
            recommended_extension_count recommended_extensions formats sampled_usage visibility_usage mesh_usage
            shadow_map_format usable reserved missing }
        hs_vk_device_info { r#type size next instance physical_device device get_instance_proc_addr api_version
            queue_family extensions extension_count features allocator log log_user }
        hs_vk_effect_info { r#type size next width height light settings casters surface normals side_faces
            instance_max vertex_max triangle_max edge_cost visibility_cost reserved }
        hs_vk_image { r#type size next image format width height usage layer level current_layout final_layout
            current_stage current_access final_stage final_access }
        hs_vk_slot { r#type size next surface normal visibility maps map_count }
        hs_vk_mesh { r#type size next vertices vertex_offset vertex_stride vertex_count indices index_offset
            index_type triangle_count }
        hs_vk_prepare_info { r#type size next slots slot_count meshes mesh_count }
        hs_vk_instance { r#type size next mesh reserved transform }
        hs_vk_map { r#type size next clip_from_world depth_empty reserved }
        hs_vk_view { r#type size next command_buffer projections offset index map }
        hs_vk_frame { r#type size next serial slot instance_count light instances draw draw_user maps map_count
            near_distance world_from_clip normal_to_world depth_empty background position_error }
        hs_vk_effect_state { r#type size next memory_bytes projections projection_stride view_count pass_count
            prepared }
    }
}

#[test]
fn structures_of_the_host_owned_tier_are_laid_out_alike() {
    check("halfshade_vulkan.h", &host_owned());
}

/// Names of the fields of every structure of a header, in its order.
fn declared(header: &str) -> Vec<(String, Vec<String>)> {
    let text =
        fs::read_to_string(root().join("include").join(header)).expect("the header is there");
    let mut structures: Vec<(String, Vec<String>)> = Vec::new();
    let mut inside = false;
    for line in text.lines().map(str::trim) {
        if let Some(name) = line
            .strip_prefix("typedef struct ")
            .and_then(|rest| rest.strip_suffix(" {"))
        {
            structures.push((name.into(), Vec::new()));
            inside = true;
        } else if line.starts_with('}') {
            inside = false;
        } else if inside && line.ends_with(';') && !line.starts_with("//") {
            let declaration = line.trim_end_matches(';');
            let declaration = declaration.split('[').next().expect("a part");
            let name = declaration.rsplit([' ', '*']).next().expect("a name");
            structures
                .last_mut()
                .expect("one began")
                .1
                .push(name.into());
        }
    }
    structures
}

/// Lets the C compiler compare: an array of negative size is an error, and its name says which.
fn check(header: &str, layouts: &[Layout]) {
    let mut listed: Vec<(String, Vec<String>)> = layouts
        .iter()
        .map(|layout| {
            let fields = layout.fields.iter().map(|(name, _)| (*name).to_owned());
            (layout.name.to_owned(), fields.collect())
        })
        .collect();
    let mut declared = declared(header);
    declared.sort();
    listed.sort();
    assert_eq!(
        declared, listed,
        "the list of this test is not that of {header}"
    );
    let mut source = format!("#include \"{header}\"\n#include <stddef.h>\n");
    for Layout { name, size, fields } in layouts {
        writeln!(
            source,
            "typedef char size_of_{name}[sizeof({name}) == {size} ? 1 : -1];"
        )
        .expect("a string");
        for (field, offset) in fields {
            writeln!(
                source,
                "typedef char offset_of_{name}_{field}[offsetof({name}, {field}) == {offset} ? 1 : -1];"
            )
            .expect("a string");
        }
    }
    let workshop = Workshop::new();
    let path = workshop.path("layouts.c");
    fs::write(&path, source).expect("written");
    done(
        Command::new("cc")
            .args([
                "-std=c99",
                "-Wall",
                "-Wextra",
                "-Werror",
                "-pedantic",
                "-c",
                "-o",
                "/dev/null",
            ])
            .arg(format!("-I{}", root().join("include").display()))
            .arg(&path),
    );
}

#[test]
fn structures_of_the_standalone_tier_are_laid_out_alike() {
    check("halfshade.h", &standalone());
}
