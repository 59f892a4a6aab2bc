#include <thread>

#include <fmt/format.h>

#include "app/commands.h"
#include "app/memory.h"
#include "app/output.h"
#include "gpu/context.h"
#include "quality/results.h"
#include "scene/builtin.h"

namespace airlight::app {

void list_scenes() {
  for (const scene::BuiltinScene& scene : scene::builtin_scenes()) {
    print(fmt::format("{:<12}{:>8} triangles  {}{}\n", scene.name, scene.make().geometry.triangles.size(),
                      scene.description, scene.count ? "; takes --triangles" : ""));
  }
}

void print_info() {
  require_memory({});
  const gpu::Context context;
  const gpu::Limits& limits = context.limits();
  print(fmt::format(
      "airlight                  {}\n"
      "renderer                  {}\n"
      "OpenGL                    {}\n"
      "runs on                   {}\n"
      "largest storage block     {} bytes\n"
      "largest texture           {} texels a side\n"
      "largest viewport          {} pixels a side\n"
      "array layers              {}\n"
      "work group                {} invocations\n"
      "Embree                    {}\n"
      "CPU cores                 {}\n",
      quality::version(), context.device().renderer, context.device().version,
      context.device().is_software ? "CPU" : "GPU", limits.max_storage_block_bytes, limits.max_texture_size,
      limits.max_viewport, limits.max_array_layers, limits.max_work_group_invocations,
      AIRLIGHT_EMBREE_VERSION, std::thread::hardware_concurrency()));
}

}  // namespace airlight::app
