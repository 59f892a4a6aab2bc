#include "gpu/context.h"

#include <array>
#include <latch>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "gpu/buffer.h"
#include "gpu/pipeline.h"
#include "scene/error.h"
#include "support/gpu_context.h"

#include "spirv/shaders/count_groups_comp.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>

namespace airlight::gpu {
namespace {

using testing::HasSubstr;
using testing::Not;
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
  EXPECT_GE(context.limits().max_work_groups.x, 65535u);
  EXPECT_GE(context.limits().max_work_groups.y, 65535u);
  EXPECT_GE(context.limits().max_work_groups.z, 65535u);
  EXPECT_GT(context.limits().max_viewport, 0);
  EXPECT_GE(context.limits().max_volume_size, 2048);  // OpenGL 4.5 guarantees that
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
    EXPECT_THAT(error.what(), HasSubstr("GL_INVALID_ENUM"));
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

TEST(Context, TellsSoftwareDriversByTheirNames) {
  for (const char* software :
       {"llvmpipe (LLVM 15.0.6, 256 bits)", "softpipe", "zink (llvmpipe (LLVM 15.0.6, 256 bits))",
        "ANGLE (Google, Vulkan 1.3.0 (SwiftShader Device (LLVM 10.0.0)), SwiftShader driver)", "lavapipe"})
    EXPECT_TRUE(is_software_renderer(software)) << software;
  for (const char* hardware :
       {"NVIDIA H100/PCIe/SSE2", "Mesa Intel(R) Xe Graphics (TGL GT2)",
        "AMD Radeon RX 6800 (radeonsi, navi21, LLVM 15.0.7, DRM 3.54)", "zink (AMD RADV NAVI21)"})
    EXPECT_FALSE(is_software_renderer(hardware)) << hardware;
}

/// A context that EGL makes, as a window's library would; the program's own is current again afterwards.
class ForeignContext {
 public:
  explicit ForeignContext(EGLenum api)
      : own_display_(eglGetCurrentDisplay()),
        own_context_(eglGetCurrentContext()),
        display_(eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr)) {
    const EGLint config_attributes[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, EGL_DONT_CARE,
                                        EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (!eglInitialize(display_, nullptr, nullptr) || !eglBindAPI(api) ||
        !eglChooseConfig(display_, config_attributes, &config, 1, &count))
      return;
    const EGLint of_gl[] = {EGL_CONTEXT_MAJOR_VERSION,
                            4,
                            EGL_CONTEXT_MINOR_VERSION,
                            5,
                            EGL_CONTEXT_OPENGL_DEBUG,
                            EGL_TRUE,
                            EGL_NONE};
    const EGLint of_gles[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_NONE};
    context_ = eglCreateContext(display_, config, EGL_NO_CONTEXT, api == EGL_OPENGL_API ? of_gl : of_gles);
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_);
  }
  ~ForeignContext() {
    eglBindAPI(EGL_OPENGL_API);
    eglMakeCurrent(own_display_, EGL_NO_SURFACE, EGL_NO_SURFACE, own_context_);
    eglDestroyContext(display_, context_);
  }

  bool is_current() const { return context_ != EGL_NO_CONTEXT && eglGetCurrentContext() == context_; }

 private:
  EGLDisplay own_display_;
  EGLContext own_context_;
  EGLDisplay display_;
  EGLContext context_ = EGL_NO_CONTEXT;
};

TEST(Context, ThatIsAdoptedRunsShadersAndIsLeftToItsOwner) {
  if (!epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless"))
    GTEST_SKIP() << "EGL makes no context without a window here";
  gpu_context();
  const ForeignContext foreign(EGL_OPENGL_API);
  ASSERT_TRUE(foreign.is_current());
  {
    Context context = Context::adopt_current();
    EXPECT_EQ(context.device().renderer, gpu_context().device().renderer);
    EXPECT_EQ(context.limits().max_texture_size, gpu_context().limits().max_texture_size);
    EXPECT_FALSE(glIsEnabled(GL_DEBUG_OUTPUT_SYNCHRONOUS));
    const Buffer counts(32);
    counts.bind_storage(0);
    Pipeline::compute(k_count_groups_comp, std::array{Constant(0, 4)}).dispatch({8, 6, 1});
    EXPECT_EQ(counts.read<std::uint32_t>().at(0), 2u);
    EXPECT_EQ(counts.read<std::uint32_t>().at(1), 3u);
    EXPECT_NO_THROW(context.finish());
    glBindBuffer(GL_TEXTURE_2D, 0);  // not a buffer target
    EXPECT_THROW(context.finish(), scene::Error);
    EXPECT_NO_THROW(context.finish());
  }
  EXPECT_TRUE(foreign.is_current());
  GLvoid* callback = nullptr;
  glGetPointerv(GL_DEBUG_CALLBACK_FUNCTION, &callback);
  EXPECT_EQ(callback, nullptr) << "it would call back into a context that is gone";
}

TEST(Context, OfOpenGlEsIsNotAdopted) {
  if (!epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless"))
    GTEST_SKIP() << "EGL makes no context without a window here";
  gpu_context();
  const ForeignContext foreign(EGL_OPENGL_ES_API);
  ASSERT_TRUE(foreign.is_current());
  try {
    const Context context = Context::adopt_current();
    FAIL();
  } catch (const scene::Error& error) {
    EXPECT_EQ(error.exit_code, scene::ExitCode::driver);
    EXPECT_THAT(error.what(), HasSubstr("OpenGL 4.5"));
  }
}

TEST(Context, CollectsMessagesFromAnyThread) {
  Context& context = gpu_context();
  GLvoid* callback = nullptr;
  GLvoid* errors = nullptr;
  glGetPointerv(GL_DEBUG_CALLBACK_FUNCTION, &callback);
  glGetPointerv(GL_DEBUG_CALLBACK_USER_PARAM, &errors);
  const auto send = [&](GLenum severity, const char* message) {
    reinterpret_cast<GLDEBUGPROC>(callback)(GL_DEBUG_SOURCE_API, GL_DEBUG_TYPE_ERROR, 0, severity, -1,
                                            message, errors);
  };
  constexpr int k_threads = 4, k_messages = 200000;  // more than a time slice
  std::latch start(k_threads);
  std::vector<std::jthread> threads;
  for (int thread = 0; thread < k_threads; ++thread) {
    threads.emplace_back([&] {
      start.arrive_and_wait();
      for (int i = 0; i < k_messages; ++i) {
        send(GL_DEBUG_SEVERITY_HIGH, "bad");
        send(GL_DEBUG_SEVERITY_LOW, "fine");
      }
    });
  }
  threads.clear();
  try {
    context.check();
    FAIL();
  } catch (const scene::Error& error) {
    const std::string text = error.what();
    EXPECT_EQ(text.size(), context.device().renderer.size() + 2 + k_threads * k_messages * 6 - 3);
    EXPECT_THAT(text, Not(HasSubstr("fine")));
  }
}

}  // namespace
}  // namespace airlight::gpu
