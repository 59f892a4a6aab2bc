#include <filesystem>
#include <future>

#include <fmt/format.h>

#include "app/commands.h"
#include "app/memory.h"
#include "app/output.h"
#include "frame/frame.h"
#include "quality/darkness.h"
#include "quality/pictures.h"
#include "quality/results.h"

namespace airlight::app {
namespace {

using scene::Error;
using scene::ExitCode;

}  // namespace

void render(const Options& options) {
  // Everything that can be wrong with the command is found before the driver is woken.
  const std::filesystem::path output = options.output;
  if (options.output.empty())
    throw Error(ExitCode::usage, "-o", "it is missing", "name the image to write, as in -o out.exr");
  if (output.extension() != ".exr")
    throw Error(ExitCode::usage, "-o", fmt::format("'{}' does not end in .exr", options.output),
                "images are OpenEXR, with a PNG preview beside");
  auto volumes = parse_volumes(options, "vsv,vsv:integral=riemann");
  auto surfaces = parse_surfaces(options);
  require_read(options, volumes, surfaces);
  const int shadow_map = shadow_map_size(options);
  if (options.get("volume") && volumes.size() != 1)
    throw Error(ExitCode::usage, "--volume", "render takes one method", "compare takes several");
  if (surfaces.size() != 1)
    throw Error(ExitCode::usage, "--surface", "render takes one method", "compare takes several");
  Subject subject = make_subject(options);
  fit_to_view(options, volumes, surfaces, subject);
  const quality::VolumeChoice& volume = volumes[0];
  const quality::SurfaceChoice& surface = surfaces[0];
  std::filesystem::path preview = output;
  preview.replace_extension(".png");
  if (output.has_parent_path()) require_folder(output.parent_path());
  require_writable(output);
  require_writable(preview);
  if (!options.quiet) say_warnings(subject.scene.report);

  require_memory(
      {.size = subject.view.size,
       .bytes_per_pixel = k_bytes_of_render + k_bytes_of_rendered_light * (subject.view.lights.size() - 1),
       .shadow_map = quality::is_read("shadow-map", volumes, surfaces) ? shadow_map : 0,
       .triangles = subject.scene.geometry.triangles.size()});
  frame::FrameImages images;
  std::string renderer;
  {
    ProgressLine progress(options.quiet);
    gpu::Context context;
    renderer = context.device().renderer;
    frame::Frame frame(context, subject.scene.geometry, shadow_map);
    quality::SharedReference reference(subject.scene.geometry, subject.view, progress.follower(),
                                       options.get("cache").value_or(""));
    {
      const auto airlight = volume.make(context, reference);
      const auto shadow = surface.make(context, reference);
      gpu::StageTimer off(nullptr);
      frame.render(subject.view, *shadow, *airlight, off);
    }
    images = frame.take();
  }
  const float exposure = subject.exposure ? *subject.exposure : quality::automatic_exposure(images.radiance);

  std::map<std::string, std::string> configuration = quality::view_options(subject.view);
  configuration["scene"] = options.scene;
  configuration["volume"] = volume.spec;
  configuration["surface"] = surface.spec;
  for (const auto& [name, value] : volume.values()) configuration[name] = frame::text_of(value);
  for (const auto& [name, value] : surface.values()) configuration["surface." + name] = frame::text_of(value);
  if (quality::is_read("shadow-map", volumes, surfaces))
    configuration["shadow-map"] = fmt::format("{}", shadow_map);
  configuration["exposure"] = fmt::format("{}", exposure);
  for (const char* name : {"albedo", "triangles"})
    if (const auto text = options.get(name)) configuration[name] = *text;
  configuration["version"] = quality::version();
  configuration["renderer"] = renderer;
  configuration["command"] =
      fmt::format("{} -o {}", options.command_line({}), quality::shell_quote(options.output));
  std::map<std::string, std::string> metadata;
  for (const auto& [name, value] : configuration) metadata["airlight." + name] = value;

  auto preview_is_written = std::async(
      std::launch::async, [&] { quality::write_png(preview, images.radiance, images.size, exposure); });
  quality::write_frame(output, images, metadata);
  preview_is_written.get();
  if (!options.quiet) {
    const bool black = quality::is_black(images.radiance);
    if (black)
      say("airlight: warning: the image is black: " +
          quality::why_black(subject.scene.geometry, subject.view));
    if (const std::string skipped = quality::skipped_lights(images); !skipped.empty())
      say(fmt::format("skipped, because they cannot reach the view: {}", skipped));
    say(fmt::format("{} and {} written, exposure {:.4g}{}", output.string(), preview.string(), exposure,
                    subject.exposure || black ? "" : " (automatic: the 95th percentile maps to 0.8)"));
  }
}

}  // namespace airlight::app
