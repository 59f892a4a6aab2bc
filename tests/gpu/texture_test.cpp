#include "gpu/texture.h"

#include <array>
#include <cstring>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "gpu/framebuffer.h"
#include "gpu/pipeline.h"
#include "scene/error.h"
#include "support/gpu_context.h"

#include "spirv/shaders/number_texels_comp.h"
#include "spirv/shaders/sample_textures_comp.h"

namespace airlight::gpu {
namespace {

using testing::Each;
using testing::HasSubstr;
using tests::gpu_context;

/// Numbers that every format holds: halves of 16 bits, and depths.
std::vector<float> numbers(std::size_t count) {
  std::vector<float> values;
  for (std::size_t i = 0; i < count; ++i) values.push_back(static_cast<float>(i % 1000) / 1024.0f);
  return values;
}

/// Writes numbers to every level of a texture of `channels`, and reads them back.
template <typename Texel>
void expect_kept(const Texture& texture) {
  for (int level = 0; level < texture.levels(); ++level) {
    const glm::ivec3 size = texture.extent(level);
    std::vector<Texel> texels(static_cast<std::size_t>(size.x * size.y * size.z));
    const std::vector<float> values = numbers(texels.size() * sizeof(Texel) / 4);
    std::memcpy(texels.data(), values.data(), values.size() * 4);
    texture.write(texels.data(), level);
    EXPECT_EQ(texture.read<Texel>(level), texels) << "level " << level;
  }
  gpu_context().check();
}

TEST(Texture, OfAnyFormatKeepsWhatIsWritten) {
  const glm::ivec2 size(5, 3);
  expect_kept<float>(Texture(Format::r16f, size));
  expect_kept<glm::vec2>(Texture(Format::rg16f, size));
  expect_kept<glm::vec4>(Texture(Format::rgba16f, size));
  expect_kept<float>(Texture(Format::r32f, size));
  expect_kept<glm::vec2>(Texture(Format::rg32f, size));
  expect_kept<glm::vec4>(Texture(Format::rgba32f, size));
  expect_kept<std::uint32_t>(Texture(Format::r32ui, size));
  expect_kept<glm::uvec4>(Texture(Format::rgba32ui, size));
  expect_kept<float>(Texture(Format::depth32f, size));
}

TEST(Texture, OfDepthAndStencilKeepsBoth) {
  const Texture texture(Format::depth32f_stencil8, {3, 2});
  std::vector<DepthStencil> texels;
  for (std::uint32_t i = 0; i < 6; ++i) texels.push_back({static_cast<float>(i) / 8.0f, 40 * i});
  texture.write(texels.data());
  const std::vector<DepthStencil> read = texture.read<DepthStencil>();
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(read[i].depth, texels[i].depth);
    EXPECT_EQ(read[i].stencil & 0xffu, texels[i].stencil);
  }
  gpu_context().check();
}

TEST(Texture, KeepsLayersLevelsAndVolumes) {
  expect_kept<glm::vec4>(Texture(Format::rgba16f, {8, 6}, 3));
  expect_kept<glm::vec2>(Texture(Format::rg32f, {8, 6}, 1, 4));
  expect_kept<float>(Texture(Format::r16f, {8, 6}, 3, 3));
  expect_kept<glm::vec4>(Texture::volume(Format::rgba16f, {8, 6, 4}));
  expect_kept<float>(Texture::volume(Format::r32f, {8, 6, 4}, 4));
}

TEST(Texture, KnowsTheSizeOfItsLevels) {
  const Texture image(Format::rg16f, {8, 5}, 1, 4);
  EXPECT_EQ(image.size(1), glm::ivec2(4, 2));
  EXPECT_EQ(image.size(3), glm::ivec2(1, 1));
  EXPECT_EQ(image.bytes(), 4 * (40 + 8 + 2 + 1));
  const Texture layers(Format::r32f, {8, 5}, 3, 2);
  EXPECT_EQ(layers.extent(1), glm::ivec3(4, 2, 3));
  EXPECT_EQ(layers.layers(), 3);
  EXPECT_EQ(layers.bytes(), 4 * 3 * (40 + 8));
  const Texture volume = Texture::volume(Format::rgba16f, {8, 5, 6}, 2);
  EXPECT_EQ(volume.extent(1), glm::ivec3(4, 2, 3));
  EXPECT_EQ(volume.layers(), 1);
  EXPECT_EQ(volume.bytes(), 8 * (240 + 24));
}

TEST(Texture, ALevelIsAnImageWithAllItsLayers) {
  const Texture volume = Texture::volume(Format::rgba16f, {8, 6, 4}, 2);
  const Texture layers(Format::r32f, {8, 6}, 3, 2);
  volume.bind_image(0, 1);
  layers.bind_image(1, 1);
  Pipeline::compute(k_number_texels_comp).dispatch({8, 6, 4});
  std::size_t at = 0;
  const std::vector<glm::vec4> in_volume = volume.read<glm::vec4>(1);
  const std::vector<float> in_layers = layers.read<float>(1);
  ASSERT_EQ(in_volume.size(), 4u * 3 * 2);
  for (int z = 0; z < 2; ++z)
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < 4; ++x) EXPECT_EQ(in_volume[at++], glm::vec4(x, y, z, 1));
  at = 0;
  for (int z = 0; z < 3; ++z)
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < 4; ++x) EXPECT_EQ(in_layers[at++], static_cast<float>(x + 10 * y + 100 * z));
  gpu_context().check();
}

