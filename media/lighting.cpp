#include "media/lighting.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "epipolar/space.h"

namespace airlight::media {
namespace {

constexpr float k_narrowest_lobe = 0.995f;

bool lies_above(const scene::Medium& medium, const glm::dvec3& point) {
  return medium.top && point.y > *medium.top;
}

}  // namespace

std::uint32_t layer_of(const scene::Medium& medium, const scene::Light& light, const glm::dvec3& eye) {
  if (!medium.top) return shaders::k_no_layer;
  const bool is_entered =
      !scene::is_sun(light) && (lies_above(medium, eye) || lies_above(medium, light.position));
  return is_entered ? shaders::k_layer_entered : shaders::k_layer_around;
}

std::uint32_t reach_of(const scene::Light& light) {
  return (light.cone ? shaders::k_reach_of_cone : 0) | (light.range ? shaders::k_reach_of_range : 0);
}

bool is_rough(const frame::FrameInputs& inputs, std::uint32_t layer) {
  constexpr float k_wide_lobe = 0.8f, k_deep = 8.0f;
  const scene::View& view = inputs.view;
  double reach = glm::distance(inputs.light().position, view.camera.eye);
  if (layer == shaders::k_layer_entered && !inputs.scene.box().empty())
    reach = std::min(reach, scene::reach_from(view.camera.eye, inputs.scene.box()));
  const glm::vec3 depth = (view.medium.sigma_s + view.medium.sigma_a) * static_cast<float>(reach);
  return std::abs(view.medium.g) > k_wide_lobe || std::max({depth.x, depth.y, depth.z}) > k_deep;
}

shaders::EpipolarBlock gridless_space(const scene::View& view, const scene::Light& light) {
  return epipolar::epipolar_block(view, light, {}, epipolar::Ranges::full, epipolar::ThetaCells::equal);
}

std::optional<frame::Refusal> narrow_lobe(const scene::Medium& medium) {
  if (!scene::has_g(medium.phase) || std::abs(medium.g) <= k_narrowest_lobe) return {};
  return frame::Refusal{{},
                        fmt::format("it cannot follow the lobe of g = {:g}: the limit is |g| = {:g}",
                                    medium.g, k_narrowest_lobe),
                        "use a g nearer to 0, or the method reference"};
}

}  // namespace airlight::media
