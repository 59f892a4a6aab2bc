#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "reference/fog_quadrature.h"
#include "reference/hierarchy.h"
#include "reference/reference.h"
#include "reference/run_integrals.h"
#include "reference/shadow_intervals.h"
#include "reference/state.h"
#include "scene/parallel.h"

// The airlight without sampling: which part of each view ray is lit follows from the triangles
// (shadow_intervals.h), and lit runs are integrated by Gauss–Legendre quadrature (fog_quadrature.h), a sun's
// in closed form (sun_fog.h).
//
// Neighbouring rays share most of their occluders. So the rays of a tile of pixels look for them together:
// one descent of the hierarchy lists what reaches into the space between the light and the rays, and each ray
// goes through the list.

namespace airlight::reference {

namespace {

/// A tile of more occluders than this is split: each of its rays goes through all of them, and they need
/// memory.
constexpr std::size_t k_most_occluders = 65536;
/// How far off a pixel may be, relative to itself: the quadrature, and rounding to single precision.
constexpr double k_rounding = 6e-8;

/// Pixels of the image: [`from`, `to`).
struct Tile {
  glm::ivec2 from, to;
};

/// Cuts a region to the convex hull of a light and a cone of view rays: it is bounded by those sides of the
/// cone that have the light inside, and by the planes through eye and light that touch the cone.
/// @param eye   the cone's apex [m]
/// @param light as seen from the eye, at any distance
/// @param edges of the cone, in their order around it
void cut_to_hull(const glm::dvec3& eye, const glm::dvec3& light, const std::array<glm::dvec3, 4>& edges,
                 Region& region) {
  const glm::dvec3 middle = edges[0] + edges[1] + edges[2] + edges[3];
  for (std::size_t i = 0; i < 4; ++i) {
    const glm::dvec3 side = glm::cross(edges[i], edges[(i + 1) % 4]);
    const glm::dvec3 inward = glm::dot(side, middle) < 0.0 ? -side : side;
    if (glm::dot(inward, light) >= 0.0) region.cut({inward, eye});
  }
  for (std::size_t i = 0; i < 4; ++i) {
    const glm::dvec3 touching = glm::cross(light, edges[i]);
    double least = 0.0, most = 0.0;
    for (std::size_t other = 1; other < 4; ++other) {
      const double distance = glm::dot(touching, edges[(i + other) % 4]);
      least = std::min(least, distance);
      most = std::max(most, distance);
    }
    if (least == 0.0) region.cut({touching, eye});
    if (most == 0.0) region.cut({-touching, eye});
  }
}

/// What a worker adds to the image's totals.
struct Sums {
  double radiance = 0.0;  ///< over all channels
  double squared_radiance = 0.0;
  std::uint64_t shadows = 0;
  std::uint64_t lit_runs = 0;
  std::uint64_t pixels = 0;

  void operator+=(const Sums& other) {
    radiance += other.radiance;
    squared_radiance += other.squared_radiance;
    shadows += other.shadows;
    lit_runs += other.lit_runs;
    pixels += other.pixels;
  }
};

}  // namespace

/// Integrates the view rays of tiles. Keeps its memory from tile to tile.
template <class Ray>
class Reference::TileIntegrator {
 public:
  TileIntegrator(const State& state, const Hierarchy& hierarchy, int refinement, AirlightImage& image)
      : state_(state),
        hierarchy_(hierarchy),
        image_(image),
        integrals_(state.run_integrals(refinement)),
        occluders_(state.sun, &state.triangles) {}

  Sums integrate(const Tile& tile) {
    tile_ = tile;
    rays_.clear();
    for (int y = tile.from.y; y < tile.to.y; ++y) {
      for (int x = tile.from.x; x < tile.to.x; ++x) rays_.push_back(state_.ray<Ray>(x, y));
    }
    sums_ = {};
    integrate_part(tile);
    return sums_;
  }

 private:
  const Ray& ray(int x, int y) const {
    return rays_[static_cast<std::size_t>((y - tile_.from.y) * (tile_.to.x - tile_.from.x) + x -
                                          tile_.from.x)];
  }

  /// @param part of the tile whose rays are known
  void integrate_part(const Tile& part) {
    hierarchy_.find(region_of(part), found_);
    const glm::ivec2 size = part.to - part.from;
    if (found_.size() > k_most_occluders && std::max(size.x, size.y) > 1) {
      const glm::ivec2 middle = part.from + (size + 1) / 2;
      integrate_part({part.from, middle});
      if (middle.x < part.to.x) integrate_part({{middle.x, part.from.y}, {part.to.x, middle.y}});
      if (middle.y < part.to.y) integrate_part({{part.from.x, middle.y}, {middle.x, part.to.y}});
      if (middle.x < part.to.x && middle.y < part.to.y) integrate_part({middle, part.to});
      return;
    }
    occluders_.clear();
    for (const std::uint32_t triangle : found_)
      occluders_.add(state_.triangles.around(state_.origin, triangle), triangle);
    for (int y = part.from.y; y < part.to.y; ++y) {
      for (int x = part.from.x; x < part.to.x; ++x) integrate_pixel(x, y);
    }
  }

