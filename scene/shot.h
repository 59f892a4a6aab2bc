#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>

#include "scene/scene.h"

namespace airlight::scene {

/// Reads a shot, a TOML file that names a scene and says how it is shown:
///
///     scene = "lamp.glb"         # a model, relative to the shot, or a built-in scene's name
///     triangles = 20000          # of a built-in scene whose count can be set
///     exposure = 4.0             # of PNG previews
///     albedo = [0.5, 0.5, 0.5]   # of every surface; one number means grey
///     [camera]                   # a camera of the scene by its name, or eye and target [m]
///     eye = [0, 1, 4]
///     target = [0, 1, 0]
///     up = [0, 1, 0]
///     fov = 38                   # vertical [degrees]
///     [light]                    # a light of the scene by its name, or position [m] and intensity [W/sr]
///     position = [0, 1.85, 0]
///     intensity = [1, 0.86, 0.68]
///     [medium]
///     sigma_s = 0.25             # [1/m]
///     sigma_a = 0.0
///     phase = "henyey-greenstein"
///     g = 0.5
///     rayleigh_weight = 0.5      # with phase = "hoffman-preetham"
///
/// Everything but `scene` may be left out. Keys mean what the command line's options of these names mean.
/// @param triangles asked for in place of the shot's own
/// @returns the scene; its first camera and light, its medium and its exposure are the shot's
/// @throws Error (bad_file) with file and line, also for what `import_scene` refuses and for a view that
/// `validate` refuses; (usage) where `triangles` cannot be
Scene load_shot(const std::filesystem::path& file, std::optional<std::size_t> triangles = {});

}  // namespace airlight::scene
