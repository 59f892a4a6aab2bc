#include "scene/scene.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "scene/error.h"

namespace airlight::scene {
namespace {

/// Squares of shorter distances vanish in single precision.
constexpr double k_shortest_distance = 1e-18;  // [m]

bool is_finite(glm::dvec3 v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

double largest(glm::dvec3 v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

std::string text_of(glm::dvec3 v) {
  return fmt::format("({:g}, {:g}, {:g})", v.x, v.y, v.z);
}

void check_point(ExitCode code, const std::string& where, glm::dvec3 point) {
  if (!is_finite(point)) throw Error(code, where, fmt::format("{} is not finite", text_of(point)));
  if (largest(point) > k_largest_coordinate)
    throw Error(
        code, where,
        fmt::format("{} is farther than {:g} m from the origin", text_of(point), k_largest_coordinate));
}

void check_coefficient(const std::string& where, glm::dvec3 value) {
  if (!is_finite(value) || std::min({value.x, value.y, value.z}) < 0.0)
    throw Error(ExitCode::bad_file, where, fmt::format("{} is not finite and non-negative", text_of(value)));
}

void validate(const Light& light, glm::dvec3 eye) {
  const std::string where = light.name.empty() ? "light" : fmt::format("light '{}'", light.name);
  check_point(ExitCode::bad_file, where + ", position", light.position);
  check_coefficient(where + ", intensity", light.intensity);
  if (glm::distance(light.position, eye) < k_shortest_distance)
    throw Error(ExitCode::bad_file, where, "it is at the eye, where the airlight is infinite",
                "move the light or the camera");
}

}  // namespace

Box bounds(const Geometry& geometry) {
  Box box;
  for (glm::uvec3 triangle : geometry.triangles)
    for (int corner = 0; corner < 3; ++corner) box.include(geometry.positions[triangle[corner]]);
  return box;
}

std::string phase_name(PhaseFunction phase) {
  switch (phase) {
    case PhaseFunction::isotropic:
      return "isotropic";
    case PhaseFunction::rayleigh:
      return "rayleigh";
    case PhaseFunction::henyey_greenstein:
      return "henyey-greenstein";
    case PhaseFunction::hoffman_preetham:
      return "hoffman-preetham";
  }
  return {};
}

PhaseFunction phase_of_name(const std::string& where, std::string_view name) {
  using enum PhaseFunction;
  for (PhaseFunction phase : {isotropic, rayleigh, henyey_greenstein, hoffman_preetham})
    if (phase_name(phase) == name) return phase;
  throw Error(ExitCode::usage, where, fmt::format("'{}' is unknown", name),
              "use isotropic, rayleigh, henyey-greenstein or hoffman-preetham");
}

bool has_g(PhaseFunction phase) {
  return phase == PhaseFunction::henyey_greenstein || phase == PhaseFunction::hoffman_preetham;
}

CameraFrame camera_frame(const Camera& camera, glm::ivec2 image_size) {
  const std::string where = camera.name.empty() ? "camera" : fmt::format("camera '{}'", camera.name);
  const auto refuse = [&](const std::string& problem) -> Error { return {ExitCode::usage, where, problem}; };

  if (image_size.x < 1 || image_size.y < 1)
    throw refuse(fmt::format("an image of {}x{} has no pixels", image_size.x, image_size.y));
  check_point(ExitCode::usage, where + ", eye", camera.eye);
  check_point(ExitCode::usage, where + ", target", camera.target);
  if (!is_finite(camera.up)) throw refuse(fmt::format("up {} is not finite", text_of(camera.up)));
  if (!(camera.vertical_fov_degrees > 0.0 && camera.vertical_fov_degrees < 180.0))
    throw refuse(fmt::format("a vertical field of view of {:g} degrees is not between 0 and 180",
                             camera.vertical_fov_degrees));

  const glm::dvec3 view = camera.target - camera.eye;
  // Scaling first keeps the squares of very short and very long vectors from vanishing or overflowing.
  const double view_size = largest(view), up_size = largest(camera.up);
  if (view_size == 0.0) throw refuse(fmt::format("eye and target are both {}", text_of(camera.eye)));
  if (up_size == 0.0) throw refuse("up is the zero vector");

  CameraFrame frame;
  frame.eye = camera.eye;
  frame.forward = glm::normalize(view / view_size);
  const glm::dvec3 across = glm::cross(frame.forward, glm::normalize(camera.up / up_size));
  // The sine of an angle below which its direction is mostly rounding.
  if (glm::length(across) < 1e-9) throw refuse("up is parallel to the view");
  frame.right = glm::normalize(across);
  frame.up = glm::cross(frame.right, frame.forward);
  frame.half_height = std::tan(0.5 * glm::radians(camera.vertical_fov_degrees));
  frame.half_width = frame.half_height * image_size.x / image_size.y;
  return frame;
}

void validate(const View& view) {
  camera_frame(view.camera, view.size);

  if (view.lights.empty()) throw Error(ExitCode::bad_file, "view", "it has no light");
  for (const Light& light : view.lights) validate(light, view.camera.eye);

  const Medium& medium = view.medium;
  check_coefficient("medium, sigma-s", medium.sigma_s);
  check_coefficient("medium, sigma-a", medium.sigma_a);
  if (!(std::abs(medium.g) < 1.0f))
    throw Error(ExitCode::bad_file, "medium, g", fmt::format("{:g} is not between -1 and 1", medium.g));
  if (!(medium.rayleigh_weight >= 0.0f && medium.rayleigh_weight <= 1.0f))
    throw Error(ExitCode::bad_file, "medium, rayleigh-weight",
                fmt::format("{:g} is not between 0 and 1", medium.rayleigh_weight));
  if (medium.phase > PhaseFunction::hoffman_preetham)
    throw Error(ExitCode::bad_file, "medium, phase",
                fmt::format("there is no phase function {}", static_cast<std::uint32_t>(medium.phase)));
}

void override_albedo(Geometry& geometry, glm::vec3 albedo) {
  geometry.materials = {{albedo}};
  std::fill(geometry.material_of_triangle.begin(), geometry.material_of_triangle.end(), 0u);
}

Camera fit_camera(const Geometry& geometry) {
  Camera camera;
  camera.name = "fitted";
  const Box box = bounds(geometry);
  if (box.empty()) return camera;

  const glm::dvec3 lower = box.lower, upper = box.upper;
  const glm::dvec3 center = 0.5 * (lower + upper);
  const double radius = 0.5 * glm::distance(lower, upper);
  // The sphere around the box touches the edges of a square image, plus a margin.
  const double distance = 1.05 * radius / std::sin(0.5 * glm::radians(camera.vertical_fov_degrees));
  camera.target = center;
  camera.eye = center + distance * glm::normalize(glm::dvec3(0.0, 0.3, 1.0));
  return camera;
}

}  // namespace airlight::scene
