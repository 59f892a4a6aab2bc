#pragma once

#include <filesystem>

#include "scene/scene.h"

namespace airlight::scene {

/// Reads a scene file: glTF 2.0 (`.gltf`, `.glb`), Wavefront OBJ (`.obj`) or PLY (`.ply`), by its extension.
///
/// Node transforms are applied; perspective cameras and point lights are kept; what else matters for the
/// picture (other lights, textures, skins, …) becomes a counted warning. Zero-area triangles are dropped and
/// counted.
/// @throws Error (bad_file) for a missing, broken or unsupported file, and for NaN, infinite or overflowing
/// coordinates, with their place.
Scene import_scene(const std::filesystem::path& file);

}  // namespace airlight::scene
