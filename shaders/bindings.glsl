// Where everything that a shader reads or writes is bound: one name a thing, for C++ and GLSL. OpenGL 4.5 guarantees 16 texture
// units, 8 storage buffers and 12 uniform blocks a stage: no number lies above that.
#ifndef AIRLIGHT_BINDINGS_GLSL
#define AIRLIGHT_BINDINGS_GLSL
#include "shared.glsl"

// Uniform blocks
CONST uint k_camera_block = 0u;  // frame/camera.glsl
CONST uint k_light_block = 1u;   // frame/light.glsl
CONST uint k_medium_block = 2u;  // frame/medium.glsl
CONST uint k_space_block = 3u;   // epipolar/space.glsl
CONST uint k_froxel_history_block = 4u;  // media/froxels.glsl
CONST uint k_rays_block = 5u;    // frame/ray_list_block.glsl

// Texture units
CONST uint k_surface_unit = 0u;         // of a frame: normal and distance a pixel, …
CONST uint k_triangle_unit = 1u;        // … the triangle seen, …
CONST uint k_visibility_unit = 2u;      // … what of the light arrives at the surface, …
CONST uint k_airlight_unit = 3u;        // … and what the medium scatters
CONST uint k_shadow_map_unit = 4u;
CONST uint k_light_texture_unit = 5u;
CONST uint k_scratch_unit = 6u;         // of one step, which reads back what it wrote
CONST uint k_planes_unit = 7u;          // epipolar/planes.glsl
CONST uint k_positions_unit = 8u;       // of a scene: vertices, …
CONST uint k_triangles_unit = 9u;       // … their indices, …
CONST uint k_albedos_unit = 10u;        // … materials, …
CONST uint k_materials_unit = 11u;      // … and which a triangle has
CONST uint k_grid_unit = 12u;           // epipolar/grid.glsl
CONST uint k_table_unit = 13u;          // media/vsv_table.glsl
CONST uint k_first_shadowed_unit = 14u; // epipolar/grid.h
CONST uint k_blocks_unit = 15u;         // epipolar/fused_scan.h
// Of surface shadows, which are asked for when no grid and no table is bound: surface_shadows/occluders.glsl, …
CONST uint k_insertion_order_unit = 7u;  // … a tree's triangles, …
CONST uint k_occluders_unit = 12u;
CONST uint k_triangle_planes_unit = 13u;
CONST uint k_tree_planes_unit = 14u;  // … its planes, …
CONST uint k_tree_links_unit = 15u;   // … and where they lead: surface_shadows/top_tree.glsl

CONST uint k_parts_unit = 14u;        // While occluders are made: which part a triangle is of, …
CONST uint k_is_culled_unit = 15u;    // … and which parts are culled
CONST uint k_subtrees_unit = 7u;      // While a tree is asked: what is known of its subtrees

CONST uint k_attenuations_unit = 3u;  // What light passes (surface_shadows/transmission.glsl)

CONST uint k_clusters_unit = 7u;            // Of a metric tree (surface_shadows/metric_tree.glsl): clusters of triangles, …
CONST uint k_partition_distances_unit = 6u; // … its nodes' δ, where they are stored, …
CONST uint k_always_asked_unit = 12u;       // … those that have no place in it, …
CONST uint k_cluster_triangles_unit = 14u;  // … their triangles, …
CONST uint k_metric_tree_unit = 15u;        // … and its nodes

CONST uint k_places_unit = 2u;            // While airlight is asked of listed rays: where they pass through the image.
CONST uint k_ray_members_unit = 6u;       // While they are listed, and then interpolated: of which sample or pixel each is, …
CONST uint k_sample_depths_unit = 7u;     // … what epipolar samples see, …
CONST uint k_ray_groups_unit = 12u;       // … which of them have rays, …
CONST uint k_sample_airlight_unit = 13u;  // … and their airlight

CONST uint k_base_colour_unit = 8u;       // Of a frame whose surfaces have looks (frame/looks.h), once they are found, …
CONST uint k_shading_normal_unit = 9u;    // … as are their normals; …
CONST uint k_material_textures_unit = 2u; // … while they are: each material's texture, …
CONST uint k_texels_unit = 3u;            // … the texels of all, …
CONST uint k_texture_places_unit = 4u;    // … where triangles lie in them, …
CONST uint k_normals_unit = 5u;           // … and normals of their corners

// Storage buffers
CONST uint k_phi_range_storage = 0u;  // epipolar/phi_range.glsl
CONST uint k_grid_storage = 1u;
CONST uint k_first_shadowed_storage = 2u;
CONST uint k_planes_storage = 3u;
CONST uint k_queue_storage = 4u;      // epipolar/triangle_queue.glsl
CONST uint k_scratch_storage = 5u;
CONST uint k_table_storage = 6u;
CONST uint k_blocks_storage = 7u;
CONST uint k_occluders_storage = 1u;  // as above
CONST uint k_tree_planes_storage = 2u;
CONST uint k_tree_links_storage = 3u;
CONST uint k_subtrees_storage = 4u;
CONST uint k_metric_tree_storage = 1u;
CONST uint k_always_asked_storage = 2u;
CONST uint k_light_view_storage = 3u;
CONST uint k_ray_list_storage = 1u;
CONST uint k_ray_members_storage = 2u;
CONST uint k_ray_groups_storage = 3u;

// Image units, of which a compute shader has 8
CONST uint k_froxels_image = 0u;  // media/froxel_scatter.comp
CONST uint k_lit_image = 1u;      // the same

#endif
