#include "frame/shadow_map.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "frame/reversed_depth.h"
#include "scene/error.h"

#include "spirv/frame/shadow_map_frag.h"
#include "spirv/frame/shadow_map_vert.h"

namespace airlight::frame {

void require_shadow_map(const gpu::Context& context, int size) {
  const int limit = std::min(context.limits().max_texture_size, context.limits().max_viewport);
  if (size > limit) {
    throw scene::Error(
        scene::ExitCode::driver, "--shadow-map",
        fmt::format("{} texels are more than this driver's {} (GL_MAX_TEXTURE_SIZE)", size, limit),
        "ask for a smaller one");
  }
}

SurfacePipeline make_shadow_map_pipeline(bool is_plane) {
  return SurfacePipeline([is_plane](bool cut_outs) {
    return gpu::Pipeline::graphics({.vertex = k_shadow_map_vert, .fragment = k_shadow_map_frag},
                                   k_reversed_depth,
                                   std::array{gpu::Constant(0, is_plane), gpu::Constant(1, cut_outs)});
  });
}

namespace {

/// The axis of a face and those of its u and v: the same as in shaders/frame/shadow_cube.glsl.
struct FaceAxes {
  explicit FaceAxes(int face)
      : forward(unit(face / 2) * (face % 2 == 0 ? 1.0 : -1.0)),
        u(unit((face / 2 + 1) % 3)),
        v(unit((face / 2 + 2) % 3)) {}
  static glm::dvec3 unit(int i) { return glm::dvec3(i == 0, i == 1, i == 2); }
  glm::dvec3 forward, u, v;
};

/// A convex cone about the origin: the sums of multiples ≥ 0 of unit directions.
using Cone = std::vector<glm::dvec3>;

/// The pyramid of directions forward + x·u + y·v with |x|, |y| ≤ 1.
Cone pyramid(glm::dvec3 forward, glm::dvec3 u, glm::dvec3 v) {
  Cone corners;
  for (const double x : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0}) corners.push_back(glm::normalize(forward + x * u + y * v));
  return corners;
}

/// Whether all directions of one cone are more than `reach` [rad] from all of the other: never wrongly "yes".
/// Convex cones that do not meet are parted by a side of one of them, a plane through two of its directions.
bool are_apart(const Cone& a, const Cone& b, double reach) {
  for (const Cone* cone : {&a, &b}) {
    for (const glm::dvec3& first : *cone) {
      for (const glm::dvec3& second : *cone) {
        glm::dvec3 normal = glm::cross(first, second);
        const double length = glm::length(normal);
        if (length < 1e-9) continue;
        normal /= length;
        double above = 1.0, below = 1.0;  // sines of the least angles from the plane, a's above and b's below
        for (const glm::dvec3& direction : a) above = std::min(above, glm::dot(normal, direction));
        for (const glm::dvec3& direction : b) below = std::min(below, -glm::dot(normal, direction));
        constexpr double k_rounding = 1e-12;
        if (above < -k_rounding || below < -k_rounding) continue;
        if (std::asin(above) + std::asin(below) > reach) return true;
      }
    }
  }
  return false;
}

}  // namespace

CubeFaces needed_faces(const scene::CameraFrame& camera, glm::dvec3 light, double reach) {
  // From the light the point at t along a view ray w is seen along (eye − light) + t·w.
  Cone seen = {glm::normalize(camera.eye - light)};
  for (const glm::dvec3& corner : scene::corner_rays(camera)) seen.push_back(glm::normalize(corner));
  // Shaders add the two in single precision. Where they cancel, close to the light, the direction is off by
  // a rounding over the angle between view ray and light, which out of view is at least half a pixel.
  constexpr double k_rounding = 0.01;
  CubeFaces needed;
  for (int face = 0; face < 6; ++face) {
    const FaceAxes axes(face);
    needed.set(static_cast<std::size_t>(face),
               !are_apart(seen, pyramid(axes.forward, axes.u, axes.v), reach + k_rounding));
  }
  return needed;
}

ShadowMap::ShadowMap(const gpu::Context& context, int size) : pipeline_(make_shadow_map_pipeline(false)) {
  require_shadow_map(context, size);
  depth_ = gpu::Texture(gpu::Format::depth32f, {size, size}, 6);
  for (int face = 0; face < 6; ++face)
    faces_.push_back(gpu::Framebuffer({}, gpu::Attachment(depth_, 0, face)));
}

void ShadowMap::draw(const SceneBuffers& scene, glm::dvec3 light, std::span<const std::uint32_t> left_out,
                     CubeFaces faces) {
  const glm::vec3 light_high(light);
  for (std::size_t face = 0; face < 6; ++face) {
    if (drawn_[face]) continue;
    const gpu::Framebuffer& target = faces_[face];
    if (!empty_[face]) target.clear();
    empty_[face] = !faces[face];
    drawn_[face] = faces[face];
    if (!faces[face]) continue;
    const FaceAxes axes(static_cast<int>(face));
    const Pyramid seen{.apex = light,
                       .right = axes.u,
                       .up = axes.v,
                       .forward = axes.forward,
                       .half_width = 1.0,
                       .half_height = 1.0};
    pipeline_.draw(
        target, scene, [&](const scene::Box& box) { return may_touch(seen, box); }, left_out,
        [&](gpu::Pipeline& pipeline) {
          pipeline.set(0, static_cast<int>(face));
          pipeline.set(1, light_high);
          pipeline.set(2, glm::vec3(light - glm::dvec3(light_high)));
        });
  }
}

}  // namespace airlight::frame
