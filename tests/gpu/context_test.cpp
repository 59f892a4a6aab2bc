#include "gpu/context.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "gpu/buffer.h"
#include "gpu/texture.h"
#include "scene/error.h"
#include "support/gpu_context.h"

#include <epoxy/gl.h>

namespace airlight::gpu {
namespace {

using testing::HasSubstr;
using tests::gpu_context;

TEST(Context, KnowsItsDeviceAndAllowsWhatOpenGl45Must) {
  const Context& context = gpu_context();
  EXPECT_FALSE(context.device().renderer.empty());
  EXPECT_FALSE(context.device().version.empty());
  // The smallest limits that the OpenGL 4.5 specification lets a driver have (tables 23.53 to 23.64).
  EXPECT_GE(context.limits().max_storage_block_bytes, std::int64_t{1} << 24);
  EXPECT_GE(context.limits().max_texel_buffer_texels, 65536);
  EXPECT_GE(context.limits().max_texture_size, 16384);
  EXPECT_GE(context.limits().max_array_layers, 2048);
  EXPECT_GE(context.limits().max_work_group_invocations, 1024);
  EXPECT_GT(context.limits().max_viewport, 0);
}

TEST(Context, AGlMistakeBecomesAnErrorOnce) {
  Context& context = gpu_context();
  EXPECT_NO_THROW(context.check());
  glBindBuffer(GL_TEXTURE_2D, 0);  // not a buffer target
  try {
    context.check();
    FAIL() << "the mistake went unseen";
  } catch (const scene::Error& error) {
    EXPECT_EQ(error.exit_code, scene::ExitCode::driver);
    EXPECT_THAT(error.what(), HasSubstr(context.device().renderer));
    EXPECT_THAT(error.what(), HasSubstr("glBindBuffer"));
  }
  EXPECT_NO_THROW(context.check());
}

TEST(Context, ABufferOverTheLimitIsAnErrorThatNamesIt) {
  Limits limits = gpu_context().limits();
  limits.max_storage_block_bytes = 1 << 20;
  EXPECT_NO_THROW(require_storage_block(limits, 1 << 20, "the thing", "make it smaller"));
  try {
    require_storage_block(limits, (1 << 20) + 1, "the thing", "make it smaller");
    FAIL();
  } catch (const scene::Error& error) {
    EXPECT_EQ(error.exit_code, scene::ExitCode::driver);
    EXPECT_THAT(error.what(), HasSubstr("the thing"));
    EXPECT_THAT(error.what(), HasSubstr("GL_MAX_SHADER_STORAGE_BLOCK_SIZE"));
    EXPECT_THAT(error.what(), HasSubstr("make it smaller"));
  }
}

TEST(Buffer, KeepsWhatIsWritten) {
  Context& context = gpu_context();
  const std::vector<std::uint32_t> values = {1, 2, 3, 0xffffffffu};
  const Buffer buffer = Buffer::from(std::span<const std::uint32_t>(values));
  EXPECT_EQ(buffer.bytes(), 16);
  EXPECT_EQ(buffer.read<std::uint32_t>(), values);
  buffer.clear();
  EXPECT_EQ(buffer.read<std::uint32_t>(), std::vector<std::uint32_t>(4, 0));
  EXPECT_EQ(Buffer(12).read<std::uint32_t>(), std::vector<std::uint32_t>(3, 0)) << "new storage is zero";
  EXPECT_TRUE(Buffer(0).read<std::uint32_t>().empty());
  context.check();
}

TEST(Texture, KeepsItsRowsInOrder) {
  Context& context = gpu_context();
  const Texture texture(Format::rgba32f, {3, 2});
  std::vector<glm::vec4> values;
  for (int i = 0; i < 6; ++i) values.emplace_back(i, 10 * i, -i, 1e30f);
  texture.write(values.data());
  EXPECT_EQ(texture.read<glm::vec4>(), values);
  EXPECT_EQ(texture.bytes(), 96);
  context.check();
}

}  // namespace
}  // namespace airlight::gpu
