#include "gpu/context.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "scene/error.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>

namespace airlight::gpu {
namespace {

using scene::Error;
using scene::ExitCode;

bool lists(const char* extensions, std::string_view name) {
  return extensions && std::string_view(extensions).find(name) != std::string_view::npos;
}

/// The displays worth trying, best first: hardware devices, then Mesa's surfaceless platform.
std::vector<EGLDisplay> candidate_displays() {
  std::vector<EGLDisplay> displays;
  const char* client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  if (lists(client, "EGL_EXT_device_enumeration") && lists(client, "EGL_EXT_platform_device")) {
    std::array<EGLDeviceEXT, 16> devices{};
    EGLint count = 0;
    eglQueryDevicesEXT(static_cast<EGLint>(devices.size()), devices.data(), &count);
    for (int i = 0; i < count; ++i) {
      const auto device = devices[static_cast<std::size_t>(i)];
      if (lists(eglQueryDeviceStringEXT(device, EGL_EXTENSIONS), "EGL_MESA_device_software")) continue;
      displays.push_back(eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, device, nullptr));
    }
  }
  if (lists(client, "EGL_MESA_platform_surfaceless")) {
    displays.push_back(eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr));
  }
  return displays;
}

/// Makes a context current on `display`. @returns EGL_NO_CONTEXT where it cannot.
EGLContext try_context(EGLDisplay display) {
  if (display == EGL_NO_DISPLAY || !eglInitialize(display, nullptr, nullptr)) return EGL_NO_CONTEXT;
  if (!eglBindAPI(EGL_OPENGL_API)) return EGL_NO_CONTEXT;
  const EGLint config_attributes[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, EGL_DONT_CARE,
                                      EGL_NONE};
  EGLConfig config = nullptr;
  EGLint config_count = 0;
  if (!eglChooseConfig(display, config_attributes, &config, 1, &config_count) || config_count == 0) {
    return EGL_NO_CONTEXT;
  }
  const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                               4,
                               EGL_CONTEXT_MINOR_VERSION,
                               5,
                               EGL_CONTEXT_OPENGL_PROFILE_MASK,
                               EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                               EGL_CONTEXT_OPENGL_DEBUG,
                               EGL_TRUE,
                               EGL_NONE};
  EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, attributes);
  if (context == EGL_NO_CONTEXT) return EGL_NO_CONTEXT;
  if (eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) return context;
  eglDestroyContext(display, context);
  return EGL_NO_CONTEXT;
}

std::string gl_string(GLenum name) {
  const auto* text = reinterpret_cast<const char*>(glGetString(name));
  return text ? text : "";
}

int gl_integer(GLenum name) {
  GLint value = 0;
  glGetIntegerv(name, &value);
  return value;
}

}  // namespace

bool is_software_renderer(const std::string& renderer) {
  // Zink names the Vulkan driver under it: lavapipe calls itself llvmpipe.
  constexpr std::array k_names = {"llvmpipe", "softpipe", "lavapipe", "SwiftShader", "swrast"};
  return std::any_of(k_names.begin(), k_names.end(),
                     [&](const char* name) { return lists(renderer.c_str(), name); });
}

Context::Context(DebugOutput debug_output) {
  for (EGLDisplay display : candidate_displays()) {
    if (EGLContext context = try_context(display); context != EGL_NO_CONTEXT) {
      display_ = display;
      context_ = context;
      break;
    }
  }
  if (!context_) {
    throw Error(ExitCode::driver, "EGL", "no headless OpenGL 4.5 core context can be had",
                "install a driver, such as Mesa's (libegl1, libgl1-mesa-dri)");
  }
  set_up(debug_output);
}

Context::Context(Adopted, DebugOutput debug_output) {
  set_up(debug_output);
}

Context Context::adopt_current(DebugOutput debug_output) {
  return Context(Adopted{}, debug_output);
}

