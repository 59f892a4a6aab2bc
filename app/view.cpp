#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "app/commands.h"
#include "app/memory.h"
#include "app/output.h"
#include "gpu/context.h"
#include "quality/results.h"
#include "viewer/viewer.h"
#include "viewer/window.h"

namespace airlight::app {

void view(const Options& options) {
  auto volumes = parse_volumes(options, "vsv");
  auto surfaces = parse_surfaces(options);
  require_read(options, volumes, surfaces);
  int shadow_map = shadow_map_size(options);
  const auto require_gpu = [](const auto& choice, const char* option) {
    if (!choice.method->traits.runs_on_gpu)
      throw scene::Error(scene::ExitCode::usage, option,
                         fmt::format("{} is too slow to fly by", choice.method->name),
                         "the window can show the truth beside another method");
  };
  const auto require_shown = [&] {
    if (volumes.size() != 1 || surfaces.size() != 1)
      throw scene::Error(scene::ExitCode::usage, volumes.size() != 1 ? "--volume" : "--surface",
                         "view begins with one method", "another one can be set beside it in the window");
    require_gpu(volumes[0], "--volume");
    require_gpu(surfaces[0], "--surface");
  };
  require_shown();
  Subject subject = make_subject(options);
  if (subject.path && subject.path->moves_objects())
    throw scene::Error(scene::ExitCode::usage, "--path",
                       "it moves nodes, and the window shows a model at rest", "render or compare it");
  if (!options.get("size")) subject.view.size = {1280, 720};
  take_usual_methods(options, subject, volumes, surfaces, shadow_map);
  require_shown();
  viewer::Shown shown{subject.view, volumes[0],       surfaces[0],
                      shadow_map,   subject.exposure, subject.scene.tone_map};
  fit_to_view(volumes, surfaces, subject);
  if (!options.quiet) say_warnings(subject.scene.report);
  require_memory(
      {.size = subject.view.size,
       .bytes_per_pixel = k_bytes_of_compare + k_bytes_of_compared_light * (subject.view.lights.size() - 1),
       .shadow_map = shadow_map,
       .triangles = subject.scene.geometry.triangles.size(),
       .looks = bytes_of_looks(subject.scene.geometry)});

  viewer::Window window(fmt::format("{} - Airlight", options.scene), subject.view.size);
  gpu::Context context = gpu::Context::adopt_current();
  viewer::Viewer viewer(context, subject.scene,
                        {options.scene, options.get("triangles"), options.get("albedo"), options.get("looks"),
                         options.get("occluders")},
                        shown, subject.path, output_folder(options));
  while (!viewer.is_closed()) {
    window.wait(viewer.patience());
    for (const viewer::Event& event : window.events().take_all()) viewer.push(event);
    const double now = viewer::Window::seconds();
    if (!viewer.has_work(now)) continue;
    if (viewer.draw(now))
      window.present(viewer.image());
    else
      window.wait(0.1);
  }
}

}  // namespace airlight::app