  static glm::dvec3 end(const ViewRay& ray, const glm::dvec3& eye) { return ray.end(eye); }
  static glm::dvec3 end(const SunRay& ray, const glm::dvec3&) { return ray.end(); }

  /// All that can cast a shadow on the rays of these pixels.
  Region region_of(const Tile& part) const {
    const glm::dvec3 light = state_.sun ? far_end(glm::dvec3(0.0), *state_.sun) : glm::dvec3(0.0);
    Region region{.box = {glm::min(state_.eye, light), glm::max(state_.eye, light)}, .half_spaces = {}};
    for (int y = part.from.y; y < part.to.y; ++y) {
      for (int x = part.from.x; x < part.to.x; ++x) {
        const glm::dvec3 last = end(ray(x, y), state_.eye);
        region.box.lower = glm::min(region.box.lower, last);
        region.box.upper = glm::max(region.box.upper, last);
      }
    }
    // Half a pixel more than the pixels themselves: a ray nearly at the light is moved (light_plane.h).
    const glm::dvec2 from = glm::dvec2(part.from) - 0.5, to = glm::dvec2(part.to) + 0.5;
    cut_to_hull(state_.eye, state_.sun.value_or(-state_.eye),
                {state_.direction(from), state_.direction({to.x, from.y}), state_.direction(to),
                 state_.direction({from.x, to.y})},
                region);
    return region;
  }

  void integrate_pixel(int x, int y) {
    const Ray& view_ray = ray(x, y);
    shadows_.trace(view_ray, occluders_);
    const auto [radiance] = integrals_.template radiances<1>(view_ray, [&](const auto& add) {
      for (const ShadowIntervals::Run& run : shadows_.lit_runs()) add(0, run.from, run.to, run.share);
    });
    image_.radiance[state_.index(x, y)] = glm::vec3(radiance);
    sums_.radiance += radiance.r + radiance.g + radiance.b;
    sums_.squared_radiance += glm::dot(radiance, radiance);
    sums_.shadows += shadows_.count();
    sums_.lit_runs += shadows_.lit_runs().size();
    ++sums_.pixels;
  }

  const State& state_;
  const Hierarchy& hierarchy_;
  AirlightImage& image_;
  RunIntegrals integrals_;
  Tile tile_{};
  std::vector<Ray> rays_;  ///< of the tile's pixels, row by row
  std::vector<std::uint32_t> found_;
  Occluders occluders_;
  ShadowIntervals shadows_;
  Sums sums_;
};

AirlightImage Reference::exact(int refinement, const Progress& progress) const {
  const glm::ivec2 count = (state_->view.size + k_tile - 1) / k_tile;
  std::vector<glm::ivec2> tiles;
  for (int row = 0; row < count.y; ++row)
    for (int column = 0; column < count.x; ++column) tiles.emplace_back(column, row);
  return exact_in(tiles, refinement, progress);
}

AirlightImage Reference::exact_in(std::span<const glm::ivec2> tiles, int refinement,
                                  const Progress& progress) const {
  return state_->sun ? exact_along<SunRay>(tiles, refinement, progress)
                     : exact_along<ViewRay>(tiles, refinement, progress);
}

template <class Ray>
AirlightImage Reference::exact_along(std::span<const glm::ivec2> tiles, int refinement,
                                     const Progress& progress) const {
  const State& state = *state_;
  AirlightImage image;
  image.radiance.resize(state.pixels());
  std::vector<Sums> sums(tiles.size());
  const auto start = std::chrono::steady_clock::now();
  const Hierarchy hierarchy(state.triangles, state.origin);

  const auto make_worker = [&] {
    return [&, integrator = TileIntegrator<Ray>(state, hierarchy, refinement, image)](int i) mutable {
      const auto tile = static_cast<std::size_t>(i);
      const glm::ivec2 from = k_tile * tiles[tile];
      sums[tile] = integrator.integrate({from, glm::min(from + k_tile, state.view.size)});
    };
  };
  scene::parallel(static_cast<int>(tiles.size()), make_worker, progress);

  image.ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  Sums total;
  for (const Sums& of_tile : sums) total += of_tile;
  const auto pixels = static_cast<double>(total.pixels);
  if (total.radiance > 0.0)
    image.bound = (k_rounding + (state.sun ? 0.0 : FogQuadrature::k_error)) *
                  std::sqrt(total.squared_radiance / (3.0 * pixels)) / (total.radiance / (3.0 * pixels));
  image.shadows_per_pixel = static_cast<double>(total.shadows) / pixels;
  image.lit_runs_per_pixel = static_cast<double>(total.lit_runs) / pixels;
  return image;
}

}  // namespace airlight::reference
