// All resources that passes share, each declared once. A pass names what it uses, with GLSL's own qualifier of access:
//
//     readonly BUFFER(views);
//     BUFFER(fits);
//     TEXTURE(shadow_map);
//     writeonly IMAGE(position_world, rgba32f);
//
// A resource has the same number in every pass. The host binds it by its name, which plans and debug labels print as
// well. What belongs to a single technique is declared in that technique's own files, with numbers from 48 on.

#define BUFFER(name) RESOURCE_##name
#define TEXTURE(name) RESOURCE_##name(AS_TEXTURE)
#define IMAGE(name, format) layout(format) RESOURCE_##name(AS_IMAGE)

// A buffer of a single struct, and one of any number of elements.
#define STRUCT(number, type, name) layout(binding = number, scalar) buffer name##_block { type name; }
#define ARRAY(number, type, name) layout(binding = number, scalar) buffer name##_block { type name[]; }

#define AS_TEXTURE(number, texture, image, name) layout(binding = number) uniform texture name
#define AS_IMAGE(number, texture, image, name) layout(binding = number) uniform image name

// The frame.
#define RESOURCE_frame STRUCT(0, Frame, frame)
#define RESOURCE_views ARRAY(1, View, views)
#define RESOURCE_fits ARRAY(2, Fit, fits)
#define RESOURCE_lights ARRAY(3, Light, lights)
#define RESOURCE_corners ARRAY(70, vec2, corners)
#define RESOURCE_counters STRUCT(4, Counters, counters)

// The scene.
#define RESOURCE_positions ARRAY(5, vec3, positions)
#define RESOURCE_position_residuals ARRAY(6, vec3, position_residuals)
#define RESOURCE_triangles ARRAY(7, uvec3, triangles)
#define RESOURCE_triangle_surfaces ARRAY(8, uint, triangle_surfaces)
#define RESOURCE_triangle_planes ARRAY(9, vec4, triangle_planes)
#define RESOURCE_surfaces ARRAY(10, Surface, surfaces)
#define RESOURCE_texcoords ARRAY(11, vec2, texcoords)
#define RESOURCE_vertex_surfaces ARRAY(12, uint, vertex_surfaces)
#define RESOURCE_vertex_colors ARRAY(64, vec3, vertex_colors)
#define RESOURCE_texels ARRAY(13, uint, texels)

// A host's.
#define RESOURCE_host STRUCT(14, Host, host)
#define RESOURCE_instances ARRAY(15, Instance, instances)
#define RESOURCE_host_vertices ARRAY(16, uint, host_vertices)
#define RESOURCE_host_indices ARRAY(17, uint, host_indices)
#define RESOURCE_host_surface(AS) AS(18, texture2D, image2D, host_surface)
#define RESOURCE_host_normal(AS) AS(19, texture2D, image2D, host_normal)
#define RESOURCE_host_map(AS) AS(20, texture2D, image2D, host_map)
#define RESOURCE_givens ARRAY(21, Given, givens)
#define RESOURCE_projections ARRAY(22, Projection, projections)

// The visible surface.
#define RESOURCE_position_world(AS) AS(23, texture2D, image2D, position_world)
#define RESOURCE_normal_world(AS) AS(24, texture2D, image2D, normal_world)
#define RESOURCE_albedo(AS) AS(25, texture2D, image2D, albedo)

// A view's shadow map and what is built over it.
#define RESOURCE_caster_indices ARRAY(26, uint, caster_indices)
#define RESOURCE_triangle_casts ARRAY(43, uint, triangle_casts)
#define RESOURCE_shadow_map(AS) AS(27, texture2DArray, image2DArray, shadow_map)
#define RESOURCE_layers(AS) AS(28, texture2DArray, image2DArray, layers)
#define RESOURCE_coarse_map ARRAY(44, vec2, coarse_map)
#define RESOURCE_hierarchy_groups ARRAY(65, HierarchyGroups, hierarchy_groups)
#define RESOURCE_hierarchy(AS) AS(29, texture2DArray, image2DArray, hierarchy)

// From kernels to visibility.
#define RESOURCE_tile_bounds ARRAY(61, TileBounds, tile_bounds)
#define RESOURCE_grids ARRAY(81, uint, grids)
#define RESOURCE_tiles ARRAY(62, Tile, tiles)
#define RESOURCE_kernels ARRAY(30, Kernel, kernels)
#define RESOURCE_windows ARRAY(63, Window, windows)
#define RESOURCE_budgets ARRAY(45, float, budgets)
#define RESOURCE_quality ARRAY(46, float, quality)
#define RESOURCE_quality_rows ARRAY(47, float, quality_rows)
#define RESOURCE_costs STRUCT(31, Costs, costs)
#define RESOURCE_packets ARRAY(32, Packet, packets)
#define RESOURCE_pixels ARRAY(33, uint, pixels)
#define RESOURCE_lists ARRAY(34, Lists, lists)
#define RESOURCE_rounds ARRAY(35, Round, rounds)
#define RESOURCE_progress ARRAY(36, Progress, progress)
#define RESOURCE_partial ARRAY(37, SUM, partial)
#define RESOURCE_sectors ARRAY(38, float, sectors)
#define RESOURCE_occlusion ARRAY(39, float, occlusion)
#define RESOURCE_occluded_by_view ARRAY(66, float, occluded_by_view)
#define RESOURCE_visibility ARRAY(40, float, visibility)

// The picture.
#define RESOURCE_exposure STRUCT(41, Exposure, exposure)
#define RESOURCE_picture ARRAY(42, uint, picture)
