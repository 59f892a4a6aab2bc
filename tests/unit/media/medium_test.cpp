#include "media/medium.h"

#include <gtest/gtest.h>

namespace airlight::media {
namespace {

TEST(MediumBlock, ExtinctionIsScatteringPlusAbsorption) {
  scene::View view;
  view.medium = {.sigma_s = {0.1f, 0.2f, 0.3f},
                 .sigma_a = {0.5f, 0.0f, 0.25f},
                 .phase = scene::PhaseFunction::henyey_greenstein,
                 .g = 0.4f,
                 .rayleigh_weight = 0.3f};
  view.lights[0].intensity = {7, 8, 9};
  const shaders::MediumBlock block = medium_block(view);
  EXPECT_EQ(block.sigma_s, view.medium.sigma_s);
  EXPECT_EQ(block.sigma_t, view.medium.sigma_s + view.medium.sigma_a);
  EXPECT_EQ(block.intensity, view.lights[0].intensity);
  EXPECT_EQ(block.g, 0.4f);
  EXPECT_EQ(block.rayleigh_weight, 0.3f);
}

}  // namespace
}  // namespace airlight::media
