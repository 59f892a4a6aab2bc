#include "media/medium.h"

namespace airlight::media {

static_assert(static_cast<unsigned>(scene::PhaseFunction::isotropic) == shaders::k_isotropic);
static_assert(static_cast<unsigned>(scene::PhaseFunction::rayleigh) == shaders::k_rayleigh);
static_assert(static_cast<unsigned>(scene::PhaseFunction::henyey_greenstein) == shaders::k_henyey_greenstein);
static_assert(static_cast<unsigned>(scene::PhaseFunction::hoffman_preetham) == shaders::k_hoffman_preetham);

shaders::MediumBlock medium_block(const scene::View& view) {
  shaders::MediumBlock block{};
  block.sigma_s = view.medium.sigma_s;
  block.g = view.medium.g;
  block.sigma_t = view.medium.sigma_s + view.medium.sigma_a;
  block.intensity = view.lights[0].intensity;
  block.rayleigh_weight = view.medium.rayleigh_weight;
  return block;
}

}  // namespace airlight::media
