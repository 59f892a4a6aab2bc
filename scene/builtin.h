#pragma once

#include <cassert>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "scene/scene.h"

namespace airlight::scene {

/// How many triangles a scene can have.
struct TriangleCount {
  std::size_t usual = 0;      ///< unless another count is asked for
  std::size_t fewest = 0;     ///< of what can be asked for
  std::string_view rounding;  ///< what a count asked for is rounded to
};

/// No scene can be asked for more triangles.
inline constexpr std::size_t k_most_triangles = 100'000'000;

/// A scene made by code, with camera, light and medium that show its point.
struct BuiltinScene {
  std::string_view name;
  std::string_view description;        ///< one line
  std::optional<TriangleCount> count;  ///< where it can be set
  Scene (*make_with)(std::size_t triangles);

  /// @param triangles from `count->fewest` to k_most_triangles, rounded as it says; only where there is a
  /// count
  Scene make(std::optional<std::size_t> triangles = {}, Looks looks = Looks::textured) const {
    assert(!triangles || (count && *triangles >= count->fewest && *triangles <= k_most_triangles));
    Scene scene = make_with(triangles.value_or(count ? count->usual : 0));
    if (looks == Looks::flat) show_flat(scene);
    return scene;
  }
};

/// All built-in scenes; the first is the default.
std::span<const BuiltinScene> builtin_scenes();

/// @returns the built-in scene of that name, or nullptr.
const BuiltinScene* find_builtin(std::string_view name);

/// What is wrong with asking the scene of that name for so many triangles, and what can be asked for; empty
/// where nothing is.
/// @param scene nullptr where it is not built in
std::string count_problem(const BuiltinScene* scene, std::string_view name, std::size_t triangles);

}  // namespace airlight::scene
