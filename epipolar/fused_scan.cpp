#include "epipolar/fused_scan.h"

#include <algorithm>
#include <bit>

#include "epipolar/space_math.h"

#include "spirv/epipolar/fused_scan_comp.h"

namespace airlight::epipolar {
namespace {

gpu::Pipeline load(const Resolution& resolution, bool by_blocks) {
  const auto grid = resolution_constants(resolution);
  const auto digits =
      static_cast<std::uint32_t>(std::bit_width(static_cast<std::uint32_t>(resolution.alpha)));
  return gpu::Pipeline::compute(
      k_fused_scan_comp,
      std::array{grid[0], grid[1], grid[2], gpu::Constant(3, digits), gpu::Constant(4, by_blocks)});
}

}  // namespace

FusedScan::FusedScan(const gpu::Limits& limits, const Resolution& resolution, bool by_blocks)
    : program_(load(resolution, by_blocks)) {
  if (!by_blocks) return;
  // Fewer than the light rays, for which the grid has found room.
  blocks_ = gpu::Buffer(std::int64_t{4} * resolution.theta * (resolution.phi / 128));
  block_texels_ = {limits, blocks_, gpu::Format::r32ui, "the blocks of the grid"};
}

void FusedScan::run(const Grid& grid) const {
  if (blocks_.bytes() == 0) grid.bits().clear();
  dispatch_planes(program_, grid, grid.resolution().phi / 128);
}

void FusedScan::bind() const {
  if (blocks_.bytes() == 0) return;
  blocks_.bind_storage(shaders::k_blocks_storage);
  block_texels_.bind_sampler(shaders::k_blocks_unit);
}

std::vector<std::uint32_t> FusedScan::bits(const Grid& grid) const {
  std::vector<std::uint32_t> bits = grid.bits().read<std::uint32_t>();
  if (blocks_.bytes() == 0) return bits;
  const auto alphas = static_cast<std::uint32_t>(grid.resolution().alpha);
  const auto per_ray = static_cast<std::size_t>(grid.resolution().phi / 128);
  const std::vector<std::uint32_t> blocks = blocks_.read<std::uint32_t>();
  for (std::size_t block = 0; block < blocks.size(); ++block) {
    const auto texel = [&](std::uint32_t row) {
      return bits.begin() +
             static_cast<std::ptrdiff_t>(4 * ((block / per_ray * alphas + row) * per_ray + block % per_ray));
    };
    const std::uint32_t first = blocks[block] & 0xffffu, last = blocks[block] >> 16;
    for (std::uint32_t row = 0; row < first; ++row) std::copy_n(texel(first), 4, texel(row));
    for (std::uint32_t row = last + 1; row < alphas; ++row) std::copy_n(texel(last), 4, texel(row));
  }
  return bits;
}

std::int64_t FusedScan::written_bytes(const Grid& grid) const {
  constexpr std::int64_t k_texel = 16;  // bytes
  std::int64_t texels = 0;
  if (blocks_.bytes() > 0) {
    for (const std::uint32_t rows : blocks_.read<std::uint32_t>())
      texels += 1 + (rows >> 16) - (rows & 0xffffu);
  } else {
    texels = grid.bits().bytes() / k_texel;  // cleared
    const std::vector<std::uint32_t> first = grid.first_shadowed().read<std::uint32_t>();
    for (auto ray = first.begin(); ray != first.end(); ray += 128)
      texels += grid.resolution().alpha - static_cast<int>(*std::min_element(ray, ray + 128) & ~7u);
  }
  return k_texel * texels;
}

}  // namespace airlight::epipolar
