#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "scene/gothic.h"
#include "scene/view_fields.h"

// A gallery whose windows are jalis: screens of pierced marble, through which a low sun falls in hundreds of
// thin shafts. A screen is two triangles: what is pierced, a texture cuts out.
//
// The rest is made of closed solids that reach into their neighbours, so no light leaks at a seam.

namespace airlight::scene {
namespace {

// Inner faces of the walls, and the ceiling [m].
constexpr double k_side = 3.4, k_far = -20.0, k_near = 7.0, k_ceiling = 6.6, k_wall = 0.7;
constexpr int k_bays = 6;
constexpr double k_bay = (k_near - k_far) / k_bays;

/// Strips of marble lie along three families of parallel lines, this far from one to the next [m] …
constexpr double k_apart = 0.42;
/// … and are as wide: between them are hexagons and triangles, which together are stars.
constexpr double k_strip = 0.105;
/// What the pattern repeats by: a texture's sides [m].
const glm::dvec2 k_period(2.0 * k_apart, 2.0 * k_apart / std::numbers::sqrt3);

/// The pierced marble, whose alpha falls through a half at the strips' edges, straight across two texels.
TextureImage pierced_marble() {
  TextureImage image{{256, 148}, {}};
  const glm::dvec2 texel = k_period / glm::dvec2(image.size);
  for (int row = 0; row < image.size.y; ++row) {
    for (int column = 0; column < image.size.x; ++column) {
      const glm::dvec2 at = (glm::dvec2(column, row) + 0.5) * texel;
      double from_line = k_apart;
      for (int family = 0; family < 3; ++family) {
        const double angle = std::numbers::pi / 3.0 * family;
        const double across = (std::cos(angle) * at.x + std::sin(angle) * at.y) / k_apart;
        from_line = std::min(from_line, k_apart * std::abs(across - std::floor(across) - 0.5));
      }
      const double inside = (0.5 * k_strip - from_line) / (2.0 * texel.x);
      const double alpha = std::clamp(0.5 + inside, 0.0, 1.0);
      // A bevel is a little darker.
      const double bright = 205.0 + 30.0 * std::clamp(0.25 * inside, 0.0, 1.0);
      image.texels.emplace_back(glm::u8vec3(bright, 0.97 * bright, 0.92 * bright),
                                std::lround(255.0 * alpha));
    }
  }
  return image;
}

/// A screen over an opening: what of it the arch does not show stands in the wall.
void add_screen(Modeller& model, Geometry& geometry, const Plane& plane, const Opening& o, double top) {
  const double left = o.x - o.half_width - 0.15, right = o.x + o.half_width + 0.15, bottom = o.sill - 0.15;
  const auto corner = [&](double x, double y) { return model.vertex(plane.at(x, y, -0.5 * k_wall)); };
  model.quad(corner(left, bottom), corner(right, bottom), corner(right, top), corner(left, top));
  geometry.texture_places.resize(geometry.triangles.size());
  const auto place = [](double x, double y) { return glm::vec2(glm::dvec2(x, -y) / k_period); };
  const auto triangles = geometry.texture_places.end() - 2;
  triangles[0] = {place(left, bottom), place(right, bottom), place(right, top)};
  triangles[1] = {place(left, bottom), place(right, top), place(left, top)};
}

}  // namespace

Scene make_jali() {
  Scene scene;
  scene.name = "jali";
  Geometry& geometry = scene.geometry;
  Modeller model(geometry);
  constexpr double k_out = k_side + k_wall;

  // The floor, the ceiling with its beams, the walls at both ends, and the one across from the windows.
  model.paint({0.42f, 0.34f, 0.27f});
  model.box({-k_out, -k_wall, k_far - k_wall}, {k_out, 0.0, k_near + k_wall});
  model.paint({0.5f, 0.42f, 0.34f});
  model.box({-k_out, k_ceiling, k_far - k_wall}, {k_out, k_ceiling + k_wall, k_near + k_wall});
  model.box({-k_out, -k_wall, k_near}, {k_out, k_ceiling + k_wall, k_near + k_wall});
  model.box({-k_out, -k_wall, k_far - k_wall}, {k_out, k_ceiling + k_wall, k_far});
  model.box({-k_out, -k_wall, k_far - k_wall}, {-k_side, k_ceiling + k_wall, k_near + k_wall});
  model.paint({0.3f, 0.2f, 0.13f});
  for (double z = k_far + 0.25 * k_bay; z < k_near; z += 0.25 * k_bay)
    model.box({-k_side - 0.2, k_ceiling - 0.28, z - 0.09}, {k_side + 0.2, k_ceiling + 0.2, z + 0.09});

  // The windows. u × v = w: along the wall to the south, up, into the hall.
  const Plane inner{{k_side, 0.0, 0.0}, {0.0, 0.0, 1.0}, {0.0, 1.0, 0.0}, {-1.0, 0.0, 0.0}};
  std::vector<Opening> windows;
  for (int i = 0; i < k_bays; ++i) windows.push_back({k_far + (i + 0.5) * k_bay, 1.62, 0.55, 3.0});
  model.paint({0.55f, 0.46f, 0.37f});
  pierced_wall(
      model,
      {inner, k_far - 0.5 * k_wall, k_near + 0.5 * k_wall, -k_wall, k_ceiling + 0.4, k_wall, -0.2, 0.12},
      windows);

  // Half-columns between the windows, on both sides, and benches along the other wall.
  model.paint({0.58f, 0.5f, 0.41f});
  constexpr auto k_profile = std::to_array<glm::dvec2>({{0.34, -0.1},
                                                        {0.34, 0.3},
                                                        {0.27, 0.42},
                                                        {0.2, 0.7},
                                                        {0.17, 3.9},
                                                        {0.22, 4.05},
                                                        {0.22, 4.2},
                                                        {0.3, 4.5},
                                                        {0.34, 4.9},
                                                        {0.34, k_ceiling + 0.1}});
  for (int i = 0; i <= k_bays; ++i)
    for (const double hand : {1.0, -1.0})
      model.turned({hand * k_side, 0.0, k_far + i * k_bay}, k_profile, 24);
  model.paint({0.4f, 0.32f, 0.25f});
  for (int i = 0; i < k_bays; ++i) {
    const double z = k_far + (i + 0.5) * k_bay;
    model.box({-k_side - 0.2, -0.1, z - 1.5}, {-k_side + 0.55, 0.45, z + 1.5});
  }

  // The screens.
  geometry.textures.push_back(pierced_marble());
  geometry.materials.push_back({.albedo = glm::vec3(1.0f), .texture = 0u, .cut_out = CutOut{0u, 0.5f}});
  for (const Opening& o : windows) add_screen(model, geometry, inner, o, 6.0);

  scene.cameras.push_back({"gallery", {-2.5, 1.7, 6.3}, {1.0, 2.5, -10.0}, {0.0, 1.0, 0.0}, 62.0});
  scene.lights.push_back(
      sun("sun", direction_of_angles({114.0, 31.0}), glm::vec3(1.0f, 0.8f, 0.53f) * 130.0f));
  scene.medium.sigma_s = glm::vec3(0.02f);
  scene.medium.phase = PhaseFunction::henyey_greenstein;
  scene.medium.g = 0.5f;
  scene.surroundings = {.ambient = {0.16f, 0.17f, 0.2f}, .background = {1.6f, 2.2f, 3.2f}};
  scene.exposure = 0.55f;
  scene.tone_map = ToneMap::agx;
  return scene;
}

}  // namespace airlight::scene