/// Two levels of an image, of layers and of a volume: texel (x, y, z) of level m holds x + 10 y + 100 z +
/// 1000 m.
class Sampled {
 public:
  Sampled()
      : image_(Format::r32f, {4, 4}, 1, 2),
        layers_(Format::r16f, {4, 4}, 2, 2),
        volume_(Texture::volume(Format::r32f, {4, 4, 4}, 2)),
        seen_(3 * sizeof(glm::vec4)),
        pipeline_(Pipeline::compute(k_sample_textures_comp)) {
    for (const Texture* texture : all()) {
      for (int level = 0; level < 2; ++level) {
        const glm::ivec3 size = texture->extent(level);
        std::vector<float> texels;
        for (int z = 0; z < size.z; ++z)
          for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x)
              texels.push_back(static_cast<float>(x + 10 * y + 100 * z + 1000 * level));
        texture->write(texels.data(), level);
      }
    }
  }

  std::array<const Texture*, 3> all() const { return {&image_, &layers_, &volume_}; }

  /// What the image, its second layer and the volume show.
  std::array<float, 3> at(glm::uvec3 sixteenths, std::uint32_t half_levels) const {
    for (unsigned unit = 0; unit < 3; ++unit) all()[unit]->bind_sampler(unit);
    seen_.bind_storage(0);
    pipeline_.set(0, glm::uvec4(sixteenths, half_levels));
    pipeline_.dispatch({1, 1, 1});
    const std::vector<glm::vec4> seen = seen_.read<glm::vec4>();
    gpu_context().check();
    return {seen[0].r, seen[1].r, seen[2].r};
  }

 private:
  Texture image_, layers_, volume_;
  Buffer seen_;
  Pipeline pipeline_;
};

TEST(Texture, IsSampledNearestUnlessToldOtherwise) {
  const Sampled sampled;
  // (5, 9, 13)/16 of four texels lies in (1, 2, 3); of two in (0, 1, 1).
  EXPECT_EQ(sampled.at({5, 9, 13}, 0), (std::array{21.0f, 121.0f, 321.0f}));
  EXPECT_EQ(sampled.at({5, 9, 13}, 2), (std::array{1010.0f, 1110.0f, 1110.0f}));
  EXPECT_EQ(sampled.at({5, 9, 13}, 4), (std::array{1010.0f, 1110.0f, 1110.0f})) << "past the last level";
}

