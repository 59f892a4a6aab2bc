// The C++ side of the shader functions: include this before a *.glsl file, inside namespace
// airlight::shaders.
#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#define AIRLIGHT_SHARED_GLSL  // keeps shaders/shared.glsl, the GLSL side, out
#define IN(type) const type&
#define OUT(type) type&
#define INOUT(type) type&
#define CONST inline constexpr
#define FUNCTION inline
#define PRECISE

namespace airlight::shaders {

using uint = std::uint32_t;
using glm::abs, glm::ceil, glm::clamp, glm::cross, glm::dot, glm::exp, glm::floor, glm::length, glm::max, glm::min,
    glm::mix, glm::normalize, glm::sqrt;
using glm::ivec2, glm::ivec3, glm::uvec2, glm::uvec3, glm::uvec4, glm::vec2, glm::vec3, glm::vec4;

}  // namespace airlight::shaders