void Context::set_up(DebugOutput debug_output) {
  device_.renderer = gl_string(GL_RENDERER);
  device_.version = gl_string(GL_VERSION);
  device_.is_software = is_software_renderer(device_.renderer);
  if (epoxy_gl_version() < 45) {
    throw Error(ExitCode::driver, device_.renderer, "it has OpenGL " + device_.version,
                "use a driver with OpenGL 4.5");
  }
  if (!epoxy_has_gl_extension("GL_ARB_gl_spirv") && epoxy_gl_version() < 46) {
    throw Error(ExitCode::driver, device_.renderer, "GL_ARB_gl_spirv is missing",
                "use a driver with OpenGL 4.6");
  }
  glEnable(GL_DEBUG_OUTPUT);
  if (debug_output == DebugOutput::synchronous) {
    glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
  } else {
    glDisable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
  }
  glDebugMessageCallback(collect, &errors_);

  GLint64 storage_block = 0;
  glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &storage_block);
  GLint viewport[2] = {0, 0};
  glGetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport);
  limits_ = {.max_storage_block_bytes = storage_block,
             .max_texel_buffer_texels = gl_integer(GL_MAX_TEXTURE_BUFFER_SIZE),
             .max_texture_size = gl_integer(GL_MAX_TEXTURE_SIZE),
             .max_volume_size = gl_integer(GL_MAX_3D_TEXTURE_SIZE),
             .max_viewport = std::min(viewport[0], viewport[1]),
             .max_array_layers = gl_integer(GL_MAX_ARRAY_TEXTURE_LAYERS),
             .max_work_group_invocations = gl_integer(GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS),
             .max_work_groups = max_work_groups(),
             .storage_offset_alignment = gl_integer(GL_SHADER_STORAGE_BUFFER_OFFSET_ALIGNMENT)};
  check();
}

Context::~Context() {
  if (!context_) {
    glDebugMessageCallback(nullptr, nullptr);  // an adopted context goes on without us
    return;
  }
  eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(display_, context_);
  eglTerminate(display_);
}

void Context::collect(unsigned, unsigned, unsigned, unsigned severity, int, const char* message,
                      const void* errors) {
  if (severity != GL_DEBUG_SEVERITY_HIGH) return;
  auto& [mutex, text] = *static_cast<Errors*>(const_cast<void*>(errors));
  const std::lock_guard lock(mutex);
  text += text.empty() ? "" : " | ";
  text += message;
}

void Context::check() {
  const std::lock_guard lock(errors_.mutex);
  if (errors_.text.empty()) return;
  throw Error(ExitCode::driver, device_.renderer, std::exchange(errors_.text, {}));
}

void Context::finish() {
  glFinish();
  check();
}

void require_storage_block(const Limits& limits, std::int64_t bytes, const std::string& what,
                           const std::string& remedy) {
  if (bytes <= limits.max_storage_block_bytes) return;
  throw Error(ExitCode::driver, what,
              fmt::format("needs {:.0f} MiB, but one shader storage buffer of this driver holds {:.0f} MiB "
                          "(GL_MAX_SHADER_STORAGE_BLOCK_SIZE)",
                          static_cast<double>(bytes) / 0x100000,
                          static_cast<double>(limits.max_storage_block_bytes) / 0x100000),
              remedy);
}

void require_texels(const Limits& limits, std::int64_t texels, const std::string& what,
                    const std::string& remedy) {
  if (texels <= limits.max_texel_buffer_texels) return;
  throw Error(ExitCode::driver, what,
              fmt::format("{} texels are more than this driver's {} (GL_MAX_TEXTURE_BUFFER_SIZE)", texels,
                          limits.max_texel_buffer_texels),
              remedy);
}

glm::uvec3 max_work_groups() {
  glm::ivec3 most(0);
  for (int axis = 0; axis < 3; ++axis)
    glGetIntegeri_v(GL_MAX_COMPUTE_WORK_GROUP_COUNT, static_cast<GLuint>(axis), &most[axis]);
  return most;
}

void require_work_groups(glm::uvec3 most, glm::uvec3 groups) {
  if (!glm::any(glm::greaterThan(groups, most))) return;
  throw Error(ExitCode::driver, "dispatch",
              fmt::format("{} × {} × {} work groups are more than this driver's {} × {} × {} "
                          "(GL_MAX_COMPUTE_WORK_GROUP_COUNT)",
                          groups.x, groups.y, groups.z, most.x, most.y, most.z),
              "ask for less: a smaller image or a coarser grid");
}

}  // namespace airlight::gpu
