#include "scene/scene.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "scene/error.h"
#include "scene/view_fields.h"

namespace airlight::scene {
namespace {

/// Squares of shorter distances vanish in single precision.
constexpr double k_shortest_distance = 1e-18;  // [m]

double largest(glm::dvec3 v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

std::string text_of(glm::dvec3 v) {
  return fmt::format("({:g}, {:g}, {:g})", v.x, v.y, v.z);
}

/// Checks each field by itself.
template <typename Thing>
void check_fields(ExitCode code, const std::string& where, const Thing& thing) {
  for (const Field<Thing>& field : fields<Thing>()) {
    const auto value = field.read(thing);
    if (const auto wrong = value ? field.problem(*value) : std::nullopt)
      throw Error(code, fmt::format("{}, {}", where, field.key()), wrong->problem, wrong->remedy);
  }
}

/// A sun that stands lower reaches a layer along paths so long that single precision cannot tell them apart.
constexpr double k_lowest_sun = 1e-6;  // sine of its elevation

/// The largest brightness of fog, σ_s I/D [W/(m² sr)], or under a sun σ_s E [W/m³]. What this leaves to the
/// largest number in single precision is for the peaks towards the light, 1/sin α, and of the phase function.
constexpr double k_brightest = 1e25;

void validate_sun(const std::string& where, const Light& sun, const Medium& medium) {
  assert(std::abs(glm::length(sun.towards) - 1.0) < 1e-9);
  if (const auto wrong = sun.texture ? field<Light>("light-texture").lack(sun) : std::nullopt)
    throw Error(ExitCode::bad_file, where, wrong->problem, wrong->remedy);
  if (sun.cone || sun.range)
    throw Error(ExitCode::bad_file, where, "it is a sun, which has no cone and no range",
                "spots and ranges are for lamps");
  if (medium.top && sun.towards.y < k_lowest_sun)
    throw Error(ExitCode::usage, where,
                "a sun that is at or below the horizon never reaches a medium with a top",
                "raise the sun, or leave out --fog-top");
  if (largest(sun.irradiance) * largest(medium.sigma_s) > k_brightest)
    throw Error(ExitCode::usage, where + ", irradiance",
                fmt::format("{:g} W/m2 in this medium could overflow single precision, which images are in",
                            largest(sun.irradiance)),
                "lower --irradiance");
}

void validate(const Light& light, const View& view) {
  const glm::dvec3 eye = view.camera.eye;
  const std::string where = light.name.empty() ? "light" : fmt::format("light '{}'", light.name);
  check_fields(ExitCode::bad_file, where, light);
  if (is_sun(light)) return validate_sun(where, light, view.medium);
  if (light.cone && !(std::abs(glm::length(light.cone->axis) - 1.0) < 1e-9))
    throw Error(ExitCode::bad_file, where, "it is a spot whose axis is no direction of unit length",
                "aim it at a point that is not where it stands");
  if (glm::distance(light.position, eye) < k_shortest_distance)
    throw Error(ExitCode::bad_file, where, "it is at the eye, where the airlight is infinite",
                "move the light or the camera");
  const double distance = glm::distance(light.position, eye);
  const double brightest = largest(light.intensity) * largest(view.medium.sigma_s) / distance;
  if (brightest > k_brightest)
    throw Error(
        ExitCode::usage, where + ", intensity",
        fmt::format("{:g} W/sr at {:g} m from the eye could overflow single precision, which images are in",
                    largest(light.intensity), distance),
        "lower --intensity");
}

}  // namespace

bool has_area(glm::vec3 a, glm::vec3 b, glm::vec3 c) {
  // The differences of floats and the products of those lose nothing that matters in double, so thin
  // triangles have one.
  const glm::dvec3 origin(a);
  return glm::cross(glm::dvec3(b) - origin, glm::dvec3(c) - origin) != glm::dvec3(0.0);
}

bool has_cut_outs(const Geometry& geometry) {
  return std::any_of(geometry.materials.begin(), geometry.materials.end(),
                     [](const Material& material) { return material.cut_out.has_value(); });
}

std::size_t texel_count(const Geometry& geometry) {
  std::size_t count = 0;
  for (const TextureImage& texture : geometry.textures) count += texture.texels.size();
  return count;
}

Box bounds(const Geometry& geometry) {
  Box box;
  for (glm::uvec3 triangle : geometry.triangles)
    for (int corner = 0; corner < 3; ++corner) box.include(geometry.positions[triangle[corner]]);
  return box;
}

bool shine_alike(const Light& a, const Light& b) {
  Light as_bright = a;
  as_bright.name = b.name;
  as_bright.intensity = b.intensity;
  as_bright.irradiance = b.irradiance;
  return as_bright == b;
}

glm::dvec3 direction_to(const Light& light, glm::dvec3 from) {
  return is_sun(light) ? light.towards : glm::normalize(light.position - from);
}

double reach_from(glm::dvec3 point, const Box& box) {
  return glm::length(
      glm::max(glm::abs(glm::dvec3(box.lower) - point), glm::abs(glm::dvec3(box.upper) - point)));
}

glm::dvec3 unit(glm::dvec3 v) {
  // Scaling first keeps the squares of very short and very long vectors from vanishing or overflowing.
  return glm::normalize(v / largest(v));
}

glm::dvec3 image_ray(const CameraFrame& camera, glm::dvec2 place) {
  return camera.forward + place.x * camera.half_width * camera.right +
         place.y * camera.half_height * camera.up;
}

glm::dvec3 image_ray(const CameraFrame& camera, glm::dvec2 image_size, glm::dvec2 point) {
  return image_ray(camera, {2.0 * point.x / image_size.x - 1.0, 1.0 - 2.0 * point.y / image_size.y});
}

std::array<glm::dvec3, 4> corner_rays(const CameraFrame& camera) {
  return {image_ray(camera, {-1, -1}), image_ray(camera, {1, -1}), image_ray(camera, {1, 1}),
          image_ray(camera, {-1, 1})};
}

std::span<const std::string_view> phase_names() {
  static constexpr auto k_names =
      std::to_array<std::string_view>({"isotropic", "rayleigh", "henyey-greenstein", "hoffman-preetham"});
  return k_names;
}

std::span<const std::string_view> tone_map_names() {
  static constexpr auto k_names = std::to_array<std::string_view>({"none", "reinhard", "aces", "agx"});
  return k_names;
}

std::string tone_map_name(ToneMap tone_map) {
  return std::string(tone_map_names()[static_cast<std::size_t>(tone_map)]);
}

std::string phase_name(PhaseFunction phase) {
  const auto index = static_cast<std::size_t>(phase);
  return index < phase_names().size() ? std::string(phase_names()[index]) : std::string();
}

bool has_g(PhaseFunction phase) {
  return phase == PhaseFunction::henyey_greenstein || phase == PhaseFunction::hoffman_preetham;
}

CameraFrame camera_frame(const Camera& camera, glm::ivec2 image_size) {
  const std::string where = camera.name.empty() ? "camera" : fmt::format("camera '{}'", camera.name);
  const auto refuse = [&](const std::string& problem) -> Error { return {ExitCode::usage, where, problem}; };

  if (const auto wrong = field<View>("size").problem(image_size)) throw refuse(wrong->problem);
  check_fields(ExitCode::usage, where, camera);

  const glm::dvec3 view = camera.target - camera.eye;
  if (largest(view) == 0.0) throw refuse(fmt::format("eye and target are both {}", text_of(camera.eye)));
  if (largest(camera.up) == 0.0) throw refuse("up is the zero vector");

  CameraFrame frame;
  frame.eye = camera.eye;
  frame.forward = unit(view);
  const glm::dvec3 across = glm::cross(frame.forward, unit(camera.up));
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
  check_fields(ExitCode::bad_file, "medium", view.medium);
  check_fields(ExitCode::bad_file, "surroundings", view.surroundings);
  for (const Light& light : view.lights) validate(light, view);
}

void show_flat(Scene& scene) {
  Geometry& geometry = scene.geometry;
  const auto masks = std::count_if(geometry.materials.begin(), geometry.materials.end(),
                                   [](const Material& material) { return material.cut_out.has_value(); });
  if (masks > 0)
    scene.report.warnings.push_back(
        fmt::format("alpha masks of materials ignored ({}): surfaces are opaque", masks));
  for (Material& material : geometry.materials)
    material = {.albedo = material.albedo, .transmittance = material.transmittance};
  geometry.textures.clear();
  geometry.texture_places.clear();
  geometry.normals.clear();
}

void override_albedo(Geometry& geometry, glm::vec3 albedo) {
  for (Material& material : geometry.materials) {
    material.albedo = albedo;
    material.texture.reset();
  }
  if (has_cut_outs(geometry)) return;
  geometry.textures.clear();
  geometry.texture_places.clear();
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
