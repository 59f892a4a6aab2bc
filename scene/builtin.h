#pragma once

#include <span>
#include <string_view>

#include "scene/scene.h"

namespace airlight::scene {

/// A scene made by code, with camera, light and medium that show its point.
struct BuiltinScene {
  std::string_view name;
  std::string_view description;  ///< one line
  Scene (*make)();
};

/// All built-in scenes; the first is the default.
std::span<const BuiltinScene> builtin_scenes();

/// @returns the built-in scene of that name, or nullptr.
const BuiltinScene* find_builtin(std::string_view name);

}  // namespace airlight::scene
