#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "quality/methods.h"
#include "scene/scene.h"

namespace airlight::viewer {

/// What a picture is of, and by which methods: all that a `render` command can say beside its scene.
struct Shown {
  scene::View view;
  quality::VolumeChoice volume;  ///< as asked for: what is automatic is not fitted
  quality::SurfaceChoice surface;
  int shadow_map = 2048;          ///< side of a face [texels]
  std::optional<float> exposure;  ///< automatic without
  scene::ToneMap tone_map = scene::ToneMap::none;
};

/// The scene as a command names it.
struct SceneName {
  std::string spec;                        ///< SCENE
  std::optional<std::string> triangles{};  ///< --triangles
  std::optional<std::string> albedo{};     ///< --albedo
  std::optional<std::string> looks{};      ///< --looks
  std::optional<std::string> occluders{};  ///< --occluders
};

/// METHOD:key=value of a choice, without the keys whose values are the default.
template <typename MethodType>
std::string spec_of(const quality::Choice<MethodType>& choice);

/// The command that renders this very image.
/// @param output of -o
std::string command_of(const SceneName& scene, const Shown& shown, const std::string& output);

/// Camera and lights of a path at a time.
struct PathKey {
  double time;  ///< [s]
  scene::Camera camera;
  std::vector<scene::Light> lights;
};

/// Whether one list of lights can become the other by moving and changing them: as many, each of the same
/// name and kind.
bool are_same_lights(std::span<const scene::Light> a, std::span<const scene::Light> b);

/// A path (scene::load_path) through keys of the same lights, of thirty frames a second. Of lights it says
/// what is not the same at all keys and in the view.
/// @param lights of the view that the path is for: the same ones
std::string path_of(std::span<const PathKey> keys, std::span<const scene::Light> lights);

/// A shot (scene::load_shot) of it. Methods are no part of shots.
std::string shot_of(const SceneName& scene, const Shown& shown);

}  // namespace airlight::viewer
