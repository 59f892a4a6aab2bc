#include "epipolar/fused_scan.h"

#include <algorithm>
#include <ostream>

#include <gtest/gtest.h>

#include "epipolar/surface_lookup.h"
#include "frame/none.h"
#include "support/grid_bits.h"
#include "support/open_room.h"
#include "support/random.h"
#include "support/render.h"

/// The scan of first shadowed cells, as a whole and by blocks, and what reads them.
namespace airlight::epipolar {
namespace {

/// First shadowed cells, 128 at a time, of every sort of block.
std::vector<std::uint32_t> first_shadowed_cells(const Resolution& n, tests::Random& random) {
  const auto alphas = static_cast<std::uint32_t>(n.alpha);
  std::vector<std::uint32_t> first;
  for (int block = 0; block < n.theta * n.phi / 128; ++block) {
    const std::uint32_t at = random.bits() % (alphas + 1);
    const std::uint32_t room = std::min(alphas - at, 1u + random.bits() % 20);
    for (int ray = 0; ray < 128; ++ray) {
      switch (block % 6) {
        case 0:  // wholly lit
          first.push_back(alphas);
          break;
        case 1:  // wholly dark
          first.push_back(0);
          break;
        case 2:  // dark at once
          first.push_back(at);
          break;
        case 3:  // by and by
          first.push_back(at + random.bits() % (room + 1));
          break;
        case 4:  // in part never
          first.push_back(random.bits() % 2 == 0 ? alphas : at);
          break;
        default:
          first.push_back(random.bits() % (alphas + 1));
      }
    }
  }
  return first;
}

class FusedScanOf : public testing::TestWithParam<Resolution> {};

TEST_P(FusedScanOf, AnyLightRaysComparesThemWithEachRow) {
  const Resolution n = GetParam();
  gpu::Context& context = tests::gpu_context();
  const Grid grid(context.limits(), n);
  tests::Random random(1);
  const std::vector<std::uint32_t> first = first_shadowed_cells(n, random);
  grid.first_shadowed().write(first.data(), grid.first_shadowed().bytes());
  const auto alphas = static_cast<std::size_t>(n.alpha), phis = static_cast<std::size_t>(n.phi);
  std::vector<std::uint32_t> expected(static_cast<std::size_t>(grid.bits().bytes()) / 4);
  for (std::size_t ray = 0; ray < first.size(); ++ray) {
    for (std::size_t i = first[ray]; i < alphas; ++i) {
      const std::size_t bit = (ray / phis * alphas + i) * phis + ray % phis;
      expected[bit / 32] |= 1u << bit % 32;
    }
  }
  grid.bind();
  for (const bool by_blocks : {false, true}) {
    grid.bits().clear(tests::k_rubbish);
    const FusedScan scan(context.limits(), n, by_blocks);
    scan.bind();
    scan.run(grid);
    EXPECT_TRUE(scan.bits(grid) == expected) << (by_blocks ? "by blocks" : "as a whole");
    if (!by_blocks) continue;

    // No row of a block is written but those between, of which its first and last are alike in all rays.
    std::int64_t written = 0;
    const std::vector<std::uint32_t> words = grid.bits().read<std::uint32_t>();
    for (std::size_t word = 0; word < words.size(); word += 4) {
      const std::size_t i = word / (phis / 32) % alphas, j = word / (phis / 32) / alphas;
      const auto rays = first.begin() + static_cast<std::ptrdiff_t>(j * phis + word % (phis / 32) * 32);
      const auto [least, largest] = std::minmax_element(rays, rays + 128);
      const bool is_stored = i + 1 >= *least && i <= *largest;
      written += is_stored ? 16 : 0;
      ASSERT_EQ(words[word] == tests::k_rubbish, !is_stored) << "row " << i << " of plane " << j;
    }
    EXPECT_EQ(scan.written_bytes(grid), written);
  }
  context.check();
}

INSTANTIATE_TEST_SUITE_P(Resolutions, FusedScanOf,
                         testing::Values(Resolution{1, 7, 128}, Resolution{8, 12, 256},
                                         Resolution{13, 25, 384}, Resolution{257, 31, 512},
                                         Resolution{k_most_block_alpha, 6, 128}));

struct Case {
  const char* name;
  scene::View view;
  Populate populate = Populate::shadow_map;
  media::VsvIntegral integral = media::VsvIntegral::automatic;
  bool has_plates = false;
  frame::ViewRays rays = {};
};
void PrintTo(const Case& of, std::ostream* stream) {
  *stream << of.name;
}

std::vector<Case> cases() {
  using enum media::VsvIntegral;
  const scene::View in_view = tests::open_room_with_lamp_at({0.3, 0.5, -0.2});
  const scene::View aside = tests::open_room_with_lamp_at({4, 3, 1});
  const scene::View behind = tests::open_room_with_lamp_at({0.4, 0.9, 4});
  const scene::View sun = tests::open_room_lit_by(scene::sun("", {0.5, 1, 0.3}, glm::vec3(5)));
  constexpr auto k_map = Populate::shadow_map;
  return {{"table", in_view, k_map, table},
          {"quadrature", in_view, k_map, quadrature},
          {"riemann", aside, k_map, riemann},
          {"factored", in_view, k_map, factored},
          {"sun", sun},
          {"sun_riemann", sun, k_map, riemann},
          {"sun_factored", sun, k_map, factored},
          {"conservative", aside, Populate::conservative},
          {"conservative_sun", sun, Populate::conservative},
          {"plates", behind, k_map, quadrature, true},
          {"plates_conservative", behind, Populate::conservative, table, true},
          {"quarter", in_view, k_map, automatic, false, {.where = frame::Where::quarter}},
          {"epipolar",
           aside,
           k_map,
           automatic,
           false,
           {.where = frame::Where::epipolar, .slices = 64, .samples = 64}}};
}

frame::FrameImages render(const Case& of, Scan scan) {
  // N_α is no multiple of the eight rows that are made at a time.
  const VolumeOptions volume{.resolution = {77, 96, 256}, .populate = of.populate, .scan = scan};
  media::Vsv vsv(tests::gpu_context(), {.integral = of.integral, .rays = of.rays, .volume = volume});
  SurfaceLookup lookup(tests::gpu_context(), volume);
  const scene::Geometry geometry = tests::open_room(of.has_plates);
  frame::Frame frame(tests::gpu_context(), geometry, 256);
  gpu::StageTimer timer(nullptr);
  vsv.volume().grid().bits().clear(tests::k_rubbish);
  lookup.volume().grid().bits().clear(tests::k_rubbish);
  frame.render(of.view, lookup, vsv, timer);
  return frame.read();
}

class ScanByBlocks : public testing::TestWithParam<Case> {};

TEST_P(ScanByBlocks, GivesTheImageOfTheWholeGrid) {
  const frame::FrameImages whole = render(GetParam(), Scan::fused);
  const frame::FrameImages blocks = render(GetParam(), Scan::blocks);
  EXPECT_TRUE(blocks.airlight == whole.airlight);
  EXPECT_TRUE(blocks.visibility == whole.visibility);
  // There is shadow in it.
  const frame::FrameImages unshadowed = tests::render_vsv({}, GetParam().view);
  EXPECT_GT(tests::error_of(unshadowed.airlight, whole.airlight).rrmse, 0.02);
}

INSTANTIATE_TEST_SUITE_P(Cases, ScanByBlocks, testing::ValuesIn(cases()),
                         [](const auto& of) { return of.param.name; });

}  // namespace
}  // namespace airlight::epipolar
