#include <algorithm>
#include <string>
#include <thread>

#include <fmt/format.h>

#include "app/commands.h"
#include "app/memory.h"
#include "app/output.h"
#include "gpu/context.h"
#include "quality/results.h"
#include "scene/builtin.h"
#include "scene/edges.h"

namespace airlight::app {

void list_scenes() {
  for (const scene::BuiltinScene& scene : scene::builtin_scenes()) {
    print(fmt::format("{:<12}{:>8} triangles  {}{}\n", scene.name, scene.make().geometry.triangles.size(),
                      scene.description, scene.count ? "; takes --triangles" : ""));
  }
}

namespace {

void print_driver() {
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

void print_scene(const Options& options) {
  const scene::Scene scene = load_scene(options);
  const scene::Geometry& geometry = scene.geometry;
  const scene::Box box = scene::bounds(geometry);
  const scene::EdgeCounts edges = scene::count_edges(geometry);
  const auto materials_that = [&](auto is_so) {
    return std::count_if(geometry.materials.begin(), geometry.materials.end(), is_so);
  };
  std::string text = fmt::format(
      "triangles                 {}, and {} without area dropped\n"
      "vertices                  {}\n",
      geometry.triangles.size(), scene.report.degenerate_triangles, geometry.positions.size());
  if (!box.empty())
    text += fmt::format("box                       {:.6g},{:.6g},{:.6g} to {:.6g},{:.6g},{:.6g} m\n",
                        box.lower.x, box.lower.y, box.lower.z, box.upper.x, box.upper.y, box.upper.z);
  text += fmt::format(
      "materials                 {}: {} with textures, {} with parts cut out, {} that let light through\n"
      "cameras                   {}\n"
      "lights                    {}\n"
      "edges by index            {}\n"
      "edges by position         {}: {} open, {} of more than two triangles, at most {} triangles\n",
      geometry.materials.size(), materials_that([](const auto& m) { return m.texture.has_value(); }),
      materials_that([](const auto& m) { return m.cut_out.has_value(); }),
      materials_that([](const auto& m) { return m.transmittance != glm::vec3(0.0f); }), scene.cameras.size(),
      scene.lights.size(), edges.by_vertex, edges.by_position, edges.open, edges.of_more_than_two,
      edges.most_triangles);
  print(text);
  say_warnings(scene.report);
}

}  // namespace

void info(const Options& options) {
  if (options.scene.empty())
    print_driver();
  else
    print_scene(options);
}

}  // namespace airlight::app
