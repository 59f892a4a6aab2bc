#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>

#include "scene/scene.h"
#include "scene/view_fields.h"

namespace airlight::scene {

/// Reads a shot, a TOML file that names a scene and says how it is shown:
///
///     scene = "lamp.glb"         # a model, relative to the shot, or a built-in scene's name
///     triangles = 20000          # of a built-in scene whose count can be set
///     exposure = 4.0             # of PNG previews
///     tone_map = "agx"           # the same
///     ambient = [0.01, 0.01, 0.02]   # radiance from all sides that surfaces reflect [W/(m² sr)]
///     background = [0.1, 0.1, 0.2]   # radiance beyond all surfaces [W/(m² sr)]
///     albedo = [0.5, 0.5, 0.5]   # of every surface; one number means grey
///     [camera]                   # name = "NAME" of one of the scene's, or eye and target [m]
///     eye = [0, 1, 4]
///     target = [0, 1, 0]
///     up = [0, 1, 0]
///     fov = 38                   # vertical [degrees]
///     [light]                    # name = "NAME" of one of the scene's, or position [m] and intensity [W/sr]
///     position = [0, 1.85, 0]
///     intensity = [1, 0.86, 0.68]
///     texture = "lantern.exr"    # what it radiates by direction, relative to the shot
///     target = [0, 0, 0]         # makes it a spot, which shines there [m]
///     angles = [20, 30]          # inner and outer half-angle of its cone [degrees]
///     range = 10                 # where its light ends [m]
///     [sun]                      # where [light] would stand
///     towards = [0.8, 0.5, 0.3]  # its direction, of any length; or:
///     angles = [70, 30]          # azimuth from +Z towards +X, elevation above the horizon [degrees]
///     irradiance = [3, 2.4, 1.6] # on a surface that faces it [W/m²]
///     [[light]]                  # instead of both, once for each of several lights, with either's keys
///     [medium]
///     sigma_s = 0.25             # [1/m]
///     sigma_a = 0.0
///     phase = "henyey-greenstein"
///     g = 0.5
///     rayleigh_weight = 0.5      # with phase = "hoffman-preetham"
///     fog_top = 16               # the medium fills what lies below [m]
///     [methods]                  # that it is best shown by, as airlight tune finds them
///     volume = "vsv:phi=256"
///     surface = "shadow-map"
///     shadow_map = 1024          # [texels]
///
/// Everything but `scene` may be left out. Keys mean what the command line's options of these names mean; a
/// camera or a light without a name of its own is named by its number from 0, as in name = "0". Lights stand
/// in for the scene's, which are off then, and chosen by name alone; without a name or a place, a light's
/// keys change the scene's only one.
/// @param triangles asked for in place of the shot's own
/// @param read_light_texture without it, a shot that names a texture is refused
/// @returns the scene; its first camera, its lights, its medium, its surroundings and its exposure are the
/// shot's
/// @throws Error (bad_file) with file and line, also for what `import_scene` refuses and for a view that
/// `validate` refuses; (usage) where `triangles` cannot be
Scene load_shot(const std::filesystem::path& file, std::optional<std::size_t> triangles = {},
                const LightTextureReader& read_light_texture = {}, Looks looks = Looks::flat);

}  // namespace airlight::scene
