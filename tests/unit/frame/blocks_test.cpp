#include "frame/blocks.h"

#include <gtest/gtest.h>

namespace airlight::frame {
namespace {

TEST(MediumBlock, ExtinctionIsScatteringPlusAbsorption) {
  const scene::Medium medium = {.sigma_s = {0.1f, 0.2f, 0.3f},
                                .sigma_a = {0.5f, 0.0f, 0.25f},
                                .phase = scene::PhaseFunction::henyey_greenstein,
                                .g = 0.4f,
                                .rayleigh_weight = 0.3f};
  const shaders::MediumBlock block = medium_block(medium, {1.0, 2.0, 3.0});
  EXPECT_EQ(block.sigma_s, medium.sigma_s);
  EXPECT_EQ(block.sigma_t, medium.sigma_s + medium.sigma_a);
  EXPECT_EQ(block.g, 0.4f);
  EXPECT_EQ(block.rayleigh_weight, 0.3f);
}

}  // namespace
}  // namespace airlight::frame
