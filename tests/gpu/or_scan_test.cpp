#include "epipolar/or_scan.h"

#include <gtest/gtest.h>

#include "epipolar/mip_scan.h"
#include "support/gpu_context.h"
#include "support/random.h"

namespace airlight::epipolar {
namespace {

class OrScanOf : public testing::TestWithParam<Resolution> {};

TEST_P(OrScanOf, RandomBitsEqualsTheScanOnTheCpu) {
  const Resolution n = GetParam();
  gpu::Context& context = tests::gpu_context();
  const Grid grid(context.limits(), n);
  tests::Random random(1);
  std::vector<std::uint32_t> bits(static_cast<std::size_t>(grid.bits().bytes()) / 4);
  for (std::uint32_t& word : bits)
    word = random.bits() & random.bits() & random.bits() & random.bits() & random.bits();
  const std::vector<std::uint32_t> unscanned = bits;
  grid.bind();
  const auto words = static_cast<std::size_t>(n.phi / 32), alphas = static_cast<std::size_t>(n.alpha);
  for (std::size_t j = 0; j < static_cast<std::size_t>(n.theta); ++j) {
    for (std::size_t i = 1; i < alphas; ++i) {
      for (std::size_t word = 0; word < words; ++word) {
        bits[(j * alphas + i) * words + word] |= bits[(j * alphas + i - 1) * words + word];
      }
    }
  }
  grid.bits().write(unscanned.data(), grid.bits().bytes());
  OrScan(n).run(grid);
  EXPECT_EQ(grid.bits().read<std::uint32_t>(), bits);
  grid.bits().write(unscanned.data(), grid.bits().bytes());
  MipScan(context.limits(), grid).run(grid);
  EXPECT_EQ(grid.bits().read<std::uint32_t>(), bits);
  context.check();
}

INSTANTIATE_TEST_SUITE_P(Resolutions, OrScanOf,
                         testing::Values(Resolution{1, 1, 128}, Resolution{64, 64, 128},
                                         Resolution{33, 17, 640}, Resolution{3, 5, 256},
                                         Resolution{5, 2, 128}, Resolution{257, 129, 512}));

}  // namespace
}  // namespace airlight::epipolar