TEST(Texture, IsSampledLinearlyBetweenTexelsAndLevels) {
  const Sampled sampled;
  for (const Texture* texture : sampled.all()) texture->sample_linearly();
  // A texel's centre lies at odd eighths of four texels: (4, 8, 12)/16 is the mean of texels 0 and 1, 1 and
  // 2, 2 and 3.
  EXPECT_EQ(sampled.at({4, 8, 12}, 0), (std::array{15.5f, 115.5f, 265.5f}));
  // Of two texels: (4, 8, 12)/16 is texel 0, the mean of 0 and 1, and texel 1; halfway between the levels.
  const std::array<float, 3> between = sampled.at({4, 8, 12}, 1);
  EXPECT_EQ(between[0], 510.25f);
  EXPECT_NEAR(between[1], 610.25f, 0.25f)
      << "half-precision texels, which NVIDIA's GPUs filter to half precision";
  EXPECT_EQ(between[2], 685.25f);
  EXPECT_EQ(sampled.at({0, 2, 2}, 0)[0], 0.0f) << "clamped";
  sampled.all()[0]->sample_linearly(Wrap::repeat);
  EXPECT_EQ(sampled.at({0, 2, 2}, 0)[0], 1.5f) << "the mean of the first and the last column";
  EXPECT_EQ(sampled.at({2, 0, 2}, 0)[0], 0.0f) << "not over the top";
}

TEST(Framebuffer, ThatIsIncompleteIsAnErrorThatNamesWhy) {
  const auto error_of = [](const std::vector<Attachment>& colours, const std::optional<Attachment>& depth) {
    try {
      const Framebuffer framebuffer(colours, depth);
    } catch (const scene::Error& error) {
      EXPECT_EQ(error.exit_code, scene::ExitCode::driver);
      return std::string(error.what());
    }
    return std::string();
  };
  const Texture colour(Format::rgba32f, {4, 4}), depth(Format::depth32f, {4, 4}),
      layers(Format::r32f, {4, 4}, 2);
  EXPECT_EQ(error_of({colour}, depth), "");
  EXPECT_EQ(error_of({Attachment(layers, 0, 1)}, depth), "");
  EXPECT_THAT(error_of({colour}, colour), HasSubstr("GL_FRAMEBUFFER_INCOMPLETE_ATTACHMENT"));
  EXPECT_THAT(error_of({layers}, depth), HasSubstr("GL_FRAMEBUFFER_INCOMPLETE_LAYER_TARGETS"));
  EXPECT_THAT(error_of({}, {}), HasSubstr("GL_FRAMEBUFFER_INCOMPLETE_MISSING_ATTACHMENT"));
  gpu_context().check();
}

TEST(Framebuffer, ClearsTheLevelAndLayerThatItDrawsInto) {
  const Texture layers(Format::r32f, {4, 4}, 2, 2), bits(Format::r32ui, {2, 2});
  const Texture depth(Format::depth32f_stencil8, {2, 2});
  const std::vector<float> ones(32, 1.0f);
  layers.write(ones.data(), 0);
  layers.write(ones.data(), 1);
  bits.write(ones.data());
  const Framebuffer framebuffer({Attachment(layers, 1, 1), bits}, depth);
  framebuffer.clear(0.25f, 7);
  EXPECT_THAT(layers.read<float>(0), Each(1.0f));
  EXPECT_EQ(layers.read<float>(1), (std::vector<float>{1, 1, 1, 1, 0, 0, 0, 0}));
  EXPECT_THAT(bits.read<std::uint32_t>(), Each(0u));
  for (const DepthStencil& texel : depth.read<DepthStencil>()) {
    EXPECT_EQ(texel.depth, 0.25f);
    EXPECT_EQ(texel.stencil & 0xffu, 7u);
  }
  gpu_context().check();
}

TEST(TexelView, OverTheLimitIsAnErrorThatNamesIt) {
  Limits limits = gpu_context().limits();
  limits.max_texel_buffer_texels = 3;
  EXPECT_NO_THROW(TexelView(limits, Buffer(48), Format::rgba32f, "the thing"));
  try {
    const TexelView view(limits, Buffer(64), Format::rgba32f, "the thing");
    FAIL();
  } catch (const scene::Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("the thing"));
    EXPECT_THAT(error.what(), HasSubstr("GL_MAX_TEXTURE_BUFFER_SIZE"));
  }
}

TEST(Texture, IsCleared) {
  const Texture texture(Format::rgba32f, {2, 3});
  texture.write(std::vector<glm::vec4>(6, glm::vec4(1.0f)).data());
  texture.clear();
  EXPECT_EQ(texture.read<glm::vec4>(), std::vector<glm::vec4>(6, glm::vec4(0.0f)));
}

}  // namespace
}  // namespace airlight::gpu
