#pragma once

#include <filesystem>

#include "scene/scene.h"

namespace airlight::scene {

/// Reads a scene file: glTF 2.0 (`.gltf`, `.glb`), Wavefront OBJ (`.obj`) or PLY (`.ply`), by its extension.
///
/// Node transforms are applied; perspective cameras and lights are kept, and with Looks::textured the
/// textures of base colours, PNG or JPEG, within the file or beside it; what else matters for the picture
/// (other textures, skins, …) becomes a counted warning. Zero-area triangles are dropped and counted.
/// @throws Error (bad_file) for a missing, broken or unsupported file, for NaN, infinite or overflowing
/// coordinates, with their place, and for a texture that is missing, broken or larger than k_largest_texture,
/// with its material.
Scene import_scene(const std::filesystem::path& file, Looks looks = Looks::flat);

}  // namespace airlight::scene
